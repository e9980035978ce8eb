// SPDX-License-Identifier: MIT
// The variants of lesson 08 that docs/accuracy/08_normal_maps.md measures: each keeps what its
// comment says.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/image/image_io.hpp"
#include "lab/normal_map_methods.hpp"
#include "support/lesson_process.hpp"
#include "support/near.hpp"
#include "support/normal_mapped_torus.hpp"
#include "support/printers.hpp"
#include "support/sanitizer.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

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

TEST(LabNormalMaps, AllFramesAreMoreAccurateOnFinerMeshesAndVertexTangentsMost) {
    std::vector<NormalErrors> coarse, fine;
    for (const NormalMapMethod& method : {vertex, pixel, face, interpolated}) {
        coarse.push_back(normal_errors(NormalMappedTorus(16, 8, method)));
        fine.push_back(normal_errors(NormalMappedTorus(64, 32, method)));
        EXPECT_LT(fine.back().rms, coarse.back().rms / 3);
        EXPECT_LT(fine.back().greatest, coarse.back().greatest / 2);
        EXPECT_LT(coarse.back().greatest, 10);
    }
    EXPECT_LT(2 * fine[0].rms, fine[1].rms) << "of vertices, beside pixels";
    EXPECT_LT(fine[1].rms, fine[2].rms) << "of pixels, beside faces";
    EXPECT_LT(coarse[0].rms, coarse[3].rms) << "of vertices, beside frames that are interpolated";
}

TEST(LabNormalMaps, SnormHasItsZeroInTheMiddle) {
    EXPECT_EQ(component_from_snorm(255), 1.0f);
    EXPECT_EQ(component_from_snorm(1), -1.0f);
    EXPECT_NEAR(component_from_snorm(64), -64 / 127.0f, 1e-7f);
    for (int bits = 2; bits <= 16; ++bits) {
        const std::uint32_t middle = 1u << (bits - 1);
        ASSERT_EQ(component_from_snorm(middle, bits), 0.0f) << "the middle value of " << bits;
        ASSERT_EQ(component_from_snorm(2 * middle - 1, bits), 1.0f) << "the greatest of " << bits;
        ASSERT_EQ(component_from_snorm(0, bits), -1.0f) << "the least of " << bits;
    }
    const Image<u8vec4> slanted({1, 1}, {192, 160, 240, 7});
    EXPECT_EQ(normals_from_snorm(slanted, Green::up)[ivec2(0)], vec4(64, 32, 112, 127) / 127.0f);
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
    const Image<u8vec4> flat({1, 1}, {128, 128, 255, 255});
    EXPECT_EQ(NormalMapMethod{.bits = 4}.normals(flat)[ivec2(0)],
              vec4(component_from_unorm(8, 4), component_from_unorm(8, 4), 1, 1));
    EXPECT_EQ((NormalMapMethod{.format = NormalFormat::snorm, .bits = 4}.normals(flat)[ivec2(0)]),
              vec4(0, 0, 1, 1));
}

TEST(LabNormalMaps, EncodersFindTheNearestValue) {
    EXPECT_EQ(unorm_from_component(-0.498f, 8), 64u);  // the worked example
    EXPECT_EQ(unorm_from_component(0, 8), 128u) << "halves upwards";
    EXPECT_EQ(snorm_from_component(-0.504f, 8), 64u);
    std::mt19937 random(2);
    std::uniform_real_distribution<float> any(-1, 1);
    for (const int bits : {4, 5, 6, 8, 10, 16}) {
        const auto greatest = static_cast<float>((1 << bits) - 1);
        // Half a step; and what floats round on the way there and back.
        const float of_unorm = 1 / greatest + 4e-7f, of_snorm = 1 / (greatest - 1) + 4e-7f;
        for (int i = 0; i < 10'000; ++i) {
            const float x = i < 3 ? static_cast<float>(i - 1) : any(random);
            EXPECT_NEAR(component_from_unorm(unorm_from_component(x, bits), bits), x, of_unorm);
            EXPECT_NEAR(component_from_snorm(snorm_from_component(x, bits), bits), x, of_snorm);
        }
    }
}

/// What is left of normals that are stored and read.
///
/// @param encode,decode  Called as encode(component, 8), decode(value, 8).
struct StorageErrors {
    double greatest = 0, rms = 0;  ///< Degrees.
    dvec3 mean{0};                 ///< Of the components' errors.

    template <typename Encode, typename Decode>
    StorageErrors(Encode encode, Decode decode) {
        std::mt19937 random(3);
        std::normal_distribution<double> any;
        constexpr int count = 200'000;
        for (int i = 0; i < count; ++i) {
            const dvec3 n = glm::normalize(dvec3(any(random), any(random), std::abs(any(random))));
            vec3 decoded;
            for (int axis = 0; axis < 3; ++axis)
                decoded[axis] = decode(encode(static_cast<float>(n[axis]), 8), 8);
            const double off = degrees_between(decoded, vec3(n));
            greatest = std::max(greatest, off), rms += off * off, mean += dvec3(decoded) - n;
        }
        rms = std::sqrt(rms / count), mean /= count;
    }
};

TEST(LabNormalMaps, ErrorsOfStorageAreThoseOfThePage) {
    // Half a step in each of three directions, across the normal at most: sqrt(3)/2 of a step.
    const StorageErrors unorm(unorm_from_component, component_from_unorm);
    EXPECT_LE(unorm.greatest, 0.3892);
    EXPECT_GT(unorm.greatest, 0.9 * 0.3892);
    EXPECT_NEAR(unorm.rms, 0.184, 0.001);
    EXPECT_NEAR(unorm.mean.x, 0, 0.0001);
    const StorageErrors snorm(snorm_from_component, component_from_snorm);
    EXPECT_LE(snorm.greatest, 0.3908);
    EXPECT_GT(snorm.greatest, 0.9 * 0.3908);
    // A decoding that is not the encoder's doubles the error.
    const StorageErrors as_snorm(unorm_from_component, component_from_snorm);
    EXPECT_NEAR(as_snorm.rms, 0.37, 0.005);
    EXPECT_NEAR(as_snorm.greatest, 0.76, 0.01);
    EXPECT_NEAR(as_snorm.mean.x, -0.0039, 0.0001) << "half a step, in each direction alike";
}

TEST(LabNormalMaps, OptionsChangeThePictureAndDefaultsDoNot) {
    const Image<u8vec4> plain = drawn({});
    EXPECT_EQ(drawn({"--frame", "vertex", "--orthonormal", "pixels", "--handedness", "uvs",
                     "--normal-map", "tangent", "--green", "up", "--normal-format", "unorm",
                     "--channels", "xyz", "--bits", "file"}),
              plain);
    for (const auto& [option, value] : {std::pair{"--frame", "face"},
                                        {"--frame", "pixel"},
                                        {"--orthonormal", "vertices"},
                                        {"--normal-map", "object"},
                                        {"--normal-map", "none"},
                                        {"--green", "down"},
                                        {"--normal-format", "snorm"},
                                        {"--channels", "xy"},
                                        {"--bits", "6"}})
        EXPECT_NE(drawn({option, value}), plain) << option << " " << value;
    const std::string shield = "shield_mirrored_uvs.obj";
    EXPECT_NE(drawn({"--handedness", "ignored", "--model", shield}), drawn({"--model", shield}));
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
