// SPDX-License-Identifier: MIT
/// @file
/// What "Why this pixel?" says of shadows, in this lesson and all later ones, for `--probe`.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "09_shadow_maps/shadows.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// Says which depths a shadow test compares.
///
/// @param map       The map's number, counted through all lights.
/// @param triangle  With the bias that has been fitted to it for this map.
inline void report_shadow_test(PixelReport& report, const ShadowMaps& shadow_maps, std::size_t l,
                               std::size_t map, const ShadowBiasCache& triangle,
                               const PcfKernel& kernel) {
    const LightShadowMaps& of_light = shadow_maps.of_light[l];
    const ShadowMap& asked = of_light.maps[map - of_light.first_map];
    const float in_map = asked.depths.depths()[kernel.middle + max_pcf_radius];
    report.line("  shadow map",
                "texel " + words(kernel.middle) + " of " + std::to_string(asked.size) + "x" +
                    std::to_string(asked.size),
                "Eq. 9.6");
    for (const bool is_back : {false, true})
        if (const ShadowBias* const bias = triangle.known_bias(map, is_back))
            report.line("  bias", bias->bias, "Eq. 9.10");
    const float depth = std::max(kernel.depth, DepthBuffer::cleared);
    report.line(
        "  depths compared",
        words(depth, 7) + (depth >= in_map ? " is not behind " : " is behind ") + words(in_map, 7),
        "Eq. 9.7");
    const int side = 2 * shadow_maps.radius + 1;
    const float lit = pcf_visibility(asked, shadow_maps.radius, kernel);
    report.line("  taps that say lit",
                std::to_string(std::lrint(lit * static_cast<float>(side * side))) + " of " +
                    std::to_string(side * side),
                "Eq. 9.13");
}

/// Says how much of a light reaches a point of a triangle, and why.
inline float report_visibility(PixelReport& report, const ShadowMaps& shadow_maps, std::size_t l,
                               ShadowBiasCache& triangle, vec3 position, vec3 normal) {
    bool is_tested = false;
    const float visibility = light_visibility(
        shadow_maps, l, triangle, position, normal, [&](std::size_t map, const PcfKernel& kernel) {
            is_tested = true;
            report_shadow_test(report, shadow_maps, l, map, triangle, kernel);
        });
    if (is_tested)
        report.line("  visibility", visibility, "Eq. 9.16");
    else
        report.line("  visibility",
                    words(visibility) + (shadow_maps.of_light[l].maps.empty()
                                             ? ": the light casts no shadows"
                                         : visibility == 0 ? ": the surface is turned away"
                                                           : ": outside of the shadow map"));
    return visibility;
}

}  // namespace rasterbook
