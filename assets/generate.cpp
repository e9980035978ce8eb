// SPDX-License-Identifier: MIT
/// @file
/// Makes every model, scene and texture of the course again: generate_assets [OUT_DIR].
///
/// The same bytes on every machine: only + - * / and sqrt, whose results IEEE 754 fixes. (Another
/// encoder may compress a PNG otherwise.)
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "assets/generate/arbor.hpp"
#include "assets/generate/brick.hpp"
#include "assets/generate/figure.hpp"
#include "assets/generate/graph_paper.hpp"
#include "assets/generate/hammered.hpp"
#include "assets/generate/materials.hpp"
#include "assets/generate/models.hpp"
#include "assets/generate/scenes.hpp"
#include "assets/generate/shield.hpp"
#include "assets/generate/teapot.hpp"
#include "assets/generate/texture.hpp"
#include "assets/generate/tiles.hpp"
#include "assets/generate/wood.hpp"
#include "assets/generate/workshop.hpp"
#include "common/image/file.hpp"
#include "common/image/image_io.hpp"
#include "common/image/input_error.hpp"
#include "common/image/interruption.hpp"
#include "common/image/png.hpp"

namespace rasterbook::assets {
namespace {

using std::filesystem::path;

std::vector<Part> load_teapot(const path& file) {
    std::ifstream in(file);
    if (!in) throw InputError(file, "cannot be opened");
    try {
        const std::vector<Patch> patches = read_patches(nlohmann::json::parse(in));
        if (patches.size() != 32) throw InputError(file, "the teapot has 32 patches");
        return teapot_parts(patches);
    } catch (const nlohmann::json::exception& error) { throw InputError(file, error.what()); }
}

void write_text(const path& file, const std::string& text) {
    write_whole_file(file, std::vector<std::uint8_t>(text.begin(), text.end()));
}

/// One OBJ and the MTL of the same name.
void write_model(const path& folder, const std::string& name, const std::string& comment,
                 std::vector<Part> parts, const std::string& materials) {
    write_text(folder / (name + ".obj"), obj_text({comment, name + ".mtl", std::move(parts)}));
    write_text(folder / (name + ".mtl"), "# " + comment + "\n" + materials);
}

void write_models(const path& folder, const std::vector<Part>& teapot) {
    const std::string utah = "The Utah teapot (Martin Newell, 1975)";
    write_model(folder, "teapot", utah, teapot, porcelain + tea_in_spout);
    write_model(folder, "triangle", "A triangle", {triangle("white")}, plain_white);
    write_model(folder, "crate", "A wooden crate", {crate("crate")}, wooden_crate);
    write_model(folder, "crate_bump", "A brick block with a height map", {crate("brick")},
                brick_crate_with_heights);
    write_model(folder, "floor", "A wide floor of tiles", {floor("tiles", 48, 3)}, smooth_tiles);
    write_model(folder, "floor_checker", "A wide checkered floor", {floor("checker", 48, 6)},
                checkered_floor);
    write_model(folder, "horizon", "A wooden crate on a checkered floor to the horizon",
                {crate("crate"), floor("checker", 384, 6)}, wooden_crate + checkered_floor);
    write_model(folder, "scene", "Teapot, crate and floor", scene(teapot, "", "crate", "tiles"),
                porcelain + tea_in_spout + wooden_crate + smooth_tiles);
    write_model(folder, "figure", "A robot with a crate on a platform", figure(), figure_paints);
    write_model(folder, "shield_mirrored_uvs",
                "A shield, both halves of which show one half of a texture", {shield("bronze")},
                embossed_bronze);
    write_model(folder, "scene_bumpy", "Teapot, crate and floor with normal maps",
                scene(teapot, "copper", "brick", "tiles"),
                hammered_copper + tea_in_spout + brick_crate + bumpy_tiles);
}

void write_scenes(const path& folder, const std::vector<Part>& teapot) {
    write_whole_file(folder / "unlit.glb", unlit_scene(teapot).glb());
    GltfFile textured = textured_scene(teapot);
    write_text(folder / "textured.gltf", textured.text("textured.bin"));
    write_whole_file(folder / "textured.bin", textured.bytes());
    write_whole_file(folder / "bumpy.glb", bumpy_scene(teapot).glb());
    write_whole_file(folder / "toon.glb", toon_scene().glb());
    write_whole_file(folder / "arbor.glb", arbor_scene().glb());
    write_whole_file(folder / "workshop.glb", workshop_scene(teapot).glb());
}

u8vec3 checker_texel(dvec2 p) {
    const ivec2 square = ivec2(p) / 64;
    return encode((square.x + square.y) % 2 == 0 ? rgb(0xECE5D8) : rgb(0x33424E));
}

/// NAME.png, NAME_specular.png and NAME_normal.png.
void write_material(const path& folder, const std::string& name, const Image<Texel>& texels,
                    double relief) {
    write_image(folder / (name + ".png"), color_image(texels));
    write_image(folder / (name + "_specular.png"), specular_image(texels));
    write_image(folder / (name + "_normal.png"), normal_image(texels, relief));
}

void write_textures(const path& folder) {
    const Image<Texel> brick = paint(brick_texel);
    write_material(folder, "brick", brick, brick_relief);
    write_image(folder / "brick_height.png", height_image(brick));
    write_material(folder, "tiles", paint(tile_texel), tile_relief);
    write_material(folder, "hammered", paint(hammered_texel), hammered_relief);
    write_image(folder / "shield_normal.png", normal_image(paint(shield_texel), shield_relief));
    write_image(folder / "wood.png", wood_image());
    write_image(folder / "checker.png", paint(checker_texel));
    write_image(folder / "graph_paper.png", graph_paper_image());
    write_whole_file(folder / "leaves.png", encode_png(leaves_image(), folder / "leaves.png"));
}

void generate(const path& folder) {
    const std::vector<Part> teapot = load_teapot(path(RASTERBOOK_ASSETS) / "utah_teapot.json");
    std::filesystem::create_directories(folder / "models");
    std::filesystem::create_directories(folder / "textures");
    write_models(folder / "models", teapot);
    write_scenes(folder / "models", teapot);
    write_textures(folder / "textures");
}

}  // namespace
}  // namespace rasterbook::assets

int main(int argument_count, char** arguments) {
    if (argument_count > 2 || (argument_count == 2 && arguments[1][0] == '-')) {
        std::cerr << "usage: generate_assets [OUT_DIR]\n";
        return 2;
    }
    rasterbook::protect_files();
    try {
        rasterbook::assets::generate(argument_count == 2 ? arguments[1] : RASTERBOOK_ASSETS);
        return 0;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << '\n';
        return 1;
    }
}
