// SPDX-License-Identifier: MIT
// What a lesson's texts have to be like: a short core first, the field's terms, an answer to each
// exercise.
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/texts.hpp"

namespace fs = std::filesystem;
using namespace rasterbook::test;

namespace {

/// A text without all that stands between two marks, and without the marks.
std::string without(std::string text, const std::string& begin, const std::string& end) {
    for (auto at = text.find(begin); at != text.npos; at = text.find(begin, at)) {
        const auto last = text.find(end, at + begin.size());
        text.erase(at, last == text.npos ? last : last + end.size() - at);
    }
    return text;
}

/// What is read word by word: no comments, code, formulas, tables, pictures or addresses.
std::string prose_of(const std::string& text) {
    std::string prose;
    std::istringstream lines(without(without_code(text), "<!--", "-->"));
    for (std::string line; std::getline(lines, line);)
        if (!line.starts_with('|') && !line.starts_with("![")) prose += line + '\n';
    prose = without(without(prose, "$`", "`$"), "$", "$");
    prose = without(without(prose, "`", "`"), "](", ")");
    return prose;
}

std::size_t count_words(const std::string& text) {
    std::istringstream words(prose_of(text));
    std::size_t count = 0;
    for (std::string word; words >> word;)
        count += std::ranges::any_of(
            word, [](char c) { return std::isalpha(static_cast<unsigned char>(c)); });
    return count;
}

std::vector<std::string> headings_of(const std::string& text) {
    std::vector<std::string> headings;
    for (const std::string& part : parts_after(text, "\n## "))
        headings.push_back(part.substr(0, part.find('\n')));
    return headings;
}

/// The part of a derivation that a learner needs who wants a renderer that works.
std::string core_of(const std::string& lesson) {
    const std::string text = derivation_of(lesson);
    return text.substr(0, text.find("\n## Robust\n"));
}

/// The texts that are read; a file's name and what it says.
std::map<std::string, std::string> texts() {
    std::map<std::string, std::string> found;
    for (const fs::path& file : files_with({".md"}))
        found[fs::relative(file, root).string()] = read_text(file);
    return found;
}

}  // namespace

TEST(Drift, EachDerivationGoesFromItsCoreToTheHardCases) {
    const std::vector<std::string> last = {"Robust", "What accuracy costs",
                                           "In other books and APIs", "History and further reading",
                                           "Sources"};
    for (const std::string& name : lessons()) {
        const std::vector<std::string> headings = headings_of(derivation_of(name));
        ASSERT_GT(headings.size(), last.size()) << name;
        EXPECT_EQ(headings.front(), "Names") << name;
        EXPECT_TRUE(std::equal(last.rbegin(), last.rend(), headings.rbegin()))
            << name << " ends with " << testing::PrintToString(headings);
        const std::size_t steps = parts_after(readme_of(name), "\nstep: ").size();
        for (std::size_t k = 1; k <= steps; ++k)
            EXPECT_TRUE(k < headings.size() &&
                        headings[k].starts_with("Step " + std::to_string(k) + ": "))
                << name << ", step " << k << " of " << steps;
    }
}

TEST(Drift, ACoreIsShortAndFullOfPictures) {
    constexpr std::size_t of_the_first_three = 1200, of_the_others = 1800, without_a_picture = 500;
    for (const std::string& name : lessons()) {
        const std::string core = core_of(name);
        EXPECT_LE(count_words(core), name < "04" ? of_the_first_three : of_the_others) << name;
        for (const std::string& part : parts_after("\n![" + core, "\n![")) {
            const std::string text = part.substr(std::min(part.find('\n'), part.size()));
            EXPECT_LE(count_words(text), without_a_picture)
                << name << ": no picture after" << text.substr(0, 200);
        }
    }
}

TEST(Drift, ALetterHasOneMeaningInALesson) {
    std::size_t letters = 0;
    for (const std::string& name : lessons()) {
        const std::string text = derivation_of(name);
        const auto begin = text.find("\n## Names\n");
        ASSERT_NE(begin, text.npos) << name;
        std::set<std::string> named;
        std::istringstream lines(text.substr(begin, text.find("\n## ", begin + 1) - begin));
        for (std::string line; std::getline(lines, line);) {
            if (!line.starts_with("| ")) continue;
            const std::string cell = line.substr(0, line.find(" | "));
            for (auto at = cell.find('$'); at != cell.npos;) {
                const auto end = std::min(cell.find('$', at + 1), cell.size());
                std::string letter = cell.substr(at + 1, end - at - 1);
                std::erase(letter, '`');
                ++letters;
                EXPECT_TRUE(named.insert(letter).second) << name << ": " << letter << " twice";
                at = cell.find('$', end + 1);
            }
        }
    }
    EXPECT_GT(letters, 60u);
}

TEST(Drift, TermsInBoldAreInTheGlossary) {
    const auto lower = [](std::string text) {
        for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        return text;
    };
    std::set<std::string> terms;
    for (const std::string& row : parts_after(read_text(root / "docs/glossary.md"), "\n- **"))
        terms.insert(lower(row.substr(0, row.find("**"))));
    std::size_t bold = 0;
    for (const auto& [file, text] : texts()) {
        if (!file.starts_with("lessons/") && !file.starts_with("docs/derivations/") &&
            !file.starts_with("docs/accuracy/"))
            continue;
        for (const std::string& words : all_between(' ' + without_code(text), "**", "**")) {
            if (words.find_first_of(".:?!", words.size() - 1) != words.npos) continue;
            if (words.front() == ' ' || words.back() == ' ') continue;  // between two of them
            ++bold;
            std::string term = lower(words);
            if (!terms.contains(term) && term.ends_with('s')) term.pop_back();  // of several
            EXPECT_TRUE(terms.contains(term)) << file << ": " << words;
        }
    }
    EXPECT_GT(bold, 100u);
}

TEST(Drift, TextsUseTheFieldsTerms) {
    const std::map<std::string, std::string> terms = {{"nearness", "1/w"},
                                                      {"lamp", "point light"},
                                                      {"lamps", "point lights"},
                                                      {"relief", "normal mapping"},
                                                      {"reliefs", "normal mapping"},
                                                      {"look-up", "shadow test, sample"},
                                                      {"look-ups", "shadow tests, samples"},
                                                      {"film", "image sequence, animation"},
                                                      {"films", "image sequences, animations"},
                                                      {"speckles", "z-fighting"},
                                                      {"throws a shadow", "casts a shadow"},
                                                      {"throw a shadow", "cast a shadow"},
                                                      {"throw shadows", "cast shadows"},
                                                      {"at last", "finally"},
                                                      {"nor is", "and ... not"}};
    for (const auto& [file, text] : texts()) {
        std::string prose = prose_of(text);
        for (char& c : prose) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        for (const auto& [word, term] : terms)
            EXPECT_FALSE(has_word(prose, word)) << file << ": " << word << ": say " << term;
    }
}

TEST(Drift, EachExerciseHasAnAnswerThatDraws) {
    for (const std::string& name : lessons()) {
        const std::string readme = readme_of(name);
        const std::string exercises = readme.substr(readme.find("\n## Your turn\n"));
        std::size_t k = 0;
        for (const std::string& exercise : parts_after(exercises, "\n**")) {
            if (!std::isdigit(static_cast<unsigned char>(exercise.front()))) continue;
            ++k;
            const std::string number = std::to_string(k);
            EXPECT_TRUE(exercise.starts_with(number + ".** ")) << name << ", exercise " << number;
            const auto answer = exercise.find("<details><summary>Answer " + number + "</summary>");
            ASSERT_NE(answer, exercise.npos) << name << ", exercise " << number;
            const std::string number_of_lesson = name.substr(0, 2);
            EXPECT_TRUE(
                exercise.find("./lessons/run " + number_of_lesson, answer) != exercise.npos ||
                exercise.find("./lessons/run lab " + number_of_lesson, answer) != exercise.npos)
                << name << ", answer " << number << " draws nothing";
        }
        EXPECT_GE(k, 4u) << name;
    }
}
