// SPDX-License-Identifier: MIT
/// @file
/// Other ways to fill the triangle of lesson 02; measured in docs/accuracy/02_triangle_fill.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <type_traits>

#include "02_triangle_fill/triangle.hpp"
#include "common/app/lesson_app.hpp"

namespace rasterbook {

/// What edge functions are computed in.
enum class EdgeNumber { int64, int32, float32, float64 };

struct FillMethod {
    EdgeNumber edges = EdgeNumber::int64;
    int subpixel_bits = rasterbook::subpixel_bits;  ///< 0 to 16, for whole numbers.

    void declare(OptionParser& parser) {
        parser.choice(
            "--edges", edges,
            {{"int64", EdgeNumber::int64},
             {"int32", EdgeNumber::int32},
             {"float", EdgeNumber::float32},
             {"double", EdgeNumber::float64}},
            "What edge functions are computed in: int64 never overflows; int32 does, where "
            "triangles are larger than 128 pixels; float and double leave vertices where "
            "they are, and round");
        parser.choice(
            "--subpixel-bits", subpixel_bits,
            {{"0", 0}, {"2", 2}, {"4", 4}, {"8", 8}, {"12", 12}, {"16", 16}},
            "Vertices are snapped to 1/2^N of a pixel. Only the lesson's own fill, int64 with "
            "8 bits, narrows rows by division; the others test each pixel of a box");
    }
};

/// Visits the pixels whose centres a triangle covers, as fill_triangle does, but tests every pixel
/// of the bounding box, and computes in `Number`. Whole numbers that are too large wrap around.
///
/// @param vertices  In pixels times `scale`, finite.
/// @param emit     Called as emit(ivec2 pixel, vec3 barycentrics).
template <typename Number, std::invocable<ivec2, vec3> Emit>
void fill_bounding_box(const std::array<glm::vec<2, Number>, 3>& vertices, Number scale, ivec2 size,
                       Emit&& emit) {
    using Wrapping =
        typename std::conditional_t<std::is_integral_v<Number>, std::make_unsigned<Number>,
                                    std::type_identity<Number>>::type;
    const auto difference = [](Number u, Number v) {
        return static_cast<Number>(static_cast<Wrapping>(u) - static_cast<Wrapping>(v));
    };
    const auto product = [](Number u, Number v) {
        return static_cast<Number>(static_cast<Wrapping>(u) * static_cast<Wrapping>(v));
    };
    const auto sum = [](Number u, Number v) {
        return static_cast<Number>(static_cast<Wrapping>(u) + static_cast<Wrapping>(v));
    };
    const auto [a, b, c] = vertices;
    const Number twice_area = sum(product(difference(b.y, a.y), difference(c.x, a.x)),
                                  product(difference(a.x, b.x), difference(c.y, a.y)));
    if (twice_area == 0) return;
    const Number winding = twice_area > 0 ? Number{1} : Number{-1};
    const float inv_area = 1.0f / static_cast<float>(product(winding, twice_area));

    const dvec2 low = dvec2(glm::min(glm::min(a, b), c)) / static_cast<double>(scale);
    const dvec2 high = dvec2(glm::max(glm::max(a, b), c)) / static_cast<double>(scale);
    const ivec2 first(glm::clamp(glm::ceil(low - 0.5), dvec2(0), dvec2(size)));
    const ivec2 last(glm::clamp(glm::floor(high - 0.5), dvec2(-1), dvec2(size) - 1.0));
    const auto center = [&](int pixel) {
        const auto whole = static_cast<Number>(pixel);
        return sum(product(whole, scale), scale / 2);
    };

    struct Side {
        Number from_x, from_y, normal_x, normal_y, row;
        bool owned;
    };
    const auto side = [&](glm::vec<2, Number> p, glm::vec<2, Number> q) {
        const Number nx = product(winding, difference(q.y, p.y));
        const Number ny = product(winding, difference(p.x, q.x));
        return Side{p.x, p.y, nx, ny, 0, nx > 0 || (nx == 0 && ny > 0)};
    };
    std::array<Side, 3> sides = {side(b, c), side(c, a), side(a, b)};
    for (int y = first.y; y <= last.y; ++y) {
        for (Side& s : sides) s.row = product(s.normal_y, difference(center(y), s.from_y));
        for (int x = first.x; x <= last.x; ++x) {
            const auto value = [&](const Side& s) {
                return sum(product(s.normal_x, difference(center(x), s.from_x)), s.row);
            };
            const Number of_a = value(sides[0]), of_b = value(sides[1]), of_c = value(sides[2]);
            const auto is_inside = [](Number v, const Side& s) {
                return v > 0 || (v == 0 && s.owned);
            };
            if (is_inside(of_a, sides[0]) && is_inside(of_b, sides[1]) && is_inside(of_c, sides[2]))
                emit(ivec2(x, y), vec3(of_a, of_b, of_c) * inv_area);
        }
    }
}

/// Fills the bounding box in the method's numbers.
///
/// @param vertices In pixels, not snapped. When a coordinate is not a number or reaches 2^30 steps,
///                 nothing is visited.
template <std::invocable<ivec2, vec3> Emit>
void fill_bounding_box_as(const FillMethod& method, const std::array<dvec2, 3>& vertices,
                          ivec2 size, Emit&& emit) {
    const int bits = method.subpixel_bits, scale_bits = std::max(bits, 1);  // centres are whole
    const double limit = std::ldexp(1.0, 30 - scale_bits);
    for (const dvec2 p : vertices)
        if (!(std::abs(p.x) < limit && std::abs(p.y) < limit)) return;
    const auto snapped = [&]<typename Number>(Number one) {
        std::array<glm::vec<2, Number>, 3> whole;
        for (std::size_t i = 0; i < 3; ++i)
            for (const int axis : {0, 1})
                whole[i][axis] = static_cast<Number>(
                    std::llrint(std::ldexp(vertices[i][axis], bits)) << (scale_bits - bits));
        fill_bounding_box<Number>(whole, one << scale_bits, size, emit);
    };
    switch (method.edges) {
        case EdgeNumber::int64:
            return snapped(std::int64_t{1});
        case EdgeNumber::int32:
            return snapped(std::int32_t{1});
        case EdgeNumber::float32:
            return fill_bounding_box<float>(
                {vec2(vertices[0]), vec2(vertices[1]), vec2(vertices[2])}, 1.0f, size, emit);
        case EdgeNumber::float64:
            return fill_bounding_box<double>(vertices, 1.0, size, emit);
    }
}

/// Whether other numbers than fill_triangle's are asked for.
inline bool is_another_method(const FillMethod& method) {
    return method.edges != EdgeNumber::int64 || method.subpixel_bits != subpixel_bits;
}

/// fill_triangle, or fill_bounding_box_as if the method asks for other numbers.
///
/// @param on_screen  The triangle as snap_triangle gives it, for fill_triangle.
/// @param vertices    The same in pixels, not snapped.
template <std::invocable<ivec2, vec3> Emit>
void fill(const FillMethod& method, const ScreenTriangle& on_screen,
          const std::array<dvec2, 3>& vertices, ivec2 size, Emit&& emit) {
    if (is_another_method(method))
        fill_bounding_box_as(method, vertices, size, traced(on_screen.vertices, emit));
    else
        fill_triangle(on_screen, size, emit);
}

}  // namespace rasterbook
