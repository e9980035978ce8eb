// SPDX-License-Identifier: MIT
// Shadows of surfaces with holes, against rays from the floor to the light.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "10_threading/thread_pool.hpp"
#include "11_scenes/scene_assets.hpp"
#include "common/image/bmp.hpp"
#include "support/any_scene.hpp"
#include "support/lesson_11.hpp"
#include "support/one_triangle.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// A leaf of side 2 at y = 1 above a floor, and a light. Its texture has holes in squares.
struct Leaf {
    int texels;                ///< A side of the texture.
    std::vector<float> alpha;  ///< Of each texel, row by row from the top.
    vec2 uv_first,
        uv_step;  ///< At the corner of least x and z, and what they grow by to the other.
    Wrap wrap;
    float opacity, vertex_alpha, cutoff;
    SceneLight light;

    /// Whether it is there at a point of its plane.
    bool is_there(vec2 x_z) const {
        return glm::all(glm::lessThan(glm::abs(x_z), vec2(1))) &&
               opacity * vertex_alpha * alpha_at(uv_first + uv_step * (x_z + 1.0f) / 2.0f) >=
                   cutoff;
    }

  private:
    float alpha_at(vec2 uv) const {
        for (int i = 0; i < 2; ++i) {
            const float whole = std::floor(uv[i]);
            const bool is_odd = std::fmod(std::abs(whole), 2.0f) == 1;
            uv[i] = wrap == Wrap::clamp ? std::clamp(uv[i], 0.0f, 0.9999f) : uv[i] - whole;
            if (wrap == Wrap::mirror && is_odd) uv[i] = 1 - uv[i];
        }
        const ivec2 texel = glm::min(ivec2(uv * static_cast<float>(texels)), texels - 1);
        return alpha[static_cast<std::size_t>((texels - 1 - texel.y) * texels + texel.x)];
    }
};

Leaf any_leaf(Dice& dice) {
    Leaf leaf{.texels = 2 + static_cast<int>(dice.below(4))};
    for (int i = 0; i < leaf.texels * leaf.texels; ++i)
        leaf.alpha.push_back(dice.one_in(2) ? 1 : dice.between(0, 0.6f));
    leaf.uv_first = {dice.between(-3, 3), dice.between(-3, 3)};
    leaf.uv_step = {dice.between(0.5f, 1.6f) * (dice.one_in(2) ? 1 : -1), dice.between(0.5f, 1.6f)};
    constexpr std::array wraps = {Wrap::repeat, Wrap::mirror, Wrap::clamp};
    leaf.wrap = wraps.at(dice.below(3));
    if (leaf.wrap == Wrap::clamp) leaf.uv_first = {0.3f, -0.2f};
    leaf.opacity = dice.one_in(2) ? 1 : dice.between(0.7f, 1);
    leaf.vertex_alpha = dice.one_in(2) ? 1 : dice.between(0.7f, 1);
    leaf.cutoff = dice.between(0.2f, 0.8f);
    constexpr std::array kinds = {SceneLight::Kind::directional, SceneLight::Kind::point,
                                  SceneLight::Kind::spot};
    const vec3 position(dice.between(-1, 1), dice.between(3, 5), dice.between(-1, 1));
    leaf.light = {"light",  kinds.at(dice.below(3)),   vec3(9),
                  position, -glm::normalize(position), 100};
    return leaf;
}

constexpr float camera_height = 0.95f;

/// Between leaf and floor, looking down; to the right is +x, upwards -z.
mat4 camera_position_and_turn() {
    return mat4(vec4(1, 0, 0, 0), vec4(0, 0, -1, 0), vec4(0, 1, 0, 0),
                vec4(0, camera_height, 0, 1));
}

Scene scene_of(const Leaf& leaf) {
    Scene scene;
    scene.is_gltf = true;
    scene.materials.resize(3);
    scene.materials[1].ambient = vec3(0);
    Material& material = scene.materials[2];
    material.alpha = AlphaMode::mask, material.alpha_cutoff = leaf.cutoff;
    material.opacity = leaf.opacity, material.two_sided = true;
    material.diffuse_map.file = "takes the place of the leaf's texture";
    material.diffuse_map.embedded =
        std::make_shared<const Bytes>(encode_bmp(Image<u8vec3>({1, 1}), "a texel"));
    const auto square = [&](float side, float y, std::uint32_t of) {
        Mesh mesh =
            mesh_of({{-side, y, -side}, {-side, y, side}, {side, y, side}, {side, y, -side}},
                    {{0, 1, 2}, {0, 2, 3}});
        for (Triangle& triangle : mesh.triangles) {
            triangle.material = of;
            for (Vertex& vertex : triangle.vertices) vertex.uv = vertex.position;
        }
        const float s = leaf.uv_step.x, t = leaf.uv_step.y;
        for (const vec2 grown : {vec2(0), vec2(0, t), vec2(s, t), vec2(s, 0)})
            mesh.uvs.push_back(leaf.uv_first + grown);
        mesh.colors.assign(4, vec4(1, 1, 1, leaf.vertex_alpha));
        scene.meshes.push_back(mesh);
    };
    square(6, 0, 1), square(1, 1, 2);
    scene.lights = {leaf.light};
    scene.cameras = {{"between leaf and floor", camera_position_and_turn(), 2, 0.05f, 100}};
    return scene;
}

/// The alphas as a texture.
std::shared_ptr<const Texture> texture_of(const Leaf& leaf) {
    Image<vec4> picture(ivec2(leaf.texels));
    for (std::size_t i = 0; i < leaf.alpha.size(); ++i)
        picture.pixels()[i] = vec4(vec3(1), leaf.alpha[i]);
    return std::make_shared<const Texture>(make_texture(std::move(picture), leaf.wrap));
}

}  // namespace

TEST(Scenes, Eq11_7_HardCase_LightFallsThroughHolesAsRaysDo) {
    constexpr int side = 64;
    int dark = 0, lit = 0;
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        Dice dice(seed);
        const Leaf leaf = any_leaf(dice);
        lesson_11::Options options;
        options.size = ivec2(side), options.texture.filter = Filter::nearest;
        options.shadow.size = 1024, options.shadow.pcf = 1;
        SceneAssets assets = make_scene_assets(scene_of(leaf), options);
        assets.textures.diffuse[2] = texture_of(leaf);
        ThreadPool pool(2);
        StepClock clock;
        const Image<vec3> picture = lesson_11::render(options, assets, pool, clock);
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const vec2 ndc = 2.0f * (vec2(x, y) + 0.5f) / static_cast<float>(side) - 1.0f;
                const vec2 on_floor = camera_height * std::tan(1.0f) * ndc;
                const vec3 from(on_floor.x, 0, on_floor.y);
                const vec3 toward = leaf.light.kind == SceneLight::Kind::directional
                                        ? -leaf.light.direction_world
                                        : leaf.light.position_world - from;
                const vec2 at = on_floor + vec2(toward.x, toward.z) / toward.y;
                int there = 0;  // of points within 0.06: several texels of any map here
                for (int i = 0; i < 121; ++i)
                    there += leaf.is_there(at + 0.012f * (vec2(i % 11, i / 11) - 5.0f));
                if (there % 121 != 0) continue;  // an edge
                ++(there ? dark : lit);
                ASSERT_EQ((picture[{x, y}] == vec3(0)), there == 121)
                    << "pixel (" << x << ", " << y << ") is black, and the leaf covers the light "
                    << "there; seed " << seed;
            }
    }
    EXPECT_GT(dark, 10'000);
    EXPECT_GT(lit, 50'000);
}
