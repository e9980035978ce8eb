// SPDX-License-Identifier: MIT
/// @file
/// A torus with bumps: as a mesh with a normal map, drawn by the stages of lesson 08, and its true
/// normals, found in long double and with none of the course's functions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "05_textures/interpolation.hpp"
#include "06_phong/fragments.hpp"
#include "06_phong/shading_variants.hpp"
#include "08_normal_maps/bumpy_scene.hpp"
#include "common/math/types.hpp"
#include "common/mesh.hpp"

namespace rasterbook::test {

/// The surface itself. u leads around the axis, v around the tube; both from 0 to 1.
struct TrueTorus {
    using real = long double;
    using lvec3 = glm::vec<3, real>;

    static constexpr real great_radius = 1, tube_radius = 0.45L;
    static constexpr real bump = 0.02L;  ///< From the mean height to the highest.
    static constexpr int bumps_around = 24, bumps_across = 10;

    /// Around a place: which way u and v lead, and out; each of length 1.
    struct Frame {
        lvec3 tangent, bitangent, normal;
    };

    static lvec3 position(real u, real v) {
        const real a = tau * u, b = tau * v;
        const real from_axis = great_radius + tube_radius * std::cos(b);
        return {from_axis * std::sin(a), tube_radius * std::sin(b), from_axis * std::cos(a)};
    }
    static Frame frame(real u, real v) {
        const real a = tau * u, b = tau * v;
        return {{std::cos(a), 0, -std::sin(a)},
                {-std::sin(b) * std::sin(a), std::cos(b), -std::sin(b) * std::cos(a)},
                {std::cos(b) * std::sin(a), std::sin(b), std::cos(b) * std::cos(a)}};
    }
    /// The normal of the surface with its bumps, in the frame: length 1.
    static lvec3 in_frame(real u, real v) {
        const real a = tau * u, b = tau * v;
        const real height = bump * std::sin(bumps_around * a) * std::sin(bumps_across * b);
        const real per_a =
            bump * bumps_around * std::cos(bumps_around * a) * std::sin(bumps_across * b);
        const real per_b =
            bump * bumps_across * std::sin(bumps_around * a) * std::cos(bumps_across * b);
        // The bumpy surface's derivatives are (along_a, 0, per_a) and (0, along_b, per_b); the
        // normal is their cross product.
        const real along_a = great_radius + (tube_radius + height) * std::cos(b);
        const real along_b = tube_radius + height;
        const lvec3 n(-per_a * along_b, -per_b * along_a, along_a * along_b);
        return n / std::sqrt(glm::dot(n, n));
    }
    /// The same in the model's space.
    static lvec3 normal(real u, real v) {
        const auto [tangent, bitangent, out] = frame(u, v);
        const lvec3 n = in_frame(u, v);
        return n.x * tangent + n.y * bitangent + n.z * out;
    }

  private:
    static constexpr real tau = 2 * std::numbers::pi_v<real>;
};

inline long double degrees_off(vec3 found, TrueTorus::lvec3 exact) {
    const TrueTorus::lvec3 f(found.x, found.y, found.z), across = glm::cross(f, exact);
    return std::atan2(std::sqrt(glm::dot(across, across)), glm::dot(f, exact)) * 180 /
           std::numbers::pi_v<long double>;
}

/// As a mesh of quads, smooth, with the true normals of the smooth torus at its corners.
inline Mesh torus_mesh(int around, int across) {
    Mesh mesh;
    for (int i = 0; i <= around; ++i)
        for (int k = 0; k <= across; ++k) {
            const vec2 uv(static_cast<float>(i) / static_cast<float>(around),
                          static_cast<float>(k) / static_cast<float>(across));
            mesh.positions.push_back(vec3(TrueTorus::position(uv.x, uv.y)));
            mesh.normals.push_back(vec3(TrueTorus::frame(uv.x, uv.y).normal));
            mesh.uvs.push_back(uv);
            mesh.bounds.add(mesh.positions.back());
        }
    const auto corner = [&](int i, int k) {
        const auto index = static_cast<std::uint32_t>(i * (across + 1) + k);
        return Corner{index, index, index};
    };
    for (int i = 0; i < around; ++i)
        for (int k = 0; k < across; ++k) {
            const Corner a = corner(i, k), b = corner(i + 1, k), c = corner(i + 1, k + 1),
                         d = corner(i, k + 1);
            mesh.triangles.push_back({{a, b, c}, 0});
            mesh.triangles.push_back({{a, c, d}, 0});
        }
    return mesh;
}

/// The torus's normal map, exact in each texel but for the rounding to float.
inline Image<vec4> torus_map(ivec2 size) {
    Image<vec4> map(size);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            map[{x, y}] =
                vec4(vec3(TrueTorus::in_frame((x + 0.5L) / size.x, 1 - (y + 0.5L) / size.y)), 1);
    return map;
}

/// A torus, and a camera that sees it.
struct BumpyTorus {
    struct Options {
        TextureOptions texture;
        LightOptions shading{.all_effects = true};  // so that its mesh is given tangents
        NormalMapVariant normal_map;
    };

    static constexpr ivec2 map_size{2048, 1024};
    static constexpr ivec2 size{416, 300};

    NormalMapVariant variant;
    BumpyScene scene;
    Camera camera =
        orbit_camera({.yaw_degrees = 0, .pitch_degrees = 42, .distance = 1.95f}, scene.bounds());

    BumpyTorus(int around, int across, const NormalMapVariant& how = {})
        : variant(how), scene(scene_of(torus_mesh(around, across)), options_for(how)) {
        // The codes' steps are another matter: all are drawn with this map.
        static const auto map =
            std::make_shared<Texture>(make_texture(torus_map(map_size), Wrap::repeat));
        scene.normal_textures[0] = map;
    }

    const Mesh& mesh() const { return scene.meshes[0]; }

    /// Draws the torus as the lesson does up to its normals; no light is computed. Calls
    /// emit(pixel, normal, uv) for each fragment; the normal is of any length.
    template <typename Emit>
    void draw(Emit&& emit) const {
        NoCounters counters;
        DepthBuffer depth(size);
        const std::vector<vec4> positions_clip =
            transform(camera.clip_from_world(size), mesh().positions);
        for (const Triangle& triangle : mesh().triangles) {
            const std::array<vec2, 3> uvs{mesh().uvs[triangle.corners[0].uv],
                                          mesh().uvs[triangle.corners[1].uv],
                                          mesh().uvs[triangle.corners[2].uv]};
            for (const ClippedTriangle& clipped :
                 clip_triangle(corners_of(triangle, positions_clip))) {
                const vec3 a = screen_from_clip(clipped[0].position_clip, size);
                const vec3 b = screen_from_clip(clipped[1].position_clip, size);
                const vec3 c = screen_from_clip(clipped[2].position_clip, size);
                const ScreenTriangle on_screen = snap_triangle(a, b, c);
                if (!is_front_facing(on_screen)) continue;
                const TriangleDepth triangle_depth(vec3(a.z, b.z, c.z));
                const PerspectiveWeights perspective(on_screen, clipped);
                const TriangleSurface surface(scene, mesh(), triangle);
                const TriangleRelief relief(variant, scene, mesh(), triangle, false);
                const TriangleLight light({}, {}, camera.position_world, mesh(), triangle, false,
                                          surface);
                const auto shade = [&](const ManyFragments& fragments) {
                    const ManyWeights weights = weights_of(fragments, perspective);
                    BumpyPoints points;
                    light.add(weights, points, counters);
                    relief.add(weights, Filter::bilinear, points, counters);
                    relief.tilt(points);
                    for (std::size_t i = 0; i < fragments.count; ++i)
                        emit(fragments.pixels[i], points.normal_world[i],
                             interpolate(uvs, weights.here[i]));
                };
                Fragments visible(shade);
                fill_triangle(on_screen, size, [&](ivec2 pixel, vec3 screen_weights) {
                    if (depth.test_and_write(pixel, triangle_depth.at(screen_weights)))
                        visible.add(pixel, screen_weights);
                });
                visible.finish();
            }
        }
    }

  private:
    static Options options_for(const NormalMapVariant& how) {
        Options options;
        options.normal_map = how;
        return options;
    }

    static Scene scene_of(Mesh mesh) {
        Scene scene;
        scene.materials.resize(1);
        scene.meshes.push_back(std::move(mesh));
        return scene;
    }
};

/// How far normals are off those of the true torus, of the fragments that are drawn.
struct NormalErrors {
    double fragments = 0;
    double rms = 0, greatest = 0;  ///< Degrees.
};

inline NormalErrors normal_errors(const BumpyTorus& torus) {
    NormalErrors errors;
    long double squares = 0, greatest = 0;
    torus.draw([&](ivec2, vec3 normal, vec2 uv) {
        const long double off = degrees_off(normal, TrueTorus::normal(uv.x, uv.y));
        squares += off * off, greatest = std::max(greatest, off);
        ++errors.fragments;
    });
    errors.rms = static_cast<double>(std::sqrt(squares / errors.fragments));
    errors.greatest = static_cast<double>(greatest);
    return errors;
}

}  // namespace rasterbook::test
