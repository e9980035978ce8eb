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
    explicit ExactSphere(const LitSphere& sphere)
        : eye_(sphere.camera.position_world),
          light_(sphere.lights[0].position_world),
          half_distance_(sphere.lights[0].half_distance),
          color_(sphere.lights[0].color.x),
          half_height_(std::tan(static_cast<real>(sphere.camera.fov_y_radians) / 2)) {
        forward_ = -eye_ / length(eye_);  // towards the origin
        const real level = std::hypot(forward_.x, forward_.z);
        right_ = Vector(-forward_.z, 0, forward_.x) / level;
        up_ = glm::cross(right_, forward_);
    }

    /// @param normal_of,place_of  Of a surface in this light, seen by this camera: three numbers
    ///                            each; the normal of length 1.
    template <typename Numbers>
    long double light_at(const Numbers& normal_of, const Numbers& place_of) const {
        const Vector normal(normal_of[0], normal_of[1], normal_of[2]);
        const Vector position(place_of[0], place_of[1], place_of[2]);
        const Vector to_light = light_ - position, to_eye = eye_ - position;
        const real distance = length(to_light), cosine = glm::dot(normal, to_light) / distance;
        if (cosine <= 0) return 0;
        const real arrives = color_ / (1 + distance * distance / (half_distance_ * half_distance_));
        // Of the way to the eye, mirrored in the normal: the same cosine as of the mirrored
        // light's.
        const Vector mirrored = 2 * glm::dot(normal, to_eye) * normal - to_eye;
        const real mirrored_cosine = glm::dot(mirrored, to_light) / (distance * length(to_eye));
        const real highlight =
            mirrored_cosine > 0 ? std::exp(LitSphere::shininess * std::log(mirrored_cosine)) : 0;
        return arrives * (LitSphere::diffuse * cosine + LitSphere::specular * highlight);
    }

    /// Nothing where the ray through the pixel's centre misses the sphere.
    std::optional<long double> light_in(ivec2 pixel) const {
        const auto ndc = [](int at, int size) { return (2.0L * at + 1) / size - 1; };
        const real x = half_height_ * ndc(pixel.x, LitSphere::size.x);  // a square picture
        const real y = -half_height_ * ndc(pixel.y, LitSphere::size.y);
        const Vector ray = forward_ + x * right_ + y * up_;
        // |eye + t ray| = 1
        const real a = glm::dot(ray, ray), b = glm::dot(ray, eye_), c = glm::dot(eye_, eye_) - 1;
        if (b * b < a * c) return std::nullopt;
        const Vector hit = eye_ + (-b - std::sqrt(b * b - a * c)) / a * ray;
        return light_at(hit, hit);
    }

  private:
    using real = long double;
    using Vector = glm::vec<3, real>;

    static real length(const Vector& v) { return std::sqrt(glm::dot(v, v)); }

    Vector eye_, light_, forward_, right_, up_;
    real half_distance_, color_, half_height_;
};

/// How far a variant's picture is from the exact one, where both show the sphere; 1 is white.
struct LightErrors {
    double rms = 0, greatest = 0, fragments = 0;
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
        sum_of_squares += error * error, ++compared;
    });
    errors.rms = std::sqrt(sum_of_squares / compared);
    return errors;
}

}  // namespace rasterbook::test
