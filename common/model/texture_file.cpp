// SPDX-License-Identifier: MIT
#include "common/model/texture_file.hpp"

#include "common/image/image_io.hpp"
#include "common/image/input_error.hpp"

namespace rasterbook {
namespace {

Image<u8vec4> chessboard() {
    Image<u8vec4> image({8, 8}, {255, 0, 255, 255});
    for (int i = 0; i < 64; ++i)
        if ((i / 8 + i) % 2 == 0) image[{i % 8, i / 8}] = {0, 0, 0, 255};
    return image;
}

}  // namespace

Image<u8vec4> read_texture_file(const TextureMap& map, LoadBudget& budget) {
    if (!map.embedded) budget.charge_file(map.file);
    const std::uint64_t most = budget.left(Resource::pixels);
    Image<u8vec4> image =
        map.embedded ? decode_image(*map.embedded, map.file, most) : read_image(map.file, most);
    budget.charge(Resource::pixels, image.pixels().size(), map.file);
    return image;
}

Image<u8vec4> read_texture_file(const TextureMap& map, const char* statement, bool keep_going,
                                Scene& scene) {
    try {
        return read_texture_file(map, scene.budget);
    } catch (const InputError& error) {
        const std::string asked_by = map.asked_by.empty() ? statement : map.asked_by;
        const InputError named(map.library, map.line, asked_by + ": " + error.what());
        if (!keep_going) throw named;
        scene.warnings.push_back(named.what());
        return chessboard();
    }
}

}  // namespace rasterbook
