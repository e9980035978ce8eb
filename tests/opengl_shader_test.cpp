// SPDX-License-Identifier: MIT
// Lesson 09's fragment stage beside the same in GLSL.
#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "04_mvp/camera.hpp"
#include "04_mvp/transform.hpp"
#include "common/image/backdrop.hpp"
#include "common/math/color.hpp"
#include "support/lesson_09.hpp"
#include "support/opengl.hpp"
#include "support/picture_difference.hpp"
#include "support/pictures.hpp"
#include "support/printers.hpp"
#include "support/texts.hpp"

namespace fs = std::filesystem;
using namespace rasterbook;
using namespace rasterbook::test;

namespace {

OpenGlShaders shaders() {
    const fs::path folder = fs::path(RASTERBOOK_TEST_DATA) / "shaders";
    return {read_text(folder / "09_vertex.glsl"), read_text(folder / "09_fragment.glsl")};
}

/// Normal maps as OpenGL reads those of codes: numbers from 0 to 1 (UNORM). However the lesson
/// decodes a code, the shader's 2 x - 1 makes the same normal of it.
///
/// @return  For each material; null where the lesson has none.
std::vector<std::shared_ptr<const Texture>> unorm_normal_maps(const NormalMaps& maps) {
    std::vector<std::shared_ptr<const Texture>> unorm;
    for (const auto& normals : maps.textures) {
        const auto copy = normals ? std::make_shared<Texture>(*normals) : nullptr;
        if (copy)
            for (TextureLevel& level : copy->levels)
                for (vec4& texel : level.texels.pixels()) texel = 0.5f * texel + 0.5f;
        unorm.push_back(copy);
    }
    return unorm;
}

/// The scene's triangles in their order, cut where the material changes. All maps of a material
/// are taken to have the uvs of its map_Kd.
std::vector<OpenGlPart> parts_of(const Scene& scene) {
    std::vector<OpenGlPart> parts;
    for (const Mesh& mesh : scene.meshes)
        for (const Triangle& triangle : mesh.triangles) {
            if (parts.empty() || parts.back().material != triangle.material)
                parts.push_back({triangle.material});
            const std::array<vec2, 3> uvs =
                uvs_of(mesh, triangle, scene.materials[triangle.material].diffuse_map, nullptr);
            for (std::size_t i = 0; i < 3; ++i) {
                const Vertex& vertex = triangle.vertices[i];
                parts.back().vertices.push_back({mesh.positions[vertex.position],
                                                 mesh.normals[vertex.normal],
                                                 mesh.tangents[vertex.normal], uvs[i]});
            }
        }
    return parts;
}

OpenGlInputs inputs_of_material(const ShadowAssets& assets, std::size_t i,
                                const Texture* normal_map) {
    const Material& material = assets.scene.materials[i];
    const SurfaceColor color = surface_color(material);
    return {{{"material.ambient", color.ambient},
             {"material.diffuse", color.diffuse},
             {"material.specular", color.specular},
             {"material.emission", color.emission},
             {"shininess", material.shininess}},
            {{"diffuse_map", assets.textures.diffuse[i].get()},
             {"specular_map", assets.textures.specular[i].get()},
             {"normal_map", normal_map}}};
}

OpenGlInputs inputs_of_scene(const Camera& camera, ivec2 size, std::span<const Light> lights,
                             const ShadowMap& map) {
    const mat4 upside_down = scaling(vec3(1, -1, 1));  // see OpenGl
    OpenGlInputs inputs{{{"clip_from_world", upside_down * camera.clip_from_world(size)},
                         {"eye_world", camera.position_world},
                         {"ambient_light", ambient_light},
                         {"size", static_cast<float>(map.size)},
                         {"texels_from_world", map.texels_from_world},
                         {"plane_from_world", mat3(map.plane_from_world)},
                         {"rounding_texels", static_cast<float>(map.rounding_texels)},
                         {"rounding_depth", static_cast<float>(map.rounding_depth)}},
                        {{"depths", &map.depths.depths()}}};
    for (std::size_t l = 0; l < lights.size(); ++l) {
        const std::string light = "lights[" + std::to_string(l) + "].";
        inputs.uniforms[light + "color"] = lights[l].color;
        inputs.uniforms[light + "direction_world"] = lights[l].direction_world;
    }
    return inputs;
}

/// As in a file.
Image<u8vec4> encoded(const Image<vec3>& linear) {
    const Image<u8vec3> srgb = srgb8_from_linear(linear);
    Image<u8vec4> picture(srgb.size());
    for (std::size_t i = 0; i < picture.pixels().size(); ++i)
        picture.pixels()[i] = u8vec4(srgb.pixels()[i], 255);
    return picture;
}

}  // namespace

TEST_F(OpenGlTest, Lesson09sFragmentShaderDrawsTheSamePicture) {
    lesson_09::Options options;
    options.size = {640, 360};
    options.texture.filter = Filter::bilinear;  // OpenGL finds levels only roughly
    options.shading.all_effects = true;         // so that each material has all textures
    const ShadowAssets assets = lesson_09::make_assets(loaded(options.model.string()), options);
    const Image<vec3> ours = lesson_09::render(options, assets);

    const Camera camera = orbit_camera(options.orbit, assets.scene.bounds());
    const std::array lights = raking_lights(options.shading.key_light, assets.scene.bounds());
    const ShadowMaps shadow_maps =
        draw_shadow_maps(options.shadow, {assets.scene, assets.shadow_bounds, lights});
    const auto normal_maps = unorm_normal_maps(assets.normal_maps);
    std::vector<OpenGlPart> parts = parts_of(assets.scene);
    for (OpenGlPart& part : parts)
        part.inputs = inputs_of_material(assets, part.material, normal_maps[part.material].get());
    const OpenGlPicture drawn =
        gl->draw(parts, options.size, shaders(),
                 inputs_of_scene(camera, options.size, lights, shadow_maps.of_light[0].maps[0]));

    const Image<vec3> empty = backdrop(options.size);
    Image<vec3> theirs = empty;
    std::size_t covered = 0, covered_by_one = 0;
    for (std::size_t i = 0; i < theirs.pixels().size(); ++i) {
        const bool is_ours = ours.pixels()[i] != empty.pixels()[i];
        const bool is_theirs = drawn.color.pixels()[i].a == 1;
        covered += is_ours;
        covered_by_one += is_ours != is_theirs;
        if (is_theirs) theirs.pixels()[i] = vec3(drawn.color.pixels()[i]);
    }
    EXPECT_GE(covered, 120'000u);
    EXPECT_EQ(covered_by_one, 0u);

    // In floats hardly a pixel is the same: OpenGL interpolates between vertices that are not yet
    // snapped, and rounds elsewhere. That moves a few of a hundred pixels to the next level of 255,
    // and hardly any beyond. Where a last bit decides, a pixel may differ by any amount: into which
    // of the map's texels a point falls, or which triangle has a pixel where two meet. (Of 128,412
    // pixels, 4 differ by two levels, and 3 by up to 76: by up to three taps of nine.)
    const PictureDifference difference = picture_difference(encoded(theirs), encoded(ours));
    EXPECT_LE(difference.jumps, covered / 5000)
        << "pixels differ by more than a level, the greatest by " << difference.greatest;
    EXPECT_LE(difference.differing, covered / 20);
}

TEST(OpenGlShaders, AreQuotedWordForWord) {
    const auto [vertex, fragment] = shaders();
    const std::string page = read_text(root / "docs/where_next.md");
    for (const std::string& part : parts_after(page, "\n```glsl\n")) {
        const std::string quote = part.substr(0, part.find("```"));
        EXPECT_TRUE(vertex.find(quote) != vertex.npos || fragment.find(quote) != fragment.npos)
            << quote;
    }
}
