// SPDX-License-Identifier: MIT
// The variants of lesson 08 that docs/accuracy/08_normal_maps.md measures: each keeps what its
// comment says.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/image/image_io.hpp"
#include "lab/normal_map_methods.hpp"
#include "support/lesson_process.hpp"
#include "support/normal_mapped_torus.hpp"
#include "support/printers.hpp"
#include "support/sanitizer.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

NormalErrors errors_of(int around, int across, const NormalMapMethod& variant) {
    return normal_errors(NormalMappedTorus(around, across, variant));
}

constexpr NormalMapMethod face{.frame = FrameOf::face}, vertex{},
    interpolated{.orthonormal = Orthonormal::at_vertices}, pixel{.frame = FrameOf::pixel};

/// The picture that the lesson draws with these options.
Image<u8vec4> drawn(std::vector<std::string> options) {
    const auto file = fresh_folder("variants") / "out.png";
    options.insert(options.end(), {"--size", "320x180", "--out", file.string()});
    EXPECT_EQ(run_program("lab_08_normal_maps", options).exit_status, 0);
    return read_image(file);
}

}  // namespace

TEST(LabNormalMaps, TheReferenceNormalIsOrthogonalToTheBumpySurface) {
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

TEST(LabNormalMaps, AllFramesAreMoreAccurateOnFinerMeshes) {
    for (const NormalMapMethod& variant : {face, vertex, interpolated, pixel}) {
        const NormalErrors coarse = errors_of(16, 8, variant), fine = errors_of(64, 32, variant);
        EXPECT_GT(coarse.fragments, 10'000);
        EXPECT_GT(fine.rms, 0.01) << "the map itself has steps";
        EXPECT_LT(fine.rms, coarse.rms / 3);
        EXPECT_LT(fine.greatest, coarse.greatest / 2);
        EXPECT_LT(coarse.greatest, 10);
    }
}

TEST(LabNormalMaps, VertexTangentsAreTheMostAccurate) {
    const double of_face = errors_of(64, 32, face).rms, of_vertex = errors_of(64, 32, vertex).rms,
                 of_pixel = errors_of(64, 32, pixel).rms;
    EXPECT_LT(2 * of_vertex, of_pixel);
    EXPECT_LT(of_pixel, of_face);
    EXPECT_LT(errors_of(16, 8, vertex).rms, errors_of(16, 8, interpolated).rms);
}

TEST(LabNormalMaps, SnormHasItsZeroInTheMiddle) {
    EXPECT_EQ(component_from_snorm(128), 0.0f);
    EXPECT_EQ(component_from_snorm(255), 1.0f);
    EXPECT_EQ(component_from_snorm(1), -1.0f);
    EXPECT_EQ(component_from_snorm(0), -1.0f) << "one value more below the middle than above";
    EXPECT_NEAR(component_from_snorm(64), -64 / 127.0f, 1e-7f);
    for (int bits = 2; bits <= 16; ++bits) {
        const std::uint32_t middle = 1u << (bits - 1);
        ASSERT_EQ(component_from_snorm(middle, bits), 0.0f) << "the middle value of " << bits;
        ASSERT_EQ(component_from_snorm(2 * middle - 1, bits), 1.0f) << "the greatest of " << bits;
        ASSERT_EQ(component_from_snorm(0, bits), -1.0f) << "the least of " << bits;
        for (std::uint32_t k = 1; k < middle && k < 500; ++k)  // the same on either side
            ASSERT_EQ(component_from_snorm(middle + k, bits),
                      -component_from_snorm(middle - k, bits))
                << bits << " bits, the values " << middle + k << " and " << middle - k;
    }
    const Image<u8vec4> flat({2, 2}, {128, 128, 255, 7});
    for (const Green green : {Green::up, Green::down})
        EXPECT_EQ(normals_from_snorm(flat, green)[ivec2(1)], vec4(0, 0, 1, 1));
    const Image<u8vec4> slanted({1, 1}, {192, 160, 240, 255});
    EXPECT_EQ(normals_from_snorm(slanted, Green::down)[ivec2(0)], vec4(64, -32, 112, 127) / 127.0f);
}

TEST(LabNormalMaps, FilesAreReadAsUnormUnlessAskedOtherwise) {
    const Image<u8vec4> image({1, 1}, {64, 128, 192, 255});
    const vec4 unorm(component_from_unorm(64), component_from_unorm(128), component_from_unorm(192),
                     1);
    const vec4 snorm(component_from_snorm(64), 0, component_from_snorm(192), 1);
    EXPECT_EQ(NormalMapMethod{}.normals(image)[ivec2(0)], unorm);
    EXPECT_EQ(NormalMapMethod{}.normals_of_bumps(image, Wrap::repeat)[ivec2(0)], unorm)
        << "coloured";
    EXPECT_EQ(NormalMapMethod{.format = NormalFormat::snorm}.normals(image)[ivec2(0)], snorm);
}

TEST(LabNormalMaps, EncodersFindTheNearestValue) {
    EXPECT_EQ(unorm_from_component(-0.498f, 8), 64u);  // the worked example
    EXPECT_EQ(unorm_from_component(0, 8), 128u) << "halves upwards";
    EXPECT_EQ(snorm_from_component(-0.504f, 8), 64u);
    for (const int bits : {4, 5, 6, 8, 10, 16}) {
        const std::uint32_t greatest = (1u << bits) - 1, middle = 1u << (bits - 1);
        EXPECT_EQ(unorm_from_component(1, bits), greatest);
        EXPECT_EQ(unorm_from_component(-1, bits), 0u);
        EXPECT_EQ(snorm_from_component(0, bits), middle);
        EXPECT_EQ(snorm_from_component(1, bits), greatest);
        EXPECT_EQ(snorm_from_component(-1, bits), 1u);
        std::mt19937 random(2);
        std::uniform_real_distribution<float> any(-1, 1);
        // Half a step; and what floats round on the way there and back.
        const float half_step = 1 / static_cast<float>(greatest) + 4e-7f;
        const float half_step_of_snorm = 0.5f / static_cast<float>(middle - 1) + 4e-7f;
        for (int i = 0; i < 10'000; ++i) {
            const float x = any(random);
            EXPECT_NEAR(component_from_unorm(unorm_from_component(x, bits), bits), x, half_step);
            EXPECT_NEAR(component_from_snorm(snorm_from_component(x, bits), bits), x,
                        half_step_of_snorm);
        }
        for (std::uint32_t value = 1; value <= greatest; value += 1 + middle / 64) {
            EXPECT_EQ(unorm_from_component(component_from_unorm(value, bits), bits), value);
            EXPECT_EQ(snorm_from_component(component_from_snorm(value, bits), bits), value);
        }
    }
}

/// @param encode  Called as encode(component, bits).
/// @param decode  Called as decode(value, bits).
struct StorageErrors {
    double greatest = 0, rms = 0;  ///< Degrees.
    dvec3 mean{0};                 ///< Of the components' errors.

    template <typename Encode, typename Decode>
    StorageErrors(int bits, Encode encode, Decode decode) {
        std::mt19937 random(3);
        std::normal_distribution<double> any;
        constexpr int count = 200'000;
        for (int i = 0; i < count; ++i) {
            const dvec3 n = glm::normalize(dvec3(any(random), any(random), std::abs(any(random))));
            vec3 decoded;
            for (int axis = 0; axis < 3; ++axis)
                decoded[axis] = decode(encode(static_cast<float>(n[axis]), bits), bits);
            const auto off =
                static_cast<double>(degrees_off(decoded, TrueTorus::lvec3(n.x, n.y, n.z)));
            greatest = std::max(greatest, off), rms += off * off, mean += dvec3(decoded) - n;
        }
        rms = std::sqrt(rms / count), mean /= count;
    }
};

TEST(LabNormalMaps, TheLargestAnglesAreThoseOfThePage) {
    // Half a step in each of three directions, across the normal at most: sqrt(3)/2 of a step.
    for (const int bits : {8, 10, 16}) {
        const auto bound = [](double step) {
            return std::asin(std::sqrt(0.75) * step) * 180 / std::numbers::pi + 1e-5;
        };
        const double of_unorm = bound(2.0 / ((1 << bits) - 1));
        const double of_snorm = bound(1.0 / ((1 << (bits - 1)) - 1));
        const StorageErrors unorm(bits, unorm_from_component, component_from_unorm);
        const StorageErrors snorm(bits, snorm_from_component, component_from_snorm);
        EXPECT_LE(unorm.greatest, of_unorm) << bits;
        EXPECT_GT(unorm.greatest, 0.9 * of_unorm) << bits;
        EXPECT_LE(snorm.greatest, of_snorm) << bits;
        EXPECT_GT(snorm.greatest, 0.9 * of_snorm) << bits;
    }
}

TEST(LabNormalMaps, ADecodingThatIsNotTheEncodersDoublesTheError) {
    const StorageErrors pair(8, unorm_from_component, component_from_unorm);
    EXPECT_NEAR(pair.rms, 0.184, 0.001);
    EXPECT_NEAR(pair.mean.x, 0, 0.0001);
    const StorageErrors as_snorm(8, unorm_from_component, component_from_snorm);
    EXPECT_NEAR(as_snorm.rms, 0.37, 0.005);
    EXPECT_NEAR(as_snorm.greatest, 0.76, 0.01);
    EXPECT_NEAR(as_snorm.mean.x, -0.0039, 0.0001) << "half a step, in each direction alike";
    EXPECT_NEAR(as_snorm.mean.y, -0.0039, 0.0001);
    const StorageErrors as_unorm(8, snorm_from_component, component_from_unorm);
    EXPECT_NEAR(as_unorm.mean.x, 0.0039, 0.0001);
}

TEST(LabNormalMaps, OptionsChangeThePictureAndDefaultsDoNot) {
    const Image<u8vec4> plain = drawn({});
    for (const std::vector<std::string>& same : {std::vector<std::string>{"--frame", "vertex"},
                                                 {"--orthonormal", "pixels"},
                                                 {"--handedness", "uvs"},
                                                 {"--normal-map", "tangent"},
                                                 {"--green", "up"},
                                                 {"--normal-format", "unorm"},
                                                 {"--channels", "xyz"},
                                                 {"--bits", "file"}})
        EXPECT_EQ(drawn(same), plain) << same[0];
    for (const std::vector<std::string>& other : {std::vector<std::string>{"--frame", "face"},
                                                  {"--frame", "pixel"},
                                                  {"--orthonormal", "vertices"},
                                                  {"--normal-map", "object"},
                                                  {"--normal-map", "none"},
                                                  {"--green", "down"},
                                                  {"--normal-format", "snorm"},
                                                  {"--channels", "xy"},
                                                  {"--bits", "4"},
                                                  {"--bits", "5"},
                                                  {"--bits", "6"}})
        EXPECT_NE(drawn(other), plain) << other[0] << " " << other[1];
    const std::string mirrored = "shield_mirrored_uvs.obj";
    EXPECT_NE(drawn({"--model", mirrored, "--handedness", "ignored"}),
              drawn({"--model", mirrored}));
}

TEST(LabNormalMaps, FewerBitsAreLessAccurate) {
    const Image<u8vec4> image =
        read_image(std::filesystem::path(RASTERBOOK_ASSETS) / "textures/hammered_normal.png");
    for (const NormalFormat format : {NormalFormat::unorm, NormalFormat::snorm}) {
        const Image<vec4> exact = NormalMapMethod{.format = format}.normals(image);
        double last = 0;
        for (const int bits : {8, 6, 5, 4}) {
            const Image<vec4> stored =
                NormalMapMethod{.format = format, .bits = bits}.normals(image);
            double squares = 0;
            for (std::size_t i = 0; i < exact.pixels().size(); ++i) {
                const vec4 off = stored.pixels()[i] - exact.pixels()[i];
                squares += glm::dot(off, off);
            }
            EXPECT_GT(squares, last) << bits;
            last = squares;
        }
    }
}

TEST(LabNormalMaps, HardCase_MillionsOfTrianglesMayShareAVertex) {
    if (is_sanitized) GTEST_SKIP() << "takes a gigabyte there";
    const std::array<vec2, 3> uvs = {vec2(0, 0), vec2(1, 0), vec2(-1, 0.01f)};
    const auto tangents_of = [&](std::size_t triangles) {  // nearly pi at the first vertex
        Mesh mesh;
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {-1, 0.01f, 0}};
        mesh.normals.assign(3, vec3(0, 0, 1));
        mesh.triangles.assign(triangles, {{Vertex{0, 0, 0}, Vertex{1, 1, 1}, Vertex{2, 2, 2}}, 0});
        return vertex_tangents(mesh, [&](const Triangle&) { return uvs; });
    };
    const std::vector<vec4> of_one = tangents_of(1), of_many = tangents_of(2'800'000);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_LT(glm::distance(of_one[i], of_many[i]), 1e-6) << "the tangent of vertex " << i;
}
