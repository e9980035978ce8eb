// SPDX-License-Identifier: MIT
// Textures that materials name: found or not, used as MTL says; and the lesson's own pictures.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
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
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
}

void write_image_file(const fs::path& file, ivec2 size, const std::vector<u8vec3>& texels) {
    Image<u8vec3> picture(size);
    std::copy(texels.begin(), texels.end(), picture.pixels().begin());
    fs::create_directories(file.parent_path());
    write_image(file, picture);
}

/// A square that fills the picture, its uv from 0 to 1, seen straight from the front.
const std::string square =
    "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
const std::string square_with_uv = "f 1/1 2/2 3/3 4/4\n", square_without_uv = "f 1 2 3 4\n";

/// A folder with a model, square.obj, whose library is square.mtl, and red.png.
struct Model {
    fs::path folder = fresh_folder("textures"), out = folder / "out.png";

    explicit Model(const std::string& library, const std::string& faces = square_with_uv,
                   const std::string& header = "mtllib square.mtl\n") {
        write_text(folder / "square.mtl", library);
        write_text(folder / "square.obj", header + square + "usemtl m\n" + faces);
        write_image_file(folder / "red.png", {1, 1}, {red});
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
    for (ivec2 p(0); p.y < picture.size().y; ++p.y)
        for (p.x = 0; p.x < picture.size().x; ++p.x)
            if (hue(picture[p]) != expected)
                return testing::AssertionFailure()
                       << "pixel " << testing::PrintToString(p) << " has the codes "
                       << testing::PrintToString(picture[p]) << " instead of the hue "
                       << testing::PrintToString(expected) << " (255: above 60)";
    return testing::AssertionSuccess();
}

const std::string plain = "newmtl m\nKd 1 1 1\n";

}  // namespace

TEST(Textures, ImageThatCannotBeReadIsAnErrorThatNamesWhoAsksForIt) {
    look_up("Eq. 5.11, and how images are found");
    Model model(plain + "map_Kd bad.png\n");
    const std::string red_png = read_text(model.folder / "red.png");
    struct Case {
        const char* what;
        const std::string* bytes;
    };
    const std::string nothing, words = "not a picture\n", half = red_png.substr(0, 40);
    for (const auto& [what, bytes] : {Case{"missing", nullptr}, Case{"empty", &nothing},
                                      Case{"words", &words}, Case{"truncated", &half}}) {
        if (bytes) write_text(model.folder / "bad.png", *bytes);
        const ProcessResult result = model.run();
        EXPECT_EQ(result.exit_status, 1) << what;
        const std::string begin = "error: " + (model.folder / "square.mtl").string() +
                                  ":3: map_Kd: " + (model.folder / "bad.png").string() + ": ";
        EXPECT_TRUE(result.err.starts_with(begin)) << what << ": " << result.err;
        EXPECT_GT(result.err.size(), begin.size() + 10) << what << ": it says why";
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_FALSE(fs::exists(model.out)) << what;
    }
    fs::remove(model.folder / "bad.png");
    fs::create_directory(model.folder / "bad.png");
    EXPECT_EQ(model.run().exit_status, 1) << "a folder";
}

TEST(Textures, MaterialThatNoTriangleHasReadsNoImage) {
    look_up("Eq. 5.11, and how images are found");
    const Model model(plain + "map_Kd red.png\nnewmtl unused\nmap_Kd missing.png\n");
    EXPECT_TRUE(is_all(model.drawn(), red));
    EXPECT_EQ(model.run().err, "");
}

TEST(Textures, WithKeepGoingAChessboardTakesThePlaceOfABrokenImage) {
    look_up("Eq. 5.11, and how images are found");
    const Model model(plain + "map_Kd bad.png\n");
    for (const bool exists : {false, true}) {
        if (exists) write_text(model.folder / "bad.png", "not a picture\n");
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
    }
    EXPECT_TRUE(is_all(Model(plain + "map_Kd red.png\n").drawn({"--keep-going"}), red));
}

TEST(Textures, ImagesAreFoundAsExportersNameThem) {
    look_up("Eq. 5.11, and how images are found");
    EXPECT_TRUE(is_all(Model(plain).drawn(), white)) << "without a picture";
    for (const char* statement :
         {"map_Kd red.png\n", "map_kd red.png\n", "\tmap_Kd   red.png   \r\n", "map_Kd ./red.png\n",
          "map_Kd .\\red.png\n", "map_Kd -s 2 2 1 -o 0.5 0 0 red.png\n",
          "map_Kd -blendu on red.png\n", "map_Bump -bm 1 no_such_heights.png\nmap_Kd red.png\n",
          "map_Kd red.png\nbump no_such_heights.png\nmap_Ks no.png\nnorm no.png\nmap_d no.png\n"})
        EXPECT_TRUE(is_all(Model(plain + statement).drawn(), red)) << statement;
    for (const auto& [name, statement] :
         {std::pair("a red one.png", "map_Kd a red one.png\n"),
          std::pair("2 reds.png", "map_Kd 2 reds.png\n"),
          std::pair("textures/red.tga", "map_Kd textures\\red.tga\n"),
          std::pair("textures/very red/red.bmp", "map_Kd textures\\very red\\red.bmp\n"),
          std::pair("-red.png", "map_Kd -red.png\n")}) {
        const Model model(plain + statement);
        write_image_file(model.folder / name, {1, 1}, {red});
        EXPECT_TRUE(is_all(model.drawn(), red)) << statement;
    }
}

TEST(Textures, PathsAreThoseBesideTheLibrary) {
    look_up("Eq. 5.11, and how images are found");
    const Model model("", square_with_uv, "mtllib materials\\square.mtl\n");
    write_text(model.folder / "materials/square.mtl", plain + "map_Kd ../pictures/green.png\n");
    write_image_file(model.folder / "pictures/green.png", {1, 1}, {green});
    EXPECT_TRUE(is_all(model.drawn(), green));
}

TEST(Textures, MaterialsMayComeFromSeveralLibraries) {
    look_up("Eq. 5.11, and how images are found");
    for (const char* header :
         {"mtllib square.mtl\nmtllib other.mtl\n", "mtllib other.mtl square.mtl\n"}) {
        const Model model("newmtl another\nKd 1 1 1\nmap_Kd red.png\n", square_with_uv, header);
        write_text(model.folder / "other.mtl", plain + "map_Kd green.png\n");
        write_image_file(model.folder / "green.png", {1, 1}, {green});
        EXPECT_TRUE(is_all(model.drawn(), green)) << header;
    }
}

TEST(Textures, MaterialThatDoesNotExistIsAWarningAndHasNoTexture) {
    look_up("Eq. 5.11, and how images are found");
    const Model model("newmtl another\nmap_Kd red.png\n");
    const ProcessResult result = model.run({"--stats"});
    EXPECT_EQ(result.exit_status, 0);
    EXPECT_TRUE(result.err.starts_with("warning: ")) << result.err;
    EXPECT_NE(result.err.find("there is no material"), std::string::npos) << result.err;
    EXPECT_NE(result.out.find("\"texture_samples\": 0,"), std::string::npos) << result.out;
    EXPECT_TRUE(is_all(read_image(model.out), white));
}

namespace {

using Arguments = std::vector<std::string>;

/// What the lesson's first step can draw; and what the last one draws.
const Arguments of_step_1 = {"lab",    "--filter", "nearest", "--mapping",
                             "affine", "--srgb",   "ignored"};
const Arguments of_all_steps = {"--filter", "nearest"};

void expect_four_texels_upright(const Arguments& arguments) {
    const Model model(plain + "map_Kd four.png\n");
    write_image_file(model.folder / "four.png", {2, 2}, {red, green, blue, white});
    const Image<u8vec4> drawn = model.drawn(arguments);
    EXPECT_EQ(hue(drawn[{4, 4}]), red) << "upper left: the picture's first row is the upper one";
    EXPECT_EQ(hue(drawn[{43, 4}]), green) << "upper right";
    EXPECT_EQ(hue(drawn[{4, 43}]), blue) << "lower left";
    EXPECT_EQ(hue(drawn[{43, 43}]), white) << "lower right";
}

void expect_clamp_on_before_the_option(const Arguments& arguments) {
    const auto upper_right = [&](const std::string& statement, const std::string& word) {
        // Twice the picture's size: beyond the middle lies what the wrap says.
        const Model model(plain + "map_Kd " + statement + " -s 2 2 1 four.png\n");
        write_image_file(model.folder / "four.png", {2, 2}, {red, green, blue, white});
        Arguments all = arguments;
        all.insert(all.end(), {"--wrap", word});
        const Image<u8vec4> drawn = model.drawn(all);
        return std::array{hue(drawn[{28, 20}]), hue(drawn[{43, 4}])};
    };
    const std::array repeated = {blue, green}, mirrored = {green, blue}, clamped = {green, green};
    EXPECT_EQ(upper_right("", "repeat"), repeated);
    EXPECT_EQ(upper_right("", "mirror"), mirrored);
    EXPECT_EQ(upper_right("", "clamp"), clamped);
    EXPECT_EQ(upper_right("-clamp off", "repeat"), repeated);
    for (const char* word : {"repeat", "mirror", "clamp"})
        EXPECT_EQ(upper_right("-clamp on", word), clamped) << word;
}

void expect_picture_moved_by_half(const Arguments& arguments) {
    const Model model(plain + "map_Kd -o 0.5 0 0 two.png\n");
    write_image_file(model.folder / "two.png", {2, 1}, {red, green});
    const Image<u8vec4> drawn = model.drawn(arguments);
    EXPECT_EQ(hue(drawn[{4, 24}]), green) << "at the left: red and green, moved by half";
    EXPECT_EQ(hue(drawn[{43, 24}]), red) << "at the right";
}

}  // namespace

TEST(Textures, Eq5_5_TextureStandsUprightOnTheSquare) { expect_four_texels_upright(of_step_1); }

TEST(Textures, Eq5_5_ClampOnGoesBeforeTheOption) { expect_clamp_on_before_the_option(of_step_1); }

TEST(Textures, InPerspectiveAndDecodedTheSquareShowsTheSame) {
    look_up("Eq. 5.11, and Eq. 5.2");
    expect_four_texels_upright(of_all_steps);
    expect_clamp_on_before_the_option(of_all_steps);
    expect_picture_moved_by_half(of_all_steps);
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
    const MaterialTextures textures = load_diffuse_textures(scene, {});
    ASSERT_EQ(textures.size(), 5u) << "one for each material";
    for (std::size_t i = 0; i < 4; ++i) ASSERT_NE(textures[i], nullptr) << "of material " << i;
    EXPECT_EQ(textures[0]->wrap, Wrap::repeat);
    EXPECT_EQ(textures[1]->wrap, Wrap::clamp);
    EXPECT_EQ(textures[0], textures[2]) << "read once";
    EXPECT_EQ(textures[1], textures[3]) << "read once";
    EXPECT_EQ(textures[4], nullptr) << "the last material names none";
}

TEST(Textures, Eq5_4_HardCase_CoordinatesFarFrom0AreMovedNearIt) {
    const Triangle triangle = {{Vertex{0, 0}, Vertex{1, 1}, Vertex{2, 2}}, 0};
    Mesh mesh;
    mesh.uvs = {{65537.3, -2.7}, {65536.1, 0.2}, {65540, -65536.4}};
    const std::array<vec2, 3> repeated = {vec2(0.3f, 0.3f), vec2(-0.9f, 3.2f), vec2(3, -65533.4f)};
    const std::array<vec2, 3> mirrored = {vec2(1.3f, 1.3f), vec2(0.1f, 4.2f), vec2(4, -65532.4f)};
    const auto uvs = [&](Wrap wrap, const TextureMap& map) {
        const Texture texture = make_texture(Image<vec4>({1, 1}), wrap);
        return uvs_of(mesh, triangle, map, &texture);
    };
    EXPECT_EQ(uvs(Wrap::repeat, {}), repeated);
    EXPECT_EQ(uvs(Wrap::mirror, {}), mirrored);
    const std::array<vec2, 3> as_they_are = {vec2(mesh.uvs[0]), vec2(mesh.uvs[1]),
                                             vec2(mesh.uvs[2])};
    EXPECT_EQ(uvs(Wrap::clamp, {}), as_they_are);
    // What the map's own -s and -o make far.
    mesh.uvs = {{0.25f, 0}, {0.5f, 1}, {1, 0.75f}};
    TextureMap far;
    far.scale = {65536, -2, 1}, far.offset = {65536.3, 1e6 + 0.7, 0};
    const std::array<vec2, 3> near = {vec2(0.3f, 0.7f), vec2(16384.3f, -1.3f),
                                      vec2(49152.3f, -0.8f)};
    EXPECT_EQ(uvs(Wrap::repeat, far), near);
}

TEST(Textures, Eq5_1_OffsetAndScaleOfTheMap) {
    Mesh mesh;
    mesh.uvs = {{0, 0}, {1, 0.5f}, {0.25f, 1}};
    const Triangle triangle = {{Vertex{0, 2}, Vertex{1, no_index}, Vertex{2, 1}}, 0};
    TextureMap map;
    const std::array<vec2, 3> plainly = {vec2(0.25f, 1), vec2(0), vec2(1, 0.5f)};
    const auto uvs = [&] {
        const std::array<dvec2, 3> exact = exact_uvs_of(mesh, triangle, map);
        return std::array{vec2(exact[0]), vec2(exact[1]), vec2(exact[2])};
    };
    EXPECT_EQ(uvs(), plainly);
    map.scale = {4, 2, 7}, map.offset = {0.5f, -1, 7};
    const std::array<vec2, 3> scaled = {vec2(1.5f, 1), vec2(0.5f, -1), vec2(4.5f, 0)};
    EXPECT_EQ(uvs(), scaled);

    expect_picture_moved_by_half(of_step_1);
}

TEST(Textures, TrianglesWithoutUvHaveTheColourAtZero) {
    look_up("Eq. 5.5");
    const Model model(plain + "map_Kd four.png\n", square_without_uv);
    write_image_file(model.folder / "four.png", {2, 2}, {red, green, blue, white});
    EXPECT_TRUE(is_all(model.drawn({"--filter", "nearest"}), blue)) << "the lower left texel";
    const Image<u8vec4> drawn = model.drawn();
    for (const u8vec4 color : drawn.pixels())
        ASSERT_EQ(color, (drawn[{0, 0}])) << "a footprint of no size";
}

TEST(Textures, Eq5_11_HalfOfTheLightIsValue188) {
    const auto color = [](const std::vector<std::string>& arguments, u8vec3 texel) {
        const Model model(plain + "map_Kd gray.png\n");
        write_image_file(model.folder / "gray.png", {1, 1}, {texel});
        return linear_from_srgb(model.drawn(arguments)[{24, 24}].r / 255.0);
    };
    const double whole = color({}, white);
    constexpr double code = 0.006;  // a code of a colour below 0.4, of 255
    EXPECT_NEAR(color({}, u8vec3(188)) / whole, 0.503, code / whole);
    EXPECT_NEAR(color({"--srgb", "ignored"}, u8vec3(188)) / whole, 188 / 255.0, code / whole);
}

TEST(Textures, SceneWithoutMapsSamplesNothingAndLooksAsIfAllWereWhite) {
    look_up("Eq. 5.6: what is only asked for where there is a map");
    const fs::path folder = fresh_folder("white"), models = fs::path(RASTERBOOK_ASSETS) / "models";
    const std::string library = read_text(models / "teapot.mtl");
    std::string with_maps;
    for (std::size_t at = 0; at < library.size();) {
        const auto end = library.find('\n', at) + 1;
        const std::string line = library.substr(at, end - at);
        with_maps += line + (line.starts_with("newmtl") ? "map_Kd white.png\n" : "");
        at = end;
    }
    ASSERT_EQ(library.find("map_"), library.npos);
    ASSERT_NE(with_maps, library);
    write_image_file(folder / "white.png", {1, 1}, {white});
    std::vector<std::string> pictures;
    for (const std::string* text : {&library, &std::as_const(with_maps)}) {
        write_text(folder / "teapot.obj", read_text(models / "teapot.obj"));
        write_text(folder / "teapot.mtl", *text);
        const ProcessResult result =
            run_program("05_textures", {"--model", folder / "teapot.obj", "--out",
                                        folder / "out.png", "--size", "320x180", "--stats"});
        ASSERT_EQ(result.exit_status, 0) << result.err;
        EXPECT_EQ(result.out.find("\"texture_samples\": 0,") != std::string::npos,
                  text == &library);
        pictures.push_back(read_text(folder / "out.png"));
    }
    EXPECT_GT(pictures[0].size(), 1000u);
    EXPECT_EQ(pictures[0] == pictures[1], true);
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
