// SPDX-License-Identifier: MIT
/// @file
/// The statements that OBJ and MTL files consist of: lines of words and numbers.
#pragma once

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "common/image/input_error.hpp"
#include "common/math/types.hpp"
#include "common/model/load_budget.hpp"

namespace rasterbook {

inline bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// Takes the first word off the text; "" at its end.
inline std::string_view next_word(std::string_view& text) {
    std::size_t begin = 0;
    while (begin < text.size() && is_blank(text[begin])) ++begin;
    std::size_t end = begin;
    while (end < text.size() && !is_blank(text[end])) ++end;
    const std::string_view word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word;
}

inline std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

/// A name without blanks and quotes around it.
inline std::string_view bare_name(std::string_view text) {
    text = trimmed(text);
    const bool has_quotes = text.size() >= 2 && text.front() == '"' && text.back() == '"';
    return has_quotes ? text.substr(1, text.size() - 2) : text;
}

/// A word as messages show it.
inline std::string in_quotes(std::string_view word) {
    constexpr std::size_t longest = 60;
    const char* end = word.size() > longest ? "...\"" : "\"";
    return '"' + std::string(word.substr(0, longest)) + end;
}

/// The file that another file names: relative to that file's folder, perhaps with backslashes.
inline std::filesystem::path path_beside(const std::filesystem::path& file, std::string_view name) {
    std::string path(name);
    std::replace(path.begin(), path.end(), '\\', '/');
    return file.parent_path() / path;
}

/// One statement of OBJ or MTL, as "v 1 2 3": its continuation lines joined.
struct Statement {
    std::string_view keyword, arguments;  ///< Without a comment.
    std::string_view with_comment;        ///< The arguments and all behind: `Paint #1` is a name.
};

/// Reads statements and keeps no more of the file in memory than the longest of them.
class StatementReader {
  public:
    /// @param budget  Is charged with the file's bytes.
    /// @throws InputError  When the file is missing, not regular, too long, unreadable or UTF-16.
    StatementReader(const std::filesystem::path& file, LoadBudget& budget);

    /// Goes on to the next statement, whose views last until the one after; false at the end.
    bool next(Statement& statement);

    const std::filesystem::path& file() const { return file_; }
    std::size_t line() const { return line_; }  ///< Where the statement begins.
    [[noreturn]] void fail(const std::string& what) const { throw InputError(file_, line_, what); }

  private:
    bool read_more();
    std::size_t find_line_end(std::size_t begin);
    std::size_t find_comment(std::size_t begin, std::size_t end) const;
    std::size_t find_next_line(std::size_t line_end);
    Statement next_logical_line();

    static constexpr std::size_t part_size_ = 1 << 16;
    std::filesystem::path file_;
    std::ifstream in_;
    std::string text_;           ///< The part of the file at hand.
    std::size_t begin_ = 0;      ///< Of the next line, in text_.
    std::size_t line_ = 1;       ///< Of the current statement, in the file.
    std::size_t next_line_ = 1;  ///< Of begin_, in the file.
};

/// Parses all of the word. from_chars knows no '+'.
template <typename Number>
std::errc parse(std::string_view word, Number& number) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    const char* word_end = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), word_end, number);
    return end == word_end ? error : std::errc::invalid_argument;
}

/// @return  The double next to the word's number; or the one beside it, where only that rounds to
/// the
///          float next to the word's number. As a float it is therefore always the nearest.
/// @throws InputError  Unless the word is a number that is finite as a float.
double read_number(const StatementReader& in, std::string_view word);

/// The first `count` numbers of a statement, 0 where those after `needed` are missing. Up to `most`
/// have to be numbers; what follows is not looked at.
///
/// @param rest  Takes what follows.
template <int count, typename Number = float>
glm::vec<count, Number> read_vector(const StatementReader& in, const Statement& statement,
                                    int needed = count, int most = count,
                                    std::string_view* rest = nullptr) {
    glm::vec<count, Number> vector(Number(0));
    std::string_view words = statement.arguments;
    for (int i = 0; i < most; ++i) {
        const std::string_view word = next_word(words);
        if (word.empty() && i >= needed) break;
        if (word.empty())
            in.fail(std::string(statement.keyword) + " needs " + std::to_string(needed) +
                    " numbers and has " + std::to_string(i));
        const double number = read_number(in, word);
        if (i < count) vector[i] = static_cast<Number>(number);
    }
    if (rest) *rest = words;
    return vector;
}

}  // namespace rasterbook
