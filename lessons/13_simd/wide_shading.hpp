// SPDX-License-Identifier: MIT
/// @file
/// Lesson 12's two steps, several pixels at a time. Introduced in lesson 13;
/// derivation: docs/derivations/13_simd.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "05_textures/interpolation.hpp"
#include "11_scenes/blending.hpp"
#include "11_scenes/shaders.hpp"
#include "12_visibility_buffer/shadow_parts.hpp"
#include "12_visibility_buffer/visibility_buffer.hpp"
#include "12_visibility_buffer/visible_shading.hpp"
#include "13_simd/simd.hpp"
#include "13_simd/wide_shadows.hpp"
#include "13_simd/wide_textures.hpp"
#include "13_simd/wide_triangles.hpp"
#include "13_simd/width.hpp"
#include "common/app/counters.hpp"

namespace rasterbook {

/// As for_each_nearer_fragment() of lesson 12.
///
/// @param visit  Called as visit(first_pixel, nearer, on_screen, depth, opacity): for as many
/// pixels
///               of a row as F has numbers, of which those count in which the mask `nearer` holds.
template <typename F, typename Maps, typename CounterPolicy, typename Visit>
void for_each_nearer_fragment(const Frame<Maps>& frame, const ProjectedTriangle& projected,
                              const Tile& tile, TileDepths& depths, CounterPolicy& counters,
                              Visit&& visit) {
    const auto count = [&](Counter counter, MaskOf<F> mask) {
        counters.add(counter, static_cast<std::uint64_t>(count_of(mask)));
    };
    const MaterialPlan& plan = frame.assets.plan.materials[projected.triangle.material];
    const bool is_masked = plan[Effect::mask];
    std::optional<TriangleInputs> inputs;  // of the opacity, where it is not 1
    if (is_masked || plan.is_glass)
        inputs.emplace(triangle_inputs<Permutation{}>(frame, projected));
    fill_tile<F>(
        projected.on_screen, tile, [&](ivec2 pixel, MaskOf<F> covered, const Vec3<F>& on_screen) {
            count(Counter::fragments_tested, covered);
            const F depth = depth_at<F>(projected.depth, on_screen);
            MaskOf<F> nearer = covered & (depth < load<F>(depths.from(pixel)));
            F opacity(1.0f);
            if (inputs) {
                if (!any_of(nearer)) return;
                LaneCounters<CounterPolicy> lanes{counters, count_of(nearer)};
                opacity =
                    opacity_at(inputs->surface, inputs->colors,
                               perspective_correct(inputs->setup, on_screen), frame.filter, lanes);
            }
            if (is_masked) {
                count(Counter::alpha_tested_fragments, nearer);
                nearer = nearer & passes_alpha_test(opacity, inputs->surface.material.alpha_cutoff);
                opacity = F(1.0f);
            }
            visit(pixel, nearer, on_screen, depth, opacity);
        });
}

/// As draw_id() of lesson 12 (Eq. 12.1).
template <typename F, typename Maps, typename CounterPolicy>
void draw_id(const Frame<Maps>& frame, const ProjectedTriangle& projected, const Tile& tile,
             TileDepths& depths, TileVisibility& visible, CounterPolicy& counters) {
    const TriangleId id = visible.add(projected);
    const auto write = [&](ivec2 pixel, MaskOf<F> covered, F depth) {
        write_where(depths.test_and_write<F>(pixel, covered, depth), visible.ids_from(pixel), id);
    };
    if (frame.assets.plan.materials[projected.triangle.material][Effect::mask])
        for_each_nearer_fragment<F>(frame, projected, tile, depths, counters,
                                    [&](ivec2 pixel, MaskOf<F> nearer, const Vec3<F>&, F depth, F) {
                                        write(pixel, nearer, depth);
                                    });
    else {
        LaneSum<F> tested;
        fill_tile<F>(projected.on_screen, tile,
                     [&](ivec2 pixel, MaskOf<F> covered, const Vec3<F>& on_screen) {
                         tested.add(covered);
                         write(pixel, covered, depth_at<F>(projected.depth, on_screen));
                     });
        counters.add(Counter::fragments_tested, tested.total());
    }
}

/// As BarycentricPlanes of lesson 12: the same bits at several pixels, wherever they are.
template <int N>
class WidePlanes {
  public:
    /// @param triangle  As fill_triangle<F>() has it.
    explicit WidePlanes(const ScreenTriangle& triangle)
        : per_area_(static_cast<float>(1.0 / std::abs(static_cast<double>(triangle.twice_area)))) {
        const int winding = triangle.twice_area > 0 ? 1 : -1;
        for (std::size_t i = 0; i < 3; ++i) {
            const EdgeWalk edge(triangle.vertices[(i + 1) % 3], triangle.vertices[(i + 2) % 3],
                                winding, ivec2(0));
            at_origin_[i] = static_cast<double>(edge.value);
            step_x_[i] = static_cast<double>(edge.step_x);
            step_y_[i] = static_cast<double>(edge.step_y);
        }
    }

    Vec3<Floats<N>> at(Ints<N> x, Ints<N> y) const {
        const auto columns = __builtin_convertvector(x.lanes, Vector<double, N>);
        const auto rows = __builtin_convertvector(y.lanes, Vector<double, N>);
        const auto share = [&](std::size_t i) {
            return Floats<N>(__builtin_convertvector(
                at_origin_[i] + columns * step_x_[i] + rows * step_y_[i], Vector<float, N>));
        };
        return Vec3<Floats<N>>(share(0), share(1), share(2)) * Floats<N>(per_area_);
    }

  private:
    std::array<double, 3> at_origin_, step_x_, step_y_;
    float per_area_;
};

/// As shade_pixels() of lesson 12, as many pixels at a time as F has numbers (Eq. 13.4).
template <Permutation with, typename F, typename CounterPolicy>
void shade_pixels(const Frame<ShadowMapsOnDemand>& frame, const ProjectedTriangle& projected,
                  std::span<const PixelRun> runs, CounterPolicy& counters) {
    constexpr int N = width_of<F>;
    TriangleInputs triangle = triangle_inputs<with>(frame, projected);
    const WidePlanes<N> planes(projected.on_screen);
    const auto shade = [&](Ints<N> x, Ints<N> y, int count) {
        LaneCounters<CounterPolicy> lanes{counters, count};
        lanes.add(Counter::fragments_shaded);
        return shaded<with>(frame, triangle, perspective_correct(triangle.setup, planes.at(x, y)),
                            lanes);
    };
    const auto scatter = [&](Ints<N> x, Ints<N> y, int count) {
        std::array<vec3, N> colors;
        store(colors.data(), shade(x, y, count));
        for (int i = 0; i < count; ++i)
            frame.color[{x[i], y[i]}] = colors[static_cast<std::size_t>(i)];
    };
    Ints<N> x(0), y(0);  // pixels of runs that are shorter than N
    int count = 0;
    for (const PixelRun& run : runs) {
        int i = 0;
        for (; i + N <= run.length; i += N) {
            const ivec2 first = run.first + ivec2(i, 0);
            store(&frame.color[first],
                  shade(Ints<N>(first.x) + lane_numbers<N>(), Ints<N>(first.y), N));
        }
        for (; i < run.length; ++i) {
            x.set(count, run.first.x + i), y.set(count, run.first.y);
            if (++count == N) scatter(x, y, N), count = 0;
        }
    }
    if (count == 0) return;
    for (int i = count; i < N; ++i) x.set(i, x[count - 1]), y.set(i, y[count - 1]);
    scatter(x, y, count);
}

/// As shade_fragments() of lesson 12.
template <Permutation with, typename F, typename CounterPolicy>
void shade_fragments(const Frame<ShadowMapsOnDemand>& frame, const ProjectedTriangle& projected,
                     std::span<FragmentToShade> fragments, CounterPolicy& counters) {
    constexpr std::size_t N = width_of<F>;
    TriangleInputs triangle = triangle_inputs<with>(frame, projected);
    for (std::size_t first = 0; first < fragments.size(); first += N) {
        const std::span<FragmentToShade> some =
            fragments.subspan(first, std::min(N, fragments.size() - first));
        Vec3<F> on_screen;
        for (std::size_t i = 0; i < N; ++i)
            for (int v = 0; v < 3; ++v)
                on_screen[v].set(static_cast<int>(i),
                                 some[std::min(i, some.size() - 1)].on_screen[v]);
        LaneCounters<CounterPolicy> lanes{counters, static_cast<int>(some.size())};
        lanes.add(Counter::fragments_shaded);
        lanes.add(Counter::blended_fragments);
        const Vec3<F> color =
            shaded<with>(frame, triangle, perspective_correct(triangle.setup, on_screen), lanes);
        for (std::size_t i = 0; i < some.size(); ++i) {
            const int lane = static_cast<int>(i);
            some[i].fragment.color = {color.x[lane], color.y[lane], color.z[lane]};
        }
    }
}

/// As draw_transparent() of lesson 12.
template <typename F, typename CounterPolicy>
void draw_transparent(const Frame<ShadowMapsOnDemand>& frame, const ProjectedTriangle& projected,
                      const Tile& tile, TileDepths& depths,
                      const VisibleShaders<ShadowMapsOnDemand, CounterPolicy>& shaders,
                      TransparentFragments& transparent, HeatMap& heat, CounterPolicy& counters) {
    std::vector<FragmentToShade> fragments;
    for_each_nearer_fragment<F>(
        frame, projected, tile, depths, counters,
        [&](ivec2 first, MaskOf<F> nearer, const Vec3<F>& on_screen, F depth, F opacity) {
            for (int i = 0; i < width_of<F>; ++i) {
                if (!lane_of(nearer, i)) continue;
                const ivec2 pixel = first + ivec2(i, 0);
                fragments.push_back(
                    {{pixel, lane_of(depth, i), lane_of(opacity, i), vec3(0)},
                     {lane_of(on_screen.x, i), lane_of(on_screen.y, i), lane_of(on_screen.z, i)}});
                heat.add(pixel);
            }
        });
    shaders[projected.triangle.material].shade_fragments(frame, projected, fragments, counters);
    for (const FragmentToShade& shaded : fragments) transparent.add(shaded.fragment);
}

/// The functions for as many pixels as F has numbers.
template <typename F, typename CounterPolicy>
WideDrawing<CounterPolicy> drawing_by() {
    using Drawing = WideDrawing<CounterPolicy>;
    using Maps = ShadowMapsOnDemand;
    Drawing drawing{&draw_id<F, Maps, CounterPolicy>, &draw_transparent<F, CounterPolicy>,
                    Drawing::Shaders::one_by_one};
    if constexpr (width_of<F> > 1)
        [&]<std::size_t... i>(std::index_sequence<i...>) {
            drawing.shaders = {typename Drawing::Shaders::Shader{
                &shade_pixels<all_permutations[i], F, CounterPolicy>,
                &shade_fragments<all_permutations[i], F, CounterPolicy>}...};
        }(std::make_index_sequence<all_permutations.size()>());
    return drawing;
}

template <int N>
WideDrawing<Counters> drawing_of_width() {
    return drawing_by<std::conditional_t<N == 1, float, Floats<N>>, Counters>();
}

}  // namespace rasterbook
