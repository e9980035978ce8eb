// SPDX-License-Identifier: MIT
// The accuracy of tangent frames and perturbed normals, against long double; and special numbers.
#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <tuple>

#include <gtest/gtest.h>

#include "06_phong/effects.hpp"
#include "06_phong/normals.hpp"
#include "06_phong/surface.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "08_normal_maps/vertex_tangents.hpp"
#include "lab/normal_map_methods.hpp"
#include "support/cases.hpp"
#include "support/look_up.hpp"
#include "support/one_triangle.hpp"
#include "support/printers.hpp"
#include "support/reference.hpp"
#include "support/special_numbers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr int exact_cases = cases_of(200'000), special_cases = 1'000'000;

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

/// A triangle with its texture coordinates, and what they differ by, exact.
struct UvTriangle {
    explicit UvTriangle(LogUniform& any)
        : positions{any.three(), any.three(), any.three()}, uvs{any.two(), any.two(), any.two()} {}

    bool has_uv_area() const {
        // Two differences, two products and their difference round, each by half an ulp of double.
        const real unsure = 4 * half_ulp_of_double * (std::abs(u1 * v2) + std::abs(u2 * v1));
        return std::abs(determinant) > unsure;
    }

    std::array<vec3, 3> positions;
    std::array<vec2, 3> uvs;
    real u1 = real{uvs[1].x} - uvs[0].x, v1 = real{uvs[1].y} - uvs[0].y;
    real u2 = real{uvs[2].x} - uvs[0].x, v2 = real{uvs[2].y} - uvs[0].y;
    real determinant = u1 * v2 - u2 * v1;
};

}  // namespace

TEST(NormalMaps, Eq8_3_DirectionsAsExactAsTheDocumentationSays) {
    LogUniform any(1);
    int judged = 0;
    for (int i = 0; i < exact_cases; ++i) {
        const UvTriangle t(any);
        if (!t.has_uv_area()) continue;
        const UvDirections found = uv_directions(t.positions, t.uvs);

        const auto& p = t.positions;
        const lvec3 e1 = exact(p[1]) - exact(p[0]), e2 = exact(p[2]) - exact(p[0]);
        const real sign = t.determinant > 0 ? 1 : -1;
        for (const auto& [direction, raw, sizes] :
             {std::tuple{found.tangent, sign * (t.v2 * e1 - t.v1 * e2),
                         std::abs(t.v2) * length(e1) + std::abs(t.v1) * length(e2)},
              {found.bitangent, sign * (t.u1 * e2 - t.u2 * e1),
               std::abs(t.u2) * length(e1) + std::abs(t.u1) * length(e2)}}) {
            // The same roundings; scaling to length 1 may double what is off across the vector.
            const real off = 2 * 4 * half_ulp_of_double * sizes / length(raw);
            if (!(off < 0.1L)) continue;  // all digits are lost to cancellation
            ++judged;
            const real tolerance = off + 2 * half_ulp_of_float;  // and to float, three components
            ASSERT_TRUE(is_near(length(exact(direction) - unit(raw)), 0, tolerance))
                << "seed 1, case " << i;
        }
    }
    EXPECT_GT(judged, exact_cases);
}

TEST(NormalMaps, Eq8_4_HandednessIsTheSignOfTheDeterminant) {
    LogUniform any(7);
    int with_area = 0;
    for (int i = 0; i < exact_cases; ++i) {
        const UvTriangle t(any);
        if (!t.has_uv_area()) continue;
        ++with_area;
        ASSERT_EQ(uv_directions(t.positions, t.uvs).handedness, t.determinant > 0 ? 1 : -1)
            << "the determinant is " << t.determinant << " (seed 7, case " << i << ")";
    }
    EXPECT_GT(with_area, exact_cases * 9 / 10);
}

TEST(NormalMaps, HardCase_FramesAsExactAsTheDocumentationSays) {
    look_up("Robust: Where little is left");
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

TEST(NormalMaps, Eq8_7_PerturbedNormalsAsExactAsFloatsAllow) {
    LogUniform any(3);
    for (int i = 0; i < exact_cases; ++i) {
        const TangentFrame frame{any.direction(), any.direction(), any.direction()};
        const vec3 in_map = any.three();
        const vec3 found = perturbed(frame, in_map, frame.normal);
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

/// A triangle to be given any numbers, with a normal map and a highlight.
struct NormalMappedTriangle {
    Scene scene = scene_of_one_triangle();
    NormalMaps maps;

    explicit NormalMappedTriangle(const Image<vec4>& normals)
        : maps{{std::make_shared<Texture>(make_texture(normals, Wrap::repeat))},
               {MapSpace::tangent}} {}

    Mesh& mesh() { return scene.meshes[0]; }
    const std::array<vec2, 3>& uvs() const { return uvs_; }

    void set_uvs(const std::array<vec2, 3>& uvs) {
        uvs_ = uvs;
        mesh().uvs = {uvs[0], uvs[1], uvs[2]};
    }

    /// To be called again after any change.
    void make_tangents() {
        mesh().tangents = vertex_tangents(mesh(), [&](const Triangle&) { return uvs_; });
    }

    ProjectedTriangle seen(bool is_back) const {
        return not_on_screen(scene.meshes[0], scene.meshes[0].triangles[0], is_back);
    }
    TriangleSurface surface(bool is_back) const {
        return triangle_surface(scene, textures_, plan_effects(scene, textures_, maps, false)[0],
                                seen(is_back));
    }

  private:
    static Scene scene_of_one_triangle() {
        Scene scene;
        scene.materials.resize(1);
        scene.materials[0].specular = vec3(1);
        scene.materials[0].shininess = 5;
        scene.meshes.push_back(mesh_of({vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)}, {{0, 1, 2}}));
        for (std::uint32_t i = 0; i < 3; ++i) scene.meshes[0].triangles[0].vertices[i].uv = i;
        return scene;
    }

    SurfaceTextures textures_{MaterialTextures(1), MaterialTextures(1), MaterialTextures(1)};
    std::array<vec2, 3> uvs_{};
};

}  // namespace

TEST(NormalMaps, HardCase_SpecialNumbersOfFrames) {
    look_up("Robust: Where no tangent is left");
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
    // Normals as no file has them: of any length, and pointing into the surface.
    Image<vec4> normals({4, 4});
    for (vec4& n : normals.pixels()) n = vec4(glm::clamp(mix.place(), -1e8f, 1e8f), 1);
    NormalMappedTriangle mapped(normals);
    const std::array lights{sun(unit_or({1, 2, 3}, vec3(0, 1, 0))),
                            Light{LightKind::point, vec3(1), vec3(0), vec3(2, 1, 0)}};
    int lit = 0;
    for (int i = 0; i < special_cases / 8; ++i) {
        Mesh& mesh = mapped.mesh();
        mesh.positions = {mix.place(), mix.place(), mix.place()};
        mesh.normals = {mix.any_three(), mix.any_three(), mix.any_three()};
        mapped.set_uvs({mix.any_two(), mix.any_two(), mix.any_two()});
        for (std::uint32_t k = 0; k < 3; ++k)
            mesh.triangles[0].vertices[k].normal = mix.below(16) == 0 ? no_index : k;
        complete_normals(mesh);
        NormalMapMethod method;
        method.frame = static_cast<FrameOf>(mix.below(3));
        method.orthonormal = static_cast<Orthonormal>(mix.below(2));
        method.channels = static_cast<Channels>(mix.below(2));
        mapped.maps.spaces[0] = static_cast<MapSpace>(mix.below(2));
        mapped.scene.materials[0].normal_map.bump_multiplier = mix.any();
        mapped.scene.materials[0].bump_map.bump_multiplier = mix.any();
        mapped.make_tangents();
        for (const vec4 tangent : mesh.tangents)
            ASSERT_NEAR(glm::length(vec3(tangent)), 1, 1e-6) << "seed 5, case " << i;

        const bool is_back = mix.below(2) == 0;
        const TriangleSurface surface = mapped.surface(is_back);
        const NormalMapOf map =
            triangle_normal_map(method, mapped.scene, mapped.maps, mapped.seen(is_back));
        const vec3 eye = mix.place();
        const auto filter = static_cast<Filter>(mix.below(3));
        for (int k = 0; k < 8; ++k) {
            const float x = static_cast<float>(mix.below(5)) / 4;
            const float y = (1 - x) * static_cast<float>(mix.below(5)) / 4;
            const FragmentBarycentrics at{{x, y, 1 - x - y}, mix.any_three(), mix.any_three()};
            const vec3 normal =
                normal_mapped(method, map, at, interpolate(surface.normals_world, at.here), filter);
            const SurfacePoint<float> point = surface_point(surface, at.here, normal, eye);
            const ReflectedLight found =
                reflected_light(std::span(lights), point, highlight_of(surface));
            ASSERT_TRUE(is_finite(found.diffuse) && is_finite(found.specular))
                << "seed 5, case " << i << ", point " << k;
            ASSERT_GE(std::min(found.diffuse.x, found.specular.x), 0) << "seed 5, case " << i;
            ASSERT_LE(std::max(found.diffuse.x, found.specular.x), 2.001f) << "seed 5, case " << i;
            lit += found.diffuse.x > 0;
        }
    }
    EXPECT_GT(lit, special_cases / 10);
}

TEST(NormalMaps, Eq8_6_TheNormalOfAFragmentTakesTheStepsOfTheText) {
    // Which tangents, which side and which handedness: the same bits as by hand.
    std::mt19937 random(6);
    std::uniform_real_distribution<float> any(-1, 1);
    const auto some = [&] { return vec3(any(random), any(random), any(random)); };
    Image<vec4> normals({8, 8});
    for (vec4& n : normals.pixels()) n = vec4(some() + vec3(0, 0, 1.5f), 1);
    normals[{3, 3}] = normals[{3, 4}] = {0, 0, 1, 1};
    NormalMappedTriangle mapped(normals);
    for (int i = 0; i < 2000; ++i) {
        Mesh& mesh = mapped.mesh();
        mesh.positions = {some(), some(), some()};
        mesh.normals = {some(), some(), some()};
        for (std::uint32_t k = 0; k < 3; ++k) mesh.triangles[0].vertices[k].normal = k;
        mapped.set_uvs({vec2(some()), vec2(some()), vec2(some())});
        if (i % 7 == 0) mapped.set_uvs({vec2(0), vec2(0), vec2(0)});  // it has no handedness
        complete_normals(mesh);
        mapped.make_tangents();
        NormalMapMethod method;
        if (i % 2) method.frame = FrameOf::pixel;
        const bool is_back = i % 3 == 0;
        const float side = is_back ? -1.0f : 1.0f;
        const NormalMapOf map =
            triangle_normal_map(method, mapped.scene, mapped.maps, mapped.seen(is_back));
        const UvDirections of_face =
            uv_directions({mesh.positions[0], mesh.positions[1], mesh.positions[2]}, mapped.uvs());
        std::array<vec3, 3> tangents, vertex_normals;
        for (std::size_t v = 0; v < 3; ++v) {
            tangents[v] = i % 2 ? of_face.tangent : vec3(mesh.tangents[v]);
            vertex_normals[v] = side * mesh.normals[v];
        }
        for (int k = 0; k < 20; ++k) {
            const float x = 0.05f * static_cast<float>(k), y = (1 - x) * 0.3f;
            const FragmentBarycentrics at{{x, y, 1 - x - y}, vec3(0), vec3(0)};
            const vec3 normal = interpolate(vertex_normals, at.here);
            const vec3 found = normal_mapped(method, map, at, normal, Filter::nearest);

            const vec3 tangent = interpolate(tangents, at.here);
            const TangentFrame frame = tangent_frame(
                side * tangent, normal, side * static_cast<float>(of_face.handedness < 0 ? -1 : 1));
            const vec3 in_map = sample_normal(*mapped.maps.textures[0], Filter::nearest,
                                              fragment_uv(mapped.uvs(), at));
            ASSERT_EQ(found, perturbed(frame, in_map, normal))
                << "seen from " << (is_back ? "behind" : "in front") << ", tangents of "
                << (i % 2 ? "the face" : "the vertices") << ": interpolated, then Eq. 8.5 and 8.7 "
                << "(seed 6, case " << i << ", " << k << ")";
        }
    }
}
