// SPDX-License-Identifier: MIT
/// @file
/// A frame of the last lesson with a place on each lesson's knob, for costs.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <syncstream>
#include <tuple>
#include <utility>
#include <vector>

// All that the lesson's main.cpp includes, so that it can be included within a namespace.
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "05_textures/textured_scene.hpp"
#include "06_phong/shading_variants.hpp"
#include "08_normal_maps/normal_map_variants.hpp"
#include "09_shadow_maps/shadow_variants.hpp"
#include "10_threading/binned_triangles.hpp"
#include "10_threading/thread_options.hpp"
#include "10_threading/thread_pool.hpp"
#include "10_threading/threaded_shadows.hpp"
#include "11_scenes/explain.hpp"
#include "11_scenes/finished_scene.hpp"
#include "11_scenes/kernels.hpp"
#include "11_scenes/scene_camera.hpp"
#include "11_scenes/scene_options.hpp"
#include "common/backdrop.hpp"
#include "common/lesson_app.hpp"
#include "common/model_file.hpp"

#define main main_of_lesson
namespace rasterbook::test::lesson {
#include "11_scenes/main.cpp"
}
#undef main

namespace rasterbook::test {
namespace {  // as the lesson's options are

/// A place on each knob.
struct Settings : lesson::Options {
    Shading light = Shading::phong;  ///< Lesson 06's --shading and --power.
    Power power = Power::in_float;
    bool has_shadows = true;
    bool is_moved = false;  ///< The camera: by half a pixel or so.
};

/// So far does the camera move to the right and up, as seen from the scene's centre.
constexpr vec2 way_radians(0.00045f, 0.0003f);

/// The scene as settings have it. Those that need no other scene share one.
const FinishedScene& scene_of(const Settings& settings) {
    using Key = std::tuple<std::filesystem::path, Decoding, MapSpace, FrameOf, int, bool, bool>;
    static std::map<Key, FinishedScene> scenes;
    const Key key{settings.model,
                  settings.texture.decoding,
                  settings.normal_map.space,
                  settings.normal_map.frame,
                  settings.normal_map.bits,
                  settings.has_shadows,
                  settings.is_moved};
    if (const auto known = scenes.find(key); known != scenes.end()) return known->second;
    FinishedScene scene(
        load_model(std::filesystem::path(RASTERBOOK_ASSETS) / "models" / settings.model), settings);
    if (!settings.has_shadows) {
        scene.lit_by.casts.fill(false);
        for (MaterialPlan& plan : scene.plan.materials) plan.set(Effect::shadow, false, "");
    }
    if (settings.is_moved)
        for (SceneCamera& camera : scene.cameras) {
            mat4& from = camera.world_from_view;
            const vec2 way = way_radians * glm::distance(vec3(from[3]), scene.bounds().center());
            from[3] += from[0] * way.x + from[1] * way.y;
        }
    return scenes.emplace(key, std::move(scene)).first->second;
}

/// Lesson 06's light of a face or of its corners: there the shadow maps are asked, too, and for
/// relief there is no place.
void draw_with_light_at_corners(Shading light, const Frame& frame, const ReadyTriangle& ready,
                                const Part& part) {
    NoCounters none;
    const TriangleSurface surface(frame.scene, ready.mesh, ready.triangle);
    const TriangleLight triangle_light(frame.shading, frame.scene.lit_by.lights, frame.eye_world,
                                       ready.mesh, ready.triangle, ready.is_back, surface);
    TriangleShadows shadow(frame.shadows, ready.mesh, ready.triangle);
    LitPoints points;
    if (light == Shading::flat) {
        triangle_light.add(vec3(1.0f / 3), points, none);
        points.normal_world.set(
            0, face_normal(ready.mesh, ready.triangle) * (ready.is_back ? -1.0f : 1.0f));
    } else {
        for (const vec3 corner : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)})
            triangle_light.add(corner, points, none);
    }
    shadow.look_up(points, none);
    triangle_light.compute(points, shadow);
    std::array<vec3, 3> diffuse, specular;
    for (std::size_t i = 0; i < 3; ++i) {
        const ReflectedLight at_corner = points.light(std::min(i, points.count - 1));
        diffuse[i] = at_corner.diffuse, specular[i] = at_corner.specular;
    }
    const TriangleDepth triangle_depth(ready.depths);
    const PerspectiveWeights perspective(ready.on_screen, ready.clipped);
    const auto shade = [&](const ManyFragments& fragments) {
        const ManyWeights weights = weights_of(fragments, perspective);
        const auto own = surface.colors(weights, frame.filter, none);
        for (std::size_t i = 0; i < fragments.count; ++i) {
            const vec3 here = weights.here[i];
            const ReflectedLight mixed{interpolate(diffuse, here), interpolate(specular, here)};
            frame.color[fragments.pixels[i]] = phong(own[i], ambient_light, mixed);
        }
    };
    Fragments visible(shade);
    fill_part(ready.on_screen, part, [&](ivec2 pixel, vec3 screen_weights) {
        if (frame.depth.test_and_write(pixel, triangle_depth.at(screen_weights)))
            visible.add(pixel, screen_weights);
    });
    visible.finish();
}

/// The lesson's render(), with the places of the knobs that it has not.
Image<vec3> render_with_own_light(const Settings& settings, const FinishedScene& scene,
                                  ThreadPool& pool) {
    const Camera camera = camera_of_picture(settings, settings.scene.camera, scene).camera;
    const mat4 clip_from_world = camera.clip_from_world(settings.size);
    WorkerCounters<NoCounters> counters_of(pool.size());
    NoCounters none;
    const Shadows shadows =
        draw_shadows(pool, settings.threads, settings.shadow, settings.shading.all_effects, scene,
                     scene.lit_by.lights, counters_of, scene.lit_by.casts);
    Image<vec3> color(settings.size, unset);
    DepthBuffer depth(settings.size, unset);
    const std::vector<const Mesh*> meshes = seen_meshes(scene, {}, clip_from_world, none);
    const Parts parts = settings.threads.parts_of(settings.size, pool.size());
    std::vector<BinnedTriangles> passes;
    for (const Pass& pass : passes_of(scene, meshes))
        passes.emplace_back(
            pool, pass.meshes, clip_from_world, parts, pass.two_sided,
            [&](std::size_t material) { return pass.takes(scene, material); }, counters_of);
    const Kernels<NoCounters> kernels(scene.plan);
    ShadingVariant shading{settings.shading};
    shading.power = settings.power;
    const Frame frame{scene,
                      shading,
                      settings.normal_map,
                      settings.texture.filter,
                      camera.position_world,
                      shadows,
                      color,
                      depth};
    pool.run(parts.count(), [&](std::size_t part, std::size_t) {
        NoCounters nothing;
        clear_part(color, depth, parts[part]);
        Layers layers;
        for (const BinnedTriangles& pass : passes)
            for (const Chunk& chunk : pass.chunks)
                for (const std::size_t index : chunk.of(part)) {
                    const ReadyTriangle& ready = chunk.triangles[index];
                    if (settings.light == Shading::phong)
                        kernels[ready.triangle.material](frame, ready, parts[part], layers,
                                                         nothing);
                    else
                        draw_with_light_at_corners(settings.light, frame, ready, parts[part]);
                }
    });
    return color;
}

/// All samples of a picture, before they are averaged.
Image<vec3> samples_of(Settings settings, ThreadPool& pool) {
    settings.size *= settings.samples_per_side;
    const FinishedScene& scene = scene_of(settings);
    if (settings.is_moved && scene.cameras.empty())
        settings.orbit.yaw_degrees += glm::degrees(way_radians.x);
    if (settings.light != Shading::phong || settings.power != Power::in_float)
        return render_with_own_light(settings, scene, pool);
    NoCounters none;
    NoClock no_clock;
    return lesson::render(settings, scene, pool, none, no_clock);
}

Image<vec3> picture_of(const Settings& settings, ThreadPool& pool) {
    return averaged(samples_of(settings, pool), settings.samples_per_side);
}

/// One way to make a choice.
struct Level {
    const char* name;
    void (*set)(Settings&);
};

/// A choice.
struct Knob {
    const char* name;
    const char* lesson;
    std::size_t cheapest, most_exact;  ///< Which of its levels.
    std::vector<Level> levels;         ///< Each at least as exact as the one before, by its lesson.
};

constexpr std::size_t samples = 0, textures = 1, maps = 2, texels = 3;  ///< Indices into knobs().

const std::vector<Knob>& knobs() {
    using S = Settings;
    static const std::vector<Knob> all = {
        {"samples a pixel",
         "02",
         0,
         2,
         {{"1", [](S& s) { s.samples_per_side = 1; }},
          {"4", [](S& s) { s.samples_per_side = 2; }},
          {"16", [](S& s) { s.samples_per_side = 4; }}}},
        {"textures",
         "05",
         0,
         2,
         {{"nearest", [](S& s) { s.texture.filter = Filter::nearest; }},
          {"bilinear", [](S& s) { s.texture.filter = Filter::bilinear; }},
          {"trilinear", [](S& s) { s.texture.filter = Filter::trilinear; }}}},
        {"depth maps",
         "09",
         1,
         4,
         {{"none", [](S& s) { s.has_shadows = false; }},
          {"512", [](S& s) { s.shadow.size = 512; }},
          {"1024", [](S& s) { s.shadow.size = 1024; }},
          {"2048", [](S& s) { s.shadow.size = 2048; }},
          {"4096", [](S& s) { s.shadow.size = 4096; }}}},
        {"texels a look-up",
         "09",
         0,
         1,
         {{"1", [](S& s) { s.shadow.pcf = 1; }},
          {"9", [](S& s) { s.shadow.pcf = 3; }},
          {"25", [](S& s) { s.shadow.pcf = 5; }}}},
        {"bias",
         "09",
         2,
         2,
         {{"none", [](S& s) { s.shadow.bias = Bias::none; }},
          {"constant", [](S& s) { s.shadow.bias = Bias::constant; }},
          {"slope", [](S& s) { s.shadow.bias = Bias::slope; }}}},
        {"codes",
         "05",
         1,
         1,
         {{"ignored", [](S& s) { s.texture.decoding = Decoding::ignored; }},
          {"decoded", [](S& s) { s.texture.decoding = Decoding::srgb; }}}},
        {"light",
         "06",
         2,
         2,
         {{"flat", [](S& s) { s.light = Shading::flat; }},
          {"Gouraud", [](S& s) { s.light = Shading::gouraud; }},
          {"Phong", [](S& s) { s.light = Shading::phong; }}}},
        {"power",
         "06",
         1,
         1,
         {{"Schlick", [](S& s) { s.power = Power::schlick; }},
          {"float", [](S& s) { s.power = Power::in_float; }}}},
        {"normal maps",
         "08",
         2,
         2,
         {{"none", [](S& s) { s.normal_map.space = MapSpace::none; }},
          {"frames of faces", [](S& s) { s.normal_map.frame = FrameOf::face; }},
          {"of corners", [](S& s) { s.normal_map.frame = FrameOf::vertex; }}}},
        {"bits of a normal",
         "08",
         1,
         1,
         {{"4", [](S& s) { s.normal_map.bits = 4; }},
          {"8", [](S& s) { s.normal_map.bits = bits_of_file; }}}}};
    return all;
}

/// For each knob the index of its level.
using Choices = std::vector<std::size_t>;

Choices with(Choices choices, std::size_t knob, std::size_t level) {
    choices[knob] = level;
    return choices;
}

Settings settings_of(const Choices& choices) {
    Settings settings;
    for (std::size_t i = 0; i < choices.size(); ++i) knobs()[i].levels[choices[i]].set(settings);
    return settings;
}

}  // namespace
}  // namespace rasterbook::test
