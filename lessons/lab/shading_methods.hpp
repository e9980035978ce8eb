// SPDX-License-Identifier: MIT
/// @file
/// Other places to compute the light of lesson 06 in, and other highlights; measured in
/// docs/accuracy/06_phong.md.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

#include "05_textures/interpolation.hpp"
#include "06_phong/face_normal.hpp"
#include "06_phong/phong.hpp"
#include "06_phong/surface.hpp"
#include "common/app/lesson_app.hpp"

namespace rasterbook {

/// Light is computed once for a face, for its vertices, or for each pixel.
enum class Shading { flat, gouraud, phong };

/// How a highlight falls off: by the angle between mirror direction and eye, or between the normal
/// and the direction halfway from light to eye.
enum class Highlight { phong, blinn };

/// How the power of a highlight is computed.
enum class Power { polynomial, in_double, squarings, schlick };

/// What is done with a normal that is interpolated: scaled to length 1, scaled by an approximate
/// root, or nothing.
enum class NormalScaling { exact, approximate, none };

struct ShadingMethod {
    Shading shading = Shading::phong;
    Highlight highlight = Highlight::phong;
    Power power = Power::polynomial;
    NormalScaling normals = NormalScaling::exact;

    void declare(OptionParser& parser) {
        parser.choice(
            "--shading", shading,
            {{"flat", Shading::flat}, {"gouraud", Shading::gouraud}, {"phong", Shading::phong}},
            "Lighting per face, per vertex, or per pixel");
        parser.choice("--highlight", highlight,
                      {{"phong", Highlight::phong}, {"blinn", Highlight::blinn}},
                      "Highlights by the mirrored direction, or by the halfway vector");
        parser.choice("--power", power,
                      {{"polynomial", Power::polynomial},
                       {"double", Power::in_double},
                       {"squarings", Power::squarings},
                       {"schlick", Power::schlick}},
                      "How the power of a highlight is computed");
        parser.choice("--normals", normals,
                      {{"exact", NormalScaling::exact},
                       {"approximate", NormalScaling::approximate},
                       {"none", NormalScaling::none}},
                      "How an interpolated normal is scaled to length 1");
    }

    bool operator==(const ShadingMethod&) const = default;
};

/// x * x * ... as often as `exponent` says, rounded to a whole number, at most 1e6.
///
/// @return  Within exponent * 2^-24 of the power, relative to it, where it is not subnormal.
inline float power_by_squarings(float x, float exponent) {
    auto bits = static_cast<unsigned>(std::clamp(exponent, 0.0f, 1e6f) + 0.5f);
    float result = bits & 1 ? x : 1.0f;
    while (bits >>= 1) {
        x *= x;
        if (bits & 1) result *= x;
    }
    return result;
}

/// A curve that looks like a power: also 0 at 0 and 1 at 1, and as steep at 1.
///
/// @return  For an exponent of 1 and above at least the power, and at most .204 more.
/// @see Schlick, "A fast alternative to Phong's specular model", Graphics Gems IV, 1994
inline float power_by_schlick(float x, float exponent) {
    if (exponent == 0) return 1;
    x = std::min(x, 1.0f);  // beyond 1, what it is divided by may vanish
    return x / (exponent - exponent * x + x);
}

/// x to the power of `exponent`; 1 for an exponent of 0.
///
/// @param x  0 to about 1.
inline float power_as(Power power, float x, float exponent) {
    switch (power) {
        case Power::in_double:
            return static_cast<float>(std::pow(double{x}, double{exponent}));
        case Power::squarings:
            return power_by_squarings(x, exponent);
        case Power::schlick:
            return power_by_schlick(x, exponent);
        case Power::polynomial:
            break;
    }
    return rasterbook::power(x, exponent);
}

/// v times 1/|v| from a guess by its bits and one step of Newton's: within .18%.
///
/// @see Lomont, "Fast inverse square root", 2003
inline vec3 unit_approximate(vec3 v) {
    const float squared = glm::dot(v, v);
    const float guess = std::bit_cast<float>(0x5f375a86u - (std::bit_cast<unsigned>(squared) >> 1));
    return v * (guess * (1.5f - 0.5f * squared * guess * guess));
}

/// The cosine that Blinn's highlight is a power of: 0 to 1 (Eq. 6.4).
inline float blinn_cosine(const SurfacePoint<float>& point, vec3 toward_light) {
    // Light and eye opposite: there is no halfway, and no highlight either.
    const vec3 halfway = unit_or(toward_light + point.toward_eye, vec3(0));
    return clamp(glm::dot(point.normal_world, halfway), 0.0f, 1.0f);
}

/// PhongHighlight, or what the method puts in its place.
struct HighlightBy {
    bool is_on;
    float shininess;
    Highlight highlight;
    Power power;

    float operator()(const SurfacePoint<float>& point, vec3 toward_light) const {
        const float cosine = highlight == Highlight::blinn ? blinn_cosine(point, toward_light)
                                                           : phong_cosine(point, toward_light);
        const float result = power_as(power, cosine, shininess);
        // Schlick's curve has no such end: it is still .05 where the power of 90 is unseen.
        return result < min_highlight && power != Power::schlick ? 0.0f : result;
    }
};

inline HighlightBy highlight_of(const ShadingMethod& method, const TriangleSurface& surface) {
    return {surface.effects[Effect::highlight], surface.material.shininess, method.highlight,
            method.power};
}

/// Scales a point's normal as the method has it, in place of Eq. 6.8.
///
/// @param normal  Interpolated.
inline void scale_normal(const ShadingMethod& method, vec3 normal, SurfacePoint<float>& point) {
    if (method.normals == NormalScaling::none) point.normal_world = normal;
    if (method.normals == NormalScaling::approximate) point.normal_world = unit_approximate(normal);
}

/// For flat and Gouraud shading: light that is computed before the pixels are visited, once, or at
/// each vertex.
struct VertexLighting {
    Shading shading;
    std::array<vec3, 3> diffuse{}, specular{};  ///< For flat shading the first.

    bool is_used() const { return shading != Shading::phong; }

    ReflectedLight at(Barycentrics barycentrics) const {
        if (shading == Shading::flat) return {diffuse[0], specular[0]};
        return {interpolate(diffuse, barycentrics), interpolate(specular, barycentrics)};
    }
};

inline VertexLighting light_vertices(const ShadingMethod& method, std::span<const Light> lights,
                                     vec3 eye_world, const TriangleSurface& surface,
                                     const ProjectedTriangle& projected) {
    VertexLighting result{method.shading};
    if (!surface.effects[Effect::light] || !result.is_used()) return result;
    const Uncounted vertices;  // only fragments are counted
    const auto light = [&](std::size_t i, Barycentrics at, vec3 normal) {
        SurfacePoint<float> point = surface_point(surface, at, normal, eye_world);
        point.normal_world = normal;  // it has length 1 already
        const ReflectedLight sum = reflected_light(lights, point, highlight_of(method, surface));
        result.diffuse[i] = sum.diffuse, result.specular[i] = sum.specular;
    };
    if (method.shading == Shading::flat) {
        const vec3 front = face_normal(projected.mesh, projected.triangle);
        light(0, Barycentrics(1.0f / 3), projected.is_back_facing ? -front : front);
        return result;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        trace("light at vertex", std::array{"a", "b", "c"}[i]);
        Barycentrics vertex(0);
        vertex[static_cast<int>(i)] = 1;
        light(i, vertex, surface.normals_world[i]);
    }
    return result;
}

}  // namespace rasterbook
