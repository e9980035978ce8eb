// SPDX-License-Identifier: MIT
/// @file
/// Textures of 8-bit values, decoded when they are read, beside textures of floats.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "05_textures/texture.hpp"
#include "13_simd/simd.hpp"
#include "13_simd/wide_textures.hpp"
#include "accuracy/accuracy.hpp"
#include "common/image/image_io.hpp"
#include "common/math/color.hpp"
#include "lab/texture_methods.hpp"

namespace rasterbook::test {

/// Where the four texels around N positions are, as sample_bilinear() of lesson 13 finds them.
template <int N>
struct BilinearPlaces {
    Ints<N> upper;  ///< The upper left texel of each four.
    Floats<N> share_x, share_y;

    BilinearPlaces(const EncodedLevel& level, Floats<N> x, Floats<N> y) {
        using F = Floats<N>;
        const F from_first_x = x * F(static_cast<float>(level.size.x)) + F(0.5f);
        const F from_first_y = y * F(static_cast<float>(level.size.y)) + F(0.5f);
        const Ints<N> column = min(truncated(from_first_x), Ints<N>(level.size.x));
        const Ints<N> row = min(truncated(from_first_y), Ints<N>(level.size.y));
        share_x = from_first_x - to_floats(column), share_y = from_first_y - to_floats(row);
        upper = row * Ints<N>(level.texels.size().x) + column;
    }
};

/// What each byte stands for: a colour's, and alpha's.
struct ByteTables {
    std::array<float, 256> color, alpha;

    ByteTables() {
        for (std::size_t byte = 0; byte < color.size(); ++byte) {
            alpha[byte] = static_cast<float>(byte) / 255.0f;
            color[byte] = linear_from_srgb(alpha[byte]);
        }
    }
};

/// As sample_bilinear() of lesson 13: a texel's channels at once, each read from the table.
template <int N>
glm::vec<4, Floats<N>> sample_by_table(const EncodedLevel& level, Floats<N> x, Floats<N> y,
                                       const ByteTables& tables) {
    using Texel = Vector<float, 4>;
    const BilinearPlaces<N> at(level, x, y);
    const u8vec4* const texels = level.texels.pixels().data();
    const auto read = [&](const u8vec4* from) {
        return Texel{tables.color[from->r], tables.color[from->g], tables.color[from->b],
                     tables.alpha[from->a]};
    };
    std::array<Texel, N> means;
    for (int i = 0; i < N; ++i) {
        const u8vec4* const upper = texels + at.upper[i];
        const u8vec4* const lower = upper + level.texels.size().x;
        const Texel left = read(upper), left_below = read(lower);
        const Texel in_upper = left + at.share_x[i] * (read(upper + 1) - left);
        const Texel in_lower = left_below + at.share_x[i] * (read(lower + 1) - left_below);
        means[static_cast<std::size_t>(i)] = in_upper + at.share_y[i] * (in_lower - in_upper);
    }
    glm::vec<4, Floats<N>> color;
    for (int c = 0; c < 4; ++c)
        for (int i = 0; i < N; ++i) color[c].set(i, means[static_cast<std::size_t>(i)][c]);
    return color;
}

/// A texel of each of N pixels, four bytes each, comes into the lanes of whole numbers; its
/// channels are taken apart and decoded there.
///
/// @param decode  Called as decode(Floats<N>), from 0 to 1.
template <int N, typename Decode>
glm::vec<4, Floats<N>> sample_in_lanes(const EncodedLevel& level, Floats<N> x, Floats<N> y,
                                       Decode&& decode) {
    using F = Floats<N>;
    using Color = glm::vec<4, F>;
    const BilinearPlaces<N> at(level, x, y);
    const u8vec4* const texels = level.texels.pixels().data();
    const auto read = [&](int offset) {
        Ints<N> packed;
        for (int i = 0; i < N; ++i) {
            std::int32_t bytes;
            std::memcpy(&bytes, texels + at.upper[i] + offset, sizeof bytes);
            packed.set(i, bytes);
        }
        Color color;
        for (int c = 0; c < 4; ++c) {
            color[c] = to_floats(Ints<N>((packed.lanes >> (8 * c)) & 255)) * F(1 / 255.0f);
            if (c < 3) color[c] = decode(color[c]);
        }
        return color;
    };
    const int pitch = level.texels.size().x;
    const Color left = read(0), left_below = read(pitch);
    const Color in_upper = left + at.share_x * (read(1) - left);
    const Color in_lower = left_below + at.share_x * (read(pitch + 1) - left_below);
    return in_upper + at.share_y * (in_lower - in_upper);
}

template <typename F>
F decoded_by_power(F srgb) {
    return select(srgb <= F(0.04045f), srgb * F(1 / 12.92f),
                  power((srgb + F(0.055f)) * F(1 / 1.055f), F(2.4f)));
}

/// A cubic that is near.
///
/// @see Ian Taylor, "sRGB Approximations for HLSL", 2012.
template <typename F>
F decoded_by_cubic(F srgb) {
    return srgb * (srgb * (srgb * F(0.305306011f) + F(0.682171111f)) + F(0.012522878f));
}

/// A texture both ways, without smaller levels.
struct TwoLevels {
    TextureLevel floats;
    EncodedLevel bytes;
};

inline const Image<u8vec4>& wood() {
    static const Image<u8vec4> texels = read_image(RASTERBOOK_ASSETS "/textures/wood.png");
    return texels;
}

inline std::shared_ptr<const TwoLevels> wood_of_size(int size) {
    Image<u8vec4> texels{ivec2(size)};
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) texels[{x, y}] = wood()[ivec2(x, y) % wood().size()];
    return std::make_shared<const TwoLevels>(
        TwoLevels{with_border(linear_from_srgb8(texels), Wrap::repeat),
                  make_encoded_level(texels, Wrap::repeat)});
}

/// Positions in a texture, 0 to 1.
struct Positions {
    std::vector<float> x, y;
};

/// A square of the screen, turned, with a little less than a texel in a pixel.
inline std::shared_ptr<const Positions> near_positions(int size) {
    Positions near;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            const vec2 texel = vec2(120, 60) + 0.8f * vec2(x, y) + 0.3f * vec2(-y, x);
            near.x.push_back(texel.x / static_cast<float>(size));
            near.y.push_back(texel.y / static_cast<float>(size));
        }
    return std::make_shared<const Positions>(std::move(near));
}

inline std::shared_ptr<const Positions> random_positions() {
    Positions anywhere;
    std::mt19937 random(13);
    std::uniform_real_distribution<float> any(0, 1);
    for (int i = 0; i < 1 << 18; ++i)
        anywhere.x.push_back(any(random)), anywhere.y.push_back(any(random));
    return std::make_shared<const Positions>(std::move(anywhere));
}

constexpr int texel_lanes = native_width;
using TexelLanes = Floats<texel_lanes>;
using ColorLanes = glm::vec<4, TexelLanes>;

/// Calls take(name, bytes of a texel, sample), where sample is called as sample(level, x, y).
template <typename Take>
void for_each_storage(Take&& take) {
    static const ByteTables tables;
    take("floats", sizeof(vec4), [](const TwoLevels& level, TexelLanes x, TexelLanes y) {
        return sample_bilinear(level.floats, x, y);
    });
    take("table", sizeof(u8vec4), [](const TwoLevels& level, TexelLanes x, TexelLanes y) {
        return sample_by_table(level.bytes, x, y, tables);
    });
    take("power", sizeof(u8vec4), [](const TwoLevels& level, TexelLanes x, TexelLanes y) {
        return sample_in_lanes(level.bytes, x, y, decoded_by_power<TexelLanes>);
    });
    take("cubic", sizeof(u8vec4), [](const TwoLevels& level, TexelLanes x, TexelLanes y) {
        return sample_in_lanes(level.bytes, x, y, decoded_by_cubic<TexelLanes>);
    });
}

/// What is to be timed.
template <typename Sample>
void sample_all(const TwoLevels& level, const Positions& positions, const Sample& sample) {
    static ColorLanes sink;
    for (std::size_t i = 0; i < positions.x.size(); i += texel_lanes) {
        // Each result is stored, but where it does not push texels out of the cache.
        sink = sample(level, load<TexelLanes>(&positions.x[i]), load<TexelLanes>(&positions.y[i]));
        asm volatile("" : : "r"(&sink) : "memory");
    }
}

/// What a byte stands for.
inline double light_of(std::uint8_t byte) {
    const double srgb = byte / 255.0;
    return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

/// The mean of the four texels around a position; the picture is repeated.
inline dvec3 mean_of_light(const Image<u8vec4>& texels, dvec2 position) {
    const dvec2 at = position * dvec2(texels.size()) - 0.5;
    dvec3 mean(0);
    for (int i = 0; i < 4; ++i) {
        const dvec2 texel = glm::floor(at) + dvec2(i % 2, i / 2);
        const dvec2 share = 1.0 - glm::abs(at - texel);
        const u8vec4 bytes = texels[(ivec2(texel) + texels.size()) % texels.size()];
        for (int c = 0; c < 3; ++c) mean[c] += share.x * share.y * light_of(bytes[c]);
    }
    return mean;
}

template <typename Sample>
Errors sampling_errors(const TwoLevels& level, const Positions& positions, const Sample& sample) {
    double greatest = 0, sum_of_squares = 0, differing = 0, wrong_values = 0;
    for (std::size_t i = 0; i < positions.x.size(); i += texel_lanes) {
        const TexelLanes x = load<TexelLanes>(&positions.x[i]);
        const TexelLanes y = load<TexelLanes>(&positions.y[i]);
        const ColorLanes color = sample(level, x, y);
        const ColorLanes of_floats = sample_bilinear(level.floats, x, y);
        for (int lane = 0; lane < texel_lanes; ++lane) {
            const dvec3 exact = mean_of_light(wood(), {x[lane], y[lane]});
            bool differs = false;
            for (int c = 0; c < 3; ++c) {
                const float found = color[c][lane];
                const double error = std::abs(static_cast<double>(found) - exact[c]);
                greatest = std::max(greatest, error);
                sum_of_squares += error * error;
                wrong_values +=
                    srgb8_from_linear(found) != srgb8_from_linear(static_cast<float>(exact[c]));
                differs |= std::bit_cast<std::uint32_t>(found) !=
                           std::bit_cast<std::uint32_t>(of_floats[c][lane]);
            }
            differing += differs;
        }
    }
    const auto samples = static_cast<double>(positions.x.size());
    return {{"greatest error, millionths", 1e6 * greatest},
            {"RMS error, millionths", 1e6 * std::sqrt(sum_of_squares / (3 * samples))},
            {"wrong values, %", 100 * wrong_values / (3 * samples)},
            {"samples that differ from floats, %", 100 * differing / samples}};
}

/// Level 0 of the wood as it is, seen from near; then of sizes that caches hold or do not.
inline void add_storages() {
    const auto small = wood_of_size(wood().size().x);
    const auto near = near_positions(wood().size().x);
    for_each_storage([&](const char* name, std::size_t bytes, auto sample) {
        Errors errors = sampling_errors(*small, *near, sample);
        errors["MiB"] = static_cast<double>(bytes) * wood().size().x * wood().size().y / (1 << 20);
        add_variant("texels", name, static_cast<double>(near->x.size()), std::move(errors),
                    [=] { sample_all(*small, *near, sample); });
    });
    const auto anywhere = random_positions();
    for (const int size : {256, 512, 1024, 2048, 4096}) {
        const auto level = wood_of_size(size);
        for_each_storage([&](const char* name, std::size_t, auto sample) {
            add_variant("sizes", std::to_string(size) + ": " + name,
                        static_cast<double>(anywhere->x.size()), {},
                        [=] { sample_all(*level, *anywhere, sample); });
        });
    }
}

/// Smaller levels are means, for which bytes have no value: what rounding them to bytes changes.
inline void add_levels() {
    static const Texture texture = make_texture(linear_from_srgb8(wood()), Wrap::repeat);
    for (std::size_t i = 0; i < texture.levels.size(); ++i) {
        const Image<vec4>& texels = texture.levels[i].texels;
        double greatest = 0, sum_of_squares = 0, kept = 0;
        for (const vec4& texel : texels.pixels())
            for (int c = 0; c < 3; ++c) {
                const float rounded =
                    linear_from_srgb(static_cast<float>(srgb8_from_linear(texel[c])) / 255.0f);
                const double error = std::abs(static_cast<double>(rounded - texel[c]));
                greatest = std::max(greatest, error);
                sum_of_squares += error * error;
                kept += rounded == texel[c];
            }
        const double count = 3 * static_cast<double>(texels.pixels().size());
        add_variant("levels", std::to_string(texture.levels[i].size.x), count,
                    {{"greatest error, millionths", 1e6 * greatest},
                     {"RMS error, millionths", 1e6 * std::sqrt(sum_of_squares / count)},
                     {"numbers kept, %", 100 * kept / count}},
                    [&texels] { [[maybe_unused]] volatile float sink = texels.pixels()[0].x; });
    }
}

}  // namespace rasterbook::test
