// SPDX-License-Identifier: MIT
/// @file
/// Depth: what it is kept as. How many surfaces, one a ten-thousandth behind the other, are
/// confused, and what a fragment costs.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "03_z_buffer/depth_buffer.hpp"
#include "accuracy/accuracy.hpp"
#include "common/image/image.hpp"
#include "lab/depth_formats.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

// Each format: the depths that a projection computes for it, and how they are stored.
struct Float32 {
    using Stored = float;
    static constexpr float at_nearest = 1, at_farthest = 0;
    static constexpr bool has_far_plane = false;
    static Stored store(float depth) { return depth; }
};
struct FromNear {
    using Stored = float;
    static constexpr float at_nearest = 0, at_farthest = 1;
    static constexpr bool has_far_plane = true;
    static Stored store(float depth) { return depth; }
};
struct Ndc {
    using Stored = float;
    static constexpr float at_nearest = 1, at_farthest = -1;
    static constexpr bool has_far_plane = false;
    static Stored store(float depth) { return zero_to_one(depth); }
};
struct Unorm16 : Float32 {
    using Stored = std::uint16_t;
    static Stored store(float depth) { return static_cast<Stored>(unorm<16>(depth)); }
};
struct Unorm24 : Float32 {
    using Stored = std::uint32_t;
    static Stored store(float depth) { return unorm<24>(depth); }
};

template <typename Format>
bool is_nearer(typename Format::Stored a, typename Format::Stored b) {
    return Format::at_nearest > Format::at_farthest ? a > b : a < b;
}

/// The depth A + B / Z as a projection computes it in float: (A Z + B) / Z.
struct Projection {
    float a, b;

    /// @param farthest                Infinite: there is no far plane.
    /// @param at_nearest,at_farthest  The depths there.
    Projection(double nearest, double farthest, double at_nearest, double at_farthest) {
        const double b_exact = (at_nearest - at_farthest) * nearest / (1 - nearest / farthest);
        a = static_cast<float>(at_farthest - b_exact / farthest);
        b = static_cast<float>(b_exact);
    }
    float depth(float distance) const { return (a * distance + b) / distance; }
};

/// Pairs of distances Z and 1.0001 Z, as many in each octave, from 0.1 to `farthest_over_nearest`
/// times that. The share that are stored alike, and the share stored in the wrong order.
template <typename Format>
std::pair<double, double> ties_and_inversions(double farthest_over_nearest) {
    constexpr double nearest = 0.1;
    constexpr int pairs = 1'000'000;
    const Projection projection(nearest,
                                Format::has_far_plane ? nearest * farthest_over_nearest
                                                      : std::numeric_limits<double>::infinity(),
                                Format::at_nearest, Format::at_farthest);
    const auto stored = [&](double distance) {
        return Format::store(projection.depth(static_cast<float>(distance)));
    };
    std::mt19937 random(1);
    std::uniform_real_distribution<double> share(0, 1);
    int ties = 0, inversions = 0;
    for (int i = 0; i < pairs; ++i) {
        const double distance = nearest * std::pow(farthest_over_nearest / 1.0001, share(random));
        const auto front = stored(distance), back = stored(1.0001 * distance);
        ties += front == back;
        inversions += is_nearer<Format>(back, front);
    }
    return {100.0 * ties / pairs, 100.0 * inversions / pairs};
}

constexpr ivec2 picture_size(256);
constexpr int layers = 16;

/// Tilted planes over the whole picture: their depths in the upper left corner and their slopes.
std::vector<vec3> random_planes() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> depth(0.3f, 0.7f), slope(-0.001f, 0.001f);
    std::vector<vec3> planes;
    for (int i = 0; i < layers; ++i)
        planes.emplace_back(depth(random), slope(random), slope(random));
    return planes;
}

template <typename Format>
void add_format(const char* name) {
    Errors errors;
    for (int power = 1; power <= 7; ++power) {
        const auto [ties, inversions] = ties_and_inversions<Format>(std::pow(10.0, power));
        errors["% ties at 1e" + std::to_string(power)] = ties;
        double& most = errors["% inversions at most"];
        most = std::max(most, inversions);
    }

    static const std::vector<vec3> planes = random_planes();
    static Image<typename Format::Stored> nearest(picture_size);
    static Image<std::uint32_t> color(picture_size);
    add_variant("formats", name, double{layers} * picture_size.x * picture_size.y, errors, [] {
        const auto cleared = Format::store(Format::at_farthest);
        std::fill(nearest.pixels().begin(), nearest.pixels().end(), cleared);
        std::uint32_t paint = 0;
        for (const vec3 plane : planes) {
            ++paint;
            const vec3 depths =
                vec3(Format::at_nearest, 0, 0) + (Format::at_farthest - Format::at_nearest) * plane;
            for (int y = 0; y < picture_size.y; ++y)
                for (int x = 0; x < picture_size.x; ++x) {
                    const auto stored = Format::store(depths.x + depths.y * static_cast<float>(x) +
                                                      depths.z * static_cast<float>(y));
                    if (!is_nearer<Format>(stored, nearest[{x, y}])) continue;
                    nearest[{x, y}] = stored;
                    color[{x, y}] = paint;
                }
        }
    });
}

}  // namespace

int main(int argc, char** argv) {
    add_format<Float32>("float");
    add_format<FromNear>("float, 0 at the near plane");
    add_format<Ndc>("float, by way of −1 … 1");
    add_format<Unorm16>("16 bits");
    add_format<Unorm24>("24 bits");
    return measure_variants(argc, argv);
}
