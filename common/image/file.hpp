// SPDX-License-Identifier: MIT
/// @file
/// Whole files: read at once, written whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace rasterbook {

/// The ending of a file's name with its dot, in small letters; empty when there is none.
std::string ending_of(const std::filesystem::path& file);

/// To be asked before a file is opened: to open a FIFO would wait for its writer.
///
/// @throws InputError  When the file is missing or is a directory, FIFO or device.
void check_regular_file(const std::filesystem::path& file);

/// Reads a file at once.
///
/// @throws InputError  When the file is missing, not regular, longer than max_bytes or unreadable.
std::vector<std::uint8_t> read_whole_file(const std::filesystem::path& file,
                                          std::uintmax_t max_bytes);

/// Writes a file beside its name and renames it at the end: it appears whole or not at all.
///
/// When anything fails, an older file of that name stays as it was and nothing new is left behind.
/// A new file takes the older one's permissions. A symbolic link is followed, so that it still is
/// one afterwards; one that leads nowhere is refused. Several threads and programs may write the
/// same file at once: the last one's stays. If the program has called protect_files(), a signal
/// that ends it waits for the file.
///
/// @throws InputError  When the folder is missing, the name belongs to something else than a
///          regular file, or the bytes cannot be written (no permission, no space).
void write_whole_file(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace rasterbook
