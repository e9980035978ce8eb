// SPDX-License-Identifier: MIT
/// @file
/// The colours of several pixels of a triangle at once. Introduced in lesson 13.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "11_scenes/shaders.hpp"
#include "12_visibility_buffer/visible_shading.hpp"
#include "13_simd/wide_raster.hpp"
#include "13_simd/wide_sampling.hpp"

namespace rasterbook {

/// As shade_pixels() of lesson 12, N pixels at a time.
template <Permutation with, int N, typename CounterPolicy>
void shade_pixels_wide(const Frame<ShadowMapsOnDemand>& frame, const ProjectedTriangle& projected,
                       std::span<const PixelRun> runs, CounterPolicy& counters) {
    using F = Floats<N>;
    TriangleInputs triangle = triangle_inputs<with>(frame, projected);
    const BarycentricPlanes planes(projected.on_screen);
    std::array<ivec2, N> pixels;
    std::array<std::array<float, N>, 3> on_screen;
    int count = 0;
    const auto shade = [&] {
        for (int i = count; i < N; ++i)
            for (std::size_t v = 0; v < 3; ++v)
                on_screen[v][static_cast<std::size_t>(i)] = on_screen[v][static_cast<std::size_t>(count - 1)];
        LaneCounters<CounterPolicy> of_lanes{counters, count};
        of_lanes.add(Counter::fragments_shaded);
        Vec3<F> at;
        for (int v = 0; v < 3; ++v)
            std::memcpy(&at[v], &on_screen[static_cast<std::size_t>(v)], sizeof(F));
        const Vec3<F> color =
            shaded<with>(frame, triangle, perspective_correct(triangle.setup, at), of_lanes);
        for (int i = 0; i < count; ++i)
            frame.color[pixels[static_cast<std::size_t>(i)]] = {color.x[i], color.y[i], color.z[i]};
        count = 0;
    };
    for (const PixelRun& run : runs)
        planes.for_each_in(run, [&](ivec2 pixel, Barycentrics at) {
            pixels[static_cast<std::size_t>(count)] = pixel;
            for (int v = 0; v < 3; ++v)
                on_screen[static_cast<std::size_t>(v)][static_cast<std::size_t>(count)] = at[v];
            if (++count == N) shade();
        });
    if (count > 0) shade();
}

/// As draw_id() of lesson 12.
template <int N, typename Maps, typename CounterPolicy>
void draw_id_wide(const Frame<Maps>& frame, const ProjectedTriangle& projected, const Tile& tile,
                  TileVisibility& visible, CounterPolicy& counters) {
    if (frame.assets.plan.materials[projected.triangle.material][Effect::mask])
        std::abort();
    const TriangleId id = visible.add(projected);
    using Ids = Vector<TriangleId, N>;
    fill_tile_wide<N>(projected.on_screen, tile,
                      [&](ivec2 first, Mask<N> covered, const Vec3<Floats<N>>& on_screen) {
                          count_lanes(counters, Counter::fragments_tested, covered);
                          const Mask<N> nearer = test_and_write_wide<N>(
                              visible.depths_from(first), covered, projected.depth.at(on_screen));
                          TriangleId* const ids = visible.ids_from(first);
                          Ids before;
                          std::memcpy(&before, ids, sizeof before);
                          const auto is = std::bit_cast<Ids>(nearer.lanes);
                          const Ids now = (is & id) | (~is & before);
                          std::memcpy(ids, &now, sizeof now);
                      });
}

template <int N, typename CounterPolicy>
class WideShaders {
  public:
    using Maps = ShadowMapsOnDemand;
    struct Shader {
        void (*shade_pixels)(const Frame<Maps>&, const ProjectedTriangle&,
                             std::span<const PixelRun>, CounterPolicy&);
        void (*shade_fragments)(const Frame<Maps>&, const ProjectedTriangle&,
                                std::span<FragmentToShade>, CounterPolicy&);
    };
    explicit WideShaders(const ScenePlan& plan) {
        for (const MaterialPlan& material : plan.materials)
            of_material_.push_back(table[permutation_of(material)]);
    }
    const Shader& operator[](std::size_t material) const { return of_material_[material]; }

  private:
    template <std::size_t... i>
    static constexpr std::array<Shader, sizeof...(i)> compiled(std::index_sequence<i...>) {
        return {Shader{&rasterbook::shade_pixels_wide<all_permutations[i], N, CounterPolicy>,
                       &rasterbook::shade_fragments<all_permutations[i], Maps, CounterPolicy>}...};
    }
    static constexpr auto table = compiled(std::make_index_sequence<all_permutations.size()>());
    std::vector<Shader> of_material_;
};

}  // namespace rasterbook
