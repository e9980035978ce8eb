// SPDX-License-Identifier: MIT
/// @file
/// What a probe says of pixels, beside what the picture has there.
#pragma once

#include <cstdint>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "common/image/image.hpp"
#include "common/math/color.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook::test {

/// Random pixels of a picture, with what a probe says of them.
///
/// @param pixels   How many: those of all tests are more than 10,000.
/// @param render   Called as render(options, assets).
/// @param probe_of Called as probe_of(options, assets).
template <typename Options, typename Assets, typename Render, typename ProbeOf>
void expect_the_pictures_pixels(Options options, const Assets& assets, int pixels,
                                const Render& render, const ProbeOf& probe_of) {
    const ivec2 size(113, 67);
    options.size = size * options.samples_per_side;
    const Image<u8vec3> picture =
        srgb8_from_linear(averaged(render(options, assets), options.samples_per_side));
    const PixelProbe probe = probe_of(options, assets);
    std::mt19937 random(1);
    for (int i = 0; i < pixels; ++i) {
        const auto below = [&](int end) { return static_cast<int>(random() % std::uint32_t(end)); };
        const ivec2 pixel(below(size.x), below(size.y));
        PixelReport report;
        const u8vec3 color = probed_color(probe, pixel, options.samples_per_side, report);
        ASSERT_EQ(color, picture[pixel])
            << "pixel " << pixel.x << ", " << pixel.y << " of " << options.model << '\n'
            << report.all();
    }
}

/// For ASSERT_TRUE: a text holds another.
inline testing::AssertionResult holds(const std::string& text, const std::string& part) {
    if (text.find(part) != text.npos) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "there is no \"" << part << "\" in\n" << text;
}

}  // namespace rasterbook::test
