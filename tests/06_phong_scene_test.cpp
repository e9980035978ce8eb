// SPDX-License-Identifier: MIT
// What materials call for, files with mistakes, scenes of all sizes, and the lesson's pictures.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/app/counters.hpp"
#include "common/image/backdrop.hpp"
#include "common/image/image_io.hpp"
#include "common/math/color.hpp"
#include "common/model/obj.hpp"
#include "lab/shading_methods.hpp"
#include "support/first_difference.hpp"
#include "support/golden.hpp"
#include "support/lesson_06.hpp"
#include "support/lesson_process.hpp"
#include "support/light_in_words.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/picture_difference.hpp"
#include "support/pictures.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;
namespace fs = std::filesystem;

namespace {

lesson_06::Options small_picture() {
    lesson_06::Options options;
    options.size = {320, 180};
    return options;
}

/// The image before it is written, linear.
Image<vec3> picture_of(const Scene& scene, const lesson_06::Options& options) {
    return lesson_06::render(options, lesson_06::make_assets(scene, options));
}

Drawn drawn_of(const PhongAssets& assets, const lesson_06::Options& options) {
    return drawn(options, assets,
                 [](auto&... arguments) { return lesson_06::render(arguments...); });
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

Scene square_of(const std::string& material) {
    const fs::path folder = fresh_folder("square");
    written(folder / "m.mtl", "newmtl m\n" + material);
    return load_obj(written(folder / "m.obj", square));
}

/// Looks at the square from the front, and a little from the side.
lesson_06::Options before_the_square() {
    lesson_06::Options options = small_picture();
    options.size = {160, 90};
    options.orbit.yaw_degrees = -20;
    return options;
}

/// Three squares side by side, of illum 0, 1 and 2, each with a diffuse and a highlight's colour.
Scene squares_of_illum_0_1_2(const std::string& before, const std::string& after) {
    const fs::path folder = fresh_folder("illum");
    std::string mtl, obj = "mtllib m.mtl\n";
    for (int i = 0; i < 3; ++i) {
        mtl += "newmtl m" + std::to_string(i) + "\nKd 0.3 0.5 0.7\nKs 1 0.5 0.25\nNs 3\n" +
               "Ke 0.01 0.02 0.03\n" + before + "illum " + std::to_string(i) + "\n" + after;
        for (const auto& [x, y] : {std::pair{0, 0}, {2, 0}, {2, 2}, {0, 2}})
            obj += "v " + std::to_string(3 * i + x) + " " + std::to_string(y) + " 0\n";
        obj += "usemtl m" + std::to_string(i) + "\nf -4 -3 -2 -1\n";
    }
    written(folder / "m.mtl", mtl);
    return load_obj(written(folder / "m.obj", obj));
}

/// The picture's brightest pixel, by the sum of its colours.
float brightest(const Image<vec3>& picture) {
    float most = 0;
    for (const vec3 c : picture.pixels()) most = std::max(most, c.x + c.y + c.z);
    return most;
}

}  // namespace

TEST(Phong, HardCase_OnlyWhatMaterialsCallForIsComputed) {
    look_up("Eq. 6.5");
    const std::string map_of_highlights =
        "Ks 1 1 1\nmap_Ks " + std::string(RASTERBOOK_ASSETS "/textures/brick_specular.png") + "\n";
    struct Row {
        std::string what;
        Scene scene;
        bool has_light, has_highlights, has_textures;
    };
    const auto of_file = [](const char* file, bool light, bool highlights, bool textures) {
        return Row{file, loaded(file), light, highlights, textures};
    };
    const auto of_square = [](const std::string& mtl, bool light, bool highlights, bool textures) {
        return Row{"a square of: " + mtl, square_of(mtl), light, highlights, textures};
    };
    for (const auto& [what, scene, has_light, has_highlights, has_textures] :
         {of_file("scene.obj", true, true, true), of_file("crate.obj", true, false, true),
          of_file("teapot.obj", true, true, false),
          of_square("illum 0\nKs 1 1 1\n", false, false, false),
          of_square("illum 1\nKs 1 1 1\n", true, false, false),
          of_square("illum 2\nKs 1 1 1\n", true, true, false),
          of_square("illum 2\nKs 0 0 0\n", true, false, false),
          of_square("illum 0\n" + map_of_highlights, false, false, false),
          of_square("illum 1\n" + map_of_highlights, true, false, false),
          of_square("illum 2\n" + map_of_highlights, true, true, true),
          of_square(map_of_highlights + "Ks 0 0 0\n", true, false, false),
          of_square("illum 2\nKs 0 0 1e-30\n", true, true, false)}) {
        lesson_06::Options options = small_picture();
        options.size /= 2;
        const PhongAssets as_called_for = lesson_06::make_assets(scene, options);
        options.shading.all_effects = true;
        const PhongAssets with_all = lesson_06::make_assets(scene, options);
        const Drawn usual = drawn_of(as_called_for, options);
        const auto shaded = usual.count(Counter::fragments_shaded);
        const std::string& where = what;
        ASSERT_GT(shaded, 1000u) << where;
        ASSERT_EQ(usual.count(Counter::fragments_lit), has_light ? shaded : 0) << where;
        ASSERT_EQ(usual.count(Counter::highlights) > 0, has_highlights) << where;
        ASSERT_LE(usual.count(Counter::highlights), shaded) << where;
        ASSERT_EQ(usual.count(Counter::texture_samples) > 0, has_textures) << where;
        ASSERT_LE(usual.count(Counter::texture_samples), shaded) << where;

        const Drawn all = drawn_of(with_all, options);
        ASSERT_EQ(all.count(Counter::fragments_lit), has_light ? shaded : 0)
            << "--all-effects, " << where;
        ASSERT_EQ(all.count(Counter::highlights), has_light ? shaded : 0)
            << "--all-effects, " << where;
        ASSERT_EQ(all.count(Counter::texture_samples), has_light ? 3 * shaded : 2 * shaded)
            << "--all-effects, " << where;
    }
}

TEST(Phong, HardCase_EffectsThatAreNotCalledForWouldChangeNothing) {
    look_up("Eq. 6.5");
    const std::vector<std::pair<const char*, Scene>> scenes = {
        {"scene", loaded("scene.obj")},
        {"crate", loaded("crate.obj")},
        {"teapot", loaded("teapot.obj")},
        {"scene_bumpy", loaded("scene_bumpy.obj")},
        {"illum", squares_of_illum_0_1_2("", "")}};
    for (const auto& [name, scene] : scenes) {
        lesson_06::Options options = small_picture();
        const PhongAssets as_called_for = lesson_06::make_assets(scene, options);
        options.shading.all_effects = true;
        const PhongAssets with_all = lesson_06::make_assets(scene, options);
        const Image<vec3> picture = lesson_06::render(options, as_called_for);
        ASSERT_TRUE(are_the_same_bits(picture, lesson_06::render(options, with_all))) << name;
        EXPECT_FALSE(is_backdrop(picture)) << name;
    }
}

TEST(Phong, HardCase_IllumDecides) {
    look_up("Eq. 6.5");
    const std::string plain = "Kd 0.3 0.5 0.7\nKe 0.01 0.02 0.03\n";
    const auto picture = [&](const std::string& material) {
        return picture_of(square_of(material), before_the_square());
    };
    const Image<vec3> lit = picture(plain + "illum 1\n");
    // 0: the colour alone, all over the square.
    const Image<vec3> unlit = picture(plain + "Ks 1 1 1\nillum 0\n");
    const vec3 middle = unlit[{80, 45}];
    EXPECT_EQ(middle, vec3(0.3f, 0.5f, 0.7f) + vec3(0.01f, 0.02f, 0.03f));
    const Image<vec3> empty = backdrop(unlit.size());
    for (ivec2 p(0); p.y < unlit.size().y; ++p.y)
        for (p.x = 0; p.x < unlit.size().x; ++p.x)
            ASSERT_TRUE(unlit[p] == middle || unlit[p] == empty[p])
                << "illum 0: pixel " << testing::PrintToString(p) << " is " << shown(unlit[p])
                << " instead of Ke + Kd, " << shown(middle) << ", or the backdrop";
    // 1: no highlight, whatever Ks. 2, and no word, and all above: with one.
    EXPECT_TRUE(are_equal(picture(plain + "Ks 1 1 1\nillum 1\n"), lit)) << "illum 1";
    EXPECT_TRUE(are_equal(picture(plain + "Ks 0 0 0\nillum 2\n"), lit)) << "Ks 0, illum 2";
    const Image<vec3> shining = picture(plain + "Ks 1 1 1\nillum 2\n");
    EXPECT_GT(brightest(shining), brightest(lit) + 0.1f);
    for (const char* illum : {"", "illum 3\n", "illum 10\n"})
        EXPECT_TRUE(are_equal(picture(plain + "Ks 1 1 1\n" + illum), shining)) << illum;
}

TEST(Phong, HardCase_AmbientOfOneAsExportersWriteIt) {
    look_up("Eq. 6.5");
    for (const char* model : {"scene.obj", "teapot.obj"}) {
        Scene scene = loaded(model);
        for (Material& material : scene.materials) material.ambient = material.diffuse;
        const Image<vec3> as_diffuse = picture_of(scene, small_picture());
        for (Material& material : scene.materials) material.ambient = vec3(1);
        EXPECT_TRUE(are_equal(picture_of(scene, small_picture()), as_diffuse))
            << model << " with Ka = 1, and with Ka = Kd";
        for (Material& material : scene.materials) material.ambient = vec3(0);
        EXPECT_FALSE(are_equal(picture_of(scene, small_picture()), as_diffuse))
            << model << " with Ka = 0, and with Ka = Kd";
    }
}

TEST(Phong, HardCase_SpecularMapsArePlainNumbers) {
    look_up("Eq. 6.5");
    const fs::path folder = fresh_folder("specular_map");
    write_image(folder / "gray.png", Image<u8vec3>({4, 4}, {188, 94, 47}));
    written(folder / "m.obj", square);
    const auto picture = [&](const std::string& material) {
        written(folder / "m.mtl", "newmtl m\nKd 0.2 0.2 0.2\nNs 2\n" + material);
        Scene scene = load_obj(folder / "m.obj");
        if (scene.materials.back().specular_map.file.empty())
            scene.materials.back().specular *= vec3(188, 94, 47) / 255.0f;
        return picture_of(scene, before_the_square());
    };
    EXPECT_TRUE(are_equal(picture("Ks 1 1 1\nmap_Ks gray.png\n"), picture("Ks 1 1 1\n")))
        << "a gray map_Ks, and its numbers over 255 in Ks";
    EXPECT_TRUE(
        are_equal(picture("Ks 0.5 0.5 0.5\nmap_Ks gray.png\n"), picture("Ks 0.5 0.5 0.5\n")))
        << "a gray map_Ks, and its numbers over 255 in Ks";
    EXPECT_TRUE(are_equal(picture("Ks 0 0 0\nmap_Ks gray.png\n"), picture("Ks 0 0 0\n")))
        << "a gray map_Ks, and its numbers over 255 in Ks";
    EXPECT_FALSE(are_equal(picture("Ks 1 1 1\nmap_Ks gray.png\n"), picture("Ks 0.5 0.5 0.5\n")))
        << "Ks counts beside map_Ks";
    // It lies as its own -s and -o say, and it leaves the diffuse colour alone.
    Image<u8vec3> halves({2, 1}, {255, 255, 255});
    halves[{1, 0}] = {0, 0, 0};
    write_image(folder / "halves.png", halves);
    const Image<vec3> dull = picture("Ks 0 0 0\n");
    EXPECT_TRUE(are_equal(
        picture("Ks 1 1 1\nmap_Ks -clamp on -s 0.001 1 1 -o 0.99 0 0 halves.png\n"), dull))
        << "where the map is black";
    EXPECT_FALSE(are_equal(
        picture("Ks 1 1 1\nmap_Ks -clamp on -s 0.001 1 1 -o 0.01 0 0 halves.png\n"), dull))
        << "where the map is white";
}

TEST(Phong, HardCase_EmissionMapsAreDecodedAndTimesKe) {
    look_up("Eq. 6.5");
    const fs::path folder = fresh_folder("emission_map");
    write_image(folder / "gray.png", Image<u8vec3>({4, 4}, {188, 255, 0}));
    Image<u8vec3> halves({2, 1}, {255, 255, 255});
    halves[{1, 0}] = {0, 0, 0};
    write_image(folder / "halves.png", halves);
    written(folder / "m.obj", square);
    const auto picture = [&](const std::string& material, vec3 factor) {
        written(folder / "m.mtl", "newmtl m\nKd 0.2 0.2 0.2\n" + material);
        Scene scene = load_obj(folder / "m.obj");
        scene.materials.back().emission *= factor;
        return picture_of(scene, before_the_square());
    };
    const vec3 light(linear_from_srgb(188 / 255.0f), 1, 0);
    for (const auto& [of_file, same, factor] :
         {std::tuple{"Ke 1 2 3\nmap_Ke gray.png\n", "Ke 1 2 3\n", light},
          {"map_Ke gray.png\nKe 1 2 3\n", "Ke 1 2 3\n", light},
          {"map_Ke gray.png\n", "Ke 1 1 1\n", light},
          {"Ke 0 0 0\nmap_Ke gray.png\n", "Ke 1 1 1\n", light},  // exporters write it so
          {"Ke 2 0 0\nmap_Ke halves.png\nmap_Ke\n", "Ke 2 0 0\n", vec3(1)},
          {"Ke 2 1 1\nmap_Ke -clamp on -s 0.001 1 1 -o 0.01 0 0 halves.png\n", "Ke 2 1 1\n",
           vec3(1)},
          {"Ke 2 1 1\nmap_Ke -clamp on -s 0.001 1 1 -o 0.99 0 0 halves.png\n", "", vec3(1)}})
        for (const char* illumination : {"illum 0\n", "illum 1\n", "illum 2\nKs 1 1 1\n"})
            EXPECT_TRUE(are_equal(picture(std::string(of_file) + illumination, vec3(1)),
                                  picture(std::string(same) + illumination, factor)))
                << of_file << illumination << "and " << same << "times " << shown(factor);
}

TEST(Phong, HardCase_MissingAndBrokenSpecularMaps) {
    look_up("Eq. 6.5");
    const fs::path folder = fresh_folder("broken_map"), out = folder / "out.png";
    const fs::path model = written(folder / "m.obj", square);
    written(folder / "broken.png", "\x89PNG and no more");
    for (const char* name : {"missing.png", "broken.png"}) {
        written(folder / "m.mtl", std::string("newmtl m\nKs 1 1 1\n\nmap_Ks ") + name + "\n");
        const std::vector<std::string> arguments = {"--model", model.string(), "--size",
                                                    "64x36",   "--out",        out.string()};
        const ProcessResult result = run_program("06_phong", arguments);
        EXPECT_EQ(result.exit_status, 1);
        EXPECT_EQ(result.err.rfind("error: " + (folder / "m.mtl").string() + ":4: map_Ks: ", 0), 0u)
            << result.err;
        EXPECT_NE(result.err.find(name), std::string::npos) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_FALSE(fs::exists(out));

        std::vector<std::string> keep_going = arguments;
        keep_going.push_back("--keep-going");
        const ProcessResult replaced = run_program("06_phong", keep_going);
        EXPECT_EQ(replaced.exit_status, 0) << replaced.err;
        EXPECT_EQ(replaced.err.rfind("warning: " + (folder / "m.mtl").string() + ":4: map_Ks: ", 0),
                  0u)
            << replaced.err;
        EXPECT_TRUE(fs::remove(out));
    }
}

TEST(Phong, HardCase_SpecularMapsWithoutHighlightAreNotRead) {
    look_up("Eq. 6.5, what is left out");
    const fs::path folder = fresh_folder("unread_map"), out = folder / "out.png";
    const fs::path model = written(folder / "m.obj", square);
    for (const char* material : {"Ks 0 0 0\n", "Ks 1 1 1\nillum 1\n", "Ks 1 1 1\nillum 0\n"}) {
        written(folder / "m.mtl", std::string("newmtl m\n") + material + "map_Ks missing.png\n");
        const ProcessResult result = run_program(
            "06_phong", {"--model", model.string(), "--size", "64x36", "--out", out.string()});
        EXPECT_EQ(result.exit_status, 0) << material;
        EXPECT_EQ(result.err, "") << material;
    }
}

TEST(Phong, HardCase_BacksOfFaces) {
    look_up("Eq. 6.8");
    // A square from behind looks as one that is named the other way round from the front.
    Scene scene = square_of("Kd 0.8 0.6 0.4\nKs 0.5 0.5 0.5\nNs 20\n"), turned = scene;
    Mesh& mesh = turned.meshes[0];
    for (Triangle& triangle : mesh.triangles) std::swap(triangle.vertices[1], triangle.vertices[2]);
    lesson_06::Options options = before_the_square();
    options.orbit.yaw_degrees = -150;
    EXPECT_TRUE(is_backdrop(picture_of(scene, options)));
    for (const LightKind kind : {LightKind::directional, LightKind::point, LightKind::spot}) {
        options.shading.key_light = kind;
        options.shading.two_sided = false;
        const Image<vec3> front = picture_of(turned, options);
        options.shading.two_sided = true;
        const Image<vec3> back = picture_of(scene, options);
        EXPECT_GT(brightest(back), 0.2f);
        ASSERT_EQ(share_that_differs(back, front), 0) << name_of(kind) << ": the share of pixels";
        // The front of what has two sides is as before.
        ASSERT_TRUE(are_equal(picture_of(turned, options), front))
            << name_of(kind) << ", --two-sided";
    }
}

TEST(Phong, HardCase_MoreLightThanAFileHolds) {
    look_up("Eq. 6.5");
    for (const auto& [material, least] : {std::pair{"Kd 9 9 9\nKs 9 9 9\nKe 9 9 9\n", 27.0f},
                                          {"Kd 1e37 0 0\nKs 0 1e37 0\n", 1e36f},
                                          {"Kd 1 1 1\nKs 1 1 1\nNs 1e38\n", 0.1f}}) {
        const Image<vec3> picture = picture_of(square_of(material), before_the_square());
        EXPECT_TRUE(is_finite(picture)) << material;
        EXPECT_GT(brightest(picture), least) << material;
    }
    const Image<vec3> bright = picture_of(square_of("Ke 9 9 9\n"), before_the_square());
    EXPECT_EQ(srgb8_from_linear(bright)[ivec2(80, 45)], u8vec3(255));
}

TEST(Phong, HardCase_ModelsOfAllSizes) {
    look_up("Eq. 6.6");
    const Scene scene = loaded("teapot.obj");
    const auto scaled = [&](float factor) {
        Scene other = scene;
        for (Mesh& mesh : other.meshes) {
            mesh.bounds = {};
            for (vec3& position : mesh.positions) position *= factor, mesh.bounds.add(position);
        }
        return other;
    };
    for (const LightKind kind : {LightKind::directional, LightKind::point, LightKind::spot}) {
        lesson_06::Options options = small_picture();
        options.size = {160, 90};
        options.shading.key_light = kind;
        const Image<vec3> expected = picture_of(scene, options);
        EXPECT_TRUE(is_finite(expected));
        // Powers of two scale exactly; roots are taken another way for small and great squares.
        for (const float factor : {0x1p-100f, 0x1p-40f, 0x1p60f, 0x1p120f}) {
            const Image<vec3> picture = picture_of(scaled(factor), options);
            ASSERT_TRUE(is_finite(picture)) << factor;
            ASSERT_EQ(share_that_differs(expected, picture), 0)
                << "the share of pixels; the teapot " << factor << " times as large, "
                << name_of(kind);
        }
        // Others round each position: some pixel's centre changes sides, or its light's.
        for (const float factor : {1e-30f, 1e-10f, 1e10f, 1e36f}) {
            const Image<vec3> picture = picture_of(scaled(factor), options);
            ASSERT_TRUE(is_finite(picture)) << factor;
            ASSERT_LT(share_that_differs(expected, picture), 0.005)
                << "the share of pixels; the teapot " << factor << " times as large, "
                << name_of(kind);
        }
    }
}

TEST(Phong, HardCase_NormalsOfTheFileAreTurnedToLengthOne) {
    look_up("Eq. 6.9");
    Scene scene = loaded("teapot.obj");
    const Image<vec3> expected = picture_of(scene, small_picture());
    for (Mesh& mesh : scene.meshes)
        for (std::size_t i = 0; i < mesh.normals.size(); ++i)
            mesh.normals[i] *= i % 2 ? 0x1p-80f : 0x1p100f;
    EXPECT_TRUE(are_equal(picture_of(scene, small_picture()), expected))
        << "with normals of other lengths in the file";
}

TEST(Phong, PictureOfTheScene) { EXPECT_TRUE(equals_golden("06_phong", "06_phong")); }

TEST(Phong, PictureOfFlatShading) {
    EXPECT_TRUE(equals_golden("lab_06_phong", "06_phong_flat", {"--shading", "flat"}));
}

TEST(Phong, PictureOfGouraudShading) {
    EXPECT_TRUE(equals_golden("lab_06_phong", "06_phong_gouraud", {"--shading", "gouraud"}));
}

TEST(Phong, PictureOfBlinnsHighlights) {
    EXPECT_TRUE(equals_golden("lab_06_phong", "06_phong_blinn", {"--highlight", "blinn"}));
}

TEST(Phong, PictureOfASpot) {
    EXPECT_TRUE(equals_golden("06_phong", "06_phong_spot", {"--light", "spot"}));
}
