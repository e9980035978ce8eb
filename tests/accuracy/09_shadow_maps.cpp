// SPDX-License-Identifier: MIT
/// @file
/// Shadows: the bias, the size of the map, and the size of the PCF kernel, against a ray to the
/// light for each pixel.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "04_mvp/camera.hpp"
#include "06_phong/normals.hpp"
#include "09_shadow_maps/shadow_map.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "accuracy/accuracy.hpp"
#include "support/light_maps.hpp"
#include "support/pictures.hpp"
#include "support/shadow_points.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr ivec2 picture_size(640, 360);
constexpr int usual_size = 1024, usual_radius = 1;

Scene the_scene() {
    Scene scene = loaded("scene_bumpy.obj");
    complete_normals(scene);
    return scene;
}

/// The lesson's scene and those of its points that face the light, with the answer for each.
struct Reference {
    Scene scene = the_scene();
    Light light = raking_lights(LightKind::directional, scene.bounds())[0];
    std::vector<SeenPoint> points;
    std::vector<bool> is_lit;  ///< Of the points.

    Reference() {
        const LightRays rays(light, RayCaster::of(scene.meshes, [](std::size_t) { return true; }),
                             scene.bounds().radius());
        const Camera camera = orbit_camera(Orbit(), scene.bounds());
        for (const SeenPoint& p : seen_points(scene, camera, picture_size)) {
            // Below this, light fades out, and flat faces do not stand for what is round.
            if (glm::dot(p.normal, light.direction_world) < full_cosine) continue;
            points.push_back(p);
            is_lit.push_back(rays.is_lit(p.position));
        }
    }
};

const Reference& reference() {
    static const Reference made;
    return made;
}

/// Maps of the light, each drawn once.
const LightMaps& maps_of(int size) {
    static std::map<int, LightMaps> made;
    return made.try_emplace(size, reference().light, reference().scene.meshes, size).first->second;
}

/// The visibilities of all points, in order. A triangle's bias is found once, as in the lesson.
template <typename Take>
void test_all(const ShadowMap& map, Bias bias, int radius, Take&& take) {
    const auto with = [&]<int r>(std::integral_constant<int, r>) {
        ShadowBias at;
        const Vertices* triangle = nullptr;
        for (const SeenPoint& p : reference().points) {
            if (triangle == nullptr || p.vertices != *triangle)
                at = shadow_bias(map, bias, r, p.vertices, p.normal);
            triangle = &p.vertices;
            take(pcf_visibility<r>(map, at, p.position));
        }
    };
    if (radius == 0) with(std::integral_constant<int, 0>());
    if (radius == 1) with(std::integral_constant<int, 1>());
    if (radius == 2) with(std::integral_constant<int, 2>());
    if (radius == 3) with(std::integral_constant<int, 3>());
}

Errors errors_of(Bias bias, int size, int radius) {
    const Reference& exact = reference();
    const ShadowMap& map = maps_of(size).maps[0];
    std::size_t i = 0, falsely_lit = 0, falsely_dark = 0;
    double squares = 0;
    test_all(map, bias, radius, [&](float visibility) {
        const bool is_lit = exact.is_lit[i++], seems_lit = visibility >= 0.5f;
        falsely_lit += seems_lit && !is_lit, falsely_dark += !seems_lit && is_lit;
        squares += (visibility - is_lit) * (visibility - is_lit);
    });
    const auto percent = [&](std::size_t count) {
        return 100 * static_cast<double>(count) / static_cast<double>(exact.points.size());
    };

    // The first pass by itself, as long as it takes without memory that has never been used.
    std::vector<double> passes_ms;
    for (int k = 0; k < 7; ++k) {
        ShadowMap again(map.clip_from_world, map.is_perspective, size, exact.scene.bounds());
        const auto start = std::chrono::steady_clock::now();
        for (const Mesh& mesh : exact.scene.meshes)
            draw_casters(again, mesh, [](std::size_t) { return true; });
        passes_ms.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                .count());
    }
    std::nth_element(passes_ms.begin(), passes_ms.begin() + 3, passes_ms.end());
    return {{"wrong, % of pixels", percent(falsely_lit + falsely_dark)},
            {"falsely lit, %", percent(falsely_lit)},
            {"falsely dark, %", percent(falsely_dark)},
            {"RMS error", std::sqrt(squares / static_cast<double>(exact.points.size()))},
            {"first pass, ms", passes_ms[3]}};
}

void add(const char* comparison, const std::string& name, Bias bias, int size, int radius) {
    add_variant(comparison, name, static_cast<double>(reference().points.size()),
                errors_of(bias, size, radius), [=] {
                    float sum = 0;
                    test_all(maps_of(size).maps[0], bias, radius,
                             [&](float visibility) { sum += visibility; });
                    [[maybe_unused]] volatile float sink = sum;
                });
}

}  // namespace

int main(int argc, char** argv) {
    for (const auto& [name, bias] : {std::pair("none", Bias::none),
                                     {"constant", Bias::constant},
                                     {"slope", Bias::slope},
                                     {"plane", Bias::plane},
                                     {"normal", Bias::normal}})
        add("bias", name, bias, usual_size, usual_radius);
    for (const int size : {256, 512, 1024, 2048, 4096})
        add("size", std::to_string(size), Bias::slope, size, usual_radius);
    for (const int radius : {0, 1, 2, 3}) {
        const std::string side = std::to_string(2 * radius + 1);
        add("texels", side + " by " + side, Bias::slope, usual_size, radius);
    }
    return measure_variants(argc, argv);
}
