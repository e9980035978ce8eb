// SPDX-License-Identifier: MIT
/// @file
/// Weights and textures' colours of many fragments at once: the same steps as for one, and the same
/// bits. Introduced in lesson 06.
#pragma once

#include <array>
#include <cstddef>

#include "05_textures/interpolation.hpp"
#include "05_textures/texture.hpp"
#include "06_phong/fragments.hpp"
#include "06_phong/lit_points.hpp"

namespace rasterbook {

/// FragmentWeights of up to most_points fragments, number by number.
struct ManyWeights {
    std::size_t count = 0;
    Vectors here, step_x, step_y;

    FragmentWeights operator[](std::size_t i) const { return {here[i], step_x[i], step_y[i]}; }
    void set(std::size_t i, const FragmentWeights& weights) {
        here.set(i, weights.here), step_x.set(i, weights.step_x), step_y.set(i, weights.step_y);
    }
};

/// The weights on the surface of all fragments.
inline ManyWeights weights_of(const ManyFragments& fragments,
                              const PerspectiveWeights& perspective) {
    const PerspectiveWeights at = perspective;  // a copy, which no step of the loop can change
    ManyWeights weights;
    weights.count = fragments.count;
    for (std::size_t i = 0; i < fragments.count; ++i)
        weights.set(i, at.at(fragments.screen_weights[i]));
    return weights;
}

/// What sample() gives for each of many fragments.
///
/// @param uvs   Of the triangle's corners.
/// @param take  Called as take(i, color) for each fragment, in order.
template <typename Take>
void sample_many(const Texture& texture, Filter filter, const std::array<vec2, 3>& uvs,
                 const ManyWeights& weights, Take&& take) {
    const std::size_t count = weights.count;
    const std::array corners = uvs;
    const Wrap wrap = texture.wrap;
    Numbers x, y;
    for (std::size_t i = 0; i < count; ++i) {
        const vec2 place = place_from_uv(interpolate(corners, weights.here[i]), wrap);
        x[i] = place.x, y[i] = place.y;
    }
    const TextureLevel& finest = texture.levels[0];
    if (filter == Filter::nearest)
        for (std::size_t i = 0; i < count; ++i) take(i, sample_nearest(finest, {x[i], y[i]}));
    if (filter == Filter::bilinear)
        for (std::size_t i = 0; i < count; ++i) take(i, sample_bilinear(finest, {x[i], y[i]}));
    if (filter != Filter::trilinear) return;
    for (std::size_t i = 0; i < count; ++i) {
        const float level = level_of_detail(interpolate(corners, weights.step_x[i]),
                                            interpolate(corners, weights.step_y[i]), finest.size);
        take(i, sample_trilinear(texture, {x[i], y[i]}, level));
    }
}

}  // namespace rasterbook
