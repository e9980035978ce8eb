// SPDX-License-Identifier: MIT
/// @file
/// Lesson 07's Options, make_assets() and render(), in namespace lesson_07.
/// In tests of the reader's headers, too, it is the course's main.cpp.
#pragma once

// All that main.cpp includes, so that what is left of it are its own lines.
#include <utility>

#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/projection.hpp"
#include "06_phong/studio_lights.hpp"
#include "06_phong/surface.hpp"
#include "07_toon/assets.hpp"
#include "common/app/lesson_app.hpp"
#include "common/image/backdrop.hpp"
#include "support/run_no_lesson.hpp"

#define main static lesson_main [[maybe_unused]]
#ifdef RENDER_IS_COMPILED_APART
#define render render_here
#endif
namespace lesson_07 {
using rasterbook::test::run_lesson;
#include "lessons/07_toon/main.cpp"
using Options = ToonOptions;
inline auto make_assets(Scene scene, const Options& options) {
    return load_toon_scene(std::move(scene), options);
}
#ifdef RENDER_IS_COMPILED_APART
#undef render
Image<vec3> render(const Options&, const ToonAssets&);
#endif
}  // namespace lesson_07
#undef main
