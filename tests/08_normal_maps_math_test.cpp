// SPDX-License-Identifier: MIT
// How exact frames and tilted normals are, against long double; and numbers of all kinds.
#include <array>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "06_phong/shading_variants.hpp"
#include "08_normal_maps/bumpy_scene.hpp"
#include "support/look_up.hpp"
#include "support/one_triangle.hpp"
#include "support/printers.hpp"
#include "support/reference.hpp"
#include "support/special_numbers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr int exact_cases = 200'000, special_cases = 1'000'000;

/// Half of the distance from 1 to the next number: what one rounding is off by, at most.
constexpr real half_ulp_of_float = 0x1p-24L, half_ulp_of_double = 0x1p-53L;

/// Numbers whose sizes are spread evenly over orders of magnitude.
class LogUniform {
  public:
    explicit LogUniform(unsigned seed) : random_(seed) {}
    float operator()() {
        const float size = std::pow(10.0f, exponent_(random_));
        return random_() & 1 ? size : -size;
    }
    vec2 two() {
        const float x = (*this)(), y = (*this)();
        return {x, y};
    }
    vec3 three() {
        const float x = (*this)(), y = (*this)(), z = (*this)();
        return {x, y, z};
    }
    /// Of length 1 but for the roundings of unit_or().
    vec3 direction() { return unit_or(three(), vec3(0, 1, 0)); }
    unsigned below(unsigned count) { return static_cast<unsigned>(random_()) % count; }

  private:
    std::mt19937 random_;
    std::uniform_real_distribution<float> exponent_{-8, 8};
};

lvec3 exact(vec3 v) { return {v.x, v.y, v.z}; }
lvec3 unit(lvec3 v) { return v / std::sqrt(glm::dot(v, v)); }
real length(lvec3 v) { return std::sqrt(glm::dot(v, v)); }

}  // namespace

TEST(NormalMaps, Eq8_3_DirectionsAsExactAsTheDocumentationSays) {
    LogUniform any(1);
    int judged = 0, with_area = 0;
    for (int i = 0; i < exact_cases; ++i) {
        const std::array p{any.three(), any.three(), any.three()};
        const std::array t{any.two(), any.two(), any.two()};
        const UvDirections found = uv_directions(p, t);

        const lvec3 e1 = exact(p[1]) - exact(p[0]), e2 = exact(p[2]) - exact(p[0]);
        const real u1 = real{t[1].x} - t[0].x, v1 = real{t[1].y} - t[0].y;
        const real u2 = real{t[2].x} - t[0].x, v2 = real{t[2].y} - t[0].y;
        const real determinant = u1 * v2 - u2 * v1;
        // Two differences, two products and their difference round, each by half an ulp of double.
        const real unsure = 4 * half_ulp_of_double * (std::abs(u1 * v2) + std::abs(u2 * v1));
        if (std::abs(determinant) <= unsure) continue;
        ++with_area;
        ASSERT_EQ(found.handedness, determinant > 0 ? 1 : -1) << "seed 1, case " << i;

        const real sign = found.handedness;
        for (const auto& [direction, raw, sizes] :
             {std::tuple{found.tangent, sign * (v2 * e1 - v1 * e2),
                         std::abs(v2) * length(e1) + std::abs(v1) * length(e2)},
              {found.bitangent, sign * (u1 * e2 - u2 * e1),
               std::abs(u2) * length(e1) + std::abs(u1) * length(e2)}}) {
            // The same roundings; scaling to length 1 may double what is off across the vector.
            const real off = 2 * 4 * half_ulp_of_double * sizes / length(raw);
            if (!(off < 0.1L)) continue;  // all digits are lost to cancellation
            ++judged;
            const real tolerance = off + 2 * half_ulp_of_float;  // and to float, three components
            ASSERT_TRUE(is_near(length(exact(direction) - unit(raw)), 0, tolerance))
                << "seed 1, case " << i;
        }
    }
    EXPECT_GT(with_area, exact_cases * 9 / 10);
    EXPECT_GT(judged, exact_cases);
}

TEST(NormalMaps, Eq8_5_FramesAsExactAsTheDocumentationSays) {
    LogUniform any(2);
    // What is left of t across n, of length s times that of t: the dot product is off by 3 half
    // ulps, by 10 more of n's length, the product and the difference by 1 each; then |.| by 5.
    constexpr real of_left = 15 * half_ulp_of_float, of_length = 5 * half_ulp_of_float;
    int judged = 0;
    for (int i = 0; i < exact_cases; ++i) {
        const vec3 n = any.direction(), t = any.three();
        const float handedness = any.below(2) ? 1.0f : -1.0f;
        const TangentFrame frame = tangent_frame(t, n, handedness);
        // n is scaled once more in there: that is within the 10.
        const lvec3 normal = unit(exact(n)), tangent = unit(exact(t));
        const lvec3 left = tangent - glm::dot(tangent, normal) * normal;
        const real s = length(left);
        ASSERT_LE(std::abs(glm::dot(exact(frame.tangent), normal)), 1e-6L) << "seed 2, case " << i;
        ASSERT_TRUE(is_near(length(exact(frame.tangent)), 1, 2 * of_length)) << "case " << i;
        if (s < 1e-5L) continue;  // no digit is left of it
        ++judged;
        const real tolerance = 2 * of_left / s + of_length;
        ASSERT_TRUE(is_near(length(exact(frame.tangent) - unit(left)), 0, tolerance))
            << "seed 2, case " << i << ", s " << s;
        const lvec3 bitangent = real{handedness} * glm::cross(normal, unit(left));
        ASSERT_TRUE(
            is_near(length(exact(frame.bitangent) - bitangent), 0, tolerance + 2 * of_length))
            << "seed 2, case " << i << ", s " << s;
    }
    EXPECT_GT(judged, exact_cases / 2);
}

TEST(NormalMaps, Eq8_7_TiltedNormalsAsExactAsFloatsAllow) {
    LogUniform any(3);
    for (int i = 0; i < exact_cases; ++i) {
        const TangentFrame frame =
            tangent_frame(any.direction(), any.direction(), any.below(2) ? 1.0f : -1.0f);
        const vec3 in_map = any.three();
        const vec3 found = tilted(frame, in_map, frame.normal);
        for (int axis = 0; axis < 3; ++axis) {
            Sum sum;
            sum.add(real{in_map.x} * frame.tangent[axis]);
            sum.add(real{in_map.y} * frame.bitangent[axis]);
            sum.add(real{in_map.z} * frame.normal[axis]);
            // Three products and two sums.
            ASSERT_TRUE(
                is_near(found[axis], sum.value, 3 * half_ulp_of_float * sum.of_sizes + FLT_MIN))
                << "seed 3, case " << i;
        }
    }
}

namespace {

/// A scene of one triangle, to be given any numbers, under one texture of normals.
struct Bumpy {
    struct Options {
        TextureOptions texture;
        LightOptions shading;
        NormalMapVariant normal_map;
    };

    Options options;
    BumpyScene scene;

    explicit Bumpy(const Image<vec4>& normals) : scene(scene_of_one_triangle(), options) {
        scene.normal_textures[0] = std::make_shared<Texture>(make_texture(normals, Wrap::repeat));
    }
    Mesh& mesh() { return scene.meshes[0]; }
    std::array<vec2, 3> uvs() { return {mesh().uvs[0], mesh().uvs[1], mesh().uvs[2]}; }

  private:
    static Scene scene_of_one_triangle() {
        Scene scene;
        scene.materials.resize(1);
        scene.materials[0].specular = vec3(1);
        scene.materials[0].shininess = 5;
        scene.meshes.push_back(mesh_of({vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)}, {{0, 1, 2}}));
        scene.meshes[0].uvs = {vec2(0), vec2(1, 0), vec2(0, 1)};
        for (std::uint32_t i = 0; i < 3; ++i) scene.meshes[0].triangles[0].corners[i].uv = i;
        return scene;
    }
};

}  // namespace

TEST(NormalMaps, HardCase_SpecialNumbersOfFrames) {
    look_up("Eq. 8.5, where nothing is left");
    SpecialNumbers mix(4);
    for (int i = 0; i < special_cases; ++i) {
        const std::array p{mix.any_three(), mix.any_three(), mix.any_three()};
        const std::array t{mix.any_two(), mix.any_two(), mix.any_two()};
        const UvDirections found = uv_directions(p, t);
        for (const vec3 direction : {found.tangent, found.bitangent})
            ASSERT_TRUE(direction == vec3(0) ||
                        std::abs(glm::length(direction) - 1) <= 2 * FLT_EPSILON)
                << "seed 4, case " << i;
        const vec3 normal = mix.any_three(), tangent = i % 2 ? found.tangent : mix.any_three();
        const float handedness = mix.below(2) ? 1.0f : -1.0f;
        const auto [frame_t, frame_b, frame_n] = tangent_frame(tangent, normal, handedness);
        const dvec3 a = frame_t, b = frame_b, n = frame_n;
        for (const double off : {glm::length(a) - 1, glm::length(b) - 1, glm::length(n) - 1,
                                 glm::dot(a, n), glm::dot(b, n), glm::dot(a, b)})
            ASSERT_LE(std::abs(off), 1e-6) << "seed 4, case " << i;
        ASSERT_GT(handedness * glm::dot(glm::cross(n, a), b), 0.9) << "seed 4, case " << i;
    }
}

TEST(NormalMaps, HardCase_SpecialNumbersOfPoints) {
    look_up("Eq. 8.7");
    SpecialNumbers mix(5);
    // Normals as no file holds them: of any length, and pointing into the surface.
    Image<vec4> normals({4, 4});
    for (vec4& n : normals.pixels()) n = vec4(glm::clamp(mix.place(), -1e8f, 1e8f), 1);
    Bumpy bumpy(normals);
    const std::array lights{sun(unit_or({1, 2, 3}, vec3(0, 1, 0))),
                            Light{LightKind::point, vec3(1), vec3(0), vec3(2, 1, 0)}};
    int lit = 0;
    for (int i = 0; i < special_cases / 8; ++i) {
        Mesh& mesh = bumpy.mesh();
        mesh.positions = {mix.place(), mix.place(), mix.place()};
        mesh.normals = {mix.any_three(), mix.any_three(), mix.any_three()};
        for (vec2& uv : mesh.uvs) uv = mix.any_two();
        for (std::uint32_t k = 0; k < 3; ++k)
            mesh.triangles[0].corners[k].normal = mix.below(16) == 0 ? no_index : k;
        complete_normals(mesh);
        NormalMapVariant variant;
        variant.frame = static_cast<FrameOf>(mix.below(3));
        variant.orthonormal = static_cast<Orthonormal>(mix.below(2));
        variant.channels = static_cast<Channels>(mix.below(2));
        bumpy.scene.normal_spaces[0] = static_cast<MapSpace>(mix.below(2));
        bumpy.scene.materials[0].normal_map.bump_multiplier = mix.any();
        bumpy.scene.materials[0].bump_map.bump_multiplier = mix.any();
        bumpy.scene.tangents[0] =
            vertex_tangents(mesh, [&](const Triangle&) { return bumpy.uvs(); });
        for (const vec4 tangent : bumpy.scene.tangents[0])
            ASSERT_NEAR(glm::length(vec3(tangent)), 1, 1e-6) << "seed 5, case " << i;

        const Triangle& triangle = mesh.triangles[0];
        const bool is_back = mix.below(2) == 0;
        const TriangleSurface surface(bumpy.scene, mesh, triangle);
        const TriangleRelief relief(variant, bumpy.scene, mesh, triangle, is_back);
        const TriangleLight light({}, lights, mix.place(), mesh, triangle, is_back, surface);
        ManyWeights weights;
        while (weights.count < 8) {
            const float x = static_cast<float>(mix.below(5)) / 4;
            const float y = (1 - x) * static_cast<float>(mix.below(5)) / 4;
            weights.set(weights.count++, {{x, y, 1 - x - y}, mix.any_three(), mix.any_three()});
        }
        BumpyPoints points;
        NoCounters none;
        light.add(weights, points, none);
        relief.add(weights, static_cast<Filter>(mix.below(3)), points, none);
        relief.tilt(points);
        light.compute(points);
        for (std::size_t point = 0; point < points.count; ++point) {
            const ReflectedLight found = points.light(point);
            ASSERT_TRUE(is_finite(found.diffuse) && is_finite(found.specular))
                << "seed 5, case " << i << ", point " << point;
            ASSERT_GE(std::min(found.diffuse.x, found.specular.x), 0) << "seed 5, case " << i;
            ASSERT_LE(std::max(found.diffuse.x, found.specular.x), 2.001f) << "seed 5, case " << i;
            lit += found.diffuse.x > 0;
        }
    }
    EXPECT_GT(lit, special_cases / 10);
}

TEST(NormalMaps, HardCase_ManyPointsAtOnceAreTiltedAsOne) {
    look_up("Eq. 8.5 and 8.7");
    std::mt19937 random(6);
    std::uniform_real_distribution<float> any(-1, 1);
    const auto some = [&] { return vec3(any(random), any(random), any(random)); };
    Image<vec4> normals({8, 8});
    for (vec4& n : normals.pixels()) n = vec4(some() + vec3(0, 0, 1.5f), 1);
    normals[{3, 3}] = normals[{3, 4}] = {0, 0, 1, 1};
    Bumpy bumpy(normals);
    for (int i = 0; i < 2000; ++i) {
        Mesh& mesh = bumpy.mesh();
        mesh.positions = {some(), some(), some()};
        mesh.normals = {some(), some(), some()};
        for (std::uint32_t k = 0; k < 3; ++k) mesh.triangles[0].corners[k].normal = k;
        for (vec2& uv : mesh.uvs) uv = vec2(some());
        complete_normals(mesh);
        bumpy.scene.tangents[0] =
            vertex_tangents(mesh, [&](const Triangle&) { return bumpy.uvs(); });
        NormalMapVariant variant;
        if (i % 2) variant.frame = FrameOf::pixel;
        const TriangleRelief relief(variant, bumpy.scene, mesh, mesh.triangles[0], i % 3 == 0);
        const TriangleSurface surface(bumpy.scene, mesh, mesh.triangles[0]);
        const TriangleLight light({}, {}, vec3(0), mesh, mesh.triangles[0], i % 3 == 0, surface);
        NoCounters none;
        ManyWeights weights;
        while (weights.count < 20) {
            const float x = 0.05f * static_cast<float>(weights.count), y = (1 - x) * 0.3f;
            weights.set(weights.count++, {{x, y, 1 - x - y}, vec3(0), vec3(0)});
        }
        BumpyPoints together;
        light.add(weights, together, none);
        relief.add(weights, Filter::nearest, together, none);
        std::vector<vec3> alone;  // by the plain steps
        for (std::size_t k = 0; k < together.count; ++k) {
            const vec3 mixed = together.normal_world[k];
            const float side = i % 3 == 0 ? -1.0f : 1.0f;
            const UvDirections of_face = uv_directions(
                {mesh.positions[0], mesh.positions[1], mesh.positions[2]}, bumpy.uvs());
            const auto& tangents = bumpy.scene.tangents[0];
            std::array<vec3, 3> corners;
            for (std::size_t c = 0; c < 3; ++c)
                corners[c] = i % 2 ? of_face.tangent : vec3(tangents[c]);
            const vec3 tangent = interpolate(corners, weights.here[k]);
            const TangentFrame frame = tangent_frame(
                side * tangent, mixed, side * static_cast<float>(of_face.handedness < 0 ? -1 : 1));
            alone.push_back(tilted(frame, together.in_map[k], mixed));
        }
        relief.tilt(together);
        for (std::size_t k = 0; k < alone.size(); ++k)
            ASSERT_EQ(together.normal_world[k], alone[k])
                << "seed 6, case " << i << ", " << k
                << "; TriangleRelief takes the steps that unit_across() documents";
    }
}
