// SPDX-License-Identifier: MIT
// Materials that call for normal maps, the statements of MTL, and the lesson's pictures.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <tuple>
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
#include "support/special_numbers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;
namespace fs = std::filesystem;

namespace {

const std::string textures = (fs::path(RASTERBOOK_ASSETS) / "textures").string() + "/";

constexpr std::array all_frames = {FrameOf::face, FrameOf::vertex, FrameOf::pixel};

lab_08::Options small_picture() {
    lab_08::Options options;
    options.size = {160, 90};
    return options;
}

Drawn drawn_scene(const Scene& scene, const lab_08::Options& options) {
    return drawn(options, lab_08::load(scene, options),
                 [](auto&... arguments) { return lab_08::render(arguments...); });
}

Image<vec3> picture_of(const Scene& scene, const lab_08::Options& options) {
    return lab_08::render(options, lab_08::load(scene, options));
}

bool all_are_finite(const Image<vec3>& picture) {
    return std::ranges::all_of(picture.pixels(), [](vec3 c) { return is_finite(c); });
}

/// The share of pixels that differ by more than so many levels when they are written.
double share_that_differs(const Image<vec3>& a, const Image<vec3>& b,
                          int levels = levels_that_may_differ) {
    const Image<u8vec3> code_a = srgb8_from_linear(a), code_b = srgb8_from_linear(b);
    double differing = 0;
    for (std::size_t i = 0; i < code_a.pixels().size(); ++i)
        differing += greatest_difference(u8vec4(code_a.pixels()[i], 255),
                                         u8vec4(code_b.pixels()[i], 255)) > levels;
    return differing / static_cast<double>(code_a.pixels().size());
}

fs::path written(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    return file;
}

/// A square that stands upright and looks along z, of the material `m`.
const std::string square =
    "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3 4/4\n";

Scene square_of(const std::string& material, const std::string& obj = square) {
    const fs::path folder = fresh_folder("normal_mapped_square");
    written(folder / "m.mtl", "newmtl m\nKd 0.8 0.8 0.8\n" + material);
    return load_obj(written(folder / "m.obj", obj));
}

/// Looks at the square from the front, and a little from the side.
lab_08::Options before_the_square() {
    lab_08::Options options = small_picture();
    options.orbit.yaw_degrees = -20;
    return options;
}

/// A picture of one colour in a file of its own.
std::string plain_picture(const std::string& name, u8vec3 color) {
    static const fs::path folder = fresh_folder("plain_pictures");
    write_image(folder / name, Image<u8vec3>({4, 4}, color));
    return (folder / name).string();
}

}  // namespace

TEST(NormalMaps, HardCase_NoFrameWithoutAMap) {
    look_up("Eq. 8.6");
    const std::string norm = "norm " + textures + "brick_normal.png\n";
    const std::string bump = "map_Bump -bm 0.01 " + textures + "brick_height.png\n";
    const std::string two_groups =
        "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "g first\nusemtl m\nf 1/1 2/2 3/3\ng second\nusemtl plain\nf 1/1 3/3 4/4\n";
    for (const auto& [name, scene, has_maps] :
         {std::tuple{"scene", loaded("scene.obj"), false},
          {"scene_bumpy", loaded("scene_bumpy.obj"), true},
          {"norm", square_of(norm), true},
          {"norm of one group", square_of(norm + "newmtl plain\n", two_groups), true},
          {"bump", square_of(bump), true},
          {"unlit norm", square_of("illum 0\n" + norm), false},
          {"unlit bump", square_of("illum 0\n" + bump), false},
          {"diffuse norm", square_of("illum 1\n" + norm), true}}) {
        lab_08::Options options = small_picture();
        for (const FrameOf frame : all_frames) {
            options.method.frame = frame;
            const NormalMapAssets assets = lab_08::load(scene, options);
            for (const Mesh& mesh : assets.scene.meshes) {
                const bool calls_for_one =
                    assets.normal_maps.textures[mesh.triangles[0].material] != nullptr;
                EXPECT_EQ(mesh.tangents.empty(), !calls_for_one || frame != FrameOf::vertex)
                    << name << ", mesh " << mesh.name;
            }
            const Drawn with = drawn_scene(scene, options);
            EXPECT_EQ(with.count(Counter::normal_map_samples) > 0, has_maps) << name;
            EXPECT_EQ(with.count(Counter::meshes_with_tangents) > 0,
                      has_maps && frame == FrameOf::vertex)
                << name;
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

TEST(NormalMaps, HardCase_EffectsThatAreNotCalledForWouldChangeNothing) {
    look_up("Robust: A flat map changes nothing");
    for (const char* model : {"scene.obj", "scene_bumpy.obj", "crate_bump.obj"}) {
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
    const std::string right = plain_picture("right.png", {213, 128, 222}),
                      up = plain_picture("up.png", {128, 213, 222});
    for (const auto& [map, space, green, normal] :
         {std::tuple{right, MapSpace::tangent, Green::up, vec3(s, o, c)},
          {up, MapSpace::tangent, Green::up, vec3(o, s, c)},
          {up, MapSpace::tangent, Green::down, vec3(o, -s, c)},
          {"-s -1 1 1 " + right, MapSpace::tangent, Green::up, vec3(-s, o, c)},
          {"-bm 2 " + right, MapSpace::tangent, Green::up, vec3(2 * s, 2 * o, c)},
          {up, MapSpace::object, Green::up, vec3(o, s, c)}}) {
        std::ostringstream slanted;
        slanted << "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvn " << normal.x << ' '
                << normal.y << ' ' << normal.z << "\nusemtl m\nf 1//1 2//1 3//1 4//1\n";
        for (const LightKind kind : {LightKind::directional, LightKind::point})
            for (const FrameOf frame : all_frames) {
                lab_08::Options options = before_the_square();
                options.shading.key_light = kind;
                options.method.frame = frame;
                options.normal_map.space = space, options.normal_map.green = green;
                EXPECT_EQ(share_that_differs(picture_of(square_of("norm " + map + "\n"), options),
                                             picture_of(square_of("", slanted.str()), options)),
                          0)
                    << "of the pixels of a square with `norm " << map
                    << "`, beside one with the normal " << shown(normal);
            }
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
    options.shading.two_sided = true;
    for (const float pitch : {30.0f, -30.0f}) {  // from below it is the other side
        options.orbit.pitch_degrees = pitch;
        const Drawn with = drawn_scene(square_of(flat, floor), options);
        const Image<vec3> plain = picture_of(square_of("", floor), options);
        EXPECT_EQ(share_that_differs(with.picture, plain), 0) << "with --pitch " << pitch;
        EXPECT_EQ(with.count(Counter::meshes_with_tangents), 0u);
    }
    // -bm scales in the tangent frame: it does not count here.
    const std::string slanted = plain_picture("slanted_up.png", {190, 230, 128}) + "\n";
    options.orbit.pitch_degrees = 30;
    EXPECT_TRUE(are_equal(picture_of(square_of("norm -bm 3 " + slanted, floor), options),
                          picture_of(square_of("norm " + slanted, floor), options)));
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
            const dvec2 d1 = uv(1) - uv(0), d2 = uv(2) - uv(0);
            if (d1.x * d2.y > d2.x * d1.y) continue;
            ++changed;
            for (Vertex& vertex : triangle.vertices) {
                const dvec2 of_other_half = mesh.uvs[vertex.uv];
                vertex.uv = static_cast<std::uint32_t>(mesh.uvs.size());
                mesh.uvs.emplace_back(of_other_half.x, 1 - of_other_half.y);
            }
        }
    ASSERT_GT(changed, 100);
    for (const FrameOf frame : all_frames) {
        lab_08::Options options = small_picture();
        options.size = {320, 180};
        options.orbit.distance = 2.7f;
        options.method.frame = frame;
        EXPECT_LT(share_that_differs(picture_of(mirrored, options), picture_of(whole, options), 2),
                  0.0004)
            << "of the pixels differ, one half of the shield mirrored in the texture or not";
    }
}

TEST(NormalMaps, HardCase_NormalsOrHeightsInMapBump) {
    look_up("Eq. 8.9");
    const lab_08::Options options = before_the_square();
    const std::string normals = textures + "brick_normal.png\n";
    const std::string heights = "map_Bump -bm 0.014 " + textures + "brick_height.png\n";
    const Image<vec3> as_norm = picture_of(square_of("norm " + normals), options);
    // Coloured pictures are normals; `norm` counts more; keywords in any case.
    for (const std::string& same : {"map_Bump " + normals, "bump " + normals,
                                    "norm " + normals + heights, heights + "norm " + normals})
        EXPECT_TRUE(are_equal(picture_of(square_of(same), options), as_norm)) << same;
    const Image<vec3> as_heights = picture_of(square_of(heights), options);
    EXPECT_FALSE(are_equal(as_heights, as_norm)) << "heights are read as if they were normals";
    EXPECT_FALSE(are_equal(as_heights, picture_of(square_of(""), options)))
        << "heights change nothing";
}

TEST(NormalMaps, HardCase_MissingAndBrokenMaps) {
    look_up("Eq. 8.9");
    const fs::path folder = fresh_folder("broken_normal_map"), out = folder / "out.png";
    const fs::path model = written(folder / "m.obj", square);
    written(folder / "broken.png", "\x89PNG and no more");
    const auto drawn_with = [&](std::vector<std::string> more) {
        more.insert(more.end(),
                    {"--model", model.string(), "--size", "64x36", "--out", out.string()});
        return run_program("08_normal_maps", more);
    };
    for (const std::string statement : {"norm", "map_Bump"})
        for (const std::string name : {"missing.png", "broken.png"}) {
            written(folder / "m.mtl", "newmtl m\n\n" + statement + " " + name + "\n");
            const std::string where = (folder / "m.mtl").string() + ":3: " + statement + ": ";
            const ProcessResult result = drawn_with({});
            expect_error(result, 1, where);
            EXPECT_NE(result.err.find(name), std::string::npos) << result.err;
            EXPECT_FALSE(fs::exists(out));

            const ProcessResult replaced = drawn_with({"--keep-going"});
            EXPECT_EQ(replaced.exit_status, 0) << replaced.err;
            EXPECT_TRUE(replaced.err.starts_with("warning: " + where)) << replaced.err;
            EXPECT_TRUE(fs::remove(out));
            // What is not called for is not read.
            EXPECT_EQ(drawn_with({"--normal-map", "none"}).exit_status, 0);
            written(folder / "m.mtl", "newmtl m\nillum 0\n" + statement + " " + name + "\n");
            EXPECT_EQ(drawn_with({}).exit_status, 0);
            EXPECT_TRUE(fs::remove(out));
        }
}

TEST(NormalMaps, HardCase_DegenerateUvs) {
    look_up("Robust: Where no tangent is left");
    const std::string map = "Ks 1 1 1\nNs 5\nnorm -bm 1e37 " + textures + "hammered_normal.png\n";
    const std::string begin = square.substr(0, square.find("vt")) + "usemtl m\n";
    for (const std::string mesh : {"f 1 2 3 4\n", "vt 0 0\nf 1/1 2/1 3/1 4/1\n",
                                   "vt 3e38 -3e38\nvt -3e38 0\nvt 1 3e38\nf 1/1 2/2 3/3 4/1\n"})
        for (const FrameOf frame : all_frames) {
            lab_08::Options options = before_the_square();
            options.method.frame = frame;
            const Image<vec3> picture = picture_of(square_of(map, begin + mesh), options);
            EXPECT_TRUE(all_are_finite(picture)) << mesh;
            EXPECT_FALSE(is_backdrop(picture)) << mesh;
        }
}

TEST(NormalMaps, HardCase_ModelsOfAllSizes) {
    look_up("Eq. 8.3");
    const Scene scene = loaded("scene_bumpy.obj");
    lab_08::Options options = small_picture();
    for (const FrameOf frame : all_frames) {
        options.method.frame = frame;
        const Image<vec3> expected = picture_of(scene, options);
        for (const float factor : {0x1p-100f, 0x1p120f}) {
            Scene other = scene;
            for (Mesh& mesh : other.meshes) {
                mesh.bounds = {};
                for (vec3& position : mesh.positions) position *= factor, mesh.bounds.add(position);
            }
            const Image<vec3> picture = picture_of(other, options);
            EXPECT_TRUE(all_are_finite(picture)) << "of a scene times " << factor;
            EXPECT_EQ(share_that_differs(expected, picture), 0) << "of a scene times " << factor;
        }
    }
}

TEST(NormalMaps, HardCase_UvsMovedByWholeNumbersLookTheSame) {
    look_up("Eq. 8.3");
    const std::string folder = fresh_folder("far_uvs").string() + "/";
    std::mt19937 random(5);
    for (const char* name : {"a.png", "b.png", "c.png", "n.png"}) {
        Image<u8vec3> noise({16, 16});
        for (u8vec3& texel : noise.pixels())
            texel = {random() % 256, random() % 256, name[0] == 'n' ? 255 : random() % 256};
        write_image(folder + name, noise);
    }
    for (const std::string options : {"", "-s 3 2 1 -o 0.3 -0.7 0 "}) {
        Scene scene = square_of("Ks 0.5 0.5 0.5\nNs 9\nKe 0.2 0.2 0.2\nmap_Kd " + options + folder +
                                "a.png\nmap_Ks " + options + folder + "b.png\nmap_Ke " + options +
                                folder + "c.png\nnorm " + options + folder + "n.png\n");
        for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp})
            for (const Filter filter : {Filter::nearest, Filter::trilinear}) {
                lab_08::Options with = before_the_square();
                with.texture.wrap = wrap, with.texture.filter = filter;
                const auto picture = [&](ivec2 moved) {
                    const ivec2 thousandths[] = {
                        {-117, 341}, {1283, -259}, {1502, 1118}, {93, 946}};
                    for (std::size_t i = 0; i < 4; ++i)
                        scene.meshes[0].uvs[i] = dvec2(thousandths[i] + 1000 * moved) / 1000.0;
                    return picture_of(scene, with);
                };
                const Image<vec3> near = picture({0, 0});
                for (const ivec2 moved :
                     {ivec2(2, -2), ivec2(-4, 100), ivec2(65536, 65536), ivec2(30'000, -60'002)})
                    EXPECT_EQ(have_the_same_bits(picture(moved), near), wrap != Wrap::clamp)
                        << "moved by " << testing::PrintToString(moved) << "; wrap "
                        << static_cast<int>(wrap) << ", filter " << static_cast<int>(filter) << ' '
                        << options;
                EXPECT_EQ(have_the_same_bits(picture({1, -65535}), near), wrap == Wrap::repeat)
                    << "moved by an odd number";
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
