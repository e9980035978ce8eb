// SPDX-License-Identifier: MIT
/// @file
/// Normal maps: where tangent frames are computed, and how normals are stored.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "accuracy/accuracy.hpp"
#include "support/normal_mapped_torus.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

void add_frames() {
    static Image<vec3> normals(NormalMappedTorus::size);
    const std::pair<const char*, NormalMapMethod> ways[] = {
        {"face", {.frame = FrameOf::face}},
        {"vertex", {}},
        {"vertex, interpolated", {.orthonormal = Orthonormal::at_vertices}},
        {"pixel", {.frame = FrameOf::pixel}}};
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
    ErrorSum errors, to_60;
    for (const dvec3 n : directions(1'000'000)) {
        const auto off = degrees_off(decode(texel_of(n)), TrueTorus::lvec3(n.x, n.y, n.z));
        errors.add(off);
        if (n.z >= 0.5) to_60.add(off);
    }
    const double flat =
        static_cast<double>(degrees_off(decode(texel_of({0, 0, 1})), TrueTorus::lvec3(0, 0, 1)));
    std::vector<Texel> some;
    for (const dvec3 n : directions(4096)) some.push_back(texel_of(n));
    add_variant("storage", name, static_cast<double>(some.size()),
                {{"greatest error, degrees", errors.greatest()},
                 {"greatest up to 60", to_60.greatest()},
                 {"RMS", errors.rms()},
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

/// Some are encoded for one decoding and decoded by the other.
void add_storages() {
    using S = Stored<8>;
    const auto unorm = [](double x) { return S::unorm(x); };
    const auto snorm = [](double x) { return S::snorm(x); };
    const auto as_unorm = [](Texel t) { return S::as_unorm(t); };
    const auto as_snorm = [](Texel t) { return S::as_snorm(t); };
    add_storage("8 bits", unorm, as_unorm);
    add_storage("8 bits, x y", unorm, [](Texel t) { return with_z(vec2(S::as_unorm(t))); });
    add_storage(
        "16 bits", [](double x) { return Stored<16>::unorm(x); },
        [](Texel t) { return Stored<16>::as_unorm(t); });
    add_storage("8 bits, SNORM", snorm, as_snorm);
    add_storage("8 bits, UNORM decoded as SNORM", unorm, as_snorm);
    add_storage("8 bits, SNORM decoded as UNORM", snorm, as_unorm);
}

}  // namespace

int main(int argc, char** argv) {
    add_frames();
    add_storages();
    return measure_variants(argc, argv);
}
