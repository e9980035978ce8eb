// SPDX-License-Identifier: MIT
#include "common/app/lesson_app.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <random>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "common/image/backdrop.hpp"
#include "common/image/image_io.hpp"
#include "common/math/color.hpp"

namespace rasterbook {
namespace {

using Words = std::vector<std::string>;

constexpr std::size_t most_pictures = 12;

struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// "a,b" and ',' give "a" and "b".
Words split(const std::string& text, char separator) {
    std::istringstream stream(text + separator);
    Words words;
    for (std::string word; std::getline(stream, word, separator);) words.push_back(word);
    return words;
}

std::string joined(const Words& words, const std::string& separator) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
    return text;
}

const Choice* find(const std::vector<Choice>& choices, const std::string& name) {
    const auto found = std::ranges::find(choices, name, &Choice::name);
    return found == choices.end() ? nullptr : &*found;
}

/// The command line with "--name=word" as two words.
Words normalized(const Words& given, const std::vector<Choice>& choices) {
    Words words;
    for (const std::string& word : given) {
        const std::size_t equals = word.find('=');
        const std::string name = word.substr(0, equals);
        words.push_back(find(choices, name) ? name : word);
        if (words.back() != word) words.push_back(word.substr(equals + 1));
    }
    return words;
}

/// What one picture is drawn by.
struct Method {
    Words line;    ///< Its command line.
    Words lists;   ///< The options that are given several words,
    Words chosen;  ///< and of each the word by which this picture is drawn.
};

/// Each combination of the words of all lists; one without words where there is no list.
std::vector<Method> methods_of(const Words& given, const std::vector<Choice>& choices) {
    std::vector<Method> methods(1);
    for (std::size_t i = 0; i < given.size(); ++i) {
        const bool is_chosen = i > 0 && find(choices, given[i - 1]);
        const Words words = is_chosen ? split(given[i], ',') : Words{given[i]};
        if (methods.size() * words.size() > most_pictures)
            throw UsageError(
                given[i - 1] + ": these are " + std::to_string(methods.size() * words.size()) +
                " pictures, and no more than " + std::to_string(most_pictures) + " are compared");
        std::vector<Method> longer;
        for (const Method& method : methods)
            for (const std::string& word : words) {
                longer.push_back(method);
                longer.back().line.push_back(word);
                if (words.size() > 1) {
                    longer.back().lists.push_back(given[i - 1]);
                    longer.back().chosen.push_back(word);
                }
            }
        methods = std::move(longer);
    }
    return methods;
}

/// The command line with the reference's choices in place of its own; where the reference has none,
/// without those that have several words.
Words line_of_reference(const Words& reference, const Words& given, const Words& lists) {
    const Words& replaced = reference.empty() ? lists : reference;
    Words words;
    for (std::size_t i = 0; i < given.size(); ++i) {
        if (std::ranges::count(replaced, given[i]) > 0)
            ++i;  // and its word
        else
            words.push_back(given[i]);
    }
    words.insert(words.end(), reference.begin(), reference.end());
    return words;
}

/// One of the pictures.
struct Trial {
    LessonProgram program;
    std::string name;  ///< The words that tell it from the others.
    Image<u8vec3> picture{};
    std::vector<double> times_ms{};

    void draw() {
        const auto start = std::chrono::steady_clock::now();
        const Image<vec3> drawn =
            averaged(program.render(program.frame()), program.options.samples_per_side);
        const std::chrono::duration<double, std::milli> elapsed =
            std::chrono::steady_clock::now() - start;
        times_ms.push_back(elapsed.count());
        picture = srgb8_from_linear(drawn);
    }

    /// @param share  0 for the least time, 0.5 for the median, 1 for the longest.
    double time_ms(double share) const {
        std::vector<double> sorted = times_ms;
        std::ranges::sort(sorted);
        return sorted[static_cast<std::size_t>(
            std::lround(share * static_cast<double>(sorted.size() - 1)))];
    }
};

/// How far a picture is from the reference, in steps of 8 bits.
struct Error {
    std::size_t pixels = 0;  ///< That differ.
    int greatest = 0;
    double root_mean_square = 0;
};

u8vec3 difference(u8vec3 a, u8vec3 b) { return u8vec3(glm::abs(ivec3(a) - ivec3(b))); }

Error error_of(const Image<u8vec3>& picture, const Image<u8vec3>& reference) {
    Error error;
    double squares = 0;
    for (std::size_t i = 0; i < picture.pixels().size(); ++i) {
        const ivec3 apart(difference(picture.pixels()[i], reference.pixels()[i]));
        const int greatest = std::max({apart.x, apart.y, apart.z});
        error.pixels += greatest > 0;
        error.greatest = std::max(error.greatest, greatest);
        squares += glm::dot(dvec3(apart), dvec3(apart));
    }
    error.root_mean_square =
        std::sqrt(squares / (3.0 * static_cast<double>(picture.pixels().size())));
    return error;
}

void check(const LessonOptions& options) {
    for (const auto& [is_asked, name] :
         {std::pair(options.stats, "--stats"), std::pair(options.frames.of_turn > 1, "--frames")})
        if (is_asked) throw UsageError(std::string(name) + " is for one picture, not for several");
}

/// Draws all by turns, in random order, until there are enough times.
void draw_by_turns(std::deque<Trial>& trials) {
    constexpr int most_rounds = 9, fewest_rounds = 3;
    constexpr std::chrono::seconds long_enough(20);
    const auto start = std::chrono::steady_clock::now();
    std::vector<Trial*> order;
    for (Trial& trial : trials) order.push_back(&trial);
    std::mt19937 random(1);
    for (int round = 0; round < most_rounds; ++round) {
        if (round >= fewest_rounds && std::chrono::steady_clock::now() - start > long_enough) break;
        std::ranges::shuffle(order, random);
        for (Trial* const trial : order) trial->draw();
    }
}

void print_table(const std::string& heading, const std::string& reference,
                 const std::deque<Trial>& trials, const std::vector<Error>& errors) {
    std::size_t width = heading.size();
    for (const Trial& trial : trials) width = std::max(width, trial.name.size());
    std::ostringstream table;
    const auto cell = [&](int columns) -> std::ostream& { return table << std::setw(columns); };
    table << std::fixed << std::left;
    cell(int(width)) << "" << "    differs from " << reference << '\n';
    cell(int(width)) << heading << std::right << "      pixels    most     RMS    ms to draw, and "
                     << "half of the times\n";
    for (std::size_t i = 0; i < trials.size(); ++i) {
        const Trial& trial = trials[i];
        table << std::left;
        cell(int(width)) << trial.name << std::right;
        cell(12) << errors[i].pixels;
        cell(8) << errors[i].greatest << std::setprecision(3);
        cell(8) << errors[i].root_mean_square << std::setprecision(2);
        cell(14) << trial.time_ms(0.5);
        cell(11) << trial.time_ms(0.25) << " to " << trial.time_ms(0.75) << '\n';
    }
    std::cout << table.str() << "most and RMS: of 255; times: medians of "
              << trials.front().times_ms.size() << ", by turns\n";
}

/// The pictures in a row, and below each its difference from the reference.
Image<u8vec3> side_by_side(const std::deque<Trial>& trials, const Image<u8vec3>& reference,
                           int brightness) {
    const ivec2 size = reference.size();
    Image<u8vec3> sheet({size.x * static_cast<int>(trials.size()), 2 * size.y});
    for (std::size_t i = 0; i < trials.size(); ++i)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const ivec2 at(static_cast<int>(i) * size.x + x, y);
                sheet[at] = trials[i].picture[{x, y}];
                sheet[at + ivec2(0, size.y)] = u8vec3(
                    brightness * ivec3(difference(trials[i].picture[{x, y}], reference[{x, y}])));
            }
    return sheet;
}

/// "lab_wu.png" for "lab.png" and "wu".
std::filesystem::path with_name(const std::filesystem::path& file, std::string name) {
    std::ranges::replace(name, ' ', '_');
    std::filesystem::path named = file;
    named.replace_filename(file.stem().string() + '_' + name + file.extension().string());
    return named;
}

int compare(const std::function<LessonProgram()>& make, const std::string& reference_text,
            const Words& given, const std::vector<Method>& methods) {
    const Words reference_words = reference_text.empty() ? Words() : split(reference_text, ' ');
    const std::string what = reference_text.empty() ? "the lesson's own" : reference_text;
    std::deque<Trial> trials;  // the last one is the reference
    std::vector<Method> all = methods;
    all.push_back({line_of_reference(reference_words, given, methods.front().lists), {}, {}});
    for (const Method& method : all) {
        Trial& trial = trials.emplace_back(Trial{make(), joined(method.chosen, " ")});
        trial.program.fills_triangles = false;  // --probe explains one picture
        Words line{trial.program.name};
        line.insert(line.end(), method.line.begin(), method.line.end());
        std::vector<char*> arguments;
        for (std::string& word : line) arguments.push_back(word.data());
        if (const auto status = read_command_line(trial.program, static_cast<int>(arguments.size()),
                                                  arguments.data()))
            return *status;
        check(trial.program.options);
    }
    const Scene model = read_model(trials.front().program.options);
    for (Trial& trial : trials) {
        trial.program.options.size *= trial.program.options.samples_per_side;
        const Scene& prepared = trial.program.prepare(model);
        if (&trial == &trials.front()) print_warnings(prepared);
    }
    Trial reference = std::move(trials.back());
    trials.pop_back();
    reference.draw();
    draw_by_turns(trials);

    std::vector<Error> errors;
    int greatest = 0;
    for (const Trial& trial : trials) {
        errors.push_back(error_of(trial.picture, reference.picture));
        greatest = std::max(greatest, errors.back().greatest);
    }
    print_table(joined(methods.front().lists, " "), what, trials, errors);

    const std::filesystem::path out = trials.front().program.options.out;
    const int brightness = greatest > 0 ? 255 / greatest : 1;
    for (const Trial& trial : trials) write_image(with_name(out, trial.name), trial.picture);
    write_image(out, side_by_side(trials, reference.picture, brightness));
    std::cout << "wrote " << with_name(out, trials.front().name).string() << " and so on, and "
              << out.string() << " with all side by side;\nbelow each its difference from " << what
              << (brightness > 1 ? ", " + std::to_string(brightness) + " times as bright" : "")
              << '\n';
    return 0;
}

/// A text in lines of up to 80 characters, each after four blanks.
std::string wrapped(const std::string& text) {
    std::string lines, line = "   ";
    for (const std::string& word : split(text, ' ')) {
        if (line.size() + 1 + word.size() > 84) lines += std::exchange(line, "   ") + '\n';
        line += ' ' + word;
    }
    return lines + line + '\n';
}

void print_choices(const LessonProgram& program, const std::vector<Choice>& choices) {
    std::cout
        << program.title
        << "\nWith commas between several words, it draws them all, and compares their errors "
           "and times.\n";
    for (const Choice& choice : choices)
        std::cout << '\n'
                  << choice.name << ' '
                  << (choice.words.empty() ? "NUMBER" : joined(choice.words, ",")) << "   ["
                  << choice.preset << "]\n"
                  << wrapped(choice.help);
}

}  // namespace

int run_lab(const std::function<LessonProgram()>& make, const std::string& reference, int argc,
            char** argv) {
    LessonProgram program = make();
    program.fills_triangles &= program.is_probed;
    return exit_status_of([&] {
        const std::vector<Choice> choices = choices_of(program);
        const Words given = normalized(Words(argv + 1, argv + argc), choices);
        if (given.empty()) {
            print_choices(program, choices);
            return 0;
        }
        try {
            const std::vector<Method> methods = methods_of(given, choices);
            return methods.size() == 1 ? run_lesson_program(program, argc, argv)
                                       : compare(make, reference, given, methods);
        } catch (const UsageError& error) {
            std::cerr << "error: " << error.what() << " (--help lists what there is)\n";
            return 2;
        }
    });
}

}  // namespace rasterbook
