// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?": scenes of any file in one pixel, in this lesson and the next two, for
/// `--probe`.
#pragma once

#include "11_scenes/scene_assets.hpp"
#include "11_scenes/scene_options.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// Explains pixels of the pictures of lessons 11 to 13, which are the same.
///
/// @param options,assets  Have to outlive the probe.
PixelProbe scene_probe(const SceneRendererOptions& options, const SceneAssets& assets);

}  // namespace rasterbook
