// SPDX-License-Identifier: MIT
// What materials call for, files with mistakes, scenes of all sizes, and the lesson's pictures.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

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

Drawn drawn_of(const Scene& scene, const lesson_06::Options& options) {
    return drawn(options, lesson_06::make_assets(scene, options),
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
        std::string what;  ///< A model, or the material of a square.
        bool has_light, has_highlights, has_textures;
    };
    for (const auto& [what, has_light, has_highlights, has_textures] :
         {Row{"scene.obj", true, true, true}, Row{"crate.obj", true, false, true},
          Row{"teapot.obj", true, true, false}, Row{"scene_bumpy.obj", true, true, true},
          Row{"illum 0\nKs 1 1 1\n", false, false, false},
          Row{"illum 1\nKs 1 1 1\n", true, false, false},
          Row{"illum 2\nKs 1 1 1\n", true, true, false},
          Row{"illum 2\nKs 0 0 0\n", true, false, false},
          Row{"illum 0\n" + map_of_highlights, false, false, false},
          Row{"illum 1\n" + map_of_highlights, true, false, false},
          Row{"illum 2\n" + map_of_highlights, true, true, true},
          Row{map_of_highlights + "Ks 0 0 0\n", true, false, false},
          Row{"illum 2\nKs 0 0 1e-30\n", true, true, false}}) {
        SCOPED_TRACE(what);
        const Scene scene = what.ends_with(".obj") ? loaded(what) : square_of(what);
        lesson_06::Options options = small_picture();
        options.size /= 2;
        const Drawn usual = drawn_of(scene, options);
        const auto shaded = usual.count(Counter::fragments_shaded);
        ASSERT_GT(shaded, 1000u);
        ASSERT_EQ(usual.count(Counter::fragments_lit), has_light ? shaded : 0);
        ASSERT_EQ(usual.count(Counter::highlights) > 0, has_highlights);
        ASSERT_LE(usual.count(Counter::highlights), shaded);
        ASSERT_EQ(usual.count(Counter::texture_samples) > 0, has_textures);

        options.shading.all_effects = true;
        const Drawn all = drawn_of(scene, options);
        ASSERT_EQ(all.count(Counter::fragments_lit), has_light ? shaded : 0) << "--all-effects";
        ASSERT_EQ(all.count(Counter::highlights), has_light ? shaded : 0) << "--all-effects";
        ASSERT_EQ(all.count(Counter::texture_samples), has_light ? 3 * shaded : 2 * shaded)
            << "--all-effects";
        EXPECT_TRUE(have_the_same_bits(all.picture, usual.picture)) << "--all-effects";
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
    for (ivec2 p(0, unlit.size().y / 2); p.x < unlit.size().x; ++p.x)
        ASSERT_TRUE(unlit[p] == middle || unlit[p] == empty[p])
            << "illum 0: pixel " << testing::PrintToString(p) << " is " << shown(unlit[p])
            << " instead of Ke + Kd, " << shown(middle) << ", or the backdrop";
    // 1: no highlight, whatever Ks. 2, and no word, and all above: with one.
    EXPECT_TRUE(are_equal(picture(plain + "Ks 1 1 1\nillum 1\n"), lit)) << "illum 1";
    EXPECT_TRUE(are_equal(picture(plain + "Ks 0 0 0\nillum 2\n"), lit)) << "Ks 0, illum 2";
    const Image<vec3> shining = picture(plain + "Ks 1 1 1\nillum 2\n");
    EXPECT_GT(brightest(shining), brightest(lit) + 0.1f);
    for (const char* illum : {"", "illum 10\n"})
        EXPECT_TRUE(are_equal(picture(plain + "Ks 1 1 1\n" + illum), shining)) << illum;
}

TEST(Phong, HardCase_AmbientOfOneAsExportersWriteIt) {
    look_up("Eq. 6.5");
    const auto with_ambient = [](const auto& ambient_of) {
        Scene scene = loaded("scene.obj");
        for (Material& material : scene.materials) material.ambient = ambient_of(material);
        return picture_of(scene, small_picture());
    };
    const Image<vec3> as_diffuse = with_ambient([](const Material& m) { return m.diffuse; });
    EXPECT_TRUE(are_equal(with_ambient([](const Material&) { return vec3(1); }), as_diffuse))
        << "with Ka = 1, and with Ka = Kd";
    EXPECT_FALSE(are_equal(with_ambient([](const Material&) { return vec3(0); }), as_diffuse))
        << "with Ka = 0, and with Ka = Kd";
}

TEST(Phong, HardCase_SpecularMapsArePlainNumbersAndEmissionMapsAreDecoded) {
    look_up("Eq. 6.5");
    const fs::path folder = fresh_folder("maps");
    write_image(folder / "gray.png", Image<u8vec3>({4, 4}, {188, 255, 0}));
    Image<u8vec3> halves({2, 1}, {255, 255, 255});
    halves[{1, 0}] = {0, 0, 0};
    write_image(folder / "halves.png", halves);
    written(folder / "m.obj", square);
    const auto picture = [&](const std::string& material, vec3 specular, vec3 emission) {
        written(folder / "m.mtl", "newmtl m\nKd 0.2 0.2 0.2\nNs 2\n" + material);
        Scene scene = load_obj(folder / "m.obj");
        scene.materials.back().specular *= specular;
        scene.materials.back().emission *= emission;
        return picture_of(scene, before_the_square());
    };
    const vec3 all(1), plain(188 / 255.0f, 1, 0), light(linear_from_srgb(188 / 255.0f), 1, 0);
    const std::string white_half = "-clamp on -s 0.001 1 1 -o 0.01 0 0 halves.png\n",
                      black_half = "-clamp on -s 0.001 1 1 -o 0.99 0 0 halves.png\n";
    struct Row {
        std::string with_map, without;
        vec3 specular, emission;  ///< What the colours without a map are multiplied by.
    };
    for (const auto& [with_map, without, specular, emission] :
         {Row{"Ks 1 1 1\nmap_Ks gray.png\n", "Ks 1 1 1\n", plain, all},
          Row{"Ks 0.5 0.5 0.5\nmap_Ks gray.png\n", "Ks 0.5 0.5 0.5\n", plain, all},
          Row{"Ks 1 1 1\nmap_Ks " + white_half, "Ks 1 1 1\n", all, all},
          Row{"Ks 1 1 1\nmap_Ks " + black_half, "Ks 0 0 0\n", all, all},
          Row{"Ke 1 2 3\nmap_Ke gray.png\n", "Ke 1 2 3\n", all, light},
          Row{"map_Ke gray.png\n", "Ke 1 1 1\n", all, light},
          Row{"Ke 0 0 0\nmap_Ke gray.png\n", "Ke 1 1 1\n", all, light},  // exporters write it so
          Row{"Ke 2 0 0\nmap_Ke halves.png\nmap_Ke\n", "Ke 2 0 0\n", all, all},
          Row{"Ke 2 1 1\nmap_Ke " + white_half, "Ke 2 1 1\n", all, all},
          Row{"Ke 2 1 1\nmap_Ke " + black_half, "", all, all}})
        for (const char* illumination : {"illum 0\n", "illum 1\n", "illum 2\n"})
            EXPECT_TRUE(are_equal(picture(with_map + illumination, all, all),
                                  picture(without + illumination, specular, emission)))
                << with_map << illumination << "and " << without << "times " << shown(specular)
                << " and " << shown(emission);
}

TEST(Phong, HardCase_SpecularMapsAreReadOnlyWhereThereIsAHighlight) {
    look_up("Eq. 6.5, what is left out");
    const fs::path folder = fresh_folder("missing_map"), out = folder / "out.png";
    const fs::path model = written(folder / "m.obj", square);
    const auto run = [&](const std::string& material) {
        written(folder / "m.mtl", "newmtl m\n" + material + "map_Ks missing.png\n");
        return run_program("06_phong", {"--model", model, "--size", "64x36", "--out", out});
    };
    for (const char* dull : {"Ks 0 0 0\n", "Ks 1 1 1\nillum 1\n", "Ks 1 1 1\nillum 0\n"}) {
        const ProcessResult result = run(dull);
        EXPECT_EQ(result.exit_status, 0) << dull;
        EXPECT_EQ(result.err, "") << dull;
        EXPECT_TRUE(fs::remove(out)) << dull;
    }
    expect_error(run("Ks 1 1 1\n"), 1,
                 (folder / "m.mtl").string() + ":3: map_Ks: " + (folder / "missing.png").string());
    EXPECT_FALSE(fs::exists(out));
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
        // Powers of two scale exactly; roots are taken another way for small and great squares.
        // Others round each position: some pixel's centre changes sides, or its light's.
        for (const auto& [factor, may_differ] :
             {std::pair{0x1p-100f, 0.0}, {0x1p120f, 0.0}, {1e-30f, 0.005}, {1e36f, 0.005}}) {
            const Image<vec3> picture = picture_of(scaled(factor), options);
            ASSERT_TRUE(is_finite(picture)) << factor;
            ASSERT_LE(share_that_differs(expected, picture), may_differ)
                << "the share of pixels; the teapot " << factor << " times as large, "
                << name_of(kind);
        }
    }
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
