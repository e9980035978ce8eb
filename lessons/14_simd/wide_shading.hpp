// SPDX-License-Identifier: MIT
/// @file
/// Lesson 13's two steps, several pixels at a time. Introduced in lesson 14;
/// derivation: docs/derivations/14_simd.md.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "05_textures/interpolation.hpp"
#include "11_scenes/blending.hpp"
#include "11_scenes/opacity.hpp"
#include "12_effects/permutation.hpp"
#include "13_visibility_buffer/shadow_parts.hpp"
#include "13_visibility_buffer/visibility_buffer.hpp"
#include "13_visibility_buffer/visible_shading.hpp"
#include "14_simd/pixel_batch.hpp"
#include "14_simd/simd.hpp"
#include "14_simd/wide_setup.hpp"
#include "14_simd/wide_shadows.hpp"
#include "14_simd/wide_textures.hpp"
#include "14_simd/wide_triangles.hpp"
#include "14_simd/width.hpp"
#include "common/app/counters.hpp"

namespace rasterbook {

/// Notes for `--probe` that depths are compared, of as many pixels of a row as F has numbers.
template <typename F>
void trace_lane_depth(TileDepths& depths, ivec2 pixel, const F& depth) {
    if constexpr (has_probe)
        if (is_traced()) trace_depth(depths.from(pixel)[pixel_trace->lane], traced_lane(depth));
}

/// Visits the fragments of a triangle in a tile that are nearer than what is there, but for holes.
///
/// @param visit  Called as visit(first_pixel, nearer, on_screen, depth, opacity, in_texture): for
///               as many pixels of a row as F has numbers. Those count for which the mask `nearer`
///               holds.
template <typename F, typename Maps, typename Visit>
void for_each_nearer_fragment(const Frame<Maps>& frame, const ProjectedTriangle& projected,
                              const Tile& tile, TileDepths& depths, Visit&& visit) {
    const auto count_where = [](Counter counter, MaskOf<F> mask) {
        count(counter, static_cast<std::uint64_t>(count_of(mask)));
    };
    const bool is_masked = frame.assets.effects[projected.triangle.material][Effect::mask];
    const AlphaInputs inputs = alpha_inputs(frame.assets, projected);
    const TracedFill traced(projected.on_screen.vertices);
    fill_tile<F>(
        projected.on_screen, tile, [&](ivec2 pixel, MaskOf<F> covered, const Vec3<F>& on_screen) {
            const TracedFragment fragment(traced, pixel, width_of<F>,
                                          [&](int i) { return lane_of(covered, i); });
            count_where(Counter::fragments_tested, covered);
            const F depth = depth_at<F>(projected.depth, on_screen);
            trace_lane_depth(depths, pixel, depth);
            MaskOf<F> nearer = covered & (depth > load<F>(depths.from(pixel)));
            if (!any_of(nearer)) return;
            fragments_at_once = static_cast<std::uint64_t>(count_of(nearer));
            const PerspectiveBarycentrics<F> at = perspective_correct(inputs.setup, on_screen);
            const glm::vec<4, F> in_texture = texture_sample(inputs.surface, at, frame.filter);
            F opacity = opacity_at(inputs.surface, inputs.colors, at.here, in_texture);
            if (is_masked) {
                count_where(Counter::alpha_tested_fragments, nearer);
                const float cutoff = inputs.surface.material.alpha_cutoff;
                nearer = nearer & passes_alpha_test(opacity, cutoff);
                if (is_traced() && !lane_of(nearer, pixel_trace->lane))
                    trace_hole(traced_lane(opacity), cutoff);
                opacity = F(1.0f);
            }
            visit(pixel, nearer, on_screen, depth, opacity, Vec3<F>(in_texture));
        });
}

/// Draws a triangle's depths and its id into a tile (Eq. 13.1).
template <typename F, typename Maps>
void draw_id(const Frame<Maps>& frame, const ProjectedTriangle& projected, const Tile& tile,
             TileDepths& depths, VisibilityBuffer& visible) {
    const TriangleId id = visible.add(projected);
    const auto write = [&](ivec2 pixel, MaskOf<F> covered, F depth) {
        const MaskOf<F> nearer = depths.test_and_write<F>(pixel, covered, depth);
        write_where(nearer, visible.ids_from(pixel), id);
        return nearer;
    };
    if (frame.assets.effects[projected.triangle.material][Effect::mask])
        for_each_nearer_fragment<F>(
            frame, projected, tile, depths,
            [&](ivec2 pixel, MaskOf<F> nearer, auto&, F depth, F, const Vec3<F>& in_texture) {
                const MaskOf<F> written = write(pixel, nearer, depth);
                for (int i = 0; i < width_of<F>; ++i)
                    if (lane_of(written, i))
                        frame.color[pixel + ivec2(i, 0)] = lane_of(in_texture, i);
            });
    else {
        LaneSum<F> tested;
        const TracedFill traced(projected.on_screen.vertices);
        fill_tile<F>(projected.on_screen, tile,
                     [&](ivec2 pixel, MaskOf<F> covered, const Vec3<F>& on_screen) {
                         const TracedFragment fragment(traced, pixel, width_of<F>,
                                                       [&](int i) { return lane_of(covered, i); });
                         tested.add(covered);
                         const F depth = depth_at<F>(projected.depth, on_screen);
                         trace_lane_depth(depths, pixel, depth);
                         write(pixel, covered, depth);
                     });
        count(Counter::fragments_tested, tested.total());
    }
}

/// A triangle of a tile, and the pixels in which it is visible.
struct VisibleTriangle {
    const ProjectedTriangle* triangle;
    std::span<const PixelSpan> spans;
};

/// Draws the colours of pixels, of triangles of one mesh and one material.
template <Permutation with, typename F>
void shade_pixels(const Frame<ShadowMapsOnDemand>& frame,
                  std::span<const VisibleTriangle> visible) {
    if constexpr (width_of<F> == 1) {
        for (const auto& [triangle, spans] : visible) shade_pixels<with>(frame, *triangle, spans);
    } else {
        PixelBatch<with, F> batch(frame, *visible.front().triangle);
        for (const auto& [triangle, spans] : visible) {
            if (triangle != visible.front().triangle) batch.begin(*triangle);
            for (const PixelSpan& span : spans) batch.add(span);
        }
        batch.finish();
    }
}

/// Finds the colours of a triangle's transparent fragments.
template <Permutation with, typename F>
void shade_fragments(const Frame<ShadowMapsOnDemand>& frame, const ProjectedTriangle& projected,
                     std::span<FragmentToShade> fragments) {
    if constexpr (width_of<F> == 1) {
        shade_fragments<with>(frame, projected, fragments);
    } else {
        constexpr std::size_t N = width_of<F>;
        TriangleInputs triangle = triangle_inputs(with, frame, projected);
        LaneInputs<with, N> inputs(triangle);
        inputs.set(first_lanes<F>(N), triangle, 0);
        for (std::size_t first = 0; first < fragments.size(); first += N) {
            const std::span<FragmentToShade> some =
                fragments.subspan(first, std::min(N, fragments.size() - first));
            Vec3<F> on_screen, in_texture;
            for (std::size_t i = 0; i < N; ++i) {
                const FragmentToShade& of = some[std::min(i, some.size() - 1)];
                set_lane(on_screen, static_cast<int>(i), of.on_screen);
                set_lane(in_texture, static_cast<int>(i), of.fragment.color);
            }
            fragments_at_once = some.size();
            count_each<F>(Counter::fragments_shaded);
            std::array<vec3, N> colors;
            store(colors.data(),
                  shaded<with>(frame, inputs, perspective_correct(triangle.setup, on_screen),
                               in_texture));
            for (std::size_t i = 0; i < some.size(); ++i) some[i].fragment.color = colors[i];
        }
    }
}

/// A permutation's shade_pixels() and shade_fragments().
struct WideShader {
    void (*shade_pixels)(const Frame<ShadowMapsOnDemand>&, std::span<const VisibleTriangle>);
    void (*shade_fragments)(const Frame<ShadowMapsOnDemand>&, const ProjectedTriangle&,
                            std::span<FragmentToShade>);
};

template <typename F>
WideShader shader_of(const Frame<ShadowMapsOnDemand>& frame, const ProjectedTriangle& projected) {
    constexpr auto shaders = []<std::size_t... i>(std::index_sequence<i...>) {
        return std::array{WideShader{&rasterbook::shade_pixels<all_permutations[i], F>,
                                     &rasterbook::shade_fragments<all_permutations[i], F>}...};
    }(std::make_index_sequence<all_permutations.size()>());
    return shaders[permutation_of(frame.assets.effects[projected.triangle.material])];
}

/// Gathers the transparent fragments of a triangle.
template <typename F>
void draw_transparent(const Frame<ShadowMapsOnDemand>& frame, const ProjectedTriangle& projected,
                      const Tile& tile, TileDepths& depths, TransparentFragments& transparent,
                      HeatMap& heat) {
    std::vector<FragmentToShade> fragments;
    for_each_nearer_fragment<F>(
        frame, projected, tile, depths,
        [&](ivec2 first, MaskOf<F> nearer, const Vec3<F>& on_screen, F depth, F opacity,
            const Vec3<F>& in_texture) {
            for (int i = 0; i < width_of<F>; ++i) {
                if (!lane_of(nearer, i)) continue;
                const ivec2 pixel = first + ivec2(i, 0);
                fragments.push_back(
                    {{pixel, lane_of(depth, i), lane_of(opacity, i), lane_of(in_texture, i)},
                     lane_of(on_screen, i)});
                heat.add(pixel);
            }
        });
    shade_traced(projected.on_screen.vertices, std::span(fragments),
                 [&](std::span<FragmentToShade> some) {
                     shader_of<F>(frame, projected).shade_fragments(frame, projected, some);
                 });
    for (const FragmentToShade& shaded : fragments) transparent.add(shaded.fragment);
}

/// Whether two triangles are of one mesh and one material.
inline bool are_alike(const ProjectedTriangle& a, const ProjectedTriangle& b) {
    return &a.mesh == &b.mesh && a.triangle.material == b.triangle.material;
}

/// The colour of all of a triangle's pixels, if there is one: its material is unlit, and has
/// neither textures nor vertex colours.
inline std::optional<vec3> flat_color(const Frame<ShadowMapsOnDemand>& frame,
                                      const ProjectedTriangle& projected) {
    const EffectMask effects = frame.assets.effects[projected.triangle.material];
    if (all_permutations[permutation_of(effects)].model != ShadingModel::unlit ||
        effects[Effect::texture] || effects[Effect::emission_map] ||
        vertex_colors(projected).are_there)
        return std::nullopt;
    return unlit(surface_color(frame.assets.scene.materials[projected.triangle.material]));
}

/// Triangles of one colour that follow each other.
struct FlatTriangles {
    TriangleId first, end;
    vec3 color;
};

/// Draws the colours of a tile if each of its triangles has one: then there is nothing to compute.
///
/// @return  Whether they have.
template <typename F>
bool fill_flat(const Frame<ShadowMapsOnDemand>& frame, VisibilityBuffer& visible) {
    std::vector<FlatTriangles> flat;
    std::vector<std::size_t> flat_of;  // by id
    for (const ProjectedTriangle* before = nullptr;
         const ProjectedTriangle* triangle : visible.triangles()) {
        const auto id = static_cast<TriangleId>(flat_of.size());
        if (before == nullptr || !are_alike(*before, *triangle)) {
            const std::optional<vec3> color = flat_color(frame, *triangle);
            if (!color) return false;
            flat.push_back({id, id, *color});
        }
        flat.back().end = id + 1;
        flat_of.push_back(flat.size() - 1);
        before = triangle;
    }
    constexpr int N = width_of<F>;
    std::uint64_t filled = 0;
    const auto [tile, row_step] = visible.tile();
    const int width = tile.last.x - tile.first.x + 1;
    for (int y = tile.first.y; !flat.empty() && y <= tile.last.y; y += row_step) {
        const TriangleId* const ids = visible.ids_from({tile.first.x, y});
        vec3* const pixels = &frame.color[{tile.first.x, y}];
        for (int x = 0; x < width;) {
            if (ids[x] == no_triangle) {
                ++x;
                continue;
            }
            const auto& [first, end, color] = flat[flat_of[ids[x]]];
            if (are_within<N>(ids + x, first, end)) {  // behind a row there is no triangle
                fill<F>(pixels + x, N, color);
                x += N, filled += N;
            } else {
                pixels[x++] = color, ++filled;
            }
        }
    }
    count(Counter::fragments_shaded, filled);
    return true;
}

/// Draws the colours of all pixels in which a triangle is visible, each once.
template <typename F>
void shade_visible(const Frame<ShadowMapsOnDemand>& frame, VisibilityBuffer& visible, Show show,
                   HeatMap& heat) {
    if constexpr (width_of<F> > 1)
        if (show == Show::picture && !is_probing() && fill_flat<F>(frame, visible))
            return visible.clear();
    std::vector<VisibleTriangle> triangles;
    visible.take_visible([&](const ProjectedTriangle& triangle, std::span<const PixelSpan> spans) {
        triangles.push_back({&triangle, spans});
    });
    for (auto begin = triangles.begin(), end = begin; begin != triangles.end(); begin = end) {
        const WideShader shader = shader_of<F>(frame, *begin->triangle);
        while (end != triangles.end() && are_alike(*begin->triangle, *end->triangle)) ++end;
        if (!is_probing()) {
            shader.shade_pixels(frame, {begin, end});
            continue;
        }
        for (const auto& [triangle, spans] : std::span(begin, end))
            shade_traced(triangle->on_screen.vertices, spans, [&](auto some) {
                const VisibleTriangle alone{triangle, some};
                shader.shade_pixels(frame, {&alone, 1});
            });
    }
    for (const auto& [triangle, spans] : triangles)
        for (const PixelSpan& span : spans) {
            heat.add(span);
            if (show == Show::ids)
                std::fill_n(&frame.color[span.first], span.length, color_of_triangle(*triangle));
        }
}

/// The functions for as many pixels as F has numbers.
template <typename F>
WideDrawing drawing_by() {
    return {&project_triangles<F>, &draw_id<F, ShadowMapsOnDemand>, &shade_visible<F>,
            &draw_transparent<F>};
}

template <int N>
WideDrawing drawing_of_width() {
    return drawing_by<std::conditional_t<N == 1, float, Floats<N>>>();
}

}  // namespace rasterbook
