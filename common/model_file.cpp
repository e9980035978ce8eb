// SPDX-License-Identifier: MIT
#include "common/model_file.hpp"

#include <string>

#include "common/gltf.hpp"
#include "common/obj.hpp"

namespace rasterbook {

Scene load_model(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const bool is_gltf = ending == ".gltf" || ending == ".glb" || ending == ".vrm";
    return is_gltf ? load_gltf(file) : load_obj(file);
}

}  // namespace rasterbook
