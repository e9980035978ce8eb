// SPDX-License-Identifier: MIT
/// @file
/// One way to draw a frame: the render() of LESSON, in namespace LESSON_NAMESPACE, compiled WITHOUT
/// an effect.
///
/// The lessons count the work of each effect where it is done. Here the counters are replaced by
/// ones which promise that this work is never done; so the compiler drops the code that leads to
/// it, and nothing is copied. Where the counting comes too late, after the question whether there
/// is anything to do, the stage itself is replaced.
#include "benchmarks/unused_effects.hpp"

#include <cstdint>
#include <memory>
#include <type_traits>

// All types that the functions below name, whichever lesson it is.
#include "07_toon/toon_variants.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "11_scenes/scene_program.hpp"
#include "11_scenes/shaders.hpp"

#include LESSON_HEADER

namespace rasterbook {

/// NoCounters, and a promise that nothing is to be counted for an effect.
template <Without effect>
struct NoWork {
    void add(Counter counter, std::uint64_t = 1) {
        if (is_work_of(effect, counter)) __builtin_unreachable();
    }
    void add(const NoWork&) {}
};

template <Without effect>
requires(effect == Without::texture || effect == Without::specular_map)
SurfaceColor surface_color(const TriangleSurface& surface, const FragmentBarycentrics& at,
                           Filter filter, NoWork<effect>&) {
    if (surface.effects[effect == Without::texture ? Effect::texture : Effect::specular_map])
        __builtin_unreachable();
    return surface_color(surface, at, filter);
}

template <Without effect>
requires(effect == Without::texture || effect == Without::specular_map)
SurfaceColor surface_color(const TriangleSurface& surface, const FragmentBarycentrics& at,
                           const vec3& in_texture, Filter filter, NoWork<effect>&) {
    if (surface.effects[effect == Without::texture ? Effect::texture : Effect::specular_map])
        __builtin_unreachable();
    return surface_color(surface, at, in_texture, filter);
}

inline vec4 texture_sample(const TriangleSurface& surface, const FragmentBarycentrics&, Filter,
                           NoWork<Without::texture>&) {
    if (surface.effects[Effect::texture]) __builtin_unreachable();
    return vec4(1);
}

inline float light_visibility(const ShadowMaps&, std::size_t, TriangleReceiver&, vec3, vec3,
                              NoWork<Without::shadow>&) {
    return 1;
}

inline void add_to_outline(const ToonVariant&, const TriangleSurface&, Barycentrics, vec3, ivec2,
                           Image<vec3>&, Image<vec3>&, NoWork<Without::outline>&) {}

inline void draw_outlines(const ToonVariant&, const Scene&, const HullNormals&, const Camera&, int,
                          const Image<vec3>&, DepthBuffer&, Image<vec3>&,
                          NoWork<Without::outline>&) {}

}  // namespace rasterbook

using namespace rasterbook;
using namespace LESSON_NAMESPACE;

namespace {

template <typename AnyOptions>
auto assets_of(const Scene& model, const AnyOptions& options) {
    if constexpr (LESSON == 11)
        return make_scene_assets(model, options);
    else
        return make_assets(model, options);
}

Image<vec3> draw(const auto& options, const auto& assets) {
    if constexpr (LESSON == 11) {
        static ThreadPool pool(1);
        StepClock clock;
        return render(options, assets, pool, clock);
    } else {
        return render(options, assets);
    }
}

}  // namespace

template <>
Draw rasterbook::draw_of<LESSON, Without::WITHOUT>(const Scene& model) {
    const auto options = [](auto knobs) {
        if constexpr (requires { knobs.shading.outline; }) knobs.shading.outline = Outline::none;
        return knobs;
    }(Options());
    using Uncounted =
        std::conditional_t<Without::WITHOUT == Without::own, NoCounters, NoWork<Without::WITHOUT>>;
    using Assets = decltype(assets_of(model, options));
    return [options, assets = std::make_shared<const Assets>(assets_of(model, options))](
               Counters* counters) {
        Uncounted uncounted;
        // Both, as in the lesson's program.
        return counters ? draw(options, *assets, *counters) : draw(options, *assets);
    };
}
