// SPDX-License-Identifier: MIT
/// @file
/// Lights and points of surfaces in words, for tests that fail.
#pragma once

#include <array>
#include <string>

#include "06_phong/light.hpp"
#include "06_phong/phong.hpp"
#include "lab/shading_methods.hpp"
#include "support/near.hpp"

namespace rasterbook::test {

constexpr const char* name_of(Highlight highlight) {
    return highlight == Highlight::phong ? "Phong's highlight" : "Blinn's highlight";
}
constexpr const char* name_of(Shading shading) {
    return shading == Shading::flat      ? "flat shading"
           : shading == Shading::gouraud ? "Gouraud shading"
                                         : "Phong shading";
}

inline constexpr std::array light_kinds = {LightKind::directional, LightKind::point,
                                           LightKind::spot};

constexpr const char* name_of(LightKind kind) {
    return kind == LightKind::directional ? "directional light"
           : kind == LightKind::point     ? "point light"
                                          : "spotlight";
}

inline std::string described(const Light& light) {
    std::string text = name_of(light.kind) + (" of color " + shown(light.color));
    if (light.kind != LightKind::directional)
        text +=
            " at " + shown(light.position_world) + ", half distance " + shown(light.half_distance);
    if (light.kind != LightKind::point) text += ", direction " + shown(light.direction_world);
    if (light.kind == LightKind::spot)
        text += ", cosines " + shown(light.cos_inner) + " and " + shown(light.cos_outer);
    return text;
}

inline std::string described(const SurfacePoint<float>& point) {
    return "at " + shown(point.position_world) + ", where N = " + shown(point.normal_world) +
           " and V = " + shown(point.toward_eye);
}

}  // namespace rasterbook::test
