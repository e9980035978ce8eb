// SPDX-License-Identifier: MIT
/// @file
/// What `--probe` notes when a texture is sampled.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "common/image/image.hpp"
#include "common/probe/pixel_trace.hpp"

namespace rasterbook {

[[gnu::cold, gnu::noinline]] inline void note_perspective(vec3 on_surface) {
    if (pixel_trace->has_line("perspective-correct")) return;
    const vec3 inverse_w = pixel_trace->inverse_w();
    trace("1/w of a, b, c",
          words(inverse_w.x) + ' ' + words(inverse_w.y) + ' ' + words(inverse_w.z), "Eq. 5.2");
    trace("perspective-correct", on_surface, "Eq. 5.3");
}

/// Notes barycentric coordinates on a surface, once for each fragment.
template <typename F>
void trace_perspective(const glm::vec<3, F>& on_surface) {
    if constexpr (has_probe)
        if (is_traced()) note_perspective(traced_lane(on_surface));
}

template <typename Texture, typename Filter, typename Uv>
vec4 sample_untraced(const Texture& texture, Filter filter, const Uv& uv) {
    const Untraced again;
    return sample(texture, filter, uv);
}

/// Notes which texels a sample is made of.
///
/// A texel's weight is what the sampler makes of a texture that is 1 in this texel and 0 elsewhere;
/// its four channels stand for four texels.
template <typename Texture, typename Filter, typename Uv>
void note_texels(const Texture& texture, Filter filter, const Uv& uv, vec2 position,
                 std::size_t finest, std::size_t coarsest) {
    Texture marked{texture.wrap, {}};
    for (std::size_t i = 0; i < texture.levels.size(); ++i) {
        const bool is_read = i == 0 || (i >= finest && i <= coarsest);
        const ivec2 size = is_read ? texture.levels[i].size : ivec2(1);
        marked.levels.push_back({size, Image<vec4>(size + 2, vec4(0))});
    }
    constexpr float least_shown = 0.01f;
    const char* equation = filter == Filter::nearest ? "" : "Eq. 5.6";
    float rest = 1;
    for (std::size_t i = finest; i <= coarsest; ++i) {
        const auto& level = texture.levels[i];
        const ivec2 first = glm::clamp(ivec2(position * vec2(level.size) + 0.5f), ivec2(0),
                                       level.size);  // of four, counted from the border's
        const auto texel = [&](int channel) { return first + ivec2(channel % 2, channel / 2); };
        for (int k = 0; k < 4; ++k) marked.levels[i].texels[texel(k)][k] = 1;
        const vec4 weights = sample_untraced(marked, filter, uv);
        for (int k = 0; k < 4; ++k) {
            marked.levels[i].texels[texel(k)] = vec4(0);
            if (!(weights[k] >= least_shown)) continue;
            rest -= weights[k];
            trace("  texel",
                  words(vec3(level.texels[texel(k)])) + " times " + words(weights[k], 2) + ", at " +
                      words(texel(k) - 1) + " of level " + std::to_string(i),
                  equation);
            equation = "";
        }
    }
    if (!(std::abs(rest) < 0.001f)) trace("  other texels", "times " + words(rest, 2));
}

/// Notes how a texture is sampled.
///
/// @param position  In the texture.
/// @param level     Of detail; with trilinear filtering.
template <typename Texture, typename Filter, typename Uv>
[[gnu::cold, gnu::noinline]] void note_sample(const Texture& texture, Filter filter, Uv uv,
                                              vec2 position, float level) {
    const ivec2 size = texture.levels[0].size;
    trace(pixel_trace->take_label("texture").c_str(),
          std::to_string(size.x) + 'x' + std::to_string(size.y) + " texels");
    trace("  uv", uv.here, "Eq. 5.1");
    trace("  in the texture", position, "Eq. 5.4 and 5.5");
    std::size_t finest = 0, coarsest = 0;
    if (filter == Filter::trilinear) {
        const std::size_t last = texture.levels.size() - 1;
        finest = static_cast<std::size_t>(std::clamp(level, 0.0f, static_cast<float>(last)));
        coarsest = std::min(finest + 1, last);
        trace("  mip level", words(level) + " of 0 to " + std::to_string(last), "Eq. 5.8");
    }
    note_texels(texture, filter, uv, position, finest, coarsest);
    trace("  sample", vec3(sample_untraced(texture, filter, uv)),
          filter == Filter::trilinear ? "Eq. 5.10" : "");
}

template <typename Texture, typename Filter, typename Uv>
void trace_sample(const Texture& texture, Filter filter, const Uv& uv, vec2 position, float level) {
    if constexpr (has_probe)
        if (is_traced()) note_sample(texture, filter, uv, position, level);
}

/// Says what the texture is that is sampled next.
inline void label_sample(const char* name) {
    if constexpr (has_probe)
        if (is_traced()) pixel_trace->label_next(name);
}

}  // namespace rasterbook
