// SPDX-License-Identifier: MIT
/// @file
/// What glTF's materials become.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/image/image_io.hpp"
#include "common/model/gltf.hpp"
#include "common/model/metallic_roughness.hpp"
#include "common/model/model_file.hpp"
#include "support/gltf_builder.hpp"
#include "support/lesson_process.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

namespace fs = std::filesystem;

/// The material of a file with one triangle.
Material material_of(const GltfBuilder& made) {
    return load_gltf(made.write(fresh_folder("gltf_material") / "scene.gltf")).materials.at(1);
}

/// Adds a texture with an embedded image of 2 x 1 pixels.
void add_picture(GltfBuilder& made, u8vec3 left, u8vec3 right) {
    const fs::path file = fresh_folder("gltf_picture") / "two.png";
    Image<u8vec3> picture({2, 1}, left);
    picture[{1, 0}] = right;
    write_image(file, picture);
    const std::size_t begin = made.bytes.size();
    made.bytes += read_text(file);
    const int view = made.add_view(begin);
    made.document["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
    made.document["textures"].push_back({{"source", made.document["images"].size() - 1}});
}

}  // namespace

TEST(MetallicRoughness, WhitePlasticOfMediumRoughnessHasASoftHighlight) {
    const PhongNumbers plastic = phong_from_metallic_roughness(vec3(1), 0, 0.5f);
    EXPECT_EQ(plastic.diffuse, vec3(1));
    EXPECT_FLOAT_EQ(plastic.specular.r, 0.16f);
    EXPECT_FLOAT_EQ(plastic.shininess, 7.5f);

    const PhongNumbers polished_gold = phong_from_metallic_roughness({1, 0.75f, 0.25f}, 1, 0);
    EXPECT_EQ(polished_gold.diffuse, vec3(0));
    EXPECT_EQ(polished_gold.shininess, 1024);
    for (int i = 0; i < 3; ++i)  // no brighter than light, of the same hue; float rounds twice
        EXPECT_NEAR(polished_gold.specular[i], (vec3(1, 0.75f, 0.25f)[i]), 1.2e-7f);
}

TEST(MetallicRoughness, TheHighlightIsAsBrightAndAsWideAsThatOfRoughSurfaces) {
    // The microfacet model of glTF: GGX with alpha = r^2, seen and lit from straight above, times
    // pi, as light of colour 1 has irradiance pi.
    const auto rough = [](long double r, long double cosine_to_half) {
        const long double a2 = r * r * r * r;
        const long double below = cosine_to_half * cosine_to_half * (a2 - 1) + 1;
        return 0.04L * a2 / (4 * below * below);
    };
    for (const float r : {0.35f, 0.5f, 0.7f}) {
        const PhongNumbers phong = phong_from_metallic_roughness(vec3(0), 0, r);
        // Float: four products and a quotient.
        EXPECT_NEAR(double(phong.specular.r / rough(r, 1)), 1, 1e-6) << r;
        // Where GGX has fallen to half: the mirror direction turns by twice the half vector's
        // angle. A power has fallen to two thirds there: GGX is thinner, and its tails are longer.
        for (double degrees = 0.1; degrees < 45; degrees += 0.1) {
            const double half = degrees * std::numbers::pi / 180;
            if (rough(r, std::cos(half)) > rough(r, 1) / 2) continue;
            const double share = std::pow(std::cos(2 * half), double{phong.shininess});
            EXPECT_GT(share, 0.6) << r;
            EXPECT_LT(share, 0.7) << r;
            break;
        }
    }
}

TEST(GltfMaterials, FactorsAreMapped) {
    GltfBuilder made = one_triangle();
    made.set(R"("/materials/0": {
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 0.125],
                                 "metallicFactor": 0.5, "roughnessFactor": 1},
        "emissiveFactor": [0.5, 0.25, 0], "doubleSided": true,
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}})");
    const Material material = material_of(made);
    EXPECT_EQ(material.diffuse, vec3(0.25f, 0.125f, 0.5f));
    EXPECT_EQ(material.ambient, material.diffuse);
    EXPECT_FLOAT_EQ(material.specular.r, (0.04f + 0.5f) / 2 / 4);
    EXPECT_FLOAT_EQ(material.specular.b, (0.04f + 1) / 2 / 4);
    EXPECT_EQ(material.shininess, 1);
    EXPECT_EQ(material.emission, vec3(2, 1, 0));
    EXPECT_EQ(material.illumination, 2);
    EXPECT_EQ(material.opacity, 1);  // OPAQUE: the factor's alpha does not count
    EXPECT_EQ(material.alpha, AlphaMode::opaque);
    EXPECT_TRUE(material.two_sided);
    EXPECT_FALSE(material.toon);
}

TEST(GltfMaterials, UnlitOnesHaveOnlyTheirColour) {
    GltfBuilder made = one_triangle();
    made.set(R"("/materials/0": {"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1]},
                                 "emissiveFactor": [1, 1, 1],
                                 "extensions": {"KHR_materials_unlit": {}}})");
    const Material material = material_of(made);
    EXPECT_EQ(material.illumination, 0);
    EXPECT_EQ(material.diffuse, vec3(0.5f, 0.25f, 1));  // metallicFactor is 1 where none is given
    EXPECT_EQ(material.emission, vec3(0));
    EXPECT_EQ(material.specular, vec3(0));
}

TEST(GltfMaterials, OpacityIsMaskedOrBlended) {
    GltfBuilder made = one_triangle();
    made.set(R"("/materials/0/pbrMetallicRoughness/baseColorFactor": [1, 1, 1, 0.25],
                "/materials/0/alphaMode": "BLEND")");
    EXPECT_EQ(material_of(made).alpha, AlphaMode::blend);
    EXPECT_EQ(material_of(made).opacity, 0.25f);
    made.material()["alphaMode"] = "MASK";
    EXPECT_EQ(material_of(made).alpha, AlphaMode::mask);
    EXPECT_EQ(material_of(made).alpha_cutoff, 0.5f);
    made.material()["alphaCutoff"] = 0.75;
    EXPECT_EQ(material_of(made).alpha_cutoff, 0.75f);
}

TEST(GltfMaterials, ImagesAreFilesOrEmbedded) {
    GltfBuilder made = one_triangle();
    made.set_texture("folder/my%20wood.png").set(R"("/samplers/0": {}, "/textures/0/sampler": 0)");
    const fs::path folder = fresh_folder("gltf_pictures");
    const TextureMap beside = load_gltf(made.write(folder / "a.gltf")).materials.at(1).diffuse_map;
    EXPECT_EQ(beside.file, folder / "folder/my wood.png");
    EXPECT_EQ(beside.library, folder / "a.gltf");
    EXPECT_FALSE(beside.embedded);
    EXPECT_TRUE(beside.clamp == bvec2(false) && beside.mirror == bvec2(false));

    const u8vec3 red(255, 0, 0), blue(0, 0, 255);
    add_picture(made, red, blue);
    made.set(R"("/materials/0/pbrMetallicRoughness/baseColorTexture/index": 1,
                "/materials/0/normalTexture": {"index": 1, "scale": 0.5})");
    const Scene scene = load_gltf(made.write(folder / "b.glb", GltfForm::binary));
    const TextureMap &inside = scene.materials.at(1).diffuse_map,
                     &normals = scene.materials[1].normal_map;
    ASSERT_TRUE(inside.embedded);
    const Image<u8vec4> picture = decode_image(*inside.embedded, inside.file);
    EXPECT_EQ((picture[{0, 0}]), u8vec4(red, 255));
    EXPECT_EQ((picture[{1, 0}]), u8vec4(blue, 255));
    EXPECT_EQ(inside.embedded, normals.embedded);  // one copy of the bytes
    EXPECT_EQ(inside.file, normals.file);
    EXPECT_NE(inside.file, beside.file);
    EXPECT_EQ(normals.bump_multiplier, 0.5f);

    const auto view = made.document["images"][1]["bufferView"].get<std::size_t>();
    const json& range = made.document["bufferViews"][view];
    const std::string png = made.bytes.substr(range["byteOffset"], range["byteLength"]);
    made.document["images"][1] = {{"uri", "data:image/png;base64," + base64(png)}};
    const Scene in_json = load_gltf(made.write(folder / "c.gltf"));
    ASSERT_TRUE(in_json.materials.at(1).diffuse_map.embedded);
    EXPECT_EQ(*in_json.materials[1].diffuse_map.embedded, *inside.embedded);
}

TEST(GltfMaterials, TexturesAreMovedAndScaledWithVUpwards) {
    GltfBuilder made = one_triangle();
    made.set_texture("wood.png");
    made.set(R"("/materials/0/pbrMetallicRoughness/baseColorTexture/extensions":
                {"KHR_texture_transform": {"offset": [0.25, 0.125], "scale": [2, 3]}})");
    const TextureMap map = material_of(made).diffuse_map;
    for (const vec2 down : {vec2(0, 0), vec2(1, 0.5f), vec2(0.25f, 0.75f)}) {
        const vec2 there = down * vec2(2, 3) + vec2(0.25f, 0.125f);
        const vec2 up(down.x, 1 - down.y);
        EXPECT_EQ(up * vec2(map.scale) + vec2(map.offset), vec2(there.x, 1 - there.y));
    }
}

TEST(GltfMaterials, TheMaterialChoosesTheSetOfTextureCoordinates) {
    GltfBuilder made = one_triangle();
    made.set_texture("wood.png");
    made.set(R"("/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord": 1)");
    made.primitive()["attributes"]["TEXCOORD_1"] = made.add({6, 5, 4, 3, 2, 1}, "VEC2", gl_float);
    const Scene scene = load_gltf(made.write(fresh_folder("gltf_sets") / "scene.gltf"));
    EXPECT_EQ(scene.meshes.at(0).uvs.at(0), dvec2(6, 1 - 5));
}

TEST(GltfMaterials, AMissingSetOfTextureCoordinatesIsAWarning) {
    const std::string base_color =
                          R"("/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord":)",
                      without_base_color = R"("/materials/0/pbrMetallicRoughness": {}, )",
                      normals = R"("/materials/0/normalTexture": {"index": 0, "texCoord": )",
                      no_set_0 = R"(, "/meshes/0/primitives/0/attributes/TEXCOORD_0": null)",
                      set_1 = R"(, "/meshes/0/primitives/0/attributes/TEXCOORD_1": 2)";
    constexpr int none = -1;
    for (const auto& [changes, missing] : std::vector<std::pair<std::string, int>>{
             {base_color + "0", none},
             {base_color + "0" + no_set_0 + set_1, 0},
             {base_color + "1", 1},
             {base_color + "1" + set_1, none},
             {without_base_color + normals + "0}" + no_set_0, 0},
             {without_base_color + normals + "2}" + set_1, 2},
             {without_base_color + normals + "1}" + no_set_0 + set_1, none}}) {
        SCOPED_TRACE(changes);
        GltfBuilder made = one_triangle();
        made.set_texture("wood.png").set(changes);
        const Scene scene = load_gltf(made.write(fresh_folder("gltf_no_set") / "scene.gltf"));
        ASSERT_EQ(scene.warnings.size(), missing == none ? 0u : 1u);
        if (missing == none) continue;
        EXPECT_NE(scene.warnings[0].find("mesh 0 \"triangle\", primitive 0: has no TEXCOORD_" +
                                         std::to_string(missing) +
                                         " for the texture of material 0 \"paint\""),
                  std::string::npos)
            << scene.warnings[0];
    }
}

TEST(GltfMaterials, OfAMetallicRoughnessTextureTheMeanCounts) {
    GltfBuilder made = one_triangle();
    // Red does not count, roughness is green, metal is blue.
    add_picture(made, {255, 51, 255}, {255, 153, 0});
    made.set(R"("/materials/0/pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 0}})");
    const Material material = material_of(made);
    const PhongNumbers expected = phong_from_metallic_roughness(vec3(1), 0.5f, 0.4f);
    // The mean of codes is exact but for its rounding to float.
    EXPECT_NEAR(material.diffuse.r, expected.diffuse.r, 1e-6);
    EXPECT_NEAR(material.shininess, expected.shininess, 1e-4);
    EXPECT_NEAR(material.specular.r, expected.specular.r, 1e-6);
    EXPECT_TRUE(material.specular_map.file.empty());
}

TEST(GltfMaterials, AnEmissiveTextureIsAnEmissionMap) {
    GltfBuilder made = one_triangle();
    add_picture(made, {255, 0, 188}, {0, 0, 188});
    made.set(R"("/materials/0/emissiveFactor": [1, 1, 0.5],
                "/materials/0/emissiveTexture": {"index": 0, "texCoord": 1})");
    made.primitive()["attributes"]["TEXCOORD_1"] = made.add({6, 5, 4, 3, 2, 1}, "VEC2", gl_float);
    const Scene scene = load_gltf(made.write(fresh_folder("gltf_emission") / "scene.gltf"));
    const Material& material = scene.materials.at(1);
    EXPECT_EQ(material.emission, vec3(1, 1, 0.5f));
    ASSERT_TRUE(material.emission_map.embedded);
    EXPECT_EQ(scene.meshes.at(0).uvs.at(0), dvec2(6, 1 - 5));
    EXPECT_TRUE(scene.warnings.empty());
    made.material()["emissiveFactor"] = {0, 0, 0};
    EXPECT_TRUE(material_of(made).emission_map.file.empty());
}

TEST(GltfMaterials, AMetalsHighlightHasTheMeanColourOfItsTexture) {
    GltfBuilder made = one_triangle();
    add_picture(made, {255, 188, 0}, {255, 0, 0});
    made.set(R"("/materials/0/pbrMetallicRoughness": {"roughnessFactor": 1,
                                                      "baseColorTexture": {"index": 0}})");
    const Material material = material_of(made);
    // Light, not codes, is averaged: of sRGB code 188 it is ((188/255 + 0.055) / 1.055)^2.4.
    EXPECT_FLOAT_EQ(material.specular.r, 0.25f);
    EXPECT_FLOAT_EQ(material.specular.g, 0.25f * 0.50288649f / 2);
    EXPECT_EQ(material.specular.b, 0);
    EXPECT_EQ(material.diffuse, vec3(0)) << "of a metal";
}

TEST(GltfMaterials, MToonIsAShadingModelOfItsOwn) {
    GltfBuilder made = one_triangle();
    made.set(R"("/extensionsRequired": ["VRMC_materials_mtoon"],
                "/materials/0": {
                    "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1]},
                    "extensions": {"KHR_materials_unlit": {},
                                   "VRMC_materials_mtoon": {"specVersion": "1.0"}}})");
    const Material plain = material_of(made);
    ASSERT_TRUE(plain.toon);
    EXPECT_EQ(plain.toon->shade, vec3(0));
    EXPECT_EQ(plain.toon->toony, 0.9f);
    EXPECT_EQ(plain.toon->shift, 0);
    EXPECT_EQ(plain.toon->outline, ToonMaterial::Outline::none);
    EXPECT_EQ(plain.illumination, 1);  // "unlit" is for programs that do not know MToon
    EXPECT_EQ(plain.diffuse, vec3(0.5f, 0.25f, 1));
    EXPECT_EQ(plain.specular, vec3(0));

    made.set(R"("/materials/0/extensions/VRMC_materials_mtoon": {
        "specVersion": "1.0", "shadeColorFactor": [0.25, 0.5, 0.75], "shadingToonyFactor": 0.5,
        "shadingShiftFactor": -0.25, "outlineWidthFactor": 0.125,
        "outlineWidthMode": "worldCoordinates", "outlineColorFactor": [1, 0, 0.5]})");
    const Material full = material_of(made);
    ASSERT_TRUE(full.toon);
    EXPECT_EQ(full.toon->shade, vec3(0.25f, 0.5f, 0.75f));
    EXPECT_EQ(full.toon->toony, 0.5f);
    EXPECT_EQ(full.toon->shift, -0.25f);
    EXPECT_EQ(full.toon->outline, ToonMaterial::Outline::world);
    EXPECT_EQ(full.toon->outline_width, 0.125f);
    EXPECT_EQ(full.toon->outline_color, vec3(1, 0, 0.5f));
    made.material()["extensions"]["VRMC_materials_mtoon"]["outlineWidthMode"] = "screenCoordinates";
    EXPECT_EQ(material_of(made).toon->outline, ToonMaterial::Outline::screen);
    made.material()["extensions"]["VRMC_materials_mtoon"]["matcapTexture"] = {{"index", 0}};
    const Scene scene = load_model(made.write(fresh_folder("gltf_matcap") / "a.gltf"));
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("matcapTexture is passed over"), std::string::npos);
}

TEST(GltfMaterials, Vrm0HasTheSameInAListBesideTheMaterials) {
    GltfBuilder made = one_triangle();
    made.set(R"("/materials": [{"name": "other"}, {"name": "paint"}],
                "/meshes/0/primitives/0/material": 1,
                "/extensions/VRM/materialProperties": [
                    {"shader": "VRM_USE_GLTFSHADER"},
                    {"shader": "VRM/MToon",
                     "floatProperties": {"_ShadeToony": 0.5, "_ShadeShift": -0.5,
                                         "_OutlineWidth": 0.5, "_OutlineWidthMode": 1},
                     "vectorProperties": {"_ShadeColor": [0.5, 0, 1, 1],
                                          "_OutlineColor": [0, 1, 0, 1]}}])");
    const fs::path file = fresh_folder("gltf_vrm") / "figure.vrm";
    const Scene scene = load_model(made.write(file, GltfForm::binary));
    EXPECT_FALSE(scene.materials.at(1).toon);
    const std::optional<ToonMaterial>& toon = scene.materials.at(2).toon;
    ASSERT_TRUE(toon);
    // Light begins at N.L = -0.5 and is full halfway from there to 1: at 0.25.
    EXPECT_FLOAT_EQ(toon->toony, 1 - 0.75f / 2);
    EXPECT_FLOAT_EQ(toon->shift, -(-0.5f + 0.25f) / 2);
    EXPECT_FLOAT_EQ(toon->shade.r, 0.21404114f);  // sRGB code 0.5, as light
    EXPECT_EQ(toon->shade.b, 1);
    EXPECT_EQ(toon->outline, ToonMaterial::Outline::world);
    EXPECT_FLOAT_EQ(toon->outline_width, 0.005f);  // centimetres there
    EXPECT_EQ(toon->outline_color, vec3(0, 1, 0));

    made.set(R"("/extensions/VRM/materialProperties/1/floatProperties/_OutlineWidthMode": 2,
                "/extensions/VRM/materialProperties/1/vectorProperties/_ShadeColor": null)");
    const Scene other = load_model(made.write(file, GltfForm::binary));
    EXPECT_EQ(other.materials.at(2).toon->outline, ToonMaterial::Outline::screen);
    EXPECT_FLOAT_EQ(other.materials.at(2).toon->outline_width, 0.0025f)
        << "100 of them are half of the height";
    EXPECT_FLOAT_EQ(other.materials.at(2).toon->shade.r, 0.9331069f) << "sRGB code 0.97";
}
