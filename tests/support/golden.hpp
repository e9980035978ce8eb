// SPDX-License-Identifier: MIT
/// @file
/// Golden pictures: what a lesson drew when somebody last looked at it and was content.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/image/image.hpp"

namespace rasterbook::test {

/// The golden pictures' size: small enough to keep, large enough for a README.
constexpr const char* golden_size = "960x540";

/// For EXPECT_TRUE: a lesson's picture equals tests/golden/GOLDEN.png.
///
/// On a mismatch, expected | actual | difference side by side are written into the build folder and
/// the failure names that file. With RASTERBOOK_UPDATE_GOLDEN set in the environment, a golden
/// picture that differs is replaced instead; RASTERBOOK_KEEP_PICTURES names a folder into which the
/// lesson's picture is copied, too.
///
/// @param lesson     The program's name, NN_name.
/// @param golden     The picture's name without ".png".
/// @param arguments  For the program, besides --size and --out.
/// @param may_jump   So many pixels may differ by any amount (PictureDifference).
testing::AssertionResult equals_golden(const std::string& lesson, const std::string& golden,
                                       const std::vector<std::string>& arguments = {},
                                       std::size_t may_jump = 0);

}  // namespace rasterbook::test
