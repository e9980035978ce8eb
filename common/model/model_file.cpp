// SPDX-License-Identifier: MIT
#include "common/model/model_file.hpp"

#include <string>

#include "common/image/file.hpp"
#include "common/model/gltf.hpp"
#include "common/model/obj.hpp"

namespace rasterbook {

Scene load_model(const std::filesystem::path& file, const LoadBudget& budget) {
    const std::string ending = ending_of(file);
    const bool is_gltf = ending == ".gltf" || ending == ".glb" || ending == ".vrm";
    Scene scene = is_gltf ? load_gltf(file, budget) : load_obj(file, budget);
    scene.file = file;
    return scene;
}

}  // namespace rasterbook
