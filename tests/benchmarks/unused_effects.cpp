// SPDX-License-Identifier: MIT
/// @file
/// What it costs to carry an effect that a scene does not call for: the time of a lesson's picture,
/// and that of the same picture by the same program compiled without the effect.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include "06_phong/light_options.hpp"
#include "08_normal_maps/normal_map_options.hpp"
#include "12_effects/planned_scene.hpp"
#include "benchmarks/unused_effects.hpp"
#include "common/app/memory.hpp"
#include "support/pictures.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// Who draws a frame: the lesson itself, a mere copy of it, or one without the effect.
enum Way { lesson, copy, without, ways };

struct Row {
    std::string name;
    Without effect;
    std::array<Draw, ways> draw;
    std::array<std::vector<double>, ways> ms = {};  ///< Of each frame.
};

template <int number, Without effect>
Row row(const char* name, const Scene& model) {
    return {name,
            effect,
            {draw_of<number, Without::own>(model), draw_of<number, Without::nothing>(model),
             draw_of<number, effect>(model)}};
}

/// A model with a change of all of its materials.
template <typename Change>
Scene model(const char* name, const Change& change) {
    Scene scene = loaded(name);
    for (Material& material : scene.materials) change(material);
    return scene;
}

/// An effect, and lesson 12's picture without it.
struct LeftOut {
    Effect effect;
    Without without;
    Draw (*draw)(const Scene&);
};

template <Without without>
constexpr LeftOut left_out(Effect effect) {
    return {effect, without, draw_of<12, without>};
}

/// The effects that lesson 12 does not call for in one of its scenes. Not outlines: there they are
/// meshes like others, and the only question is one for each frame.
void add_rows_of_lesson_12(const char* name, std::vector<Row>& rows) {
    constexpr std::array all = {left_out<Without::light>(Effect::light),
                                left_out<Without::highlight>(Effect::highlight),
                                left_out<Without::texture>(Effect::texture),
                                left_out<Without::specular_map>(Effect::specular_map),
                                left_out<Without::emission_map>(Effect::emission_map),
                                left_out<Without::vertex_colors>(Effect::vertex_colors),
                                left_out<Without::normal_map>(Effect::normal_map),
                                left_out<Without::shadow>(Effect::shadow),
                                left_out<Without::toon>(Effect::toon),
                                left_out<Without::mask>(Effect::mask),
                                left_out<Without::blend>(Effect::blend)};
    static_assert(all.size() + 1 == effect_count);
    const Scene scene = loaded(name);
    const Draw own = draw_of<12, Without::own>(scene),
               nothing = draw_of<12, Without::nothing>(scene);
    const ScenePlan plan = load_planned_scene(scene, EffectsOptions()).plan;
    for (const auto& [effect, without, draw] : all) {
        // A comic's fragments are counted among the lit ones.
        if (plan.any(effect) || (effect == Effect::light && plan.any(Effect::toon))) continue;
        rows.push_back({"12 " + std::string(name) + ", " +
                            std::string(effect_names[static_cast<std::size_t>(effect)]),
                        without,
                        {own, nothing, draw(scene)}});
    }
}

/// Each effect on a scene that does not call for it.
std::vector<Row> all_rows() {
    const Scene plain = model("scene.obj", [](Material& m) { m.diffuse_map = {}; });
    const Scene unlit = model("figure.obj", [](Material& m) { m.illumination = 0; });
    const Scene clear = model("scene.obj", [](Material& m) { m.opacity = 0.5f; });
    std::vector<Row> rows = {
        row<6, Without::texture>("06 texture", plain), row<7, Without::toon>("07 toon", unlit),
        row<7, Without::outline>("07 outline", model("figure.obj", [](Material&) {})),
        row<8, Without::normal_map>("08 normal map", model("scene.obj", [](Material&) {})),
        row<9, Without::shadow>("09 shadow", clear)};
    for (const char* name : {"unlit.glb", "textured.gltf", "bumpy.glb", "toon.glb"})
        add_rows_of_lesson_12(name, rows);
    return rows;
}

/// Milliseconds of the processor: what else it does in the meantime does not count.
double ms_of(const Draw& draw) {
    const std::clock_t start = std::clock();
    draw(nullptr);
    return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// Whether the lesson's picture takes work of the effect; then nobody may draw without it.
bool is_called_for(const Row& row) {
    Counters counters;
    row.draw[lesson](&counters);
    for (std::size_t i = 0; i < counters.values.size(); ++i)
        if (counters.values[i] > 0 && is_work_of(row.effect, static_cast<Counter>(i))) return true;
    return false;
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

/// @param argv  How many frames of each kind, 100 if it is not said; and with what the rows' names
///              begin, all if it is not said: 30 12 is lesson 12 alone.
int main(int argc, char** argv) {
    const int frames = argc > 1 ? std::atoi(argv[1]) : 100;
    if (frames < 1) {
        std::fprintf(stderr, "error: say how many frames of each kind, at least 1\n");
        return 2;
    }
    keep_freed_memory();  // as the lessons' program does
    std::vector<Row> rows = all_rows();
    if (argc > 2)
        std::erase_if(rows, [&](const Row& row) { return !row.name.starts_with(argv[2]); });
    for (const Row& row : rows) {
        if (is_called_for(row)) {
            std::fprintf(stderr, "error: %s: the scene calls for it\n", row.name.c_str());
            return 1;
        }
        for (const Way way : {copy, without})
            if (!are_the_same_bits(row.draw[lesson](nullptr), row.draw[way](nullptr))) {
                std::fprintf(stderr, "error: %s: the pictures differ\n", row.name.c_str());
                return 1;
            }
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

    std::ranges::sort(rows, {}, &Row::name);
    std::printf(
        "| lesson, unused effect | ms | without | more, %% | quartiles | a mere copy, %% |\n"
        "|---|---:|---:|---:|---:|---:|\n");
    for (const Row& row : rows) {
        const std::vector<double> more = percent_more(row, lesson, without),
                                  of_copy = percent_more(row, copy, lesson);
        std::printf("| %s | %.2f | %.2f | %+.1f | %+.1f to %+.1f | %+.1f |\n", row.name.c_str(),
                    quantile(row.ms[lesson], 0.5), quantile(row.ms[without], 0.5),
                    quantile(more, 0.5), quantile(more, 0.25), quantile(more, 0.75),
                    quantile(of_copy, 0.5));
    }
}
