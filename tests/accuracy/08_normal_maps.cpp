// SPDX-License-Identifier: MIT
/// @file
/// Normal maps: where tangent frames are computed, and how normals are stored. Also draws the
/// page's figure: the angular error of each pixel's normal, in colour.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "accuracy/accuracy.hpp"
#include "common/image/image_io.hpp"
#include "support/normal_mapped_torus.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

struct Way {
    const char* name;
    NormalMapMethod variant;
};

const std::array<Way, 4> ways{{{"face", {.frame = FrameOf::face}},
                               {"vertex", {}},
                               {"vertex, interpolated", {.orthonormal = Orthonormal::at_vertices}},
                               {"pixel", {.frame = FrameOf::pixel}}}};

void add_frames() {
    static Image<vec3> normals(NormalMappedTorus::size);
    for (const auto& [name, variant] : ways)
        for (const auto& [mesh, around, across] : {std::tuple{"coarse", 16, 8}, {"fine", 64, 32}}) {
            const auto torus = std::make_shared<NormalMappedTorus>(around, across, variant);
            const NormalErrors errors = normal_errors(*torus);
            add_variant(
                "frames", std::string(name) + ", " + mesh, errors.fragments,
                {{"RMS error, degrees", errors.rms}, {"greatest", errors.greatest}}, [=] {
                    torus->draw([](ivec2 pixel, vec3 normal, vec2) { normals[pixel] = normal; });
                });
        }
}

/// Directions out of a surface, evenly spread over half a sphere.
std::vector<dvec3> directions(int count) {
    std::mt19937 random(1);
    std::normal_distribution<double> any;
    std::vector<dvec3> drawn;
    for (int i = 0; i < count; ++i) {
        dvec3 n(any(random), any(random), any(random));
        n.z = std::abs(n.z);
        drawn.push_back(glm::normalize(n));
    }
    return drawn;
}

using Texel = glm::vec<3, std::uint16_t>;

/// @param encode  Called as encode(component, -1 to 1): the value that is stored.
/// @param decode  Called as decode(texel): the normal, of any length.
template <typename Encode, typename Decode>
void add_storage(const char* name, Encode encode, Decode decode) {
    const auto texel_of = [&](dvec3 n) { return Texel(encode(n.x), encode(n.y), encode(n.z)); };
    double greatest = 0, greatest_to_60 = 0, squares = 0;
    const std::vector<dvec3> all = directions(1'000'000);
    for (const dvec3 n : all) {
        const auto off =
            static_cast<double>(degrees_off(decode(texel_of(n)), TrueTorus::lvec3(n.x, n.y, n.z)));
        greatest = std::max(greatest, off), squares += off * off;
        if (n.z >= 0.5) greatest_to_60 = std::max(greatest_to_60, off);
    }
    const double flat =
        static_cast<double>(degrees_off(decode(texel_of({0, 0, 1})), TrueTorus::lvec3(0, 0, 1)));
    std::vector<Texel> some;
    for (const dvec3 n : directions(4096)) some.push_back(texel_of(n));
    add_variant("storage", name, static_cast<double>(some.size()),
                {{"greatest error, degrees", greatest},
                 {"greatest up to 60", greatest_to_60},
                 {"RMS", std::sqrt(squares / static_cast<double>(all.size()))},
                 {"flat", flat}},
                [=] {
                    [[maybe_unused]] volatile float sink;
                    for (const Texel& texel : some) {
                        const vec3 n = decode(texel);
                        sink = n.x + n.y + n.z;
                    }
                });
}

/// What an encoder stores, and what a decoder makes of it, with so many bits a component.
template <int bits>
struct Stored {
    static std::uint16_t unorm(double component) {
        return static_cast<std::uint16_t>(
            std::floor((component + 1) / 2 * ((1 << bits) - 1) + 0.5));
    }
    static std::uint16_t snorm(double component) {
        return static_cast<std::uint16_t>(
            snorm_from_component(static_cast<float>(component), bits));
    }
    static vec3 as_unorm(Texel t) {
        return {component_from_unorm(t.x, bits), component_from_unorm(t.y, bits),
                component_from_unorm(t.z, bits)};
    }
    static vec3 as_snorm(Texel t) {
        return {component_from_snorm(t.x, bits), component_from_snorm(t.y, bits),
                component_from_snorm(t.z, bits)};
    }
};

template <int bits>
void add_bits(const char* name, const char* name_of_two) {
    using S = Stored<bits>;
    add_storage(name, [](double x) { return S::unorm(x); }, [](Texel t) { return S::as_unorm(t); });
    add_storage(
        name_of_two, [](double x) { return S::unorm(x); },
        [](Texel t) { return with_z(vec2(S::as_unorm(t))); });
}

/// 8 bits, encoded for one decoding and decoded by the other.
void add_decodings() {
    using S = Stored<8>;
    const auto unorm = [](double x) { return S::unorm(x); };
    const auto snorm = [](double x) { return S::snorm(x); };
    const auto as_unorm = [](Texel t) { return S::as_unorm(t); };
    const auto as_snorm = [](Texel t) { return S::as_snorm(t); };
    add_storage("8 bits, SNORM", snorm, as_snorm);
    add_storage("8 bits, UNORM decoded as SNORM", unorm, as_snorm);
    add_storage("8 bits, SNORM decoded as UNORM", snorm, as_unorm);
}

/// From black over blue and red to yellow, in eight steps; an error of `most` and above is white.
vec3 colour_of(double degrees, double most) {
    static const std::array<vec3, 6> stops{vec3(0.02f, 0.02f, 0.05f), vec3(0.1f, 0.16f, 0.55f),
                                           vec3(0.5f, 0.12f, 0.6f),   vec3(0.92f, 0.3f, 0.22f),
                                           vec3(1.0f, 0.78f, 0.2f),   vec3(1.0f)};
    const double step = std::min(std::floor(degrees / most * 8), 8.0) / 8 * 5;
    const auto low = static_cast<std::size_t>(std::min(std::floor(step), 4.0));
    return glm::mix(stops[low], stops[low + 1],
                    static_cast<float>(step - static_cast<double>(low)));
}

/// Face and vertex above, interpolated and pixel below, all of the coarse mesh; each 416 x 300.
/// Below them the scale, 0 degrees on the left. (A torus leaves more room above than below.)
void draw_angles(const std::filesystem::path& file) {
    constexpr double most = 6;
    constexpr int upwards = 24, margin = 40, scale = 14;
    const ivec2 each = NormalMappedTorus::size;
    Image<u8vec3> picture({2 * each.x, 2 * each.y + upwards}, {30, 34, 42});
    const auto written = [](vec3 color) { return u8vec3(255.0f * color + 0.5f); };
    for (std::size_t i = 0; i < ways.size(); ++i) {
        const ivec2 corner(static_cast<int>(i % 2) * each.x,
                           static_cast<int>(i / 2) * each.y - upwards);
        NormalMappedTorus(16, 8, ways[i].variant).draw([&](ivec2 pixel, vec3 normal, vec2 uv) {
            const auto off = degrees_off(normal, TrueTorus::normal(uv.x, uv.y));
            picture[corner + pixel] = written(colour_of(static_cast<double>(off), most));
        });
    }
    const int width = picture.size().x - 2 * margin;
    for (int x = 0; x < width; ++x)
        for (int y = 0; y < scale; ++y)
            picture[ivec2(margin, 2 * each.y - upwards / 2) + ivec2(x, y)] =
                written(colour_of(most * (9.0 / 8) * x / width, most));
    write_image(file, picture);
}

}  // namespace

int main(int argc, char** argv) {
    draw_angles(std::filesystem::path(RASTERBOOK_ASSETS).parent_path() /
                "docs/accuracy/08_normal_maps-angles.png");
    add_frames();
    add_bits<8>("8 bits", "8 bits, x y");
    add_bits<10>("10 bits", "10 bits, x y");
    add_bits<16>("16 bits", "16 bits, x y");
    add_decodings();
    return measure_variants(argc, argv);
}
