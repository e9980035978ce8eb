// SPDX-License-Identifier: MIT
/// @file
/// Says what a reader's picture looks like beside the one that the course draws.
#include <exception>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "common/image_io.hpp"
#include "support/image_doctor.hpp"
#include "support/lesson_process.hpp"

using namespace rasterbook;
using rasterbook::test::ProcessResult, rasterbook::test::diagnose;

namespace {

const std::filesystem::path course = std::filesystem::path(RASTERBOOK_ASSETS).parent_path();

/// The course's picture of a lesson, drawn with these options.
struct Drawn {
    ProcessResult process;
    Image<u8vec4> picture;  ///< Empty when the program has written none.
};

Drawn draw(const std::string& lesson, std::vector<std::string> arguments, ivec2 size) {
    const auto file = test::fresh_folder("diagnose") / "expected.png";
    arguments.insert(
        arguments.end(),
        {"--size", std::to_string(size.x) + "x" + std::to_string(size.y), "--out", file.string()});
    Drawn drawn{test::run_program(lesson, arguments), {}};
    if (std::filesystem::exists(file)) drawn.picture = read_image(file);
    return drawn;
}

/// The options of the lesson's further pictures: "gallery: OPTIONS | ..." in its README.
std::vector<std::string> options_of_other_pictures(const std::string& lesson) {
    std::istringstream readme(test::read_text(course / "lessons" / lesson / "README.md"));
    std::vector<std::string> options;
    const std::string mark = "gallery: ";
    for (std::string line; std::getline(readme, line);)
        if (line.starts_with(mark))
            options.push_back(line.substr(mark.size(), line.find(" |") - mark.size()));
    return options;
}

/// The options of the one of the lesson's further pictures that this is, or "".
std::string recognised(const std::string& lesson, const Image<u8vec4>& actual) {
    for (const std::string& options : options_of_other_pictures(lesson)) {
        std::istringstream words(options);
        const std::vector<std::string> arguments(std::istream_iterator<std::string>(words), {});
        const Drawn other = draw(lesson, arguments, actual.size());
        if (other.picture.size() == actual.size() && diagnose(actual, other.picture, {}).empty())
            return options;
    }
    return "";
}

/// @return  The exit status.
int examine(const std::string& file, const std::string& lesson,
            const std::vector<std::string>& options) {
    const Image<u8vec4> actual = read_image(file);
    const Drawn expected = draw(lesson, options, actual.size());
    std::cerr << expected.process.err;
    if (expected.picture.size() != actual.size()) {  // an error, or --help
        std::cout << expected.process.out;
        return expected.process.exit_status;
    }
    const std::string found =
        diagnose(actual, expected.picture, test::picture_facts(lesson, options, actual.size()));
    if (found.empty()) {
        std::cout << file << " looks the same as the course's; the tests see more\n";
        return 0;
    }
    std::cout << file << ": " << found << '\n';
    const std::string other = options.empty() ? recognised(lesson, actual) : "";
    if (!other.empty()) std::cout << "It is the lesson's picture with " << other << '\n';
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    if (arguments.size() < 2) {
        std::cerr << "error: a picture and its lesson are to be named: mine.png NN_name "
                     "[OPTION...]\n";
        return 2;
    }
    if (!std::filesystem::is_directory(course / "lessons" / arguments[1])) {
        std::cerr << "error: there is no lesson '" << arguments[1] << "'\n";
        return 2;
    }
    try {
        return examine(arguments[0], arguments[1], {arguments.begin() + 2, arguments.end()});
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << '\n';
        return 1;
    }
}
