// SPDX-License-Identifier: MIT
/// @file
/// The ways to draw a frame that unused_effects.cpp compares.
#pragma once

#include <functional>

#include "common/counters.hpp"
#include "common/image.hpp"
#include "common/mesh.hpp"

namespace rasterbook {

/// What is left out of a copy of a lesson's render(). `own`: it is no copy, but the lesson's own.
enum class Without {
    own,
    nothing,
    light,
    highlight,
    texture,
    specular_map,
    vertex_colors,
    normal_map,
    shadow,
    toon,
    outline,
    mask,
    blend
};

/// Draws a picture, and counts where the counters are not null.
using Draw = std::function<Image<vec3>(Counters*)>;

/// The pictures of a model as a lesson draws them, lesson 07 with no outline.
///
/// Each is compiled alone, as a lesson's program is: in one file, the compiler would inline less of
/// each, and it would be chance in which.
template <int lesson, Without without>
Draw draw_of(const Scene& model);

}  // namespace rasterbook
