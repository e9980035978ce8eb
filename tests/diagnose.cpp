// SPDX-License-Identifier: MIT
/// @file
/// Says what a reader's picture looks like beside the one that the course draws; or what the
/// reader's own program draws, beside stored pictures.
#include <algorithm>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "common/app/threads.hpp"
#include "common/image/image_io.hpp"
#include "support/image_doctor.hpp"
#include "support/lesson_process.hpp"
#include "support/picture_difference.hpp"
#include "support/texts.hpp"

using namespace rasterbook;
using rasterbook::test::ProcessResult, rasterbook::test::diagnose;

namespace {

/// The course's picture of a lesson, drawn with these options.
struct Drawn {
    ProcessResult process;
    Image<u8vec4> picture;  ///< Empty when the program has written none.
};

Drawn draw(const std::string& lesson, std::vector<std::string> arguments, ivec2 size) {
    const auto file = test::fresh_folder("diagnose") / "expected.png";
    arguments.insert(arguments.end(), {"--out", file.string()});
    if (std::ranges::count(arguments, "--size") == 0)
        arguments.insert(arguments.end(),
                         {"--size", std::to_string(size.x) + "x" + std::to_string(size.y)});
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
    std::vector<OtherPicture> others;
    for (const std::string& part : test::parts_after(test::readme_of(lesson), '\n' + mark)) {
        const std::string line = part.substr(0, part.find('\n'));
        if (const auto bar = line.find(" | "); bar != line.npos)
            others.push_back({line.substr(0, bar), line.substr(bar + 3)});
    }
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

/// The course's picture and one with a line wrong, of docs/troubleshooting.md.
struct WrongPicture {
    std::string title;
    std::set<std::string> equations;  ///< Which say what is right.
    std::vector<std::string> options;
    std::filesystem::path right, wrong;
};

std::vector<WrongPicture> wrong_pictures(const std::string& lesson) {
    const std::filesystem::path docs = test::root / "docs";
    const std::string command = "| `./lessons/run " + lesson.substr(0, 2);
    std::vector<WrongPicture> found;
    for (const std::string& section :
         test::parts_after(test::read_text(docs / "troubleshooting.md"), "\n## ")) {
        const auto options = test::all_between(section, command, "`");
        const auto pictures = test::all_between(section, "](troubleshooting/", ")");
        if (options.size() != 1 || pictures.size() != 2) continue;
        std::istringstream words(options[0]);
        found.push_back({section.substr(0, section.find('\n')),
                         test::cited_equations(section),
                         {std::istream_iterator<std::string>(words), {}},
                         docs / "troubleshooting" / pictures[0],
                         docs / "troubleshooting" / pictures[1]});
    }
    return found;
}

std::size_t jumps_between(const Image<u8vec4>& a, const Image<u8vec4>& b) {
    return a.size() == b.size() ? test::picture_difference(a, b).jumps : a.pixels().size();
}

/// What a program of this build draws beside the pictures of docs/troubleshooting.md.
///
/// @param is_right  Becomes false when one of the right ones is not drawn.
/// @return  A line for each wrong one that is.
std::string known_mistakes(const std::string& lesson, bool& is_right) {
    constexpr std::size_t part_left = 10;  // a tenth of the wrong pixels may have another reason
    std::vector<WrongPicture> mistakes = wrong_pictures(lesson);
    // By the options it is drawn with; until then what it should be.
    std::map<std::vector<std::string>, Image<u8vec4>> drawn;
    for (WrongPicture& known : mistakes) {
        if (std::ranges::count(known.options, "--samples") == 0)
            known.options.insert(known.options.end(), {"--samples", "16"});
        drawn.try_emplace(known.options, read_image(known.right));
    }
    for_each_at_once(threads_of_the_machine(), 0, static_cast<int>(drawn.size()) - 1, [&](int i) {
        auto& [options, picture] = *std::next(drawn.begin(), i);
        picture = draw(lesson, options, picture.size()).picture;
    });
    std::string lines;
    for (const WrongPicture& known : mistakes) {
        const Image<u8vec4>& own = drawn[known.options];
        const std::size_t off = jumps_between(own, read_image(known.right));
        if (off == 0) continue;
        is_right = false;
        if (jumps_between(own, read_image(known.wrong)) * part_left > off) continue;
        lines += "It looks as in docs/troubleshooting.md, \"" + known.title + "\"";
        for (std::string number : known.equations) {
            lines +=
                "; Eq. " + number + ", ./tests/run --mine " + lesson.substr(0, 2) + " --test Eq";
            std::ranges::replace(number, '.', '_');
            lines += number + '_';
        }
        lines += '\n';
    }
    return lines;
}

/// Draws with the reader's own program, if this is built with the files in mine/.
///
/// @return  The exit status.
int examine_own(const std::string& lesson) {
    const std::string golden = lesson == "10_threading" ? "09_shadow_maps" : lesson;  // the same
    const Image<u8vec4> expected =
        read_image(std::filesystem::path(RASTERBOOK_GOLDEN) / (golden + ".png"));
    std::vector<std::string> options;
    if (lesson == "07_toon") options = {"--samples", "16"};
    const Drawn own = draw(lesson, options, expected.size());
    std::cerr << own.process.err;
    bool is_right = true;
    const std::string known = known_mistakes(lesson, is_right);
    if (own.picture.size() != expected.size()) {  // it has crashed, or said what is wrong
        std::cout << (known.empty() ? "There is no picture\n" : known);
        return 1;
    }
    const std::string found =
        diagnose(own.picture, expected, test::picture_facts(lesson, options, expected.size()));
    if (is_right && found.empty()) {
        std::cout << "It looks the same as the course's; the tests see more\n";
        return 0;
    }
    const OtherPicture mistake = recognised(lesson, options, "diagnose: ", own.picture);
    if (!known.empty())
        std::cout << known;
    else if (!mistake.options.empty())
        std::cout << "It looks as with " << mistake.options << ": " << mistake.meaning << '\n';
    else if (!found.empty())
        std::cout << "The picture: " << found << '\n';
    else
        std::cout << "The lesson's picture looks the same as the course's; others of "
                     "docs/troubleshooting.md do not\n";
    return 1;
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
    if (!mistake.options.empty())
        std::cout << file << ": looks as with " << mistake.options << ": " << mistake.meaning
                  << '\n';
    else
        std::cout << file << ": " << found << '\n';
    if (!mistake.options.empty() || !options.empty()) return 1;
    const OtherPicture other = recognised(lesson, {}, "gallery: ", actual);
    if (!other.options.empty())
        std::cout << "It is the lesson's picture with " << other.options << '\n';
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    const auto is_lesson = [](const std::string& name) {
        return std::filesystem::is_directory(test::root / "lessons" / name);
    };
    const bool is_own = arguments.size() == 1 && is_lesson(arguments[0]);
    if (!is_own && arguments.size() < 2) {
        std::cerr << "error: a picture and its lesson are to be named: mine.png NN_name "
                     "[OPTION...]\n";
        return 2;
    }
    if (!is_own && !is_lesson(arguments[1])) {
        std::cerr << "error: there is no lesson '" << arguments[1] << "'\n";
        return 2;
    }
    try {
        if (is_own) return examine_own(arguments[0]);
        return examine(arguments[0], arguments[1], {arguments.begin() + 2, arguments.end()});
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << '\n';
        return 1;
    }
}
