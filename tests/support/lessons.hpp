// SPDX-License-Identifier: MIT
/// @file
/// The lessons' Options, make_assets() and render(), each in a namespace of its own: lesson_09 and
/// so on. In tests of the reader's headers, too, it is the course's main.cpp.
#pragma once

// All that the lessons' main.cpp include, so that what is left of those are their own lines.
#include <iostream>
#include <optional>
#include <syncstream>
#include <utility>

#include "02_triangle_fill/flat_color.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/mvp_variants.hpp"
#include "04_mvp/projection.hpp"
#include "05_textures/textures.hpp"
#include "06_phong/assets.hpp"
#include "06_phong/shading_variants.hpp"
#include "06_phong/studio_lights.hpp"
#include "07_toon/assets.hpp"
#include "07_toon/toon_variants.hpp"
#include "08_normal_maps/assets.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "09_shadow_maps/assets.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "10_threading/binned_triangles.hpp"
#include "10_threading/thread_options.hpp"
#include "10_threading/thread_pool.hpp"
#include "10_threading/threaded_shadows.hpp"
#include "11_scenes/explain.hpp"
#include "11_scenes/scene_assets.hpp"
#include "11_scenes/scene_camera.hpp"
#include "11_scenes/scene_options.hpp"
#include "11_scenes/shaders.hpp"
#include "common/app/lesson_app.hpp"
#include "common/image/backdrop.hpp"

namespace rasterbook::test {

/// Takes the place of rasterbook::run_lesson(): nobody calls it, and no picture is compiled for it.
template <typename Options, typename... Arguments>
int run_lesson(Arguments&&...) {
    return 0;
}

}  // namespace rasterbook::test

#define main static lesson_main [[maybe_unused]]
namespace lesson_04 {
using rasterbook::test::run_lesson;
#include "lessons/04_mvp/main.cpp"
}  // namespace lesson_04
namespace lesson_05 {
using rasterbook::test::run_lesson;
#include "lessons/05_textures/main.cpp"
}  // namespace lesson_05
namespace lesson_06 {
using rasterbook::test::run_lesson;
#include "lessons/06_phong/main.cpp"
inline auto make_assets(Scene scene, const Options& options) {
    return make_phong_assets(std::move(scene), options);
}
}  // namespace lesson_06
namespace lesson_07 {
using rasterbook::test::run_lesson;
#include "lessons/07_toon/main.cpp"
inline auto make_assets(Scene scene, const Options& options) {
    return make_toon_assets(std::move(scene), options);
}
}  // namespace lesson_07
namespace lesson_08 {
using rasterbook::test::run_lesson;
#include "lessons/08_normal_maps/main.cpp"
inline auto make_assets(Scene scene, const Options& options) {
    return make_normal_map_assets(std::move(scene), options);
}
}  // namespace lesson_08
namespace lesson_09 {
using rasterbook::test::run_lesson;
#include "lessons/09_shadow_maps/main.cpp"
inline auto make_assets(Scene scene, const Options& options) {
    return make_shadow_assets(std::move(scene), options);
}
}  // namespace lesson_09
namespace lesson_10 {
using rasterbook::test::run_lesson;
#include "lessons/10_threading/main.cpp"
inline auto make_assets(Scene scene, const Options& options) {
    return make_shadow_assets(std::move(scene), options);
}
}  // namespace lesson_10
namespace lesson_11 {
using rasterbook::test::run_lesson;
#include "lessons/11_scenes/main.cpp"
}  // namespace lesson_11
#undef main
