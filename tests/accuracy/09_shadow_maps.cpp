// SPDX-License-Identifier: MIT
/// @file
/// Shadows: the bias, the size of the map, and the size of the PCF kernel, against a ray to the
/// light for each pixel. Also draws where they are wrong: docs/accuracy/09_shadow_maps-*.png.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "04_mvp/camera.hpp"
#include "06_phong/normals.hpp"
#include "09_shadow_maps/shadow_map.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "accuracy/accuracy.hpp"
#include "common/image/image_io.hpp"
#include "support/light_maps.hpp"
#include "support/pictures.hpp"
#include "support/shadow_points.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr ivec2 picture_size(640, 360);
// What pictures of errors show: where the crate and the teapot stand, and shadows on the teapot.
constexpr ivec2 zoomed_size(1600, 900), window_low(325, 262), window_size(800, 450);
constexpr int usual_size = 1024, usual_radius = 1;

Scene the_scene() {
    Scene scene = loaded("scene_bumpy.obj");
    complete_normals(scene);
    return scene;
}

bool is_in_window(ivec2 pixel) {
    const ivec2 inside = pixel - window_low;
    return glm::all(glm::greaterThanEqual(inside, ivec2(0))) &&
           glm::all(glm::lessThan(inside, window_size));
}

/// The lesson's scene and those of its points that face the light, with the answer for each.
struct Reference {
    Scene scene;
    Light light;
    std::vector<SeenPoint> all, points;
    std::vector<bool> is_lit;  ///< Of the points.

    /// @param shows  Called as shows(pixel): whether this one is asked for.
    template <typename Shows>
    Reference(ivec2 size, Shows&& shows)
        : scene(the_scene()),
          light(raking_lights(LightKind::directional, scene.bounds())[0]),
          all(seen_points(scene, orbit_camera(Orbit(), scene.bounds()), size)) {
        std::erase_if(all, [&](const SeenPoint& p) { return !shows(p.pixel); });
        const LightRays rays(light, RayCaster::of(scene.meshes, [](std::size_t) { return true; }),
                             scene.bounds().radius());
        for (const SeenPoint& p : all) {
            // Below this, light fades out, and flat faces do not stand for what is round.
            if (glm::dot(p.normal, light.direction_world) < full_cosine) continue;
            points.push_back(p);
            is_lit.push_back(rays.is_lit(p.position));
        }
    }
};

const Reference& reference() {
    static const Reference made(picture_size, [](ivec2) { return true; });
    return made;
}

/// Maps of the light, each drawn once.
const LightMaps& maps_of(int size) {
    static std::vector<std::pair<int, LightMaps>> made = [] {
        std::vector<std::pair<int, LightMaps>> none;
        none.reserve(16);
        return none;
    }();
    for (const auto& [of, maps] : made)
        if (of == size) return maps;
    return made.emplace_back(size, LightMaps(reference().light, reference().scene.meshes, size))
        .second;
}

/// The visibilities of all points, in order. A triangle's bias is found once, as in the lesson.
template <typename Take>
void test_all(const Reference& of, const ShadowMap& map, Bias bias, int radius, Take&& take) {
    const auto with = [&]<int r>(std::integral_constant<int, r>) {
        ShadowBias at;
        const Vertices* triangle = nullptr;
        for (const SeenPoint& p : of.points) {
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

/// By how far the shadow's edge of a plate over a floor is off its place, on average, in
/// thousandths of the plate's side. The plate is turned, so that its sides meet the texels at all
/// angles.
double edge_off_by(Bias bias, int size, int radius) {
    const auto quad = [](const std::array<vec3, 4>& p) {
        Mesh mesh;
        mesh.positions.assign(p.begin(), p.end());
        for (const vec3 position : p) mesh.bounds.add(position);
        mesh.triangles = {{{Vertex{0}, Vertex{1}, Vertex{2}}, 0},
                          {{Vertex{0}, Vertex{2}, Vertex{3}}, 0}};
        return mesh;
    };
    const vec3 u(0.5f * std::cos(0.3f), 0, 0.5f * std::sin(0.3f)), v(u.z, 0, -u.x);
    const vec3 middle(-0.7f, 0.5f, 0);
    const std::array meshes = {
        quad({vec3(-2, 0, -2), vec3(-2, 0, 2), vec3(2, 0, 2), vec3(2, 0, -2)}),
        quad({middle - u - v, middle + u - v, middle + u + v, middle - u + v})};
    const Light& light = reference().light;
    const LightMaps maps(light, meshes, size);
    // On the floor the plate's shadow is the plate, moved along the light.
    const vec3 moved = middle - light.direction_world * (middle.y / light.direction_world.y);
    constexpr int steps = 1200;
    constexpr double from = -1.5, step = 3.0 / steps;
    long wrong = 0;
    for (int j = 0; j < steps; ++j)
        for (int i = 0; i < steps; ++i) {
            const vec3 point(static_cast<float>(from + (i + 0.5) * step), 0,
                             static_cast<float>(from + (j + 0.5) * step));
            const vec3 from_middle = point - moved;
            const bool is_dark = std::abs(glm::dot(from_middle, u)) < glm::dot(u, u) &&
                                 std::abs(glm::dot(from_middle, v)) < glm::dot(v, v);
            const Vertices vertices = vertices_in(meshes[0], meshes[0].triangles[0]);
            wrong += (maps.visibility(bias, radius, vertices, point) < 0.5f) != is_dark;
        }
    const double perimeter = 4;
    return 1000 * static_cast<double>(wrong) * step * step / perimeter;
}

/// Whether the flat triangle faces away from the light, although its interpolated normals face it.
bool is_turned_away(const SeenPoint& p, vec3 toward_light) {
    const vec3 face = glm::cross(p.vertices[1] - p.vertices[0], p.vertices[2] - p.vertices[0]);
    return glm::dot(face, toward_light) * glm::dot(face, p.normal) <= 0;
}

Errors errors_of(Bias bias, int size, int radius) {
    const Reference& exact = reference();
    const ShadowMap& map = maps_of(size).maps[0];
    std::size_t i = 0, falsely_lit = 0, falsely_dark = 0, turned_away = 0;
    double squares = 0;
    test_all(exact, map, bias, radius, [&](float visibility) {
        const SeenPoint& p = exact.points[i];
        const bool is_lit = exact.is_lit[i++], seems_lit = visibility >= 0.5f;
        turned_away += seems_lit && !is_lit && is_turned_away(p, exact.light.direction_world);
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
            {"falsely lit on faces turned away, %", percent(turned_away)},
            {"RMS error", std::sqrt(squares / static_cast<double>(exact.points.size()))},
            {"edge off by, thousandths", edge_off_by(bias, size, radius)},
            {"first pass, ms", passes_ms[3]}};
}

void add(const char* comparison, const std::string& name, Bias bias, int size, int radius) {
    add_variant(comparison, name, static_cast<double>(reference().points.size()),
                errors_of(bias, size, radius), [=] {
                    float sum = 0;
                    test_all(reference(), maps_of(size).maps[0], bias, radius,
                             [&](float visibility) { sum += visibility; });
                    [[maybe_unused]] volatile float sink = sum;
                });
}

/// A part of the scene in gray; red is falsely lit, blue falsely dark.
void draw_errors(const std::string& name, Bias bias, int size, int radius) {
    static const Reference exact(zoomed_size, is_in_window);
    Image<u8vec3> picture(window_size, {30, 34, 42});
    for (const SeenPoint& p : exact.all) picture[p.pixel - window_low] = {66, 66, 68};
    std::size_t i = 0;
    test_all(exact, maps_of(size).maps[0], bias, radius, [&](float visibility) {
        const SeenPoint& p = exact.points[i];
        const bool is_lit = exact.is_lit[i++], seems_lit = visibility >= 0.5f;
        const float cosine = glm::dot(p.normal, exact.light.direction_world);
        const auto gray = static_cast<std::uint8_t>(is_lit ? 130 + 90 * cosine : 84);
        picture[p.pixel - window_low] = seems_lit && !is_lit   ? u8vec3(235, 70, 40)
                                        : !seems_lit && is_lit ? u8vec3(40, 90, 235)
                                                               : u8vec3(gray, gray, gray);
    });
    write_image(RASTERBOOK_ASSETS "/../docs/accuracy/09_shadow_maps-" + name + ".png", picture);
}

constexpr std::array<std::pair<const char*, Bias>, 5> biases = {{{"none", Bias::none},
                                                                 {"constant", Bias::constant},
                                                                 {"slope", Bias::slope},
                                                                 {"plane", Bias::plane},
                                                                 {"normal", Bias::normal}}};

}  // namespace

int main(int argc, char** argv) {
    for (const auto& [name, bias] : biases) draw_errors(name, bias, 256, usual_radius);
    for (const auto& [name, bias] : biases) add("bias", name, bias, usual_size, usual_radius);
    for (const auto& [name, bias] : biases) add("coarse", name, bias, 256, usual_radius);
    for (const int size : {256, 512, 1024, 2048, 4096})
        add("size", std::to_string(size), Bias::slope, size, usual_radius);
    for (const int radius : {0, 1, 2, 3}) {
        const std::string side = std::to_string(2 * radius + 1);
        add("texels", side + " by " + side, Bias::slope, usual_size, radius);
    }
    return measure_variants(argc, argv);
}
