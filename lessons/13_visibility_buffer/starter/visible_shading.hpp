// SPDX-License-Identifier: MIT
/// @file
/// A tile in two passes: which triangle is visible in each pixel, then the colours of these pixels
/// alone. Introduced in lesson 13; derivation: docs/derivations/13_visibility_buffer.md.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "05_textures/interpolation.hpp"
#include "11_scenes/blending.hpp"
#include "11_scenes/opacity.hpp"
#include "13_visibility_buffer/shaded.hpp"
#include "13_visibility_buffer/shadow_parts.hpp"
#include "13_visibility_buffer/views.hpp"
#include "13_visibility_buffer/visibility_buffer.hpp"
#include "13_visibility_buffer/visibility_options.hpp"
#include "common/app/counters.hpp"

namespace rasterbook {

/// A fragment whose colour texture has been sampled, and that is not shaded yet.
struct FragmentToShade {
    TransparentFragment fragment;  ///< Its colour: the sample. Its opacity: 1 unless it is glass.
    Barycentrics on_screen;
};

/// Visits those fragments of a triangle that are nearer than what is in the depth buffer, and not
/// in a hole.
///
/// @param projected  Of a material that has holes or is blended.
/// @param visit      Called as visit(FragmentToShade).
template <typename Maps, typename Visit>
void for_each_nearer_fragment(const Frame<Maps>& frame, const ProjectedTriangle& projected,
                              const Tile& tile, Visit&& visit) {
    const AlphaInputs inputs = alpha_inputs(frame.assets, projected);
    fill_tile(projected.on_screen, tile, [&](ivec2 pixel, Barycentrics on_screen) {
        count(Counter::fragments_tested);
        const float depth = projected.depth.at(on_screen);
        if (!is_nearer(frame.depth, pixel, depth)) return;
        const FragmentBarycentrics at = perspective_correct(inputs.setup, on_screen);
        const vec4 in_texture = texture_sample(inputs.surface, at, frame.filter);
        const float opacity = opacity_at(inputs.surface, inputs.colors, at.here, in_texture);
        if (is_hole(inputs.surface, opacity)) return;
        const bool is_masked = inputs.surface.effects[Effect::mask];
        visit(
            FragmentToShade{{pixel, depth, is_masked ? 1 : opacity, vec3(in_texture)}, on_screen});
    });
}

/// Draws depth and id of an opaque triangle (Eq. 13.1). Its colour is not known yet; where it has
/// holes, the colour buffer keeps the sample of its texture until then.
template <typename Maps>
void draw_id(const Frame<Maps>& frame, const ProjectedTriangle& projected, const Tile& tile,
             VisibilityBuffer& visible) {
    // TODO: step 1: an id by visible.add(), and the triangle's pixels by fill_tile(). Count each as
    // a Counter::fragments_tested. Where frame.depth.test_and_write() passes, the pixel's id is
    // the triangle's (Eq. 13.1). A material with Effect::mask has holes: there,
    // for_each_nearer_fragment() visits what is left of the triangle, and it counts; keep the
    // sample of each fragment's texture in frame.color.
}

/// Draws the colours of the pixels in which a triangle is visible. Of a material with holes,
/// frame.color has the samples of its texture.
template <Permutation with, typename Maps>
void shade_pixels(const Frame<Maps>& frame, const ProjectedTriangle& projected,
                  std::span<const PixelSpan> spans) {
    // TODO: step 2: triangle_inputs(), once. Then for each pixel of the spans the barycentric
    // coordinates by BarycentricPlanes, made perspective-correct, and shaded(), which gives its
    // frame.color. It takes texture_sample(), or what draw_id() has kept of a material with
    // Effect::mask. Count each pixel as one of Counter::fragments_shaded.
}

/// Finds the colours of a triangle's transparent fragments.
template <Permutation with, typename Maps>
void shade_fragments(const Frame<Maps>& frame, const ProjectedTriangle& projected,
                     std::span<FragmentToShade> fragments) {
    TriangleInputs triangle = triangle_inputs(with, frame, projected);
    for (auto& [fragment, on_screen] : fragments) {
        count(Counter::fragments_shaded);
        fragment.color = shaded<with>(
            frame, triangle, perspective_correct(triangle.setup, on_screen), fragment.color);
    }
}

/// For each material its shaders: shade_pixels() and shade_fragments().
template <typename Maps>
class VisibleShaders {
  public:
    struct Shader {
        void (*shade_pixels)(const Frame<Maps>&, const ProjectedTriangle&,
                             std::span<const PixelSpan>);
        void (*shade_fragments)(const Frame<Maps>&, const ProjectedTriangle&,
                                std::span<FragmentToShade>);
    };

    explicit VisibleShaders(std::span<const EffectMask> effects);

    const Shader& operator[](std::size_t material) const { return of_material_[material]; }

  private:
    template <std::size_t... i>
    static constexpr std::array<Shader, sizeof...(i)> compiled(std::index_sequence<i...>) {
        return {Shader{&rasterbook::shade_pixels<all_permutations[i], Maps>,
                       &rasterbook::shade_fragments<all_permutations[i], Maps>}...};
    }

    std::vector<Shader> of_material_;
};

template <typename Maps>
VisibleShaders<Maps>::VisibleShaders(std::span<const EffectMask> effects) {
    constexpr auto table = compiled(std::make_index_sequence<all_permutations.size()>());
    for (const EffectMask wanted : effects) of_material_.push_back(table[permutation_of(wanted)]);
}
extern template class VisibleShaders<ShadowMapsOnDemand>;  // visible_shading.cpp

/// Draws the colours of all pixels in which a triangle is visible, each once: Eq. 13.5 says what
/// that saves. Then the tile has no triangles any more.
template <typename Maps>
void shade_visible(const Frame<Maps>& frame, const VisibleShaders<Maps>& shaders,
                   VisibilityBuffer& visible, Show show, HeatMap& heat) {
    visible.take_visible([&](const ProjectedTriangle& projected, std::span<const PixelSpan> spans) {
        shade_traced(projected.on_screen.vertices, spans, [&](std::span<const PixelSpan> some) {
            shaders[projected.triangle.material].shade_pixels(frame, projected, some);
        });
        for (const PixelSpan& span : spans) heat.add(span);
        if (show == Show::ids)
            for (const PixelSpan& span : spans)
                std::fill_n(&frame.color[span.first], span.length, color_of_triangle(projected));
    });
}

/// Gathers the transparent fragments of a triangle.
template <typename Maps>
void draw_transparent(const Frame<Maps>& frame, const ProjectedTriangle& projected,
                      const Tile& tile, const VisibleShaders<Maps>& shaders,
                      TransparentFragments& transparent, HeatMap& heat) {
    std::vector<FragmentToShade> fragments;
    for_each_nearer_fragment(frame, projected, tile, [&](const FragmentToShade& nearer) {
        fragments.push_back(nearer);
        heat.add(nearer.fragment.pixel);
    });
    shade_traced(projected.on_screen.vertices, std::span(fragments),
                 [&](std::span<FragmentToShade> some) {
                     shaders[projected.triangle.material].shade_fragments(frame, projected, some);
                 });
    for (const FragmentToShade& shaded : fragments) transparent.add(shaded.fragment);
}

}  // namespace rasterbook
