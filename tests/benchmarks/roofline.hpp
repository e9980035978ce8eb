// SPDX-License-Identifier: MIT
/// @file
/// What roofline.cpp asks of roofline_limits.cpp.
#pragma once

namespace rasterbook {

/// Measures what one core can do at most, and writes a line of JSON for each limit:
///
/// - reads of memory, by how much of it is used,
/// - arithmetic, by the number of lanes.
///
/// @param repetitions  Of each, of which the fastest counts.
void measure_limits(int repetitions);

}  // namespace rasterbook
