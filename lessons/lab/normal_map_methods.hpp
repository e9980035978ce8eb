// SPDX-License-Identifier: MIT
/// @file
/// Other places to compute the frames of lesson 08 in, and other ways to store normals; measured in
/// docs/accuracy/08_normal_maps.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "05_textures/interpolation.hpp"
#include "06_phong/face_normal.hpp"
#include "06_phong/load_surface_textures.hpp"
#include "06_phong/normals.hpp"
#include "08_normal_maps/assets.hpp"
#include "08_normal_maps/load_normal_maps.hpp"
#include "08_normal_maps/normal_map.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "08_normal_maps/tangent_frame.hpp"
#include "common/app/lesson_app.hpp"

namespace rasterbook {

/// Tangent and bitangent are those of the face, as they lie in it (Eq. 8.3); or tangents are
/// computed for its vertices, from all faces around them; or for each pixel, from the face's
/// tangent and the normal there.
enum class FrameOf { face, vertex, pixel };

/// The frames between vertices are made orthonormal, or are as they are interpolated.
enum class Orthonormal { at_pixels, at_vertices };

/// The bitangents of vertices and pixels point to where v grows; or as if no texture were mirrored.
enum class Handedness { of_uvs, ignored };

/// A map stores all of a normal, or x and y only.
enum class Channels { xyz, xy };

constexpr int bits_of_file = 0;  ///< For NormalMapMethod::bits: as the file has them.

/// How a file stores a component: UNORM, 0 to 1 (Eq. 8.1), unless the map's maker says otherwise;
/// or SNORM, -1 to 1, with the middle value added.
enum class NormalFormat { unorm, snorm };

/// A component of a normal, -1 to 1, of a SNORM value with the middle one added. That one, 128 of 8
/// bits, is exactly 0, the greatest exactly 1; the two least are -1.
///
/// @param value  0 to 2^bits - 1.
/// @param bits   2 to 16.
constexpr float component_from_snorm(std::uint32_t value, int bits = 8) {
    const float middle = static_cast<float>(1u << (bits - 1));
    return std::max(-1.0f, (static_cast<float>(value) - middle) / (middle - 1));
}

/// The nearest value of a component, -1 to 1: what an encoder stores.
///
/// @param bits  2 to 16.
inline std::uint32_t unorm_from_component(float component, int bits) {
    const float greatest = static_cast<float>((1u << bits) - 1);
    return static_cast<std::uint32_t>(std::floor((component + 1) / 2 * greatest + 0.5f));
}

/// A component, -1 to 1, as the nearest whole number of SNORM, with the middle value added.
inline std::uint32_t snorm_from_component(float component, int bits) {
    const float middle = static_cast<float>(1u << (bits - 1));
    return static_cast<std::uint32_t>(std::floor(middle + (middle - 1) * component + 0.5f));
}

/// Normals of SNORM values: (128, 128, 255) is (0, 0, 1) without error.
inline Image<vec4> normals_from_snorm(const Image<u8vec4>& image, Green green) {
    const float up = green == Green::up ? 1.0f : -1.0f;
    Image<vec4> normals(image.size());
    for (std::size_t i = 0; i < normals.pixels().size(); ++i) {
        const u8vec4 texel = image.pixels()[i];
        normals.pixels()[i] = {component_from_snorm(texel.r), up * component_from_snorm(texel.g),
                               component_from_snorm(texel.b), 1};
    }
    return normals;
}

struct NormalMapMethod {
    FrameOf frame = FrameOf::vertex;
    Orthonormal orthonormal = Orthonormal::at_pixels;
    Handedness handedness = Handedness::of_uvs;
    NormalFormat format = NormalFormat::unorm;
    Channels channels = Channels::xyz;
    int bits = bits_of_file;

    void declare(OptionParser& parser) {
        parser.choice(
            "--frame", frame,
            {{"face", FrameOf::face}, {"vertex", FrameOf::vertex}, {"pixel", FrameOf::pixel}},
            "Tangents are computed for a face, for its vertices, or for each pixel");
        parser.choice("--orthonormal", orthonormal,
                      {{"pixels", Orthonormal::at_pixels}, {"vertices", Orthonormal::at_vertices}},
                      "Frames are made orthonormal at each pixel, or only at the vertices");
        parser.choice("--handedness", handedness,
                      {{"uvs", Handedness::of_uvs}, {"ignored", Handedness::ignored}},
                      "Bitangents point to where v grows, or as if no texture were mirrored");
        parser.choice("--normal-format", format,
                      {{"unorm", NormalFormat::unorm}, {"snorm", NormalFormat::snorm}},
                      "Values 0 to 255 stand for -1 to 1, or 128 is 0 and 255 is 1");
        parser.choice("--channels", channels, {{"xyz", Channels::xyz}, {"xy", Channels::xy}},
                      "A map stores x, y and z, or z is computed from the other two");
        parser.choice("--bits", bits,
                      {{"4", 4}, {"5", 5}, {"6", 6}, {"8", 8}, {"file", bits_of_file}},
                      "Normals are stored with so many bits a component");
    }

    bool operator==(const NormalMapMethod&) const = default;

    /// The normals of a `norm`, to be sampled.
    Image<vec4> normals(const Image<u8vec4>& image, Green green = Green::up) const {
        return stored(format == NormalFormat::unorm ? normals_from_unorm(image, green)
                                                    : normals_from_snorm(image, green));
    }
    /// The normals of a `map_Bump`: from heights, or, where the image has colours, as of a `norm`.
    Image<vec4> normals_of_bumps(const Image<u8vec4>& image, WrapModes wrap,
                                 Green green = Green::up) const {
        return is_gray(image) ? stored(normals_from_heights(image, wrap)) : normals(image, green);
    }

  private:
    Image<vec4> stored(Image<vec4> normals) const {
        if (bits == bits_of_file && channels == Channels::xyz) return normals;
        for (vec4& normal : normals.pixels()) {
            vec3 n = unit_or(vec3(normal), vec3(0, 0, 1));
            if (bits != bits_of_file)
                for (int axis = 0; axis < 3; ++axis) n[axis] = quantised(n[axis]);
            normal = vec4(n, 1);
        }
        return normals;
    }
    float quantised(float component) const {
        return format == NormalFormat::unorm
                   ? component_from_unorm(unorm_from_component(component, bits), bits)
                   : component_from_snorm(snorm_from_component(component, bits), bits);
    }
};

/// What load_normal_maps() is given: a method's normals.
struct NormalsBy {
    const NormalMapMethod& method;
    Green green;

    Image<vec4> normals(const Image<u8vec4>& image) const { return method.normals(image, green); }
    Image<vec4> normals_of_bumps(const Image<u8vec4>& image, WrapModes wrap) const {
        return method.normals_of_bumps(image, wrap, green);
    }
};

/// Gives tangents to the meshes, if the method has those of vertices.
inline void make_tangents(const NormalMapMethod& method, Scene& scene, const NormalMaps& maps) {
    if (method.frame == FrameOf::vertex) make_tangents(scene, maps);
}

/// Reads a scene's textures and normal maps, and makes frames, as the method has them.
///
/// @throws InputError  When an image cannot be read.
inline NormalMapAssets load_normal_map_scene(const NormalMapMethod& method, Scene scene,
                                             const NormalMapSceneOptions& options) {
    const bool all_effects = options.shading.all_effects;
    complete_normals(scene);
    SurfaceTextures textures = load_surface_textures(scene, options.texture);
    NormalMaps maps = load_normal_maps(scene, options.texture, options.normal_map.space,
                                       all_effects, NormalsBy{method, options.normal_map.green});
    make_tangents(method, scene, maps);
    if (all_effects) add_neutral_inputs(scene, textures);
    auto effects = plan_effects(scene, textures, maps, all_effects);
    return {std::move(scene), std::move(textures), std::move(maps), std::move(effects)};
}

/// A triangle's normal map, with what other methods have of its face.
struct NormalMapOf : TriangleNormalMap {
    TangentBasis<float> face{};  ///< For FrameOf::face: as Eq. 8.3 finds it.
};

/// @param scene  With tangents, as make_tangents() leaves them.
inline NormalMapOf triangle_normal_map(const NormalMapMethod& method, const Scene& scene,
                                       const NormalMaps& maps, const ProjectedTriangle& projected) {
    NormalMapOf map{normal_map_inputs(scene, maps, projected)};
    if (map.texture == nullptr || map.space == MapSpace::object) return map;
    if (method.frame == FrameOf::vertex) {
        map = {triangle_normal_map(scene, maps, projected)};
    } else {
        const std::vector<vec3>& positions = projected.mesh.positions;
        const std::array<Vertex, 3>& indices = projected.triangle.vertices;
        const UvDirections directions =
            uv_directions({positions[indices[0].position], positions[indices[1].position],
                           positions[indices[2].position]},
                          map.uvs);
        map.tangents.fill(map.side * directions.tangent);
        map.face = {map.side * directions.tangent, map.side * directions.bitangent,
                    map.side * face_normal(projected.mesh, projected.triangle)};
        map.handedness = map.side * (directions.handedness < 0 ? -1.0f : 1.0f);
    }
    if (method.handedness == Handedness::ignored) map.handedness = map.side;
    return map;
}

/// The frame in a fragment, as the method has it.
inline TangentBasis<float> frame_at(const NormalMapMethod& method, const NormalMapOf& map,
                                    Barycentrics at, vec3 normal) {
    if (method.frame == FrameOf::face)
        return {map.face.tangent, map.face.bitangent, unit_or(normal, map.face.normal)};
    if (method.frame == FrameOf::vertex && method.orthonormal == Orthonormal::at_vertices) {
        const vec3 tangent = interpolate(map.tangents, at);
        return {tangent, map.handedness * glm::cross(normal, tangent), normal};
    }
    return frame_at(map, at, normal);
}

/// A fragment's normal, perturbed by the map.
///
/// @param normal  Interpolated, not yet scaled.
/// @return        Of any length.
inline vec3 normal_mapped(const NormalMapMethod& method, const NormalMapOf& map,
                          const FragmentBarycentrics& at, vec3 normal, Filter filter) {
    if (map.texture == nullptr) return normal;
    count(Counter::normal_map_samples);
    trace("normal, interpolated", normal, "Eq. 5.1");
    label_sample("normal map");
    vec3 in_map = sample_normal(*map.texture, filter, fragment_uv(map.uvs, at));
    trace("  normal of the map", in_map, "Eq. 8.1");
    if (method.channels == Channels::xy) in_map = with_z(vec2(in_map));
    if (map.space == MapSpace::object) return map.side * in_map;
    if (map.bump_multiplier != 1) in_map.x *= map.bump_multiplier, in_map.y *= map.bump_multiplier;
    const TangentBasis<float> frame = frame_at(method, map, at.here, normal);
    if (is_traced()) note_perturbed(frame, in_map, normal);
    return perturbed(frame, in_map, normal);
}

}  // namespace rasterbook
