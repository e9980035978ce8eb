// SPDX-License-Identifier: MIT
/// @file
/// Runs a lesson's program as a reader would.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace rasterbook::test {

struct ProcessResult {
    int exit_status;  ///< -1 when a signal ended it.
    std::string out, err;
    int signal = 0;  ///< That ended it, or 0.
};

/// A program that runs beside the test: of the build, such as "03_z_buffer", or any by its whole
/// path. No signal is blocked or ignored in it.
class StartedProgram {
  public:
    StartedProgram(const std::string& name, const std::vector<std::string>& arguments);
    StartedProgram(const StartedProgram&) = delete;
    StartedProgram& operator=(const StartedProgram&) = delete;
    ~StartedProgram();  ///< Kills it, unless it was waited for.

    void send(int signal) const;
    bool is_running() const;
    ProcessResult wait();

  private:
    std::filesystem::path folder_;  ///< Where its output goes.
    int process_ = -1;              ///< -1 when it could not be started, or was waited for.
};

/// Runs a program of the build, such as "03_z_buffer", or any by its whole path, and waits for it.
///
/// An argument "lab" stands for the lesson's laboratory, as in ./lessons/run lab.
///
/// In the environment, RASTERBOOK_OTHER_BUILD names the folder of a build for another machine, and
/// RASTERBOOK_EMULATOR what runs its programs (./tests/other_machines).
ProcessResult run_program(std::string name, std::vector<std::string> arguments);

/// The bytes of the PNG file that a lesson's program writes.
std::string bytes_of_picture(const std::string& lesson, std::vector<std::string> arguments);

/// Exit status, one line on stderr that starts with "error: " and holds `text`, nothing on stdout.
void expect_error(const ProcessResult& result, int exit_status, const std::string& text);

/// All of a file's bytes; empty when there is no such file.
std::string read_text(const std::filesystem::path& file);

using Files = std::map<std::string, std::string>;  ///< Bytes by name.

/// The regular files in a folder, not those in folders below it.
Files files_in(const std::filesystem::path& folder);

/// The names of those that are in one folder only, or not the same in both.
std::string differing(const Files& a, const Files& b);

/// An empty folder for this test alone, below the system's folder for temporary files; removed when
/// the test program ends.
std::filesystem::path fresh_folder(const std::string& name);

}  // namespace rasterbook::test
