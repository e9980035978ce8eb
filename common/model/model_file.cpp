// SPDX-License-Identifier: MIT
#include "common/model/model_file.hpp"

#include <sstream>
#include <string>

#include <glm/geometric.hpp>

#include "common/image/file.hpp"
#include "common/image/input_error.hpp"
#include "common/model/gltf.hpp"
#include "common/model/obj.hpp"

namespace rasterbook {

namespace {

/// A picture of what is larger, or a thousand denormal steps and smaller, would be wrong: its
/// numbers overflow, or have hardly any digits. A scene of no size at all has no area to be drawn.
void check_size(const Scene& scene, const std::filesystem::path& file) {
    constexpr double least = 2.5e-42, most = 2.5e37;
    const Bounds bounds = scene.bounds();
    const double diagonal = glm::distance(dvec3(bounds.min), dvec3(bounds.max));
    if (diagonal == 0 || (diagonal >= least && diagonal <= most)) return;
    std::ostringstream what;
    what << "measures " << diagonal << " from corner to corner of its box: what can be drawn has "
         << least << " to " << most;
    throw InputError(file, what.str());
}

}  // namespace

Scene load_model(const std::filesystem::path& file, const LoadBudget& budget) {
    const std::string ending = ending_of(file);
    const bool is_gltf = ending == ".gltf" || ending == ".glb" || ending == ".vrm";
    Scene scene = is_gltf ? load_gltf(file, budget) : load_obj(file, budget);
    check_size(scene, file);
    scene.file = file;
    return scene;
}

}  // namespace rasterbook
