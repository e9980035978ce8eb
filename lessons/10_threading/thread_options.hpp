// SPDX-License-Identifier: MIT
/// @file
/// How many threads draw, how the picture is split among them, and who drew what: `--threads`,
/// `--split`, `--tile` and `--show-threads`; measured in docs/accuracy/10_threading.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <glm/trigonometric.hpp>

#include "09_shadow_maps/assets.hpp"
#include "10_threading/split.hpp"
#include "10_threading/thread_pool.hpp"
#include "common/app/lesson_app.hpp"
#include "common/app/threads.hpp"
#include "common/image/image.hpp"

namespace rasterbook {

struct ThreadOptions {
    int threads = threads_of_the_machine();
    Split split = Split::tiles;
    int tile = 32;  ///< Pixels along a tile's side.
    bool show = false;

    void declare(OptionParser& parser) {
        parser.number("--threads", threads, 1, max_threads, "How many threads draw");
        parser.choice(
            "--split", split,
            {{"rows", Split::rows}, {"interleaved", Split::interleaved}, {"tiles", Split::tiles}},
            "What each of them draws: rows, every so many-th row, or the next free tile");
        parser.number("--tile", tile, 8, 16384, "Pixels along a tile's side");
        parser.flag("--show-threads", show, "Tint each pixel by the thread that drew it");
    }

    /// Tiles grow where there would be more than 65,536: each has a list in each batch.
    Tiling tiling_of(ivec2 size, std::size_t workers) const {
        int side = tile;
        while (Tiling(Split::tiles, size, 1, side).count() > 65536) side *= 2;
        return {split, size, workers, side};
    }
};

struct ThreadedSceneOptions : ShadowSceneOptions {
    ThreadOptions threads;

    void declare(OptionParser& parser) {
        ShadowSceneOptions::declare(parser);
        threads.declare(parser);
    }
};

/// A pool of so many threads, kept from one picture to the next. Each thread that draws pictures
/// has its own.
inline ThreadPool& kept_pool(int threads) {
    thread_local std::optional<ThreadPool> pool;
    if (!pool || pool->size() != static_cast<std::size_t>(threads)) pool.emplace(threads);
    return *pool;
}

/// A worker's colour, linear: all are equally bright to the eye, and hues a golden angle apart, so
/// that of any few workers in a row no two look alike.
///
/// @see Ottosson, "A perceptual color space for image processing", 2020
inline vec3 color_of(std::size_t worker) {
    constexpr float lightness = 0.76f, chroma = 0.15f;
    const float hue_degrees = 250.0f + 137.508f * static_cast<float>(worker);
    const float a = chroma * std::cos(glm::radians(hue_degrees));
    const float b = chroma * std::sin(glm::radians(hue_degrees));
    const vec3 roots(lightness + 0.39634f * a + 0.21580f * b,
                     lightness - 0.10556f * a - 0.06385f * b,
                     lightness - 0.08948f * a - 1.29149f * b);
    const vec3 c = roots * roots * roots;
    return glm::max(vec3(4.07674f * c.x - 3.30771f * c.y + 0.23097f * c.z,
                         -1.26844f * c.x + 2.60976f * c.y - 0.34132f * c.z,
                         -0.00420f * c.x - 0.70342f * c.y + 1.70761f * c.z),
                    vec3(0));
}

/// Gives a tile its worker's colour; what is bright stays brighter than what is dark.
/// A tile that is a box has a darker upper and left border.
inline void tint(Image<vec3>& picture, const Tile& tile, std::size_t worker) {
    constexpr float least = 0.10f, most_white = 0.5f, border = 0.4f;
    const vec3 color = color_of(worker);
    for_each_strip(tile, [&](const PixelBox& strip) {
        for (int y = strip.first.y; y <= strip.last.y; ++y)
            for (int x = strip.first.x; x <= strip.last.x; ++x) {
                const bool is_border =
                    tile.row_step == 1 && (x == strip.first.x || y == strip.first.y);
                vec3& pixel = picture[{x, y}];
                const float light = glm::dot(pixel, vec3(0.2126f, 0.7152f, 0.0722f));
                const vec3 tinted = glm::mix(color, vec3(1), std::min(0.7f * light, most_white));
                pixel = (is_border ? border : 1) * (least + 2 * light) * tinted;
            }
    });
}

}  // namespace rasterbook
