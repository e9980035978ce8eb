// SPDX-License-Identifier: MIT
// The reference for shadows, against a loop over all triangles and against plain numbers.
#include <cmath>
#include <filesystem>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/model/obj.hpp"
#include "support/ray_cast.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// One triangle after the other.
std::optional<double> nearest_of_all(const Ray& ray, const RayCaster& caster) {
    std::optional<double> found;
    for (const RayTriangle& triangle : caster.triangles())
        if (const auto distance = distance_to(ray, triangle))
            if (!found || *distance < *found) found = distance;
    return found;
}

dvec3 any_in_cube(std::mt19937& random) {
    std::uniform_real_distribution<double> any(-1, 1);
    const double x = any(random), y = any(random), z = any(random);
    return {x, y, z};
}

}  // namespace

TEST(RayCast, MeetsATriangleInItsMiddleAndAtItsBorder) {
    const RayTriangle triangle = {dvec3(0, 0, 5), dvec3(4, 0, 5), dvec3(0, 4, 5)};
    const auto from = [](double x, double y) { return Ray{{x, y, 1}, {0, 0, 2}}; };
    EXPECT_EQ(distance_to(from(1, 1), triangle), 2.0);
    EXPECT_EQ(distance_to(from(0, 0), triangle), 2.0);
    EXPECT_EQ(distance_to(from(2, 2), triangle), 2.0);
    EXPECT_FALSE(distance_to(from(2.001, 2), triangle));
    EXPECT_FALSE(distance_to(from(-0.001, 2), triangle));
    EXPECT_FALSE(distance_to(Ray{{1, 1, 1}, {0, 0, -2}}, triangle)) << "behind";
    EXPECT_FALSE(distance_to(Ray{{1, 1, 1}, {0, 0, 2}, 0, 1.9}, triangle)) << "too far";
    EXPECT_FALSE(distance_to(Ray{{1, 1, 1}, {0, 0, 2}, 2.1}, triangle)) << "too near";
    EXPECT_FALSE(distance_to(Ray{{1, 1, 1}, {1, 0, 0}}, triangle)) << "parallel";
    EXPECT_EQ(distance_to(Ray{{1, 1, 9}, {0, 0, -2}}, triangle), 2.0) << "from behind";
}

TEST(RayCast, FindsTheSameAsALoopOverAllTriangles) {
    std::mt19937 random(1);
    for (const std::size_t count : {0u, 1u, 2u, 4u, 5u, 64u, 1000u}) {
        std::vector<RayTriangle> triangles;
        for (std::size_t i = 0; i < count; ++i) {
            const dvec3 middle = any_in_cube(random);
            RayTriangle triangle;
            for (dvec3& corner : triangle) corner = middle + 0.2 * any_in_cube(random);
            triangles.push_back(triangle);
            if (i % 7 == 0) triangles.push_back(triangle);  // two in one place
        }
        const RayCaster caster(std::move(triangles));
        int hits = 0;
        for (int i = 0; i < 3000; ++i) {
            Ray ray{2.0 * any_in_cube(random), any_in_cube(random)};
            if (i % 3 == 0) ray.direction[i / 3 % 3] = 0;
            if (i % 4 == 0) ray.from = 0.3, ray.to = 1.5;
            if (i % 5 == 0 && count > 0) {  // met at 1; by chance few are
                const auto all = caster.triangles();
                const RayTriangle& aim = all[static_cast<std::size_t>(i) % all.size()];
                ray.direction = (aim[0] + aim[1] + aim[2]) / 3.0 - ray.origin;
            }
            const auto expected = nearest_of_all(ray, caster);
            ASSERT_EQ(caster.nearest(ray), expected) << count << " triangles, seed 1, ray " << i;
            ASSERT_EQ(caster.is_blocked(ray), expected.has_value()) << count << ", ray " << i;
            hits += expected.has_value();
        }
        EXPECT_TRUE(count == 0 ? hits == 0 : hits >= 600) << count << ": " << hits;
    }
}

TEST(RayCast, FindsTheSameInTheScene) {
    const Scene scene = load_obj(std::filesystem::path(RASTERBOOK_ASSETS) / "models" / "scene.obj");
    const RayCaster caster = RayCaster::of(scene.meshes, [](std::size_t) { return true; });
    EXPECT_GT(caster.triangles().size(), 4000u);
    std::mt19937 random(2);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        const Ray ray{dvec3(scene.bounds().center()) + 6.0 * any_in_cube(random),
                      any_in_cube(random)};
        const auto expected = nearest_of_all(ray, caster);
        ASSERT_EQ(caster.nearest(ray), expected) << "seed 2, ray " << i;
        ASSERT_EQ(caster.is_blocked(ray), expected.has_value()) << "ray " << i;
        hits += expected.has_value();
    }
    EXPECT_GT(hits, 500);
}

TEST(RayCast, DoesNotSlipThroughWhereTrianglesMeet) {
    // A fan around the origin, as a lid: rays through its middle and along its seams.
    std::vector<RayTriangle> fan;
    constexpr int sides = 17;
    const auto rim = [](int i) {
        const double angle_radians = 2 * 3.14159265358979323846 * i / sides;
        return dvec3(std::cos(angle_radians), std::sin(angle_radians), 0);
    };
    for (int i = 0; i < sides; ++i) fan.push_back({dvec3(0), rim(i), rim(i + 1)});
    const RayCaster caster(fan);
    std::mt19937 random(3);
    for (int i = 0; i < 5000; ++i) {
        const double share = i % 50 / 51.0;
        const dvec3 aim = share * rim(i % sides);
        dvec3 origin = any_in_cube(random);
        origin.z = 1 + std::abs(origin.z);
        ASSERT_TRUE(caster.is_blocked({origin, aim - origin})) << "seed 3, ray " << i;
    }
}
