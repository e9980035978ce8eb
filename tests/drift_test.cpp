// SPDX-License-Identifier: MIT
// Texts, code and tests belong together; these tests notice when one of them moves on alone.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/texts.hpp"

namespace fs = std::filesystem;
using namespace rasterbook::test;

TEST(Drift, EveryLessonHasAllItsParts) {
    ASSERT_GE(lessons().size(), 3u);
    for (const std::string& name : lessons()) {
        const fs::path lesson = root / "lessons" / name;
        for (const fs::path& part :
             {lesson / "README.md", lesson / "main.cpp", root / "docs/derivations" / (name + ".md"),
              root / "docs/accuracy" / (name + ".md"), root / "tests/accuracy" / (name + ".cpp"),
              root / "tests" / (name + "_test.cpp"), root / "tests/golden" / (name + ".png")})
            EXPECT_TRUE(fs::exists(part)) << part;
        EXPECT_TRUE(fs::is_directory(lesson / "starter") && !fs::is_empty(lesson / "starter"))
            << name << " has no starter";
        if (!fs::is_directory(lesson / "starter")) continue;
        for (const auto& starter : fs::directory_iterator(lesson / "starter"))
            EXPECT_TRUE(fs::exists(lesson / starter.path().filename())) << starter.path();
        const std::string readme = readme_of(name), front = read_text(root / "README.md");
        EXPECT_EQ(readme.rfind("# Lesson " + name.substr(0, 2) + ": ", 0), 0u) << name;
        for (const char* part : {"\n> ", "\n## What goes wrong", "\n## What accuracy costs",
                                 "\n## Write it yourself", "\n## Your turn"})
            EXPECT_NE(readme.find(part), std::string::npos) << name << ": " << part;
        EXPECT_NE(front.find("lessons/" + name + "/README.md"), std::string::npos) << name;
    }
}

TEST(Drift, StartersHaveTheFunctionsOfTheirHeaders) {
    // Of the file or of a class, on one line: what the course's other files call must be there.
    const std::regex function(
        "(?: {4})?(?:[\\w:<>,*&]+ )*[\\w:<>,*&]+[ *&]+(\\w+)\\([^;={]*\\)(?: const)? \\{.*");
    std::size_t count = 0;
    for (const std::string& name : lessons())
        for (const auto& starter : fs::directory_iterator(root / "lessons" / name / "starter")) {
            const fs::path header = root / "lessons" / name / starter.path().filename();
            const std::string text = read_text(starter.path());
            std::istringstream lines(read_text(header));
            std::smatch found;
            for (std::string line; std::getline(lines, line);) {
                if (!std::regex_match(line, found, function)) continue;
                ++count;
                EXPECT_NE(text.find(found.str(1) + '('), text.npos)
                    << starter.path() << " has no " << found[1] << "()";
            }
        }
    EXPECT_GT(count, 100u);
}

TEST(Drift, NoLessonIncludesALaterOneAndNothingInCommonALesson) {
    int includes = 0;
    for (const char* folder : {"common", "lessons"})
        for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
            if (!entry.is_regular_file() || entry.path().extension() == ".md") continue;
            const std::string owner =
                fs::relative(entry.path(), root / "lessons").begin()->string();
            for (const std::string& header :
                 all_between(read_text(entry.path()), "#include \"", "\"")) {
                if (header.starts_with("common/")) continue;
                ++includes;
                EXPECT_TRUE(owner != ".." && header.substr(0, header.find('/')) <= owner)
                    << entry.path() << ": " << header;
            }
        }
    EXPECT_GT(includes, 5);
}

TEST(Drift, ALessonBuildsOnAnEarlierOne) {  // what ./lessons/run --diff compares it with
    const std::vector<std::string> names = lessons();
    int marks = 0;
    for (const std::string& name : names)
        for (const std::string& part : parts_after(readme_of(name), "\nbuilds on: ")) {
            ++marks;
            const std::string before = part.substr(0, part.find('\n'));
            EXPECT_TRUE(std::ranges::count(names, before) == 1 && before < name)
                << name << " builds on " << before;
        }
    EXPECT_GT(marks, 0);
}

TEST(Drift, EveryNumberedEquationIsCitedInCodeAndInATest) {
    std::set<std::string> numbered, in_tests;
    for (const std::string& name : lessons())
        for (const std::string& number :
             all_between(derivation_of(name) + pages_beside(name), "\\tag{", "}"))
            EXPECT_TRUE(numbered.insert(number).second) << number << " is there twice";
    for (const auto& entry : fs::directory_iterator(root / "tests"))
        if (entry.path().extension() == ".cpp" && entry.path().filename() != "drift_test.cpp")
            for (std::string number : all_between(read_text(entry.path()), ", Eq", ")")) {
                if (!std::isdigit(static_cast<unsigned char>(number[0]))) continue;
                number = number.substr(0, number.find('_', number.find('_') + 1));
                std::replace(number.begin(), number.end(), '_', '.');
                in_tests.insert(number);
            }
    for (const std::string& name : lessons()) {
        const std::string test = tests_of(name);
        const auto count = [&](const std::string& piece) {
            return parts_after(test, piece).size();
        };
        EXPECT_GT(count("\nTEST("), 5u);
        EXPECT_EQ(count("\nTEST("), count(", Eq" + std::to_string(std::stoi(name)) + "_") +
                                        count(", PictureOf") + count("    look_up("))
            << name << ": each test names an equation or says where to read";
        for (const std::string& place : all_between(test, "look_up(", ";"))
            for (const std::string& number : cited_equations(place))
                EXPECT_TRUE(numbered.contains(number)) << name << ": " << place;
    }
    EXPECT_EQ(cited_equations(all_code()), numbered);
    EXPECT_EQ(in_tests, numbered);
    EXPECT_GT(numbered.size(), 15u);
}

TEST(Drift, CodeInTextsIsQuotedFromCompiledFiles) {
    int quotes = 0;
    for (const std::string& name : lessons()) {
        std::string code;
        for (const auto& entry : fs::directory_iterator(root / "lessons" / name))
            if (entry.path().extension() == ".hpp" || entry.path().extension() == ".cpp")
                code += without_indentation(read_text(entry.path()));
        for (const std::string& text : {readme_of(name), derivation_of(name)})
            for (const std::string& part : parts_after(text, "```cpp\n")) {
                const std::string quote = part.substr(0, part.find("```"));
                ++quotes;
                EXPECT_NE(code.find(without_indentation(quote)), std::string::npos)
                    << "a text of " << name << " quotes what is not there:\n"
                    << quote;
            }
    }
    EXPECT_GT(quotes, 5);
}

TEST(Drift, LinksAndPicturesInTextsLeadSomewhere) {
    int links = 0;
    for (const fs::path& file : files_with({".md"})) {
        const std::string text = read_text(file);
        std::set<std::string> anchors;
        for (const std::string& part : parts_after(text, "\n## "))
            anchors.insert('#' + anchor_of(part.substr(0, part.find('\n'))));
        for (const std::string& link : all_between(without_code(text), "](", ")")) {
            if (link.starts_with("http")) continue;
            ++links;
            EXPECT_TRUE(fs::exists(file.parent_path() / link.substr(0, link.find('#'))) &&
                        (link[0] != '#' || anchors.contains(link)))
                << file << ": " << link;
        }
    }
    EXPECT_GT(links, 30);
}

TEST(Drift, PicturesInReadmesAreGoldenOnesThatATestDraws) {
    std::string tests;
    for (const std::string& name : lessons()) tests += tests_of(name);
    int pictures = 0;
    for (const std::string& name : lessons())
        for (const std::string& picture : all_between(readme_of(name), "](", ".png)")) {
            ++pictures;
            if (picture.starts_with("../../docs/answers/"))
                continue;  // docs/pictures.py draws them
            EXPECT_EQ(picture.rfind("../../tests/golden/" + name, 0), 0u)
                << name << ": " << picture;
            EXPECT_NE(tests.find('"' + fs::path(picture).filename().string() + '"'),
                      std::string::npos)
                << picture;
        }
    EXPECT_GE(pictures, 5);
}
