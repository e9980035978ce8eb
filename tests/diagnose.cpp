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

#include "common/image/image_io.hpp"
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

/// A picture that a lesson draws with other options, and what those mean.
struct OtherPicture {
    std::string options, meaning;
};

/// Those that the lesson's README names in its comment: lines "MARK: OPTIONS | MEANING".
std::vector<OtherPicture> other_pictures(const std::string& lesson, const std::string& mark) {
    std::istringstream readme(test::read_text(course / "lessons" / lesson / "README.md"));
    std::vector<OtherPicture> others;
    for (std::string line; std::getline(readme, line);)
        if (const auto bar = line.find(" | "); line.starts_with(mark) && bar != line.npos)
            others.push_back({line.substr(mark.size(), bar - mark.size()), line.substr(bar + 3)});
    return others;
}

/// The first of the other pictures that this is; of no options if it is none of them.
///
/// @param options  Given besides.
OtherPicture recognised(const std::string& lesson, const std::vector<std::string>& options,
                        const std::string& mark, const Image<u8vec4>& actual) {
    for (const OtherPicture& other : other_pictures(lesson, mark)) {
        std::vector<std::string> arguments = options;
        std::istringstream words(other.options);
        arguments.insert(arguments.end(), std::istream_iterator<std::string>(words), {});
        const Image<u8vec4> picture = draw(lesson, arguments, actual.size()).picture;
        if (picture.size() == actual.size() && diagnose(actual, picture, {}).empty()) return other;
    }
    return {};
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
    const OtherPicture mistake = recognised(lesson, options, "diagnose: ", actual);
    if (!mistake.options.empty()) {
        std::cout << file << ": looks as with " << mistake.options << ": " << mistake.meaning
                  << '\n';
        return 1;
    }
    std::cout << file << ": " << found << '\n';
    if (!options.empty()) return 1;
    const OtherPicture other = recognised(lesson, {}, "gallery: ", actual);
    if (!other.options.empty())
        std::cout << "It is the lesson's picture with " << other.options << '\n';
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
