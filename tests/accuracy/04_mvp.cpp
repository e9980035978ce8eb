// SPDX-License-Identifier: MIT
/// @file
/// Transforming and clipping: what places far from the world's origin are computed in, and what of
/// a triangle is cut off before it is drawn.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/accuracy.hpp"
#include "lab/mvp_methods.hpp"
#include "support/projected.hpp"
#include "support/seen_by_rays.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// Points in a box of a few units, and the camera that the lesson looks at them with.
struct View {
    static constexpr ivec2 size{1024};
    std::vector<vec3> positions;
    Bounds bounds;
    Camera camera;

    View() {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> any(-4, 4);
        for (int i = 0; i < 10'000; ++i) {
            positions.emplace_back(any(random), any(random), any(random));
            bounds.add(positions.back());
        }
        camera = orbit_camera({}, bounds);
    }
};

/// Distances on the screen between what a variant computes and where the points belong.
Errors place_errors(const View& view, Precision precision) {
    Errors errors;
    for (const int power : {3, 5, 6, 7}) {
        const double offset = std::pow(10.0, power);
        const std::vector<vec4> positions_clip =
            transform({precision, offset}, view.camera, view.size, view.positions);
        const ReferenceCamera reference(view.camera, view.bounds.center(), view.size, offset);
        ErrorSum distances;
        for (std::size_t i = 0; i < positions_clip.size(); ++i) {
            const Place place = reference.on_screen(view.positions[i]);
            const vec3 computed = screen_from_clip(positions_clip[i], view.size);
            distances.add(std::hypot(computed.x - place.x, computed.y - place.y));
        }
        const std::string at = " at 1e" + std::to_string(power);
        errors["greatest error, px" + at] = distances.greatest();
        errors["RMS error, px" + at] = distances.rms();
    }
    return errors;
}

void add_precisions() {
    static const View view;
    static const std::vector<dvec3> world = moved(view.positions, 1e6);
    static const std::vector<vec3> world_float = moved(view.positions, 1e6f);
    const auto add = [](const char* name, Precision precision, std::function<void()> work) {
        add_variant("precision", name, static_cast<double>(view.positions.size()),
                    place_errors(view, precision), std::move(work));
    };
    static std::vector<vec4> sink;
    const mat4 clip_from_world = view.camera.clip_from_world(view.size);
    add("float", Precision::float32, [=] { sink = transform(clip_from_world, world_float); });
    add("relative", Precision::relative,
        [=] { sink = transform_relative(clip_from_world, dvec3(1e6), world); });
    add("double", Precision::float64,
        [=] { sink = transform_double(dmat4(clip_from_world), world); });
}

constexpr ivec2 picture_size(256);

/// Draws a triangle as the lesson does; calls emit(pixel) where its depth is that of something
/// seen.
template <typename Emit>
void draw(const MvpMethod& variant, const std::array<vec4, 3>& vertices, Emit&& emit) {
    if (variant.clipping == Clipping::pixels)
        return fill_homogeneous(whole_triangle(vertices), picture_size, [&](ivec2 pixel, float z) {
            if (z > DepthBuffer::cleared) emit(pixel);
        });
    for (const ClippedTriangle& clipped : clip(variant, vertices, picture_size)) {
        const ProjectedTriangle triangle = projected(clipped, picture_size);
        if (triangle.is_back_facing) continue;
        fill_triangle(triangle.on_screen, picture_size,
                      [&](ivec2 pixel, Barycentrics barycentrics) {
                          if (triangle.depth.at(barycentrics) > DepthBuffer::cleared) emit(pixel);
                      });
    }
}

/// Pixels of a million, of those that should be drawn, that are drawn and should not be, or the
/// other way round, or twice.
double wrong_of_a_million(const MvpMethod& variant, const std::vector<ClipVertices>& triangles) {
    double wrong = 0, seen = 0;
    for (const ClipVertices& vertices : triangles) {
        Image<std::uint8_t> hits(picture_size, 0);
        draw(variant, vertices, [&](ivec2 pixel) { ++hits[pixel]; });
        const RaySeen rays(vertices);
        for (int y = 0; y < picture_size.y; ++y)
            for (int x = 0; x < picture_size.x; ++x) {
                const bool expected = rays.is_seen({x, y}, picture_size);
                wrong += hits[{x, y}] != expected;
                seen += expected;
            }
    }
    return 1e6 * wrong / seen;
}

void add_clippings(const char* comparison, const std::vector<ClipVertices>& triangles) {
    static Image<std::uint8_t> hits(picture_size, 0);
    const std::pair<const char*, Clipping> clippings[] = {
        {"six", Clipping::six_planes}, {"near", Clipping::near_plane}, {"pixel", Clipping::pixels}};
    for (const auto& [name, clipping] : clippings) {
        const MvpMethod variant{.clipping = clipping};
        add_variant(comparison, name, static_cast<double>(triangles.size()),
                    {{"wrong of a million", wrong_of_a_million(variant, triangles)}}, [=] {
                        for (const ClipVertices& vertices : triangles)
                            draw(variant, vertices, [](ivec2 pixel) { ++hits[pixel]; });
                    });
    }
}

}  // namespace

int main(int argc, char** argv) {
    add_precisions();
    add_clippings("small", small_triangles(2000));
    add_clippings("large", large_triangles(500));
    return measure_variants(argc, argv);
}
