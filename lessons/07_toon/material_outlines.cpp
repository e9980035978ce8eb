// SPDX-License-Identifier: MIT
#include "07_toon/material_outlines.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "07_toon/outline.hpp"

namespace rasterbook {

namespace {

/// The material of a toon material's outline: unlit, of its colour.
Material outline_material(const Material& of) {
    Material material;
    material.name = "outline of " + of.name;
    material.illumination = 0;
    material.diffuse = material.ambient = of.toon->outline_color;
    return material;
}

}  // namespace

bool is_drawing(const Scene& scene) {
    bool has_outlines = false;
    for (const Mesh& mesh : scene.meshes)
        for (const Triangle& triangle : mesh.triangles) {
            const Material& material = scene.materials[triangle.material];
            if (!material.toon) return false;
            has_outlines = has_outlines || has_outline(material);
        }
    return has_outlines;
}

Scene with_outline_materials(Scene scene) {
    const std::size_t count = scene.materials.size();
    for (std::size_t i = 0; i < count; ++i)
        if (has_outline(scene.materials[i]))
            scene.materials.push_back(outline_material(scene.materials[i]));
    return scene;
}

std::size_t first_outline_material(std::span<const Material> materials) {
    return materials.size() -
           static_cast<std::size_t>(std::count_if(materials.begin(), materials.end(), has_outline));
}

std::vector<OutlineHull> outline_hulls(const Scene& scene) {
    constexpr std::uint32_t none = 0;  // they come last, behind the scene's own materials
    std::vector<std::uint32_t> outline_of(scene.materials.size(), none);
    for (std::size_t i = 0, next = first_outline_material(scene.materials);
         i < scene.materials.size(); ++i)
        if (has_outline(scene.materials[i])) outline_of[i] = static_cast<std::uint32_t>(next++);
    std::vector<OutlineHull> hulls;
    for (const Mesh& mesh : scene.meshes) {
        OutlineHull hull;
        hull.widths.assign(mesh.positions.size(), 0.0f);
        hull.on_screen.assign(mesh.positions.size(), false);
        for (const Triangle& triangle : mesh.triangles) {
            const std::uint32_t outline = outline_of[triangle.material];
            if (outline == none) continue;
            const auto& [a, b, c] = triangle.vertices;
            const Vertex p{a.position}, q{b.position}, r{c.position};
            hull.mesh.triangles.push_back({{p, r, q}, outline});
            const ToonMaterial& look = *scene.materials[triangle.material].toon;
            for (const Vertex vertex : {p, q, r}) {
                hull.widths[vertex.position] = look.outline_width;
                hull.on_screen[vertex.position] = look.outline == ToonMaterial::Outline::screen;
            }
        }
        if (hull.mesh.triangles.empty()) continue;
        hull.mesh.name = "outline of " + mesh.name;
        hull.mesh.positions = hull.places = mesh.positions;
        hull.normals = hull_normals(mesh);
        hulls.push_back(std::move(hull));
    }
    return hulls;
}

Mesh pushed(const OutlineHull& hull, const Camera& camera) {
    Mesh mesh = hull.mesh;
    const float height_per_distance =
        2 * static_cast<float>(std::tan(double{camera.fov_y_radians} / 2));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        float width = hull.widths[i];
        if (hull.on_screen[i]) {
            const vec3 seen(camera.view_from_world * vec4(hull.places[i], 1));
            width *= height_per_distance * std::max(-seen.z, 0.0f);
        }
        mesh.positions[i] = hull.places[i] + width * hull.normals[i];
        mesh.bounds.add(mesh.positions[i]);
    }
    return mesh;
}

}  // namespace rasterbook
