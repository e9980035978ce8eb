// SPDX-License-Identifier: MIT
/// @file
/// Says what a wrong picture looks like, and what usually makes it look so.
#pragma once

#include <string>
#include <vector>

#include "common/app/lesson_app.hpp"
#include "common/app/orthographic_view.hpp"
#include "common/image/image.hpp"
#include "common/model/mesh.hpp"
#include "support/visibility.hpp"

namespace rasterbook::test {

/// What is known of a picture besides its pixels.
struct PictureFacts {
    /// In the order in which they are drawn; empty when only the pixels are to be judged.
    std::vector<ScreenPatch> patches;
    bool has_depth_buffer = false;    ///< The nearest patch is seen; without one, the last.
    bool shows_barycentrics = false;  ///< Red, green and blue are barycentric coordinates.
    bool shows_depth = false;         ///< Near is bright, far is dark, nothing is black.
};

/// The facts of a lesson's picture.
///
/// @param lesson     NN_name.
/// @param arguments  Of its program.
/// @throws InputError  When the model cannot be read.
PictureFacts picture_facts(const std::string& lesson, const std::vector<std::string>& arguments,
                           ivec2 size);

/// The scene's triangles as the orthographic projection of lessons 01 to 03 shows them.
std::vector<ScreenPatch> parallel_patches(const Scene& scene, const OrthographicView& view);

/// The same as the camera of lesson 04 sees them, by GLM's matrices. Of a triangle that reaches
/// behind the camera nothing is seen.
///
/// @param bounds  What the camera goes around.
std::vector<ScreenPatch> perspective_patches(const Scene& scene, const Bounds& bounds,
                                             const Orbit& orbit, ivec2 size);

/// One line for each mistake that explains the picture, at most two: what it looks like, a colon,
/// the usual cause.
///
/// @param actual,expected  Of one size.
/// @return  Empty when the pictures count as the same (picture_difference.hpp). When no usual
///          mistake explains the picture, a line that says so and where it differs.
std::string diagnose(const Image<u8vec4>& actual, const Image<u8vec4>& expected,
                     const PictureFacts& facts);

}  // namespace rasterbook::test
