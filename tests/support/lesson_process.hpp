// SPDX-License-Identifier: MIT
/// @file
/// Runs a lesson's program as a reader would.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rasterbook::test {

struct ProcessResult {
    int exit_status;  ///< -1 when a signal ended it.
    std::string out, err;
};

/// Runs a program of the build, such as "03_z_buffer", or any by its whole path, and waits for it.
ProcessResult run_program(const std::string& name, const std::vector<std::string>& arguments);

/// All of a file's bytes; empty when there is no such file.
std::string read_text(const std::filesystem::path& file);

/// An empty folder for this test alone, below the system's folder for temporary files; removed when
/// the test program ends.
std::filesystem::path fresh_folder(const std::string& name);

}  // namespace rasterbook::test
