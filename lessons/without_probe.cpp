// SPDX-License-Identifier: MIT
// What a lesson's program has in place of "Why this pixel?", so that it is sooner built.
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

struct PhongAssets;
struct PhongProbeOptions;
struct ToonAssets;
struct ToonProbeOptions;
struct NormalMapAssets;
struct NormalMapProbeOptions;
struct ShadowAssets;
struct ShadowProbeOptions;
struct SceneAssets;
struct SceneRendererOptions;

PixelProbe phong_probe(const PhongProbeOptions&, const PhongAssets&) { return {}; }
PixelProbe toon_probe(const ToonProbeOptions&, const ToonAssets&) { return {}; }
PixelProbe normal_map_probe(const NormalMapProbeOptions&, const NormalMapAssets&) { return {}; }
PixelProbe shadow_probe(const ShadowProbeOptions&, const ShadowAssets&) { return {}; }
PixelProbe scene_probe(const SceneRendererOptions&, const SceneAssets&) { return {}; }

}  // namespace rasterbook
