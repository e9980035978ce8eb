// SPDX-License-Identifier: MIT
// Materials that call for normal maps, the statements of MTL, and the lesson's pictures.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/image/image_io.hpp"
#include "common/math/color.hpp"
#include "common/model/obj.hpp"
#include "support/first_difference.hpp"
#include "support/golden.hpp"
#include "support/lab_08.hpp"
#include "support/lesson_process.hpp"
#include "support/look_up.hpp"
#include "support/picture_difference.hpp"
#include "support/pictures.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;
namespace fs = std::filesystem;

namespace {

const std::string textures = (fs::path(RASTERBOOK_ASSETS) / "textures").string() + "/";

lab_08::Options small_picture() {
    lab_08::Options options;
    options.size = {320, 180};
    return options;
}

Drawn drawn_scene(const Scene& scene, const lab_08::Options& options) {
    return drawn(options, lab_08::load(scene, options),
                 [](auto&... arguments) { return lab_08::render(arguments...); });
}

Image<vec3> picture_of(const Scene& scene, const lab_08::Options& options) {
    return lab_08::render(options, lab_08::load(scene, options));
}

bool is_finite(const Image<vec3>& picture) {
    return std::ranges::all_of(picture.pixels(), [](vec3 c) {
        return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
    });
}

/// The share of pixels that differ by more than a rounding when they are written.
double share_that_differs(const Image<vec3>& a, const Image<vec3>& b) {
    const Image<u8vec3> code_a = srgb8_from_linear(a), code_b = srgb8_from_linear(b);
    std::size_t differing = 0;
    for (std::size_t i = 0; i < code_a.pixels().size(); ++i)
        differing +=
            !looks_the_same(u8vec4(code_a.pixels()[i], 255), u8vec4(code_b.pixels()[i], 255));
    return static_cast<double>(differing) / static_cast<double>(code_a.pixels().size());
}

fs::path written(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    return file;
}

/// A square that stands upright and looks along z, of the material `m`.
const std::string square =
    "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3 4/4\n";

/// Its material in a folder that stays for the test, beside what `write_pictures` puts there.
Scene square_of(const std::string& material, const std::string& obj = square) {
    const fs::path folder = fresh_folder("normal_mapped_square");
    written(folder / "m.mtl", "newmtl m\nKd 0.8 0.8 0.8\n" + material);
    return load_obj(written(folder / "m.obj", obj));
}

/// Looks at the square from the front, and a little from the side.
lab_08::Options before_the_square() {
    lab_08::Options options = small_picture();
    options.size = {160, 90};
    options.orbit.yaw_degrees = -20;
    return options;
}

/// A picture of one colour in a file of its own.
std::string plain_picture(const std::string& name, u8vec3 color) {
    static const fs::path folder = fresh_folder("plain_pictures");
    write_image(folder / name, Image<u8vec3>({4, 4}, color));
    return (folder / name).string();
}

constexpr std::array all_frames = {FrameOf::face, FrameOf::vertex, FrameOf::pixel};

/// A wavy sheet of 5 x 5 vertices, whose uvs have so many decimals and have been moved; with all
/// kinds of maps.
Scene sheet(const fs::path& folder, int decimals, const std::array<int, 2>& moved,
            const std::string& options) {
    std::mt19937 random(13);
    const auto unit = [&] { return static_cast<double>(random() % 1024) / 1024; };
    std::ostringstream obj;
    obj << std::fixed << "mtllib m.mtl\nusemtl m\n";
    const int scale = decimals == 0 ? 128 : 1000;  // 128: exact as floats, also when moved
    for (int i = 0; i < 25; ++i) {
        obj << std::setprecision(6) << "v " << i % 5 << ' ' << i / 5 << ' ' << unit() << '\n';
        std::string uv;
        for (const int axis : {0, 1}) {
            const auto near =
                std::lround((0.6 * (axis == 0 ? i % 5 : i / 5) + unit() - 1.1) * scale);
            const std::int64_t far = near + std::int64_t{moved[std::size_t(axis)]} * scale;
            std::ostringstream number;  // in decimals, without any rounding
            number << (far < 0 ? "-" : "") << std::abs(far) / scale << '.' << std::setfill('0')
                   << std::setw(decimals == 0 ? 7 : 3)
                   << std::abs(far) % scale * (decimals == 0 ? 78125 : 1);
            uv += ' ' + number.str();
        }
        obj << "vt" << uv << '\n';
    }
    for (int i = 0; i < 16; ++i) {
        const int a = 1 + i % 4 + 5 * (i / 4);
        for (const int vertex : {a, a + 1, a + 6, a + 5})
            obj << (vertex == a ? "f " : " ") << vertex << '/' << vertex;
        obj << '\n';
    }
    written(folder / "m.mtl", "newmtl m\nKs 0.5 0.5 0.5\nNs 9\nKe 0.2 0.2 0.2\nmap_Kd " + options +
                                  "a.png\nmap_Ks " + options + "b.png\nmap_Ke " + options +
                                  "c.png\nnorm " + options + "n.png\n");
    return load_obj(written(folder / "m.obj", obj.str()));
}

}  // namespace

TEST(NormalMaps, HardCase_NoFrameWithoutAMap) {
    look_up("Eq. 8.6");
    const std::string norm = "norm " + textures + "brick_normal.png\n";
    const std::string bump = "map_Bump -bm 0.01 " + textures + "brick_height.png\n";
    struct Row {
        const char* name;
        Scene scene;
        bool has_maps;
    };
    for (const auto& [name, scene, has_maps] :
         {Row{"scene", loaded("scene.obj"), false}, Row{"teapot", loaded("teapot.obj"), false},
          Row{"scene_bumpy", loaded("scene_bumpy.obj"), true},
          Row{"crate_bump", loaded("crate_bump.obj"), true}, Row{"none", square_of(""), false},
          Row{"norm", square_of(norm), true}, Row{"bump", square_of(bump), true},
          Row{"unlit norm", square_of("illum 0\n" + norm), false},
          Row{"unlit bump", square_of("illum 0\n" + bump), false},
          Row{"diffuse norm", square_of("illum 1\n" + norm), true}}) {
        lab_08::Options options = small_picture();
        options.size /= 2;
        for (const FrameOf frame : all_frames) {
            options.method.frame = frame;
            const NormalMapAssets assets = lab_08::load(scene, options);
            for (const Mesh& mesh : assets.scene.meshes) {
                const bool calls_for_one =
                    std::ranges::any_of(mesh.triangles, [&](const Triangle& triangle) {
                        return assets.normal_maps.textures[triangle.material] != nullptr;
                    });
                EXPECT_EQ(mesh.tangents.empty(), !calls_for_one || frame != FrameOf::vertex)
                    << name << ", mesh " << mesh.name;
            }
            const Drawn with = drawn_scene(scene, options);
            EXPECT_EQ(with.count(Counter::normal_map_samples) > 0, has_maps) << name;
            EXPECT_EQ(with.count(Counter::meshes_with_tangents) > 0,
                      has_maps && frame == FrameOf::vertex)
                << name;
            EXPECT_LE(with.count(Counter::normal_map_samples), with.count(Counter::fragments_lit));
        }
        options.method = {};
        options.normal_map.space = MapSpace::none;
        const Drawn without = drawn_scene(scene, options);
        EXPECT_EQ(without.count(Counter::normal_map_samples), 0u) << name;
        EXPECT_EQ(without.count(Counter::meshes_with_tangents), 0u) << name;

        options.normal_map.space = MapSpace::tangent;
        options.shading.all_effects = true;
        const Drawn all = drawn_scene(scene, options);
        EXPECT_EQ(all.count(Counter::normal_map_samples), all.count(Counter::fragments_lit))
            << name;
    }
}

TEST(NormalMaps, HardCase_OnlyMeshesWithMapsHaveTangents) {
    look_up("Eq. 8.6");
    // Two groups; one material has a map.
    const std::string two =
        "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "g first\nusemtl m\nf 1/1 2/2 3/3\ng second\nusemtl plain\nf 1/1 3/3 4/4\n";
    const Scene scene = square_of("norm " + textures + "brick_normal.png\nnewmtl plain\n", two);
    lab_08::Options options = before_the_square();
    ASSERT_EQ(scene.meshes.size(), 2u);
    const NormalMapAssets assets = lab_08::load(scene, options);
    EXPECT_EQ(assets.scene.meshes[0].tangents.size(), 3u);
    EXPECT_EQ(assets.scene.meshes[1].tangents.size(), 0u);
    EXPECT_EQ(drawn_scene(scene, options).count(Counter::meshes_with_tangents), 1u);
}

TEST(NormalMaps, HardCase_AFlatMapChangesNothing) {
    look_up("Robust: A flat map changes nothing");
    const std::string flat = plain_picture("flat.png", {128, 128, 255});
    const std::string level = plain_picture("level.png", {77, 77, 77});
    const std::string shiny = "Ks 0.5 0.5 0.5\nNs 20\n";
    for (const Filter filter : {Filter::nearest, Filter::bilinear, Filter::trilinear})
        for (const FrameOf frame : all_frames) {
            lab_08::Options options = before_the_square();
            options.texture.filter = filter;
            options.method.frame = frame;
            options.method.format = NormalFormat::snorm;  // no UNORM value is exactly 0
            options.shading.two_sided = true;
            for (const float yaw : {-20.0f, 160.0f}) {
                options.orbit.yaw_degrees = yaw;
                const Image<vec3> plain = picture_of(square_of(shiny), options);
                for (const std::string& map :
                     {"norm " + flat, "norm -bm 7 " + flat, "map_Bump " + level,
                      "map_Bump -bm 100 " + level, "map_Bump " + flat})
                    ASSERT_TRUE(have_the_same_bits(
                        picture_of(square_of(shiny + map + "\n"), options), plain))
                        << "a square with `" << map << "`, beside the same without a map";
            }
        }
}

TEST(NormalMaps, HardCase_EffectsThatAreNotCalledForWouldChangeNothing) {
    look_up("Robust: A flat map changes nothing");
    for (const char* model :
         {"scene.obj", "teapot.obj", "crate.obj", "scene_bumpy.obj", "crate_bump.obj"}) {
        const Scene scene = loaded(model);
        for (const FrameOf frame : all_frames)
            for (const MapSpace space : {MapSpace::tangent, MapSpace::object, MapSpace::none}) {
                lab_08::Options options = small_picture();
                options.method.frame = frame;
                options.normal_map.space = space;
                options.shading.two_sided = frame == FrameOf::pixel;
                const Image<vec3> picture = picture_of(scene, options);
                options.shading.all_effects = true;
                ASSERT_TRUE(have_the_same_bits(picture_of(scene, options), picture))
                    << model << " with --all-effects, beside the same without";
                ASSERT_FALSE(is_backdrop(picture)) << model << ": nothing is drawn";
            }
    }
}

TEST(NormalMaps, HardCase_AMapOfOneNormalIsASlantedSurface) {
    look_up("Eq. 8.7");
    // The whole map has one normal, that points to the right, or up. Without highlights, the square
    // looks like one whose vertices have that normal.
    const float c = component_from_unorm(222), s = component_from_unorm(213);  // .74 and .67
    const float o = component_from_unorm(128);                                 // .004
    const std::string right = "norm " + plain_picture("right.png", {213, 128, 222}) + "\n";
    const std::string up = "norm " + plain_picture("up.png", {128, 213, 222}) + "\n";
    const auto slanted_square = [&](vec3 normal) {
        const std::string n = std::to_string(normal.x) + " " + std::to_string(normal.y) + " " +
                              std::to_string(normal.z);
        return square_of("", "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvn " + n +
                                 "\nusemtl m\nf 1//1 2//1 3//1 4//1\n");
    };
    for (const LightKind kind : {LightKind::directional, LightKind::point})
        for (const FrameOf frame : all_frames)
            for (const Filter filter : {Filter::nearest, Filter::trilinear}) {
                lab_08::Options options = before_the_square();
                options.shading.key_light = kind;
                options.method.frame = frame;
                options.texture.filter = filter;
                EXPECT_EQ(share_that_differs(picture_of(square_of(right), options),
                                             picture_of(slanted_square({s, o, c}), options)),
                          0);
                EXPECT_EQ(share_that_differs(picture_of(square_of(up), options),
                                             picture_of(slanted_square({o, s, c}), options)),
                          0);
                EXPECT_GT(share_that_differs(picture_of(square_of(up), options),
                                             picture_of(slanted_square({o, -s, c}), options)),
                          0.1);
                // Green down, and a map that is mirrored by its -s.
                options.normal_map.green = Green::down;
                EXPECT_EQ(share_that_differs(picture_of(square_of(up), options),
                                             picture_of(slanted_square({o, -s, c}), options)),
                          0);
                options.normal_map.green = Green::up;
                std::string mirrored = right;
                mirrored.insert(5, "-s -1 1 1 ");
                EXPECT_EQ(share_that_differs(picture_of(square_of(mirrored), options),
                                             picture_of(slanted_square({-s, o, c}), options)),
                          0);
                // Twice as steep.
                std::string steep = right;
                steep.insert(5, "-bm 2 ");
                EXPECT_EQ(
                    share_that_differs(picture_of(square_of(steep), options),
                                       picture_of(slanted_square({2 * s, 2 * o, c}), options)),
                    0);
                // In object space the components are along the axes.
                options.normal_map.space = MapSpace::object;
                EXPECT_EQ(share_that_differs(picture_of(square_of(up), options),
                                             picture_of(slanted_square({o, s, c}), options)),
                          0);
            }
}

TEST(NormalMaps, HardCase_ObjectSpaceMapsNeedNoFrame) {
    look_up("Robust: Maps in object space");
    // A floor that faces up: in object space (0, 1, 0) is flat.
    const std::string floor =
        "mtllib m.mtl\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "usemtl m\nf 1/1 2/2 3/3 4/4\n";
    const std::string flat = "norm " + plain_picture("flat_up.png", {128, 255, 128}) + "\n";
    lab_08::Options options = before_the_square();
    options.normal_map.space = MapSpace::object;
    options.method.format = NormalFormat::snorm;  // (128, 255, 128) is exactly (0, 1, 0)
    const Image<vec3> plain = picture_of(square_of("", floor), options);
    EXPECT_EQ(share_that_differs(picture_of(square_of(flat, floor), options), plain), 0);
    EXPECT_EQ(drawn_scene(square_of(flat, floor), options).count(Counter::meshes_with_tangents),
              0u);
    // -bm scales in the tangent frame: it does not count here.
    const std::string slanted = plain_picture("slanted_up.png", {190, 230, 128}) + "\n";
    EXPECT_TRUE(are_equal(picture_of(square_of("norm -bm 3 " + slanted, floor), options),
                          picture_of(square_of("norm " + slanted, floor), options)));
    // From below it is the other side.
    options.orbit.pitch_degrees = -30;
    options.shading.two_sided = true;
    const Image<vec3> below = picture_of(square_of("", floor), options);
    EXPECT_EQ(share_that_differs(picture_of(square_of(flat, floor), options), below), 0);
}

TEST(NormalMaps, HardCase_BacksOfFaces) {
    look_up("Robust: Seen from behind, and in mirrored copies");
    // From behind a dent is a bump: as a square that looks there, with the texture mirrored and
    // steep the other way.
    const std::string map = textures + "hammered_normal.png\n";
    const std::string from_behind =
        "mtllib m.mtl\nv 1 -1 0\nv -1 -1 0\nv -1 1 0\nv 1 1 0\n"
        "vt 1 0\nvt 0 0\nvt 0 1\nvt 1 1\nusemtl m\nf 1/1 2/2 3/3 4/4\n";
    for (const FrameOf frame : all_frames) {
        lab_08::Options options = before_the_square();
        options.method.frame = frame;
        options.orbit.yaw_degrees = 160;
        const Image<vec3> front = picture_of(square_of("norm -bm -1 " + map, from_behind), options);
        EXPECT_FALSE(is_backdrop(front));
        options.shading.two_sided = true;
        EXPECT_EQ(share_that_differs(picture_of(square_of("norm " + map), options), front), 0);
        EXPECT_GT(
            share_that_differs(picture_of(square_of("norm " + map, from_behind), options), front),
            0.1);
    }
}

namespace {

/// The share of a model's pixels whose red, green or blue differs by more than so many levels.
double share_that_is_other(const Image<vec3>& a, const Image<vec3>& b, int levels) {
    const Image<u8vec3> code_a = srgb8_from_linear(a), code_b = srgb8_from_linear(b),
                        around = srgb8_from_linear(backdrop(a.size()));
    double of_model = 0, other = 0;
    for (std::size_t i = 0; i < code_a.pixels().size(); ++i) {
        if (code_a.pixels()[i] == around.pixels()[i]) continue;
        ++of_model;
        other += greatest_difference(u8vec4(code_a.pixels()[i], 255),
                                     u8vec4(code_b.pixels()[i], 255)) > levels;
    }
    return other / of_model;
}

}  // namespace

TEST(NormalMaps, HardCase_WrongHandednessShowsOnMirroredHalves) {
    look_up("Eq. 8.4, The mirror");
    const Scene shield = loaded("shield_mirrored_uvs.obj");
    for (const FrameOf frame : {FrameOf::vertex, FrameOf::pixel}) {
        lab_08::Options options = small_picture();
        options.orbit.distance = 2.7f;
        options.method.frame = frame;
        const Image<vec3> right = picture_of(shield, options);
        options.method.handedness = Handedness::ignored;
        const Image<vec3> wrong = picture_of(shield, options);
        // 38% of the shield's pixels, and 18%.
        EXPECT_GT(share_that_is_other(right, wrong, 4), 0.35)
            << "of the shield's pixels differ by more than 4 of 255 if no handedness is used";
        EXPECT_GT(share_that_is_other(right, wrong, 16), 0.15)
            << "of the shield's pixels differ by more than 16 of 255 if no handedness is used";
        EXPECT_LT(share_that_is_other(right, wrong, 4), 0.5) << "one half of it is not mirrored";
    }
}

TEST(NormalMaps, HardCase_MirroredHalvesLookLikeAWholeTexture) {
    look_up("Eq. 8.4, The mirror");
    // The shield's texture has both halves. What its left half shows mirrored is there once more as
    // it is to look: with v beyond 0.5, and nothing is mirrored any more.
    const Scene mirrored = loaded("shield_mirrored_uvs.obj");
    Scene whole = mirrored;
    int changed = 0;
    for (Mesh& mesh : whole.meshes)
        for (Triangle& triangle : mesh.triangles) {
            const auto uv = [&](std::size_t i) { return mesh.uvs[triangle.vertices[i].uv]; };
            const vec2 d1 = uv(1) - uv(0), d2 = uv(2) - uv(0);
            if (d1.x * d2.y > d2.x * d1.y) continue;
            ++changed;
            for (Vertex& vertex : triangle.vertices) {
                const vec2 of_other_half = mesh.uvs[vertex.uv];
                vertex.uv = static_cast<std::uint32_t>(mesh.uvs.size());
                mesh.uvs.emplace_back(of_other_half.x, 1 - of_other_half.y);
            }
        }
    ASSERT_GT(changed, 100);
    for (const FrameOf frame : all_frames) {
        lab_08::Options options = small_picture();
        options.orbit.distance = 2.7f;
        options.method.frame = frame;
        EXPECT_LT(share_that_is_other(picture_of(mirrored, options), picture_of(whole, options), 2),
                  0.001)
            << "of the shield's pixels differ, one half of it mirrored in the texture or not";
    }
}

TEST(NormalMaps, HardCase_NormalsOrHeightsInMapBump) {
    look_up("Eq. 8.9");
    const lab_08::Options options = before_the_square();
    const std::string normals = textures + "brick_normal.png\n";
    const std::string heights = "map_Bump -bm 0.014 " + textures + "brick_height.png\n";
    const Image<vec3> as_norm = picture_of(square_of("norm " + normals), options);
    // Coloured pictures are normals; `norm` counts more; keywords in any case.
    EXPECT_TRUE(are_equal(picture_of(square_of("map_Bump " + normals), options), as_norm))
        << "map_Bump " + normals;
    EXPECT_TRUE(are_equal(picture_of(square_of("bump " + normals), options), as_norm))
        << "bump " + normals;
    EXPECT_TRUE(are_equal(picture_of(square_of("norm " + normals + heights), options), as_norm))
        << "norm " + normals + heights;
    EXPECT_TRUE(are_equal(picture_of(square_of(heights + "norm " + normals), options), as_norm))
        << heights + "norm " + normals;
    const Image<vec3> as_heights = picture_of(square_of(heights), options);
    EXPECT_FALSE(are_equal(as_heights, as_norm)) << "heights are read as if they were normals";
    EXPECT_FALSE(are_equal(as_heights, picture_of(square_of(""), options)))
        << "heights change nothing";
    // Both come from the same surface.
    double difference = 0, effect = 0;
    const Image<vec3> plain = picture_of(square_of(""), options);
    for (std::size_t i = 0; i < plain.pixels().size(); ++i) {
        difference += std::abs(as_heights.pixels()[i].x - as_norm.pixels()[i].x);
        effect += std::abs(as_norm.pixels()[i].x - plain.pixels()[i].x);
    }
    EXPECT_LT(difference, 0.1 * effect);
}

TEST(NormalMaps, HardCase_MissingAndBrokenMaps) {
    look_up("Eq. 8.9");
    const fs::path folder = fresh_folder("broken_normal_map"), out = folder / "out.png";
    const fs::path model = written(folder / "m.obj", square);
    written(folder / "broken.png", "\x89PNG and no more");
    for (const std::string statement : {"norm", "map_Bump"})
        for (const char* name : {"missing.png", "broken.png"}) {
            written(folder / "m.mtl", "newmtl m\n\n" + statement + " " + name + "\n");
            const std::vector<std::string> arguments = {"--model", model.string(), "--size",
                                                        "64x36",   "--out",        out.string()};
            const ProcessResult result = run_program("08_normal_maps", arguments);
            EXPECT_EQ(result.exit_status, 1);
            const std::string where = (folder / "m.mtl").string() + ":3: " + statement + ": ";
            EXPECT_EQ(result.err.rfind("error: " + where, 0), 0u) << result.err;
            EXPECT_NE(result.err.find(name), std::string::npos) << result.err;
            EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
            EXPECT_FALSE(fs::exists(out));

            std::vector<std::string> keep_going = arguments;
            keep_going.push_back("--keep-going");
            const ProcessResult replaced = run_program("08_normal_maps", keep_going);
            EXPECT_EQ(replaced.exit_status, 0) << replaced.err;
            EXPECT_EQ(replaced.err.rfind("warning: " + where, 0), 0u) << replaced.err;
            EXPECT_TRUE(fs::remove(out));
            // What is not called for is not read.
            std::vector<std::string> without = arguments;
            without.insert(without.end(), {"--normal-map", "none"});
            EXPECT_EQ(run_program("08_normal_maps", without).exit_status, 0);
            written(folder / "m.mtl", "newmtl m\nillum 0\n" + statement + " " + name + "\n");
            EXPECT_EQ(run_program("08_normal_maps", arguments).exit_status, 0);
            EXPECT_TRUE(fs::remove(out));
        }
}

TEST(NormalMaps, HardCase_DegenerateUvs) {
    look_up("Robust: Where no tangent is left");
    const std::string begin = "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";
    const std::string map = "Ks 1 1 1\nNs 5\nnorm " + textures + "hammered_normal.png\n";
    for (const std::string uvs :
         {"", "vt 0 0\nvt 0 0\nvt 0 0\nvt 0 0\n", "vt 0 0\nvt 1 0\nvt 2 0\nvt 3 0\n",
          "vt 0.3 0.3\nvt 0.3 0.3\nvt 1 1\nvt 0 1\n",
          "vt 0 0\nvt 1e30 0\nvt 1e30 1e30\nvt 0 1e30\n",
          "vt 0 0\nvt 1e-30 0\nvt 1e-30 1e-30\nvt 0 1e-30\n",
          "vt 3e38 -3e38\nvt -3e38 0\nvt 1 3e38\nvt 0 0\n"})
        for (const FrameOf frame : all_frames)
            for (const char* steepness : {"", "-bm 1e37 ", "-bm 0 ", "-bm 1e-40 "}) {
                std::string material = map;
                material.insert(material.find("norm ") + 5, steepness);
                lab_08::Options options = before_the_square();
                options.method.frame = frame;
                const Image<vec3> picture = picture_of(
                    square_of(material, begin + uvs + "usemtl m\n" +
                                            (uvs.empty() ? "f 1 2 3 4\n" : "f 1/1 2/2 3/3 4/4\n")),
                    options);
                EXPECT_TRUE(is_finite(picture)) << uvs << steepness;
                EXPECT_FALSE(is_backdrop(picture)) << uvs << steepness;
            }
}

TEST(NormalMaps, HardCase_ModelsOfAllSizes) {
    look_up("Eq. 8.3");
    const Scene scene = loaded("scene_bumpy.obj");
    lab_08::Options options = small_picture();
    options.size = {160, 90};
    for (const FrameOf frame : all_frames) {
        options.method.frame = frame;
        const Image<vec3> expected = picture_of(scene, options);
        EXPECT_TRUE(is_finite(expected));
        for (const float factor : {0x1p-100f, 0x1p-40f, 0x1p60f, 0x1p120f}) {
            Scene other = scene;
            for (Mesh& mesh : other.meshes) {
                mesh.bounds = {};
                for (vec3& position : mesh.positions) position *= factor, mesh.bounds.add(position);
            }
            const Image<vec3> picture = picture_of(other, options);
            EXPECT_TRUE(is_finite(picture)) << factor;
            EXPECT_EQ(share_that_differs(expected, picture), 0) << factor;
        }
    }
}

TEST(NormalMaps, PictureOfTheScene) {
    EXPECT_TRUE(equals_golden("08_normal_maps", "08_normal_maps"));
}

TEST(NormalMaps, PictureOfMirroredHalves) {
    EXPECT_TRUE(equals_golden("08_normal_maps", "08_normal_maps_mirrored_uvs",
                              {"--model", "shield_mirrored_uvs.obj", "--distance", "2.7"}));
}

TEST(NormalMaps, PictureOfHeights) {
    EXPECT_TRUE(equals_golden("08_normal_maps", "08_normal_maps_heights",
                              {"--model", "crate_bump.obj", "--distance", "3.4", "--yaw", "-50"}));
}

TEST(NormalMaps, PictureOfGreenDown) {
    EXPECT_TRUE(equals_golden("08_normal_maps", "08_normal_maps_green_down", {"--green", "down"}));
}

TEST(NormalMaps, PictureOfObjectSpaceMaps) {
    EXPECT_TRUE(
        equals_golden("08_normal_maps", "08_normal_maps_object", {"--normal-map", "object"}));
}

TEST(NormalMaps, PictureOfTheSceneWithoutMaps) {
    EXPECT_TRUE(equals_golden("08_normal_maps", "08_normal_maps_none", {"--normal-map", "none"}));
}

TEST(NormalMaps, HardCase_UvsMovedByWholeNumbersLookTheSame) {
    look_up("Eq. 8.3");
    const fs::path folder = fresh_folder("far_uvs");
    std::mt19937 random(5);
    for (const char* name : {"a.png", "b.png", "c.png", "n.png"}) {
        Image<u8vec3> noise({16, 16});
        for (u8vec3& texel : noise.pixels())
            texel = {random() % 256, random() % 256, name[0] == 'n' ? 255 : random() % 256};
        write_image(folder / name, noise);
    }
    for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp})
        for (const Filter filter : {Filter::nearest, Filter::trilinear})
            for (const int decimals : {3, 0})
                for (const std::string options : {"", "-s 3 2 1 -o 0.3 -0.7 0 "}) {
                    lab_08::Options with = small_picture();
                    with.size = {120, 90};
                    with.texture.wrap = wrap, with.texture.filter = filter;
                    with.orbit.yaw_degrees = 0;
                    const auto picture = [&](const std::array<int, 2>& moved) {
                        Scene scene = sheet(folder, decimals, moved, options);
                        if (decimals == 0)  // as a glTF file has them
                            for (dvec2& uv : scene.meshes[0].uvs) uv = vec2(uv);
                        return picture_of(scene, with);
                    };
                    const Image<vec3> near = picture({0, 0});
                    for (const auto& moved : {std::array{2, -2},
                                              {-4, 100},
                                              {65536, 65536},
                                              {-65536, 2},
                                              {30'000, -60'002}})
                        EXPECT_EQ(have_the_same_bits(picture(moved), near), wrap != Wrap::clamp)
                            << "moved by " << moved[0] << ", " << moved[1] << "; wrap "
                            << static_cast<int>(wrap) << ", filter " << static_cast<int>(filter)
                            << ", decimals " << decimals << ' ' << options;
                    const bool is_moved = !have_the_same_bits(picture({1, -65535}), near);
                    EXPECT_EQ(is_moved, wrap != Wrap::repeat) << "moved by an odd number";
                }
}
