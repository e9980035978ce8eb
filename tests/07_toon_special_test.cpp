// SPDX-License-Identifier: MIT
// Zeros, subnormal numbers, infinities and NaN as inputs: every colour is finite.
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "07_toon/outline.hpp"
#include "lab/toon_methods.hpp"
#include "support/look_up.hpp"
#include "support/printers.hpp"
#include "support/special_numbers.hpp"
#include "support/toon_pictures.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr int cases = 300'000;

/// Special numbers, and colours of such.
class Mix : public SpecialNumbers {
  public:
    using SpecialNumbers::SpecialNumbers;

    vec3 color() { return glm::clamp(place(), -1e37f, 1e37f); }
    SurfaceColor surface() {
        const vec3 ambient = color(), diffuse = color(), specular = color();
        return {ambient, diffuse, specular, color()};
    }
};

/// Three triangles of any vertices and normals, of a material of any numbers.
Scene any_scene(Mix& mix, bool is_ordinary_position) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < 9; ++i) {
        mesh.positions.push_back(is_ordinary_position
                                     ? vec3(mix.ordinary(), mix.ordinary(), mix.ordinary())
                                     : mix.place());
        mesh.normals.push_back(mix.any_three());
        mesh.bounds.add(mesh.positions.back());
    }
    for (std::uint32_t i = 0; i < 9; i += 3)
        mesh.triangles.push_back({{Vertex{i, no_index, mix.below(4) == 0 ? no_index : i},
                                   Vertex{i + 1, no_index, i + 1}, Vertex{i + 2, no_index, i + 2}},
                                  0});
    Scene scene = scene_of_one(mesh);
    Material& material = scene.materials[0];
    const SurfaceColor color = mix.surface();
    material.ambient = color.ambient, material.diffuse = color.diffuse;
    material.specular = color.specular, material.emission = color.emission;
    material.shininess = std::abs(mix.finite());
    material.illumination = static_cast<int>(mix.below(3));
    return scene;
}

}  // namespace

TEST(Toon, HardCase_SpecialNumbersOfPaint) {
    look_up("Eq. 7.4");
    Mix mix(1);
    for (int i = 0; i < cases; ++i) {
        const SurfaceColor color = mix.surface();
        const ReflectedLight light{glm::min(glm::abs(mix.place()), vec3(20)),
                                   glm::min(glm::abs(mix.place()), vec3(20))};
        const int tones = 1 + static_cast<int>(mix.below(max_tones));
        ASSERT_TRUE(is_finite(toon(color, vec3(0.5f), light, tones))) << "seed 1, case " << i;
        const vec3 of_nothing = toon(color, vec3(0.5f), {mix.any_three(), mix.any_three()}, tones);
        ASSERT_TRUE(is_finite(of_nothing)) << "seed 1, case " << i;
        const float level = smoothly_quantised(mix.any(), mix.any(), tones);
        ASSERT_TRUE(level >= 0 && level <= 1) << "seed 1, case " << i << ": " << level;
        const float share = highlight_share(brightness(mix.any_three()), mix.any());
        ASSERT_TRUE(share >= 0 && share <= 1) << "seed 1, case " << i << ": " << share;
    }
}

TEST(Toon, HardCase_SpecialNumbersOfHulls) {
    look_up("Eq. 7.9");
    Mix mix(2);
    for (int i = 0; i < cases; ++i) {
        const vec4 position(mix.place(), mix.finite());
        const vec4 normal(mix.any_three(), mix.any());
        const vec4 at = pushed(position, normal, 3, {640, 360});
        ASSERT_EQ(at.z, position.z) << "seed 2, case " << i;
        ASSERT_EQ(at.w, position.w) << "seed 2, case " << i;
        if (std::abs(position.w) < 1e37f) { ASSERT_TRUE(is_finite(at)) << "seed 2, case " << i; }
        Mesh mesh = any_scene(mix, false).meshes[0];
        mesh.positions[mix.below(9)] = mix.any_three();
        mesh.positions[mix.below(9)] = mesh.positions[mix.below(9)];
        if (i % 10 == 0)
            for (const vec3 direction : hull_normals(mesh)) {
                const float length = glm::length(direction);
                ASSERT_TRUE(length == 0 || std::abs(length - 1) < 1e-6f) << "seed 2, case " << i;
            }
    }
}

TEST(Toon, HardCase_SpecialNumbersInPictures) {
    look_up("Eq. 7.6");
    Mix mix(3);
    int drawn = 0, inked = 0;
    for (int i = 0; i < 3000; ++i) {
        const Scene scene = any_scene(mix, i % 2 == 0);
        lesson_07::Options options;
        options.size = {48, 27};
        options.shading.outline = static_cast<Outline>(mix.below(4));
        options.shading.key_light = static_cast<LightKind>(mix.below(3));
        options.shading.two_sided = mix.below(2) == 0;
        options.shading.tones = 1 + static_cast<int>(mix.below(max_tones));
        options.shading.outline_width_px = mix.below(2) == 0 ? 2.0f : 64.0f;
        const Image<vec3> picture = toon_picture(scene, options);
        for (const vec3 color : picture.pixels())
            ASSERT_TRUE(is_finite(color)) << "seed 3, case " << i;
        const Image<Seen> seen = seen_in(picture);
        drawn += count_of(seen, Seen::body) > 0;
        inked += count_of(seen, Seen::ink) > 0;
    }
    EXPECT_GT(drawn, 1000);
    EXPECT_GT(inked, 500);
}

TEST(Toon, HardCase_SilhouettesAreNeverNaN) {
    look_up("Eq. 7.6");
    // At a silhouette normals are seen edge-on, and interpolated ones point away from the eye.
    const Scene scene = [] {
        Scene figure = scene_of_one(cube_mesh(true));
        for (const vec3 position : figure.meshes[0].positions)
            figure.meshes[0].normals.push_back(position);  // far too smooth for a cube
        for (Triangle& triangle : figure.meshes[0].triangles)
            for (Vertex& vertex : triangle.vertices) vertex.normal = vertex.position;
        figure.materials[0].specular = vec3(1), figure.materials[0].shininess = 1e30f;
        return figure;
    }();
    for (const Outline outline : {Outline::facing, Outline::hull, Outline::edges})
        for (int yaw = 0; yaw < 90; yaw += 15) {
            lesson_07::Options options = small_toon();
            options.orbit = {static_cast<float>(yaw), 0, 3, 36};
            options.shading.outline = outline;
            const Image<vec3> picture = toon_picture(scene, options);
            for (const vec3 color : picture.pixels())
                ASSERT_TRUE(is_finite(color) && color.x >= 0 && color.x <= 1);
        }
}
