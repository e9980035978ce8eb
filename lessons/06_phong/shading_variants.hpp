// SPDX-License-Identifier: MIT
/// @file
/// Where light is computed and how exactly, to be seen with `--shading`, `--highlight`, `--power`
/// and `--normals`, and measured in docs/accuracy/06_phong.md.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

#include "05_textures/interpolation.hpp"
#include "06_phong/lit_points.hpp"
#include "06_phong/lit_scene.hpp"
#include "06_phong/normals.hpp"
#include "06_phong/phong.hpp"
#include "common/lesson_app.hpp"

namespace rasterbook {

/// Light is computed once for a face, for its corners, or for each pixel.
enum class Shading { flat, gouraud, phong };

/// How the power of a highlight is computed.
enum class Power { in_float, in_double, squarings, schlick };

/// What is done with a normal that is interpolated: scaled to length 1, scaled by an approximate
/// root, or nothing.
enum class NormalScaling { exact, approximate, none };

/// What every scene with lights can be asked for, in this lesson and all later ones.
struct LightOptions {
    LightKind key_light = LightKind::point;
    bool two_sided = false;
    bool all_effects = false;

    void declare(Knobs& knobs) {
        knobs.choice("--light", key_light,
                     {{"sun", LightKind::directional},
                      {"lamp", LightKind::point},
                      {"spot", LightKind::spot}},
                     "What the scene is lit by");
        knobs.flag("--two-sided", two_sided, "Draw the backs of faces, too");
        knobs.flag("--all-effects", all_effects,
                   "Compute each effect also where it can change nothing");
    }
};

struct ShadingVariant : LightOptions {
    Shading shading = Shading::phong;
    Highlight highlight = Highlight::phong;
    Power power = Power::in_float;
    NormalScaling normals = NormalScaling::exact;

    void declare(Knobs& knobs) {
        knobs.choice(
            "--shading", shading,
            {{"flat", Shading::flat}, {"gouraud", Shading::gouraud}, {"phong", Shading::phong}},
            "Light is computed once for a face, for its corners, or for each pixel");
        knobs.choice("--highlight", highlight,
                     {{"phong", Highlight::phong}, {"blinn", Highlight::blinn}},
                     "Highlights by the mirror direction, or by the halfway one");
        knobs.choice("--power", power,
                     {{"float", Power::in_float},
                      {"double", Power::in_double},
                      {"squarings", Power::squarings},
                      {"schlick", Power::schlick}},
                     "How the power of a highlight is computed");
        knobs.choice("--normals", normals,
                     {{"exact", NormalScaling::exact},
                      {"approximate", NormalScaling::approximate},
                      {"none", NormalScaling::none}},
                     "How an interpolated normal is scaled to length 1");
        LightOptions::declare(knobs);
    }
};

/// x * x * ... as often as `exponent` says, rounded to a whole number.
///
/// @return  Within `exponent` half ulps of the power, relative to it, where it is not subnormal.
inline float power_by_squarings(float x, float exponent) {
    auto bits = static_cast<unsigned>(std::clamp(exponent, 0.0f, 1e6f) + 0.5f);
    float result = bits & 1 ? x : 1.0f;
    while (bits >>= 1) {
        x *= x;
        if (bits & 1) result *= x;
    }
    return result;
}

/// A curve that looks like a power: also 0 at 0 and 1 at 1, and as steep there.
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
        case Power::in_float:
            break;
    }
    return std::pow(x, exponent);
}

/// v times 1/|v| from a guess by its bits and one step of Newton's: within .18%.
///
/// @see Lomont, "Fast inverse square root", 2003
inline vec3 unit_approximate(vec3 v) {
    const float squared = glm::dot(v, v);
    const float guess = std::bit_cast<float>(0x5f375a86u - (std::bit_cast<unsigned>(squared) >> 1));
    return v * (guess * (1.5f - 0.5f * squared * guess * guess));
}

/// A highlight below 2 to the power of minus this is none: no power is computed for it.
constexpr float unseen_bits = 26;

/// The least cosine of a highlight that can be seen. Schlick's curve has no such end: it is still
/// .05 where the power of 90 is unseen.
inline float least_seen_cosine(Power power, float exponent) {
    return power == Power::schlick ? 0.0f : std::exp2(-unseen_bits / exponent);
}

/// The light on a triangle: computed for each fragment, or before, for its corners or once.
class TriangleLight {
  public:
    /// @param mesh     Each corner has a normal of length 1.
    /// @param is_back  The triangle is seen from behind: its normals point to the other side.
    TriangleLight(const ShadingVariant& variant, std::span<const Light> lights, vec3 eye_world,
                  const Mesh& mesh, const Triangle& triangle, bool is_back,
                  const TriangleSurface& surface)
        : variant_(variant),
          lights_(lights),
          eye_world_(eye_world),
          has_highlight_(surface.effects.highlight),
          shininess_(surface.material.shininess),
          least_cosine_(has_highlight_ ? least_seen_cosine(variant.power, shininess_) : 1.0f),
          at_once_(variant.shading == Shading::phong && variant.highlight == Highlight::phong &&
                   variant.normals == NormalScaling::exact) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Corner corner = triangle.corners[i];
            positions_[i] = mesh.positions[corner.position];
            normals_[i] = is_back ? -mesh.normals[corner.normal] : mesh.normals[corner.normal];
        }
        if (!surface.effects.light || variant.shading == Shading::phong) return;
        if (variant.shading == Shading::gouraud)
            for (std::size_t i = 0; i < 3; ++i)
                set_corner(i, reflected(positions_[i], normals_[i]));
        else
            set_corner(0, reflected(interpolate(positions_, vec3(1.0f / 3)),
                                    face_normal(mesh, triangle) * (is_back ? -1.0f : 1.0f)));
    }

    /// @param weights  Of the corners.
    template <typename CounterPolicy>
    ReflectedLight at(vec3 weights, CounterPolicy& counters) const {
        count(counters);
        if (variant_.shading == Shading::flat) return {diffuse_[0], specular_[0]};
        if (variant_.shading == Shading::gouraud)
            return {interpolate(diffuse_, weights), interpolate(specular_, weights)};
        const vec3 normal = interpolate(normals_, weights);
        return reflected(interpolate(positions_, weights), scaled(normal));
    }

    /// Adds a fragment to those that are lit together.
    ///
    /// @param weights  Of the corners.
    /// @param points   Fewer than most_points.
    template <typename CounterPolicy>
    void add(vec3 weights, LitPoints& points, CounterPolicy& counters) const {
        const std::size_t i = points.count++;
        if (!at_once_) return points.set_light(i, at(weights, counters));
        count(counters);
        points.position_world.set(i, interpolate(positions_, weights));
        points.normal_world.set(i, interpolate(normals_, weights));
    }

    /// Adds fragments to those that are lit together, of which there is none yet.
    template <typename CounterPolicy>
    void add(const ManyWeights& weights, LitPoints& points, CounterPolicy& counters) const {
        if (!at_once_) {
            for (std::size_t i = 0; i < weights.count; ++i) add(weights.here[i], points, counters);
            return;
        }
        const std::array positions = positions_, normals = normals_;
        points.count = weights.count;
        for (std::size_t i = 0; i < weights.count; ++i) {
            points.position_world.set(i, interpolate(positions, weights.here[i]));
            points.normal_world.set(i, interpolate(normals, weights.here[i]));
        }
        for (std::size_t i = 0; i < weights.count; ++i) count(counters);
    }

    /// The light on all of them: the same bits as of at(), sooner.
    void compute(LitPoints& points) const {
        compute(points, [](std::size_t, std::size_t) { return 1.0f; });
    }

    /// The same, where not all light arrives.
    ///
    /// @param share  As of reflect_light().
    template <typename Share>
    void compute(LitPoints& points, const Share& share) const {
        if (!at_once_) return;
        const auto reflect = [&](bool has_highlight) {
            return reflect_light(
                lights_, eye_world_, has_highlight, points,
                [this](float cosine) { return power(cosine); }, share);
        };
        // Compiled twice: the second time without all that a highlight takes.
        if (has_highlight_ ? reflect(true) : reflect(false)) return;
        for (std::size_t i = 0; i < points.count; ++i) {
            ReflectedLight sum;
            for (std::size_t l = 0; l < lights_.size(); ++l) {
                const ReflectedLight light =
                    reflected(lights_.subspan(l, 1), points.position_world[i],
                              scaled(points.normal_world[i]));
                sum.diffuse += share(l, i) * light.diffuse;
                sum.specular += share(l, i) * light.specular;
            }
            points.set_light(i, sum);
        }
    }

  private:
    template <typename CounterPolicy>
    void count(CounterPolicy& counters) const {
        counters.add(Counter::fragments_lit);
        if (has_highlight_) counters.add(Counter::highlights);
    }

    void set_corner(std::size_t i, const ReflectedLight& light) {
        diffuse_[i] = light.diffuse, specular_[i] = light.specular;
    }

    vec3 scaled(vec3 normal) const {
        if (variant_.normals == NormalScaling::none) return normal;
        if (variant_.normals == NormalScaling::approximate) return unit_approximate(normal);
        return unit_or(normal, normals_[0]);  // Eq. 6.8
    }

    ReflectedLight reflected(vec3 position, vec3 normal) const {
        return reflected(lights_, position, normal);
    }

    ReflectedLight reflected(std::span<const Light> lights, vec3 position, vec3 normal) const {
        const vec3 toward_eye = has_highlight_ ? unit_or(eye_world_ - position, normal) : vec3(0);
        const SurfacePoint point{position, normal, toward_eye};
        return reflected_light(lights, point, has_highlight_, variant_.highlight,
                               [this](float cosine) { return power(cosine); });
    }

    float power(float cosine) const {
        return cosine < least_cosine_ ? 0.0f : power_as(variant_.power, cosine, shininess_);
    }

    ShadingVariant variant_;
    std::span<const Light> lights_;
    vec3 eye_world_;
    bool has_highlight_;
    float shininess_;
    float least_cosine_;  ///< Of a highlight that can be seen.
    bool at_once_;        ///< Light is the one that reflect_light() computes.
    std::array<vec3, 3> positions_, normals_;
    std::array<vec3, 3> diffuse_, specular_;  ///< For Gouraud at the corners; for flat the first.
};

}  // namespace rasterbook
