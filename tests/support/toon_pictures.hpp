// SPDX-License-Identifier: MIT
/// @file
/// Pictures of lesson 07, and what is in them: paper, bodies and ink.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "support/lesson_07.hpp"
#include "support/pictures.hpp"

namespace rasterbook::test {

inline lesson_07::Options small_toon() {
    lesson_07::Options options;
    options.size = {320, 180};
    return options;
}

/// The picture before it is written, in light, and what was done to draw it.
inline Drawn drawn_toon(const Scene& scene, const lesson_07::Options& options) {
    return drawn(options, lesson_07::make_assets(scene, options),
                 [](auto&... arguments) { return lesson_07::render(arguments...); });
}
inline Image<vec3> toon_picture(const Scene& scene, const lesson_07::Options& options) {
    return lesson_07::render(options, lesson_07::make_assets(scene, options));
}

inline Scene scene_of_one(Mesh mesh) {
    Scene scene;
    scene.meshes.push_back(std::move(mesh));
    scene.materials.resize(1);
    return scene;
}

/// A cube around the origin, from -1 to 1, of 12 triangles.
///
/// @param is_shared  It has 8 positions; or else each face has 4 of its own.
inline Mesh cube_mesh(bool is_shared) {
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            vec3 out(0), u(0);
            out[axis] = side, u[(axis + 1) % 3] = 1;
            const vec3 v = glm::cross(out, u);
            std::uint32_t vertices[4];
            for (int i = 0; i < 4; ++i) {
                const vec3 place =
                    out + (i == 1 || i == 2 ? 1.0f : -1.0f) * u + (i >= 2 ? 1.0f : -1.0f) * v;
                auto found =
                    is_shared ? std::ranges::find(mesh.positions, place) : mesh.positions.end();
                vertices[i] = static_cast<std::uint32_t>(found - mesh.positions.begin());
                if (found == mesh.positions.end()) mesh.positions.push_back(place);
                mesh.bounds.add(place);
            }
            const auto triangle = [&](int a, int b, int c) {
                mesh.triangles.push_back(
                    {{Vertex{vertices[a]}, Vertex{vertices[b]}, Vertex{vertices[c]}}, 0});
            };
            triangle(0, 1, 2), triangle(0, 2, 3);
        }
    return mesh;
}

/// What is in a pixel: nothing, a body, or the outline.
enum class Seen : char { paper, body, ink };

inline Image<Seen> seen_in(const Image<vec3>& picture) {
    Image<Seen> seen(picture.size());
    for (std::size_t i = 0; i < picture.pixels().size(); ++i) {
        const vec3 color = picture.pixels()[i];
        seen.pixels()[i] = color == paper_color ? Seen::paper
                           : color == ink       ? Seen::ink
                                                : Seen::body;
    }
    return seen;
}

inline int count_of(const Image<Seen>& seen, Seen what) {
    return static_cast<int>(std::ranges::count(seen.pixels(), what));
}

/// How many pixels of bodies have paper among their eight neighbours: gaps of an outline.
inline int gaps_in_outline(const Image<Seen>& seen) {
    int gaps = 0;
    for (ivec2 p(1); p.y + 1 < seen.size().y; ++p.y)
        for (p.x = 1; p.x + 1 < seen.size().x; ++p.x) {
            if (seen[p] != Seen::body) continue;
            bool is_gap = false;
            for (int i = 0; i < 9; ++i)
                is_gap |= seen[p + ivec2(i % 3 - 1, i / 3 - 1)] == Seen::paper;
            gaps += is_gap;
        }
    return gaps;
}

}  // namespace rasterbook::test
