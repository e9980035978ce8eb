// SPDX-License-Identifier: MIT
/// @file
/// How many threads draw, how the picture is split among them, and who drew what: to be seen with
/// `--threads`, `--split`, `--tile` and `--show-threads`, and measured in
/// docs/accuracy/10_threading.md.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <thread>

#include "10_threading/split.hpp"
#include "common/image.hpp"
#include "common/lesson_app.hpp"

namespace rasterbook {

constexpr int most_threads = 256;

struct ThreadOptions {
    /// As many as the machine runs at once; 1 where it does not say.
    int threads =
        std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, most_threads);
    Split split = Split::tiles;
    int tile = 64;  ///< Pixels along a tile's side.
    bool show = false;

    void declare(Knobs& knobs) {
        knobs.number("--threads", threads, 1, most_threads, "How many threads draw");
        knobs.choice(
            "--split", split,
            {{"rows", Split::rows}, {"interleaved", Split::interleaved}, {"tiles", Split::tiles}},
            "What each of them draws: rows, every so many-th row, or the next free tile");
        knobs.number("--tile", tile, 8, 16384, "Pixels along a tile's side");
        knobs.flag("--show-threads", show, "Tint each pixel by the thread that drew it");
    }

    Parts parts_of(ivec2 size, std::size_t workers) const { return {split, size, workers, tile}; }
};

/// A worker's colour, linear: the hues of neighbours in number are far apart.
inline vec3 color_of(std::size_t worker) {
    constexpr std::array<vec3, 8> colors = {{{1.0f, 0.32f, 0.05f},     // orange
                                             {0.03f, 0.35f, 1.0f},     // blue
                                             {0.55f, 0.75f, 0.03f},    // lime
                                             {0.85f, 0.06f, 0.45f},    // magenta
                                             {0.02f, 0.70f, 0.55f},    // teal
                                             {1.0f, 0.70f, 0.05f},     // yellow
                                             {0.42f, 0.16f, 0.95f},    // violet
                                             {0.95f, 0.08f, 0.06f}}};  // red
    return colors[worker % colors.size()];
}

/// Gives a part of a picture its worker's colour; what is bright stays brighter than what is dark.
/// A part that is a box has a darker frame.
inline void tint(Image<vec3>& picture, const Part& part, std::size_t worker) {
    const vec3 color = color_of(worker);
    for_each_strip(part, [&](const PixelBox& strip) {
        for (int y = strip.first.y; y <= strip.last.y; ++y)
            for (int x = strip.first.x; x <= strip.last.x; ++x) {
                const bool is_frame =
                    part.row_step == 1 && (x == strip.first.x || y == strip.first.y);
                vec3& pixel = picture[{x, y}];
                const float light = glm::dot(pixel, vec3(0.2126f, 0.7152f, 0.0722f));
                pixel = (is_frame ? 0.4f : 1.0f) * (0.09f + 1.1f * light) *
                        glm::mix(color, vec3(1), std::min(0.6f * light, 0.8f));
            }
    });
}

}  // namespace rasterbook
