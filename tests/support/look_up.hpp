// SPDX-License-Identifier: MIT
/// @file
/// Tells a reader whose own code fails a test where the reasoning is.
#pragma once

#include <string>

namespace rasterbook::test {

/// Where in the lesson's derivation to read when the running test fails; printed once, after what
/// failed. A test named EqN_M_... needs no call: it names its equation itself.
///
/// @param place  Such as "Eq. 2.7".
void look_up(const std::string& place);

}  // namespace rasterbook::test
