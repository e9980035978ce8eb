// SPDX-License-Identifier: MIT
/// @file
/// A torus with bumps: as a mesh with a normal map, drawn by the stages of lesson 08, and its exact
/// normals, found in long double and with none of the course's functions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <utility>

#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/projection.hpp"
#include "05_textures/interpolation.hpp"
#include "06_phong/normals.hpp"
#include "06_phong/surface.hpp"
#include "08_normal_maps/load_normal_maps.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "common/math/types.hpp"
#include "common/model/mesh.hpp"
#include "lab/normal_map_methods.hpp"

namespace rasterbook::test {

/// The surface itself. u runs around the axis, v around the tube; both from 0 to 1.
struct TrueTorus {
    using real = long double;
    using lvec3 = glm::vec<3, real>;

    static constexpr real great_radius = 1, tube_radius = 0.45L;
    static constexpr real bump = 0.02L;  ///< From the mean height to the highest.
    static constexpr int bumps_around = 24, bumps_across = 10;

    /// At a point: the directions in which u and v grow, and the normal; each of length 1.
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

/// As a mesh of quads, smooth, with the exact normals of the smooth torus at its vertices.
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
    const auto vertex = [&](int i, int k) {
        const auto index = static_cast<std::uint32_t>(i * (across + 1) + k);
        return Vertex{index, index, index};
    };
    for (int i = 0; i < around; ++i)
        for (int k = 0; k < across; ++k) {
            const Vertex a = vertex(i, k), b = vertex(i + 1, k), c = vertex(i + 1, k + 1),
                         d = vertex(i, k + 1);
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
struct NormalMappedTorus {
    static constexpr ivec2 map_size{2048, 1024};
    static constexpr ivec2 size{416, 300};

    NormalMapMethod method;
    Scene scene;
    NormalMaps maps;
    Camera camera =
        orbit_camera({.yaw_degrees = 0, .pitch_degrees = 42, .distance = 1.95f}, scene.bounds());

    NormalMappedTorus(int around, int across, const NormalMapMethod& how = {})
        : method(how), scene(scene_of(torus_mesh(around, across))), maps(exact_map()) {
        complete_normals(scene);
        make_tangents(method, scene, maps);
    }

    /// Draws the torus as the lesson does up to its normals; no light is computed. Calls
    /// emit(pixel, normal, uv) for each fragment; the normal is of any length.
    template <typename Emit>
    void draw(Emit&& emit) const {
        DepthBuffer depth(size);
        const SurfaceTextures no_textures{MaterialTextures(1), MaterialTextures(1),
                                          MaterialTextures(1)};
        const auto draw_triangle = [&](const ProjectedTriangle& projected) {
            const TriangleSurface surface = triangle_surface(scene, no_textures, {}, projected);
            const PerspectiveSetup setup =
                perspective_setup(projected.on_screen, projected.clipped);
            const NormalMapOf map = triangle_normal_map(method, scene, maps, projected);
            fill_triangle(projected.on_screen, size, [&](ivec2 pixel, Barycentrics on_screen) {
                if (!depth.test_and_write(pixel, projected.depth.at(on_screen))) return;
                const FragmentBarycentrics at = perspective_correct(setup, on_screen);
                const vec3 normal = interpolate(surface.normals_world, at.here);
                emit(pixel, normal_mapped(method, map, at, normal, Filter::bilinear),
                     interpolate(map.uvs, at.here));
            });
        };
        for_each_visible_triangle(scene, camera.clip_from_world(size), size, Culling::back_faces,
                                  draw_triangle);
    }

  private:
    /// Not of a file: the steps of 8-bit codes are measured elsewhere.
    static NormalMaps exact_map() {
        static const auto map =
            std::make_shared<Texture>(make_texture(torus_map(map_size), Wrap::repeat));
        return {{map}, {MapSpace::tangent}};
    }

    static Scene scene_of(Mesh mesh) {
        Scene scene;
        scene.materials.resize(1);
        scene.meshes.push_back(std::move(mesh));
        return scene;
    }
};

/// The errors of the normals, over all fragments that are drawn.
struct NormalErrors {
    double fragments = 0;
    double rms = 0, greatest = 0;  ///< Degrees.
};

inline NormalErrors normal_errors(const NormalMappedTorus& torus) {
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
