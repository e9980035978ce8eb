// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?": normal maps in one pixel, in this lesson and all later ones, for `--probe`.
#pragma once

#include "04_mvp/probe.hpp"
#include "06_phong/probe.hpp"
#include "06_phong/surface.hpp"
#include "08_normal_maps/assets.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "common/app/counters.hpp"
#include "common/app/lesson_app.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// Says what a normal map makes of a normal.
///
/// @param normal  Interpolated, not yet scaled.
/// @return        Of any length.
inline vec3 report_normal(PixelReport& report, const TriangleNormalMap& map,
                          const NormalMapVariant& variant, const FragmentBarycentrics& at,
                          vec3 normal, Filter filter) {
    if (map.texture == nullptr) return normal;
    NoCounters uncounted;
    report.line("normal, interpolated", normal, "Eq. 5.1");
    const FragmentUv uv = fragment_uv(map.uvs, at);
    report_sample(report, "normal map", *map.texture, filter, uv);
    report.line("  normal of the map", sample_normal(*map.texture, filter, uv), "Eq. 8.1");
    if (map.space == MapSpace::tangent) {
        const TangentBasis<float> frame = frame_at(map, variant, at.here, normal);
        report.line("  tangent", frame.tangent, "Eq. 8.5");
        report.line("  bitangent", frame.bitangent, "Eq. 8.5");
    }
    const vec3 mapped = normal_mapped(map, variant, at, normal, filter, uncounted);
    report.line("  normal, perturbed", mapped, "Eq. 8.7");
    return mapped;
}

/// What normal_map_probe() is to know of a lesson's options, wherever they stand.
struct NormalMapProbeOptions {
    const ivec2& size;
    const Orbit& orbit;
    const TextureOptions& texture;
    const LightOptions& shading;
    const NormalMapVariant& normal_map;
};

/// Explains pixels of this lesson's picture.
///
/// @param options, assets  What they refer to has to outlive the probe.
PixelProbe normal_map_probe(const NormalMapProbeOptions& options, const NormalMapAssets& assets);

/// The same, of all options of a lesson.
template <typename Options>
PixelProbe normal_map_probe(const Options& options, const NormalMapAssets& assets) {
    return normal_map_probe(NormalMapProbeOptions{options.size, options.orbit, options.texture,
                                                  options.shading, options.normal_map},
                            assets);
}

}  // namespace rasterbook
