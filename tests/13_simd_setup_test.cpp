// SPDX-License-Identifier: MIT
// Triangles that are projected several at a time beside lesson 10's, bit by bit.
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "10_threading/binned_triangles.hpp"
#include "13_simd/simd.hpp"
#include "13_simd/wide_setup.hpp"
#include "support/any_scene.hpp"
#include "support/lanes.hpp"
#include "support/look_up.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// Triangles of a mesh, and its positions in clip space.
struct TrianglesInClipSpace {
    Mesh mesh{};
    std::vector<vec4> positions{};

    void add(const std::array<vec4, 3>& vertices) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), vertices.begin(), vertices.end());
        mesh.triangles.push_back({{{{first}, {first + 1}, {first + 2}}}, 0});
    }
};

vec4 inside(Dice& dice) {
    const float w = dice.between(0.1f, 10);
    return {w * dice.in_cube(1), w};
}

/// A number of a triangle, and what it is.
struct Named {
    std::string name;
    double value;
};

std::vector<Named> numbers_of(const ProjectedTriangle& projected) {
    std::vector<Named> numbers;
    const auto add = [&](const std::string& name, auto v) {
        for (int i = 0; i < v.length(); ++i)
            numbers.push_back({name + " " + "xyzw"[i], static_cast<double>(v[i])});
    };
    for (std::size_t v = 0; v < 3; ++v) {
        const std::string of = " of vertex " + std::to_string(v);
        add("clip space" + of, projected.clipped.at(v).position_clip);
        add("barycentrics" + of, projected.clipped.at(v).barycentrics);
        add("the screen's place" + of, projected.on_screen.vertices.at(v));
    }
    numbers.push_back({"twice the area", static_cast<double>(projected.on_screen.twice_area)});
    numbers.push_back({"the least depth", projected.depth.farthest()});
    add("what is added to the least depth", projected.depth.above_farthest());
    numbers.push_back({"whether it faces away", projected.is_back_facing ? 1.0 : 0.0});
    return numbers;
}

/// Apart from compare(), which is compiled for each width.
testing::AssertionResult are_lesson_10s(const TrianglesInClipSpace& triangles,
                                        ProjectTriangles* project, ivec2 size, Culling culling) {
    std::vector<ProjectedTriangle> actual, expected;
    const auto call = [&](ProjectTriangles* by, std::vector<ProjectedTriangle>& to) {
        return by(triangles.mesh, triangles.mesh.triangles, triangles.positions.data(), size,
                  culling, to);
    };
    const std::size_t culled = call(project, actual), should_be = call(project_triangles, expected);
    if (actual.size() != expected.size() || culled != should_be)
        return testing::AssertionFailure()
               << actual.size() << " triangles are left and " << culled << " culled; expected "
               << expected.size() << " and " << should_be;
    for (std::size_t i = 0; i < actual.size(); ++i) {
        const ProjectedTriangle &a = actual[i], &e = expected[i];
        const std::ptrdiff_t number = &e.triangle - triangles.mesh.triangles.data();
        if (&a.triangle != &e.triangle || &a.mesh != &e.mesh)
            return testing::AssertionFailure() << "number " << i << " is not triangle " << number;
        const std::vector<Named> of_a = numbers_of(a), of_e = numbers_of(e);
        for (std::size_t n = 0; n < of_a.size(); ++n) {
            if (std::bit_cast<std::uint64_t>(of_a[n].value) ==
                std::bit_cast<std::uint64_t>(of_e[n].value))
                continue;
            testing::AssertionResult failure = testing::AssertionFailure();
            failure << "triangle " << number << " of";
            for (const Vertex& vertex : e.triangle.vertices)
                failure << " " << testing::PrintToString(triangles.positions[vertex.position]);
            return failure << ": " << of_a[n].name << " is " << of_a[n].value << ", expected "
                           << of_e[n].value;
        }
    }
    return testing::AssertionSuccess();
}

void compare(const TrianglesInClipSpace& triangles, ivec2 size) {
    for_each_width([&]<int N>() {
        for (const Culling culling : {Culling::none, Culling::back_faces})
            ASSERT_TRUE(are_lesson_10s(triangles, &project_triangles<Floats<N>>, size, culling))
                << N << " at a time, on a picture of " << testing::PrintToString(size)
                << (culling == Culling::none ? ", without culling" : ", with culling");
    });
}

}  // namespace

TEST(Simd, HardCase_HalvesAreRoundedToEven) {
    look_up("Eq. 2.8");
    constexpr std::array rounded_numbers = {0.0f, 2.0f, 2.0f, 3.0f};
    EXPECT_TRUE(has_in_lanes(rounded(in_lanes<4>({0.5f, 1.5f, 2.5f, 2.75f})), [&](int i) {
        return rounded_numbers.at(std::size_t(i));
    })) << "0.5, 1.5, 2.5 and 2.75 rounded";
}

TEST(Simd, HardCase_RoundedNumbersAreThoseOfLrint) {
    look_up("Eq. 2.8");
    for_each_width([]<int N>() {
        Dice dice(1);
        for (int k = 0; k < 20'000; ++k) {
            NumbersOfLanes<N> x;
            for (float& number : x) {
                number = std::ldexp(dice.between(0, 1), static_cast<int>(dice.below(32)) - 1);
                if (dice.one_in(4)) number = std::floor(number) + 0.5f;
            }
            ASSERT_TRUE(has_in_lanes(
                rounded(in_lanes<N>(x)),
                [&](int i) { return static_cast<float>(std::lrint(x.at(std::size_t(i)))); }))
                << list_of(x) << " rounded";
        }
    });
}

TEST(Simd, HardCase_TrianglesInsideOfTheFrustumAreLesson10s) {
    look_up("Eq. 2.8");
    Dice dice(2);
    for (int k = 0; k < 200; ++k) {
        TrianglesInClipSpace triangles;
        for (std::uint32_t i = dice.below(70); i > 0; --i)
            triangles.add({inside(dice), inside(dice), inside(dice)});
        compare(triangles, {1 + int(dice.below(2000)), 1 + int(dice.below(2000))});
    }
}

TEST(Simd, HardCase_TrianglesOnTheFrustumsBorderAreNotClipped) {
    look_up("Eq. 4.10");
    TrianglesInClipSpace on_border;
    for (int i = 0; i < 4; ++i)
        on_border.add({vec4(-2, -2, 2, 2), vec4(1, -1, 0, 1), vec4(-0.5f, 0.5f, 0.25f, 0.5f)});
    for_each_width([&]<int N>() {
        const std::vector some(std::size_t{N}, on_border.mesh.triangles[0]);
        const auto on_screen = project_plain<N>(some, on_border.positions.data(), {64, 64});
        EXPECT_TRUE(all_of(on_screen.is_plain)) << "its corners are three of the frustum's";
    });
    for (const auto& [vertex, outside, where] :
         {std::tuple(0, vec4(std::nextafter(-2.0f, -3.0f), -2, 2, 2), "to the left of"),
          std::tuple(0, vec4(-2, -2, std::nextafter(2.0f, 3.0f), 2), "before"),
          std::tuple(1, vec4(1, -1, -0x1p-149f, 1), "beyond")}) {
        TrianglesInClipSpace across = on_border;
        across.positions[static_cast<std::size_t>(vertex)] = outside;
        for_each_width([&]<int N>() {
            const std::vector some(std::size_t{N}, across.mesh.triangles[0]);
            const auto on_screen = project_plain<N>(some, across.positions.data(), {64, 64});
            EXPECT_FALSE(any_of(on_screen.is_plain))
                << "a vertex is an ulp " << where << " the frustum";
        });
        compare(across, {64, 64});
    }
}

TEST(Simd, HardCase_TrianglesThatAreClippedAreLesson10s) {
    look_up("Eq. 2.8");
    Dice dice(3);
    for (int k = 0; k < 200; ++k) {
        TrianglesInClipSpace triangles;
        for (std::uint32_t i = dice.below(70); i > 0; --i) {
            std::array vertices = {inside(dice), inside(dice), inside(dice)};
            for (vec4& vertex : vertices)
                if (dice.one_in(4)) vertex = {dice.in_cube(4), dice.between(-1, 3)};
            if (dice.one_in(8)) vertices[1] = vertices[0];  // no area
            triangles.add(vertices);
        }
        compare(triangles, {1 + int(dice.below(2000)), 1 + int(dice.below(2000))});
    }
}

TEST(Simd, HardCase_UnusualNumbersInOneTriangleChangeNoOther) {
    look_up("Eq. 2.8");
    Dice dice(4);
    for (int k = 0; k < 2000; ++k) {
        TrianglesInClipSpace triangles;
        const std::uint32_t unusual = dice.below(16);
        for (std::uint32_t i = 0; i < 16; ++i) {
            std::array vertices = {inside(dice), inside(dice), inside(dice)};
            if (i == unusual) {
                vec4& vertex = vertices.at(dice.below(3));
                vertex[static_cast<int>(dice.below(4))] = any_float(dice);
                if (dice.one_in(8)) vertex = vec4(0);
                if (dice.one_in(8)) vertex = vec4(any_float(dice));
            }
            triangles.add(vertices);
        }
        compare(triangles, {640, 480});
    }
}

TEST(Simd, HardCase_OnHugePicturesNoAreaIsRounded) {
    look_up("Eq. 2.8");
    Dice dice(5);
    for (const int side : {16384, (1 << 17) - 1, 1 << 17, 1 << 20, (1 << 22) - 1, 1 << 22})
        for (int k = 0; k < 20; ++k) {
            TrianglesInClipSpace triangles;
            for (std::uint32_t i = 0; i < 32; ++i)
                triangles.add({inside(dice), inside(dice), inside(dice)});
            compare(triangles, {side, side});
        }
}
