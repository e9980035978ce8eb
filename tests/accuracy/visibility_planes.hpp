// SPDX-License-Identifier: MIT
/// @file
/// Lesson 13 with barycentric planes in float: their errors, their pictures and their time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/visibility_frames.hpp"
#include "support/exact.hpp"
#include "support/rounded_planes.hpp"

namespace rasterbook::test {

/// What of a triangle is visible in a tile.
struct VisiblePart {
    ScreenTriangle triangle;
    std::vector<PixelSpan> spans;
};

/// Takes what is visible, if it is not null.
inline std::vector<VisiblePart>* collected = nullptr;

/// shade_pixels() with other planes.
template <Permutation with, typename Maps>
void shade_pixels_by_planes(const Frame<Maps>& frame, const ProjectedTriangle& projected,
                            std::span<const PixelSpan> spans) {
    TriangleInputs triangle = triangle_inputs(with, frame, projected);
    const RoundedPlanes<float> planes(projected.on_screen);
    for (const PixelSpan& span : spans)
        planes.for_each_in(span, [&](ivec2 pixel, Barycentrics on_screen) {
            const FragmentBarycentrics at = perspective_correct(triangle.setup, on_screen);
            const vec3 in_texture(texture_sample(triangle.surface, at, frame.filter));
            frame.color[pixel] = shaded<with>(frame, triangle, at, in_texture);
        });
}

/// Takes the place of shade_visible().
template <typename Maps>
void shade_visible_by_planes(const Frame<Maps>& frame, const VisibleShaders<Maps>&,
                             VisibilityBuffer& visible, Show, HeatMap&) {
    visible.take_visible([&](const ProjectedTriangle& projected, std::span<const PixelSpan> spans) {
        if (collected != nullptr)
            collected->push_back({projected.on_screen, {spans.begin(), spans.end()}});
        const std::size_t permutation =
            permutation_of(frame.assets.effects[projected.triangle.material]);
        [&]<std::size_t... i>(std::index_sequence<i...>) {
            ((permutation == i
                  ? shade_pixels_by_planes<all_permutations[i]>(frame, projected, spans)
                  : void()),
             ...);
        }(std::make_index_sequence<all_permutations.size()>());
    });
}

}  // namespace rasterbook::test

/// Lesson 13, but for its planes.
#define main static lesson_main [[maybe_unused]]
#define shade_visible rasterbook::test::shade_visible_by_planes
namespace lesson_12_by_planes {
using rasterbook::test::run_effects_lesson;
#include "lessons/13_visibility_buffer/main.cpp"
}  // namespace lesson_12_by_planes
#undef shade_visible
#undef main

namespace rasterbook::test {

/// Errors of barycentric coordinates against the exact quotient, which rounds only to 64 bits.
template <typename Planes>
Errors errors_of(const std::vector<VisiblePart>& parts) {
    ErrorSum errors;
    for (const auto& [triangle, spans] : parts) {
        const auto [a, b, c] = triangle.vertices;
        const auto area = static_cast<long double>(exact_twice_area(a, b, c));
        const std::array edges = {std::pair{b, c}, std::pair{c, a}, std::pair{a, b}};
        const Planes planes(triangle);
        for (const PixelSpan& span : spans)
            planes.for_each_in(span, [&](ivec2 pixel, Barycentrics found) {
                const ivec2 p = exact_center(pixel);
                for (std::size_t i = 0; i < 3; ++i) {
                    const auto& [from, to] = edges[i];
                    const auto exact =
                        static_cast<long double>(exact_twice_area(from, to, p)) / area;
                    errors.add(found[static_cast<int>(i)] - exact);
                }
            });
    }
    return {{"greatest error, millionths", 1e6 * errors.greatest()},
            {"RMS error, millionths", 1e6 * errors.rms()}};
}

inline volatile float kept;  ///< So that a sum is not left out.

/// @param draw  Called as draw(assets).
template <typename Planes, typename Draw>
void add_planes_of(const std::string& variant, const std::vector<VisiblePart>& parts, Draw draw) {
    Errors errors = errors_of<Planes>(parts);
    for (const auto& [name, assets] : scenes())
        errors[name + ", %"] =
            differing_percent_of_files(draw(*assets), frame(lesson_12::Options(), *assets));
    double pixels = 0;
    for (const VisiblePart& part : parts)
        for (const PixelSpan& span : part.spans) pixels += span.length;
    add_variant("planes", variant, pixels, errors, [&parts] {
        vec3 sum(0);
        for (const auto& [triangle, spans] : parts) {
            const Planes planes(triangle);
            for (const PixelSpan& span : spans)
                planes.for_each_in(span, [&](ivec2, Barycentrics found) { sum += found; });
        }
        kept = sum.x + sum.y + sum.z;
    });
}

inline void add_planes() {
    static std::vector<VisiblePart> parts;
    const auto draw_by_planes = [](const PlannedScene& assets) {
        StepClock clock;
        return lesson_12_by_planes::render(lesson_12_by_planes::Options(), assets, one_thread(),
                                           clock);
    };
    collected = &parts;
    for (const NamedScene& scene : scenes()) draw_by_planes(*scene.assets);
    collected = nullptr;
    add_planes_of<BarycentricPlanes>("whole numbers", parts, [](const PlannedScene& assets) {
        return frame(lesson_13::Options(), assets);
    });
    add_planes_of<RoundedPlanes<float>>("float", parts, draw_by_planes);
}

}  // namespace rasterbook::test
