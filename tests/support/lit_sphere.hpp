// SPDX-License-Identifier: MIT
/// @file
/// A sphere lit by a point light: as a mesh, drawn by the stages of lesson 06, and as it really
/// looks, found in long double and with none of the course's functions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>

#include "02_triangle_fill/triangle.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/projection.hpp"
#include "05_textures/interpolation.hpp"
#include "06_phong/effects.hpp"
#include "06_phong/normals.hpp"
#include "06_phong/phong.hpp"
#include "common/math/types.hpp"
#include "common/model/mesh.hpp"
#include "lab/shading_methods.hpp"
#include "support/one_triangle.hpp"

namespace rasterbook::test {

/// A sphere of radius 1 around the origin, of rows from pole to pole, each of `columns` quads.
inline Mesh sphere_mesh(int rows, int columns) {
    Mesh mesh;
    for (int row = 0; row <= rows; ++row)
        for (int column = 0; column <= columns; ++column) {
            const double from_pole = std::numbers::pi * row / rows;
            const double around = 2 * std::numbers::pi * column / columns;
            mesh.positions.emplace_back(std::sin(from_pole) * std::sin(around), std::cos(from_pole),
                                        std::sin(from_pole) * std::cos(around));
            mesh.bounds.add(mesh.positions.back());
        }
    mesh.normals = mesh.positions;
    const auto vertex = [&](int row, int column) {
        const auto index = static_cast<std::uint32_t>(row * (columns + 1) + column);
        return Vertex{index, no_index, index};
    };
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const Vertex a = vertex(row, column), b = vertex(row + 1, column);
            const Vertex c = vertex(row + 1, column + 1), d = vertex(row, column + 1);
            if (row + 1 < rows) mesh.triangles.push_back({{a, b, c}, 0});
            if (row > 0) mesh.triangles.push_back({{a, c, d}, 0});
        }
    return mesh;
}

/// A grey sphere with a highlight, a point light and a camera that sees both.
struct LitSphere {
    static constexpr ivec2 size{512};
    static constexpr float diffuse = 0.6f, specular = 0.4f, shininess = 90;

    Scene scene;
    SurfaceTextures textures{MaterialTextures(1), MaterialTextures(1), MaterialTextures(1)};
    EffectMask effects = plan_effects(scene, textures, false)[0];
    Camera camera = orbit_camera({.distance = 2}, scene.bounds());
    std::array<Light, 1> lights{
        Light{LightKind::point, vec3(2), vec3(0), vec3(0.3f, 1.8f, 2.4f), 3.0f}};

    LitSphere(int rows, int columns) : scene(scene_of(sphere_mesh(rows, columns))) {
        complete_normals(scene);
    }

    const Mesh& mesh() const { return scene.meshes[0]; }

    LitTriangle lit(const ProjectedTriangle& projected, const ShadingMethod& variant) const {
        return {variant, lights, camera.position_world, scene, textures, effects, projected};
    }
    LitTriangle lit(const Triangle& triangle, const ShadingMethod& variant,
                    bool is_back = false) const {
        return lit(not_on_screen(mesh(), triangle, is_back), variant);
    }

    /// Draws the sphere as the lesson does, without a depth buffer: of a sphere, no front faces
    /// cover each other. Calls emit(pixel, light) for each fragment.
    template <typename Emit>
    void draw(const ShadingMethod& variant, Emit&& emit) const {
        for_each_visible_triangle(
            scene, camera.clip_from_world(size), size, Culling::back_faces,
            [&](const ProjectedTriangle& projected) {
                const LitTriangle triangle = lit(projected, variant);
                const PerspectiveSetup setup =
                    perspective_setup(projected.on_screen, projected.clipped);
                fill_triangle(projected.on_screen, size, [&](ivec2 pixel, Barycentrics on_screen) {
                    const Barycentrics here = perspective_correct(setup, on_screen).here;
                    emit(pixel, phong(triangle.surface().own_color, vec3(0), triangle.at(here)).x);
                });
            });
    }

  private:
    static Scene scene_of(Mesh mesh) {
        Material material;
        material.diffuse = vec3(diffuse), material.specular = vec3(specular);
        material.shininess = shininess;
        Scene scene;
        scene.materials.push_back(std::move(material));
        scene.meshes.push_back(std::move(mesh));
        return scene;
    }
};

/// The light that a pixel of LitSphere should have.
class ExactSphere {
  public:
    explicit ExactSphere(const LitSphere& sphere) {
        const Light& light = sphere.lights[0];
        half_distance_ = light.half_distance, color_ = light.color.x;
        eye_ = wide(sphere.camera.position_world), light_ = wide(light.position_world);
        const Vector forward = scaled(eye_, -1 / length(eye_));  // towards the origin
        const long double level = std::hypot(forward[0], forward[2]);
        right_ = {-forward[2] / level, 0, forward[0] / level};
        up_ = {-forward[1] * forward[0] / level, level, -forward[1] * forward[2] / level};
        forward_ = forward;
        half_height_ = std::tan(static_cast<long double>(sphere.camera.fov_y_radians) / 2);
    }

    /// @param normal,position  Of a surface in this light, seen by this camera; normal of length 1.
    long double light_at(const std::array<long double, 3>& normal,
                         const std::array<long double, 3>& position) const {
        const Vector to_light = sum(light_, scaled(position, -1));
        const long double distance = length(to_light);
        const long double cosine = dot(normal, to_light) / distance;
        if (cosine <= 0) return 0;
        const long double arrives =
            color_ / (1 + distance * distance / (half_distance_ * half_distance_));
        // Of the way to the eye, mirrored in the normal: the same cosine as of the mirrored
        // light's.
        const Vector to_eye = sum(eye_, scaled(position, -1));
        const Vector mirrored = sum(scaled(normal, 2 * dot(normal, to_eye)), scaled(to_eye, -1));
        const long double mirrored_cosine = dot(mirrored, to_light) / (distance * length(to_eye));
        const long double highlight =
            mirrored_cosine > 0 ? std::exp(LitSphere::shininess * std::log(mirrored_cosine)) : 0;
        return arrives * (LitSphere::diffuse * cosine + LitSphere::specular * highlight);
    }

    /// Nothing where the ray through the pixel's centre misses the sphere.
    std::optional<long double> light_in(ivec2 pixel) const {
        const auto ndc = [](int at, int size) { return (2.0L * at + 1) / size - 1; };
        const long double x = half_height_ * ndc(pixel.x, LitSphere::size.x);  // a square picture
        const long double y = -half_height_ * ndc(pixel.y, LitSphere::size.y);
        const Vector ray = sum(forward_, sum(scaled(right_, x), scaled(up_, y)));
        // |eye + t ray| = 1
        const long double a = dot(ray, ray), b = dot(ray, eye_), c = dot(eye_, eye_) - 1;
        if (b * b < a * c) return std::nullopt;
        const Vector hit = sum(eye_, scaled(ray, (-b - std::sqrt(b * b - a * c)) / a));
        return light_at(hit, hit);
    }

  private:
    using Vector = std::array<long double, 3>;

    static Vector wide(vec3 v) { return {v.x, v.y, v.z}; }
    static long double dot(const Vector& a, const Vector& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
    static long double length(const Vector& a) { return std::sqrt(dot(a, a)); }
    static Vector scaled(const Vector& a, long double s) { return {s * a[0], s * a[1], s * a[2]}; }
    static Vector sum(const Vector& a, const Vector& b) {
        return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
    }

    Vector eye_, light_, forward_, right_, up_;
    long double half_distance_, color_, half_height_;
};

/// How far a variant's picture is from the exact one, where both show the sphere; 1 is white.
struct LightErrors {
    double rms = 0, greatest = 0, fragments = 0, brightest = 0;
};

inline LightErrors light_errors(const LitSphere& sphere, const ShadingMethod& variant) {
    const ExactSphere exact(sphere);
    LightErrors errors;
    double sum_of_squares = 0, compared = 0;
    sphere.draw(variant, [&](ivec2 pixel, float light) {
        ++errors.fragments;
        const std::optional<long double> expected = exact.light_in(pixel);
        if (!expected) return;
        const double error = std::abs(static_cast<double>(light - *expected));
        errors.greatest = std::max(errors.greatest, error);
        errors.brightest = std::max(errors.brightest, static_cast<double>(*expected));
        sum_of_squares += error * error, ++compared;
    });
    errors.rms = std::sqrt(sum_of_squares / compared);
    return errors;
}

}  // namespace rasterbook::test
