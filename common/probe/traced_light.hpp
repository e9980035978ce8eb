// SPDX-License-Identifier: MIT
/// @file
/// What `--probe` notes of the light of a light source.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "common/model/mesh.hpp"
#include "common/probe/pixel_trace.hpp"

namespace rasterbook {

/// Notes what of a light arrives at a point of a surface.
///
/// @param number  Of the light, from 0.
/// @param sum     Of the lights before it.
template <typename Light, typename Point, typename Highlight, typename Sum>
[[gnu::cold, gnu::noinline]] void note_light(std::size_t number, const Light& light, Point point,
                                             Highlight highlight, Sum sum) {
    using Kind = decltype(light.kind);
    constexpr std::array kinds = {"directional light", "point light", "spotlight"};
    trace(("light " + std::to_string(number + 1)).c_str(),
          kinds[static_cast<std::size_t>(light.kind)]);
    const auto incoming = incoming_light(light, point.position_world);
    const float cosine = traced_lane(glm::dot(point.normal_world, incoming.toward));
    trace("  arriving", incoming.color,
          light.kind == Kind::directional ? ""
          : light.kind == Kind::point     ? "Eq. 6.6"
                                          : "Eq. 6.6 and 6.7");
    trace("  cosine", words(cosine) + (cosine > 0 ? "" : ": turned away"), "Eq. 6.1");
    pixel_trace->diffuse_before.reset();
    if (!(cosine > 0)) return;
    pixel_trace->diffuse_before = traced_lane(sum.diffuse);
    pixel_trace->specular_before = traced_lane(sum.specular);
    if (!highlight.is_on) return;
    std::string shininess;
    if constexpr (requires { highlight.shininess; })
        shininess = ", shininess " + words(highlight.shininess);
    trace("  highlight", words(traced_lane(highlight(point, incoming.toward))) + shininess,
          "Eq. 6.3");
}

/// Notes what a light adds to the sum of lights.
template <typename Sum>
[[gnu::cold, gnu::noinline]] void note_added(Sum sum) {
    if (!pixel_trace->diffuse_before) return;
    trace("  adds diffuse", traced_lane(sum.diffuse) - *pixel_trace->diffuse_before);
    const vec3 specular = traced_lane(sum.specular) - pixel_trace->specular_before;
    if (specular != vec3(0)) trace("  adds specular", specular);
}

/// Notes, around add_light(), what of a light arrives, and what it adds.
template <typename Sum>
class TracedLight {
  public:
    /// @param sum  Of the lights; to which this one is added while this object lives.
    template <typename Light, typename Point, typename Highlight>
    TracedLight(std::size_t number, const Light& light, const Point& point,
                const Highlight& highlight, const Sum& sum)
        : sum_(sum) {
        if constexpr (has_probe)
            if (is_traced()) note_light(number, light, point, highlight, sum);
    }
    ~TracedLight() {
        if constexpr (has_probe)
            if (is_traced()) note_added(sum_);
    }
    TracedLight(const TracedLight&) = delete;
    TracedLight& operator=(const TracedLight&) = delete;

  private:
    const Sum& sum_;
};

/// Notes the light that comes from all around, and that of all lights.
template <typename Sum>
void trace_sum(vec3 ambient, const Sum& light) {
    trace("ambient light", ambient);
    trace("diffuse light", light.diffuse);
    trace("specular light", light.specular);
}

}  // namespace rasterbook
