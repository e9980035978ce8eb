// SPDX-License-Identifier: MIT
// Random scenes, cameras, lights, sizes and options, drawn by lessons 03, 09 and 12: each colour is
// finite, and lesson 12 draws the same bytes with one thread and with three. Of the numbers some
// are small and some are any that a file may have.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <fuzzer/FuzzedDataProvider.h>

#include "common/image/bmp.hpp"
#include "common/math/numerics.hpp"
#include "support/lesson_03.hpp"
#include "support/lesson_09.hpp"
#include "support/lesson_12.hpp"

using namespace rasterbook;

namespace {

/// Takes numbers off the random bytes; when these are used up, all are 0.
class Numbers {
  public:
    Numbers(const std::uint8_t* data, std::size_t size) : bytes_(data, size) {}

    bool flag() { return bytes_.ConsumeBool(); }
    int whole(int least, int most) { return bytes_.ConsumeIntegralInRange(least, most); }

    template <typename Value>
    Value one_of(std::initializer_list<Value> values) {
        return values.begin()[whole(0, static_cast<int>(values.size()) - 1)];
    }

    /// 0 to 1 in 255 steps.
    float share() { return static_cast<float>(bytes_.ConsumeIntegral<std::uint8_t>()) / 255; }
    float between(float least, float most) {
        return std::clamp(least + share() * (most - least), least, most);
    }

    /// Any finite number, of any size; mostly a small one.
    float any() {
        if (whole(0, 3) > 0) return static_cast<float>(bytes_.ConsumeIntegral<std::int8_t>()) / 32;
        const auto number = std::bit_cast<float>(bytes_.ConsumeIntegral<std::uint32_t>());
        return std::isfinite(number) ? number : 0;
    }
    float positive(float least = std::numeric_limits<float>::min()) {
        return std::max(std::abs(any()), least);
    }
    vec3 any_vector() {
        const float x = any(), y = any();
        return {x, y, any()};
    }
    vec3 direction() { return vec3(normalize_or(dvec3(any_vector()), dvec3(0, 0, -1))); }

    /// Colours as loaders leave them.
    vec3 color() { return glm::clamp(any_vector(), -max_color, max_color); }
    vec3 color_to_1() { return glm::clamp(any_vector(), 0.0f, 1.0f); }

  private:
    FuzzedDataProvider bytes_;
};

TextureMap any_map(Numbers& numbers) {
    static const std::array pictures = [] {
        Image<u8vec3> colors({3, 2}, {200, 10, 90}), grey({2, 2}, {50, 50, 50});
        colors[{1, 1}] = {128, 128, 255}, grey[{1, 0}] = {250, 250, 250};
        const auto file = [](const Image<u8vec3>& image) {
            return std::make_shared<const Bytes>(encode_bmp(image, "picture"));
        };
        return std::array{file(colors), file(grey), file(Image<u8vec3>({1, 1}, {9, 99, 199}))};
    }();
    TextureMap map;
    const int which = numbers.whole(0, 4);
    if (which >= static_cast<int>(pictures.size())) return map;
    map.file = std::to_string(which);
    map.embedded = pictures[static_cast<std::size_t>(which)];
    if (numbers.flag()) map.offset = numbers.any_vector(), map.scale = numbers.any_vector();
    for (int axis = 0; axis < 2; ++axis) {
        map.clamp[axis] = numbers.flag();
        map.mirror[axis] = !map.clamp[axis] && numbers.flag();
    }
    map.nearest_magnified = numbers.flag(), map.nearest_minified = numbers.flag();
    map.bump_multiplier = numbers.any();
    return map;
}

Material any_material(Numbers& numbers, bool is_gltf) {
    Material material;
    const auto color = [&] { return is_gltf ? numbers.color_to_1() : numbers.color(); };
    material.ambient = color(), material.diffuse = color(), material.specular = color();
    material.emission = numbers.color();
    material.shininess = numbers.positive(0);
    material.opacity = numbers.share();
    material.illumination = numbers.whole(0, 2);
    material.diffuse_map = any_map(numbers), material.specular_map = any_map(numbers);
    material.emission_map = any_map(numbers);
    material.bump_map = any_map(numbers), material.normal_map = any_map(numbers);
    material.alpha = numbers.one_of({AlphaMode::opaque, AlphaMode::mask, AlphaMode::blend});
    material.alpha_cutoff = numbers.any();
    material.two_sided = numbers.flag();
    if (!is_gltf || !numbers.flag()) return material;
    using Outline = ToonMaterial::Outline;
    material.illumination = 1;
    material.toon = {.shade = numbers.color_to_1(),
                     .toony = numbers.share(),
                     .shift = numbers.between(-1, 1),
                     .outline = numbers.one_of({Outline::none, Outline::world, Outline::screen}),
                     .outline_width = numbers.positive(0),
                     .outline_color = numbers.color_to_1()};
    return material;
}

template <typename Element, typename Make>
std::vector<Element> several(int count, const Make& make) {
    std::vector<Element> elements;
    for (int i = 0; i < count; ++i) elements.push_back(make());
    return elements;
}

Mesh any_mesh(Numbers& numbers, const Scene& scene) {
    Mesh mesh;
    const int points = numbers.whole(3, 9), uvs = numbers.whole(0, 4),
              normals = numbers.whole(0, 3);
    mesh.positions = several<vec3>(points, [&] { return numbers.any_vector(); });
    mesh.uvs = several<dvec2>(uvs, [&] { return dvec2(numbers.any_vector()); });
    mesh.normals = several<vec3>(normals, [&] { return numbers.any_vector(); });
    if (scene.is_gltf && numbers.flag())
        mesh.colors =
            several<vec4>(points, [&] { return vec4(numbers.color_to_1(), numbers.share()); });
    const auto index = [&](int count) {
        return count == 0 ? no_index : static_cast<std::uint32_t>(numbers.whole(0, count - 1));
    };
    const int triangles = numbers.whole(1, 8);
    for (int i = 0; i < triangles; ++i) {
        const auto material = static_cast<std::uint32_t>(
            numbers.whole(0, static_cast<int>(scene.materials.size()) - 1));
        Triangle triangle{{}, material};
        for (Vertex& vertex : triangle.vertices) {
            vertex = {index(points), index(uvs), index(normals)};
            mesh.bounds.add(mesh.positions[vertex.position]);
        }
        mesh.faces.push_back({static_cast<std::uint32_t>(mesh.vertices.size()), 3, material});
        mesh.vertices.insert(mesh.vertices.end(), triangle.vertices.begin(),
                             triangle.vertices.end());
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

/// As load_gltf() makes them: turned and moved.
SceneCamera any_camera(Numbers& numbers) {
    const dvec3 z = numbers.direction(), up = numbers.direction();
    const dvec3 across = std::abs(z.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 x = normalize_or(glm::cross(up, z), glm::normalize(glm::cross(across, z)));
    const dmat4 place(dvec4(x, 0), dvec4(glm::cross(z, x), 0), dvec4(z, 0),
                      dvec4(numbers.any_vector(), 1));
    SceneCamera camera{"", mat4(place), numbers.between(0.001f, 3.14f), numbers.positive(),
                       std::numeric_limits<float>::infinity()};
    if (const float far = numbers.positive(); far > camera.near) camera.far = far;
    return camera;
}

SceneLight any_light(Numbers& numbers) {
    using Kind = SceneLight::Kind;
    SceneLight light{"",
                     numbers.one_of({Kind::directional, Kind::point, Kind::spot}),
                     glm::abs(numbers.any_vector()),
                     numbers.any_vector(),
                     numbers.direction(),
                     numbers.positive()};
    light.cos_outer = numbers.share();
    light.cos_inner = std::max(numbers.share(), std::nextafter(light.cos_outer, 2.0f));
    return light;
}

Scene any_scene(Numbers& numbers) {
    Scene scene;
    scene.is_gltf = numbers.flag();
    scene.materials = several<Material>(numbers.whole(1, 3),
                                        [&] { return any_material(numbers, scene.is_gltf); });
    scene.meshes = several<Mesh>(numbers.whole(1, 3), [&] { return any_mesh(numbers, scene); });
    if (!scene.is_gltf) return scene;
    scene.cameras = several<SceneCamera>(numbers.whole(0, 1), [&] { return any_camera(numbers); });
    scene.lights = several<SceneLight>(numbers.whole(0, 3), [&] { return any_light(numbers); });
    return scene;
}

/// What lessons 09 and 12 have in common.
template <typename Options>
Options any_options(Numbers& numbers, ivec2 size, bool show_depth) {
    Options options;
    options.size = size, options.show_depth = show_depth;
    if (numbers.flag())
        options.orbit = {numbers.between(-36000, 36000), numbers.between(-90, 90),
                         std::clamp(numbers.positive(), 0.01f, 1e6f), numbers.between(1, 170)};
    options.texture.filter = numbers.one_of({Filter::nearest, Filter::bilinear, Filter::trilinear});
    options.texture.wrap = numbers.one_of({Wrap::repeat, Wrap::mirror, Wrap::clamp});
    options.texture.decoding = numbers.one_of({Decoding::srgb, Decoding::ignored});
    options.shading = {numbers.one_of({LightKind::directional, LightKind::point, LightKind::spot}),
                       numbers.flag(), numbers.flag()};
    options.normal_map = {numbers.one_of({MapSpace::tangent, MapSpace::object, MapSpace::none}),
                          numbers.one_of({Green::up, Green::down})};
    options.shadow = {
        numbers.whole(16, 32),
        numbers.one_of({Bias::none, Bias::constant, Bias::slope, Bias::plane, Bias::normal}),
        numbers.one_of({1, 3, 5, 7})};
    return options;
}

void expect_finite(const Image<vec3>& picture) {
    for (const vec3 color : picture.pixels())
        for (int i = 0; i < 3; ++i) {
            if (std::isfinite(color[i])) continue;
            std::fprintf(stderr, "a colour is %g, %g, %g\n", color.r, color.g, color.b);
            std::abort();
        }
}

void draw_03(Numbers& numbers, const Scene& scene, ivec2 size) {
    lesson_03::Options options;
    options.size = size;
    options.paint = numbers.one_of({Paint::flat, Paint::barycentric});
    options.show_depth = numbers.flag();
    expect_finite(lesson_03::render(options, scene));
}

void draw_09(Numbers& numbers, const Scene& scene, ivec2 size) {
    const auto options = any_options<lesson_09::Options>(numbers, size, numbers.flag());
    expect_finite(lesson_09::render(options, lesson_09::make_assets(scene, options)));
}

void draw_12(Numbers& numbers, const Scene& scene, ivec2 size) {
    static ThreadPool one(1), three(3);
    auto options = any_options<lesson_12::Options>(numbers, size, numbers.flag());
    options.threads.split = numbers.one_of({Split::rows, Split::interleaved, Split::tiles});
    options.threads.tile = numbers.whole(8, 20);
    options.camera = numbers.one_of({"", "orbit", "fit"});
    const PlannedScene assets = load_planned_scene(scene, options);
    StepClock clock;
    const Image<vec3> picture = lesson_12::render(options, assets, one, clock);
    expect_finite(picture);
    const Image<vec3> again = lesson_12::render(options, assets, three, clock);
    if (std::memcmp(picture.pixels().data(), again.pixels().data(), picture.pixels().size_bytes()))
        std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Numbers numbers(data, size);
    const auto draw = numbers.one_of({draw_03, draw_09, draw_12});
    const int width = numbers.whole(1, 24);
    const ivec2 picture_size(width, numbers.whole(1, 12));
    draw(numbers, any_scene(numbers), picture_size);
    return 0;
}
