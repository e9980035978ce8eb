// SPDX-License-Identifier: MIT
#include "common/model/statements.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <locale>
#include <sstream>
#include <utility>

#include "common/image/file.hpp"

namespace rasterbook {

namespace fs = std::filesystem;

StatementReader::StatementReader(const fs::path& file, LoadBudget& budget) : file_(file) {
    budget.charge_file(file);
    check_regular_file(file);
    in_.open(file, std::ios::binary);
    if (!in_) throw InputError(file, "cannot be opened");

    read_more();
    const std::string_view start = std::string_view(text_).substr(0, 2);
    const bool has_mark = start == "\xFF\xFE" || start == "\xFE\xFF";
    if (has_mark || (start.size() == 2 && (start[0] == '\0') != (start[1] == '\0')))
        fail("the text is UTF-16, not UTF-8");
    if (text_.starts_with("\xEF\xBB\xBF")) begin_ = 3;
}

bool StatementReader::next(Statement& statement) {
    while (begin_ < text_.size() || read_more()) {
        if (begin_ > part_size_) text_.erase(0, std::exchange(begin_, 0));
        statement = next_logical_line();
        statement.keyword = next_word(statement.arguments);
        statement.with_comment.remove_prefix(
            std::size_t(statement.arguments.data() - statement.with_comment.data()));
        statement.arguments = trimmed(statement.arguments);
        if (!statement.keyword.empty()) return true;
    }
    return false;
}

/// All of a statement as its arguments.
Statement StatementReader::next_logical_line() {
    line_ = next_line_;
    for (std::size_t begin = begin_;;) {
        const std::size_t line_end = find_line_end(begin);
        const std::size_t end = find_comment(begin, line_end);
        const bool goes_on = end > begin && text_[end - 1] == '\\';
        const std::size_t next = find_next_line(line_end);
        ++next_line_;
        if (!goes_on) {
            const std::size_t first = std::exchange(begin_, next);
            const std::string_view text = text_;
            return {{}, text.substr(first, end - first), text.substr(first, line_end - first)};
        }
        std::fill_n(&text_[end - 1], next - (end - 1), ' ');
        begin = next;
    }
}

std::size_t StatementReader::find_line_end(std::size_t begin) {
    // The '\0' behind the text ends the loop, as any control character does.
    const auto is_text = [](char c) { return static_cast<unsigned char>(c) >= ' ' || c == '\t'; };
    std::size_t end = begin;
    do {
        for (const char* text = text_.data(); is_text(text[end]);) ++end;
    } while (end == text_.size() && read_more());
    if (end == text_.size() || text_[end] == '\n' || text_[end] == '\r') return end;
    line_ = next_line_;
    fail("not text: control character " + std::to_string(int(text_[end])));
}

/// A comment begins with a '#' at the beginning of a word: there is none in "1.#IND".
std::size_t StatementReader::find_comment(std::size_t begin, std::size_t end) const {
    const std::string_view line = std::string_view(text_).substr(begin, end - begin);
    std::size_t at = line.find('#');
    while (at != line.npos && at > 0 && !is_blank(line[at - 1])) at = line.find('#', at + 1);
    return begin + std::min(at, line.size());
}

/// Lines end with "\n", "\r\n" or "\r".
std::size_t StatementReader::find_next_line(std::size_t line_end) {
    if (line_end == text_.size()) return line_end;
    if (text_[line_end] == '\n') return line_end + 1;
    const bool has_next = line_end + 1 < text_.size() || read_more();
    return line_end + (has_next && text_[line_end + 1] == '\n' ? 2 : 1);
}

bool StatementReader::read_more() {
    const std::size_t size = text_.size();
    text_.resize(size + part_size_);
    in_.read(&text_[size], part_size_);
    text_.resize(size + std::size_t(in_.gcount()));
    if (in_.bad()) throw InputError(file_, "cannot be read");
    return text_.size() > size;
}

namespace {

/// A number that from_chars finds out of range: infinite, or rounded when it is too small.
double read_extreme_number(std::string_view word) {
    std::istringstream stream{std::string(word)};
    stream.imbue(std::locale::classic());
    double number = 0;
    return stream >> number ? number : std::numeric_limits<double>::infinity();
}

/// Numbers as most files have them, "-12.3456": at most 15 digits, no exponent. The digits as a
/// whole number and the power of ten are both exact in double, so their quotient is rounded only
/// once. False for all others.
bool parse_short_decimal(std::string_view word, double& number) {
    constexpr std::array powers_of_ten{1.0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                       1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
    const bool is_negative = word.starts_with('-');
    if (is_negative) word.remove_prefix(1);
    std::int64_t digits = 0;
    std::size_t count = 0, point = word.size();
    for (std::size_t i = 0; i < word.size(); ++i) {
        const unsigned digit = static_cast<unsigned char>(word[i]) - unsigned{'0'};
        if (digit < 10 && count < powers_of_ten.size() - 1)
            digits = 10 * digits + digit, ++count;
        else if (word[i] == '.' && point == word.size())
            point = i;
        else
            return false;
    }
    if (count == 0) return false;
    const std::size_t decimals = point == word.size() ? 0 : word.size() - point - 1;
    const double size = static_cast<double>(digits) / powers_of_ten[decimals];
    number = is_negative ? -size : size;
    return true;
}

/// Whether a number may lie halfway between two floats: then it has no digits beyond the one behind
/// a float's last.
bool may_be_halfway(double number) {
    constexpr std::uint64_t beyond = (std::uint64_t{1} << 28) - 1;
    return (std::bit_cast<std::uint64_t>(number) & beyond) == 0 &&
           number != static_cast<float>(number);
}

}  // namespace

double read_number(const StatementReader& in, std::string_view word) {
    double number = 0;
    if (!parse_short_decimal(word, number)) {
        const std::errc error = parse(word, number);
        if (error == std::errc::invalid_argument) in.fail(in_quotes(word) + " is not a number");
        if (error == std::errc::result_out_of_range) number = read_extreme_number(word);
        if (!std::isfinite(static_cast<float>(number)))
            in.fail(in_quotes(word) + " is not a finite number");
    }
    // Rounded to double, then to float, a number just off halfway might go to the wrong float.
    if (float once = 0; may_be_halfway(number) && parse(word, once) == std::errc{})
        if (once != static_cast<float>(number)) number = std::nextafter(number, double{once});
    return number;
}

}  // namespace rasterbook
