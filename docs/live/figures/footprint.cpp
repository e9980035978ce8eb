// SPDX-License-Identifier: MIT
/// @file
/// Lesson 05's texture on a floor, each pixel's footprint and level, for the figure footprint.js.
#include <array>
#include <cstdint>
#include <vector>

#include "04_mvp/transform.hpp"
#include "05_textures/texture.hpp"

namespace rasterbook {
namespace {

constexpr ivec2 screen_size(40, 30);
constexpr int texture_side = 64;
constexpr float texels_per_unit = 40;

/// A chessboard of squares of 16 texels with thin lines between them; one square is amber.
Image<vec4> picture() {
    Image<u8vec4> texels{ivec2(texture_side)};
    for (int y = 0; y < texture_side; ++y)
        for (int x = 0; x < texture_side; ++x) {
            const ivec2 square = ivec2(x, y) / 16;
            const bool is_line = x % 16 == 0 || y % 16 == 0;
            const bool is_light = (square.x + square.y) % 2 == 0;
            texels[{x, y}] = is_line                 ? u8vec4(30, 64, 140, 255)
                             : square == ivec2(1, 2) ? u8vec4(245, 158, 11, 255)
                             : is_light              ? u8vec4(239, 246, 255, 255)
                                                     : u8vec4(96, 150, 235, 255);
        }
    return linear_from_srgb8(texels);
}

const Texture texture = make_texture(picture(), Wrap::repeat);

/// What a pixel of the floor shows.
struct Seen {
    float is_floor;  ///< 0: all else has no meaning.
    vec2 position;   ///< In texels, y down, from 0 to the texture's size.
    vec2 across;     ///< How far a pixel to the right is, in texels, y down.
    vec2 down;       ///< The same of a pixel down.
    float level;
};
std::array<Seen, screen_size.x * screen_size.y> seen;
std::vector<u8vec4> bytes;

u8vec4 srgb8(vec4 linear) {
    return {srgb8_from_linear(linear.r), srgb8_from_linear(linear.g), srgb8_from_linear(linear.b),
            255};
}

}  // namespace

/// Draws the floor.
///
/// @param pitch   Of the camera, downwards, radians.
/// @param filter  As in Filter.
/// @return        40 x 30 pixels: red, green, blue and alpha; 0 where there is no floor.
extern "C" const u8vec4* draw(float pitch, int filter) {
    seen.fill({});
    bytes.assign(seen.size(), u8vec4(0));
    const vec3 eye(0, 1.1f, 0);
    const mat4 clip_from_world =
        perspective(glm::radians(50.0f), 4.0f / 3, 0.05f) *
        look_at(eye, eye + vec3(0, -std::sin(pitch), -std::cos(pitch)), vec3(0, 1, 0));
    const std::array<vec3, 4> corners = {{{-9, 0, 3}, {9, 0, 3}, {9, 0, -6.5f}, {-9, 0, -6.5f}}};
    const auto draw_triangle = [&](std::array<vec3, 3> vertices) {
        std::array<vec2, 3> uvs;
        std::array<vec4, 3> positions_clip;
        for (std::size_t i = 0; i < 3; ++i) {
            const vec3 p = rotation_y(0.4f) * vec4(vertices[i], 1);
            uvs[i] = vec2(p.x, -p.z) * (texels_per_unit / texture_side);
            positions_clip[i] = clip_from_world * vec4(vertices[i], 1);
        }
        for (const ClippedTriangle& clipped : clip_triangle(positions_clip)) {
            const auto corner = [&](std::size_t i) {
                return vec2(screen_from_clip(clipped[i].position_clip, screen_size));
            };
            const ScreenTriangle on_screen = snap_triangle(corner(0), corner(1), corner(2));
            const PerspectiveSetup setup = perspective_setup(on_screen, clipped);
            fill_triangle(on_screen, screen_size, [&](ivec2 pixel, Barycentrics barycentrics) {
                const FragmentUv uv = fragment_uv(uvs, perspective_correct(setup, barycentrics));
                const std::size_t i = pixel.y * screen_size.x + pixel.x;
                const vec2 texels(texture_side, -texture_side);  // v points up
                seen[i] = {1, float(texture_side) * texture_position(uv.here, texture.wrap),
                           uv.ddx * texels, uv.ddy * texels,
                           level_of_detail(uv.ddx, uv.ddy, texture.levels[0].size)};
                bytes[i] = srgb8(sample(texture, Filter(filter), uv));
            });
        }
    };
    draw_triangle({corners[0], corners[1], corners[2]});
    draw_triangle({corners[0], corners[2], corners[3]});
    return bytes.data();
}

/// Of the picture drawn last.
extern "C" const Seen* seen_in(int x, int y) { return &seen[y * screen_size.x + x]; }

/// The texels of a level, row by row.
///
/// @param level  0 to 6: 64 to 1 texels a side.
extern "C" const u8vec4* texels_of(int level) {
    const auto& [size, texels] = texture.levels[level];
    bytes.clear();
    for (int y = 1; y <= size.y; ++y)
        for (int x = 1; x <= size.x; ++x) bytes.push_back(srgb8(texels[{x, y}]));
    return bytes.data();
}

}  // namespace rasterbook
