// SPDX-License-Identifier: MIT
#include "common/app/empty_picture.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <vector>

#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

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

/// An area with the sign that a triangle's has on the screen, where y points down: > 0 if it is
/// seen counter-clockwise; 0 if it has none when its vertices are snapped to 1/256 pixel.
double area_on_screen(const std::array<vec4, 3>& at) {
    const auto snapped = [](vec4 p) {
        constexpr double steps = 512 * 256;  // of half a picture that is 1024 pixels wide
        return dvec3(glm::round(steps / p.w * dvec2(p)), 1);
    };
    const bool is_in_front = std::ranges::all_of(at, [](vec4 p) { return p.w > 0; });
    const auto vertex = [&](std::size_t i) {
        return is_in_front ? snapped(at[i]) : dvec3(at[i].x, at[i].y, at[i].w);
    };
    return glm::determinant(dmat3(vertex(0), vertex(1), vertex(2)));
}

}  // namespace

void count_undrawn(const Mesh& mesh, const mat4& clip_from_model, UndrawnTriangles& undrawn) {
    constexpr float clip_limit = 0x1p125f;  // of lesson 04
    for (const Triangle& triangle : mesh.triangles) {
        std::array<vec4, 3> at;
        for (std::size_t i = 0; i < 3; ++i)
            at[i] = clip_from_model * vec4(mesh.positions[triangle.vertices[i].position], 1);
        const auto all = [&](auto&& holds) { return std::ranges::all_of(at, holds); };
        const auto all_beyond = [&](int axis) {
            return all([&](vec4 p) { return p[axis] > p.w; }) ||
                   all([&](vec4 p) { return p[axis] < (axis < 2 ? -p.w : 0); });
        };
        if (!all([](vec4 p) { return glm::all(glm::lessThan(glm::abs(p), vec4(clip_limit))); }))
            ++undrawn.overflowing;
        else if (all([](vec4 p) { return p.w <= 0; }))
            ++undrawn.behind_camera;
        else if (all_beyond(0) || all_beyond(1) || all_beyond(2))
            ++undrawn.outside_view;
        else if (const double area = area_on_screen(at); area <= 0)
            ++(area == 0 ? undrawn.without_area : undrawn.facing_away);
    }
}

std::string why_empty(const Counters& counters, const UndrawnTriangles& undrawn,
                      const Scene& scene) {
    std::string reasons;
    const auto add = [&](std::uint64_t times, const std::string& thing, const std::string& why) {
        if (times > 0)
            reasons += (reasons.empty() ? "" : ", ") + std::to_string(times) + ' ' + thing +
                       (times > 1 ? "s " : " ") + why;
    };
    add(undrawn.behind_camera, "triangle", "behind the camera");
    add(undrawn.outside_view, "triangle", "outside of the camera's view");
    add(undrawn.overflowing, "triangle", "too large or too far away for single precision");
    const std::uint64_t culled = counters[Counter::triangles_culled_by_facing];
    if (culled > 0)  // else both sides are drawn
        add(undrawn.facing_away, "triangle", "seen from behind (named clockwise?)");
    add(undrawn.without_area, "triangle", "without area on the screen");

    // In an empty picture, what is alpha tested fails, what is blended is clear, and a fragment
    // fails the depth test only where it is not nearer than what the buffer is cleared to.
    const std::uint64_t shaded = counters[Counter::fragments_shaded],
                        blended = counters[Counter::blended_fragments],
                        holes = counters[Counter::alpha_tested_fragments],
                        tested = std::max(counters[Counter::fragments_tested], shaded + holes);
    add(holes, "fragment", "failed by the alpha test");
    add(blended, "fragment", "wholly transparent" + names_of_clear_materials(scene));
    add(shaded - blended, "fragment", "of the background's color");
    add(tested - shaded - holes, "fragment", "beyond the camera's far plane");
    if (reasons.empty())  // else they are pieces without area, which clipping left
        add(culled, "triangle", "seen from behind (named clockwise?) or without area");
    return reasons.empty() ? "its triangles cover no pixel's centre" : reasons;
}

}  // namespace rasterbook
