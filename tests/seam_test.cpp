// SPDX-License-Identifier: MIT
// The lessons' shading is templated on the number type: each lane of eight floats gets the same
// bits as a single float, whatever its neighbours need.
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "04_mvp/clip.hpp"
#include "05_textures/interpolation.hpp"
#include "06_phong/light.hpp"
#include "06_phong/phong.hpp"
#include "08_normal_maps/normal_map.hpp"
#include "08_normal_maps/tangent_frame.hpp"
#include "common/math/functions.hpp"
#include "support/float8.hpp"
#include "support/projected.hpp"
#include "support/special_numbers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr std::size_t fragments = 100'000, numbers = 1'000'000;

/// What stages give, each number with the stage's name.
template <typename F>
struct Results {
    std::vector<std::pair<const char*, F>> numbers;

    void add(const char* stage, F x) { numbers.emplace_back(stage, x); }
    void add(const char* stage, const Vec3<F>& v) {
        add(stage, v.x), add(stage, v.y), add(stage, v.z);
    }
};

/// How many numbers of a lane have other bits than those that were found alone.
std::size_t differing_bits(const Results<Float8>& all, std::size_t lane,
                           const Results<float>& alone) {
    std::size_t differing = 0;
    for (std::size_t i = 0; i < alone.numbers.size(); ++i) {
        const auto& [stage, expected] = alone.numbers[i];
        const float actual = all.numbers[i].second[lane];
        if (std::bit_cast<std::uint32_t>(actual) == std::bit_cast<std::uint32_t>(expected))
            continue;
        if (differing++ == 0)
            ADD_FAILURE() << stage << ", lane " << lane << ": " << actual << " instead of "
                          << expected;
    }
    return differing;
}

/// A fragment's own numbers.
template <typename F>
struct Fragment {
    Vec3<F> on_screen;  ///< Barycentric coordinates.
    std::array<Vec3<F>, 3> normals, tangents;
    F handedness;
    Vec3<F> position, eye, in_normal_map;
    std::array<F, 3> visibility;
    FragmentColor<F> color;
};

/// What eight fragments have in common.
struct Common {
    PerspectiveSetup setup;
    std::array<Light, 3> lights;
    PhongHighlight highlight;
};

template <typename F>
Results<F> shade(const Common& common, const Fragment<F>& f) {
    Results<F> results;
    const PerspectiveBarycentrics<F> at = perspective_correct(common.setup, f.on_screen);
    results.add("perspective_correct", at.here);
    results.add("its ddx", at.ddx), results.add("its ddy", at.ddy);
    const Vec3<F> normal = interpolate(f.normals, at.here);
    const TangentBasis<F> frame =
        tangent_frame(interpolate(f.tangents, at.here), normal, f.handedness);
    results.add("tangent", frame.tangent), results.add("bitangent", frame.bitangent);
    results.add("normal", frame.normal);
    const Vec3<F> mapped = perturbed(frame, f.in_normal_map, normal);
    results.add("perturbed", mapped);

    const Vec3<F> unit_normal = unit_or(mapped, frame.normal);
    const Vec3<F> toward_eye = unit_or(f.eye - f.position, unit_normal);
    const SurfacePoint<F> point{f.position, unit_normal, toward_eye};
    for (const Light& light : common.lights) {
        const Incoming<F> incoming = incoming_light(light, f.position);
        results.add("toward the light", incoming.toward);
        results.add("incoming color", incoming.color);
        results.add("highlight", common.highlight(point, incoming.toward));
    }
    const LightSum<F> sum =
        reflected_light(std::span<const Light>(common.lights), point, common.highlight,
                        [&](std::size_t l, auto...) { return f.visibility[l]; });
    results.add("diffuse", sum.diffuse), results.add("specular", sum.specular);
    results.add("phong", phong(f.color, vec3(0.04f, 0.05f, 0.07f), sum));
    return results;
}

/// Ordinary inputs, and every second time hard ones.
class Inputs {
  public:
    Common common() {
        Common common{setup(), {}, {below(8) != 0, one_of(0.0f, 1.0f, 90.0f, 1000.0f)}};
        for (std::size_t l = 0; l < 3; ++l) {
            const float cos_outer = between(-0.9f, 0.9f);
            common.lights[l] = {
                static_cast<LightKind>(l), glm::abs(vector()), direction(), 3.0f * vector(),
                between(0.5f, 4),          cos_outer + 0.1f,   cos_outer};
        }
        return common;
    }

    Fragment<float> fragment(const Common& common) {
        Fragment<float> f;
        const float u = between(0, 1), v = between(0, 1 - u);
        f.on_screen = below(4) ? vec3(1 - u - v, u, v) : mat3(1)[static_cast<int>(below(3))];
        const vec3 normal = 0.5f * direction();
        for (vec3& of_vertex : f.normals) of_vertex = normal + 0.3f * vector();
        for (vec3& of_vertex : f.tangents) of_vertex = vector();
        if (below(2))
            for (vec3& of_vertex : f.normals)
                of_vertex *= one_of(0.0f, 1e-45f, 1e-30f, 1e30f, FLT_MAX, infinity, not_a_number);
        if (below(2))  // parallel to the normals, or nearly so
            for (std::size_t i = 0; i < 3; ++i)
                f.tangents[i] = f.normals[i] + one_of(0.0f, 1e-7f, 1e-2f) * vector();
        f.handedness = below(2) ? 1.0f : -1.0f;
        f.position = vector(), f.eye = 4.0f * vector();
        if (below(4) == 0)
            f.position = one_of(common.lights[1].position_world, f.eye, vec3(FLT_MAX, 0, -FLT_MAX));
        f.in_normal_map = vector() + vec3(0, 0, 1);
        if (below(4) == 0) f.in_normal_map = one_of(vec3(0), vec3(1e-40f, 0, 1), vec3(infinity));
        for (float& visibility : f.visibility)
            visibility = below(2) ? between(0, 1) : one_of(0.0f, 1.0f);
        f.color = {glm::abs(vector()), glm::abs(vector()), glm::abs(vector()), glm::abs(vector())};
        return f;
    }

    unsigned below(unsigned count) { return static_cast<unsigned>(random_()) % count; }
    float between(float least, float greatest) {
        return least + (greatest - least) * static_cast<float>(random_() >> 8) * 0x1p-24f;
    }
    /// Any float whatever.
    float bits() { return std::bit_cast<float>(static_cast<std::uint32_t>(random_())); }
    template <typename T, typename... Others>
    T one_of(T first, Others... others) {
        const std::array all{first, T(others)...};
        return all[below(static_cast<unsigned>(all.size()))];
    }

  private:
    vec3 vector() {
        const float x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
        return {x, y, z};
    }
    vec3 direction() { return unit_or(vector(), vec3(0, 1, 0)); }

    /// Of a triangle in view, or of what clipping has left of one.
    PerspectiveSetup setup() {
        for (;;) {
            const std::array<vec4, 3> clip = {vec4(vector(), between(0.1f, 2)),
                                              vec4(vector(), between(0.5f, 9)),
                                              vec4(3.0f * vector(), between(-3, 3))};
            for (const ClippedTriangle& clipped : clip_triangle(clip)) {
                const ScreenTriangle on_screen = projected(clipped, {640, 360}).on_screen;
                if (on_screen.twice_area != 0) return perspective_setup(on_screen, clipped);
            }
        }
    }

    std::mt19937 random_{1};
};

/// Eight structs of nothing but floats as one of Float8.
template <template <typename> typename Struct>
Struct<Float8> together(const std::array<Struct<float>, Float8::lanes>& structs) {
    constexpr std::size_t count = sizeof(Struct<float>) / sizeof(float);
    std::array<Float8, count> all;
    for (std::size_t lane = 0; lane < Float8::lanes; ++lane) {
        const auto of_lane = std::bit_cast<std::array<float, count>>(structs[lane]);
        for (std::size_t i = 0; i < count; ++i) all[i].set(lane, of_lane[i]);
    }
    return std::bit_cast<Struct<Float8>>(all);
}

template <typename F>
struct Pair {
    F x, y;
};

template <typename F>
Results<F> functions_of(const Pair<F>& pair) {
    const auto [x, y] = pair;
    Results<F> results;
    results.add("exp2", rasterbook::exp2(x)), results.add("log2", rasterbook::log2(x));
    results.add("power", power(x, y));
    results.add("min", rasterbook::min(x, y)), results.add("max", rasterbook::max(x, y));
    results.add("clamp", rasterbook::clamp(x, F(-1.0f), F(1.0f)));
    return results;
}

}  // namespace

TEST(Seam, EightLanesGetTheSameBitsAsOne) {
    Inputs inputs;
    std::size_t differing = 0;
    std::map<std::string_view, int> not_zero;
    for (std::size_t i = 0; i < fragments && differing < 10; i += Float8::lanes) {
        const Common common = inputs.common();
        std::array<Fragment<float>, Float8::lanes> each;
        for (Fragment<float>& fragment : each) fragment = inputs.fragment(common);
        const Results<Float8> all = shade(common, together(each));
        for (std::size_t lane = 0; lane < Float8::lanes; ++lane) {
            const Results<float> alone = shade(common, each[lane]);
            differing += differing_bits(all, lane, alone);
            for (const auto& [stage, x] : alone.numbers) not_zero[stage] += x != 0;
        }
    }
    EXPECT_EQ(differing, 0u);
    for (const auto& [stage, count] : not_zero) EXPECT_GT(count, int{fragments} / 5) << stage;
}

TEST(Seam, EightLanesGetTheSameBitsOfSpecialNumbers) {
    std::vector<float> special;
    for (const float x : {0.0f, 0.25f, 0x1.6a09e6p-1f, 1.0f, 0x1.6a09e6p0f, 2.0f, 90.0f, 126.0f,
                          127.0f, 128.0f, 149.0f, 1e-40f, FLT_MIN, FLT_MAX, infinity, not_a_number})
        for (const float near : {std::nextafter(x, 0.0f), x, std::nextafter(x, 2 * x)})
            special.insert(special.end(), {near, -near});
    Inputs inputs;
    const auto any = [&] {
        return inputs.below(2) ? special[inputs.below(static_cast<unsigned>(special.size()))]
                               : inputs.bits();
    };
    std::size_t differing = 0;
    for (std::size_t i = 0; i < numbers && differing < 10; i += Float8::lanes) {
        std::array<Pair<float>, Float8::lanes> each;
        for (auto& [x, y] : each) {
            x = any();
            do { y = std::abs(any()); } while (std::isnan(y));
        }
        const Results<Float8> all = functions_of(together(each));
        for (std::size_t lane = 0; lane < Float8::lanes; ++lane)
            differing += differing_bits(all, lane, functions_of(each[lane]));
    }
    EXPECT_EQ(differing, 0u);
}
