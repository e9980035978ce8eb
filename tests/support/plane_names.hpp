// SPDX-License-Identifier: MIT
/// @file
/// The names of the frustum's planes, in the order of plane_distance().
#pragma once

namespace rasterbook::test {

constexpr const char* plane_names[] = {"left", "right", "bottom", "top", "near", "far"};

}  // namespace rasterbook::test
