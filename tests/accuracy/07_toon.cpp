// SPDX-License-Identifier: MIT
/// @file
/// Tones on a sphere, and the three outlines of a sphere beside a cube. The references are rays in
/// double that meet sphere and cube themselves.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "accuracy/accuracy.hpp"
#include "common/image/image_io.hpp"
#include "common/math/color.hpp"
#include "support/lab_07.hpp"
#include "support/lit_sphere.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr ivec2 size(512);
constexpr int tones = 4;

/// A sphere of radius 1 around the origin, and beside it perhaps a cube, in directional light.
Scene bodies(bool with_cube) {
    Scene scene;
    Material material;
    material.diffuse = vec3(1), material.ambient = vec3(0);
    scene.materials.push_back(material);
    scene.meshes.push_back(sphere_mesh(96, 192));
    if (!with_cube) return scene;
    Mesh cube;
    for (int i = 0; i < 8; ++i) {
        cube.positions.push_back(vec3(1.3f, -0.7f, -0.7f) +
                                 1.4f * vec3(ivec3(i & 1, i >> 1 & 1, i >> 2)));
        cube.bounds.add(cube.positions.back());
    }
    constexpr std::uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& [a, b, c, d] : quads) {
        cube.triangles.push_back({{Vertex{a}, Vertex{b}, Vertex{c}}, 0});
        cube.triangles.push_back({{Vertex{a}, Vertex{c}, Vertex{d}}, 0});
    }
    scene.meshes.push_back(cube);
    return scene;
}

/// The rays of a camera that looks at a point.
class Rays {
  public:
    Rays(const Camera& camera, dvec3 center)
        : eye_(camera.position_world),
          forward_(glm::normalize(center - eye_)),
          right_(glm::normalize(glm::cross(forward_, dvec3(0, 1, 0)))),
          up_(glm::cross(right_, forward_)),
          half_height_(std::tan(double{camera.fov_y_radians} / 2)) {}

    dvec3 eye() const { return eye_; }

    /// @param position_px  In a square picture.
    dvec3 through(dvec2 position_px) const {
        const dvec2 ndc = 2.0 * position_px / dvec2(size) - 1.0;
        return forward_ + half_height_ * (ndc.x * right_ - ndc.y * up_);
    }

  private:
    dvec3 eye_, forward_, right_, up_;
    double half_height_;
};

/// The ray parameter at which a ray meets the sphere.
std::optional<double> meets_sphere(dvec3 eye, dvec3 ray) {
    const double a = glm::dot(ray, ray), b = glm::dot(ray, eye), c = glm::dot(eye, eye) - 1;
    if (b * b < a * c) return std::nullopt;
    return (-b - std::sqrt(b * b - a * c)) / a;
}

/// The body a ray hits: 0 nothing, 1 the sphere, 2 to 7 a side of the cube.
int meets(dvec3 eye, dvec3 ray) {
    int body = 0, side = 0;
    double nearest = 1e30, from = -1e30, to = 1e30;
    if (const auto sphere = meets_sphere(eye, ray)) nearest = *sphere, body = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = axis == 0 ? 1.3 : -0.7;
        double enter = (low - eye[axis]) / ray[axis], leave = (low + 1.4 - eye[axis]) / ray[axis];
        if (enter > leave) std::swap(enter, leave);
        if (enter > from) from = enter, side = axis;
        to = std::min(to, leave);
    }
    if (from < to && from > 0 && from < nearest) body = 2 + 2 * side + (ray[side] > 0);
    return body;
}

lab_07::Options options_of(Outline outline, bool smooth) {
    lab_07::Options options;
    options.size = size;
    options.orbit = {};
    options.shading.outline = outline;
    options.smooth = smooth;
    return options;
}

/// The level of light in each pixel, as the lesson draws it with so many samples a side.
Image<float> drawn_levels(const ToonAssets& assets, bool smooth, int samples) {
    lab_07::Options options = options_of(Outline::none, smooth);
    options.size = samples * size;
    options.samples_per_side = samples;
    const Image<vec3> picture = averaged(lab_07::render(options, assets), samples);
    Image<float> levels(size);
    for (std::size_t i = 0; i < levels.pixels().size(); ++i)
        levels.pixels()[i] = picture.pixels()[i].g;
    return levels;
}

/// The mean level of 256 rays a pixel; nothing where one of them misses the sphere or grazes it.
std::vector<std::optional<double>> exact_levels(const Camera& camera,
                                                std::span<const Light> lights) {
    const Rays rays(camera, dvec3(0));
    std::vector<std::optional<double>> levels;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            std::optional<double> sum = 0.0;
            for (int i = 0; i < 256 && sum; ++i) {
                const dvec3 ray =
                    rays.through({x + (i % 16 + 0.5) / 16.0, y + (i / 16 + 0.5) / 16.0});
                const auto far = meets_sphere(rays.eye(), ray);
                const dvec3 normal = far ? rays.eye() + *far * ray : dvec3(0);
                if (!far || -glm::dot(normal, ray) < 0.15 * glm::length(ray)) {
                    sum.reset();
                    break;
                }
                dvec3 light(0);
                for (const Light& one : lights)
                    light += std::max(0.0, glm::dot(normal, dvec3(one.direction_world))) *
                             dvec3(one.color);
                const double brightness = std::max({light.r, light.g, light.b});
                int tone = 0;
                for (int k = 1; k < tones; ++k) tone += brightness >= double(k) / tones;
                *sum += tone / (tones - 1.0) / 256;
            }
            levels.push_back(sum);
        }
    return levels;
}

void add_tones() {
    static const ToonAssets assets =
        load_toon_scene(bodies(false), options_of(Outline::none, false));
    const Bounds bounds = assets.scene.bounds();
    const Camera camera = orbit_camera({}, bounds);
    const auto lights = studio_lights(LightKind::directional, bounds);
    const auto exact = exact_levels(camera, lights);
    // Where the two brightest tones meet, of three variants: as drawn, and below what is wrong.
    constexpr int zoom = 6;
    constexpr ivec2 part_from(316, 334);
    const Image<float> part({44, 44});
    const ivec2 step = part.size() + 1;  // a pixel between two pieces
    Image<vec3> picture(zoom * (step * ivec2(3, 2) - 1), vec3(1));
    const auto show = [&](ivec2 at, vec3 color) {
        for (int j = 0; j < zoom * zoom; ++j)
            picture[zoom * at + ivec2(j % zoom, j / zoom)] = color;
    };
    int panel = 0;
    const std::tuple<const char*, bool, int> variants[] = {{"hard", false, 1},
                                                           {"smooth", true, 1},
                                                           {"hard, 4 samples", false, 2},
                                                           {"hard, 16 samples", false, 4}};
    for (const auto& [name, is_smooth, per_side] : variants) {
        const bool smooth = is_smooth;
        const int samples = per_side;
        const Image<float> levels = drawn_levels(assets, smooth, samples);
        ErrorSum errors;
        for (std::size_t i = 0; i < exact.size(); ++i) {
            const ivec2 pixel(int(i) % size.x, int(i) / size.x);
            const double error = exact[i] ? double{levels[pixel]} - *exact[i] : 0;
            if (exact[i]) errors.add(error);
            const ivec2 shown = pixel - part_from;
            if (panel == 3 || !part.contains(shown)) continue;
            const float strength = std::min(1.0f, 5 * static_cast<float>(std::abs(error)));
            const vec3 wrong = error > 0 ? vec3(1.0f, 0.05f, 0.0f) : vec3(0.0f, 0.1f, 1.0f);
            const ivec2 at = shown + ivec2(panel * step.x, 0);
            const float of_brightest = glm::clamp(3 * levels[pixel] - 2, 0.0f, 1.0f);
            show(at, glm::mix(vec3(0.3f, 0.04f, 0.03f), vec3(0.85f, 0.2f, 0.09f), of_brightest));
            show(at + ivec2(0, step.y),
                 glm::mix(vec3(0.3f + 0.5f * levels[pixel]), wrong, strength));
        }
        ++panel;
        add_variant("tones", name, double(size.x) * size.y,
                    {{"RMS error", errors.rms()}, {"greatest error", errors.greatest()}},
                    [=] { drawn_levels(assets, smooth, samples); });
    }
    write_image(RASTERBOOK_ASSETS "/../docs/accuracy/07_toon-tones.png",
                srgb8_from_linear(picture));
}

void add_outlines() {
    constexpr int near_edge = 3;  // pixels: as far as a line of 3 may lie from its edge
    Image<int> met(size);
    static const ToonAssets assets =
        load_toon_scene(bodies(true), options_of(Outline::hull, false));
    const Bounds bounds = assets.scene.bounds();
    const Rays rays(orbit_camera({}, bounds), dvec3(bounds.center()));
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            met[{x, y}] = meets(rays.eye(), rays.through({x + 0.5, y + 0.5}));
    const auto is_edge = [&](ivec2 p) {
        return met[p] != met[p + ivec2(1, 0)] || met[p] != met[p + ivec2(0, 1)];
    };
    /// Whether one of the pixels around has it.
    const auto around = [&](ivec2 p, const auto& has) {
        for (int y = -near_edge; y <= near_edge; ++y)
            for (int x = -near_edge; x <= near_edge; ++x)
                if (has(p + ivec2(x, y))) return true;
        return false;
    };
    const std::pair<const char*, Outline> outlines[] = {{"none", Outline::none},
                                                        {"facing ratio", Outline::facing},
                                                        {"hull", Outline::hull},
                                                        {"edges", Outline::edges}};
    for (const auto& [name, outline] : outlines) {
        const lab_07::Options options = options_of(outline, false);
        const Image<vec3> picture = lab_07::render(options, assets);
        const auto is_ink = [&](ivec2 p) { return picture[p] == ink; };
        double edges = 0, missing = 0, inked = 0, wrong = 0;
        for (int y = near_edge; y < size.y - near_edge - 1; ++y)
            for (int x = near_edge; x < size.x - near_edge - 1; ++x) {
                const ivec2 p(x, y);
                if (is_edge(p)) ++edges, missing += !around(p, is_ink);
                if (is_ink(p)) ++inked, wrong += !around(p, is_edge);
            }
        add_variant("outlines", name, double(size.x) * size.y,
                    {{"missing, %", 100 * missing / edges},
                     {"false, %", inked > 0 ? 100 * wrong / inked : 0}},
                    [=] { lab_07::render(options, assets); });
    }
}

}  // namespace

int main(int argc, char** argv) {
    add_tones();
    add_outlines();
    return measure_variants(argc, argv);
}
