// SPDX-License-Identifier: MIT
/// @file
/// The one exception for bad input: it names the file, the line and what is wrong.
#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace rasterbook {

/// Thrown for input that cannot be read; what() is "FILE:LINE: what is wrong" or "FILE: what is
/// wrong".
class InputError : public std::runtime_error {
  public:
    InputError(const std::filesystem::path& file, const std::string& what)
        : std::runtime_error(file.string() + ": " + what) {}

    /// @param line  Counted from 1; 0: none in particular.
    InputError(const std::filesystem::path& file, std::size_t line, const std::string& what)
        : std::runtime_error(line > 0 ? file.string() + ":" + std::to_string(line) + ": " + what
                                      : file.string() + ": " + what) {}
};

}  // namespace rasterbook
