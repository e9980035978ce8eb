// SPDX-License-Identifier: MIT
/// @file
/// Glass that is sorted in each pixel, sorted by triangles, or not at all.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "11_scenes/blending.hpp"
#include "accuracy/accuracy.hpp"
#include "common/math/color.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr ivec2 picture_size(256, 256);
constexpr vec3 behind(0.5f);

struct Pane {
    ScreenTriangle on_screen;
    vec3 depths, color;
    float opacity;
};

/// Panes at all angles, which cut through each other.
std::vector<Pane> random_panes(std::size_t count) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> share(0, 1);
    const auto any = [&] { return vec3(share(random), share(random), share(random)); };
    std::vector<Pane> panes;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 x = 256.0f * any(), y = 256.0f * any();
        panes.push_back({snap_triangle({x.x, y.x}, {x.y, y.y}, {x.z, y.z}), any(), any(),
                         0.25f + 0.5f * share(random)});
    }
    return panes;
}

/// What is seen in a pixel's centre, in double: all panes there, from back to front. Empty where a
/// centre lies on an edge.
std::vector<dvec3> exact_picture(const std::vector<Pane>& panes) {
    std::vector<dvec3> picture;
    for (int y = 0; y < picture_size.y; ++y)
        for (int x = 0; x < picture_size.x; ++x) {
            std::vector<std::pair<double, const Pane*>> here;
            for (const Pane& pane : panes) {
                std::array<double, 3> areas{};
                for (std::size_t i = 0; i < 3; ++i) {
                    const dvec2 p = (dvec2(x, y) + 0.5) * 256.0;
                    const dvec2 a(pane.on_screen.vertices[(i + 1) % 3]),
                        b(pane.on_screen.vertices[(i + 2) % 3]);
                    areas[i] = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
                }
                const double twice_area = areas[0] + areas[1] + areas[2];
                if (std::ranges::any_of(areas, [&](double area) { return area * twice_area <= 0; }))
                    continue;
                const double depth = (areas[0] * pane.depths.x + areas[1] * pane.depths.y +
                                      areas[2] * pane.depths.z) /
                                     twice_area;
                here.emplace_back(depth, &pane);
            }
            std::ranges::sort(here);
            dvec3 color(behind);
            for (const auto& [depth, pane] : here)
                color = double{pane->opacity} * dvec3(pane->color) + (1.0 - pane->opacity) * color;
            picture.push_back(color);
        }
    return picture;
}

template <typename Emit>
void draw(const Pane& pane, Emit&& emit) {
    const TriangleDepth depth(pane.depths);
    fill_triangle(pane.on_screen, picture_size,
                  [&](ivec2 pixel, Barycentrics at) { emit(pixel, depth.at(at)); });
}

void draw_sorted_fragments(const std::vector<Pane>& panes, Image<vec3>& color) {
    TransparentFragments transparent;
    for (const Pane& pane : panes)
        draw(pane, [&](ivec2 pixel, float depth) {
            transparent.add({pixel, depth, pane.opacity, pane.color});
        });
    transparent.blend_over(color);
}

void draw_as_they_come(const std::vector<Pane>& panes, Image<vec3>& color) {
    for (const Pane& pane : panes)
        draw(pane, [&](ivec2 pixel, float) {
            color[pixel] = over(pane.color, pane.opacity, color[pixel]);
        });
}

/// From back to front, by the depths of their middles.
void draw_sorted_triangles(const std::vector<Pane>& panes, Image<vec3>& color) {
    std::vector<Pane> sorted = panes;
    std::ranges::stable_sort(
        sorted, {}, [](const Pane& pane) { return pane.depths.x + pane.depths.y + pane.depths.z; });
    draw_as_they_come(sorted, color);
}

using Draw = void (*)(const std::vector<Pane>&, Image<vec3>&);

void add_panes(std::size_t count) {
    const std::vector<Pane> panes = random_panes(count);
    const std::vector<dvec3> exact = exact_picture(panes);
    std::uint64_t fragments = 0;
    for (const Pane& pane : panes) draw(pane, [&](ivec2, float) { ++fragments; });
    const std::pair<const char*, Draw> ways[] = {{"sorted fragments", draw_sorted_fragments},
                                                 {"sorted triangles", draw_sorted_triangles},
                                                 {"as they come", draw_as_they_come}};
    for (const auto& [name, way] : ways) {
        Image<vec3> picture(picture_size, behind);
        way(panes, picture);
        ErrorSum error;
        for (std::size_t i = 0; i < exact.size(); ++i)
            for (int c = 0; c < 3; ++c)
                error.add(double{srgb_from_linear(picture.pixels()[i][c])} -
                          double{srgb_from_linear(static_cast<float>(exact[i][c]))});
        add_variant("panes_" + std::to_string(count), name, static_cast<double>(fragments),
                    {{"RMS difference", error.rms()}, {"greatest difference", error.greatest()}},
                    [=] {
                        Image<vec3> again(picture_size, behind);
                        way(panes, again);
                    });
    }
}

}  // namespace

int main(int argc, char** argv) {
    add_panes(8);
    add_panes(64);
    return measure_variants(argc, argv);
}
