// SPDX-License-Identifier: MIT
/// @file
/// The light of a sky and a sun, computed once and kept as colours of corners.
#pragma once

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "common/math/types.hpp"

namespace rasterbook::assets {

/// A box that stands on y = 0, turned about its vertical axis as placed() turns parts.
struct BakedBox {
    dvec3 center, half_size;
    double cosine, sine;
};

/// A ball that is squeezed along the axes.
struct BakedBall {
    dvec3 center, radii;
};

/// What keeps light away: one ball and one box stand for what is there, a wide floor below.
struct BakedScene {
    BakedBall ball;
    BakedBox box;
};

/// Whether a ray meets a ball.
inline bool meets(const BakedBall& ball, dvec3 from, dvec3 way) {
    const dvec3 o = (from - ball.center) / ball.radii, d = way / ball.radii;
    const double a = glm::dot(d, d), b = glm::dot(o, d), c = glm::dot(o, o) - 1;
    return b < 0 && b * b > a * c;
}

/// Whether a ray meets a box.
inline bool meets(const BakedBox& box, dvec3 from, dvec3 way) {
    const auto turned = [&](dvec3 v) {
        return dvec3(box.cosine * v.x - box.sine * v.z, v.y, box.cosine * v.z + box.sine * v.x);
    };
    const dvec3 o = turned(from - box.center), d = turned(way);
    double begin = 0, end = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
        if (d[axis] == 0) {
            if (std::abs(o[axis]) > box.half_size[axis]) return false;
            continue;
        }
        const double s = (-box.half_size[axis] - o[axis]) / d[axis];
        const double t = (box.half_size[axis] - o[axis]) / d[axis];
        begin = std::max(begin, std::min(s, t)), end = std::min(end, std::max(s, t));
    }
    return begin < end;
}

/// A point of the floor; one that lies in the box or the ball is moved to their border, so that the
/// light beside them goes on to where they stand.
inline dvec3 beside(const BakedScene& scene, dvec3 point) {
    const double gap = 0.02;
    const BakedBox& box = scene.box;
    const dvec3 x(box.cosine, 0, -box.sine), z(box.sine, 0, box.cosine);
    const dvec2 at(glm::dot(point - box.center, x), glm::dot(point - box.center, z));
    const dvec2 inside = dvec2(box.half_size.x, box.half_size.z) - glm::abs(at);
    if (inside.x > 0 && inside.y > 0)
        return inside.x < inside.y ? point + (at.x < 0 ? -1.0 : 1.0) * (inside.x + gap) * x
                                   : point + (at.y < 0 ? -1.0 : 1.0) * (inside.y + gap) * z;
    const dvec3 from_center = (point - scene.ball.center) / scene.ball.radii;
    const double along = from_center.x * from_center.x + from_center.z * from_center.z;
    const double border = 1 - from_center.y * from_center.y;
    if (along > border || along == 0) return point;
    const double farther = std::sqrt(border / along) * (1 + gap);
    return {scene.ball.center.x + farther * (point.x - scene.ball.center.x), point.y,
            scene.ball.center.z + farther * (point.z - scene.ball.center.z)};
}

/// Of whom a point is part: that does not keep light away from itself.
enum class BakedPart { ball, box, floor };

/// The light at a point: of 208 directions around the normal, more of them near it, and of 52
/// places on a wide sun.
inline dvec3 baked_light(const BakedScene& scene, BakedPart part, dvec3 point, dvec3 normal) {
    const dvec3 zenith(0.24, 0.35, 0.55), horizon(0.5, 0.46, 0.42), ground(0.16, 0.12, 0.09);
    const dvec3 sun(1.15, 0.88, 0.56), toward_sun = glm::normalize(dvec3(-0.75, 0.55, 0.28));
    if (part == BakedPart::floor) point = beside(scene, point);
    const auto is_free = [&](dvec3 way) {
        return (part == BakedPart::ball || !meets(scene.ball, point, way)) &&
               (part == BakedPart::box || !meets(scene.box, point, way));
    };
    const auto basis = [](dvec3 z) {
        const dvec3 any = std::abs(z.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        const dvec3 x = glm::normalize(glm::cross(any, z));
        return dmat3(x, glm::cross(z, x), z);
    };
    // Places in the disc, as seen from above: each stands for as much light as another.
    const auto for_disc = [](int side, auto&& visit) {
        int count = 0;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const dvec2 p((2.0 * x + 1) / side - 1, (2.0 * y + 1) / side - 1);
                if (glm::dot(p, p) < 1) visit(p), ++count;
            }
        return count;
    };
    dvec3 from_sky(0);
    const dmat3 around_normal = basis(normal);
    const int sky_count = for_disc(16, [&](dvec2 p) {
        const dvec3 way = around_normal * dvec3(p, std::sqrt(1 - glm::dot(p, p)));
        if (way.y < 0)
            from_sky += ground;
        else if (is_free(way))
            from_sky += glm::mix(horizon, zenith, way.y);
        else
            from_sky += 0.25 * ground;
    });
    double seen = 0;
    const dmat3 around_sun = basis(toward_sun);
    const int sun_count = for_disc(8, [&](dvec2 p) {
        seen += is_free(glm::normalize(around_sun * dvec3(0.09 * p, 1))) ? 1 : 0;
    });
    return from_sky / double(sky_count) +
           sun * (std::max(glm::dot(normal, toward_sun), 0.0) * seen / double(sun_count));
}

}  // namespace rasterbook::assets
