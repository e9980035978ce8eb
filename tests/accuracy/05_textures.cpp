// SPDX-License-Identifier: MIT
/// @file
/// Textures: how often perspective is divided out, how texels become a fragment's colour, and when
/// sRGB is decoded.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "04_mvp/clip.hpp"
#include "05_textures/texture.hpp"
#include "05_textures/texture_options.hpp"
#include "accuracy/accuracy.hpp"
#include "common/image/image_io.hpp"
#include "lab/texture_methods.hpp"
#include "support/projected.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// A rectangle on the screen: two triangles, whose vertices have uvs.
struct Rectangle {
    std::vector<ClippedTriangle> triangles;
    std::vector<std::array<vec2, 3>> uvs;

    /// @param vertices  Counter-clockwise on the screen, all inside the frustum.
    Rectangle(const std::array<vec4, 4>& vertices, const std::array<vec2, 4>& vertex_uvs) {
        for (std::size_t i = 1; i <= 2; ++i) {
            triangles.push_back({{{vertices[0], {1, 0, 0}},
                                  {vertices[i], {0, 1, 0}},
                                  {vertices[i + 1], {0, 0, 1}}}});
            uvs.push_back({vertex_uvs[0], vertex_uvs[i], vertex_uvs[i + 1]});
        }
    }
};

/// Draws as the lesson does; calls emit(pixel, uv).
template <typename Emit>
void draw(const TextureMethod& method, const Rectangle& rectangle, ivec2 size, Emit&& emit) {
    for (std::size_t i = 0; i < rectangle.triangles.size(); ++i) {
        const ClippedTriangle& clipped = rectangle.triangles[i];
        const ScreenTriangle on_screen = projected(clipped, size).on_screen;
        MappedBarycentrics mapped(method, on_screen, clipped);
        fill_triangle(on_screen, size, [&](ivec2 pixel, Barycentrics screen_barycentrics) {
            emit(pixel, fragment_uv(rectangle.uvs[i], mapped.at(pixel, screen_barycentrics)));
        });
    }
}

void add_mappings() {
    // A prime number of rows: spans begin anywhere along the diagonal.
    static constexpr ivec2 size(512, 61);
    constexpr double texels = 1024;
    // From w = 1 at the left to w = 100 at the right.
    static const Rectangle wall(
        {vec4(-1, -1, 0, 1), vec4(100, -100, 0, 100), vec4(100, 100, 0, 100), vec4(-1, 1, 0, 1)},
        {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)});
    static Image<vec2> sink(size);

    const std::pair<const char*, int> mappings[] = {{"affine", affine}, {"64", 64}, {"32", 32},
                                                    {"16", 16},         {"8", 8},   {"4", 4},
                                                    {"perspective", 1}};
    for (const auto& [name, mapping] : mappings) {
        const TextureMethod method{mapping};
        ErrorSum sum;
        draw(method, wall, size, [&](ivec2 pixel, const FragmentUv& uv) {
            const long double x = (pixel.x + 0.5L) / size.x;
            const long double u = (x / 100) / ((1 - x) + x / 100);  // u/w over 1/w
            sum.add(texels * (u - static_cast<long double>(uv.here.x)));
        });
        const double pixels = size.x * size.y;
        const Errors errors = {{"greatest error, texels", sum.greatest()},
                               {"RMS error, texels", sum.rms()}};
        add_variant("mapping", name, pixels, errors, [=] {
            draw(method, wall, size,
                 [](ivec2 pixel, const FragmentUv& uv) { sink[pixel] = uv.here; });
        });
        add_variant("footprint", name, pixels, errors, [=] {
            draw(method, wall, size, [](ivec2 pixel, const FragmentUv& uv) {
                sink[pixel] = uv.here + uv.ddx + uv.ddy;
            });
        });
    }
}

Image<u8vec4> asset(const std::string& name) {
    return read_image(RASTERBOOK_ASSETS "/textures/" + name + ".png");
}

/// What a code stands for.
long double light_of(std::uint8_t code) {
    const long double srgb = code / 255.0L;
    return srgb <= 0.04045L ? srgb / 12.92L : std::pow((srgb + 0.055L) / 1.055L, 2.4L);
}

Image<dvec3> light_of(const Image<u8vec4>& texels) {
    std::array<double, 256> lights;
    for (std::size_t code = 0; code < lights.size(); ++code)
        lights[code] = static_cast<double>(light_of(static_cast<std::uint8_t>(code)));
    Image<dvec3> light(texels.size());
    for (std::size_t i = 0; i < texels.pixels().size(); ++i) {
        const u8vec4 code = texels.pixels()[i];
        light.pixels()[i] = {lights[code.r], lights[code.g], lights[code.b]};
    }
    return light;
}

void add_difference(ErrorSum& sum, vec4 computed, dvec3 expected) {
    for (int channel = 0; channel < 3; ++channel)
        sum.add(static_cast<double>(computed[channel]) - expected[channel]);
}

/// A floor that reaches to the horizon, which is the picture's upper border. It is seen at the
/// distance 1 in the lowest row; from there up to the middle a texel is 4 pixels to 1 high.
struct Floor {
    static constexpr ivec2 size{256};

    /// Where a point of the screen lies on the floor.
    static dvec2 uv_at(dvec2 screen) {
        const double distance = size.y / screen.y;
        const double aside = (screen.x / size.x - 0.5) * distance;
        constexpr double turned = 0.5, textures_a_unit = 0.25;
        return textures_a_unit * dvec2(std::cos(turned) * aside - std::sin(turned) * distance,
                                       std::sin(turned) * aside + std::cos(turned) * distance);
    }

    /// What lies between two rows.
    static Rectangle strip(int upper, int lower) {
        const std::array<ivec2, 4> places = {ivec2(0, lower), ivec2(size.x, lower),
                                             ivec2(size.x, upper), ivec2(0, upper)};
        std::array<vec4, 4> vertices;
        std::array<vec2, 4> uvs;
        for (std::size_t i = 0; i < 4; ++i) {
            const dvec2 share = dvec2(places[i]) / dvec2(size);
            vertices[i] = vec4(dvec4(2 * share.x - 1, 1 - 2 * share.y, 0, 1) / share.y);
            uvs[i] = vec2(uv_at(dvec2(places[i])));
        }
        return {vertices, uvs};
    }

    /// 1024 samples a pixel, one in each square of a grid of 32 x 32.
    static Image<dvec3> seen(const Image<dvec3>& light) {
        std::mt19937 random(1);
        std::uniform_real_distribution<double> any(0, 1);
        constexpr int grid = 32;
        Image<dvec3> mean(size, dvec3(0));
        for (int y = 0; y < size.y * grid; ++y)
            for (int x = 0; x < size.x * grid; ++x) {
                const dvec2 uv = uv_at(dvec2(x + any(random), y + any(random)) / double{grid});
                const dvec2 share(uv.x - std::floor(uv.x), std::ceil(uv.y) - uv.y);
                const ivec2 texel = glm::min(ivec2(share * dvec2(light.size())), light.size() - 1);
                mean[ivec2(x, y) / grid] += light[texel] / double{grid * grid};
            }
        return mean;
    }
};

void add_filters() {
    struct Material {
        std::string name;
        Texture texture;  ///< Half as fine as the picture: what is seen has more than it.
        Image<dvec3> seen;
    };
    static std::vector<Material> materials;
    for (const std::string name : {"checker", "tiles"}) {
        const Image<u8vec4> texels = asset(name);
        materials.push_back({name,
                             make_texture(downsampled(linear_from_srgb8(texels)), Wrap::repeat),
                             Floor::seen(light_of(texels))});
    }
    static Image<vec4> sink(Floor::size);
    const std::pair<const char*, Filter> filters[] = {{"nearest", Filter::nearest},
                                                      {"bilinear", Filter::bilinear},
                                                      {"trilinear", Filter::trilinear}};
    const auto add = [&](const char* comparison, int upper, int lower) {
        const Rectangle strip = Floor::strip(upper, lower);
        for (const auto& [name, filter] : filters) {
            Errors errors;
            for (const Material& material : materials) {
                ErrorSum sum;
                draw({}, strip, Floor::size, [&](ivec2 pixel, const FragmentUv& uv) {
                    add_difference(sum, sample(material.texture, filter, uv), material.seen[pixel]);
                });
                errors["RMS error, " + material.name] = sum.rms();
            }
            add_variant(comparison, name, Floor::size.x * (lower - upper), errors, [=] {
                const Texture& texture = materials.back().texture;
                draw({}, strip, Floor::size, [&](ivec2 pixel, const FragmentUv& uv) {
                    sink[pixel] = sample(texture, filter, uv);
                });
            });
        }
    };
    add("near", Floor::size.y / 2, Floor::size.y);
    add("far", 1, Floor::size.y / 2);
}

/// The mean of the four texels around a place, 0 to 1; the picture is repeated.
dvec3 mean_around(const Image<dvec3>& light, dvec2 place) {
    const dvec2 texels = place * dvec2(light.size()) - 0.5;
    dvec3 mean(0);
    for (int i = 0; i < 4; ++i) {
        const dvec2 texel = glm::floor(texels) + dvec2(i % 2, i / 2);
        const dvec2 share = 1.0 - glm::abs(texels - texel);
        mean += share.x * share.y * light[(ivec2(texel) + light.size()) % light.size()];
    }
    return mean;
}

void add_decodings() {
    struct Picture {
        std::string name;
        TextureLevel decoded, ignored;
        EncodedLevel encoded;
        Image<dvec3> light;
    };
    static std::vector<Picture> pictures;
    for (const std::string name : {"checker", "wood"}) {
        const Image<u8vec4> texels = asset(name);
        const TextureOptions ignored{.decoding = Decoding::ignored};
        pictures.push_back({name, with_border(linear_from_srgb8(texels), Wrap::repeat),
                            with_border(ignored.decoded(texels), Wrap::repeat),
                            make_encoded_level(texels, Wrap::repeat), light_of(texels)});
    }
    // A square of the screen, turned, with a little less than a texel in a pixel.
    static std::vector<vec2> places;
    constexpr int side = 128;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            places.push_back((vec2(200, 100) + 0.8f * vec2(x, y) + 0.3f * vec2(-y, x)) / 512.0f);
    static std::vector<vec4> sink(places.size());
    static const DecodingTable table;

    const auto add = [](const char* name, auto sample) {
        Errors errors;
        for (const Picture& picture : pictures) {
            ErrorSum sum;
            for (const vec2 place : places)
                add_difference(sum, sample(picture, place), mean_around(picture.light, place));
            errors["RMS error, millionths, " + picture.name] = 1e6 * sum.rms();
            errors["greatest error, millionths, " + picture.name] = 1e6 * sum.greatest();
        }
        add_variant("decoding", name, static_cast<double>(places.size()), errors, [=] {
            const Picture& picture = pictures.back();
            for (std::size_t i = 0; i < places.size(); ++i) sink[i] = sample(picture, places[i]);
        });
    };
    add("decoded", [](const Picture& p, vec2 place) { return sample_bilinear(p.decoded, place); });
    add("table",
        [](const Picture& p, vec2 place) { return sample_by_table(p.encoded, place, table); });
    add("exact", [](const Picture& p, vec2 place) { return sample_by_power(p.encoded, place); });
    add("after", [](const Picture& p, vec2 place) { return sample_then_decode(p.encoded, place); });
    add("ignored", [](const Picture& p, vec2 place) { return sample_bilinear(p.ignored, place); });
}

}  // namespace

int main(int argc, char** argv) {
    add_mappings();
    add_filters();
    add_decodings();
    return measure_variants(argc, argv);
}
