// SPDX-License-Identifier: MIT
/// @file
/// Causes what goes wrong outside of the programs: full disks, closed streams.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/lesson_process.hpp"

// Where a fault cannot be caused, its test is skipped; whoever asks for all of them sees it fail.
#define SKIP_FAULT(reason)                                                        \
    do {                                                                          \
        if (std::getenv("RASTERBOOK_FAULTS_REQUIRED")) FAIL() << reason;          \
        GTEST_SKIP() << reason << "; RASTERBOOK_FAULTS_REQUIRED=1 makes it fail"; \
    } while (false)

namespace rasterbook::test {

using Words = std::vector<std::string>;

inline Words operator+(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

inline std::string program(const char* name) {
    return std::filesystem::path(RASTERBOOK_LESSONS) / name;
}

/// Runs a shell's command, in which "$@" stands for the words and "$0" for a name of your own.
inline ProcessResult in_shell(const std::string& command, const Words& words,
                              const std::string& name = "sh") {
    return run_program("/bin/sh", Words{"-c", command, name} + words);
}

/// For in_shell: the words' output goes into a pipe, named as "$0", which nobody reads any more.
inline const std::string into_closed_pipe =
    "mkfifo \"$0\"; : <\"$0\" & exec 3>\"$0\"; wait; rm \"$0\"; exec \"$@\" >&3 3>&-";

/// By what this user may mount a file system that nobody else sees; empty where he may not.
inline const std::string& mounter() {
    static const std::string command = [] {
        for (const char* candidate : {"unshare -m", "unshare -rm"})
            if (in_shell(candidate + std::string(" mount -t tmpfs none \"$@\""),
                         {fresh_folder("mount")})
                    .exit_status == 0)
                return candidate;
        return "";
    }();
    return command;
}
inline const char* const cannot_mount =
    "this user may not mount a file system, not even by unshare -rm";

/// Runs a program in a folder that is a small disk, which is gone at the end.
///
/// @param options  Of mount, such as its size.
/// @param prepare  A shell's command in that folder, before; its failure is none.
/// @param files    Takes what there is afterwards.
inline ProcessResult on_disk(const std::filesystem::path& disk, const std::string& options,
                             const std::string& prepare, const Words& words, Files& files) {
    const std::filesystem::path copy = fresh_folder("copy");
    const std::string script =
        "mount -t tmpfs -o \"$0\" none \"$1\" && cd \"$1\" || exit 99\n"
        "copy=$2; eval \"$3\"; shift 3; \"$@\"; status=$?; cp -a . \"$copy\"; exit $status";
    const ProcessResult result = in_shell("exec " + mounter() + " sh -c \"$0\" \"$@\"",
                                          Words{options, disk, copy, prepare} + words, script);
    files = files_in(copy);
    return result;
}

inline const char* const fill = "head -c 1M /dev/zero >fill 2>/dev/null";

/// A lesson's frames as they should be: "turn_0000.bmp" and so on.
inline const Words frames_of_04{"--model", "triangle.obj", "--size", "128x96"};
inline Files whole_frames(const char* frames, const Words& options = frames_of_04,
                          const char* lesson = "04_mvp") {
    const std::filesystem::path folder = fresh_folder("whole");
    const ProcessResult result =
        run_program(lesson, options + Words{"--frames", frames, "--out", folder / "turn_%04d.bmp"});
    EXPECT_EQ(result.exit_status, 0) << result.err;
    return files_in(folder);
}

/// All files are frames, whole ones, or of those that were there before.
inline void expect_whole(const Files& files, const Files& whole) {
    for (const auto& [name, bytes] : files) {
        EXPECT_TRUE(name.starts_with("turn_")) << name << " was left behind";
        EXPECT_EQ(bytes.size(), whole.begin()->second.size()) << name;
        if (whole.contains(name)) { EXPECT_TRUE(bytes == whole.at(name)) << name; }
    }
}

}  // namespace rasterbook::test
