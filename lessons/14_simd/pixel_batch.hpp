// SPDX-License-Identifier: MIT
/// @file
/// Pixels that are shaded together, one in each lane. Introduced in lesson 14;
/// derivation: docs/derivations/14_simd.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "02_triangle_fill/triangle.hpp"
#include "05_textures/interpolation.hpp"
#include "13_visibility_buffer/shaded.hpp"
#include "13_visibility_buffer/shadow_parts.hpp"
#include "13_visibility_buffer/visibility_buffer.hpp"
#include "14_simd/simd.hpp"
#include "14_simd/wide_shadows.hpp"
#include "14_simd/wide_textures.hpp"
#include "common/app/counters.hpp"

namespace rasterbook {

/// Barycentric coordinates at several pixels, wherever they are: the bits of lesson 13 (Eq. 13.2).
template <int N>
class WideBarycentricPlanes {
  public:
    /// @param triangle  As fill_triangle<F>() takes it: then the doubles are exact.
    explicit WideBarycentricPlanes(const ScreenTriangle& triangle)
        : inv_area_(static_cast<float>(1.0 / std::abs(static_cast<double>(triangle.twice_area)))) {
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
        return Vec3<Floats<N>>(share(0), share(1), share(2)) * Floats<N>(inv_area_);
    }

  private:
    std::array<double, 3> at_origin_, step_x_, step_y_;
    float inv_area_;
};

/// What a shader has to know of the triangles, each lane of its own one. All are of one mesh and
/// one material.
template <Permutation with, int N>
struct LaneInputs {
    using F = Floats<N>;
    SurfaceInputs<F> surface;
    ColorInputs<F> colors;
    NormalMapInputs<F> normal_map;
    LaneBiasCaches<N> shadow_biases;

    /// @param triangle  Any of them: what they have in common is taken from it.
    explicit LaneInputs(const TriangleInputs& triangle)
        : surface{.material = triangle.surface.material,
                  .effects = triangle.surface.effects,
                  .texture = triangle.surface.texture,
                  .specular_texture = triangle.surface.specular_texture,
                  .emission_texture = triangle.surface.emission_texture,
                  .own_color = triangle.surface.own_color,
                  .positions_world = {},
                  .normals_world = {}},
          colors{triangle.colors.are_there},
          normal_map{.texture = triangle.normal_map.texture,
                     .space = triangle.normal_map.space,
                     .bump_multiplier = triangle.normal_map.bump_multiplier} {}

    /// Gives a triangle's own inputs to some lanes: as many as shading reads.
    ///
    /// @param slot  0 to N: the triangle's number among those that lanes have.
    void set(Mask<N> lanes, TriangleInputs& triangle, int slot) {
        const TriangleSurface& own = triangle.surface;
        if (own.effects[Effect::texture]) blend(lanes, surface.uvs, own.uvs);
        if (own.effects[Effect::specular_map]) blend(lanes, surface.specular_uvs, own.specular_uvs);
        if (own.effects[Effect::emission_map]) blend(lanes, surface.emission_uvs, own.emission_uvs);
        if (colors.are_there) blend(lanes, colors.of_vertices, triangle.colors.of_vertices);
        if constexpr (with.model != ShadingModel::unlit) {
            blend(lanes, surface.positions_world, own.positions_world);
            blend(lanes, surface.normals_world, own.normals_world);
        }
        if constexpr (with.normal_map) {
            const TriangleNormalMap& map = triangle.normal_map;
            blend(lanes, normal_map.side, map.side);
            blend(lanes, normal_map.uvs, map.uvs);
            blend(lanes, normal_map.tangents, map.tangents);
            blend(lanes, normal_map.handedness, map.handedness);
        }
        if constexpr (with.shadow) shadow_biases.set(lanes, triangle.shadow_biases, slot);
    }
};

/// A triangle of which a batch has pixels.
template <Permutation with, int N>
struct BatchTriangle {
    TriangleInputs inputs;
    WideBarycentricPlanes<N> planes;

    BatchTriangle(const Frame<ShadowMapsOnDemand>& frame, const ProjectedTriangle& triangle)
        : inputs(triangle_inputs(with, frame, triangle)), planes(triangle.on_screen) {}
};

/// Pixels that are shaded together, one in each lane: of one triangle, or of several that are of
/// one mesh and one material (Eq. 14.4).
template <Permutation with, typename F>
class PixelBatch {
  public:
    PixelBatch(const Frame<ShadowMapsOnDemand>& frame, const ProjectedTriangle& first)
        : frame_(frame), inputs_((begin(first), current().inputs)) {}

    /// The pixels that are added from now on are this triangle's.
    void begin(const ProjectedTriangle& triangle) {
        end_triangle();
        slot_ = (slot_ + 1) % triangles_.size();
        triangles_[slot_].emplace(frame_, triangle);
        is_in_all_lanes_ = false;
    }

    /// Adds pixels; whenever the batch is full, it is shaded, and another begins.
    void add(const PixelSpan& span) {
        for (int i = 0; i < span.length;) {
            const ivec2 first = span.first + ivec2(i, 0);
            const int added = std::min(span.length - i, N - count_);
            fill_up(Ints<N>(first.x - count_) + lane_numbers<N>(), Ints<N>(first.y));
            count_ += added, i += added;
            if (added == N)
                store(&frame_.color[first], shade());  // they are neighbours
            else if (count_ == N)
                shade_and_scatter();
        }
    }

    /// Shades what is left. The lanes that are left over repeat the last pixel.
    void finish() {
        if (count_ == 0) return;
        fill_up(Ints<N>(x_[count_ - 1]), Ints<N>(y_[count_ - 1]));
        shade_and_scatter();
    }

  private:
    static constexpr int N = width_of<F>;

    BatchTriangle<with, N>& current() { return *triangles_[slot_]; }

    /// Gives columns and rows to the lanes behind the pixels that are there already.
    void fill_up(Ints<N> x, Ints<N> y) {
        const Mask<N> empty = !first_lanes<F>(count_);
        x_ = select(empty, x, x_), y_ = select(empty, y, y_);
    }

    /// Gives the triangle's lanes their coordinates in it, and its inputs. The empty lanes behind
    /// them get these, too; what comes next overwrites them.
    void end_triangle() {
        if (first_ == count_) return;
        const PerspectiveBarycentrics<F> at =
            perspective_correct(current().inputs.setup, current().planes.at(x_, y_));
        const Mask<N> own = !first_lanes<F>(first_);
        at_ = {select(own, at.here, at_.here), select(own, at.ddx, at_.ddx),
               select(own, at.ddy, at_.ddy)};
        if (!is_in_all_lanes_) inputs_.set(own, current().inputs, static_cast<int>(slot_));
        is_in_all_lanes_ = first_ == 0;
        first_ = count_;
    }

    Vec3<F> shade() {
        end_triangle();
        fragments_at_once = static_cast<std::uint64_t>(count_);
        count_each<F>(Counter::fragments_shaded);
        const Vec3<F> colors = shaded_lanes();
        count_ = first_ = 0;
        return colors;
    }

    Vec3<F> shaded_lanes() {
        if constexpr (with.model == ShadingModel::unlit)
            return unlit_colors();
        else
            return shaded<with>(frame_, inputs_, at_, samples());
    }

    /// The samples of the colour texture: of a material with holes, draw_id() has kept them in the
    /// picture.
    Vec3<F> samples() const {
        if (!inputs_.surface.effects[Effect::mask])
            return Vec3<F>(texture_sample(inputs_.surface, at_, frame_.filter));
        Vec3<F> kept(F(0.0f));
        for (int i = 0; i < count_; ++i) set_lane(kept, i, frame_.color[{x_[i], y_[i]}]);
        return kept;
    }

    /// All in one function, as sample(). With lights, that would take the compiler too long.
    [[gnu::flatten]] Vec3<F> unlit_colors() {
        return shaded<Permutation{}>(frame_, inputs_, at_, samples());
    }

    void shade_and_scatter() {
        const int count = count_;
        std::array<vec3, N> colors;
        store(colors.data(), shade());
        for (int i = 0; i < count; ++i)
            frame_.color[{x_[i], y_[i]}] = colors[static_cast<std::size_t>(i)];
    }

    const Frame<ShadowMapsOnDemand>& frame_;
    Ints<N> x_{0}, y_{0};        ///< Of the pixels.
    int count_ = 0, first_ = 0;  ///< So many pixels; the first one of the current triangle.
    /// The current triangle, and those that pixels of the batch are of.
    std::array<std::optional<BatchTriangle<with, N>>, N + 1> triangles_;
    std::size_t slot_ = 0;
    bool is_in_all_lanes_ = false;  ///< The current triangle, in inputs_.
    PerspectiveBarycentrics<F> at_{};
    LaneInputs<with, N> inputs_;
};

}  // namespace rasterbook
