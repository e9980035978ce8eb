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

Image<u8vec4> read_texture_file(const TextureMap& map, LoadBudget& budget, std::string* remark) {
    if (!map.unreadable.empty()) throw InputError(map.file, map.unreadable);
    if (!map.embedded) budget.charge_file(map.file);
    const std::uint64_t most = budget.left(Resource::pixels);
    Image<u8vec4> image = map.embedded ? decode_image(*map.embedded, map.file, most, remark)
                                       : read_image(map.file, most, remark);
    budget.charge(Resource::pixels, image.pixels().size(), map.file);
    return image;
}

Image<u8vec4> read_texture_file(const TextureMap& map, const char* statement, bool keep_going,
                                Scene& scene) {
    const auto named = [&](const InputError& error) {
        const std::string asked_by = map.asked_by.empty() ? statement : map.asked_by;
        return InputError(map.library, map.line, asked_by + ": " + error.what());
    };
    try {
        std::string remark;
        Image<u8vec4> image = read_texture_file(map, scene.budget, &remark);
        if (!remark.empty()) scene.warnings.push_back(named(InputError(map.file, remark)).what());
        return image;
    } catch (const InputError& error) {
        if (!keep_going) throw named(error);
        scene.warnings.push_back(named(error).what());
        return chessboard();
    }
}

}  // namespace rasterbook
