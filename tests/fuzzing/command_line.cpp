// SPDX-License-Identifier: MIT
// Random words as lesson 12's command line: what is accepted lies in the bounds of --help; all else
// is bad usage. Lines are words.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "support/lesson_12.hpp"

using namespace rasterbook;

namespace {

void expect(bool is_true) {
    if (!is_true) std::abort();
}

template <typename Number>
bool is_within(Number number, Number least, Number most) {
    return number >= least && number <= most;  // NaN is not
}

void check(const lesson_12::Options& options) {
    constexpr std::array samples = {1, 2, 4, 8}, pcf = {1, 3, 5, 7};
    expect(is_within(options.size.x, 1, 16384) && is_within(options.size.y, 1, 16384));
    expect(std::ranges::count(samples, options.samples_per_side) == 1);
    expect(is_within(options.jobs, 1, max_threads));
    const Frames& frames = options.frames;
    expect(frames.first >= 0 && frames.first <= frames.last && frames.last < frames.of_turn);
    expect(frames.of_turn == 1 || name_of_frame(options.out, 0) != name_of_frame(options.out, 1));
    expect(is_within(options.orbit.yaw_degrees, -36000.0f, 36000.0f));
    expect(is_within(options.orbit.pitch_degrees, -90.0f, 90.0f));
    expect(is_within(options.orbit.distance, 0.01f, 1e6f));
    expect(is_within(options.orbit.fov_degrees, 1.0f, 170.0f));
    expect(is_within(options.shadow.size, 16, 8192));
    expect(std::ranges::count(pcf, options.shadow.pcf) == 1);
    expect(is_within(options.threads.threads, 1, max_threads));
    expect(is_within(options.threads.tile, 8, 16384));
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    std::cout.rdbuf(nullptr);  // what the program says
    std::cerr.rdbuf(nullptr);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<std::string> words{""};
    for (std::size_t i = 0; i < size; ++i)
        if (data[i] == '\n' || data[i] == '\0')
            words.emplace_back();
        else
            words.back() += static_cast<char>(data[i]);
    words.insert(words.begin(), "12_effects");
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());

    lesson_12::Options options;
    const std::optional<int> status =
        read_command_line({"12_effects",
                           "",
                           options,
                           &options.orbit,
                           &options.show_depth,
                           &options.threads.threads,
                           [&](OptionParser& parser) { options.declare(parser); },
                           {},
                           {},
                           true},
                          static_cast<int>(arguments.size()), arguments.data());
    if (status)
        expect(*status == 0 || *status == 2);
    else
        check(options);
    return 0;
}
