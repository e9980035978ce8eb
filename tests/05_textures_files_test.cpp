// SPDX-License-Identifier: MIT
// Textures that materials name: found or not, used as MTL says; and the lesson's own pictures.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "05_textures/load_textures.hpp"
#include "05_textures/textures.hpp"
#include "common/image/image_io.hpp"
#include "common/model/mesh.hpp"
#include "support/golden.hpp"
#include "support/lesson_process.hpp"
#include "support/look_up.hpp"
#include "support/printers.hpp"

namespace fs = std::filesystem;
using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr u8vec3 red(255, 0, 0), green(0, 255, 0), blue(0, 0, 255), white(255);

void write_text(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

void write_image_file(const fs::path& file, ivec2 size, const std::vector<u8vec3>& texels) {
    Image<u8vec3> picture(size);
    std::copy(texels.begin(), texels.end(), picture.pixels().begin());
    fs::create_directories(file.parent_path());
    write_image(file, picture);
}

const std::string plain = "newmtl m\nKd 1 1 1\n";
const std::string square_with_uv = "f 1/1 2/2 3/3 4/4\n", square_without_uv = "f 1 2 3 4\n";

/// A folder with square.obj, a square that fills the picture, its uv from 0 to 1, seen straight
/// from the front; its library, square.mtl; and pictures of one texel, and of two by two.
struct Model {
    fs::path folder = fresh_folder("textures"), out = folder / "out.png";

    explicit Model(const std::string& library, const std::string& faces = square_with_uv) {
        write_text(folder / "square.mtl", library);
        write_text(folder / "square.obj",
                   "mtllib square.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                   "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\n" +
                       faces);
        write_image_file(folder / "red.png", {1, 1}, {red});
        write_image_file(folder / "four.png", {2, 2}, {red, green, blue, white});
    }

    ProcessResult run(std::vector<std::string> arguments = {}) const {
        arguments.insert(arguments.end(),
                         {"--model", folder / "square.obj", "--out", out, "--yaw", "0", "--pitch",
                          "0", "--distance", "2", "--size", "48x48"});
        return run_program("05_textures", arguments);
    }

    /// What the program draws; it has nothing to warn of.
    Image<u8vec4> drawn(const std::vector<std::string>& arguments = {}) const {
        const ProcessResult result = run(arguments);
        EXPECT_EQ(result.exit_status, 0) << result.err;
        EXPECT_EQ(result.err, "");
        return result.exit_status == 0 ? read_image(out) : Image<u8vec4>({48, 48});
    }
};

/// Which of the three lights there are: the square's own colour is a grey.
u8vec3 hue(u8vec4 color) {
    return {color.r > 60 ? 255 : color.r, color.g > 60 ? 255 : color.g,
            color.b > 60 ? 255 : color.b};
}

/// For EXPECT_TRUE: the whole picture has one hue.
testing::AssertionResult is_all(const Image<u8vec4>& picture, u8vec3 expected) {
    for (const u8vec4 color : picture.pixels())
        if (hue(color) != expected)
            return testing::AssertionFailure()
                   << "a pixel has the codes " << testing::PrintToString(color)
                   << " instead of the hue " << testing::PrintToString(expected)
                   << " (255: above 60)";
    return testing::AssertionSuccess();
}

/// What the lesson's first step can draw.
const std::vector<std::string> of_step_1 = {"lab",    "--filter", "nearest", "--mapping",
                                            "affine", "--srgb",   "ignored"};

}  // namespace

TEST(Textures, ImageThatCannotBeReadIsAnErrorThatNamesWhoAsksForIt) {
    look_up("Eq. 5.11, and how images are found");
    const Model model(plain + "map_Kd bad.png\n");
    const fs::path bad = model.folder / "bad.png";
    const std::string half = read_text(model.folder / "red.png").substr(0, 40);
    for (const std::string& bytes : {std::string("missing"), std::string(), half}) {
        if (bytes != "missing") write_text(bad, bytes);
        expect_error(model.run(), 1,
                     (model.folder / "square.mtl").string() + ":3: map_Kd: " + bad.string() + ": ");
        EXPECT_FALSE(fs::exists(model.out)) << bytes;
    }
    fs::remove(bad);
    fs::create_directory(bad);
    EXPECT_EQ(model.run().exit_status, 1) << "a folder";
}

TEST(Textures, WithKeepGoingAChessboardTakesThePlaceOfABrokenImage) {
    look_up("Eq. 5.11, and how images are found");
    const Model model(plain + "map_Kd bad.png\n");
    const ProcessResult result = model.run({"--keep-going", "--filter", "nearest"});
    EXPECT_EQ(result.exit_status, 0);
    EXPECT_TRUE(result.err.starts_with("warning: " + (model.folder / "square.mtl").string() +
                                       ":3: map_Kd: " + (model.folder / "bad.png").string()))
        << result.err;
    int dark = 0, magenta = 0;
    const Image<u8vec4> drawn = read_image(model.out);
    for (const u8vec4 color : drawn.pixels())
        dark += hue(color) == u8vec3(0), magenta += hue(color) == u8vec3(255, 0, 255);
    EXPECT_EQ(dark + magenta, 48 * 48);
    EXPECT_NEAR(dark, magenta, 48 * 48 / 5);
    EXPECT_TRUE(is_all(Model(plain + "map_Kd red.png\n").drawn({"--keep-going"}), red));
}

TEST(Textures, ImagesAreFoundAsExportersNameThem) {
    look_up("Eq. 5.11, and how images are found");
    EXPECT_TRUE(is_all(Model(plain).drawn(), white)) << "without a picture";
    struct Case {
        const char *name, *statement;
    };
    for (const auto& [name, statement] :
         {Case{"red.png", "\tmap_kd   red.png   \r\n"}, Case{"red.png", "map_Kd .\\red.png\n"},
          Case{"red.png", "map_Kd -s 2 2 1 -o 0.5 0 0 -blendu on red.png\n"},
          Case{"red.png", "map_Kd red.png\nbump no_such_heights.png\nmap_Ks no.png\nnorm no.png\n"},
          Case{"2 reds.png", "map_Kd 2 reds.png\n"}, Case{"-red.png", "map_Kd -red.png\n"},
          Case{"textures/very red/red.bmp", "map_Kd textures\\very red\\red.bmp\n"},
          Case{"red.tga", "map_Kd red.tga\nnewmtl used_by_no_triangle\nmap_Kd no.png\n"}}) {
        const Model model(plain + statement);
        write_image_file(model.folder / name, {1, 1}, {red});
        EXPECT_TRUE(is_all(model.drawn(), red)) << statement;
    }
}

TEST(Textures, Eq5_5_TextureStandsUprightOnTheSquare) {
    const Image<u8vec4> drawn = Model(plain + "map_Kd four.png\n").drawn(of_step_1);
    EXPECT_EQ(hue(drawn[{4, 4}]), red) << "upper left: the picture's first row is the upper one";
    EXPECT_EQ(hue(drawn[{43, 4}]), green) << "upper right";
    EXPECT_EQ(hue(drawn[{4, 43}]), blue) << "lower left";
    EXPECT_EQ(hue(drawn[{43, 43}]), white) << "lower right";
}

TEST(Textures, OneImageMayBeClampedByOneMaterialAndRepeatedByAnother) {
    look_up("Eq. 5.4");
    Scene scene;
    const Model model(plain);
    scene.materials.resize(5);
    Mesh& mesh = scene.meshes.emplace_back();
    for (std::uint32_t i = 0; i < 5; ++i) mesh.triangles.push_back({{}, i});
    for (std::size_t i = 0; i < 4; ++i) {
        scene.materials[i].diffuse_map.file = model.folder / "red.png";
        scene.materials[i].diffuse_map.clamp = bvec2(i % 2);
    }
    const std::vector<Material> as_in_file = scene.materials;
    for (const Wrap option : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
        scene.materials = as_in_file;
        const MaterialTextures textures = load_diffuse_textures(scene, {.wrap = option});
        ASSERT_EQ(textures.size(), 5u) << "one for each material";
        ASSERT_TRUE(textures[0] && textures[1]) << "of the first two materials";
        EXPECT_EQ(textures[0]->wrap, option) << "as the option says";
        EXPECT_EQ(textures[1]->wrap, Wrap::clamp) << "-clamp on goes before the option";
        EXPECT_EQ(textures[0], textures[2]) << "read once";
        EXPECT_EQ(textures[1], textures[3]) << "read once";
        EXPECT_EQ(textures[4], nullptr) << "the last material names none";
    }
}

TEST(Textures, Eq5_4_HardCase_CoordinatesFarFrom0AreMovedNearIt) {
    const Triangle triangle = {{Vertex{0, 0}, Vertex{1, 1}, Vertex{2, 2}}, 0};
    Mesh mesh;
    mesh.uvs = {{65537.3, -2.7}, {65536.1, 0.2}, {65540, -65536.4}};
    const std::array repeated = {vec2(0.3f, 0.3f), vec2(-0.9f, 3.2f), vec2(3, -65533.4f)};
    const std::array mirrored = {vec2(1.3f, 1.3f), vec2(0.1f, 4.2f), vec2(4, -65532.4f)};
    const std::array as_they_are = {vec2(mesh.uvs[0]), vec2(mesh.uvs[1]), vec2(mesh.uvs[2])};
    const auto uvs = [&](WrapModes wrap, const TextureMap& map) {
        const Texture texture = make_texture(Image<vec4>({1, 1}), wrap);
        return uvs_of(mesh, triangle, map, &texture);
    };
    EXPECT_EQ(uvs(Wrap::repeat, {}), repeated);
    EXPECT_EQ(uvs(Wrap::mirror, {}), mirrored);
    EXPECT_EQ(uvs(Wrap::clamp, {}), as_they_are);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(uvs({Wrap::clamp, Wrap::mirror}, {})[i], vec2(as_they_are[i].x, mirrored[i].y));
    // What the map's own -s and -o make far.
    mesh.uvs = {{0.25f, 0}, {0.5f, 1}, {1, 0.75f}};
    TextureMap far;
    far.scale = {65536, -2, 1}, far.offset = {65536.3, 1e6 + 0.7, 0};
    const std::array near = {vec2(0.3f, 0.7f), vec2(16384.3f, -1.3f), vec2(49152.3f, -0.8f)};
    EXPECT_EQ(uvs(Wrap::repeat, far), near);
}

TEST(Textures, Eq5_1_OffsetAndScaleOfTheMap) {
    Mesh mesh;
    mesh.uvs = {{0, 0}, {1, 0.5f}, {0.25f, 1}};
    const Triangle triangle = {{Vertex{0, 2}, Vertex{1, no_index}, Vertex{2, 1}}, 0};
    TextureMap map;
    const std::array plainly = {dvec2(0.25f, 1), dvec2(0), dvec2(1, 0.5f)};
    EXPECT_EQ(exact_uvs_of(mesh, triangle, map), plainly);
    map.scale = {4, 2, 7}, map.offset = {0.5f, -1, 7};
    const std::array scaled = {dvec2(1.5f, 1), dvec2(0.5f, -1), dvec2(4.5f, 0)};
    EXPECT_EQ(exact_uvs_of(mesh, triangle, map), scaled);

    const Image<u8vec4> drawn = Model(plain + "map_Kd -o 0.5 0 0 four.png\n").drawn(of_step_1);
    EXPECT_EQ(hue(drawn[{4, 4}]), green) << "at the left: red and green, moved by half";
    EXPECT_EQ(hue(drawn[{43, 4}]), red) << "at the right";
}

TEST(Textures, TrianglesWithoutUvHaveTheColourAtZero) {
    look_up("Eq. 5.5");
    const Model model(plain + "map_Kd four.png\n", square_without_uv);
    EXPECT_TRUE(is_all(model.drawn({"--filter", "nearest"}), blue)) << "the lower left texel";
}

TEST(Textures, WithoutMapsNothingIsSampledAndAllLooksAsIfTheyWereWhite) {
    look_up("Eq. 5.6: what is only asked for where there is a map");
    const Model without(plain), with(plain + "map_Kd white.png\n");
    write_image_file(with.folder / "white.png", {1, 1}, {white});
    const std::string no_samples = "\"texture_samples\": 0,";
    EXPECT_NE(without.run({"--stats"}).out.find(no_samples), std::string::npos);
    EXPECT_EQ(with.run({"--stats"}).out.find(no_samples), std::string::npos);
    EXPECT_TRUE(read_text(without.out) == read_text(with.out)) << "the pictures differ";
}

TEST(Textures, PictureOfTheLesson) { EXPECT_TRUE(equals_golden("05_textures", "05_textures")); }

// Of a floor to the horizon, near the ground.

TEST(Textures, PictureOfTheHorizon) {
    EXPECT_TRUE(equals_golden(
        "05_textures", "05_textures_horizon",
        {"--model", "horizon.obj", "--distance", "0.035", "--pitch", "12", "--yaw", "-25"}));
}

TEST(Textures, PictureOfTheNearestTexels) {
    EXPECT_TRUE(equals_golden("05_textures", "05_textures_nearest",
                              {"--model", "horizon.obj", "--distance", "0.035", "--pitch", "12",
                               "--yaw", "-25", "--filter", "nearest"}));
}

TEST(Textures, PictureOfFourTexelsMean) {
    EXPECT_TRUE(equals_golden("05_textures", "05_textures_bilinear",
                              {"--model", "horizon.obj", "--distance", "0.035", "--pitch", "12",
                               "--yaw", "-25", "--filter", "bilinear"}));
}

TEST(Textures, PictureOfTheAffineMapping) {
    EXPECT_TRUE(equals_golden("lab_05_textures", "05_textures_affine",
                              {"--model", "horizon.obj", "--distance", "0.035", "--pitch", "12",
                               "--yaw", "-25", "--mapping", "affine"}));
}
