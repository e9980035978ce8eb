// SPDX-License-Identifier: MIT
/// @file
/// Light on a surface: where it is computed, how the power of a highlight is, and what is done with
/// normals that were interpolated.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/accuracy.hpp"
#include "lab/shading_methods.hpp"
#include "support/lit_sphere.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

const LitSphere& coarse() {
    static const LitSphere sphere(16, 32);
    return sphere;
}

const LitSphere& fine() {
    static const LitSphere sphere(64, 128);
    return sphere;
}

void add_places() {
    static Image<float> picture(LitSphere::size, 0);
    for (const auto& [name, shading] : {std::pair("flat", Shading::flat),
                                        {"Gouraud", Shading::gouraud},
                                        {"Phong", Shading::phong}})
        for (const LitSphere* sphere : {&coarse(), &fine()}) {
            const ShadingMethod variant{.shading = shading};
            const LightErrors errors = light_errors(*sphere, variant);
            add_variant("places", name + std::string(sphere == &fine() ? ", fine" : ", coarse"),
                        errors.fragments,
                        {{"RMS error", errors.rms}, {"greatest error", errors.greatest}}, [=] {
                            sphere->draw(variant,
                                         [](ivec2 pixel, float light) { picture[pixel] = light; });
                        });
        }
}

/// A power's values at steps of equal size, and straight lines between them.
class PowerTable {
  public:
    PowerTable(std::size_t entries, double exponent) {
        for (std::size_t i = 0; i < entries; ++i)
            values_.push_back(static_cast<float>(
                std::pow(static_cast<double>(i) / static_cast<double>(entries - 1), exponent)));
        values_.push_back(values_.back());  // so that 1 has a next value, too
        steps_ = static_cast<float>(entries - 1);
    }

    /// @param x  0 to 1.
    float operator()(float x) const {
        const float step = steps_ * x;
        const auto whole = static_cast<int>(step);
        const float* const value = &values_[static_cast<unsigned>(whole)];
        return value[0] + (step - static_cast<float>(whole)) * (value[1] - value[0]);
    }

  private:
    std::vector<float> values_;
    float steps_;
};

/// @param of_exponent  Called as of_exponent(n), gives what is called as power(x).
template <typename OfExponent>
void add_power(const char* name, OfExponent of_exponent) {
    Errors errors;
    for (const int exponent : {32, 90, 1000}) {
        constexpr int steps = 1'000'000;
        const auto power = of_exponent(static_cast<float>(exponent));
        ErrorSum sum;
        for (int i = 0; i <= steps; ++i) {
            const float x = static_cast<float>(i) / steps;
            sum.add(power(x) - std::pow(static_cast<long double>(x), exponent));
        }
        errors["greatest error, millionths at " + std::to_string(exponent)] = 1e6 * sum.greatest();
    }

    static const std::vector<float> cosines = [] {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> any(0, 1);
        std::vector<float> drawn(4096);
        for (float& cosine : drawn) cosine = any(random);
        return drawn;
    }();
    const auto power = of_exponent(32.0f);
    add_variant("power", name, static_cast<double>(cosines.size()), errors, [=] {
        // One at a time as in the lesson, not several in a vector: each result is stored.
        [[maybe_unused]] volatile float sink;
        for (const float cosine : cosines) sink = power(cosine);
    });
}

template <Power power>
void add_power_as(const char* name) {
    add_power(name,
              [](float exponent) { return [=](float x) { return power_as(power, x, exponent); }; });
}

/// Sums of the normals of the coarse sphere's vertices, as they are interpolated on it.
std::vector<vec3> interpolated_normals() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(0, 1);
    std::vector<vec3> normals;
    for (int i = 0; i < 4; ++i)
        for (const Triangle& triangle : coarse().mesh().triangles) {
            float u = any(random), v = any(random);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            vec3 normal(0);
            const float barycentrics[] = {1 - u - v, u, v};
            for (std::size_t k = 0; k < 3; ++k)
                normal += barycentrics[k] * coarse().mesh().normals[triangle.vertices[k].normal];
            normals.push_back(normal);
        }
    return normals;
}

template <typename Scale>
void add_normals(const char* name, NormalScaling scaling, Scale scale) {
    static const std::vector<vec3> normals = interpolated_normals();
    ErrorSum lengths;
    for (const vec3 normal : normals) {
        const vec3 v = scale(normal);
        const long double x = v.x, y = v.y, z = v.z;
        lengths.add(std::sqrt(x * x + y * y + z * z) - 1);
    }
    const ShadingMethod variant{.normals = scaling};
    add_variant("normals", name, static_cast<double>(normals.size()),
                {{"error of the length, millionths", 1e6 * lengths.greatest()},
                 {"RMS, coarse", light_errors(coarse(), variant).rms},
                 {"greatest, coarse", light_errors(coarse(), variant).greatest},
                 {"RMS, fine", light_errors(fine(), variant).rms},
                 {"greatest, fine", light_errors(fine(), variant).greatest}},
                [=] {
                    [[maybe_unused]] volatile float sink;
                    for (const vec3& normal : normals) {
                        const vec3 v = scale(normal);
                        sink = v.x + v.y + v.z;
                    }
                });
}

}  // namespace

int main(int argc, char** argv) {
    add_places();
    add_power_as<Power::polynomial>("polynomial");
    add_power_as<Power::in_double>("double");
    add_power("float",
              [](float exponent) { return [=](float x) { return std::pow(x, exponent); }; });
    add_power_as<Power::squarings>("squarings");
    add_power_as<Power::schlick>("Schlick");
    add_power("table, 256", [](float exponent) { return PowerTable(256, exponent); });
    add_power("table, 1024", [](float exponent) { return PowerTable(1024, exponent); });
    add_normals("exact", NormalScaling::exact,
                [](const vec3& v) { return unit_or(v, vec3(0, 1, 0)); });
    add_normals("approximate", NormalScaling::approximate,
                [](const vec3& v) { return unit_approximate(v); });
    add_normals("none", NormalScaling::none, [](const vec3& v) { return v; });
    return measure_variants(argc, argv);
}
