// SPDX-License-Identifier: MIT
// An effect that a scene does not call for takes no work, and would change nothing.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

// All that the lessons' main.cpp include, so that what is left of those are their own lines.
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

/// A picture, and what was done to make it.
struct Drawn {
    Image<vec3> picture;
    Counters counters;

    std::uint64_t count(Counter counter) const {
        return counters.values[static_cast<std::size_t>(counter)];
    }
};

/// A scene that does not call for an effect.
struct Row {
    const char* effect;
    Drawn as_called_for;
    Drawn forced;                  ///< The effect is on, with inputs that change nothing.
    std::vector<Counter> work;     ///< Of the effect; all of it is done where it is forced.
    std::vector<Counter> changes;  ///< What it would find to do; nothing where it is neutral.
};

Scene loaded(const char* name) {
    return load_obj(std::filesystem::path(RASTERBOOK_ASSETS) / "models" / name);
}

/// The scene with a change of all of its materials.
template <typename Change>
Scene with_materials(Scene scene, const Change& change) {
    for (Material& material : scene.materials) change(material);
    return scene;
}

bool are_the_same_bits(const Image<vec3>& a, const Image<vec3>& b) {
    return a.size() == b.size() &&
           std::memcmp(a.pixels().data(), b.pixels().data(), a.pixels().size_bytes()) == 0;
}

template <typename Options>
Options small(Options options) {
    options.size = {320, 180};
    return options;
}

Drawn drawn(const Scene& scene, const lesson_06::Options& options) {
    Drawn result;
    result.picture = lesson_06::render(options, LitScene(scene, options), result.counters);
    return result;
}

Drawn drawn(const Scene& scene, const lesson_07::Options& options) {
    Drawn result;
    result.picture = lesson_07::render(options, ToonScene(scene, options), result.counters);
    return result;
}

Drawn drawn(const Scene& scene, const lesson_08::Options& options) {
    Drawn result;
    result.picture = lesson_08::render(options, BumpyScene(scene, options), result.counters);
    return result;
}

Drawn drawn(const Scene& scene, const lesson_09::Options& options) {
    Drawn result;
    result.picture = lesson_09::render(options, ShadowedScene(scene, options), result.counters);
    return result;
}

/// Forced as the lessons do it themselves.
template <typename Options>
Row with_all_effects(const char* effect, const Scene& scene, Options options,
                     std::vector<Counter> work, std::vector<Counter> changes = {}) {
    Row row{effect, drawn(scene, options), {}, std::move(work), std::move(changes)};
    options.shading.all_effects = true;
    row.forced = drawn(scene, options);
    return row;
}

std::vector<Row> rows() {
    using enum Counter;
    std::vector<Row> rows;

    // The crate is of illum 1. Forced: a highlight whose colour is black.
    rows.push_back(with_all_effects("highlight", loaded("crate.obj"), small(lesson_06::Options()),
                                    {highlights}));

    // The teapot's materials name no picture. Forced: white ones.
    rows.push_back(with_all_effects("texture", loaded("teapot.obj"), small(lesson_06::Options()),
                                    {texture_samples}));

    // No material of lesson 06's scene has a map. Forced: maps that lean nowhere.
    rows.push_back(with_all_effects("normal map", loaded("scene.obj"), small(lesson_08::Options()),
                                    {normal_map_samples, meshes_with_tangents}));

    // Some light passes through every material: none throws a shadow. Forced: empty maps.
    lesson_09::Options sun = small(lesson_09::Options());
    sun.shadow.size = 256;
    const Scene clear = with_materials(loaded("scene.obj"), [](Material& m) { m.opacity = 0.5f; });
    rows.push_back(with_all_effects("shadow", clear, sun, {shadow_passes, shadow_lookups},
                                    {shadow_fragments}));

    // Unlit materials have their colour and no bands. Forced: lit ones that send no light back, and
    // glow in that colour.
    lesson_07::Options comic = small(lesson_07::Options());
    comic.shading.outline = Outline::none;
    const Scene figure = loaded("figure.obj");
    const Scene unlit = with_materials(figure, [](Material& m) { m.illumination = 0; });
    const Scene glowing = with_materials(figure, [](Material& m) {
        m.illumination = 1, m.emission += m.diffuse, m.diffuse = m.ambient = vec3(0);
    });
    rows.push_back({"toon", drawn(unlit, comic), drawn(glowing, comic), {toon_fragments}, {}});

    // No scene calls for an outline, but a knob. Forced: outlines of no width, or of what faces the
    // eye less than not at all.
    for (const auto& [name, outline] : {std::pair{"outline by facing", Outline::facing},
                                        {"outline by hull", Outline::hull},
                                        {"outline by edges", Outline::edges}}) {
        lesson_07::Options inked = comic;
        inked.shading.outline = outline;
        inked.shading.outline_width_px = inked.shading.least_facing = 0;
        rows.push_back(
            {name, drawn(figure, comic), drawn(figure, inked), {outline_tests}, {outline_pixels}});
    }
    return rows;
}

}  // namespace

TEST(Effects, ThatAreNotCalledForTakeNoWorkAndWouldChangeNothing) {
    for (const auto& [effect, as_called_for, forced, work, changes] : rows()) {
        SCOPED_TRACE(effect);
        EXPECT_GT(as_called_for.count(Counter::fragments_shaded), 5000u);
        for (const Counter counter : work) {
            SCOPED_TRACE(counter_names[static_cast<std::size_t>(counter)]);
            EXPECT_EQ(as_called_for.count(counter), 0u);
            EXPECT_GT(forced.count(counter), 0u);  // else this row could not fail
        }
        for (const Counter counter : changes) {
            SCOPED_TRACE(counter_names[static_cast<std::size_t>(counter)]);
            EXPECT_EQ(as_called_for.count(counter), 0u);
            EXPECT_EQ(forced.count(counter), 0u);
        }
        EXPECT_TRUE(are_the_same_bits(as_called_for.picture, forced.picture));
    }
}
