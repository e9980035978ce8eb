// SPDX-License-Identifier: MIT
/// @file
/// Pictures of lesson 07, and what is in them: paper, bodies and ink.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

// All that the lesson's main.cpp includes, so that it can be included within a namespace.
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "05_textures/bands.hpp"
#include "05_textures/textured_scene.hpp"
#include "06_phong/fragments.hpp"
#include "06_phong/lit_scene.hpp"
#include "07_toon/toon_variants.hpp"
#include "common/backdrop.hpp"
#include "common/lesson_app.hpp"

namespace lesson {
#define main inline main_of_lesson  // in several files of one program
#include "07_toon/main.cpp"
#undef main
}  // namespace lesson

namespace rasterbook::test {

inline const std::filesystem::path models = std::filesystem::path(RASTERBOOK_ASSETS) / "models";

inline lesson::Options small_toon() {
    lesson::Options options;
    options.size = {320, 180};
    return options;
}

/// The picture before it is written, in light.
template <typename CounterPolicy>
Image<vec3> toon_picture(const Scene& scene, const lesson::Options& options,
                         CounterPolicy& counters) {
    return lesson::render(options, ToonScene(scene, options), counters);
}
inline Image<vec3> toon_picture(const Scene& scene, const lesson::Options& options) {
    NoCounters none;
    return toon_picture(scene, options, none);
}

inline std::uint64_t count(const Counters& counters, Counter counter) {
    return counters.values[static_cast<std::size_t>(counter)];
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
            std::uint32_t corners[4];
            for (int i = 0; i < 4; ++i) {
                const vec3 place =
                    out + (i == 1 || i == 2 ? 1.0f : -1.0f) * u + (i >= 2 ? 1.0f : -1.0f) * v;
                auto found =
                    is_shared ? std::ranges::find(mesh.positions, place) : mesh.positions.end();
                corners[i] = static_cast<std::uint32_t>(found - mesh.positions.begin());
                if (found == mesh.positions.end()) mesh.positions.push_back(place);
                mesh.bounds.add(place);
            }
            const auto triangle = [&](int a, int b, int c) {
                mesh.triangles.push_back(
                    {{Corner{corners[a]}, Corner{corners[b]}, Corner{corners[c]}}, 0});
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
