// SPDX-License-Identifier: MIT
/// @file
/// What a file's normal maps mean: `--normal-map` and `--green`.
#pragma once

#include "08_normal_maps/normal_map.hpp"
#include "common/app/lesson_app.hpp"

namespace rasterbook {

/// What `norm` names: normals in tangent space, or in the model's space; or neither `norm` nor
/// `map_Bump` is read.
enum class MapSpace { tangent, object, none };

struct NormalMapOptions {
    MapSpace space = MapSpace::tangent;
    Green green = Green::up;

    void declare(OptionParser& parser) {
        parser.choice("--normal-map", space,
                      {{"tangent", MapSpace::tangent},
                       {"object", MapSpace::object},
                       {"none", MapSpace::none}},
                      "Maps have normals in tangent space, or in the model's space; or are not "
                      "read");
        parser.choice("--green", green, {{"up", Green::up}, {"down", Green::down}},
                      "Green points up in a normal map, as in OpenGL, or down, as in Direct3D");
    }

    /// The normals of a `norm`, to be sampled.
    Image<vec4> normals(const Image<u8vec4>& image) const {
        return normals_from_unorm(image, green);
    }
    /// The normals of a `map_Bump`: from heights, or, where the image has colours, as of a `norm`.
    Image<vec4> normals_of_bumps(const Image<u8vec4>& image, WrapModes wrap) const {
        return is_gray(image) ? normals_from_heights(image, wrap) : normals(image);
    }
};

}  // namespace rasterbook
