// SPDX-License-Identifier: MIT
/// @file
/// The ways to draw a frame that unused_effects.cpp compares.
#pragma once

#include <functional>

#include "common/app/counters.hpp"
#include "common/image/image.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// What is not compiled into a lesson's render(). `own`: nothing is left out; it is the lesson's
/// own. `nothing`: the same, compiled once more.
enum class Without {
    own,
    nothing,
    light,
    highlight,
    texture,
    specular_map,
    emission_map,
    vertex_colors,
    normal_map,
    shadow,
    toon,
    outline,
    mask,
    blend
};

/// Whether a counter counts an effect's work alone. Textures of all kinds share one counter.
constexpr bool is_work_of(Without effect, Counter counter) {
    switch (effect) {
        case Without::light:
            return counter == Counter::fragments_lit;
        case Without::highlight:
            return counter == Counter::highlights;
        case Without::vertex_colors:
            return counter == Counter::colored_fragments;
        case Without::normal_map:
            return counter == Counter::normal_map_samples ||
                   counter == Counter::meshes_with_tangents;
        case Without::shadow:
            return counter == Counter::shadow_passes || counter == Counter::shadow_fragments ||
                   counter == Counter::shadow_tests;
        case Without::toon:
            return counter == Counter::toon_fragments;
        case Without::outline:
            return counter == Counter::outline_tests || counter == Counter::outline_pixels;
        case Without::mask:
            return counter == Counter::alpha_tested_fragments ||
                   counter == Counter::alpha_tested_texels;
        case Without::blend:
            return counter == Counter::blended_fragments;
        default:
            return false;
    }
}

/// Draws a picture; the counters, if they are not null, become what was done for it.
using Draw = std::function<Image<vec3>(Counters*)>;

/// The pictures of a model as a lesson draws them, lesson 07 without outlines.
///
/// Each is compiled alone, as a lesson's program is: in one file, the compiler would inline less of
/// each, and it would be chance in which.
///
/// @param model  Does not call for the effect; else it is undefined what happens.
template <int lesson, Without effect>
Draw draw_of(const Scene& model);

}  // namespace rasterbook
