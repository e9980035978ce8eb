// SPDX-License-Identifier: MIT
/// @file
/// Lesson 09's shadow map of a crate on a floor, cut along the light's rays, for the figure
/// shadow_bias.js.
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "09_shadow_maps/light_view.hpp"
#include "09_shadow_maps/shadow_map.hpp"

namespace rasterbook {
namespace {

constexpr float floor_end = 3.3f, crate_half = 0.7f, crate_height = 1.4f;
constexpr int samples_per_unit = 80;
constexpr float cut_z = 0.01f;  // beside the line between two columns of texels

/// A face of the scene: from one point of the cut to the other, and as deep as 2 units.
struct CutFace {
    vec2 from, to, outward;
};
constexpr std::array<CutFace, 4> cut_faces = {{
    {{-floor_end, 0}, {floor_end, 0}, {0, 1}},
    {{-crate_half, 0}, {-crate_half, crate_height}, {-1, 0}},
    {{-crate_half, crate_height}, {crate_half, crate_height}, {0, 1}},
    {{crate_half, crate_height}, {crate_half, 0}, {1, 0}},
}};

/// A texel in which the light sees something: its ends on the near plane and at the stored depth.
struct CutTexel {
    vec2 near_from, near_to, from, to;
};
std::vector<CutTexel> seen_texels;

struct Sample {
    vec2 position;
    float face;        ///< Index into cut_faces.
    float visibility;  ///< 0 or 1, or -1 on a face that is turned away from the light.
};
std::vector<Sample> samples;
ShadowBias floor_bias;  ///< Before it is scaled.

Mesh scene() {
    Mesh mesh;
    for (const CutFace& face : cut_faces) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const vec3 p :
             {vec3(face.from, -1), vec3(face.to, -1), vec3(face.to, 1), vec3(face.from, 1)}) {
            mesh.positions.push_back(p);
            mesh.bounds.add(p);
        }
        mesh.triangles.push_back({{{{first}, {first + 1}, {first + 2}}}, 0});
        mesh.triangles.push_back({{{{first}, {first + 2}, {first + 3}}}, 0});
    }
    return mesh;
}

/// A bias so many times as large.
ShadowBias scaled(ShadowBias bias, float factor) {
    bias.bias *= factor;
    bias.bias_per_w *= factor;
    bias.offset *= factor;
    bias.offset_times_w *= factor;
    return bias;
}

}  // namespace

/// Draws the map and tests points along the cut.
///
/// @param elevation  Of the light above the floor, radians, 0 to pi.
/// @param size       Of the map in texels, > 8.
/// @param bias       As in Bias.
/// @param factor     Times the course's bias, >= 0.
extern "C" void draw(float elevation, int size, int bias, float factor) {
    const Mesh mesh = scene();
    const Light light{LightKind::directional, vec3(1),
                      vec3(std::cos(elevation), std::sin(elevation), 0)};
    const LightViews views = light_views(light, mesh.bounds, mesh.bounds, size);
    ShadowMap map(views.clip_from_world[0], false, size, mesh.bounds);
    draw_casters(map, mesh, [](std::uint32_t) { return true; });

    seen_texels.clear();
    const dmat4 world_from_texels = glm::inverse(dmat4(map.texels_from_world));
    const auto at = [&](double y, double depth) {
        return vec2(world_from_texels * dvec4(0.5 * size, y, depth, 1));
    };
    for (int y = 0; y < size; ++y) {
        const float depth = map.depths.depths()[ivec2(size / 2, y) + max_pcf_radius];
        if (depth > DepthBuffer::cleared)
            seen_texels.push_back({at(y, 1), at(y + 1, 1), at(y, depth), at(y + 1, depth)});
    }

    samples.clear();
    for (std::size_t i = 0; i < cut_faces.size(); ++i) {
        const auto& [from, to, outward] = cut_faces[i];
        const ShadowBias fitted = shadow_bias(
            map, Bias(bias), 0, {vec3(from, -1), vec3(to, -1), vec3(to, 1)}, dvec3(outward, 0));
        if (i == 0) floor_bias = fitted;
        const bool faces_light = glm::dot(outward, vec2(light.direction_world)) > 0;
        const int steps = static_cast<int>(glm::length(to - from) * samples_per_unit);
        for (int k = 0; k <= steps; ++k) {
            const vec2 point = glm::mix(from, to, float(k) / float(steps));
            samples.push_back(
                {point, float(i),
                 faces_light ? pcf_visibility<0>(map, scaled(fitted, factor), vec3(point, cut_z))
                             : -1});
        }
    }
}

extern "C" const CutTexel* texels() { return seen_texels.data(); }
extern "C" int texel_count() { return int(seen_texels.size()); }
extern "C" const Sample* tested() { return samples.data(); }
extern "C" int tested_count() { return int(samples.size()); }

/// The course's bias for the floor's depth; 2 if the light sees the floor edge-on.
extern "C" float bias_of_floor() { return floor_bias.bias; }

/// By how much the course moves the floor's points along the normal.
extern "C" float offset_of_floor() {
    return glm::length(floor_bias.offset + floor_bias.offset_times_w);  // w is 1
}

}  // namespace rasterbook
