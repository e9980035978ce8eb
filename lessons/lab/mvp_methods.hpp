// SPDX-License-Identifier: MIT
/// @file
/// Other number types to compute the positions of lesson 04 in, and other ways to clip; measured in
/// docs/accuracy/04_mvp.md; and the scene without a camera.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <vector>

#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "04_mvp/instance.hpp"
#include "04_mvp/projection.hpp"
#include "common/app/lesson_app.hpp"
#include "common/app/orthographic_view.hpp"
#include "common/image/backdrop.hpp"

namespace rasterbook {

/// What positions are computed in, from world space to clip space.
enum class Precision { float32, relative, float64 };

/// What is clipped: all outside of six planes, all before the near plane, or nothing.
enum class Clipping { six_planes, near_plane, pixels };

/// What takes the world to the screen: the lesson's camera, or what lessons 01 to 03 have.
enum class View { camera, orthographic };

struct MvpMethod {
    Precision precision = Precision::float32;
    double offset = 0;  ///< Of scene and camera in the world, along each axis.
    Clipping clipping = Clipping::six_planes;
    View view = View::camera;

    bool operator==(const MvpMethod&) const = default;

    /// Whether nothing is clipped, and each pixel is asked.
    bool asks_pixels() const { return clipping == Clipping::pixels || view == View::orthographic; }

    void declare(OptionParser& parser) {
        parser.choice(
            "--precision", precision,
            {{"float", Precision::float32},
             {"relative", Precision::relative},
             {"double", Precision::float64}},
            "What positions in the world are computed in; relative subtracts the camera's "
            "position in double and goes on in float");
        parser.choice(
            "--offset", offset,
            {{"0", 0.0}, {"1000", 1e3}, {"100000", 1e5}, {"1000000", 1e6}, {"10000000", 1e7}},
            "Move scene and camera together so far along each axis");
        parser.choice("--clip", clipping,
                      {{"six", Clipping::six_planes},
                       {"near", Clipping::near_plane},
                       {"pixel", Clipping::pixels}},
                      "Clip triangles at all planes, at the near one, or ask each pixel instead");
        parser.choice("--view", view,
                      {{"camera", View::camera}, {"orthographic", View::orthographic}},
                      "By the camera, or by the orthographic projection of lesson 03, which stands "
                      "still and has no use for other options of the camera");
    }
};

/// Points of a world too large for float, in clip space: the camera's position is subtracted in
/// double, the rest is float.
///
/// @param clip_from_relative  For a camera at the origin.
inline std::vector<vec4> transform_relative(const mat4& clip_from_relative, dvec3 eye_world,
                                            const std::vector<dvec3>& positions_world) {
    std::vector<vec4> transformed;
    transformed.reserve(positions_world.size());
    for (const dvec3 position : positions_world)
        transformed.push_back(clip_from_relative * vec4(vec3(position - eye_world), 1));
    return transformed;
}

/// Points in clip space, computed in double and rounded at the end.
inline std::vector<vec4> transform_double(const dmat4& clip_from_world,
                                          const std::vector<dvec3>& positions_world) {
    std::vector<vec4> transformed;
    transformed.reserve(positions_world.size());
    for (const dvec3 position : positions_world)
        transformed.push_back(vec4(clip_from_world * dvec4(position, 1)));
    return transformed;
}

/// Points moved along each axis, computed in T.
template <typename T>
std::vector<glm::vec<3, T>> moved(const std::vector<vec3>& positions, T offset) {
    std::vector<glm::vec<3, T>> result;
    result.reserve(positions.size());
    for (const vec3 position : positions) result.push_back(glm::vec<3, T>(position) + offset);
    return result;
}

/// From the world to clip space, computed in T, for a camera that was moved but not turned.
template <typename T>
glm::mat<4, 4, T> clip_from_world_in(const Camera& camera, glm::vec<3, T> eye,
                                     glm::vec<3, T> center, ivec2 size) {
    const T aspect = static_cast<T>(size.x) / static_cast<T>(size.y);
    const mat4& view = camera.view_from_world;
    const glm::vec<3, T> up(view[0].y, view[1].y, view[2].y);  // its second row
    return perspective<T>(camera.fov_y_radians, aspect, camera.near) * look_at<T>(eye, center, up);
}

/// The points as the camera sees them, in clip space: transform(), or with camera and points moved
/// by the method's offset, computed as it says.
///
/// @param camera  Before the move.
inline std::vector<vec4> transform(const MvpMethod& method, const Camera& camera, ivec2 size,
                                   const std::vector<vec3>& positions) {
    const vec3 center = camera.center_world;
    if (method.precision == Precision::float32) {
        if (method.offset == 0) return transform(camera.clip_from_world(size), positions);
        const auto offset = static_cast<float>(method.offset);
        return transform(
            clip_from_world_in(camera, camera.position_world + offset, center + offset, size),
            moved(positions, offset));
    }
    const dvec3 eye = dvec3(camera.position_world) + method.offset;
    const dvec3 center_moved = dvec3(center) + method.offset;
    const std::vector<dvec3> positions_world = moved(positions, method.offset);
    if (method.precision == Precision::relative)
        return transform_relative(
            clip_from_world_in(camera, vec3(0), vec3(center_moved - eye), size), eye,
            positions_world);
    return transform_double(clip_from_world_in(camera, eye, center_moved, size), positions_world);
}

/// An instance in clip space: by one matrix where nothing else is asked for.
inline std::vector<vec4> transform(const MvpMethod& method, const Camera& camera, ivec2 size,
                                   const Instance& instance) {
    if (method.precision == Precision::float32 && method.offset == 0)
        return transform(camera.clip_from_world(size) * instance.world_from_model,
                         instance.mesh.positions);
    return transform(method, camera, size, positions_world(instance));
}

/// The points as lesson 03 has them on the screen, in clip space with a w of 1.
inline std::vector<vec4> transform(const OrthographicView& view, ivec2 size,
                                   const std::vector<vec3>& positions) {
    std::vector<vec4> transformed;
    transformed.reserve(positions.size());
    for (const vec3 screen : view.screen_from_model(positions))
        transformed.emplace_back(2 * screen.x / static_cast<float>(size.x) - 1,
                                 1 - 2 * screen.y / static_cast<float>(size.y), screen.z, 1);
    return transformed;
}

/// Nothing is cut off.
inline ClippedTriangle whole_triangle(const std::array<vec4, 3>& vertices) {
    return {{{vertices[0], {1, 0, 0}}, {vertices[1], {0, 1, 0}}, {vertices[2], {0, 0, 1}}}};
}

/// The part of a triangle beyond the near plane: of that, fill_triangle draws what lies in the
/// picture. A triangle that reaches too far for fill_triangle is clipped at all six planes.
///
/// @param vertices  Clip space of a perspective.
/// @param size     Of the picture, in pixels.
inline ClippedTriangles clip_near(const std::array<vec4, 3>& vertices, ivec2 size) {
    constexpr int near_plane = 4;
    // From the picture's middle, in halves of its size: a pixel less than fill_triangle takes.
    const vec2 guard = 2.0f * (coordinate_limit - 1.0f) / vec2(size) - 1.0f;
    const auto is_usable = [guard](vec4 p) {
        return std::abs(p.x) < guard.x * p.w && std::abs(p.y) < guard.y * p.w;
    };
    ClippedTriangles clipped;
    const auto are_all_outside = [&vertices](int plane) {
        return plane_distance(plane, vertices[0]) < 0 && plane_distance(plane, vertices[1]) < 0 &&
               plane_distance(plane, vertices[2]) < 0;
    };
    for (int plane = 0; plane < frustum_planes; ++plane)
        if (are_all_outside(plane)) return clipped;
    const ClippedTriangle whole = whole_triangle(vertices);
    std::array<ClippedVertex, 4> polygon;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const ClippedVertex &from = whole[i], &to = whole[i < 2 ? i + 1 : 0];
        const float from_by = plane_distance(near_plane, from.position_clip);
        const float to_by = plane_distance(near_plane, to.position_clip);
        if (from_by >= 0) polygon[count++] = from;
        if ((from_by >= 0) != (to_by >= 0)) polygon[count++] = crossing(from, from_by, to, to_by);
    }
    for (std::size_t i = 0; i < count; ++i)
        if (!is_usable(polygon[i].position_clip)) return clip_triangle(vertices);
    for (std::size_t i = 2; i < count; ++i) clipped.add({polygon[0], polygon[i - 1], polygon[i]});
    return clipped;
}

/// clip_triangle, or the method in its place.
inline ClippedTriangles clip(const MvpMethod& method, const std::array<vec4, 3>& vertices,
                             ivec2 size) {
    return method.clipping == Clipping::near_plane ? clip_near(vertices, size)
                                                   : clip_triangle(vertices);
}

/// for_each_visible_triangle of an instance, transformed and clipped as the method has it; backs
/// are culled.
template <typename Visit>
void for_each_visible_triangle(const MvpMethod& method, const Instance& instance,
                               const Camera& camera, ivec2 size, Visit&& visit) {
    count(Counter::meshes_in);
    const mat4 clip_from_model = camera.clip_from_world(size) * instance.world_from_model;
    count_undrawn_if_asked(instance.mesh, clip_from_model);
    if (is_outside_frustum(instance.mesh.bounds, clip_from_model)) {
        count(Counter::meshes_culled_by_frustum);
        return;
    }
    const std::vector<vec4> positions_clip = transform(method, camera, size, instance);
    for (const Triangle& triangle : instance.mesh.triangles) {
        count(Counter::triangles_in);
        for (const ClippedTriangle& clipped :
             clip(method, vertices_of(triangle, positions_clip), size)) {
            const ProjectedTriangle projected = project(instance.mesh, triangle, clipped, size);
            if (projected.is_back_facing)
                count(Counter::triangles_culled_by_facing);
            else
                visit(projected);
        }
    }
}

/// A triangle in clip space with vertices anywhere, also behind the camera: the planes through the
/// eye and its sides.
///
/// @see Olano and Greer, "Triangle scan conversion using 2D homogeneous coordinates", 1997
struct HomogeneousTriangle {
    std::array<dvec3, 3> planes;  ///< Opposite to each vertex; inside > 0 if it faces front.
    double volume;  ///< Six times, of the eye and the vertices' (x, y, w); > 0: front.

    explicit HomogeneousTriangle(const ClippedTriangle& triangle) {
        std::array<dvec3, 3> xyw;
        for (std::size_t i = 0; i < 3; ++i) {
            const vec4 p = triangle[i].position_clip;
            xyw[i] = {p.x, p.y, p.w};
        }
        // The products of floats are exact: triangles that share a side have the same plane there,
        // turned round.
        for (std::size_t i = 0; i < 3; ++i)
            planes[i] = glm::cross(xyw[(i + 1) % 3], xyw[(i + 2) % 3]);
        volume = glm::dot(xyw[0], planes[0]);
    }
};

/// Visits the pixels of a picture whose rays meet a triangle that is seen counter-clockwise,
/// beyond the near plane. A centre on a side belongs to the triangle of which this is
/// a left or a top side.
///
/// @param emit  Called as emit(ivec2 pixel, float depth).
template <std::invocable<ivec2, float> Emit>
void fill_homogeneous(const ClippedTriangle& triangle, ivec2 size, Emit&& emit) {
    const HomogeneousTriangle of(triangle);
    if (!(of.volume > 0)) return;
    // The box around the vertices, or the whole picture if one of them is not in front.
    dvec2 low(std::numeric_limits<double>::max()), high(-low);
    bool all_in_front = true, all_behind = true;
    for (const ClippedVertex& vertex : triangle) {
        const dvec4 p(vertex.position_clip);
        all_in_front &= p.w > 0;
        all_behind &= p.w <= 0;
        const dvec2 on_screen = (dvec2(p.x, -p.y) / p.w + 1.0) * 0.5 * dvec2(size);
        low = glm::min(low, on_screen), high = glm::max(high, on_screen);
    }
    if (all_behind) return;
    if (!all_in_front) low = dvec2(0), high = dvec2(size);
    const ivec2 first(glm::clamp(glm::floor(low - 0.5), dvec2(0), dvec2(size)));
    const ivec2 last(glm::clamp(glm::ceil(high - 0.5), dvec2(-1), dvec2(size) - 1.0));

    const dvec2 per_half = 1.0 / dvec2(size);  // NDC for half a pixel
    std::array<bool, 3> owned;
    for (std::size_t i = 0; i < 3; ++i)
        owned[i] = of.planes[i].x > 0 || (of.planes[i].x == 0 && of.planes[i].y < 0);
    const dvec3 z = dvec3(triangle[0].position_clip.z, triangle[1].position_clip.z,
                          triangle[2].position_clip.z) /
                    of.volume;
    for (int y = first.y; y <= last.y; ++y) {
        const double y_ndc = 1.0 - (2 * y + 1) * per_half.y;
        dvec3 row;
        for (int i = 0; i < 3; ++i) {
            const dvec3 plane = of.planes[static_cast<std::size_t>(i)];
            row[i] = plane.y * y_ndc + plane.z;
        }
        for (int x = first.x; x <= last.x; ++x) {
            const double x_ndc = (2 * x + 1) * per_half.x - 1.0;
            const dvec3 shares(of.planes[0].x * x_ndc + row[0], of.planes[1].x * x_ndc + row[1],
                               of.planes[2].x * x_ndc + row[2]);
            const auto is_inside = [&](int i) {
                return shares[i] > 0 || (shares[i] == 0 && owned[static_cast<std::size_t>(i)]);
            };
            if (!(is_inside(0) && is_inside(1) && is_inside(2))) continue;
            const double depth = glm::dot(shares, z);  // of shares that give w = 1
            if (0 <= depth && depth <= 1) emit(ivec2(x, y), static_cast<float>(depth));
        }
    }
}

/// The picture of a scene of which nothing is clipped: every pixel is asked.
template <typename Options>
Image<vec3> render_by_pixels(const Options& options, const Scene& scene,
                             const std::vector<Instance>& instances, const Camera& camera) {
    const OrthographicView orthographic(scene, options.size);
    Image<vec3> color = backdrop(options.size);
    DepthBuffer depth(options.size);
    for (const Instance& instance : instances) {
        const auto positions_clip =
            options.mvp.view == View::orthographic
                ? transform(orthographic, options.size, positions_world(instance))
                : transform(options.mvp, camera, options.size, instance);
        const mat3 normal_from_model = normal_matrix(mat3(instance.world_from_model));
        for (const Triangle& triangle : instance.mesh.triangles) {
            const vec3 normal = normal_from_model * flat_normal(instance.mesh, triangle);
            const vec3 face_color =
                flat_color(normalize_or(normal, vec3(0, 1, 0)), scene.materials[triangle.material]);
            fill_homogeneous(whole_triangle(vertices_of(triangle, positions_clip)), options.size,
                             [&](ivec2 pixel, float z) {
                                 count(Counter::fragments_tested);
                                 if (!depth.test_and_write(pixel, z)) return;
                                 count(Counter::fragments_shaded);
                                 color[pixel] = face_color;
                             });
        }
    }
    if (options.show_depth) return depth_picture(depth);
    return color;
}

}  // namespace rasterbook
