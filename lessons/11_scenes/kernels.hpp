// SPDX-License-Identifier: MIT
/// @file
/// Triangles drawn by kernels: each compiled for one set of effects, and chosen once for a
/// material. Introduced in lesson 11; derivation: docs/derivations/11_scenes.md.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "03_z_buffer/depth_buffer.hpp"
#include "06_phong/fragments.hpp"
#include "06_phong/many_samples.hpp"
#include "06_phong/shading_variants.hpp"
#include "08_normal_maps/bumpy_scene.hpp"
#include "10_threading/binned_triangles.hpp"
#include "11_scenes/blending.hpp"
#include "11_scenes/finished_scene.hpp"

namespace rasterbook {

/// How a fragment gets its colour.
enum class Look { unlit, phong, toon };

/// The effects that a kernel is compiled with.
struct KernelEffects {
    Look look = Look::unlit;
    bool normal_map = false;
    bool shadow = false;
    bool see_through = false;  ///< There may be holes, or what lies behind shines through.

    bool operator==(const KernelEffects&) const = default;
};

/// All kernels. Where few materials are of a kind, one kernel stands for several sets: what it has
/// beyond them is asked at run time, once for up to 64 fragments (Eq. 11.3).
constexpr std::array all_kernels = {KernelEffects{Look::unlit, false, false, false},
                                    KernelEffects{Look::phong, false, false, false},
                                    KernelEffects{Look::phong, false, true, false},
                                    KernelEffects{Look::phong, true, false, false},
                                    KernelEffects{Look::phong, true, true, false},
                                    KernelEffects{Look::toon, true, true, false},
                                    KernelEffects{Look::unlit, false, false, true},
                                    KernelEffects{Look::phong, true, true, true},
                                    KernelEffects{Look::toon, true, true, true}};

/// The kernel that is compiled with what a material's plan has, and as little beyond it as there
/// is.
inline std::size_t kernel_of(const MaterialPlan& plan) {
    KernelEffects effects{plan[Effect::toon]    ? Look::toon
                          : plan[Effect::light] ? Look::phong
                                                : Look::unlit,
                          plan[Effect::normal_map], plan[Effect::shadow],
                          plan[Effect::mask] || plan[Effect::blend]};
    if (effects.look == Look::unlit) effects.normal_map = effects.shadow = false;
    if (effects.look == Look::toon || (effects.look == Look::phong && effects.see_through))
        effects.normal_map = effects.shadow = true;
    for (std::size_t i = 0; i < all_kernels.size(); ++i)
        if (all_kernels[i] == effects) return i;
    assert(false && "all sets have a kernel");
    return 0;
}

/// What a picture is drawn with, and into.
struct Frame {
    const FinishedScene& scene;
    ShadingVariant shading;
    NormalMapVariant normal_map;
    Filter filter;
    vec3 eye_world;
    const Shadows& shadows;
    Image<vec3>& color;
    DepthBuffer& depth;
};

/// What a triangle's corners add to its material: their colours, and how opaque it is.
class TriangleTints {
  public:
    TriangleTints(const FinishedScene& scene, const Mesh& mesh, const Triangle& triangle)
        : plan_(scene.plan.materials[triangle.material]),
          material_(scene.materials[triangle.material]),
          has_colors_(plan_[Effect::vertex_colors] && !mesh.colors.empty()) {
        if (!has_colors_) return;
        for (std::size_t i = 0; i < 3; ++i) colors_[i] = mesh.colors[triangle.corners[i].position];
    }

    /// Colours all fragments (Eq. 11.10).
    template <typename CounterPolicy>
    void tint(const ManyWeights& weights, std::array<SurfaceColor, most_points>& own,
              CounterPolicy& counters) const {
        if (!has_colors_) return;
        for (std::size_t i = 0; i < weights.count; ++i) {
            counters.add(Counter::colored_fragments);
            own[i].tint(vec3(color_at(weights.here[i])));
        }
    }

    /// How opaque they are, 0 to 1: by the material, its texture and the corners (Eq. 11.7). These
    /// do not count for a material that is neither glass nor has holes.
    template <typename CounterPolicy>
    Numbers opacities(const TriangleSurface& surface, const ManyWeights& weights, Filter filter,
                      CounterPolicy& counters) const {
        Numbers opacities;
        opacities.fill(is_masked() || plan_.is_glass ? material_.opacity : 1.0f);
        if (!is_masked() && !plan_.is_glass) return opacities;
        if (surface.effects.diffuse_map)
            sample_many(*surface.texture, filter, surface.uvs, weights,
                        [&](std::size_t i, vec4 texel) {
                            counters.add(Counter::texture_samples);
                            opacities[i] *= texel.a;
                        });
        if (has_colors_)
            for (std::size_t i = 0; i < weights.count; ++i)
                opacities[i] *= color_at(weights.here[i]).a;
        for (std::size_t i = 0; i < weights.count; ++i)
            opacities[i] = std::min(std::max(0.0f, opacities[i]), 1.0f);
        return opacities;
    }

    bool is_masked() const { return plan_[Effect::mask]; }
    bool is_layer() const { return plan_[Effect::blend]; }
    float cutoff() const { return material_.alpha_cutoff; }

  private:
    /// Exactly the corners' colour where all three agree: weights add up to 1 but for rounding.
    vec4 color_at(vec3 weights) const {
        return colors_[0] + weights.y * (colors_[1] - colors_[0]) +
               weights.z * (colors_[2] - colors_[0]);
    }

    const MaterialPlan& plan_;
    const Material& material_;
    bool has_colors_;
    std::array<vec4, 3> colors_;
};

/// Takes the place of what a kernel is compiled without.
struct Nothing {
    template <typename... Arguments>
    explicit Nothing(const Arguments&...) {}
};

template <bool is_there, typename Stage>
using Only = std::conditional_t<is_there, Stage, Nothing>;

/// The colours of a triangle's fragments, by the stages of the earlier lessons.
template <KernelEffects effects>
class Shade {
  public:
    Shade(const Frame& frame, const ReadyTriangle& ready)
        : frame_(frame),
          surface(frame.scene, ready.mesh, ready.triangle),
          tints(frame.scene, ready.mesh, ready.triangle),
          toon_(frame.scene.materials[ready.triangle.material].toon),
          perspective_(ready.on_screen, ready.clipped),
          relief_(frame.normal_map, frame.scene, ready.mesh, ready.triangle, ready.is_back),
          light_(frame.shading, frame.scene.lit_by.lights, frame.eye_world, ready.mesh,
                 ready.triangle, ready.is_back, surface),
          shadow_(frame.shadows, ready.mesh, ready.triangle) {
        if constexpr (effects.look == Look::toon) surface.own_color.ambient = toon_->shade;
    }

    /// Calls store(i, color) for each fragment, and before that begin(weights).
    template <typename CounterPolicy, typename Begin, typename Store>
    void operator()(const ManyFragments& fragments, CounterPolicy& counters, Begin&& begin,
                    Store&& store) {
        const ManyWeights weights = weights_of(fragments, perspective_);
        begin(weights);
        auto own = surface.colors(weights, frame_.filter, counters);
        tints.tint(weights, own, counters);
        if constexpr (effects.look == Look::unlit) {
            for (std::size_t i = 0; i < fragments.count; ++i) store(i, unlit(own[i]));
        } else {
            BumpyPoints points;
            light_.add(weights, points, counters);
            if constexpr (effects.normal_map) relief_.add(weights, frame_.filter, points, counters);
            if constexpr (effects.shadow) shadow_.look_up(points, counters);
            if constexpr (effects.normal_map) relief_.tilt(points);
            if constexpr (effects.look == Look::phong) {
                if constexpr (effects.shadow)
                    light_.compute(points, shadow_);
                else
                    light_.compute(points);
                for (std::size_t i = 0; i < fragments.count; ++i)
                    store(i, phong(own[i], ambient_light, points.light(i)));
            } else {
                for (std::size_t i = 0; i < fragments.count; ++i) {
                    counters.add(Counter::toon_fragments);
                    store(i, own[i].emission +
                                 toon_paint(own[i].ambient, own[i].diffuse, level(points, i)));
                }
            }
        }
    }

  private:
    float level(const BumpyPoints& points, std::size_t i) const {
        return toon_level(frame_.scene.lit_by.lights, points.position_world[i],
                          points.normal_world[i], *toon_,
                          [&](std::size_t l) { return shadow_(l, i); });
    }

    const Frame& frame_;

  public:
    TriangleSurface surface;
    TriangleTints tints;

  private:
    static constexpr bool is_lit = effects.look != Look::unlit;
    const std::optional<ToonLook>& toon_;
    PerspectiveWeights perspective_;
    Only<effects.normal_map, TriangleRelief> relief_;
    Only<is_lit, TriangleLight> light_;
    Only<effects.shadow, TriangleShadows> shadow_;
};

/// Draws what of a triangle lies in a part of the picture.
///
/// @param layers  Takes its fragments, where what lies behind shines through.
template <KernelEffects effects, typename CounterPolicy>
void draw_triangle(const Frame& frame, const ReadyTriangle& ready, const Part& part, Layers& layers,
                   CounterPolicy& counters) {
    Shade<effects> shade(frame, ready);
    const TriangleDepth triangle_depth(ready.depths);
    const auto write = [&](const ManyFragments& fragments) {
        if constexpr (!effects.see_through) {
            shade(
                fragments, counters, [](const ManyWeights&) {},
                [&](std::size_t i, vec3 color) { frame.color[fragments.pixels[i]] = color; });
        } else {
            Numbers opacities;
            shade(
                fragments, counters,
                [&](const ManyWeights& weights) {
                    opacities =
                        shade.tints.opacities(shade.surface, weights, frame.filter, counters);
                },
                [&](std::size_t i, vec3 color) {
                    const ivec2 pixel = fragments.pixels[i];
                    const float depth = triangle_depth.at(fragments.screen_weights[i]);
                    const bool is_masked = shade.tints.is_masked();
                    if (is_masked) {
                        counters.add(Counter::masked_fragments);
                        if (!is_there(opacities[i], shade.tints.cutoff())) return;
                    }
                    if (shade.tints.is_layer()) {
                        counters.add(Counter::fragments_shaded);
                        counters.add(Counter::blended_fragments);
                        layers.add({pixel, depth, is_masked ? 1.0f : opacities[i], color});
                        return;
                    }
                    if (!frame.depth.test_and_write(pixel, depth)) return;
                    counters.add(Counter::fragments_shaded);
                    frame.color[pixel] = color;
                });
        }
    };
    Fragments visible(write);
    fill_part(ready.on_screen, part, [&](ivec2 pixel, vec3 screen_weights) {
        counters.add(Counter::fragments_tested);
        const float depth = triangle_depth.at(screen_weights);
        if constexpr (effects.see_through) {
            // Only a look: whether it is there is not yet known.
            if (!(depth < frame.depth.depths()[pixel])) return;
        } else {
            if (!frame.depth.test_and_write(pixel, depth)) return;
            counters.add(Counter::fragments_shaded);
        }
        visible.add(pixel, screen_weights);
    });
    visible.finish();
}

/// For each material its kernel.
template <typename CounterPolicy>
class Kernels {
  public:
    using Kernel = void (*)(const Frame&, const ReadyTriangle&, const Part&, Layers&,
                            CounterPolicy&);

    explicit Kernels(const ScenePlan& plan) {
        for (const MaterialPlan& material : plan.materials)
            of_material_.push_back(table[kernel_of(material)]);
    }

    Kernel operator[](std::size_t material) const { return of_material_[material]; }

  private:
    template <std::size_t... i>
    static constexpr std::array<Kernel, sizeof...(i)> compiled(std::index_sequence<i...>) {
        return {&draw_triangle<all_kernels[i], CounterPolicy>...};
    }
    static constexpr auto table = compiled(std::make_index_sequence<all_kernels.size()>());

    std::vector<Kernel> of_material_;
};

}  // namespace rasterbook
