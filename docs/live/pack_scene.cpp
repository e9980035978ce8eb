// SPDX-License-Identifier: MIT
// pack_scene MODEL OUT: a model file and its images as live_app.cpp reads them.
#include <cstdio>
#include <exception>
#include <fstream>

#include "common/model/model_file.hpp"
#include "common/model/texture_file.hpp"
#include "docs/live/packed_scene.hpp"

using namespace rasterbook;

int main(int argc, char** argv) {
    if (argc != 3) return std::fputs("error: pack_scene MODEL OUT\n", stderr), 2;
    try {
        Scene scene = load_model(argv[1], LoadBudget());
        std::map<std::filesystem::path, EmbeddedImage> images;
        for (Material& material : scene.materials)
            for (TextureMap* const map :
                 {&material.diffuse_map, &material.specular_map, &material.opacity_map,
                  &material.bump_map, &material.normal_map}) {
                if (map->file.empty()) continue;
                EmbeddedImage& image = images[map->file];
                if (!image)
                    image = std::make_shared<const std::vector<std::uint8_t>>(
                        packed(read_texture_file(*map, scene.budget)));
                map->embedded = image;
            }
        SceneWriter writer;
        transfer(writer, scene);
        std::ofstream out(argv[2], std::ios::binary);
        out.write(reinterpret_cast<const char*>(writer.written.data()),
                  static_cast<std::streamsize>(writer.written.size()));
        if (!out.flush()) throw std::runtime_error(std::string(argv[2]) + ": cannot be written");
    } catch (const std::exception& error) {
        return std::fprintf(stderr, "error: %s\n", error.what()), 1;
    }
}
