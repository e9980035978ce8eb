// SPDX-License-Identifier: MIT
#include "common/app/empty_picture.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

namespace rasterbook {

namespace {

/// The materials that triangles have and whose opacity is 0: ": material "glass" has opacity 0".
std::string names_of_clear_materials(const Scene& scene) {
    std::set<std::uint32_t> clear;
    for (const Mesh& mesh : scene.meshes)
        for (const Triangle& triangle : mesh.triangles)
            if (scene.materials[triangle.material].opacity == 0) clear.insert(triangle.material);
    if (clear.empty()) return "";
    const std::size_t others = clear.size() - 1;
    return " (material \"" + scene.materials[*clear.begin()].name + "\"" +
           (others > 0 ? " and " + std::to_string(others) + " more" : "") + ": opacity 0)";
}

}  // namespace

std::string why_empty(const Counters& counters, const Scene& scene, bool knows_area) {
    const auto count = [&](Counter counter) {
        return counters.values[static_cast<std::size_t>(counter)];
    };
    std::string reasons;
    const auto add = [&](std::uint64_t times, const std::string& thing, const std::string& why) {
        if (times > 0)
            reasons += (reasons.empty() ? "" : ", ") + std::to_string(times) + ' ' + thing +
                       (times > 1 ? "s " : " ") + why;
    };
    const auto add_triangles = [&](Counter counter, const std::string& why) {
        add(count(counter), "triangle", why);
    };
    add_triangles(Counter::triangles_behind_camera, "behind the camera");
    add_triangles(Counter::triangles_outside_view, "outside of the camera's view");
    add_triangles(Counter::triangles_overflowing, "too large or too far away for single precision");
    add_triangles(Counter::triangles_culled_by_facing,
                  knows_area ? "seen from behind (named clockwise?)"
                             : "seen from behind (named clockwise?) or without area");
    add_triangles(Counter::triangles_without_area, "without area on the screen");

    // In an empty picture, what is alpha tested fails, and what is blended is clear.
    const std::uint64_t shaded = count(Counter::fragments_shaded),
                        blended = count(Counter::blended_fragments),
                        holes = count(Counter::alpha_tested_fragments),
                        tested = std::max(count(Counter::fragments_tested), shaded + holes);
    add(holes, "fragment", "failed by the alpha test");
    add(blended, "fragment", "wholly transparent" + names_of_clear_materials(scene));
    add(shaded - blended, "fragment", "of the background's color");
    add(tested - shaded - holes, "fragment", "failed by the depth test");
    return reasons.empty() ? "its triangles cover no pixel's centre" : reasons;
}

}  // namespace rasterbook
