// SPDX-License-Identifier: MIT
/// @file
/// Triangles: how finely vertices are snapped, what edge functions are computed in, and how many
/// samples a pixel has.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "accuracy/accuracy.hpp"
#include "common/image/image.hpp"
#include "common/math/numerics.hpp"
#include "lab/fill_methods.hpp"
#include "support/exact_area.hpp"
#include "support/triangulations.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

using Vertices = std::array<dvec2, 3>;
constexpr ivec2 picture_size(256);

/// Triangles anywhere in the picture, counter-clockwise, their corners on 2^-20 pixel.
std::vector<Vertices> random_triangles(int count) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> any(0, 256 << 20);
    std::vector<Vertices> triangles;
    while (std::ssize(triangles) < count) {
        Vertices t;
        for (dvec2& vertex : t) vertex = dvec2(any(random), any(random)) / double{1 << 20};
        const dvec2 u = t[1] - t[0], v = t[2] - t[0];
        if (u.y * v.x - u.x * v.y < 0) std::swap(t[1], t[2]);
        triangles.push_back(t);
    }
    return triangles;
}

/// Whether a pixel's centre lies inside a triangle with vertices on 2^-20 pixel: exact. (None of
/// the random triangles has a centre on a side.)
bool is_inside(const Vertices& vertices, ivec2 pixel) {
    using Point = glm::vec<2, std::int64_t>;
    const Point p = (Point(pixel) * std::int64_t{2} + std::int64_t{1}) << std::int64_t{19};
    for (std::size_t i = 0; i < 3; ++i) {
        const Point from(vertices[i] * double{1 << 20}),
            to(vertices[(i + 1) % 3] * double{1 << 20});
        const Point side = to - from, way = p - from;
        if (int128{side.y} * way.x - int128{side.x} * way.y <= 0) return false;
    }
    return true;
}

double covered_pixels(const std::vector<Vertices>& triangles) {
    double covered = 0;
    for (const Vertices& t : triangles)
        for (int y = 0; y < picture_size.y; ++y)
            for (int x = 0; x < picture_size.x; ++x) covered += is_inside(t, {x, y});
    return covered;
}

/// Pixels that are drawn and should not be, or the other way round, for each triangle.
double wrong_pixels(const FillMethod& variant, const std::vector<Vertices>& triangles) {
    double wrong = 0;
    for (const Vertices& t : triangles) {
        Image<std::uint8_t> hits(picture_size, 0);
        fill_bounding_box_as(variant, t, picture_size, [&](ivec2 pixel, vec3) { ++hits[pixel]; });
        for (int y = 0; y < picture_size.y; ++y)
            for (int x = 0; x < picture_size.x; ++x) wrong += hits[{x, y}] != is_inside(t, {x, y});
    }
    return wrong / static_cast<double>(triangles.size());
}

/// Gaps and double hits of a million pixels, in fans of 36 triangles around a pixel's centre whose
/// rim is `radius` pixels away. Only pixels well inside the rim count.
double fan_errors(const FillMethod& variant, float radius) {
    constexpr ivec2 size(1280, 960);
    constexpr int fans = 4;
    std::mt19937 random(1);
    double wrong = 0, pixels = 0;
    for (int i = 0; i < fans; ++i) {
        std::uniform_real_distribution<float> share(0.3f, 0.7f), jitter(0.0f, 0.1f);
        const vec2 center = glm::floor(vec2(size) * vec2(share(random), share(random))) + 0.5f;
        std::vector<vec2> rim;
        for (int k = 0; k < 36; ++k) {
            const float around_radians = (static_cast<float>(k) + jitter(random)) * -0.17453293f;
            rim.push_back(center +
                          radius * vec2(std::cos(around_radians), std::sin(around_radians)));
        }
        Image<int> hits(size, 0);
        for (const auto& [a, b, c] : fan(center, rim))
            fill(variant, snap_triangle(a, b, c), {a, b, c}, size,
                 [&](ivec2 pixel, vec3) { ++hits[pixel]; });
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                if (glm::distance(center, vec2(x, y) + 0.5f) > 0.9f * radius) continue;
                wrong += hits[{x, y}] != 1;
                ++pixels;
            }
    }
    return 1e6 * wrong / pixels;
}

/// Draws with samples_per_side^2 samples a pixel; adds up their shares.
void add_coverage(Image<float>& coverage, const Vertices& t, int samples_per_side) {
    const float n = static_cast<float>(samples_per_side), share = 1 / (n * n);
    fill_triangle(snap_triangle(vec2(t[0]) * n, vec2(t[1]) * n, vec2(t[2]) * n),
                  picture_size * samples_per_side,
                  [&](ivec2 sample, vec3) { coverage[sample / samples_per_side] += share; });
}

/// Of the coverage of the pixels that a triangle's border crosses.
Errors coverage_errors(int samples_per_side, const std::vector<Vertices>& triangles) {
    ErrorSum errors;
    for (const Vertices& t : triangles) {
        Image<float> coverage(picture_size, 0.0f);
        add_coverage(coverage, t, samples_per_side);
        for (int y = 0; y < picture_size.y; ++y)
            for (int x = 0; x < picture_size.x; ++x) {
                const double area = area_in_pixel({t.begin(), t.end()}, {x, y});
                if (area > 0 && area < 1) errors.add(double{coverage[{x, y}]} - area);
            }
    }
    return {{"RMS error of coverage", errors.rms()},
            {"greatest error of coverage", errors.greatest()}};
}

}  // namespace

int main(int argc, char** argv) {
    static const std::vector<Vertices> triangles = random_triangles(100);
    static Image<std::uint8_t> hits(picture_size, 0);
    static Image<float> coverage(picture_size, 0.0f);
    const double covered = covered_pixels(triangles);
    const auto emit = [](ivec2 pixel, vec3) { ++hits[pixel]; };
    const auto fill_boxes = [=](const FillMethod& variant) {
        return [=] {
            for (const Vertices& t : triangles)
                fill_bounding_box_as(variant, t, picture_size, emit);
        };
    };

    for (const int bits : {0, 2, 4, 8, 12, 16}) {
        const FillMethod variant{.subpixel_bits = bits};
        add_variant("snapping", std::to_string(bits) + " bits", covered,
                    {{"wrong pixels a triangle", wrong_pixels(variant, random_triangles(1000))}},
                    fill_boxes(variant));
    }

    const auto far_fans = [](const FillMethod& variant) {
        Errors errors;
        for (const char* radius : {"60", "4e3", "4e4", "4e5", "4e6"})
            errors[std::string("wrong of a million, rim at ") + radius + " px"] =
                fan_errors(variant, std::strtof(radius, nullptr));
        return errors;
    };
    add_variant("edges", "course", covered, far_fans({}), [=] {
        for (const auto& [a, b, c] : triangles)
            fill_triangle(snap_triangle(vec2(a), vec2(b), vec2(c)), picture_size, emit);
    });
    const std::pair<const char*, EdgeNumber> numbers[] = {{"int64", EdgeNumber::int64},
                                                          {"int32", EdgeNumber::int32},
                                                          {"float", EdgeNumber::float32},
                                                          {"double", EdgeNumber::float64}};
    for (const auto& [name, number] : numbers) {
        const FillMethod variant{.edges = number};
        add_variant("edges", name, covered, far_fans(variant), fill_boxes(variant));
    }

    for (const int per_side : {1, 2, 4, 8})
        add_variant("samples",
                    std::to_string(per_side * per_side) + (per_side > 1 ? " samples" : " sample"),
                    covered, coverage_errors(per_side, triangles), [=] {
                        for (const Vertices& t : triangles) add_coverage(coverage, t, per_side);
                    });
    return measure_variants(argc, argv);
}
