// SPDX-License-Identifier: MIT
/// @file
/// Lesson 12 with rounded barycentric planes: their errors, their pictures and their time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
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

/// How lesson_12_by_planes finds barycentric coordinates; `collected` takes what is visible.
enum class PlaneNumbers { float64, float32, float32_of_triangle };
inline PlaneNumbers plane_numbers{};
inline std::vector<VisiblePart>* collected = nullptr;

/// shade_pixels() with other planes.
template <typename Planes, Permutation with, typename Maps>
void shade_pixels_by(const Frame<Maps>& frame, const ProjectedTriangle& projected,
                     std::span<const PixelSpan> spans) {
    TriangleInputs triangle = triangle_inputs(with, frame, projected);
    const Planes planes(projected.on_screen);
    for (const PixelSpan& span : spans)
        planes.for_each_in(span, [&](ivec2 pixel, Barycentrics on_screen) {
            const FragmentBarycentrics at = perspective_correct(triangle.setup, on_screen);
            const vec3 in_texture(texture_sample(triangle.surface, at, frame.filter));
            frame.color[pixel] = shaded<with>(frame, triangle, at, in_texture);
        });
}

template <typename Planes, typename Maps, std::size_t... i>
void shade_permutation_by(std::index_sequence<i...>, std::size_t permutation,
                          const Frame<Maps>& frame, const ProjectedTriangle& projected,
                          std::span<const PixelSpan> spans) {
    ((permutation == i ? shade_pixels_by<Planes, all_permutations[i]>(frame, projected, spans)
                       : void()),
     ...);
}

/// Takes the place of shade_visible().
template <typename Maps>
void shade_visible_by_planes(const Frame<Maps>& frame, const VisibleShaders<Maps>&,
                             VisibilityBuffer& visible, Show, HeatMap&) {
    visible.take_visible([&](const ProjectedTriangle& projected, std::span<const PixelSpan> spans) {
        if (collected != nullptr)
            collected->push_back({projected.on_screen, {spans.begin(), spans.end()}});
        const auto shade = [&]<typename Planes>() {
            shade_permutation_by<Planes>(
                std::make_index_sequence<all_permutations.size()>(),
                permutation_of(frame.assets.plan.materials[projected.triangle.material]), frame,
                projected, spans);
        };
        switch (plane_numbers) {
            case PlaneNumbers::float64:
                return shade.template operator()<RoundedPlanes<double>>();
            case PlaneNumbers::float32:
                return shade.template operator()<RoundedPlanes<float>>();
            case PlaneNumbers::float32_of_triangle:
                return shade.template operator()<RoundedPlanes<float, PlaneOrigin::triangle>>();
        }
    });
}

}  // namespace rasterbook::test

/// Lesson 12, but for its planes.
#define main static lesson_main [[maybe_unused]]
#define shade_visible rasterbook::test::shade_visible_by_planes
namespace lesson_12_by_planes {
using rasterbook::test::run_scene_lesson;
#include "lessons/12_visibility_buffer/main.cpp"
}  // namespace lesson_12_by_planes
#undef shade_visible
#undef main

namespace rasterbook::test {

/// Errors against the exact quotient, which rounds only to 64 bits.
class PlaneErrors {
  public:
    void add(float found, long double exact) {
        const long double error = std::abs(static_cast<long double>(found) - exact);
        greatest_ = std::max(greatest_, error);
        squares_ += static_cast<double>(error * error);
        ++count_;
        if (exact == 0) return;  // it has no ulp
        const long double ulps = std::ldexp(error, 23 - std::ilogb(exact));
        greatest_ulps_ = std::max(greatest_ulps_, ulps);
        squares_of_ulps_ += static_cast<double>(ulps * ulps);
        ++count_with_ulps_;
    }

    Errors errors() const {
        constexpr double million = 1e6;
        const auto rms = [](double squares, std::size_t count) {
            return std::sqrt(squares / static_cast<double>(count));
        };
        return {{"greatest error, ulp", static_cast<double>(greatest_ulps_)},
                {"RMS error, ulp", rms(squares_of_ulps_, count_with_ulps_)},
                {"greatest error, millionths", million * static_cast<double>(greatest_)},
                {"RMS error, millionths", million * rms(squares_, count_)}};
    }

  private:
    long double greatest_ = 0, greatest_ulps_ = 0;
    double squares_ = 0, squares_of_ulps_ = 0;
    std::size_t count_ = 0, count_with_ulps_ = 0;
};

template <typename Planes>
Errors errors_of(const std::vector<VisiblePart>& parts) {
    PlaneErrors errors;
    for (const auto& [triangle, spans] : parts) {
        const auto [a, b, c] = triangle.vertices;
        const auto area = static_cast<long double>(exact_twice_area(a, b, c));
        const Planes planes(triangle);
        for (const PixelSpan& span : spans)
            planes.for_each_in(span, [&](ivec2 pixel, Barycentrics found) {
                const ivec2 p = exact_center(pixel);
                const std::array edges = {std::pair{b, c}, std::pair{c, a}, std::pair{a, b}};
                for (int i = 0; i < 3; ++i) {
                    const auto& [from, to] = edges[static_cast<std::size_t>(i)];
                    errors.add(found[i],
                               static_cast<long double>(exact_twice_area(from, to, p)) / area);
                }
            });
    }
    return errors.errors();
}

inline volatile float kept;  ///< So that a sum is not left out.

template <typename Planes>
void add_planes(const std::string& variant, const std::vector<VisiblePart>& parts,
                const std::function<Image<vec3>(const SceneAssets&)>& draw) {
    Errors errors = errors_of<Planes>(parts);
    for (const auto& [name, assets] : scenes())
        errors[name + ", %"] =
            differing_percent_of_files(draw(*assets), frame(lesson_11::Options(), *assets));
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

inline void add_all_planes() {
    static std::vector<VisiblePart> parts;
    const auto draw_by = [](PlaneNumbers numbers) {
        return [=](const SceneAssets& assets) {
            plane_numbers = numbers;
            StepClock clock;
            return lesson_12_by_planes::render(lesson_12_by_planes::Options(), assets, one_thread(),
                                               clock);
        };
    };
    collected = &parts;
    for (const NamedScene& scene : scenes()) draw_by(PlaneNumbers::float64)(*scene.assets);
    collected = nullptr;
    add_planes<BarycentricPlanes>("whole numbers", parts, [](const SceneAssets& assets) {
        return frame(lesson_12::Options(), assets);
    });
    add_planes<RoundedPlanes<double>>("double", parts, draw_by(PlaneNumbers::float64));
    add_planes<RoundedPlanes<float>>("float", parts, draw_by(PlaneNumbers::float32));
    add_planes<RoundedPlanes<float, PlaneOrigin::triangle>>(
        "float, from the triangle", parts, draw_by(PlaneNumbers::float32_of_triangle));
}

}  // namespace rasterbook::test
