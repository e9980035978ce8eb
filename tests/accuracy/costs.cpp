// SPDX-License-Identifier: MIT
/// @file
/// What accuracy costs: the choices of all lessons on one scale, in one frame of lesson 13.
///
/// Each choice is raised alone from the cheapest frame, and lowered alone from the most exact one;
/// the choices that take most of the time are tried together, in all combinations; and the filters
/// are tried once more on a floor that reaches to the horizon. Choices that lesson 13 does not have
/// are compared with each other in frames of lesson 11. Writes JSON, of which
/// report_costs.py makes tables and a plot. Takes 2 GB of memory.
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

Settings by_lesson_11(Settings settings) {
    settings.is_by_lesson_11 = true;
    return settings;
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
    double at_edges = 0;  ///< Which share of still's square lies at edges.

    /// Both, one counting as much as the other.
    double both() const { return std::sqrt((still * still + moving * moving) / 2); }
};

/// What a frame should look like, and the next one.
class Reference {
  public:
    /// An edge is where a pixel's samples differ by this standard deviation, in codes.
    static constexpr double least_at_edge = 0.05;

    explicit Reference(Settings settings) {
        settings.samples_per_side = per_side;
        settings.texture.filter = Filter::trilinear;
        settings.shadow.size = 8192, settings.shadow.pcf = 1;
        Image<vec3> samples = samples_of(settings, all_threads());
        codes_ = codes_of(averaged(samples, per_side));
        find_edges(codes_of(std::move(samples)));
        settings.is_moved = true;
        next_codes_ = codes_of(picture_of(settings, all_threads()));
    }

    Errors errors_of(Settings settings) const {
        const Image<vec3> here = codes_of(picture_of(settings, all_threads()));
        settings.is_moved = true;
        const Image<vec3> next = codes_of(picture_of(settings, all_threads()));
        double still = 0, moving = 0, edges = 0;
        for (std::size_t i = 0; i < is_edge_.size(); ++i) {
            const dvec3 off = dvec3(here.pixels()[i]) - dvec3(codes_.pixels()[i]);
            const dvec3 off_next = dvec3(next.pixels()[i]) - dvec3(next_codes_.pixels()[i]);
            still += glm::dot(off, off);
            moving += glm::dot(off_next - off, off_next - off);
            if (is_edge_[i]) edges += glm::dot(off, off);
        }
        const auto numbers = static_cast<double>(3 * is_edge_.size());
        return {std::sqrt(still / numbers), std::sqrt(moving / numbers), edges / still};
    }

    /// Of all pixels.
    double share_of_edges() const {
        return static_cast<double>(std::ranges::count(is_edge_, true)) /
               static_cast<double>(is_edge_.size());
    }

  private:
    static constexpr int per_side = 8;

    void find_edges(const Image<vec3>& samples) {
        const ivec2 size = codes_.size();
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                dvec3 sum(0), squares(0);
                for (int j = 0; j < per_side; ++j)
                    for (int i = 0; i < per_side; ++i) {
                        const dvec3 code(samples[per_side * ivec2(x, y) + ivec2(i, j)]);
                        sum += code, squares += code * code;
                    }
                const dvec3 mean = sum / (1.0 * per_side * per_side);
                const dvec3 variance = squares / (1.0 * per_side * per_side) - mean * mean;
                is_edge_.push_back(glm::dot(variance, dvec3(1.0 / 3)) >
                                   least_at_edge * least_at_edge);
            }
    }

    Image<vec3> codes_, next_codes_;
    std::vector<bool> is_edge_;  ///< For each pixel.
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

double median(std::vector<double> numbers) {
    const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>((numbers.size() - 1) / 2);
    std::nth_element(numbers.begin(), middle, numbers.end());
    return *middle;
}

/// Half of the numbers lie within this of their median.
double deviation(std::vector<double> numbers) {
    const double middle = median(numbers);
    for (double& number : numbers) number = std::abs(number - middle);
    return median(numbers);
}

/// By how much a frame takes longer than another one in the same round.
std::vector<double> ms_more(const Shot& shot, const Shot& than) {
    std::vector<double> more;
    for (std::size_t i = 0; i < std::min(shot.ms.size(), than.ms.size()); ++i)
        more.push_back(shot.ms[i] - than.ms[i]);
    return more;
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

/// As members of a JSON object.
void print_shot(const Shot& shot) {
    std::printf(
        "\"ms\": %.4f, \"still\": %.8f, \"moving\": %.8f, \"both\": %.8f, \"at edges\": %.4f",
        median(shot.ms), shot.errors.still, shot.errors.moving, shot.errors.both(),
        shot.errors.at_edges);
}

void print_step(const char* from, const Shot& before, const Shot& after) {
    const std::vector<double> more = ms_more(after, before);
    std::printf("\"%s\": {\"ms\": %.4f, \"still\": %.8f, \"moving\": %.8f}", from, median(more),
                before.errors.still - after.errors.still,
                before.errors.moving - after.errors.moving);
}

void print_choices(const Choices& choices) {
    for (const std::size_t knob : {samples, textures, maps, texels})
        std::printf("\"%s\": \"%s\", ", knobs()[knob].name,
                    knobs()[knob].levels[choices[knob]].name);
}

/// Who does not draw the picture that lesson 13 draws, bit for bit; or null.
const char* other_picture() {
    const Settings plain;
    const Image<vec3> picture = samples_of(plain, all_threads());
    if (samples_by_11(plain, all_threads(), nullptr) != picture) return "lesson 11";
    if (samples_by_11(plain, all_threads(), draw_lit_by<Shading::phong, Power::polynomial>) !=
        picture)
        return "lesson 11's shader with choices";
    return nullptr;
}

}  // namespace

int main() {
    keep_freed_memory();
    if (const char* other = other_picture()) {
        std::cerr << "error: " << other << " draws another picture than lesson 13\n";
        return 1;
    }
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
    Shots shots_by_11;
    for (const Choices& from : {cheapest, most_exact})
        for (std::size_t knob = 0; knob < knobs().size(); ++knob)
            for (std::size_t level = 0; level < knobs()[knob].levels.size(); ++level)
                if (const Choices choices = with(from, knob, level); knobs()[knob].is_of_lesson_11)
                    shots_by_11.try_emplace(choices, Shot{by_lesson_11(settings_of(choices))});
                else
                    shot_of(choices);
    std::vector<Shot*> all;
    for (auto& [choices, shot] : shots) all.push_back(&shot);
    for (auto& [choices, shot] : shots_by_11) all.push_back(&shot);
    const Reference reference(settings_of(most_exact));
    measure(all, reference);

    // The filters once more, where textures lie far away.
    Shots far;
    const auto horizon = [&](const Choices& choices) {
        Settings settings = settings_of(choices);
        settings.model = "horizon.obj", settings.size = {640, 360};
        settings.orbit = {.yaw_degrees = -25, .pitch_degrees = 12, .distance = 0.035f};
        return settings;
    };
    std::vector<Shot*> all_far;
    for (const std::size_t s : {std::size_t{0}, std::size_t{2}})
        for (std::size_t t = 0; t < 3; ++t) {
            const Choices choices = with(with(most_exact, samples, s), textures, t);
            all_far.push_back(&far.try_emplace(choices, Shot{horizon(choices)}).first->second);
        }
    measure(all_far, Reference(horizon(most_exact)));

#ifdef __clang__
    std::printf("{\"context\": {\"compiler\": \"clang %s\"},\n", __clang_version__);
#else
    std::printf("{\"context\": {\"compiler\": \"g++ %s\"},\n", __VERSION__);
#endif
    std::printf(" \"share of edges\": %.6f,\n \"ends\": [", reference.share_of_edges());
    const char* between = "\n";
    for (const auto& [name, choices] :
         {std::pair("cheapest", cheapest), std::pair("most exact", most_exact)})
        for (const auto& [lesson, drawn] :
             {std::pair("11", &shots_by_11), std::pair("13", &shots)}) {
            const Shot& shot = drawn->at(choices);
            std::printf("%s  {\"frame\": \"%s\", \"drawn by\": \"%s\", \"deviation\": %.4f, ",
                        between, name, lesson, deviation(shot.ms));
            print_shot(shot);
            std::printf("}");
            between = ",\n";
        }
    std::printf("],\n \"steps\": [");
    between = "\n";
    for (std::size_t knob = 0; knob < knobs().size(); ++knob)
        for (std::size_t level = 1; level < knobs()[knob].levels.size(); ++level) {
            const Knob& k = knobs()[knob];
            std::printf("%s  {\"knob\": \"%s\", \"lesson\": \"%s\", \"drawn by\": \"%s\", ",
                        between, k.name, k.lesson, k.is_of_lesson_11 ? "11" : "13");
            std::printf("\"from\": \"%s\", \"to\": \"%s\", ", k.levels[level - 1].name,
                        k.levels[level].name);
            const auto step = [&](const char* name, const Choices& from) {
                const Shots& drawn = k.is_of_lesson_11 ? shots_by_11 : shots;
                print_step(name, drawn.at(with(from, knob, level - 1)),
                           drawn.at(with(from, knob, level)));
            };
            step("cheapest", cheapest);
            std::printf(", ");
            step("most exact", most_exact);
            std::printf("}");
            between = ",\n";
        }
    std::printf("],\n \"combinations\": [");
    between = "\n";
    for (const Choices& choices : combined) {
        std::printf("%s  {", between);
        print_choices(choices);
        for (const auto& [name, own] : presets)
            if (own == choices) std::printf("\"preset\": \"%s\", ", name);
        print_shot(shots.at(choices));
        std::printf("}");
        between = ",\n";
    }
    std::printf("],\n \"horizon\": [");
    between = "\n";
    for (const auto& [choices, shot] : far) {
        std::printf("%s  {", between);
        print_choices(choices);
        print_shot(shot);
        std::printf("}");
        between = ",\n";
    }
    std::printf("]}\n");
}
