// SPDX-License-Identifier: MIT
// Lesson 14's pictures of random scenes, four pixels at a time and without threads: a line of
// hexadecimal digits for each, the same wherever it runs.
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>

#include "common/image/bmp.hpp"
#include "common/model/load_budget.hpp"
#include "common/model/texture_file.hpp"
#include "support/any_scene.hpp"
#include "support/lesson_14.hpp"

// In place of what reads files: the scenes' images are in memory.
namespace rasterbook {

Image<u8vec4> read_texture_file(const TextureMap& map, const char*, bool, Scene&) {
    return decode_bmp(*map.embedded, map.file);
}
Image<u8vec4> read_texture_file(const TextureMap& map, LoadBudget&) {
    return decode_bmp(*map.embedded, map.file);
}
void LoadBudget::check_overdraw(double, ivec2, const std::filesystem::path&) const {}

// In place of the other widths, which nobody asks for.
extern template WideDrawing drawing_of_width<4>();
template <int N>
WideDrawing drawing_of_width() {
    return drawing_of_width<4>();
}

}  // namespace rasterbook

using namespace rasterbook;

static std::uint64_t hash_of(const Image<vec3>& picture, const Counters& counters) {
    std::uint64_t hash = 0xcbf29ce484222325;
    const auto add = [&](std::uint64_t number) { hash = (hash ^ number) * 0x100000001b3; };
    for (const vec3& color : picture.pixels())
        for (int c = 0; c < 3; ++c) add(std::bit_cast<std::uint32_t>(color[c]));
    for (const std::uint64_t count : counters.values) add(count);
    return hash;
}

int main() {
    constexpr std::array filters = {Filter::nearest, Filter::bilinear, Filter::trilinear};
    constexpr std::array shows = {Show::picture, Show::picture, Show::picture,
                                  Show::ids,     Show::shading, Show::shadow_map};
    ThreadPool pool(1);
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        lesson_14::Options options;
        options.size = seed % 4 == 3 ? ivec2(150, 12) : ivec2(50, 40);
        options.texture.filter = filters[seed % 3];
        options.shadow.size = 64;
        options.shadow.pcf = 1 + 2 * static_cast<int>(seed % 4);
        options.threads.tile = 5 + static_cast<int>(seed % 60);
        options.visibility.shadow_part = 16;
        options.visibility.show = shows[seed % 6];
        options.wide.width = 4;
        PlannedScene assets = load_planned_scene(test::any_scene(seed), options);
        test::add_holes(assets);
        StepClock clock;
        thread_counters = {};
        const Image<vec3> picture = lesson_14::render(options, assets, pool, clock);
        std::printf("%2u %016llx\n", seed,
                    static_cast<unsigned long long>(hash_of(picture, thread_counters)));
    }
}
