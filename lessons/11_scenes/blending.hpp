// SPDX-License-Identifier: MIT
/// @file
/// Alpha: surfaces with holes, and transparent ones. Introduced in lesson 11; derivation:
/// docs/derivations/11_scenes.md.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include "10_threading/split.hpp"
#include "common/app/counters.hpp"
#include "common/image/image.hpp"
#include "common/math/types.hpp"
#include "common/probe/pixel_trace.hpp"

namespace rasterbook {

/// The alpha test: whether a surface with holes is there (Eq. 11.6).
///
/// @param opacity  Any number; of NaN, there is a hole.
template <typename F>
auto passes_alpha_test(F opacity, float cutoff) {
    return opacity >= F(cutoff);
}

/// A colour over what lies behind it (Eq. 11.7): exactly itself with an opacity of 1, exactly what
/// lies behind with one of 0.
///
/// @param opacity      0 to 1.
/// @param color,behind Finite.
inline vec3 over(vec3 color, float opacity, vec3 behind) {
    return opacity * color + (1 - opacity) * behind;
}

/// A transparent fragment: one surface in one pixel.
struct TransparentFragment {
    ivec2 pixel;
    float depth;
    float opacity;  ///< 0 to 1.
    vec3 color;
};

/// The transparent fragments of a tile, gathered in any order of depth, blended from back to front.
///
/// Sorted in each pixel by themselves: triangles that cut through each other, or overlap in a ring,
/// have no order as a whole.
class TransparentFragments {
  public:
    void add(const TransparentFragment& fragment) {
        count(Counter::blended_fragments);
        trace_blended(fragment.pixel, fragment.opacity, fragment.color);
        fragments_.push_back(fragment);
    }

    bool empty() const { return fragments_.empty(); }
    const std::vector<TransparentFragment>& fragments() const { return fragments_; }

    /// Blends all of them over the picture (Eq. 11.8). Of two fragments at the same depth, the
    /// one that was added first lies on top: it is the first that stays in the depth buffer, too.
    void blend_over(Image<vec3>& color) {
        order_.resize(fragments_.size());
        for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::uint32_t>(i);
        std::sort(order_.begin(), order_.end(), [this](std::uint32_t a, std::uint32_t b) {
            const TransparentFragment &first = fragments_[a], &second = fragments_[b];
            return std::tuple(first.pixel.y, first.pixel.x, first.depth, b) <
                   std::tuple(second.pixel.y, second.pixel.x, second.depth, a);
        });
        for (const std::uint32_t i : order_) {
            vec3& pixel = color[fragments_[i].pixel];
            pixel = over(fragments_[i].color, fragments_[i].opacity, pixel);
        }
        fragments_.clear();
    }

  private:
    std::vector<TransparentFragment> fragments_;
    std::vector<std::uint32_t> order_;
};

/// As many transparent fragments of a tile are gathered at once; they take 128 MiB.
constexpr std::size_t max_transparent = std::size_t{1} << 22;

/// Visits a tile in parts, each of which has no more than max_transparent fragments, or one pixel.
/// That is nearly always the whole tile.
///
/// @param triangles  How many transparent ones may reach into the tile.
/// @param visit      Called as visit(part).
template <typename Visit>
void for_each_part(const Tile& tile, std::size_t triangles, Visit&& visit) {
    const auto [first, last] = tile.box;
    const auto pixels =
        static_cast<int>(max_transparent / std::clamp(triangles, std::size_t{1}, max_transparent));
    const int width = std::min(last.x - first.x + 1, pixels);
    const int height = tile.row_step * std::min(last.y - first.y + 1, pixels / std::max(width, 1));
    for (int y = first.y; y <= last.y; y += height)
        for (int x = first.x; x <= last.x; x += width)
            visit(Tile{{{x, y}, glm::min(ivec2(x + width, y + height) - 1, last)}, tile.row_step});
}

}  // namespace rasterbook
