// SPDX-License-Identifier: MIT
// Textures as OpenGL draws them, on a floor that runs to the horizon: what it is compared with here
// is computed from the pixel's ray, in double.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "04_mvp/transform.hpp"
#include "support/opengl_triangles.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// The plane y = -1 below a camera that looks along -z with its head to the side; it begins behind
/// the camera. uv = (x, z) / 8.
struct Floor {
    static constexpr float fov_y = 1.0f, roll = 0.75f, uv_per_unit = 0.125f;
    static constexpr int texture_size = 256;
    OpenGlView view{ivec2(320, 240)};

    std::vector<OpenGlTriangle> triangles() const {
        const mat4 clip_from_world = perspective(fov_y, aspect(), 0.5f, 1000.0f) * rotation_z(roll);
        constexpr float behind = 5, side = 400, far = -400;
        const vec2 left_near(-side, behind), right_near(side, behind), right_far(side, far),
            left_far(-side, far);
        std::vector<OpenGlTriangle> triangles;
        for (const auto& corners : {std::array{left_near, right_near, right_far},
                                    std::array{left_near, right_far, left_far}}) {
            OpenGlTriangle& triangle = triangles.emplace_back();
            for (std::size_t i = 0; i < 3; ++i) {
                triangle.corners_clip[i] =
                    clip_from_world * vec4(corners[i].x, -1, corners[i].y, 1);
                triangle.uv[i] = corners[i] * uv_per_unit;
            }
        }
        return triangles;
    }

    float aspect() const {
        return static_cast<float>(view.size.x) / static_cast<float>(view.size.y);
    }

    /// What is seen at a pixel's centre, and how it changes to the right and down by a pixel.
    struct Seen {
        dvec2 uv, along_x, along_y;
        double lambda() const {
            return std::log2(texture_size * std::max(glm::length(along_x), glm::length(along_y)));
        }
    };

    Seen at(ivec2 pixel) const {
        const double half_height = std::tan(double{fov_y} / 2);
        const dvec2 half = half_height * dvec2(double{aspect()}, -1);
        const dvec2 per_pixel = 2.0 * half / dvec2(view.size);
        // Directions in the world for those on the screen; z stays -1.
        const double c = std::cos(double{roll}), s = std::sin(double{roll});
        const auto unrolled = [&](dvec2 v) { return dvec2(c * v.x + s * v.y, c * v.y - s * v.x); };
        const dvec2 ray = unrolled((dvec2(pixel) + 0.5) * per_pixel - half);
        const double distance = -1 / ray.y;
        const auto along = [&](dvec2 step) {
            const double farther = step.y * distance * distance;
            return double{uv_per_unit} * dvec2(step.x * distance + ray.x * farther, -farther);
        };
        return {double{uv_per_unit} * distance * dvec2(ray.x, -1),
                along(unrolled({per_pixel.x, 0})), along(unrolled({0, per_pixel.y}))};
    }
};

/// Random colours and their means.
std::vector<Image<vec3>> random_levels() {
    Random random(1);
    std::vector<Image<vec3>> levels = {Image<vec3>(ivec2(Floor::texture_size))};
    for (vec3& texel : levels[0].pixels())
        for (int i = 0; i < 3; ++i) texel[i] = static_cast<float>(any(random, 0, 255)) / 255;
    while (levels.back().size().x > 1) {
        const Image<vec3>& fine = levels.back();
        Image<vec3> coarse(fine.size() / 2);
        for_each_pixel(coarse.size(), [&](ivec2 p) {
            for (const ivec2 step : {ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(1, 1)})
                coarse[p] += fine[2 * p + step] / 4.0f;
        });
        levels.push_back(coarse);
    }
    return levels;
}

dvec3 bilinear(const Image<vec3>& level, dvec2 uv) {
    const dvec2 place = uv * dvec2(level.size()) - 0.5, low = glm::floor(place);
    const auto texel = [&](double x, double y) {
        return dvec3(level[ivec2(glm::mod(low + dvec2(x, y), dvec2(level.size())))]);
    };
    const dvec2 share = place - low;
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), share.x),
                    glm::mix(texel(0, 1), texel(1, 1), share.x), share.y);
}

dvec3 trilinear(const std::vector<Image<vec3>>& levels, dvec2 uv, double lambda) {
    const double last = static_cast<double>(levels.size() - 1);
    const double place = std::clamp(lambda, 0.0, last),
                 fine = std::min(std::floor(place), last - 1);
    const auto i = static_cast<std::size_t>(fine);
    return glm::mix(bilinear(levels[i], uv), bilinear(levels[i + 1], uv), place - fine);
}

double greatest(dvec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

}  // namespace

TEST_F(OpenGlTest, UvIsCorrectInPerspective) {
    // Near the horizon a pixel spans thousands of texels. There 1/w goes to 0, by 1/240 a pixel;
    // the triangle's plane of 1/w, which begins at 2, is off by up to 2^-22 in float: that moves
    // the place on the floor by 2^-14 pixel.
    constexpr double texels = 1.0 / 256, pixels = 0x1p-14;
    const Floor floor;
    const OpenGlPicture picture = gl->draw(floor.triangles(), floor.view);
    int compared = 0;
    for_each_pixel(floor.view.size, [&](ivec2 pixel) {
        if (picture.color[pixel].x == 0) return;
        const Floor::Seen seen = floor.at(pixel);
        const double tolerance = std::max(texels, pixels * std::exp2(seen.lambda()));
        const dvec2 uv(picture.color[pixel].y, picture.color[pixel].z);
        const double error = glm::length(uv - seen.uv) * Floor::texture_size;
        EXPECT_LE(error, tolerance) << testing::PrintToString(pixel);
        compared += tolerance == texels;
    });
    EXPECT_GE(compared, 34'000) << "within 1/256 texel";
}

TEST_F(OpenGlTest, TexturesAreFilteredLinearly) {
    constexpr double tolerance = 2.0 / 255;
    const Floor floor;
    const std::vector<Image<vec3>> levels = random_levels();
    gl->set_texture(levels);
    const OpenGlPicture places = gl->draw(floor.triangles(), floor.view);
    const OpenGlPicture fine = gl->draw(floor.triangles(), floor.view, OpenGl::bilinear);
    const OpenGlPicture mixed = gl->draw(floor.triangles(), floor.view, OpenGl::trilinear);
    int compared = 0;
    for_each_pixel(floor.view.size, [&](ivec2 pixel) {
        if (places.color[pixel].x == 0) return;
        // At the place that OpenGL has itself: the other test compares that.
        const dvec2 uv(places.color[pixel].y, places.color[pixel].z);
        const double fine_error = greatest(bilinear(levels[0], uv) - dvec3(fine.color[pixel]));
        const dvec3 expected = trilinear(levels, uv, floor.at(pixel).lambda());
        const double mixed_error = greatest(expected - dvec3(mixed.color[pixel]));
        ++compared;
        EXPECT_LE(fine_error, tolerance) << testing::PrintToString(pixel);
        EXPECT_LE(mixed_error, tolerance) << testing::PrintToString(pixel);
    });
    EXPECT_GE(compared, 38'000);
}
