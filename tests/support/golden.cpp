// SPDX-License-Identifier: MIT
#include "support/golden.hpp"

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "common/image/image_io.hpp"
#include "support/image_doctor.hpp"
#include "support/lesson_process.hpp"
#include "support/picture_difference.hpp"

namespace rasterbook::test {

namespace {

#ifdef RASTERBOOK_MINE  // the course's picture is right
constexpr const char* if_it_is_right = "";
#else
constexpr const char* if_it_is_right = "\nIf the new picture is right: ./tests/run --update-golden";
#endif

/// Three pictures of one size in a row: expected | actual | difference, the last one four times as
/// strong.
Image<u8vec3> side_by_side(const Image<u8vec4>& expected, const Image<u8vec4>& actual) {
    const ivec2 size = expected.size();
    Image<u8vec3> all({3 * size.x, size.y});
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const ivec3 e(expected[{x, y}]), a(actual[{x, y}]);
            all[{x, y}] = u8vec3(e);
            all[{x + size.x, y}] = u8vec3(a);
            all[{x + 2 * size.x, y}] = u8vec3(glm::min(4 * glm::abs(e - a), ivec3(255)));
        }
    return all;
}

}  // namespace

testing::AssertionResult equals_golden(const std::string& lesson, const std::string& golden,
                                       const std::vector<std::string>& arguments,
                                       std::size_t may_jump) {
    // Several lessons draw the same picture, maybe just now.
    const std::string drawing = golden.starts_with(lesson) ? golden : lesson + "_draws_" + golden;
    const std::filesystem::path folder = RASTERBOOK_LESSONS,
                                actual_file = folder / (drawing + "_actual.png"),
                                expected_file =
                                    std::filesystem::path(RASTERBOOK_GOLDEN) / (golden + ".png");
    std::vector<std::string> all = {"--size", golden_size, "--out", actual_file.string()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProcessResult run = run_program(lesson, all);
    if (run.exit_status != 0)
        return testing::AssertionFailure() << lesson << " failed: " << run.err;
    if (const char* const kept = std::getenv("RASTERBOOK_KEEP_PICTURES"))
        std::filesystem::copy(actual_file, kept);

    const auto replace_golden = [&] {
        std::filesystem::create_directories(RASTERBOOK_GOLDEN);
        std::filesystem::copy_file(actual_file, expected_file,
                                   std::filesystem::copy_options::overwrite_existing);
        std::cout << "replaced " << expected_file.string() << '\n';
        return testing::AssertionSuccess();
    };
    const bool may_replace = std::getenv("RASTERBOOK_UPDATE_GOLDEN") != nullptr;
    if (may_replace && !std::filesystem::exists(expected_file)) return replace_golden();

    const Image<u8vec4> expected = read_image(expected_file), actual = read_image(actual_file);
    if (expected.size() != actual.size())
        return may_replace ? replace_golden()
                           : testing::AssertionFailure()
                                 << "the sizes differ; see " << actual_file.string();
    const PictureDifference difference = picture_difference(actual, expected);
    if (difference.is_tolerable(may_jump)) {
        std::filesystem::remove(actual_file);
        return testing::AssertionSuccess();
    }
    if (may_replace) return replace_golden();
    const std::filesystem::path comparison = folder / (drawing + "_comparison.png");
    write_image(comparison, side_by_side(expected, actual));
    std::string drawn;
    for (const std::string& argument : arguments)
        drawn += (drawn.empty() ? "with " : " ") + argument;
    return testing::AssertionFailure()
           << drawn << (drawn.empty() ? "" : ", ") << difference.in_words(may_jump)
           << "\nThe picture: "
           << diagnose(actual, expected, picture_facts(lesson, arguments, actual.size()))
           << "\nexpected | actual | difference: " << comparison.string() << if_it_is_right;
}

}  // namespace rasterbook::test
