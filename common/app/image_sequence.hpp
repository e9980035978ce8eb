// SPDX-License-Identifier: MIT
/// @file
/// Several pictures of one scene: which of them are drawn, what they are called, and how many at
/// once; what it is good for: docs/animation.md.
#pragma once

#include <filesystem>
#include <string>

#include "common/math/types.hpp"

namespace rasterbook {

/// Pictures along one turn around the scene, numbered from 0: some of them, or all.
struct Frames {
    int first = 0, last = 0;  ///< Those that are drawn, both included.
    int of_turn = 1;          ///< So many make the whole turn, 1 to 9999.

    int count() const { return last - first + 1; }
};

/// Reads "90", all frames of 90, or "0-29/90", the first 30 of 90.
///
/// @throws std::invalid_argument  Says what is wrong with any other text.
Frames frames_from(const std::string& text);

/// "turn_0007.png" for frame 7 of "turn_%04d.png"; other names stay as they are.
std::filesystem::path name_of_frame(const std::filesystem::path& pattern, int frame);

/// How far the camera has gone around the scene since frame 0.
inline float degrees_at(int frame, const Frames& frames) {
    return 360.0f * static_cast<float>(frame) / static_cast<float>(frames.of_turn);
}

/// As many frames as there are threads to draw them, but no more than there are to be drawn, or
/// than take 1 GiB together; at least one.
///
/// A frame is reckoned with 40 bytes a sample: lesson 07 takes 39, the others less. Depth maps of
/// lights, 4 bytes a texel, are not in it.
///
/// @param size  Of a frame, in samples.
int frames_at_once(int threads, const Frames& frames, ivec2 size);

}  // namespace rasterbook
