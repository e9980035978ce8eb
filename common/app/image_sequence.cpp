// SPDX-License-Identifier: MIT
#include "common/app/image_sequence.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>

namespace rasterbook {
namespace {

constexpr int max_frames = 9999;

/// A number of digits alone; none for anything else.
std::optional<int> whole_number(std::string_view digits) {
    unsigned short number = 0;  // has no sign, and room for max_frames
    const char* const end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, number);
    if (error != std::errc() || stop != end) return {};
    return number;
}

}  // namespace

Frames frames_from(const std::string& text) {
    const std::string quoted = "'" + text + "'";
    const std::invalid_argument is_no_number(quoted + " is not a number of frames from 1 to " +
                                             std::to_string(max_frames) +
                                             ", nor a part of them as in 0-29/90");
    const auto slash = text.find('/'), dash = text.find('-');
    const std::string_view all(text), part = all.substr(0, slash);
    if (slash == text.npos && dash == text.npos) {
        const auto count = whole_number(all);
        if (!count || *count < 1 || *count > max_frames) throw is_no_number;
        return {0, *count - 1, *count};
    }
    if (dash == text.npos || dash > part.size()) throw is_no_number;
    const auto first = whole_number(part.substr(0, dash));
    const auto last = whole_number(part.substr(dash + 1));
    if (!first || !last) throw is_no_number;
    if (slash == text.npos)
        throw std::invalid_argument(quoted + " does not say of how many frames, as in 0-29/90");
    const auto count = whole_number(all.substr(slash + 1));
    if (!count || *count < 1 || *count > max_frames) throw is_no_number;
    if (*last < *first) throw std::invalid_argument(quoted + " ends before it begins");
    if (*last >= *count)
        throw std::invalid_argument(quoted + " ends behind the last frame, which is " +
                                    std::to_string(*count - 1));
    return {*first, *last, *count};
}

std::filesystem::path name_of_frame(const std::filesystem::path& pattern, int frame) {
    const std::string name = pattern.string();
    const auto begin = name.find('%'), end = name.find_first_not_of("0123456789", begin + 1);
    if (begin == name.npos || end == name.npos || name[end] != 'd') return pattern;
    std::string number = std::to_string(frame);
    const std::size_t digits = std::strtoul(name.c_str() + begin + 1, nullptr, 10);
    if (number.size() < digits) number.insert(0, digits - number.size(), '0');
    return name.substr(0, begin) + number + name.substr(end + 1);
}

int frames_at_once(int threads, const Frames& frames, ivec2 size) {
    constexpr std::int64_t max_bytes = std::int64_t{1} << 30, bytes_a_sample = 40;
    const std::int64_t bytes = bytes_a_sample * size.x * size.y;
    const auto fitting = std::clamp<std::int64_t>(max_bytes / bytes, 1, max_frames);
    return std::min({threads, frames.count(), static_cast<int>(fitting)});
}

}  // namespace rasterbook
