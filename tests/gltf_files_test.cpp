// SPDX-License-Identifier: MIT
/// @file
/// Real glTF files: Blender's, the course's own, damaged ones, and one that a lesson draws.
/// tests/data/gltf/blender_scene.py makes Blender's.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <random>
#include <set>

#include "05_textures/load_textures.hpp"
#include "05_textures/textures.hpp"
#include "common/image/image_io.hpp"
#include "common/model/model_file.hpp"
#include "support/gltf_builder.hpp"
#include "support/lesson_process.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

namespace fs = std::filesystem;

const fs::path models = fs::path(RASTERBOOK_ASSETS) / "models";
const fs::path data = fs::path(RASTERBOOK_TEST_DATA) / "gltf";

template <typename Vector>
bool is_finite(const Vector& v) {
    for (int i = 0; i < v.length(); ++i)
        if (!std::isfinite(v[i])) return false;
    return true;
}

/// For EXPECT_TRUE: indices in range, and finite numbers.
testing::AssertionResult is_sound(const Scene& scene) {
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.triangles.empty() || mesh.vertices.size() != 3 * mesh.faces.size() ||
            mesh.faces.size() != mesh.triangles.size())
            return testing::AssertionFailure() << "wrong faces in " << mesh.name;
        if (!mesh.colors.empty() && mesh.colors.size() != mesh.positions.size())
            return testing::AssertionFailure() << "wrong colours in " << mesh.name;
        for (const Triangle& triangle : mesh.triangles)
            for (const auto& [position, uv, normal] : triangle.vertices)
                if (position >= mesh.positions.size() ||
                    (uv != no_index && uv >= mesh.uvs.size()) || normal >= mesh.normals.size() ||
                    triangle.material >= scene.materials.size())
                    return testing::AssertionFailure() << "wrong triangle in " << mesh.name;
        if (!std::ranges::all_of(mesh.positions, is_finite<vec3>) ||
            !std::ranges::all_of(mesh.normals, is_finite<vec3>) ||
            !std::ranges::all_of(mesh.uvs, is_finite<dvec2>) ||
            !std::ranges::all_of(mesh.colors, is_finite<vec4>))
            return testing::AssertionFailure() << "a number in " << mesh.name << " is not finite";
    }
    for (const Material& m : scene.materials)
        for (const vec3& v : {m.ambient, m.diffuse, m.specular, m.emission,
                              vec3(m.shininess, m.opacity, m.alpha_cutoff),
                              vec3(m.diffuse_map.offset), vec3(m.diffuse_map.scale)})
            if (!is_finite(v)) return testing::AssertionFailure() << "material " << m.name;
    for (const SceneCamera& camera : scene.cameras)
        for (int i = 0; i < 4; ++i)
            if (!is_finite(camera.world_from_view[i]) || !(camera.near > 0))
                return testing::AssertionFailure() << "camera " << camera.name;
    for (const SceneLight& light : scene.lights)
        if (!is_finite(light.color) || !is_finite(light.position_world) ||
            !is_finite(light.direction_world) || !(light.cos_outer < light.cos_inner))
            return testing::AssertionFailure() << "light " << light.name;
    return testing::AssertionSuccess();
}

const Mesh& mesh_of(const Scene& scene, const std::string& name) {
    const auto found = std::ranges::find(scene.meshes, name, &Mesh::name);
    if (found == scene.meshes.end()) throw std::runtime_error("no mesh " + name);
    return *found;
}

/// Position, normal and uv of a triangle's vertex.
std::array<float, 8> vertex_of(const Mesh& mesh, const Triangle& triangle, std::size_t i) {
    const Vertex& vertex = triangle.vertices[i];
    const vec3 p = mesh.positions.at(vertex.position), n = mesh.normals.at(vertex.normal);
    const vec2 uv = mesh.uvs.at(vertex.uv);
    return {p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y};
}

}  // namespace

TEST(GltfFiles, BlendersSceneIsTheSameInBothFormats) {
    // The OBJ file has 6 decimals of positions and uvs, and 4 of normals; the glTF file's
    // quaternions are floats, times lengths of at most 5.
    constexpr float of_position = 3e-6f, of_normal = 1e-4f, of_uv = 1e-6f;
    const Scene as_obj = load_model(data / "blender.obj");
    const Scene as_gltf = load_model(data / "blender.glb");
    EXPECT_TRUE(as_gltf.warnings.empty());
    EXPECT_TRUE(is_sound(as_gltf));
    ASSERT_EQ(as_gltf.meshes.size(), 3u);
    for (const Mesh& mesh : as_gltf.meshes) {
        SCOPED_TRACE(mesh.name);
        const Mesh& other = mesh_of(as_obj, mesh.name);
        ASSERT_EQ(mesh.triangles.size(), other.triangles.size());
        EXPECT_EQ(mesh.positions.size(), other.positions.size());
        std::set<std::size_t> taken;
        for (const Triangle& triangle : mesh.triangles) {
            bool is_found = false;
            for (std::size_t t = 0; t < other.triangles.size() && !is_found; ++t)
                for (std::size_t turn = 0; turn < 3 && !is_found; ++turn) {
                    bool agrees = !taken.contains(t);
                    for (std::size_t i = 0; i < 3 && agrees; ++i) {
                        const auto a = vertex_of(mesh, triangle, i);
                        const auto b = vertex_of(other, other.triangles[t], (i + turn) % 3);
                        for (std::size_t k = 0; k < 8; ++k)
                            agrees = agrees && std::abs(a[k] - b[k]) < (k < 3   ? of_position
                                                                        : k < 6 ? of_normal
                                                                                : of_uv);
                    }
                    if (agrees) taken.insert(t), is_found = true;
                }
            const auto [x, y, z, nx, ny, nz, u, v] = vertex_of(mesh, triangle, 0);
            EXPECT_TRUE(is_found) << "a triangle has no counterpart: its first vertex has position "
                                  << x << ' ' << y << ' ' << z << ", normal " << nx << ' ' << ny
                                  << ' ' << nz << ", uv " << u << ' ' << v;
        }
        const Material& ours = as_gltf.materials.at(mesh.triangles[0].material);
        const Material& its = as_obj.materials.at(other.triangles[0].material);
        EXPECT_EQ(ours.name, its.name);
        // There Kd is the colour of a metal, too; a textured Kd is left out, and means white.
        const float share = mesh.name == "ball" ? 0.5f : 1.0f;
        const vec3 diffuse = its.diffuse_map.file.empty() ? its.diffuse : vec3(1);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(ours.diffuse[i], share * diffuse[i], 1e-6f);
        EXPECT_EQ(ours.diffuse_map.file.empty(), its.diffuse_map.file.empty());
        EXPECT_EQ(ours.opacity, its.opacity);
    }
    const TextureMap& map =
        as_gltf.materials.at(mesh_of(as_gltf, "box").triangles[0].material).diffuse_map;
    ASSERT_TRUE(map.embedded);
    EXPECT_EQ(decode_image(*map.embedded, map.file), read_image(data / "blender_checker.png"));
}

TEST(GltfFiles, BlendersCameraAndLightsKeepTheirPositions) {
    constexpr float tolerance = 1e-5f;  // of floats in the file, times lengths of at most 10
    const Scene scene = load_model(data / "blender.glb");
    ASSERT_EQ(scene.cameras.size(), 1u);
    // There z is up: (x, y, z) is (x, z, -y) here.
    EXPECT_EQ(scene.cameras[0].name, "eye");
    EXPECT_EQ(vec3(scene.cameras[0].world_from_view[3]), vec3(7, 5, 7));
    // Turned by 1.1 from looking down, then by 0.785 around the vertical.
    const vec3 ahead = -vec3(scene.cameras[0].world_from_view[2]);
    EXPECT_NEAR(ahead.y, -std::cos(1.1f), tolerance);
    EXPECT_NEAR(ahead.x, -std::sin(1.1f) * std::sin(0.785f), tolerance);
    EXPECT_NEAR(ahead.z, -std::sin(1.1f) * std::cos(0.785f), tolerance);
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.lights[0].kind, SceneLight::Kind::directional);
    EXPECT_EQ(scene.lights[1].kind, SceneLight::Kind::spot);
    EXPECT_EQ(scene.lights[1].position_world, vec3(4, 5, 4));
    EXPECT_NEAR(scene.lights[1].cos_outer, std::cos(glm::radians(25.0f)), tolerance);
    // Turned by 0.7 from shining down, then by 0.8.
    EXPECT_NEAR(scene.lights[1].direction_world.y, -std::cos(0.7f), tolerance);
    EXPECT_NEAR(scene.lights[1].direction_world.x, -std::sin(0.7f) * std::sin(0.8f), tolerance);
}

TEST(GltfFiles, TheCoursesScenesCallForTheirEffects) {
    const Scene unlit = load_model(models / "unlit.glb"),
                textured = load_model(models / "textured.gltf"),
                bumpy = load_model(models / "bumpy.glb"), toon = load_model(models / "toon.glb"),
                workshop = load_model(models / "workshop.glb");
    for (const Scene* scene : {&unlit, &textured, &bumpy, &toon, &workshop}) {
        EXPECT_TRUE(is_sound(*scene));
        EXPECT_TRUE(scene->warnings.empty()) << scene->warnings[0];
        EXPECT_GE(scene->cameras.size(), 1u);
        for (const Material& material : scene->materials)
            for (const TextureMap* map : {&material.diffuse_map, &material.normal_map})
                EXPECT_TRUE(map->file.empty() || fs::is_regular_file(map->file)) << map->file;
    }
    const auto count = [](const Scene& scene, auto is) {
        return std::count_if(scene.materials.begin() + 1, scene.materials.end(), is);
    };
    EXPECT_TRUE(unlit.lights.empty());
    EXPECT_EQ(count(unlit, [](const Material& m) { return m.illumination > 0; }), 0);
    for (const Mesh& mesh : unlit.meshes) EXPECT_FALSE(mesh.colors.empty());
    EXPECT_FALSE(textured.lights.empty());
    EXPECT_EQ(count(textured, [](const Material& m) { return !m.normal_map.file.empty(); }), 0);
    EXPECT_EQ(count(textured, [](const Material& m) { return !m.diffuse_map.file.empty(); }), 3);
    EXPECT_EQ(std::ranges::count(textured.meshes, 8u,
                                 [](const Mesh& mesh) { return mesh.positions.size(); }),
              4);  // crates
    EXPECT_EQ(count(bumpy, [](const Material& m) { return !m.normal_map.file.empty(); }), 4);
    EXPECT_EQ(bumpy.lights.size(), 2u);
    EXPECT_EQ(count(toon, [](const Material& m) { return !m.toon; }), 0);
}

TEST(GltfFiles, RandomlyDamagedFilesGiveASoundSceneOrAnError) {
    struct Original {
        fs::path file;
        std::string bytes;
        std::size_t json_end;
    };
    const fs::path folder = fresh_folder("gltf_damaged");
    fs::create_directory_symlink(fs::path(RASTERBOOK_ASSETS) / "textures", folder / "textures");
    fs::create_directory(folder / "models");
    fs::copy_file(models / "textured.bin", folder / "models/textured.bin");
    std::vector<Original> originals;
    for (const fs::path& file : {models / "unlit.glb", models / "textured.gltf",
                                 models / "bumpy.glb", models / "toon.glb", data / "blender.glb"}) {
        const std::string bytes = read_text(file);
        const bool is_binary = file.extension() == ".glb";
        std::size_t end = bytes.size();
        if (is_binary) end = 20 + std::uint8_t(bytes[12]) + 256u * std::uint8_t(bytes[13]);
        originals.push_back({file, bytes, end});
    }
    constexpr unsigned seed = 1;
    std::mt19937 random(seed);
    const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
    int read = 0, refused = 0;
    for (int i = 0; i < 2000; ++i) {
        const Original& original = originals[below(originals.size())];
        std::string bytes = original.bytes;
        const std::string signs = "0123456789-.,:[]{}\"eE ";
        for (std::size_t k = 0, times = 1 + below(4); k < times; ++k) {
            // Most of it in the JSON, where the structure is.
            const std::size_t at = below(4) == 0
                                       ? below(bytes.size())
                                       : std::min(below(original.json_end), bytes.size() - 1);
            const std::size_t kind = below(8);
            if (kind == 0) bytes[at] = char(below(256));
            if (kind >= 1 && kind <= 5) {  // another digit: the JSON stays whole
                const auto digit = bytes.find_first_of("0123456789", at);
                if (digit < original.json_end && digit < bytes.size())
                    bytes[digit] = char('0' + below(10));
            }
            if (kind == 6) bytes[at] = signs[below(signs.size())];
            if (kind == 7 && below(4) == 0) bytes.resize(at + 1);
        }
        const fs::path file =
            folder / "models" / (std::string("damaged") + original.file.extension().string());
        fs::remove(file);
        std::ofstream(file, std::ios::binary) << bytes;
        try {
            ASSERT_TRUE(is_sound(load_model(file)))
                << "seed " << seed << ", case " << i << " of " << original.file;
            ++read;
        } catch (const InputError& error) {
            ++refused;
            const std::string text = error.what();
            EXPECT_TRUE(text.starts_with(file.string() + ": ")) << text;
            EXPECT_EQ(text.find('\n'), text.npos) << text;
        }
    }
    EXPECT_GT(read, 200);  // Else the damage is too great to find anything.
    EXPECT_GT(refused, 200);
}

TEST(GltfFiles, BuffersMayBeLongerThanTheySay) {
    const GltfBuilder plain = one_triangle();
    const fs::path folder = fresh_folder("gltf_longer");
    const auto read = [&](const GltfBuilder& made, GltfForm form) {
        return load_model(made.write(folder / "scene.gltf", form)).meshes.at(0);
    };
    const Mesh expected = read(plain, GltfForm::embedded);
    for (const GltfForm form : {GltfForm::embedded, GltfForm::separate, GltfForm::binary})
        for (const std::size_t more : {1, 2, 3, 4, 8, 1000}) {
            SCOPED_TRACE(more);
            GltfBuilder made = plain;
            made.document["buffers"][0]["byteLength"] = made.bytes.size();
            made.bytes += std::string(more, '\x7f');
            const Mesh mesh = read(made, form);
            EXPECT_EQ(mesh.positions, expected.positions);
            EXPECT_EQ(mesh.vertices, expected.vertices);
            // What lies beyond byteLength is not there, in whatever file.
            made.document["bufferViews"][0]["byteOffset"] = plain.bytes.size() - 36 + more;
            EXPECT_THROW(read(made, form), InputError);
        }
}

TEST(GltfFiles, NamesOfFilesAreTakenFromTheirUris) {
    // The name, and URIs that stand for it: RFC 3986, 2.1, encodes bytes and nothing else.
    const std::vector<std::pair<std::string, std::vector<std::string>>> names = {
        {"a+b.bin", {"a+b.bin", "a%2Bb.bin", "a%2bb.bin", "%61+%62.bin"}},
        {"a b.bin", {"a b.bin", "a%20b.bin"}},
        {"100%.bin", {"100%.bin", "100%25.bin"}},
        {"c%20d.bin", {"c%20d.bin", "c%2520d.bin"}},
        {"50%a.bin", {"50%a.bin", "50%25a.bin"}},
        {"a#1?.bin", {"a#1?.bin", "a%231%3F.bin"}},
        {"gr\u00fcn.bin", {"gr\u00fcn.bin", "gr%C3%BCn.bin"}},
        {"sub/a&b=c.bin", {"sub/a&b=c.bin", "sub/a%26b%3Dc.bin", "./sub/a&b=c.bin"}}};
    const fs::path folder = fresh_folder("gltf_uris");
    fs::create_directory(folder / "sub");
    GltfBuilder made = one_triangle();
    for (const auto& [name, uris] : names) {
        // Another file lies where a wrong reading would look, and has another triangle.
        std::ofstream(folder / "a b.bin", std::ios::binary) << std::string(made.bytes.size(), '\0');
        std::ofstream(folder / name, std::ios::binary) << made.bytes;
        write_image(folder / (name + ".png"), Image<u8vec3>({1, 1}, {1, 2, 3}));
        for (const std::string& uri : uris) {
            SCOPED_TRACE(uri);
            made.document["buffers"][0] = {{"uri", uri}, {"byteLength", made.bytes.size()}};
            made.document["images"] = json::array({{{"uri", uri + ".png"}}});
            made.document["textures"] = json::array({{{"source", 0}}});
            made.material()["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
            const Scene scene = load_model(made.write(folder / "scene.gltf"));
            EXPECT_EQ(scene.bounds().max, vec3(1, 1, 0));
            EXPECT_TRUE(fs::is_regular_file(scene.materials.at(1).diffuse_map.file));
        }
    }
}

TEST(GltfFiles, DataUrisAreReadWhateverTheirMediaType) {
    GltfBuilder made = one_triangle();
    const fs::path folder = fresh_folder("gltf_data_uris");
    const std::string in_base64 = base64(made.bytes);
    std::string encoded = in_base64, as_bytes;
    for (std::size_t at = 0; (at = encoded.find_first_of("+/=", at)) != encoded.npos; at += 3)
        encoded.replace(at, 1, encoded[at] == '+' ? "%2B" : encoded[at] == '/' ? "%2f" : "%3D");
    for (const char c : made.bytes) {
        const std::string digits = "0123456789ABCDEF";
        as_bytes += std::string("%") + digits[std::uint8_t(c) / 16] + digits[std::uint8_t(c) % 16];
    }
    for (const std::string& uri :
         {"data:application/octet-stream;base64," + in_base64,
          "data:application/gltf-buffer;base64," + in_base64, "data:;base64," + in_base64,
          "data:model/vnd.mesh;name=a;base64," + in_base64,
          "data:text/plain;charset=utf-8;base64," + encoded,
          "data:text/plain;base64," + in_base64.substr(0, in_base64.find('=')),
          "data:application/octet-stream," + as_bytes}) {
        made.document["buffers"][0]["uri"] = uri;
        EXPECT_EQ(load_model(made.write(folder / "scene.gltf")).bounds().max, vec3(1, 1, 0))
            << uri.substr(0, 60);
    }
}

TEST(GltfFiles, BytesBehindABinaryFileAreAWarning) {
    const fs::path folder = fresh_folder("gltf_behind"), file = folder / "scene.glb";
    // With a buffer of its own, and with JSON alone.
    std::string text = read_text(one_triangle().write(folder / "scene.gltf"));
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::string json_alone = "glTF" + little_endian(2, 4) +
                                   little_endian(20 + text.size(), 4) +
                                   little_endian(text.size(), 4) + "JSON" + text;
    const std::string with_buffer = read_text(one_triangle().write(file, GltfForm::binary));
    for (const std::string& whole : {with_buffer, json_alone})
        for (const std::size_t more : {0, 1, 3, 4, 8, 20, 5000}) {
            std::ofstream(file, std::ios::binary) << whole << std::string(more, 'x');
            const Scene scene = load_model(file);
            EXPECT_EQ(scene.bounds().max, vec3(1, 1, 0));
            ASSERT_EQ(scene.warnings.size(), more == 0 ? 0u : 1u);
            if (more == 0) continue;
            EXPECT_EQ(scene.warnings[0], file.string() + ": " + std::to_string(more) +
                                             " bytes behind its end are ignored");
        }
}

TEST(GltfFiles, ImagesThatAreNotReadAreNamedAndReplaced) {
    const std::string webp = base64(std::string("RIFF\x1a\0\0\0WEBPVP8L", 16) + "0123456789");
    struct Row {
        json texture, image;
        std::string message;
    };
    const auto in = [](const char* extension) {
        return json{{"extensions", {{extension, {{"source", 0}}}}}};
    };
    const json plain = {{"source", 0}}, webp_uri = {{"uri", "data:image/webp;base64," + webp}};
    const std::string other_kind = ": not a PNG, JPEG, BMP or TGA picture";
    const fs::path folder = fresh_folder("gltf_kinds");
    for (const Row& row :
         std::vector<Row>{{in("EXT_texture_webp"), webp_uri,
                           "texture 0: has no image but that of "
                           "EXT_texture_webp, which is not read"},
                          {in("KHR_texture_basisu"), webp_uri, "but that of KHR_texture_basisu"},
                          {in("MSFT_texture_dds"), webp_uri, "but that of MSFT_texture_dds"},
                          {in("EXT_texture_avif"), webp_uri, "but that of EXT_texture_avif"},
                          {json::object(), webp_uri, "texture 0: has no image"},
                          {plain, {{"name", "empty"}}, "image 0 has neither uri nor bufferView"},
                          {plain, webp_uri, "image 0 (image/webp)" + other_kind},
                          {plain,
                           {{"uri", "data:image/ktx2;base64," + webp}},
                           "image 0 (image/ktx2)" + other_kind},
                          {plain, {{"uri", "data:;base64," + webp}}, "image 0" + other_kind},
                          {plain,
                           {{"bufferView", 0}, {"mimeType", "image/webp"}},
                           "image 0 (image/webp)" + other_kind}}) {
        SCOPED_TRACE(row.message);
        GltfBuilder made = one_triangle();
        made.document["textures"] = json::array({row.texture});
        made.document["images"] = json::array({row.image});
        made.material()["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
        const fs::path file = made.write(folder / "scene.gltf");
        Scene scene = load_model(file);
        try {
            load_diffuse_textures(scene, TextureOptions());
            ADD_FAILURE() << "it is read";
        } catch (const InputError& error) {
            const std::string text = error.what();
            EXPECT_TRUE(
                text.starts_with(file.string() + ": material 0 \"paint\": baseColorTexture: "))
                << text;
            EXPECT_NE(text.find(row.message), text.npos) << text;
            EXPECT_LT(text.size(), 500u) << "of which the data are no part";
        }
        TextureOptions options;
        options.keep_going = true;
        EXPECT_EQ(load_diffuse_textures(scene, options).at(1)->levels[0].size, ivec2(8));
        EXPECT_NE(scene.warnings.at(0).find(row.message), std::string::npos);
    }
}

TEST(GltfFiles, SamplersWrapEachDirectionAndMayAskForSharpTexels) {
    const fs::path folder = fresh_folder("gltf_samplers");
    write_image(folder / "wood.png", Image<u8vec3>({4, 4}, {255, 160, 40}));
    GltfBuilder made = one_triangle();
    made.document["images"] = json::array({{{"uri", "wood.png"}}});
    made.document["textures"] = json::array({{{"source", 0}, {"sampler", 0}}});
    made.material()["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    const std::vector<std::pair<int, Wrap>> wraps = {
        {10497, Wrap::repeat}, {33071, Wrap::clamp}, {33648, Wrap::mirror}};
    for (const auto& [gl_u, u] : wraps)
        for (const auto& [gl_v, v] : wraps)
            for (const int mag : {9728, 9729})
                for (const int min : {9728, 9729, 9984, 9985, 9986, 9987}) {
                    made.document["samplers"] = json::array({{{"wrapS", gl_u},
                                                              {"wrapT", gl_v},
                                                              {"magFilter", mag},
                                                              {"minFilter", min}}});
                    Scene scene = load_model(made.write(folder / "scene.gltf"));
                    EXPECT_TRUE(scene.warnings.empty());
                    const auto texture = load_diffuse_textures(scene, TextureOptions()).at(1);
                    EXPECT_TRUE(texture->wrap == WrapModes(u, v));
                    EXPECT_EQ(texture->magnified == Filter::nearest, mag == 9728);
                    EXPECT_EQ(texture->minified == Filter::nearest, min == 9728);
                }
}

TEST(GltfFiles, EachWrapModeIsATextureOfItsOwn) {
    const fs::path folder = fresh_folder("gltf_wrapped");
    write_image(folder / "wood.png", Image<u8vec3>({1, 1}, {255, 160, 40}));
    GltfBuilder made = one_triangle();
    made.document["images"] = json::array({{{"uri", "wood.png"}}});
    for (const int wrap : {10497, 33071, 33648, 33648}) {
        const auto index = made.document["textures"].size();
        made.document["samplers"].push_back({{"wrapS", wrap}, {"wrapT", wrap}});
        made.document["textures"].push_back({{"source", 0}, {"sampler", index}});
        json material = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}};
        material["pbrMetallicRoughness"]["baseColorTexture"]["index"] = index;
        made.document["materials"][index] = material;
        json primitive = made.primitive();
        primitive["material"] = index;
        if (index > 0) made.document["meshes"][0]["primitives"].push_back(primitive);
    }
    Scene scene = load_model(made.write(folder / "scene.gltf"));
    const MaterialTextures textures = load_diffuse_textures(scene, TextureOptions());
    ASSERT_EQ(textures.size(), 5u);
    EXPECT_EQ(textures[1]->wrap, Wrap::repeat);
    EXPECT_EQ(textures[2]->wrap, Wrap::clamp);
    EXPECT_EQ(textures[3]->wrap, Wrap::mirror);
    EXPECT_EQ(textures[3], textures[4]);
}

TEST(GltfFiles, ALessonDrawsAnEmbeddedTextureAsThatOfAnObjFile) {
    const fs::path folder = fresh_folder("gltf_drawn");
    Image<u8vec3> picture({8, 8}, {255, 160, 40});
    for (int i = 0; i < 32; ++i) picture[{i % 8, i / 8}] = {u8vec3(20, 8 * i, 200)};
    write_image(folder / "wood.png", picture);
    std::ofstream(folder / "square.mtl") << "newmtl m\nKd 1 1 1\nillum 0\nmap_Kd wood.png\n";
    std::ofstream(folder / "square.obj")
        << "mtllib square.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
           "vt 0 1\nusemtl m\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
    GltfBuilder made = one_triangle();
    made.primitive() = {
        {"attributes",
         {{"POSITION", made.add({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3", gl_float)},
          {"TEXCOORD_0", made.add({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", gl_float)}}},
        {"indices", made.add({0, 1, 2, 0, 2, 3}, "SCALAR", gl_unsigned_byte)},
        {"material", 0}};
    const std::size_t begin = made.bytes.size();
    made.bytes += read_text(folder / "wood.png");
    made.document["images"] =
        json::array({{{"bufferView", made.add_view(begin)}, {"mimeType", "image/png"}}});
    made.document["textures"] = json::array({{{"source", 0}}});
    made.material() = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                       {"extensions", {{"KHR_materials_unlit", json::object()}}}};
    made.write(folder / "square.GLB", GltfForm::binary);
    const auto drawn = [&](const char* model) {
        const fs::path out = folder / (std::string(model) + ".png");
        const ProcessResult result = run_program(
            "05_textures", {"--model", folder / model, "--out", out, "--size", "64x48"});
        EXPECT_EQ(result.exit_status, 0) << result.err;
        EXPECT_EQ(result.err, "");
        return read_image(out);
    };
    const Image<u8vec4> of_obj = drawn("square.obj");
    EXPECT_EQ(drawn("square.GLB"), of_obj);
    EXPECT_GT(std::ranges::count_if(of_obj.pixels(), [](u8vec4 color) { return color.r > 100; }),
              100);

    made.document["images"] = json::array({{{"uri", "none.png"}}});
    const fs::path broken = made.write(folder / "broken.gltf");
    const ProcessResult result = run_program(
        "05_textures", {"--model", broken, "--out", folder / "none.png", "--size", "8x8"});
    EXPECT_EQ(result.exit_status, 1);
    EXPECT_EQ(result.err, "error: " + broken.string() + ": material 0: baseColorTexture: " +
                              (folder / "none.png").string() + ": there is no such file\n");
}
