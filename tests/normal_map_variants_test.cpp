// SPDX-License-Identifier: MIT
// The variants of lesson 08 that docs/accuracy/08_normal_maps.md measures: each keeps what its
// comment says.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "08_normal_maps/normal_map_variants.hpp"
#include "common/image/image_io.hpp"
#include "support/lesson_process.hpp"
#include "support/normal_mapped_torus.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

NormalErrors errors_of(int around, int across, const NormalMapVariant& variant) {
    return normal_errors(NormalMappedTorus(around, across, variant));
}

constexpr NormalMapVariant face{.frame = FrameOf::face}, vertex{},
    interpolated{.orthonormal = Orthonormal::at_vertices}, pixel{.frame = FrameOf::pixel};

/// The picture that the lesson draws with these options.
Image<u8vec4> drawn(std::vector<std::string> options) {
    const auto file = fresh_folder("variants") / "out.png";
    options.insert(options.end(), {"--size", "320x180", "--out", file.string()});
    EXPECT_EQ(run_program("08_normal_maps", options).exit_status, 0);
    return read_image(file);
}

}  // namespace

TEST(NormalMapVariants, TheReferenceNormalIsOrthogonalToTheBumpySurface) {
    // Differences of positions on the surface itself, apart from the formula for its derivatives.
    using real = long double;
    const auto surface_at = [](real u, real v) {
        const real tau = 2 * std::numbers::pi_v<real>;
        const real height = TrueTorus::bump * std::sin(TrueTorus::bumps_around * tau * u) *
                            std::sin(TrueTorus::bumps_across * tau * v);
        return TrueTorus::position(u, v) + height * TrueTorus::frame(u, v).normal;
    };
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(0, 1);
    for (int i = 0; i < 1000; ++i) {
        const real u = any(random), v = any(random), step = 1e-6L;
        const auto along_u = surface_at(u + step, v) - surface_at(u - step, v);
        const auto along_v = surface_at(u, v + step) - surface_at(u, v - step);
        const auto n = TrueTorus::normal(u, v);
        EXPECT_NEAR(static_cast<double>(glm::dot(n, n)), 1, 1e-15);
        // Differences of such steps are off by the third derivative: 1e-7 of their size.
        EXPECT_LT(std::abs(glm::dot(n, along_u)), 1e-6L * std::sqrt(glm::dot(along_u, along_u)));
        EXPECT_LT(std::abs(glm::dot(n, along_v)), 1e-6L * std::sqrt(glm::dot(along_v, along_v)));
        EXPECT_GT(glm::dot(n, TrueTorus::frame(u, v).normal), 0.5L);
    }
}

TEST(NormalMapVariants, AllFramesAreMoreAccurateOnFinerMeshes) {
    for (const NormalMapVariant& variant : {face, vertex, interpolated, pixel}) {
        const NormalErrors coarse = errors_of(16, 8, variant), fine = errors_of(64, 32, variant);
        EXPECT_GT(coarse.fragments, 10'000);
        EXPECT_GT(fine.rms, 0.01) << "the map itself has steps";
        EXPECT_LT(fine.rms, coarse.rms / 3);
        EXPECT_LT(fine.greatest, coarse.greatest / 2);
        EXPECT_LT(coarse.greatest, 10);
    }
}

TEST(NormalMapVariants, VertexTangentsAreTheMostAccurate) {
    const double of_face = errors_of(64, 32, face).rms, of_vertex = errors_of(64, 32, vertex).rms,
                 of_pixel = errors_of(64, 32, pixel).rms;
    EXPECT_LT(2 * of_vertex, of_pixel);
    EXPECT_LT(of_pixel, of_face);
    EXPECT_LT(errors_of(16, 8, vertex).rms, errors_of(16, 8, interpolated).rms);
}

TEST(NormalMapVariants, CodesAreTheNearest) {
    EXPECT_EQ(code_from_component(-0.504f, 8), 64u);  // the worked example
    for (const int bits : {4, 5, 6, 8, 10, 16}) {
        const std::uint32_t middle = 1u << (bits - 1);
        EXPECT_EQ(code_from_component(0, bits), middle);
        EXPECT_EQ(code_from_component(1, bits), 2 * middle - 1);
        EXPECT_EQ(code_from_component(-1, bits), 1u);
        std::mt19937 random(2);
        std::uniform_real_distribution<float> any(-1, 1);
        // Half a step; and what floats round on the way there and back.
        const float half_step = 0.5f / static_cast<float>(middle - 1) + 4e-7f;
        for (int i = 0; i < 10'000; ++i) {
            const float x = any(random);
            EXPECT_NEAR(component_from_code(code_from_component(x, bits), bits), x, half_step);
        }
        for (std::uint32_t code = 1; code < 2 * middle; code += 1 + middle / 64)
            EXPECT_EQ(code_from_component(component_from_code(code, bits), bits), code);
    }
}

TEST(NormalMapVariants, TheLargestAnglesAreThoseOfThePage) {
    // Half a step in each of three directions, across the normal at most: sqrt(3)/2 of a step.
    std::mt19937 random(3);
    std::normal_distribution<double> any;
    for (const int bits : {8, 10, 16}) {
        const double step = 1.0 / ((1 << (bits - 1)) - 1);
        const double bound = std::asin(std::sqrt(0.75) * step) * 180 / std::numbers::pi + 1e-5;
        long double greatest = 0;
        for (int i = 0; i < 200'000; ++i) {
            const dvec3 n = glm::normalize(dvec3(any(random), any(random), std::abs(any(random))));
            vec3 decoded;
            for (int axis = 0; axis < 3; ++axis)
                decoded[axis] = component_from_code(
                    code_from_component(static_cast<float>(n[axis]), bits), bits);
            greatest = std::max(greatest, degrees_off(decoded, TrueTorus::lvec3(n.x, n.y, n.z)));
        }
        EXPECT_LE(greatest, bound) << bits;
        EXPECT_GT(greatest, 0.9 * bound) << bits;
    }
}

TEST(NormalMapVariants, OptionsChangeThePictureAndDefaultsDoNot) {
    const Image<u8vec4> plain = drawn({});
    for (const std::vector<std::string>& same : {std::vector<std::string>{"--frame", "vertex"},
                                                 {"--orthonormal", "pixels"},
                                                 {"--normal-map", "tangent"},
                                                 {"--green", "up"},
                                                 {"--channels", "xyz"},
                                                 {"--bits", "file"}})
        EXPECT_EQ(drawn(same), plain) << same[0];
    for (const std::vector<std::string>& other : {std::vector<std::string>{"--frame", "face"},
                                                  {"--frame", "pixel"},
                                                  {"--orthonormal", "vertices"},
                                                  {"--normal-map", "object"},
                                                  {"--normal-map", "none"},
                                                  {"--green", "down"},
                                                  {"--channels", "xy"},
                                                  {"--bits", "4"},
                                                  {"--bits", "5"},
                                                  {"--bits", "6"}})
        EXPECT_NE(drawn(other), plain) << other[0] << " " << other[1];
}

TEST(NormalMapVariants, FewerBitsAreLessAccurate) {
    const NormalMapVariant as_file{};
    const Image<u8vec4> picture =
        read_image(std::filesystem::path(RASTERBOOK_ASSETS) / "textures/hammered_normal.png");
    const Image<vec4> exact = as_file.normals(picture);
    double last = 0;
    for (const int bits : {8, 6, 5, 4}) {
        const Image<vec4> stored = NormalMapVariant{.bits = bits}.normals(picture);
        double squares = 0;
        for (std::size_t i = 0; i < exact.pixels().size(); ++i) {
            const vec4 off = stored.pixels()[i] - exact.pixels()[i];
            squares += glm::dot(off, off);
        }
        EXPECT_GT(squares, last) << bits;
        last = squares;
    }
}
