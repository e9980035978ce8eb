// SPDX-License-Identifier: MIT
/// @file
/// What a lesson includes first where it is compiled WITHOUT an effect.
///
/// The lessons count the work of each effect where it is done. Here count() promises that this work
/// is never done; so the compiler drops the code that leads to it, and nothing is copied. Where the
/// counting comes too late, after the question whether there is anything to do, the stage itself is
/// replaced.
#pragma once

// All that counters.hpp includes.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#define count(...) count_anyway(__VA_ARGS__)
#define count_each(...) count_each_anyway(__VA_ARGS__)
#include "common/app/counters.hpp"
#undef count
#undef count_each

#include "benchmarks/unused_effects.hpp"

namespace rasterbook {

inline void promise_no_work(Counter counter) {
    if (is_work_of(Without::WITHOUT, counter)) __builtin_unreachable();
}

inline void count(Counter counter, std::uint64_t times = 1) {
    promise_no_work(counter);
    count_anyway(counter, times);
}

template <typename F>
void count_each(Counter counter) {
    promise_no_work(counter);
    count_each_anyway<F>(counter);
}

}  // namespace rasterbook

// They share a counter.
#if defined(WITHOUT_texture) || defined(WITHOUT_specular_map) || defined(WITHOUT_emission_map)
#define triangle_surface triangle_surface_anyway
#include "06_phong/surface.hpp"
#undef triangle_surface

namespace rasterbook {

inline TriangleSurface triangle_surface(const Scene& scene, const SurfaceTextures& textures,
                                        EffectMask effects, const ProjectedTriangle& projected) {
    effects.set(Effect::WITHOUT, false);
    return triangle_surface_anyway(scene, textures, effects, projected);
}

#ifdef WITHOUT_texture
inline vec4 texture_sample(const TriangleSurface& surface, const FragmentBarycentrics&, Filter) {
    if (surface.effects[Effect::texture]) __builtin_unreachable();
    return vec4(1);
}
#endif

}  // namespace rasterbook
#endif

#ifdef WITHOUT_shadow
#define light_visibility light_visibility_anyway
#include "09_shadow_maps/shadows.hpp"
#undef light_visibility

namespace rasterbook {

template <typename... Arguments>
float light_visibility(const ShadowMaps&, const Arguments&...) {
    return 1;
}

}  // namespace rasterbook
#endif

#ifdef WITHOUT_outline
#define add_to_outline add_to_outline_anyway
#define draw_outlines draw_outlines_anyway
#include "07_toon/toon_options.hpp"
#undef add_to_outline
#undef draw_outlines

namespace rasterbook {

template <typename... Arguments>
void add_to_outline(const ToonShading&, const Arguments&...) {}

template <typename... Arguments>
void draw_outlines(const ToonShading&, const Arguments&...) {}

}  // namespace rasterbook
#endif
