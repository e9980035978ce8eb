// SPDX-License-Identifier: MIT
/// @file
/// What it costs to carry an effect that a scene does not call for: the time of a lesson's picture,
/// and that of the same picture by a program in which the effect is not there.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <functional>
#include <memory>
#include <numeric>
#include <random>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

// All that the lessons' main.cpp include, so that what is left of those are their own lines.
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "05_textures/textured_scene.hpp"
#include "06_phong/fragments.hpp"
#include "06_phong/lit_scene.hpp"
#include "06_phong/shading_variants.hpp"
#include "07_toon/toon_variants.hpp"
#include "08_normal_maps/bumpy_scene.hpp"
#include "08_normal_maps/normal_map_variants.hpp"
#include "09_shadow_maps/shadow_variants.hpp"
#include "09_shadow_maps/shadowed_scene.hpp"
#include "common/backdrop.hpp"
#include "common/lesson_app.hpp"
#include "common/obj.hpp"

// Each lesson's Options and render() in a namespace of its own.
#define main lesson_main
namespace lesson_06 {
#include "06_phong/main.cpp"
}
namespace lesson_07 {
#include "07_toon/main.cpp"
}
namespace lesson_08 {
#include "08_normal_maps/main.cpp"
}
namespace lesson_09 {
#include "09_shadow_maps/main.cpp"
}
#undef main

using namespace rasterbook;

namespace {

enum class Effect { none, highlight, texture, normal_map, shadow, toon, outline };

NoCounters none;

struct Lesson06 {
    using Options = lesson_06::Options;
    using LessonScene = LitScene;
    static constexpr bool has_bands = false, has_relief = false, has_shadows = false;

    static Image<vec3> render(const Options& options, const LessonScene& scene) {
        return lesson_06::render(options, scene, none);
    }
    static auto lights(const Options& options, const LessonScene& scene) {
        return studio_lights(options.shading.key_light, scene.bounds());
    }
    static Image<vec3> background(ivec2 size) { return backdrop(size); }
};

struct Lesson07 : Lesson06 {
    using Options = lesson_07::Options;
    using LessonScene = ToonScene;
    static constexpr bool has_bands = true;

    static Image<vec3> render(const Options& options, const LessonScene& scene) {
        return lesson_07::render(options, scene, none);
    }
    static auto lights(const Options& options, const LessonScene& scene) {
        return studio_lights(options.shading.key_light, scene.bounds());
    }
    static Image<vec3> background(ivec2 size) { return Image<vec3>(size, paper_color); }
};

struct Lesson08 : Lesson06 {
    using Options = lesson_08::Options;
    using LessonScene = BumpyScene;
    static constexpr bool has_relief = true;

    static Image<vec3> render(const Options& options, const LessonScene& scene) {
        return lesson_08::render(options, scene, none);
    }
    static auto lights(const Options& options, const LessonScene& scene) {
        return studio_lights(options.shading.key_light, scene.bounds(), low_key);
    }
};

struct Lesson09 : Lesson08 {
    using Options = lesson_09::Options;
    using LessonScene = ShadowedScene;
    static constexpr bool has_shadows = true;

    static Image<vec3> render(const Options& options, const LessonScene& scene) {
        return lesson_09::render(options, scene, none);
    }
    static auto lights(const Options& options, const LessonScene& scene) {
        return raking_lights(options.shading.key_light, scene.bounds());
    }
};

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

    SurfaceColor color(const FragmentWeights&, Filter, NoCounters) const { return own_color; }
};

/// A lesson's render(), with an effect left out where it is compiled.
template <typename Lesson, Effect without>
Image<vec3> draw(const typename Lesson::Options& options,
                 const typename Lesson::LessonScene& scene) {
    constexpr bool has_bands = Lesson::has_bands && without != Effect::toon;
    constexpr bool has_outlines = Lesson::has_bands && without != Effect::outline;
    constexpr bool has_relief = Lesson::has_relief && without != Effect::normal_map;
    constexpr bool has_shadows = Lesson::has_shadows && without != Effect::shadow;
    constexpr bool has_texture = without != Effect::texture;
    using Surface = std::conditional_t<has_texture, TriangleSurface, UntexturedSurface>;
    using Points = std::conditional_t<has_bands, ToonPoints,
                                      std::conditional_t<has_relief, BumpyPoints, LitPoints>>;

    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    const std::array lights = Lesson::lights(options, scene);
    const auto shadows = [&] {
        if constexpr (has_shadows)
            return Shadows(options.shadow, options.shading.all_effects, scene, lights, none);
        else
            return LeftOut();
    }();
    Image<vec3> color = Lesson::background(options.size);
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
        if (is_outside_frustum(mesh.bounds, clip_from_world)) continue;
        const std::vector<vec4> positions_clip = transform(clip_from_world, mesh.positions);
        for (const Triangle& triangle : mesh.triangles) {
            const Surface surface(scene, mesh, triangle);
            for (const ClippedTriangle& clipped :
                 clip_triangle(corners_of(triangle, positions_clip))) {
                const vec3 a = screen_from_clip(clipped[0].position_clip, options.size);
                const vec3 b = screen_from_clip(clipped[1].position_clip, options.size);
                const vec3 c = screen_from_clip(clipped[2].position_clip, options.size);
                const ScreenTriangle on_screen = snap_triangle(a, b, c);
                const bool is_back = !is_front_facing(on_screen);
                if (is_back && !options.shading.two_sided) continue;
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
                const auto shade = [&](std::span<const Fragment> fragments) {
                    std::array<SurfaceColor, most_points> own;
                    Points points;
                    for (std::size_t i = 0; i < fragments.size(); ++i) {
                        const FragmentWeights weights = perspective.at(fragments[i].screen_weights);
                        own[i] = surface.color(weights, options.texture.filter, none);
                        if (!surface.effects.light) continue;
                        if constexpr (has_bands)
                            points.add(light, weights, options.shading.smooth, none);
                        else
                            light.add(weights.here, points, none);
                        if constexpr (has_relief)
                            relief.add(weights, options.texture.filter, points, none);
                    }
                    if constexpr (has_shadows) shadow.look_up(points, none);
                    if constexpr (has_relief) relief.tilt(points);
                    if constexpr (has_bands) {
                        points.compute(light, options.shading.smooth);
                    } else if constexpr (has_shadows) {
                        light.compute(points, shadow);
                    } else if constexpr (without == Effect::highlight) {
                        const auto no_power = [](float) { return 0.0f; };
                        const auto all_arrives = [](std::size_t, std::size_t) { return 1.0f; };
                        if (!reflect_light(lights, camera.position_world, false, points, no_power,
                                           all_arrives))
                            light.compute(points);
                    } else {
                        light.compute(points);
                    }
                    for (std::size_t i = 0; i < fragments.size(); ++i) {
                        vec3& pixel = color[fragments[i].pixel];
                        if (!surface.effects.light)
                            pixel = unlit(own[i]);
                        else if constexpr (has_bands)
                            pixel = points.painted(i, options.shading, own[i], none);
                        else
                            pixel = phong(own[i], ambient_light, points.light(i));
                    }
                    if constexpr (has_outlines) {
                        if (!outlines.need_fragments()) return;
                        for (const auto& [pixel, screen_weights] : fragments)
                            outlines.add(pixel, mesh, triangle, is_back,
                                         perspective.at(screen_weights).here, color, none);
                    }
                };
                Fragments visible(shade);
                fill_triangle(on_screen, options.size, [&](ivec2 pixel, vec3 screen_weights) {
                    if (!depth.test_and_write(pixel, triangle_depth.at(screen_weights))) return;
                    visible.add({pixel, screen_weights});
                });
                visible.finish();
            }
        }
    }
    if constexpr (has_outlines) outlines.draw(scene, options.samples_per_side, depth, color, none);
    return options.show_depth ? depth_picture(depth) : color;
}

/// Who draws a frame: the lesson itself, a copy of it, or a copy without the effect.
enum Way { lesson, copy, without, ways };

struct Row {
    const char* effect;
    std::array<std::function<Image<vec3>()>, ways> draw;
    std::array<std::vector<double>, ways> ms = {};  ///< Of each frame.
};

template <typename Lesson, Effect effect>
Row row(const char* name, Scene model, typename Lesson::Options options = {}) {
    const auto scene = std::make_shared<typename Lesson::LessonScene>(std::move(model), options);
    return {name,
            {[=] { return Lesson::render(options, *scene); },
             [=] { return draw<Lesson, Effect::none>(options, *scene); },
             [=] { return draw<Lesson, effect>(options, *scene); }}};
}

/// A model with a change of all of its materials.
template <typename Change>
Scene model(const char* name, const Change& change) {
    Scene scene = load_obj(std::filesystem::path(RASTERBOOK_ASSETS) / "models" / name);
    for (Material& material : scene.materials) change(material);
    return scene;
}

/// Each effect on a scene that does not call for it.
std::vector<Row> all_rows() {
    lesson_07::Options without_outline;
    without_outline.shading.outline = Outline::none;
    const auto as_it_is = [](Material&) {};
    const auto unlit = [](Material& m) { m.illumination = 0; };
    std::vector<Row> rows;
    rows.push_back(row<Lesson06, Effect::highlight>(
        "highlight, 06", model("scene.obj", [](Material& m) { m.illumination = 1; })));
    rows.push_back(row<Lesson06, Effect::texture>(
        "texture, 06", model("scene.obj", [](Material& m) { m.diffuse_map = {}; })));
    rows.push_back(
        row<Lesson07, Effect::toon>("toon, 07", model("figure.obj", unlit), without_outline));
    rows.push_back(row<Lesson07, Effect::outline>("outline, 07", model("figure.obj", as_it_is),
                                                  without_outline));
    rows.push_back(
        row<Lesson08, Effect::normal_map>("normal map, 08", model("scene.obj", as_it_is)));
    rows.push_back(row<Lesson09, Effect::shadow>(
        "shadow, 09", model("scene.obj", [](Material& m) { m.opacity = 0.5f; })));
    return rows;
}

/// Milliseconds of the processor: what else it does in the meantime does not count.
double ms_of(const std::function<Image<vec3>()>& draw) {
    const std::clock_t start = std::clock();
    draw();
    return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

bool are_the_same_bits(const Image<vec3>& a, const Image<vec3>& b) {
    return a.size() == b.size() &&
           std::memcmp(a.pixels().data(), b.pixels().data(), a.pixels().size_bytes()) == 0;
}

/// What a share of the numbers does not exceed: 0.5 is the median.
double quantile(std::vector<double> numbers, double share) {
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(numbers.size() - 1));
    std::nth_element(numbers.begin(), numbers.begin() + at, numbers.end());
    return numbers[static_cast<std::size_t>(at)];
}

/// By how many per cent frames drawn one way take longer than those that followed or went before.
std::vector<double> percent_more(const Row& row, Way way, Way than) {
    std::vector<double> percent;
    for (std::size_t i = 0; i < row.ms[way].size(); ++i)
        percent.push_back(100 * (row.ms[way][i] / row.ms[than][i] - 1));
    return percent;
}

}  // namespace

/// @param argv  How many frames of each kind; 100 if it is not said.
int main(int argc, char** argv) {
    const int frames = argc > 1 ? std::atoi(argv[1]) : 100;
    if (frames < 1) {
        std::fprintf(stderr, "error: say how many frames of each kind, at least 1\n");
        return 2;
    }
    std::vector<Row> rows = all_rows();
    for (const Row& row : rows)
        for (const Way way : {copy, without})
            if (!are_the_same_bits(row.draw[lesson](), row.draw[way]())) {
                std::fprintf(stderr, "error: %s: the pictures differ\n", row.effect);
                return 1;
            }

    std::mt19937 random(1);
    std::array<Way, ways> order = {lesson, copy, without};
    for (int i = 0; i < frames; ++i) {
        std::ranges::shuffle(rows, random);
        for (Row& row : rows) {
            std::ranges::shuffle(order, random);
            for (const Way way : order) row.ms[way].push_back(ms_of(row.draw[way]));
        }
    }

    std::ranges::sort(rows, {}, [](const Row& row) { return std::strstr(row.effect, ", ") + 2; });
    std::printf(
        "| unused effect, lesson | ms | without | more, %% | quartiles | a mere copy, %% |\n"
        "|---|---:|---:|---:|---:|---:|\n");
    for (const Row& row : rows) {
        const std::vector<double> more = percent_more(row, lesson, without),
                                  of_copy = percent_more(row, copy, lesson);
        std::printf("| %s | %.2f | %.2f | %+.1f | %+.1f to %+.1f | %+.1f |\n", row.effect,
                    quantile(row.ms[lesson], 0.5), quantile(row.ms[without], 0.5),
                    quantile(more, 0.5), quantile(more, 0.25), quantile(more, 0.75),
                    quantile(of_copy, 0.5));
    }
}
