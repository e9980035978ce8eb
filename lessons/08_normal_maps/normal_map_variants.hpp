// SPDX-License-Identifier: MIT
/// @file
/// Where frames are computed and how exactly, and how normals are stored, to be seen with
/// `--frame`, `--orthonormal`, `--normal-format`, `--channels` and `--bits`, and measured in
/// docs/accuracy/08_normal_maps.md; and what a map's normals mean: `--normal-map`, `--green`,
/// `--handedness`.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "08_normal_maps/normal_map.hpp"
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

/// What `norm` names: normals in tangent space, or in the model's space; or neither `norm` nor
/// `map_Bump` is read.
enum class MapSpace { tangent, object, none };

/// A map stores all of a normal, or x and y only.
enum class Channels { xyz, xy };

constexpr int bits_of_file = 0;  ///< For NormalMapVariant::bits: as the file has them.

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

/// normals_from_unorm() of SNORM values: (128, 128, 255) is (0, 0, 1) without error.
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

struct NormalMapVariant {
    FrameOf frame = FrameOf::vertex;
    Orthonormal orthonormal = Orthonormal::at_pixels;
    Handedness handedness = Handedness::of_uvs;
    MapSpace space = MapSpace::tangent;
    Green green = Green::up;
    NormalFormat format = NormalFormat::unorm;
    Channels channels = Channels::xyz;
    int bits = bits_of_file;

    void declare(Knobs& knobs) {
        knobs.choice(
            "--frame", frame,
            {{"face", FrameOf::face}, {"vertex", FrameOf::vertex}, {"pixel", FrameOf::pixel}},
            "Tangents are computed for a face, for its vertices, or for each pixel");
        knobs.choice("--orthonormal", orthonormal,
                     {{"pixels", Orthonormal::at_pixels}, {"vertices", Orthonormal::at_vertices}},
                     "Frames are made orthonormal at each pixel, or only at the vertices");
        knobs.choice("--handedness", handedness,
                     {{"uvs", Handedness::of_uvs}, {"ignored", Handedness::ignored}},
                     "Bitangents point to where v grows, or as if no texture were mirrored");
        knobs.choice("--normal-map", space,
                     {{"tangent", MapSpace::tangent},
                      {"object", MapSpace::object},
                      {"none", MapSpace::none}},
                     "Maps have normals in tangent space, or in the model's space; or are not "
                     "read");
        knobs.choice("--green", green, {{"up", Green::up}, {"down", Green::down}},
                     "Green points up in a normal map, as in OpenGL, or down, as in Direct3D");
        knobs.choice("--normal-format", format,
                     {{"unorm", NormalFormat::unorm}, {"snorm", NormalFormat::snorm}},
                     "Values 0 to 255 stand for -1 to 1, or 128 is 0 and 255 is 1");
        knobs.choice("--channels", channels, {{"xyz", Channels::xyz}, {"xy", Channels::xy}},
                     "A map stores x, y and z, or z is computed from the other two");
        knobs.choice("--bits", bits,
                     {{"4", 4}, {"5", 5}, {"6", 6}, {"8", 8}, {"file", bits_of_file}},
                     "Normals are stored with so many bits a component");
    }

    /// The normals of a `norm`, to be sampled.
    Image<vec4> normals(const Image<u8vec4>& image) const {
        return stored(format == NormalFormat::unorm ? normals_from_unorm(image, green)
                                                    : normals_from_snorm(image, green));
    }
    /// The normals of a `map_Bump`: from heights, or, where the image has colours, as of a `norm`.
    Image<vec4> normals_of_bumps(const Image<u8vec4>& image, WrapModes wrap) const {
        return is_gray(image) ? stored(normals_from_heights(image, wrap)) : normals(image);
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

}  // namespace rasterbook
