// SPDX-License-Identifier: MIT
/// @file
/// Tests for lesson 12: files that others have made, beside pictures that others have drawn.
#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/image/backdrop.hpp"
#include "common/image/image_io.hpp"
#include "common/math/color.hpp"
#include "support/lesson_process.hpp"
#include "support/look_up.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

const std::filesystem::path data = std::filesystem::path(RASTERBOOK_TEST_DATA) / "gltf";

Image<u8vec4> drawn(const std::string& file, const std::string& size,
                    std::vector<std::string> knobs) {
    const std::filesystem::path picture = fresh_folder("reference") / "ours.png";
    knobs.insert(knobs.end(), {"--model", (data / file).string(), "--size", size, "--samples", "16",
                               "--out", picture.string()});
    const ProcessResult run = run_program("11_scenes", knobs);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return read_image(picture);
}

/// How far a share of all differences reaches, in codes: 0.5 is the median.
int at_most(const std::vector<int>& differences, double share) {
    std::vector<int> sorted = differences;
    std::ranges::sort(sorted);
    return sorted.at(static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1)));
}

/// By the channel that differs most.
int difference(u8vec4 a, u8vec4 b) {
    int most = 0;
    for (int i = 0; i < 3; ++i) most = std::max(most, std::abs(int{a[i]} - int{b[i]}));
    return most;
}

}  // namespace

TEST(OthersPictures, HardCase_ABlenderFileLooksAsBlenderDrawsIt) {
    look_up("Eq. 11.5");  // its sun has 2146 lux
    const Image<u8vec4> ours =
        drawn("still_life.glb", "320x180", {"--shadow-size", "4096", "--pcf", "1"});
    const Image<u8vec4> blenders = read_image(data / "still_life.png");
    ASSERT_EQ(ours.size(), blenders.size());
    const Image<u8vec3> empty = srgb8_from_linear(backdrop(ours.size()));
    std::vector<int> differences;
    for (std::size_t i = 0; i < ours.pixels().size(); ++i) {
        const u8vec4 theirs = blenders.pixels()[i];
        if (theirs.a == 255) differences.push_back(difference(ours.pixels()[i], theirs));
        if (theirs.a == 0) {  // nothing is there, of 256 samples
            EXPECT_LE(difference(ours.pixels()[i], u8vec4(empty.pixels()[i], 255)), 2)
                << "pixel " << i % 320 << ' ' << i / 320;
        }
    }
    ASSERT_GT(differences.size(), 40000u);
    // Two roundings to codes, and 256 samples at random. Our highlight of a rough surface, which
    // Blender's matte paint has not, is 2 codes.
    EXPECT_LE(at_most(differences, 0.5), 1);
    EXPECT_LE(at_most(differences, 0.9), 2);
    // Along edges 16 samples are not 256; and a texture's colours are mixed as light here.
    EXPECT_LE(at_most(differences, 0.97), 6);
    EXPECT_LE(at_most(differences, 0.999), 40);
}

TEST(OthersPictures, HardCase_AVrmFileLooksAsARayTracerDrawsIt) {
    look_up("Eq. 7.17");
    const Image<u8vec4> ours = drawn("drawing.vrm", "160x90", {"--shadow-size", "4096"});
    const Image<u8vec4> traced = read_image(data / "drawing.png");
    ASSERT_EQ(ours.size(), traced.size());
    std::vector<int> differences;
    for (std::size_t i = 0; i < ours.pixels().size(); ++i)
        differences.push_back(difference(ours.pixels()[i], traced.pixels()[i]));
    EXPECT_LE(at_most(differences, 0.99), 1);    // a rounding to codes each
    EXPECT_LE(at_most(differences, 0.999), 16);  // one of 16 samples beside an edge
}
