// SPDX-License-Identifier: MIT
// The pages that belong to no lesson agree with the lessons, too.
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "support/texts.hpp"

namespace fs = std::filesystem;
using namespace rasterbook::test;

// What ./tests/run --mine NN --step K goes by: "step: EQUATIONS | OPTIONS | PICTURES | TITLE".
TEST(Drift, EachEquationAndPictureBelongsToOneStepOfItsLesson) {
    for (const std::string& name : lessons()) {
        std::multiset<std::string> equations, pictures;
        for (const std::string& part : parts_after(readme_of(name), "\nstep: ")) {
            const std::string step = part.substr(0, part.find('\n'));
            std::istringstream fields(step);
            std::string numbers, options, of_step, title, word;
            std::getline(fields, numbers, '|') && std::getline(fields, options, '|') &&
                std::getline(fields, of_step, '|') && std::getline(fields, title, '|');
            EXPECT_GT(title.size(), 5u) << name << ": " << step;
            for (std::istringstream words(of_step); words >> word;)
                if (word != "-") pictures.insert(word);
            for (std::istringstream words(numbers); words >> word;) {  // 5.7, or 5.1-5.3
                const std::string last = word.substr(word.find('-') + 1);
                const std::string chapter = word.substr(0, word.find('.'));
                for (int i = std::stoi(word.substr(word.find('.') + 1));
                     i <= std::stoi(last.substr(last.find('.') + 1)); ++i)
                    equations.insert(chapter + '_' + std::to_string(i));
            }
        }
        std::set<std::string> tested, drawn;
        for (const std::string& test : all_between(tests_of(name), "TEST(", ")")) {
            const std::string test_name = test.substr(test.find(' ') + 1);
            if (test_name.starts_with("PictureOf")) drawn.insert(test_name);
            if (test_name.starts_with("Eq"))
                tested.insert(
                    test_name.substr(2, test_name.find('_', test_name.find('_') + 1) - 2));
        }
        EXPECT_GT(tested.size(), 0u) << name;
        for (std::string equation : tested) {
            const std::size_t of_steps = equations.count(equation);
            std::ranges::replace(equation, '_', '.');
            const bool is_beside =
                pages_beside(name).find("\\tag{" + equation + "}") != std::string::npos;
            EXPECT_EQ(of_steps, is_beside ? 0u : 1u) << name << ", Eq. " << equation;
        }
        for (const std::string& picture : drawn)
            EXPECT_EQ(pictures.count(picture), 1u) << name << ", " << picture;
        for (const std::string& picture : pictures)
            EXPECT_TRUE(drawn.contains(picture)) << name << ", " << picture;
    }
}

TEST(Drift, TheStripHasAPanelForEachLessonThatAsksForOne) {
    constexpr std::size_t panel = 168, gap = 6;  // px, as docs/pictures.py has them
    std::size_t panels = 0;
    for (const std::string& name : lessons())
        panels += readme_of(name).find("\nstrip:") != std::string::npos;
    const std::string png = read_text(root / "docs/strip.png");
    ASSERT_GT(png.size(), 24u);
    std::size_t width = 0;
    for (std::size_t i = 16; i < 20; ++i) width = 256 * width + static_cast<unsigned char>(png[i]);
    EXPECT_EQ(width + gap, panels * (panel + gap)) << "./tests/run --pictures draws it";
    EXPECT_GE(panels, 9u);
}

TEST(Drift, FiguresOfTheFrontPageAreThoseMeasured) {
    int figures = 0;
    for (const std::string& row : parts_after(read_text(root / "README.md"), "\n| [")) {
        const std::vector<std::string> cells = parts_after(row.substr(0, row.find('\n')), " | ");
        ASSERT_EQ(cells.size(), 3u) << row;
        const std::string& cost = cells[1];
        const auto begin = cost.find("](") + 2, end = cost.find(')', begin);
        const std::string measured = read_text(root / cost.substr(begin, end - begin));
        for (const std::string& figure : numbers_in(cost.substr(end))) {
            ++figures;
            EXPECT_TRUE(has_word(measured, figure)) << row << ": " << figure;
        }
    }
    EXPECT_GT(figures, 20);
}

TEST(Drift, TheGlossaryNamesWhatIsInTheCode) {
    const std::string code = all_code();
    const std::set<std::string> equations = numbered_equations();
    std::set<std::string> terms;
    std::string last;
    int names = 0;
    const auto rows = parts_after(read_text(root / "docs/glossary.md"), "\n- **");
    for (const std::string& row : rows) {
        std::string term = row.substr(0, row.find("**"));
        std::transform(term.begin(), term.end(), term.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        EXPECT_LT(last, term) << "the terms are in the order of the alphabet";
        terms.insert(last = term);
        const auto open = row.find(" (["), end = row.find("; OpenGL: ", std::min(open, row.size()));
        if (open == row.npos) {
            EXPECT_NE(row.find("See *"), row.npos) << term << " has no lesson";
            continue;
        }
        const std::string here = row.substr(open, std::min(end, row.find('\n')) - open);
        for (std::string name : all_between(here, "`", "`")) {
            if (name.find_first_not_of(", ") == name.npos) continue;  // between two names
            if (name.starts_with("--")) name = name.substr(0, name.find(' '));
            for (const std::string& part : parts_after("::" + name, "::")) {
                ++names;
                EXPECT_TRUE(has_word(code, part)) << term << ": " << part;
            }
        }
        for (const std::string& number : cited_equations(here)) {
            EXPECT_TRUE(equations.contains(number)) << term << ": " << number;
            const std::string lesson = '0' + number.substr(0, number.find('.'));
            EXPECT_NE(here.find('[' + lesson.substr(lesson.size() - 2) + ']'), here.npos)
                << term << ": " << number << " is not of a lesson that is named";
        }
    }
    for (const std::string& row : rows)
        for (const std::string& term : all_between(row, "See *", "*"))
            EXPECT_TRUE(terms.contains(term)) << term;
    EXPECT_GT(terms.size(), 100u);
    EXPECT_GT(names, 100);
}

TEST(Drift, WrongPicturesAreOfLinesInTheCode) {  // docs/pictures.py draws them from the same text
    constexpr std::uintmax_t max_bytes = 100 * 1024;
    const fs::path docs = root / "docs";
    const std::set<std::string> equations = numbered_equations();
    int mistakes = 0;
    const std::string page = read_text(docs / "troubleshooting.md");
    const std::string gallery = page.substr(0, page.find("\n## "));
    for (const std::string& section : parts_after(page, "\n## ")) {
        const std::string title = section.substr(0, section.find('\n'));
        if (title == "Why this pixel?") continue;
        ++mistakes;
        EXPECT_NE(gallery.find("](#" + anchor_of(title) + ')'), gallery.npos) << title;
        const auto fence = section.find("```diff\n");
        ASSERT_NE(fence, section.npos) << title;
        std::string right, wrong;
        std::istringstream diff(section.substr(fence + 8));
        for (std::string line; std::getline(diff, line) && !line.starts_with("```");) {
            ASSERT_TRUE(line.starts_with('+') || line.starts_with('-')) << title << ": " << line;
            (line[0] == '+' ? right : wrong) += without_indentation(line.substr(1)) + '\n';
        }
        const auto links = all_between(section.substr(0, fence), "](../", "pp)");
        ASSERT_FALSE(links.empty()) << title;
        const std::string code = without_indentation(read_text(root / (links.back() + "pp")));
        EXPECT_FALSE(right.empty()) << title;
        EXPECT_EQ(parts_after(code, '\n' + right).size(), 1u) << title << ": " << right;
        if (!wrong.empty()) { EXPECT_EQ(code.find('\n' + wrong), code.npos) << title; }

        const auto pictures = all_between(section, "](troubleshooting/", ")");
        ASSERT_EQ(pictures.size(), 2u) << title;
        EXPECT_NE(gallery.find("troubleshooting/" + pictures[1]), gallery.npos) << title;
        for (const std::string& picture : pictures) {
            const fs::path file = docs / "troubleshooting" / picture;
            ASSERT_TRUE(fs::exists(file)) << file;
            EXPECT_LT(fs::file_size(file), max_bytes) << file;
        }
        for (const std::string& number : cited_equations(section))
            EXPECT_TRUE(equations.contains(number)) << title << ": " << number;
    }
    EXPECT_GT(mistakes, 20);
}

// Markdown takes a backslash away from "\," and "\\", and the formula is another one; not between
// $` and `$, or in a block of ```math.
TEST(Drift, MarkdownLeavesFormulasAsTheyAre) {
    int formulas = 0;
    for (const fs::path& file : files_with({".md"})) {
        std::istringstream text(without_code(read_text(file)));
        for (std::string line; std::getline(text, line);) {
            bool in_code = false;
            for (std::size_t i = 0; i + 1 < line.size(); ++i) {
                if (line[i] == '`') in_code = !in_code;
                if (in_code) continue;
                formulas += line[i] == '$';
                EXPECT_FALSE(line[i] == '$' && line[i + 1] == '$') << file << ": " << line;
                EXPECT_FALSE(line[i] == '\\' &&
                             std::ispunct(static_cast<unsigned char>(line[i + 1])))
                    << file << ": " << line.substr(i);
            }
        }
    }
    EXPECT_GT(formulas, 1000);
}
