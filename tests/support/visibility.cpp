// SPDX-License-Identifier: MIT
#include "support/visibility.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "support/exact.hpp"

namespace rasterbook::test {

namespace {

/// Whether a pixel centre on this side belongs to the triangle, which lies on the side's left.
bool is_left_or_top(ivec2 from, ivec2 to) {
    return to.y > from.y || (to.y == from.y && to.x < from.x);
}

bool is_usable(vec3 vertex) {  // false for NaN
    return std::abs(vertex.x) < 1 << 21 && std::abs(vertex.y) < 1 << 21;
}

/// Twice the area of a, b, p; > 0 where seen counter-clockwise. At most 2^30 * 2^30 twice over.
std::int64_t twice_area(ivec2 a, ivec2 b, ivec2 p) {
    const auto product = [](int u, int v) { return std::int64_t{u} * v; };
    return product(a.x - p.x, p.y - b.y) - product(a.y - p.y, p.x - b.x);
}

void draw(const ScreenPatch& patch, int id, VisibilityRule rule, Visibility& picture) {
    if (!std::all_of(patch.begin(), patch.end(), is_usable)) return;
    auto [a, b, c] = patch;
    ivec2 at_a = exactly_snapped(a), at_b = exactly_snapped(b), at_c = exactly_snapped(c);
    std::int64_t area = twice_area(at_a, at_b, at_c);
    if (area == 0 || rule.drawn == (area > 0 ? Facing::back : Facing::front)) return;
    if (area < 0) {
        std::swap(b, c);
        std::swap(at_b, at_c);
        area = -area;
    }
    const ivec2 low = glm::min(glm::min(at_a, at_b), at_c) >> 8;
    const ivec2 high = glm::max(glm::max(at_a, at_b), at_c) >> 8;
    const ivec2 first = glm::max(low, ivec2(0)),
                last = glm::min(high, picture.ids.size() - ivec2(1));

    const auto covers = [](std::int64_t share, ivec2 from, ivec2 to) {
        return share > 0 || (share == 0 && is_left_or_top(from, to));
    };
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            const ivec2 center = exact_center({x, y});
            const std::int64_t share_a = twice_area(at_b, at_c, center),
                               share_b = twice_area(at_c, at_a, center),
                               share_c = area - share_a - share_b;
            if (!covers(share_a, at_b, at_c) || !covers(share_b, at_c, at_a) ||
                !covers(share_c, at_a, at_b))
                continue;
            const double depth =
                (static_cast<double>(share_a) * a.z + static_cast<double>(share_b) * b.z +
                 static_cast<double>(share_c) * c.z) /
                static_cast<double>(area);
            int& seen = picture.ids[{x, y}];
            double& depth_seen = picture.depths[{x, y}];
            const bool wins =
                seen == Visibility::nothing || rule.winner == Winner::last ||
                (rule.winner == Winner::nearest ? depth > depth_seen : depth < depth_seen);
            if (wins) seen = id, depth_seen = depth;
        }
}

}  // namespace

Visibility visible(std::span<const ScreenPatch> patches, ivec2 size, VisibilityRule rule) {
    Visibility picture{Image<int>(size, Visibility::nothing), Image<double>(size)};
    for (std::size_t i = 0; i < patches.size(); ++i)
        draw(patches[i], static_cast<int>(i), rule, picture);
    return picture;
}

}  // namespace rasterbook::test
