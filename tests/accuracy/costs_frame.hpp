// SPDX-License-Identifier: MIT
/// @file
/// A frame of lesson 13 with a place on each lesson's knob, for costs.cpp. What lesson 13 leaves no
/// choice of, lesson 11 draws.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "10_threading/thread_pool.hpp"
#include "11_scenes/explain.hpp"
#include "11_scenes/scene_assets.hpp"
#include "11_scenes/shaders.hpp"
#include "lab/normal_map_methods.hpp"
#include "lab/shading_methods.hpp"
#include "support/lesson_13.hpp"
#include "support/pictures.hpp"

namespace rasterbook::test {

/// Lesson 11's shader for all materials, if it is not null; it lets render() draw with two choices
/// of lesson 06.
inline Shaders::Shader chosen_shader = nullptr;

/// How that shader's normal maps are applied.
inline NormalMapMethod chosen_normals;

/// Takes the place of Shaders.
class ChosenShaders {
  public:
    explicit ChosenShaders(const ScenePlan& plan) : own_(plan) {}

    Shaders::Shader operator[](std::size_t material) const {
        return chosen_shader != nullptr ? chosen_shader : own_[material];
    }

  private:
    Shaders own_;
};

}  // namespace rasterbook::test

// Lesson 11's render(), which takes them for its own.
#define Shaders rasterbook::test::ChosenShaders
#include "support/lesson_11.hpp"
#undef Shaders

namespace rasterbook::test {

/// Lesson 11's shader of opaque, lit surfaces with these choices. Flat and Gouraud shading test the
/// shadows at the face's centre or at the vertices, too, and have no place for normal maps.
template <Shading shading, Power power>
void draw_lit_by(const Frame<>& frame, const ProjectedTriangle& projected, const Tile& tile,
                 TransparentFragments&) {
    const SceneAssets& assets = frame.assets;
    const std::span<const Light> lights = assets.lit_by.lights;
    const EffectMask effects = assets.plan.materials[projected.triangle.material].effects;
    const TriangleSurface surface =
        triangle_surface(assets.scene, assets.textures, effects, projected);
    const PerspectiveSetup setup = perspective_setup(projected.on_screen, projected.clipped);
    NormalMapOf normal_map;
    if constexpr (shading == Shading::phong)
        normal_map =
            triangle_normal_map(chosen_normals, assets.scene, assets.normal_maps, projected);
    ShadowBiasCache shadow_biases(surface.positions_world);
    ShadingMethod variant;
    variant.power = power;
    const HighlightBy highlight = highlight_of(variant, surface);
    const auto light_at = [&](Barycentrics at, vec3 own_normal, vec3 normal) {
        const SurfacePoint<float> point = surface_point(surface, at, normal, frame.eye_world);
        return reflected_light(lights, point, highlight, [&](std::size_t l) {
            return light_visibility(frame.shadow_maps, l, shadow_biases, point.position_world,
                                    own_normal);
        });
    };
    VertexLighting at_vertices{shading};
    const auto light_vertex = [&](std::size_t i, Barycentrics at, vec3 normal) {
        const ReflectedLight sum = light_at(at, normal, normal);
        at_vertices.diffuse[i] = sum.diffuse, at_vertices.specular[i] = sum.specular;
    };
    if constexpr (shading == Shading::flat) {
        const vec3 front = face_normal(projected.mesh, projected.triangle);
        light_vertex(0, Barycentrics(1.0f / 3), projected.is_back_facing ? -front : front);
    }
    if constexpr (shading == Shading::gouraud)
        for (std::size_t i = 0; i < 3; ++i) {
            Barycentrics vertex(0);
            vertex[static_cast<int>(i)] = 1;
            light_vertex(i, vertex, surface.normals_world[i]);
        }

    fill_tile(projected.on_screen, tile, [&](ivec2 pixel, Barycentrics on_screen) {
        if (!frame.depth.test_and_write(pixel, projected.depth.at(on_screen))) return;
        const FragmentBarycentrics at = perspective_correct(setup, on_screen);
        const SurfaceColor own = surface_color(surface, at, frame.filter);
        ReflectedLight light;
        if constexpr (shading == Shading::phong) {
            const vec3 own_normal = interpolate(surface.normals_world, at.here);
            light =
                light_at(at.here, own_normal,
                         normal_mapped(chosen_normals, normal_map, at, own_normal, frame.filter));
        } else {
            light = at_vertices.at(at.here);
        }
        frame.color[pixel] = phong(own, ambient_light, light);
    });
}

namespace {  // as the lesson's options are

/// A place on each knob.
struct Settings : lesson_13::Options {
    bool is_by_lesson_11 = false;
    Shading light = Shading::phong;  ///< By lesson 06's lab: only by lesson 11.
    Power power = Power::polynomial;
    NormalMapMethod normals;  ///< Likewise.
    bool has_shadows = true;
    bool is_moved = false;  ///< The camera: by half a pixel or so.
};

/// So far does the camera move to the right and up, as seen from the scene's centre.
constexpr vec2 way_radians(0.00045f, 0.0003f);

/// The scene as settings have it. Those that need no other scene share one.
const SceneAssets& assets_of(const Settings& settings) {
    using Key = std::tuple<std::filesystem::path, Decoding, MapSpace, FrameOf, int, bool, bool>;
    static std::map<Key, SceneAssets> known;
    const Key key{settings.model,         settings.texture.decoding, settings.normal_map.space,
                  settings.normals.frame, settings.normals.bits,     settings.has_shadows,
                  settings.is_moved};
    if (const auto same = known.find(key); same != known.end()) return same->second;
    SceneAssets assets = make_scene_assets(loaded(settings.model.string()), settings);
    if (settings.normals != NormalMapMethod())
        assets.normal_maps =
            load_normal_maps(assets.scene, settings.texture, settings.normal_map.space, false,
                             NormalsBy{settings.normals, settings.normal_map.green});
    if (!settings.has_shadows) {
        assets.lit_by.casts.fill(false);
        for (MaterialPlan& plan : assets.plan.materials) plan.effects.set(Effect::shadow, false);
    }
    if (settings.is_moved)
        for (SceneCamera& camera : assets.scene.cameras) {
            mat4& from = camera.world_from_view;
            const vec3 center = assets.scene.bounds().center();
            const vec2 way = way_radians * glm::distance(vec3(from[3]), center);
            from[3] += from[0] * way.x + from[1] * way.y;
        }
    return known.emplace(key, std::move(assets)).first->second;
}

/// Settings of the picture of all samples, before they are averaged.
Settings of_samples(Settings settings) {
    settings.size *= settings.samples_per_side;
    if (settings.is_moved && assets_of(settings).scene.cameras.empty())
        settings.orbit.yaw_degrees += glm::degrees(way_radians.x);
    return settings;
}

/// All samples of a picture, as lesson 11 draws them.
///
/// @param shader  For all materials; null: each has its own.
Image<vec3> samples_by_11(const Settings& settings, ThreadPool& pool, Shaders::Shader shader) {
    lesson_11::Options options = of_samples(settings);
    options.threads = lesson_11::Options().threads;  // its own tiles
    chosen_shader = shader;
    chosen_normals = settings.normals;
    StepClock clock;
    return lesson_11::render(options, assets_of(settings), pool, clock);
}

/// All samples of a picture. Lesson 11 draws all of them by the shader with choices, so that code
/// of the same kind is timed. Light and power are never both other than the lesson's.
Image<vec3> samples_of(const Settings& settings, ThreadPool& pool) {
    if (!settings.is_by_lesson_11) {
        StepClock clock;
        return lesson_13::render(of_samples(settings), assets_of(settings), pool, clock);
    }
    if (settings.power == Power::schlick)
        return samples_by_11(settings, pool, draw_lit_by<Shading::phong, Power::schlick>);
    switch (settings.light) {
        case Shading::flat:
            return samples_by_11(settings, pool, draw_lit_by<Shading::flat, Power::polynomial>);
        case Shading::gouraud:
            return samples_by_11(settings, pool, draw_lit_by<Shading::gouraud, Power::polynomial>);
        case Shading::phong:
            break;
    }
    return samples_by_11(settings, pool, draw_lit_by<Shading::phong, Power::polynomial>);
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
    bool is_of_lesson_11 = false;      ///< Which draws all its levels: lesson 13 leaves no choice.
};

constexpr std::size_t samples = 0, textures = 1, maps = 2, texels = 3;  ///< Indices into knobs().

const std::vector<Knob>& knobs() {
    using S = Settings;
    static const std::vector<Knob> all = {
        {"samples per pixel",
         "02",
         0,
         2,
         {{"1", [](S& s) { s.samples_per_side = 1; }},
          {"4", [](S& s) { s.samples_per_side = 2; }},
          {"16", [](S& s) { s.samples_per_side = 4; }}}},
        {"texture filter",
         "05",
         0,
         2,
         {{"nearest", [](S& s) { s.texture.filter = Filter::nearest; }},
          {"bilinear", [](S& s) { s.texture.filter = Filter::bilinear; }},
          {"trilinear", [](S& s) { s.texture.filter = Filter::trilinear; }}}},
        {"shadow map",
         "09",
         1,
         4,
         {{"none", [](S& s) { s.has_shadows = false; }},
          {"512", [](S& s) { s.shadow.size = 512; }},
          {"1024", [](S& s) { s.shadow.size = 1024; }},
          {"2048", [](S& s) { s.shadow.size = 2048; }},
          {"4096", [](S& s) { s.shadow.size = 4096; }}}},
        {"PCF taps",
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
        {"sRGB values",
         "05",
         1,
         1,
         {{"ignored", [](S& s) { s.texture.decoding = Decoding::ignored; }},
          {"decoded", [](S& s) { s.texture.decoding = Decoding::srgb; }}}},
        {"shading",
         "06",
         2,
         2,
         {{"flat", [](S& s) { s.light = Shading::flat; }},
          {"Gouraud", [](S& s) { s.light = Shading::gouraud; }},
          {"Phong", [](S& s) { s.light = Shading::phong; }}},
         true},
        {"power",
         "06",
         1,
         1,
         {{"Schlick", [](S& s) { s.power = Power::schlick; }},
          {"polynomial", [](S& s) { s.power = Power::polynomial; }}},
         true},
        {"normal maps",
         "08",
         2,
         2,
         {{"none", [](S& s) { s.normal_map.space = MapSpace::none; }},
          {"tangents of faces", [](S& s) { s.normals.frame = FrameOf::face; }},
          {"of vertices", [](S& s) { s.normals.frame = FrameOf::vertex; }}},
         true},
        {"bits per normal",
         "08",
         1,
         1,
         {{"4", [](S& s) { s.normals.bits = 4; }},
          {"8", [](S& s) { s.normals.bits = bits_of_file; }}},
         true}};
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
