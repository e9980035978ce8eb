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

/// Embeds an image of 2 x 1 pixels; gives the index of its texture.
int add_picture(GltfBuilder& made, u8vec3 left, u8vec3 right) {
    const fs::path file = fresh_folder("gltf_picture") / "two.png";
    Image<u8vec3> picture({2, 1}, left);
    picture[{1, 0}] = right;
    write_image(file, picture);
    const std::size_t begin = made.bytes.size();
    made.bytes += read_text(file);
    const int view = made.add_view(begin);
    made.document["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
    made.document["textures"].push_back({{"source", made.document["images"].size() - 1}});
    return int(made.document["textures"].size()) - 1;
}

}  // namespace

TEST(MetallicRoughness, WhitePlasticOfMediumRoughnessHasASoftHighlight) {
    const PhongNumbers plastic = phong_from_metallic_roughness(vec3(1), 0, 0.5f);
    EXPECT_EQ(plastic.diffuse, vec3(1));
    EXPECT_FLOAT_EQ(plastic.specular.r, 0.16f);
    EXPECT_FLOAT_EQ(plastic.shininess, 7.5f);
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

TEST(MetallicRoughness, NoMoreLightIsReflectedThanArrives) {
    for (const float metallic : {0.0f, 0.3f, 1.0f})
        for (float r = 0; r <= 1; r += 0.01f) {
            const vec3 base(1, 0.5f, 0.1f);
            const PhongNumbers phong = phong_from_metallic_roughness(base, metallic, r);
            for (int i = 0; i < 3; ++i) {
                // Light from straight above, over all directions: 2 Ks / (Ns + 2).
                const float sent = phong.diffuse[i] + 2 * phong.specular[i] / (phong.shininess + 2);
                EXPECT_LE(sent,
                          (1 - metallic) * base[i] + glm::mix(0.04f, base[i], metallic) + 1e-6f);
                EXPECT_LE(phong.specular[i], 1);
                EXPECT_GE(phong.specular[i], 0);
            }
            EXPECT_GE(phong.shininess, 1);
            EXPECT_LE(phong.shininess, 1024);
        }
}

TEST(MetallicRoughness, AMetalReflectsItsColourOnlyInHighlights) {
    const PhongNumbers gold = phong_from_metallic_roughness({1, 0.75f, 0.25f}, 1, 0.6f);
    EXPECT_EQ(gold.diffuse, vec3(0));
    for (int i = 0; i < 3; ++i)  // no brighter than light, of the same hue; float rounds twice
        EXPECT_NEAR(gold.specular[i], (vec3(1, 0.75f, 0.25f)[i]), 1.2e-7f);
}

TEST(GltfMaterials, FactorsAreMapped) {
    GltfBuilder made = one_triangle();
    made.material()["pbrMetallicRoughness"] = {{"baseColorFactor", {0.5, 0.25, 1, 0.125}},
                                               {"metallicFactor", 0.5},
                                               {"roughnessFactor", 1}};
    made.material()["emissiveFactor"] = {0.5, 0.25, 0};
    made.material()["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 4;
    made.material()["doubleSided"] = true;
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
    made.material()["pbrMetallicRoughness"] = {{"baseColorFactor", {0.5, 0.25, 1, 1}}};
    made.material()["emissiveFactor"] = {1, 1, 1};
    made.material()["extensions"]["KHR_materials_unlit"] = json::object();
    const Material material = material_of(made);
    EXPECT_EQ(material.illumination, 0);
    EXPECT_EQ(material.diffuse, vec3(0.5f, 0.25f, 1));  // metallicFactor is 1 where none is given
    EXPECT_EQ(material.emission, vec3(0));
    EXPECT_EQ(material.specular, vec3(0));
}

TEST(GltfMaterials, OpacityIsMaskedOrBlended) {
    GltfBuilder made = one_triangle();
    made.material()["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.25};
    made.material()["alphaMode"] = "BLEND";
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
    made.document["images"] = json::array({{{"uri", "folder/my%20wood.png"}}});
    made.document["textures"] = json::array({{{"source", 0}}});
    json& pbr = made.material()["pbrMetallicRoughness"];
    pbr["baseColorTexture"]["index"] = 0;
    const fs::path folder = fresh_folder("gltf_pictures");
    const TextureMap beside = load_gltf(made.write(folder / "a.gltf")).materials.at(1).diffuse_map;
    EXPECT_EQ(beside.file, folder / "folder/my wood.png");
    EXPECT_EQ(beside.library, folder / "a.gltf");
    EXPECT_FALSE(beside.embedded);
    EXPECT_TRUE(beside.clamp == bvec2(false) && beside.mirror == bvec2(false));

    const u8vec3 red(255, 0, 0), blue(0, 0, 255);
    pbr["baseColorTexture"]["index"] = add_picture(made, red, blue);
    made.material()["normalTexture"] = {{"index", pbr["baseColorTexture"]["index"]},
                                        {"scale", 0.5}};
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

TEST(GltfMaterials, SamplersChooseTheWrapMode) {
    GltfBuilder made = one_triangle();
    made.document["images"] = json::array({{{"uri", "wood.png"}}});
    made.document["textures"] = json::array({{{"source", 0}, {"sampler", 0}}});
    made.material()["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    const auto map = [&](json sampler) {
        made.document["samplers"] = json::array({std::move(sampler)});
        return material_of(made).diffuse_map;
    };
    EXPECT_EQ(map(json::object()).clamp, bvec2(false));
    EXPECT_EQ(map(json::object()).mirror, bvec2(false));
    const TextureMap clamped = map({{"wrapS", 33071}, {"wrapT", 33071}});
    EXPECT_TRUE(clamped.clamp == bvec2(true) && clamped.mirror == bvec2(false));
    const TextureMap mirrored = map({{"wrapS", 33648}, {"wrapT", 33648}});
    EXPECT_TRUE(mirrored.mirror == bvec2(true) && mirrored.clamp == bvec2(false));
    const TextureMap apart = map({{"wrapS", 10497}, {"wrapT", 33071}, {"magFilter", 9728}});
    EXPECT_TRUE(apart.clamp == bvec2(false, true) && apart.mirror == bvec2(false));
    EXPECT_TRUE(apart.nearest_magnified && !apart.nearest_minified);
}

TEST(GltfMaterials, TexturesAreMovedAndScaledWithVUpwards) {
    GltfBuilder made = one_triangle();
    made.document["images"] = json::array({{{"uri", "wood.png"}}});
    made.document["textures"] = json::array({{{"source", 0}}});
    made.material()["pbrMetallicRoughness"]["baseColorTexture"] = {
        {"index", 0},
        {"extensions",
         {{"KHR_texture_transform", {{"offset", {0.25, 0.125}}, {"scale", {2, 3}}}}}}};
    const TextureMap map = material_of(made).diffuse_map;
    for (const vec2 down : {vec2(0, 0), vec2(1, 0.5f), vec2(0.25f, 0.75f)}) {
        const vec2 there = down * vec2(2, 3) + vec2(0.25f, 0.125f);
        const vec2 up(down.x, 1 - down.y);
        EXPECT_EQ(up * vec2(map.scale) + vec2(map.offset), vec2(there.x, 1 - there.y));
    }
}

TEST(GltfMaterials, TheMaterialChoosesTheSetOfTextureCoordinates) {
    GltfBuilder made = one_triangle();
    made.document["images"] = json::array({{{"uri", "wood.png"}}});
    made.document["textures"] = json::array({{{"source", 0}}});
    made.material()["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}, {"texCoord", 1}};
    made.primitive()["attributes"]["TEXCOORD_1"] =
        made.add({0.5, 0.5, 0.5, 0.5, 0.5, 0.5}, "VEC2", gl_float);
    const Scene scene = load_gltf(made.write(fresh_folder("gltf_sets") / "scene.gltf"));
    EXPECT_EQ(scene.meshes.at(0).uvs.at(0), dvec2(0.5));
}

TEST(GltfMaterials, AMissingSetOfTextureCoordinatesIsAWarning) {
    struct Row {
        const char* texture;
        int set;  ///< That it asks for.
        bool has_set_0, has_set_1;
    };
    for (const auto& [texture, set, has_set_0, has_set_1] :
         std::vector<Row>{{"baseColorTexture", 0, true, false},
                          {"baseColorTexture", 0, false, true},
                          {"baseColorTexture", 0, false, false},
                          {"baseColorTexture", 1, true, false},
                          {"baseColorTexture", 1, true, true},
                          {"normalTexture", 0, false, false},
                          {"normalTexture", 2, true, true},
                          {"normalTexture", 1, false, true}}) {
        GltfBuilder made = one_triangle();
        made.document["images"] = json::array({{{"uri", "wood.png"}}});
        made.document["textures"] = json::array({{{"source", 0}}});
        json& material = made.material();
        (texture == std::string("normalTexture")
             ? material
             : material["pbrMetallicRoughness"])[texture] = {{"index", 0}, {"texCoord", set}};
        json& attributes = made.primitive()["attributes"];
        if (has_set_1) attributes["TEXCOORD_1"] = attributes["TEXCOORD_0"];
        if (!has_set_0) attributes.erase("TEXCOORD_0");
        const Scene scene = load_gltf(made.write(fresh_folder("gltf_no_set") / "scene.gltf"));
        const bool is_there = set == 0 ? has_set_0 : set == 1 && has_set_1;
        ASSERT_EQ(scene.warnings.size(), is_there ? 0u : 1u) << texture << ' ' << set;
        if (is_there) continue;
        EXPECT_NE(scene.warnings[0].find("mesh 0 \"triangle\", primitive 0: has no TEXCOORD_" +
                                         std::to_string(set) +
                                         " for the texture of material 0 \"paint\""),
                  std::string::npos)
            << scene.warnings[0];
    }
}

TEST(GltfMaterials, OfAMetallicRoughnessTextureTheMeanCounts) {
    GltfBuilder made = one_triangle();
    // Red does not count, roughness is green, metal is blue.
    const int texture = add_picture(made, {255, 51, 255}, {255, 153, 0});
    made.material()["pbrMetallicRoughness"] = {{"baseColorFactor", {1, 1, 1, 1}},
                                               {"metallicRoughnessTexture", {{"index", texture}}}};
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
    const int texture = add_picture(made, {255, 0, 188}, {0, 0, 188});
    made.material()["emissiveFactor"] = {1, 1, 0.5};
    made.material()["emissiveTexture"]["index"] = texture;
    made.material()["emissiveTexture"]["texCoord"] = 1;
    made.primitive()["attributes"]["TEXCOORD_1"] =
        made.add({0.5, 0.5, 0.5, 0.5, 0.5, 0.5}, "VEC2", gl_float);
    const Scene scene = load_gltf(made.write(fresh_folder("gltf_emission") / "scene.gltf"));
    const Material& material = scene.materials.at(1);
    EXPECT_EQ(material.emission, vec3(1, 1, 0.5f));
    ASSERT_TRUE(material.emission_map.embedded);
    EXPECT_EQ(scene.meshes.at(0).uvs.at(0), dvec2(0.5));
    EXPECT_TRUE(scene.warnings.empty());
    made.material()["emissiveFactor"] = {0, 0, 0};
    EXPECT_TRUE(material_of(made).emission_map.file.empty());
}

TEST(GltfMaterials, AMetalsHighlightHasTheMeanColourOfItsTexture) {
    GltfBuilder made = one_triangle();
    const int texture = add_picture(made, {255, 188, 0}, {255, 0, 0});
    made.material()["pbrMetallicRoughness"] = {{"roughnessFactor", 1},
                                               {"baseColorTexture", {{"index", texture}}}};
    const Material material = material_of(made);
    // Light, not codes, is averaged: of sRGB code 188 it is ((188/255 + 0.055) / 1.055)^2.4.
    EXPECT_FLOAT_EQ(material.specular.r, 0.25f);
    EXPECT_FLOAT_EQ(material.specular.g, 0.25f * 0.50288649f / 2);
    EXPECT_EQ(material.specular.b, 0);
    EXPECT_EQ(material.diffuse, vec3(0));
}

TEST(GltfMaterials, MToonIsAShadingModelOfItsOwn) {
    GltfBuilder made = one_triangle();
    made.document["extensionsRequired"] = {"VRMC_materials_mtoon"};
    made.material()["pbrMetallicRoughness"] = {{"baseColorFactor", {0.5, 0.25, 1, 1}}};
    made.material()["extensions"]["KHR_materials_unlit"] = json::object();
    made.material()["extensions"]["VRMC_materials_mtoon"]["specVersion"] = "1.0";
    const Material plain = material_of(made);
    ASSERT_TRUE(plain.toon);
    EXPECT_EQ(plain.toon->shade, vec3(0));
    EXPECT_EQ(plain.toon->toony, 0.9f);
    EXPECT_EQ(plain.toon->shift, 0);
    EXPECT_EQ(plain.toon->outline, ToonMaterial::Outline::none);
    EXPECT_EQ(plain.illumination, 1);  // "unlit" is for programs that do not know MToon
    EXPECT_EQ(plain.diffuse, vec3(0.5f, 0.25f, 1));
    EXPECT_EQ(plain.specular, vec3(0));

    made.material()["extensions"]["VRMC_materials_mtoon"] = {
        {"specVersion", "1.0"},
        {"shadeColorFactor", {0.25, 0.5, 0.75}},
        {"shadingToonyFactor", 0.5},
        {"shadingShiftFactor", -0.25},
        {"outlineWidthFactor", 0.125},
        {"outlineWidthMode", "worldCoordinates"},
        {"outlineColorFactor", {1, 0, 0.5}}};
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
    made.document["materials"] = json::array({{{"name", "other"}}, made.document["materials"][0]});
    made.primitive()["material"] = 1;
    made.document["extensions"]["VRM"]["materialProperties"] =
        json::array({{{"shader", "VRM_USE_GLTFSHADER"}},
                     {{"shader", "VRM/MToon"},
                      {"floatProperties",
                       {{"_ShadeToony", 0.5},
                        {"_ShadeShift", -0.5},
                        {"_OutlineWidth", 0.5},
                        {"_OutlineWidthMode", 1}}},
                      {"vectorProperties",
                       {{"_ShadeColor", {0.5, 0, 1, 1}}, {"_OutlineColor", {0, 1, 0, 1}}}}}});
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

    json& own = made.document["extensions"]["VRM"]["materialProperties"][1];
    own["floatProperties"]["_OutlineWidthMode"] = 2;
    own["vectorProperties"].erase("_ShadeColor");
    const Scene other = load_model(made.write(file, GltfForm::binary));
    EXPECT_EQ(other.materials.at(2).toon->outline, ToonMaterial::Outline::screen);
    EXPECT_FLOAT_EQ(other.materials.at(2).toon->outline_width, 0.0025f)
        << "100 of them are half of the height";
    EXPECT_FLOAT_EQ(other.materials.at(2).toon->shade.r, 0.9331069f) << "sRGB code 0.97";
}
