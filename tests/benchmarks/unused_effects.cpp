// SPDX-License-Identifier: MIT
/// @file
/// What it costs to carry an effect that a scene does not call for: the time of a lesson's picture,
/// and that of the same picture by a program in which the effect is not there.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "11_scenes/finished_scene.hpp"
#include "benchmarks/unused_effects.hpp"
#include "common/memory.hpp"
#include "common/model_file.hpp"
#include "common/obj.hpp"

using namespace rasterbook;

namespace {

/// Who draws a frame: the lesson itself, a copy of it, or a copy without the effect.
enum Way { lesson, copy, without, ways };

struct Row {
    std::string effect;
    std::array<Draw, ways> draw;
    std::array<std::vector<double>, ways> ms = {};  ///< Of each frame.
};

template <int number, Without effect>
Row row(const char* name, const Scene& model) {
    return {name,
            {draw_of<number, Without::own>(model), draw_of<number, Without::nothing>(model),
             draw_of<number, effect>(model)}};
}

/// A model with a change of all of its materials.
template <typename Change>
Scene model(const char* name, const Change& change) {
    Scene scene = load_obj(std::filesystem::path(RASTERBOOK_ASSETS) / "models" / name);
    for (Material& material : scene.materials) change(material);
    return scene;
}

/// An effect, and how lesson 11's picture is drawn without it.
struct Left {
    Effect effect;
    Draw (*draw)(const Scene&);
};

/// The effects that lesson 11 does not call for in one of its scenes.
void add_rows_of_lesson_11(const char* name, std::vector<Row>& rows) {
    constexpr std::array all = {Left{Effect::light, draw_of<11, Without::light>},
                                Left{Effect::highlight, draw_of<11, Without::highlight>},
                                Left{Effect::texture, draw_of<11, Without::texture>},
                                Left{Effect::specular_map, draw_of<11, Without::specular_map>},
                                Left{Effect::vertex_colors, draw_of<11, Without::vertex_colors>},
                                Left{Effect::normal_map, draw_of<11, Without::normal_map>},
                                Left{Effect::shadow, draw_of<11, Without::shadow>},
                                Left{Effect::toon, draw_of<11, Without::toon>},
                                Left{Effect::outline, draw_of<11, Without::outline>},
                                Left{Effect::mask, draw_of<11, Without::mask>},
                                Left{Effect::blend, draw_of<11, Without::blend>}};
    static_assert(all.size() == effect_count);
    const Scene scene = load_model(std::filesystem::path(RASTERBOOK_ASSETS) / "models" / name);
    const Draw own = draw_of<11, Without::own>(scene),
               nothing = draw_of<11, Without::nothing>(scene);
    struct {
        TextureOptions texture;
        LightOptions shading;
        NormalMapVariant normal_map;
    } const options;
    const ScenePlan plan = FinishedScene(scene, options).plan;
    for (const auto& [effect, draw] : all)
        if (!plan.any(effect))
            rows.push_back({"11 " + std::string(name) + ", " +
                                std::string(effect_names[static_cast<std::size_t>(effect)]),
                            {own, nothing, draw(scene)}});
}

/// Each effect on a scene that does not call for it.
std::vector<Row> all_rows() {
    const Scene dull = model("scene.obj", [](Material& m) { m.illumination = 1; });
    const Scene plain = model("scene.obj", [](Material& m) { m.diffuse_map = {}; });
    const Scene unlit = model("figure.obj", [](Material& m) { m.illumination = 0; });
    const Scene clear = model("scene.obj", [](Material& m) { m.opacity = 0.5f; });
    std::vector<Row> rows = {
        row<6, Without::highlight>("06 highlight", dull),
        row<6, Without::texture>("06 texture", plain),
        row<7, Without::toon>("07 toon", unlit),
        row<7, Without::outline>("07 outline", model("figure.obj", [](Material&) {})),
        row<8, Without::normal_map>("08 normal map", model("scene.obj", [](Material&) {})),
        row<9, Without::shadow>("09 shadow", clear)};
    for (const char* name : {"unlit.glb", "textured.gltf", "bumpy.glb", "toon.glb"})
        add_rows_of_lesson_11(name, rows);
    return rows;
}

/// Milliseconds of the processor: what else it does in the meantime does not count.
double ms_of(const Draw& draw) {
    const std::clock_t start = std::clock();
    draw(nullptr);
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

/// @param argv  How many frames of each kind, 100 if it is not said; and with what the rows' names
///              begin, all if it is not said: 30 11 is lesson 11 alone.
int main(int argc, char** argv) {
    const int frames = argc > 1 ? std::atoi(argv[1]) : 100;
    if (frames < 1) {
        std::fprintf(stderr, "error: say how many frames of each kind, at least 1\n");
        return 2;
    }
    keep_freed_memory();  // as the lessons' program does
    std::vector<Row> rows = all_rows();
    if (argc > 2)
        std::erase_if(rows, [&](const Row& row) { return !row.effect.starts_with(argv[2]); });
    for (const Row& row : rows)
        for (const Way way : {copy, without})
            if (!are_the_same_bits(row.draw[lesson](nullptr), row.draw[way](nullptr))) {
                std::fprintf(stderr, "error: %s: the pictures differ\n", row.effect.c_str());
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

    std::ranges::sort(rows, {}, &Row::effect);
    std::printf(
        "| lesson, unused effect | ms | without | more, %% | quartiles | a mere copy, %% |\n"
        "|---|---:|---:|---:|---:|---:|\n");
    for (const Row& row : rows) {
        const std::vector<double> more = percent_more(row, lesson, without),
                                  of_copy = percent_more(row, copy, lesson);
        std::printf("| %s | %.2f | %.2f | %+.1f | %+.1f to %+.1f | %+.1f |\n", row.effect.c_str(),
                    quantile(row.ms[lesson], 0.5), quantile(row.ms[without], 0.5),
                    quantile(more, 0.5), quantile(more, 0.25), quantile(more, 0.75),
                    quantile(of_copy, 0.5));
    }
}
