// SPDX-License-Identifier: MIT
/// @file
/// One way to draw a frame: LESSON's own, from LESSON_MAIN, or a copy WITHOUT an effect.
#include "benchmarks/unused_effects.hpp"

#include <array>
#include <concepts>
#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <type_traits>
#include <vector>

#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "05_textures/bands.hpp"
#include "05_textures/textured_scene.hpp"
#include "06_phong/fragments.hpp"
#include "06_phong/lit_scene.hpp"
#include "06_phong/shading_variants.hpp"
#include "07_toon/toon_variants.hpp"
#include "08_normal_maps/bumpy_scene.hpp"
#include "09_shadow_maps/shadowed_scene.hpp"
#include "common/backdrop.hpp"

#define main inline lesson_main  // compiled only where it is called: nowhere
#include LESSON_MAIN
#undef main

namespace {

using LessonScene =
    std::tuple_element_t<LESSON - 6, std::tuple<LitScene, ToonScene, BumpyScene, ShadowedScene>>;

/// Takes the place of what is left out: made of anything, it is nothing.
struct LeftOut {
    template <typename... Arguments>
    explicit LeftOut(const Arguments&...) {}
};

/// What is left of a TriangleSurface without textures.
struct UntexturedSurface {
    const Material& material;
    Effects effects;
    SurfaceColor own_color;

    UntexturedSurface(const LitScene& scene, const Mesh&, const Triangle& triangle)
        : material(scene.materials[triangle.material]),
          effects(scene.effects[triangle.material]),
          own_color(surface_color(material)) {}

    template <typename CounterPolicy>
    std::array<SurfaceColor, most_points> colors(const ManyWeights& weights, Filter,
                                                 CounterPolicy&) const {
        std::array<SurfaceColor, most_points> colors;
        for (std::size_t i = 0; i < weights.count; ++i) colors[i] = own_color;
        return colors;
    }
};

/// A lesson's render(), but what is left out is not compiled.
template <Without without, typename AnyOptions, typename AnyScene, typename CounterPolicy>
Image<vec3> copy_of_render(const AnyOptions& options, const AnyScene& scene,
                           CounterPolicy& counters) {
    constexpr bool is_comic = std::same_as<AnyScene, ToonScene>;
    constexpr bool is_bumpy = std::derived_from<AnyScene, BumpyScene>;
    constexpr bool is_shadowed = std::same_as<AnyScene, ShadowedScene>;
    constexpr bool has_bands = is_comic && without != Without::toon;
    constexpr bool has_outlines = is_comic && without != Without::outline;
    constexpr bool has_relief = is_bumpy && without != Without::normal_map;
    constexpr bool has_shadows = is_shadowed && without != Without::shadow;
    constexpr bool has_texture = without != Without::texture;
    using Surface = std::conditional_t<has_texture, TriangleSurface, UntexturedSurface>;
    using Points = std::conditional_t<has_bands, ToonPoints,
                                      std::conditional_t<has_relief, BumpyPoints, LitPoints>>;

    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    const std::array lights = [&] {
        const LightKind key = options.shading.key_light;
        if constexpr (is_shadowed)
            return raking_lights(key, scene.bounds());
        else if constexpr (is_bumpy)
            return studio_lights(key, scene.bounds(), low_key);
        else
            return studio_lights(key, scene.bounds());
    }();
    const auto shadows = [&] {
        if constexpr (has_shadows)
            return Shadows(options.shadow, options.shading.all_effects, scene, lights, counters);
        else
            return LeftOut();
    }();
    Image<vec3> color = is_comic ? Image<vec3>(options.size, paper_color) : backdrop(options.size);
    DepthBuffer depth(options.size);
    [[maybe_unused]] auto outlines = [&] {
        if constexpr (has_outlines)
            return Outlines(options.shading, camera, options.size);
        else
            return LeftOut();
    }();
    // TriangleLight asks a surface for its material alone, and takes none without textures.
    std::vector<TriangleSurface> for_light;
    if constexpr (!has_texture)
        for (std::uint32_t i = 0; i < scene.materials.size(); ++i)
            for_light.emplace_back(scene, scene.meshes[0], Triangle{{}, i});

    for (const Mesh& mesh : scene.meshes) {
        counters.add(Counter::meshes_in);
        if (is_outside_frustum(mesh.bounds, clip_from_world)) {
            counters.add(Counter::meshes_culled_by_frustum);
            continue;
        }
        if constexpr (has_relief)
            if (!scene.tangents_of(mesh).empty()) counters.add(Counter::meshes_with_tangents);
        const std::vector<vec4> positions_clip = transform(clip_from_world, mesh.positions);
        for (const Triangle& triangle : mesh.triangles) {
            counters.add(Counter::triangles_in);
            const Surface surface(scene, mesh, triangle);
            for (const ClippedTriangle& clipped :
                 clip_triangle(corners_of(triangle, positions_clip))) {
                const vec3 a = screen_from_clip(clipped[0].position_clip, options.size);
                const vec3 b = screen_from_clip(clipped[1].position_clip, options.size);
                const vec3 c = screen_from_clip(clipped[2].position_clip, options.size);
                const ScreenTriangle on_screen = snap_triangle(a, b, c);
                const bool is_back = !is_front_facing(on_screen);
                if (is_back && !options.shading.two_sided) {
                    counters.add(Counter::triangles_culled_by_facing);
                    continue;
                }
                const TriangleDepth triangle_depth(vec3(a.z, b.z, c.z));
                const PerspectiveWeights perspective(on_screen, clipped);
                const auto relief = [&] {
                    if constexpr (has_relief)
                        return TriangleRelief(options.normal_map, scene, mesh, triangle, is_back);
                    else
                        return LeftOut();
                }();
                const auto& surface_for_light = [&]() -> const TriangleSurface& {
                    if constexpr (has_texture)
                        return surface;
                    else
                        return for_light[triangle.material];
                }();
                const TriangleLight light({options.shading}, lights, camera.position_world, mesh,
                                          triangle, is_back, surface_for_light);
                std::conditional_t<has_shadows, TriangleShadows, LeftOut> shadow(shadows, mesh,
                                                                                 triangle);
                const auto shade = [&](const ManyFragments& fragments) {
                    const ManyWeights weights = weights_of(fragments, perspective);
                    const auto own = surface.colors(weights, options.texture.filter, counters);
                    Points points;
                    if (surface.effects.light) {
                        if constexpr (has_bands)
                            points.add(light, weights, options.shading.smooth, counters);
                        else
                            light.add(weights, points, counters);
                        if constexpr (has_relief)
                            relief.add(weights, options.texture.filter, points, counters);
                    }
                    if constexpr (has_shadows) shadow.look_up(points, counters);
                    if constexpr (has_relief) relief.tilt(points);
                    if constexpr (has_bands) {
                        points.compute(light, options.shading.smooth);
                    } else if constexpr (has_shadows) {
                        light.compute(points, shadow);
                    } else if constexpr (without == Without::highlight) {
                        const auto no_power = [](float) { return 0.0f; };
                        const auto all_arrives = [](std::size_t, std::size_t) { return 1.0f; };
                        if (!reflect_light(lights, camera.position_world, false, points, no_power,
                                           all_arrives))
                            light.compute(points);
                    } else {
                        light.compute(points);
                    }
                    for (std::size_t i = 0; i < fragments.count; ++i) {
                        vec3& pixel = color[fragments.pixels[i]];
                        if (!surface.effects.light)
                            pixel = unlit(own[i]);
                        else if constexpr (has_bands)
                            pixel = points.painted(i, options.shading, own[i], counters);
                        else
                            pixel = phong(own[i], ambient_light, points.light(i));
                    }
                    if constexpr (has_outlines) {
                        if (!outlines.need_fragments()) return;
                        for (std::size_t i = 0; i < fragments.count; ++i)
                            outlines.add(fragments.pixels[i], mesh, triangle, is_back,
                                         weights.here[i], color, counters);
                    }
                };
                Fragments visible(shade);
                fill_in_bands(on_screen, options.size, [&](ivec2 pixel, vec3 screen_weights) {
                    counters.add(Counter::fragments_tested);
                    if (!depth.test_and_write(pixel, triangle_depth.at(screen_weights))) return;
                    counters.add(Counter::fragments_shaded);
                    visible.add(pixel, screen_weights);
                });
                visible.finish();
            }
        }
    }
    if constexpr (has_outlines)
        outlines.draw(scene, options.samples_per_side, depth, color, counters);
    if (options.show_depth) return depth_picture(depth);
    return color;
}

/// Both, as in the lesson's program.
Image<vec3> draw(const Options& options, const LessonScene& scene, auto& counters) {
    if constexpr (Without::WITHOUT == Without::own)
        return render(options, scene, counters);
    else
        return copy_of_render<Without::WITHOUT>(options, scene, counters);
}

}  // namespace

template <>
Draw rasterbook::draw_of<LESSON, Without::WITHOUT>(const Scene& model) {
    const Options options = [](auto knobs) {
        if constexpr (requires { knobs.shading.outline; }) knobs.shading.outline = Outline::none;
        return knobs;
    }(Options());
    return [options, scene = std::make_shared<LessonScene>(model, options)](Counters* counters) {
        NoCounters none;
        return counters ? draw(options, *scene, *counters) : draw(options, *scene, none);
    };
}
