// SPDX-License-Identifier: MIT
/// @file
/// The course's texts, and what to look for in them.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "support/lesson_process.hpp"

namespace rasterbook::test {

inline const std::filesystem::path root = std::filesystem::path(RASTERBOOK_ASSETS).parent_path();

/// The course's files with one of the endings; not what is built, and not the reader's own.
inline std::vector<std::filesystem::path> files_with(const std::set<std::string>& endings) {
    std::vector<std::filesystem::path> files;
    for (const char* folder : {"", "assets", "common", "docs", "lessons", "tests"}) {
        const auto add = [&](const std::filesystem::directory_entry& entry) {
            if (entry.is_regular_file() && endings.contains(entry.path().extension().string()))
                files.push_back(entry.path());
        };
        if (*folder == '\0')
            for (const auto& entry : std::filesystem::directory_iterator(root)) add(entry);
        else
            for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder))
                add(entry);
    }
    return files;
}

/// "01_bresenham_lines" and so on, in order.
inline std::vector<std::string> lessons() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(root / "lessons"))
        if (entry.is_directory() && entry.path().filename() != "lab")
            names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

inline std::string readme_of(const std::string& lesson) {
    return read_text(root / "lessons" / lesson / "README.md");
}

inline std::string derivation_of(const std::string& lesson) {
    return read_text(root / "docs/derivations" / (lesson + ".md"));
}

/// The pages in a lesson's folder that are not on the way: all but README.md.
inline std::string pages_beside(const std::string& lesson) {
    std::string pages;
    for (const auto& entry : std::filesystem::directory_iterator(root / "lessons" / lesson))
        if (entry.path().extension() == ".md" && entry.path().filename() != "README.md")
            pages += read_text(entry.path());
    return pages;
}

/// A lesson's tests: of 04_mvp, those in 04_mvp_test.cpp and in 04_mvp_clip_test.cpp.
inline std::string tests_of(const std::string& lesson) {
    std::string tests;
    for (const auto& entry : std::filesystem::directory_iterator(root / "tests"))
        if (entry.is_regular_file() && entry.path().filename().string().starts_with(lesson + '_'))
            tests += read_text(entry.path());
    return tests;
}

/// What stands between `before` and `after`, wherever it does on one line.
inline std::vector<std::string> all_between(const std::string& text, const std::string& before,
                                            const std::string& after) {
    std::vector<std::string> found;
    for (auto at = text.find(before); at != text.npos; at = text.find(before, at)) {
        at += before.size();
        const auto end = text.find(after, at), line_end = text.find('\n', at);
        if (end < line_end) found.push_back(text.substr(at, end - at));
    }
    return found;
}

/// A text without its blocks of code.
inline std::string without_code(std::string text) {
    const std::string fence = "\n```";
    for (auto begin = text.find(fence); begin != text.npos; begin = text.find(fence, begin)) {
        const auto end = text.find(fence, begin + fence.size());
        text.erase(begin, end == text.npos ? end : end + fence.size() - begin);
    }
    return text;
}

/// A text whose lines all begin at the margin.
inline std::string without_indentation(const std::string& text) {
    std::string flat;
    for (const char c : text)
        if (c != ' ' || (!flat.empty() && flat.back() != '\n')) flat += c;
    return flat;
}

/// The numbers in "Eq. 1.4", "Eq. 1.3, 1.4" or "Eq. 2.1 and 2.2".
inline std::set<std::string> cited_equations(const std::string& text) {
    std::set<std::string> numbers;
    for (auto at = text.find("Eq. "); at != text.npos; at = text.find("Eq. ", at)) {
        at += 4;
        for (;;) {
            const auto end = std::min(text.find_first_not_of("0123456789.", at), text.size());
            std::string number = text.substr(at, end - at);
            if (number.ends_with('.')) number.pop_back();
            if (number.find('.') == number.npos) break;
            numbers.insert(number);
            at = end;
            if (text.compare(at, 2, ", ") == 0)
                at += 2;
            else if (text.compare(at, 5, " and ") == 0)
                at += 5;
            else
                break;
        }
    }
    return numbers;
}

/// The parts of a text between marks, without what stands before the first mark.
inline std::vector<std::string> parts_after(const std::string& text, const std::string& mark) {
    std::vector<std::string> parts;
    for (auto at = text.find(mark); at != text.npos;) {
        at += mark.size();
        const auto next = text.find(mark, at);
        parts.push_back(text.substr(at, next == text.npos ? next : next - at));
        at = next;
    }
    return parts;
}

/// Whether a text has `word`, and not just as a part of a longer word or number.
inline bool has_word(const std::string& text, const std::string& word) {
    const auto continues = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    };
    for (auto at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
        const auto end = at + word.size();
        const bool begins =
            at == 0 || !(continues(text[at - 1]) || text[at - 1] == '.' || text[at - 1] == ',');
        const bool ends = end == text.size() || !continues(text[end]);
        const bool is_longer_number = end + 1 < text.size() &&
                                      (text[end] == '.' || text[end] == ',') &&
                                      std::isdigit(static_cast<unsigned char>(text[end + 1]));
        if (begins && ends && !is_longer_number) return true;
    }
    return false;
}

/// The numbers in a text, such as 1.09 or 2,050.
inline std::set<std::string> numbers_in(const std::string& text) {
    std::set<std::string> numbers;
    for (auto at = text.find_first_of("0123456789"); at != text.npos;
         at = text.find_first_of("0123456789", at)) {
        auto end = std::min(text.find_first_not_of("0123456789.,", at), text.size());
        std::string number = text.substr(at, end - at);
        while (number.back() == '.' || number.back() == ',') number.pop_back();
        numbers.insert(number);
        at = end;
    }
    return numbers;
}

/// The code of common/ and of all lessons, without the starters.
inline std::string all_code() {
    std::string code;
    for (const char* folder : {"common", "lessons"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder))
            if ((entry.path().extension() == ".hpp" || entry.path().extension() == ".cpp") &&
                entry.path().parent_path().filename() != "starter")
                code += read_text(entry.path());
    return code;
}

/// The equations that derivations number.
inline std::set<std::string> numbered_equations() {
    std::set<std::string> numbers;
    for (const std::string& name : lessons())
        for (const std::string& number :
             all_between(derivation_of(name) + pages_beside(name), "\\tag{", "}"))
            numbers.insert(number);
    return numbers;
}

/// The name by which GitHub, and our site, find a heading.
inline std::string anchor_of(const std::string& heading) {
    std::string name;
    for (const char c : heading)
        if (c == ' ')
            name += '-';
        else if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_')
            name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return name;
}

}  // namespace rasterbook::test
