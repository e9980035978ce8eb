// SPDX-License-Identifier: MIT
/// @file
/// The filters of textures and the ways to wrap them that tests go through, and what failing tests
/// call them.
#pragma once

#include <array>

#include "05_textures/texture.hpp"

namespace rasterbook::test {

inline constexpr std::array all_wraps = {Wrap::repeat, Wrap::mirror, Wrap::clamp};
inline constexpr std::array all_filters = {Filter::nearest, Filter::bilinear, Filter::trilinear};

constexpr const char* name_of(Wrap wrap) {
    return wrap == Wrap::repeat ? "repeat" : wrap == Wrap::mirror ? "mirror" : "clamp";
}
constexpr const char* name_of(Filter filter) {
    return filter == Filter::nearest    ? "nearest"
           : filter == Filter::bilinear ? "bilinear"
                                        : "trilinear";
}

}  // namespace rasterbook::test
