// SPDX-License-Identifier: MIT
/// @file
/// Where frames are computed and how exactly, and how normals are stored, to be seen with
/// `--frame`, `--orthonormal`, `--channels` and `--bits`, and measured in
/// docs/accuracy/08_normal_maps.md; and what a map's codes mean: `--normal-map`, `--green`.
#pragma once

#include <cmath>
#include <cstdint>

#include "08_normal_maps/normal_map.hpp"
#include "common/app/lesson_app.hpp"

namespace rasterbook {

/// Tangents are computed once for a face; for its vertices, from all faces around them; or for each
/// pixel, from the face's sides and the normal there.
enum class FrameOf { face, vertex, pixel };

/// The frames between vertices are made orthonormal, or are as they are mixed.
enum class Orthonormal { at_pixels, at_vertices };

/// What `norm` names: normals in the frames of the surface, or as they stand in the model; or
/// neither `norm` nor `map_Bump` is read.
enum class MapSpace { tangent, object, none };

/// A map holds all of a normal, or x and y only.
enum class Channels { xyz, xy };

constexpr int bits_of_file = 0;  ///< For NormalMapVariant::bits: as the file has them.

/// A component, -1 to 1, as the nearest code of so many bits.
///
/// @param bits  2 to 16.
inline std::uint32_t code_from_component(float component, int bits) {
    const float middle = static_cast<float>(1u << (bits - 1));
    return static_cast<std::uint32_t>(std::floor(middle + (middle - 1) * component + 0.5f));
}

struct NormalMapVariant {
    FrameOf frame = FrameOf::vertex;
    Orthonormal orthonormal = Orthonormal::at_pixels;
    MapSpace space = MapSpace::tangent;
    Green green = Green::up;
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
        knobs.choice("--normal-map", space,
                     {{"tangent", MapSpace::tangent},
                      {"object", MapSpace::object},
                      {"none", MapSpace::none}},
                     "Normals in a map stand in the surface's frames, or in the model's space; or "
                     "maps are not read");
        knobs.choice("--green", green, {{"up", Green::up}, {"down", Green::down}},
                     "Where green leads in a normal map: up as in OpenGL, or down as in Direct3D");
        knobs.choice("--channels", channels, {{"xyz", Channels::xyz}, {"xy", Channels::xy}},
                     "A map holds x, y and z, or z is found from the other two");
        knobs.choice("--bits", bits,
                     {{"4", 4}, {"5", 5}, {"6", 6}, {"8", 8}, {"file", bits_of_file}},
                     "Normals are stored with so many bits a component");
    }

    /// The normals of a `norm`, to be sampled.
    Image<vec4> normals(const Image<u8vec4>& picture) const {
        return stored(normals_from_codes(picture, green));
    }
    /// The normals of a `map_Bump`: from heights, or, where the picture has colours, as of a
    /// `norm`.
    Image<vec4> normals_of_bumps(const Image<u8vec4>& picture, Wrap wrap) const {
        return is_gray(picture) ? stored(normals_from_heights(picture, wrap)) : normals(picture);
    }

  private:
    Image<vec4> stored(Image<vec4> normals) const {
        if (bits == bits_of_file && channels == Channels::xyz) return normals;
        for (vec4& normal : normals.pixels()) {
            vec3 n = unit_or(vec3(normal), vec3(0, 0, 1));
            if (bits != bits_of_file)
                for (int axis = 0; axis < 3; ++axis)
                    n[axis] = component_from_code(code_from_component(n[axis], bits), bits);
            normal = vec4(n, 1);
        }
        return normals;
    }
};

}  // namespace rasterbook
