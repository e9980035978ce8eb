// SPDX-License-Identifier: MIT
/// @file
/// What accuracy costs: the choices of several lessons on one scale, in one frame of lesson 14.
///
/// Each choice is raised alone from the cheapest frame, and lowered alone from the most exact one;
/// the choices that take most of the time are tried together, in all combinations. Writes JSON, of
/// which report_costs.py makes tables and a plot. Takes 2 GB of memory.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <map>
#include <memory>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "accuracy/costs_frame.hpp"
#include "common/app/memory.hpp"
#include "common/image/image.hpp"
#include "common/math/color.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// As many threads as there are draw what is not timed.
ThreadPool& all_threads() {
    static ThreadPool pool(std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
    return pool;
}

/// Milliseconds of the processor, on one thread: what else it does in the meantime does not count.
double ms_of(const Settings& settings) {
    static ThreadPool one_thread(1);
    const std::clock_t start = std::clock();
    picture_of(settings, one_thread);
    return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// A picture's codes, white being 1: light as the eye weighs it.
Image<vec3> codes_of(Image<vec3> picture) {
    for (vec3& pixel : picture.pixels())
        for (int c = 0; c < 3; ++c) pixel[c] = srgb_from_linear(std::clamp(pixel[c], 0.0f, 1.0f));
    return picture;
}

/// How far a picture is from the reference, and how far the change is from a picture to the next
/// one from that of the reference; RMS of codes.
struct Errors {
    double still = 0, moving = 0;
};

/// What a frame should look like, and the next one.
class Reference {
  public:
    explicit Reference(Settings settings) {
        settings.samples_per_side = 8;
        settings.texture.filter = Filter::trilinear;
        settings.shadow.size = 8192, settings.shadow.pcf = 1;
        codes_ = codes_of(picture_of(settings, all_threads()));
        settings.is_moved = true;
        next_codes_ = codes_of(picture_of(settings, all_threads()));
    }

    Errors errors_of(Settings settings) const {
        const Image<vec3> here = codes_of(picture_of(settings, all_threads()));
        settings.is_moved = true;
        const Image<vec3> next = codes_of(picture_of(settings, all_threads()));
        double still = 0, moving = 0;
        for (std::size_t i = 0; i < codes_.pixels().size(); ++i) {
            const dvec3 off = dvec3(here.pixels()[i]) - dvec3(codes_.pixels()[i]);
            const dvec3 off_next = dvec3(next.pixels()[i]) - dvec3(next_codes_.pixels()[i]);
            still += glm::dot(off, off);
            moving += glm::dot(off_next - off, off_next - off);
        }
        const auto numbers = static_cast<double>(3 * codes_.pixels().size());
        return {std::sqrt(still / numbers), std::sqrt(moving / numbers)};
    }

  private:
    Image<vec3> codes_, next_codes_;
};

constexpr std::size_t most_rounds = 15;

/// A frame, and what was measured of it.
struct Shot {
    Settings settings;
    Errors errors{};
    std::vector<double> ms{};  ///< In each round.

    /// Slow ones are drawn less often: they vary less.
    std::size_t rounds() const { return settings.samples_per_side == 1 ? most_rounds : 7; }
};

using Shots = std::map<Choices, Shot>;

/// Finds the errors of frames, and their times by turns in random order.
void measure(const std::vector<Shot*>& frames, const Reference& reference) {
    std::size_t done = 0;
    for (Shot* shot : frames) {
        shot->errors = reference.errors_of(shot->settings);
        std::cerr << "\r  errors of " << ++done << " of " << frames.size() << " frames  ";
    }
    std::mt19937 random(1);
    std::vector<Shot*> order = frames;
    for (std::size_t round = 0; round < most_rounds; ++round) {
        std::ranges::shuffle(order, random);
        for (Shot* shot : order)
            if (round < shot->rounds()) shot->ms.push_back(ms_of(shot->settings));
        std::cerr << "\r  times, round " << round + 1 << " of " << most_rounds << "          ";
    }
    std::cerr << '\n';
}

/// The frames that are tried together: all combinations of what takes most of the time.
std::vector<Choices> combinations(const Choices& cheapest) {
    std::vector<Choices> all;
    for (std::size_t s = 0; s < 3; ++s)
        for (std::size_t t = 0; t < 3; ++t)
            for (std::size_t m = 1; m < 5; ++m)
                for (std::size_t n = 0; n < 2; ++n) {
                    if (s == 2 && (t == 0 || m == 1 || n == 0)) continue;  // slow, and still coarse
                    all.push_back(with(with(with(with(cheapest, samples, s), textures, t), maps, m),
                                       texels, n));
                }
    return all;
}

/// Where a preset lies among the choices.
Choices choices_of(const Quality& quality, Choices choices) {
    const auto find = [&](std::size_t knob, auto&& is_it) {
        for (std::size_t level = 0; level < knobs()[knob].levels.size(); ++level)
            if (is_it(settings_of(with(choices, knob, level)))) choices[knob] = level;
    };
    find(samples,
         [&](const Settings& s) { return s.samples_per_side == quality.samples_per_side; });
    find(textures, [&](const Settings& s) { return s.texture.filter == quality.filter; });
    find(maps,
         [&](const Settings& s) { return s.shadow.size == quality.shadow_size && s.has_shadows; });
    find(texels, [&](const Settings& s) { return s.shadow.pcf == quality.pcf; });
    return choices;
}

void print_frame(const Choices& choices, const Shot& shot) {
    std::printf("{\"levels\": [");
    for (std::size_t knob = 0; knob < choices.size(); ++knob)
        std::printf("%s%zu", knob == 0 ? "" : ", ", choices[knob]);
    std::printf("], \"still\": %.8f, \"moving\": %.8f, \"ms\": [", shot.errors.still,
                shot.errors.moving);
    for (std::size_t round = 0; round < shot.ms.size(); ++round)
        std::printf("%s%.4f", round == 0 ? "" : ", ", shot.ms[round]);
    std::printf("]");
}

void print_knob(const Knob& knob) {
    std::printf(
        "{\"name\": \"%s\", \"lesson\": \"%s\", \"cheapest\": %zu, \"most exact\": %zu, "
        "\"levels\": [",
        knob.name, knob.lesson, knob.cheapest, knob.most_exact);
    for (std::size_t level = 0; level < knob.levels.size(); ++level)
        std::printf("%s\"%s\"", level == 0 ? "" : ", ", knob.levels[level].name);
    std::printf("]}");
}

}  // namespace

int main() {
    keep_freed_memory();
    Choices cheapest, most_exact;
    for (const Knob& knob : knobs()) {
        cheapest.push_back(knob.cheapest);
        most_exact.push_back(knob.most_exact);
    }
    const std::vector<std::pair<const char*, Choices>> presets = {
        {"fast", choices_of(fast_quality, most_exact)},
        {"balanced", choices_of(balanced_quality, most_exact)},
        {"exact", choices_of(exact_quality, most_exact)}};

    Shots shots;
    const auto shot_of = [&](const Choices& choices) -> Shot& {
        return shots.try_emplace(choices, Shot{settings_of(choices)}).first->second;
    };
    const std::vector<Choices> combined = combinations(cheapest);
    for (const Choices& choices : combined) shot_of(choices);
    for (const auto& [name, choices] : presets) shot_of(choices);
    for (const Choices& from : {cheapest, most_exact})
        for (std::size_t knob = 0; knob < knobs().size(); ++knob)
            for (std::size_t level = 0; level < knobs()[knob].levels.size(); ++level)
                shot_of(with(from, knob, level));
    std::vector<Shot*> all;
    for (auto& [choices, shot] : shots) all.push_back(&shot);
    measure(all, Reference(settings_of(most_exact)));

#ifdef __clang__
    std::printf("{\"context\": {\"compiler\": \"clang %s\"},\n", __clang_version__);
#else
    std::printf("{\"context\": {\"compiler\": \"g++ %s\"},\n", __VERSION__);
#endif
    std::printf(" \"knobs\": [");
    const char* between = "\n";
    for (const Knob& knob : knobs()) {
        std::printf("%s  ", between);
        print_knob(knob);
        between = ",\n";
    }
    std::printf("],\n \"frames\": [");
    between = "\n";
    for (const auto& [choices, shot] : shots) {
        std::printf("%s  ", between);
        print_frame(choices, shot);
        if (std::ranges::count(combined, choices) > 0) std::printf(", \"is combined\": true");
        for (const auto& [name, own] : presets)
            if (own == choices) std::printf(", \"preset\": \"%s\"", name);
        std::printf("}");
        between = ",\n";
    }
    std::printf("]}\n");
}
