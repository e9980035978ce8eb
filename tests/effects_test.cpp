// SPDX-License-Identifier: MIT
// An effect that a scene does not call for costs no work, and would change nothing.
#include <cstddef>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/lesson_06.hpp"
#include "support/lesson_07.hpp"
#include "support/lesson_08.hpp"
#include "support/lesson_09.hpp"
#include "support/pictures.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// A scene that does not call for an effect.
struct Row {
    const char* effect;
    Drawn as_called_for;
    Drawn forced;                  ///< The effect is on, with inputs that change nothing.
    std::vector<Counter> work;     ///< Of the effect; all of it is done where it is forced.
    std::vector<Counter> changes;  ///< What it would find to do; nothing where it is neutral.
};

/// The scene with a change of all of its materials.
template <typename Change>
Scene with_materials(Scene scene, const Change& change) {
    for (Material& material : scene.materials) change(material);
    return scene;
}

template <typename Options>
Options small(Options options) {
    options.size = {320, 180};
    return options;
}

Drawn drawn_scene(const Scene& scene, const lesson_06::Options& options) {
    return drawn(options, lesson_06::make_assets(scene, options),
                 [](auto&... arguments) { return lesson_06::render(arguments...); });
}

Drawn drawn_scene(const Scene& scene, const lesson_07::Options& options) {
    return drawn(options, lesson_07::make_assets(scene, options),
                 [](auto&... arguments) { return lesson_07::render(arguments...); });
}

Drawn drawn_scene(const Scene& scene, const lesson_08::Options& options) {
    return drawn(options, lesson_08::make_assets(scene, options),
                 [](auto&... arguments) { return lesson_08::render(arguments...); });
}

Drawn drawn_scene(const Scene& scene, const lesson_09::Options& options) {
    return drawn(options, lesson_09::make_assets(scene, options),
                 [](auto&... arguments) { return lesson_09::render(arguments...); });
}

/// Forced as the lessons do it themselves.
template <typename Options>
Row with_all_effects(const char* effect, const Scene& scene, Options options,
                     std::vector<Counter> work, std::vector<Counter> changes = {}) {
    Row row{effect, drawn_scene(scene, options), {}, std::move(work), std::move(changes)};
    options.shading.all_effects = true;
    row.forced = drawn_scene(scene, options);
    return row;
}

std::vector<Row> rows() {
    using enum Counter;
    std::vector<Row> rows;

    // The crate is of illum 1. Forced: a highlight whose colour is black.
    rows.push_back(with_all_effects("highlight", loaded("crate.obj"), small(lesson_06::Options()),
                                    {highlights}));

    // The teapot's materials name no texture. Forced: white ones.
    rows.push_back(with_all_effects("texture", loaded("teapot.obj"), small(lesson_06::Options()),
                                    {texture_samples}));

    // No material of lesson 06's scene has a normal map. Forced: flat ones.
    rows.push_back(with_all_effects("normal map", loaded("scene.obj"), small(lesson_08::Options()),
                                    {normal_map_samples, meshes_with_tangents}));

    // Every material lets light through: none casts a shadow. Forced: empty shadow maps.
    lesson_09::Options shadowed = small(lesson_09::Options());
    shadowed.shadow.size = 256;
    const Scene clear = with_materials(loaded("scene.obj"), [](Material& m) { m.opacity = 0.5f; });
    rows.push_back(with_all_effects("shadow", clear, shadowed, {shadow_passes, shadow_tests},
                                    {shadow_fragments}));

    // Unlit materials have their colour and no tones. Forced: lit ones that reflect nothing and
    // emit that colour.
    lesson_07::Options comic = small(lesson_07::Options());
    comic.shading.outline = Outline::none;
    const Scene figure = loaded("figure.obj");
    const Scene unlit = with_materials(figure, [](Material& m) { m.illumination = 0; });
    const Scene glowing = with_materials(figure, [](Material& m) {
        m.illumination = 1, m.emission += m.diffuse, m.diffuse = m.ambient = vec3(0);
    });
    rows.push_back(
        {"toon", drawn_scene(unlit, comic), drawn_scene(glowing, comic), {toon_fragments}, {}});

    // An option calls for an outline, not the scene. Forced: outlines of width 0, or below a facing
    // ratio of 0.
    for (const auto& [name, outline] : {std::pair{"outline by facing", Outline::facing},
                                        {"outline by hull", Outline::hull},
                                        {"outline by edges", Outline::edges}}) {
        lesson_07::Options inked = comic;
        inked.shading.outline = outline;
        inked.shading.outline_width_px = inked.shading.min_facing = 0;
        rows.push_back({name,
                        drawn_scene(figure, comic),
                        drawn_scene(figure, inked),
                        {outline_tests},
                        {outline_pixels}});
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
