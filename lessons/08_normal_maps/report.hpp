// SPDX-License-Identifier: MIT
/// @file
/// What "Why this pixel?" says of normal maps, in this lesson and all later ones, for `--probe`.
#pragma once

#include "05_textures/interpolation.hpp"
#include "05_textures/probe.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// Says what a normal map makes of a normal.
///
/// @param normal  Interpolated, not yet scaled.
/// @return        Of any length.
inline vec3 report_normal(PixelReport& report, const TriangleNormalMap& map,
                          const FragmentBarycentrics& at, vec3 normal, Filter filter) {
    if (map.texture == nullptr) return normal;
    report.line("normal, interpolated", normal, "Eq. 5.1");
    const FragmentUv uv = fragment_uv(map.uvs, at);
    report_sample(report, "normal map", *map.texture, filter, uv);
    report.line("  normal of the map", sample_normal(*map.texture, filter, uv), "Eq. 8.1");
    if (map.space == MapSpace::tangent) {
        const TangentBasis<float> frame = frame_at(map, at.here, normal);
        report.line("  tangent", frame.tangent, "Eq. 8.5");
        report.line("  bitangent", frame.bitangent, "Eq. 8.5");
    }
    const vec3 mapped = normal_mapped(map, at, normal, filter);
    report.line("  normal, perturbed", mapped, "Eq. 8.7");
    return mapped;
}

}  // namespace rasterbook
