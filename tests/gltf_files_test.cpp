// SPDX-License-Identifier: MIT
/// @file
/// Real glTF files: Blender's, the course's own, damaged ones, and one that a lesson draws.
/// tests/data/gltf/blender_scene.py makes Blender's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <random>
#include <set>

#include "05_textures/load_textures.hpp"
#include "05_textures/textures.hpp"
#include "common/image/image_io.hpp"
#include "common/model/model_file.hpp"
#include "support/gltf_builder.hpp"
#include "support/lesson_process.hpp"
#include "support/sound_scene.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

namespace fs = std::filesystem;

const fs::path models = fs::path(RASTERBOOK_ASSETS) / "models";
const fs::path data = fs::path(RASTERBOOK_TEST_DATA) / "gltf";

const Mesh& mesh_of(const Scene& scene, const std::string& name) {
    const auto found = std::ranges::find(scene.meshes, name, &Mesh::name);
    if (found == scene.meshes.end()) throw std::runtime_error("no mesh " + name);
    return *found;
}

/// Position, normal and uv of a triangle's vertex are those of another's, which OBJ has with 6
/// decimals (of normals: 4); glTF's quaternions are floats, times lengths of at most 5.
bool is_same_vertex(const Mesh& mesh, const Vertex& a, const Mesh& other, const Vertex& b) {
    const auto is_near = [](auto p, auto q, double tolerance) {
        for (int i = 0; i < p.length(); ++i)
            if (!(std::abs(p[i] - q[i]) < tolerance)) return false;
        return true;
    };
    return is_near(mesh.positions.at(a.position), other.positions.at(b.position), 3e-6) &&
           is_near(mesh.normals.at(a.normal), other.normals.at(b.normal), 1e-4) &&
           is_near(mesh.uvs.at(a.uv), other.uvs.at(b.uv), 1e-6);
}

}  // namespace

TEST(GltfFiles, BlendersSceneIsTheSameInBothFormats) {
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
        const auto is_counterpart = [&](const Triangle& triangle, std::size_t t) {
            const auto& [vertices, material] = other.triangles[t];
            for (std::size_t turn = 0; turn < 3 && !taken.contains(t); ++turn) {
                std::size_t same = 0;
                for (std::size_t i = 0; i < 3; ++i)
                    same +=
                        is_same_vertex(mesh, triangle.vertices[i], other, vertices[(i + turn) % 3]);
                if (same == 3) return true;
            }
            return false;
        };
        for (const Triangle& triangle : mesh.triangles) {
            std::size_t t = 0;
            while (t < other.triangles.size() && !is_counterpart(triangle, t)) ++t;
            EXPECT_LT(t, other.triangles.size())
                << "no triangle of the OBJ file is that which begins at "
                << testing::PrintToString(mesh.positions[triangle.vertices[0].position]);
            taken.insert(t);
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

TEST(GltfFiles, TheCoursesScenesAreReadWithoutAWarning) {
    for (const char* name :
         {"unlit.glb", "textured.gltf", "bumpy.glb", "toon.glb", "workshop.glb"}) {
        const Scene scene = load_model(models / name);
        EXPECT_TRUE(is_sound(scene));
        EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
        EXPECT_GE(scene.cameras.size(), 1u) << name;
        for (const Material& material : scene.materials)
            for (const TextureMap* map : {&material.diffuse_map, &material.normal_map})
                EXPECT_TRUE(map->file.empty() || fs::is_regular_file(map->file)) << map->file;
    }
}

TEST(GltfFiles, RandomlyDamagedFilesGiveASoundSceneOrAnError) {
    const fs::path file = fresh_folder("gltf_damaged") / "damaged.glb";
    const std::vector<std::string> originals = {
        read_text(models / "unlit.glb"), read_text(models / "bumpy.glb"),
        read_text(models / "toon.glb"), read_text(data / "blender.glb")};
    constexpr unsigned seed = 1;
    std::mt19937 random(seed);
    const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
    int read = 0, refused = 0;
    for (int i = 0; i < 2000; ++i) {
        std::string bytes = originals[below(originals.size())];
        const std::size_t json_end = 20 + std::uint8_t(bytes[12]) + 256u * std::uint8_t(bytes[13]);
        const std::string signs = "0123456789-.,:[]{}\"eE ";
        for (std::size_t k = 0, times = 1 + below(4); k < times; ++k) {
            // Most of it in the JSON, where the structure is.
            const std::size_t end = std::min(json_end, bytes.size());
            const std::size_t at = below(below(4) == 0 ? bytes.size() : end), kind = below(8);
            if (kind == 0) bytes[at] = char(below(256));
            if (kind == 1) bytes[at] = signs[below(signs.size())];
            if (kind == 2 && below(4) == 0) bytes.resize(at + 1);
            if (kind < 3) continue;
            const auto digit = bytes.find_first_of("0123456789", at);
            if (digit < end) bytes[digit] = char('0' + below(10));  // the JSON stays whole
        }
        fs::remove(file);
        std::ofstream(file, std::ios::binary) << bytes;
        try {
            ASSERT_TRUE(is_sound(load_model(file))) << "seed " << seed << ", case " << i;
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
        for (const std::size_t more : std::initializer_list<std::size_t>{1, 2, 3, 4, 8, 1000}) {
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
            made.set_texture(uri + ".png");
            const Scene scene = load_model(made.write(folder / "scene.gltf"));
            EXPECT_EQ(scene.bounds().max, vec3(1, 1, 0));
            EXPECT_TRUE(fs::is_regular_file(scene.materials.at(1).diffuse_map.file));
        }
    }
}

TEST(GltfFiles, DataUrisAreReadWhateverTheirMediaType) {
    GltfBuilder made = one_triangle();
    const fs::path folder = fresh_folder("gltf_data_uris");
    const std::string in_base64 = base64(made.bytes), digits = "0123456789ABCDEF";
    std::string as_bytes, encoded;
    for (const char character : made.bytes) {
        const auto c = static_cast<unsigned char>(character);
        as_bytes += std::string("%") + digits[c / 16] + digits[c % 16];
    }
    for (const char c : in_base64)
        encoded += c == '+' ? "%2B" : c == '/' ? "%2f" : c == '=' ? "%3D" : std::string(1, c);
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
        for (const std::size_t more : std::initializer_list<std::size_t>{0, 1, 3, 4, 8, 20, 5000}) {
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
    const std::string webp = base64(std::string("RIFF\x1a\0\0\0WEBPVP8L", 16) + "0123456789"),
                      no_image = "texture 0: has no image",
                      other_kind = ": not a PNG, JPEG, BMP or TGA picture";
    const auto only_in = [&](const std::string& extension) {
        return std::pair(
            "\"/textures/0\": {\"extensions\": {\"" + extension + "\": {\"source\": 0}}}",
            no_image + " but that of " + extension + ", which is not read");
    };
    const auto image_data = [&](const std::string& type) {
        return "\"/images/0/uri\": \"data:" + type + ";base64," + webp + "\"";
    };
    const std::vector<std::pair<std::string, std::string>> cases = {
        only_in("EXT_texture_webp"),
        only_in("KHR_texture_basisu"),
        only_in("MSFT_texture_dds"),
        only_in("EXT_texture_avif"),
        {R"("/textures/0": {})", no_image},
        {R"("/images/0": {"name": "empty"})", "image 0 has neither uri nor bufferView"},
        {image_data("image/webp"), "image 0 (image/webp)" + other_kind},
        {image_data(""), "image 0" + other_kind},
        {R"("/images/0": {"bufferView": 0, "mimeType": "image/webp"})",
         "image 0 (image/webp)" + other_kind}};
    const fs::path folder = fresh_folder("gltf_kinds");
    for (const auto& [changes, message] : cases) {
        SCOPED_TRACE(message);
        GltfBuilder made = one_triangle();
        made.set_texture("a.png").set(changes);
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
            EXPECT_NE(text.find(message), text.npos) << text;
            EXPECT_LT(text.size(), 500u) << "of which the data are no part";
        }
        TextureOptions options;
        options.keep_going = true;
        EXPECT_EQ(load_diffuse_textures(scene, options).at(1)->levels[0].size, ivec2(8));
        EXPECT_NE(scene.warnings.at(0).find(message), std::string::npos);
    }
}

TEST(GltfFiles, SamplersWrapEachDirectionAndMayAskForSharpTexels) {
    const fs::path folder = fresh_folder("gltf_samplers");
    write_image(folder / "wood.png", Image<u8vec3>({4, 4}, {255, 160, 40}));
    GltfBuilder made = one_triangle();
    made.set_texture("wood.png").set(R"("/textures/0/sampler": 0)");
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
    made.set_texture("wood.png");
    made.set(R"("/samplers": [{"wrapS": 10497, "wrapT": 10497}, {"wrapS": 33071, "wrapT": 33071},
                              {"wrapS": 33648, "wrapT": 33648}, {"wrapS": 33648, "wrapT": 33648}])");
    const json material = made.material(), primitive = made.primitive();
    for (std::size_t i = 0; i < 4; ++i) {
        made.document["textures"][i] = {{"source", 0}, {"sampler", i}};
        json& own = made.document["materials"][i] = material;
        own["pbrMetallicRoughness"]["baseColorTexture"]["index"] = i;
        made.document["meshes"][0]["primitives"][i] = primitive;
        made.document["meshes"][0]["primitives"][i]["material"] = i;
    }
    Scene scene = load_model(made.write(folder / "scene.gltf"));
    const MaterialTextures textures = load_diffuse_textures(scene, TextureOptions());
    ASSERT_EQ(textures.size(), 5u);
    EXPECT_EQ(textures[1]->wrap, Wrap::repeat);
    EXPECT_EQ(textures[2]->wrap, Wrap::clamp);
    EXPECT_EQ(textures[3]->wrap, Wrap::mirror);
    EXPECT_EQ(textures[3], textures[4]);
}

TEST(GltfFiles, ALessonDrawsAnEmbeddedTextureAsOneInAFile) {
    const fs::path folder = fresh_folder("gltf_drawn");
    Image<u8vec3> picture({8, 8}, {255, 160, 40});
    for (int i = 0; i < 32; ++i) picture[{i % 8, i / 8}] = {u8vec3(20, 8 * i, 200)};
    write_image(folder / "wood.png", picture);
    const auto drawn = [&](const fs::path& model) {
        const fs::path out = folder / "drawn.png";
        const ProcessResult result =
            run_program("05_textures", {"--model", model, "--out", out, "--size", "64x48"});
        EXPECT_EQ(result.exit_status, 0) << result.err;
        EXPECT_EQ(result.err, "");
        return read_image(out);
    };
    GltfBuilder made = one_triangle();
    made.set_texture("wood.png").set(R"("/materials/0/extensions/KHR_materials_unlit": {})");
    const Image<u8vec4> of_file = drawn(made.write(folder / "file.gltf"));
    const std::size_t begin = made.bytes.size();
    made.bytes += read_text(folder / "wood.png");
    made.add_view(begin);
    made.set(R"("/images/0": {"bufferView": 4, "mimeType": "image/png"})");
    EXPECT_EQ(drawn(made.write(folder / "embedded.GLB", GltfForm::binary)), of_file);
    EXPECT_GT(std::ranges::count_if(of_file.pixels(), [](u8vec4 color) { return color.r > 100; }),
              100);

    made.set(R"("/images/0": {"uri": "none.png"})");
    const fs::path broken = made.write(folder / "broken.gltf");
    expect_error(run_program("05_textures", {"--model", broken, "--out", folder / "none.png"}), 1,
                 broken.string() + ": material 0 \"paint\": baseColorTexture: " +
                     (folder / "none.png").string() + ": there is no such file");
}
