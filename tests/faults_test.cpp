// SPDX-License-Identifier: MIT
// What goes wrong outside of the programs: full disks, closed streams, folders that may not be
// written, other programs that write the same files. No half file, nothing left behind, one line
// that says why, and the exit status of --help.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "common/image/file.hpp"
#include "common/image/interruption.hpp"
#include "support/faults.hpp"
#include "support/lesson_process.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace fs = std::filesystem;

namespace {

const std::string output_failed = "standard output cannot be written";

const Words draw_04{program("04_mvp"), "--size", "8x8", "--out"};

/// To root, no permission is denied: it has to give that right away first.
const std::string without_roots_rights =
    geteuid() == 0 ? "exec setpriv --bounding-set=-all \"$@\"" : "exec \"$@\"";

bool can_give_away_roots_rights() {
    return in_shell(without_roots_rights, {program("04_mvp"), "--help"}).exit_status == 0;
}
const char* const cannot_give_away = "root cannot run a program without root's rights, by setpriv";

}  // namespace

TEST(Faults, HardCase_FullDiskKeepsTheFramesThatWereFinished) {
    if (mounter().empty()) SKIP_FAULT(cannot_mount);
    const fs::path disk = fresh_folder("disk");
    const Files whole = whole_frames("0-9/99");
    for (const char* jobs : {"1", "4"}) {
        Files files;
        const ProcessResult result =
            on_disk(disk, "size=200k", "",
                    Words{program("04_mvp")} + frames_of_04 +
                        Words{"--frames", "99", "--jobs", jobs, "--out", "turn_%04d.bmp"},
                    files);
        expect_error(result, 1, ".bmp: cannot be written: No space left on device");
        expect_whole(files, whole);
        if (*jobs == '1') { EXPECT_TRUE(files.contains("turn_0000.bmp")); }
        const std::string missing = result.err.substr(std::string("error: ").size(), 13);
        EXPECT_FALSE(files.contains(missing)) << missing;
        EXPECT_EQ(std::distance(files.begin(), files.lower_bound(missing)),
                  std::distance(whole.begin(), whole.lower_bound(missing)))
            << "not all frames before " << missing;
    }
}

TEST(Faults, HardCase_FullDiskLeavesTheOldPicture) {
    if (mounter().empty()) SKIP_FAULT(cannot_mount);
    const fs::path disk = fresh_folder("disk");
    for (const char* options : {"size=64k", "nr_inodes=3"})  // no room for bytes; for names
        for (const std::string name : {"a.png", "a.bmp", "a.tga"}) {
            Files files;
            const ProcessResult result =
                on_disk(disk, options, "echo old >" + name + "; " + fill,
                        Words{program("04_mvp"), "--size", "64x48", "--out", name}, files);
            expect_error(result, 1, name + ": cannot be written: No space left on device");
            EXPECT_EQ(files[name], "old\n");
            EXPECT_EQ(files.size(), 2u) << "something was left behind";
        }
}

TEST(Faults, HardCase_LimitOfAFilesSizeIsAnErrorThatLeavesTheOldPicture) {
    const fs::path folder = fresh_folder("faults");
    std::ofstream(folder / "a.bmp") << "old";
    for (const char* size : {"16x16", "640x480"})  // within a stream's buffer and beyond
        expect_error(in_shell("ulimit -f 1; exec \"$@\"",
                              {program("04_mvp"), "--size", size, "--out", folder / "a.bmp"}),
                     1, "a.bmp: cannot be written: File too large");
    EXPECT_EQ(differing(files_in(folder), {{"a.bmp", "old"}}), "");
}

TEST(Faults, HardCase_OutputThatCannotBeWrittenIsAnErrorAfterThePicture) {
    const fs::path folder = fresh_folder("faults");
    const Words draw{program("12_effects"), "--model", "unlit.glb", "--size", "64x48"};
    in_shell("exec \"$@\"", draw + Words{"--out", folder / "a.bmp"});
    const std::string whole = read_text(folder / "a.bmp");
    for (const std::string& command : {std::string("exec \"$@\" >&-"), into_closed_pipe,
                                       std::string("exec \"$@\" >/dev/full")}) {
        if (command.ends_with("full") && !fs::exists("/dev/full"))
            SKIP_FAULT("there is no /dev/full");
        for (const Words& words : {Words{}, Words{"--stats"}, Words{"--explain"}}) {
            fs::remove(folder / "a.bmp");
            expect_error(
                in_shell(command, draw + words + Words{"--out", folder / "a.bmp"}, folder / "fifo"),
                1, output_failed);
            EXPECT_TRUE(read_text(folder / "a.bmp") == whole) << command;
        }
        expect_error(in_shell(command, {program("04_mvp"), "--help"}, folder / "fifo"), 1,
                     output_failed);
    }
}

TEST(Faults, HardCase_OutputThatWasLostIsAnErrorEvenIfTheRestIsWritten) {
    const fs::path folder = fresh_folder("faults");
    int pipe_ends[2];  // a full one that makes nobody wait, as some terminals do
    ASSERT_EQ(pipe2(pipe_ends, O_NONBLOCK), 0);
    const std::string page(4096, ' ');
    while (write(pipe_ends[1], page.data(), page.size()) > 0) {}
    StartedProgram sequence(
        "/bin/sh", Words{"-c", "exec \"$@\" >&" + std::to_string(pipe_ends[1]), "sh",
                         program("12_effects"), "--model", "unlit.glb", "--size", "64x48", "--jobs",
                         "1", "--explain", "--frames", "48", "--out", folder / "turn_%04d.bmp"});
    while (sequence.is_running() && !fs::exists(folder / "turn_0040.bmp")) {}
    std::string read_again(1 << 20, ' ');
    while (read(pipe_ends[0], read_again.data(), read_again.size()) > 0) {}
    const ProcessResult result = sequence.wait();
    for (const int end : pipe_ends) close(end);
    expect_error(result, 1, output_failed);
    EXPECT_EQ(files_in(folder).size(), 48u);
}

TEST(Faults, HardCase_ErrorThatCannotBeSaidKeepsItsExitStatus) {
    const Words wrong{program("04_mvp"), "--size", "0x0"},
        missing{program("04_mvp"), "--model", "no"};
    for (const char* command : {"exec \"$@\" 2>&-", "exec \"$@\" <&- >&- 2>&-"}) {
        EXPECT_EQ(in_shell(command, wrong).exit_status, 2) << command;
        EXPECT_EQ(in_shell(command, missing).exit_status, 1) << command;
    }
}

TEST(Faults, HardCase_NoFileTakesThePlaceOfAClosedStream) {
    const fs::path folder = fresh_folder("faults");
    const auto opens_a_file = [&] {
        close(STDIN_FILENO);
        close(STDOUT_FILENO);
        protect_files();
        std::FILE* const file = std::fopen((folder / "a").c_str(), "w");
        const bool is_apart = file && fileno(file) > STDERR_FILENO;
        const bool fails = write(STDOUT_FILENO, "a", 1) < 0;
        _exit(is_apart && fails ? 0 : 1);
    };
    EXPECT_EXIT(opens_a_file(), testing::ExitedWithCode(0), "");
}

TEST(Faults, HardCase_OutputThatCannotBeWrittenEndsNoSequenceBeforeItsLastFrame) {
    const Words options{"--model", "unlit.glb", "--size", "200x100", "--jobs", "8", "--explain"};
    const Files whole = whole_frames("0-15/48", options, "12_effects");
    for (const std::string& command : {std::string("exec \"$@\" >&-"), into_closed_pipe}) {
        const fs::path folder = fresh_folder("faults");
        const Words draw{program("12_effects"), "--frames", "0-15/48", "--out",
                         folder / "turn_%04d.bmp"};
        expect_error(in_shell(command, draw + options, folder / "fifo"), 1, output_failed);
        EXPECT_EQ(differing(files_in(folder), whole), "");
    }
}

TEST(Faults, HardCase_FolderThatMayNotBeWrittenIsAnError) {
    const fs::path folder = fresh_folder("faults");
    std::ofstream(folder / "a.bmp") << "old";
    fs::permissions(folder, fs::perms{0555});
    if (!can_give_away_roots_rights()) SKIP_FAULT(cannot_give_away);
    for (const std::string name : {"a.bmp", "b.bmp"})
        expect_error(in_shell(without_roots_rights, draw_04 + Words{folder / name}), 1,
                     name + ": cannot be written: Permission denied");
    fs::permissions(folder, fs::perms{0755});
    EXPECT_EQ(differing(files_in(folder), {{"a.bmp", "old"}}), "");
}

TEST(Faults, HardCase_FileOfAnotherUserInASharedFolderStays) {
    const fs::path folder = fresh_folder("faults");
    std::ofstream(folder / "a.bmp") << "old";
    fs::permissions(folder, fs::perms{01777});  // as /tmp: each removes his own files only
    const uid_t other = geteuid() + 1;
    if (chown(folder.c_str(), other, other) != 0 ||
        chown((folder / "a.bmp").c_str(), other, other) != 0)
        SKIP_FAULT("only root can give a file to another user");
    if (!can_give_away_roots_rights()) SKIP_FAULT(cannot_give_away);
    expect_error(in_shell(without_roots_rights, draw_04 + Words{folder / "a.bmp"}), 1,
                 "a.bmp: cannot be written: Operation not permitted");
    EXPECT_EQ(differing(files_in(folder), {{"a.bmp", "old"}}), "");
}

TEST(Faults, HardCase_ReadOnlyDiskIsAnError) {
    if (mounter().empty()) SKIP_FAULT(cannot_mount);
    Files files;
    const ProcessResult result = on_disk(fresh_folder("disk"), "size=64k",
                                         "echo old >a.bmp; mount -o remount,bind,ro \"$1\"",
                                         draw_04 + Words{"turn_%d.bmp", "--frames", "9"}, files);
    expect_error(result, 1, "turn_0.bmp: cannot be written: Read-only file system");
    EXPECT_EQ(differing(files, {{"a.bmp", "old\n"}}), "");
}

TEST(Faults, HardCase_TwoRunsThatWriteTheSameFilesLeaveWholeOnes) {
    const fs::path folder = fresh_folder("faults");
    const std::vector<Words> options{
        {"--model", "triangle.obj", "--size", "400x300"},
        {"--model", "triangle.obj", "--size", "500x400", "--yaw", "90"}};
    std::vector<Files> whole;
    std::vector<std::unique_ptr<StartedProgram>> runs;
    for (const Words& words : options) {
        whole.push_back(whole_frames("40", words));
        runs.push_back(std::make_unique<StartedProgram>(
            "04_mvp", words + Words{"--frames", "40", "--out", folder / "turn_%04d.bmp"}));
    }
    const auto expect_one_of_both = [&](const std::string& name) {
        const std::string bytes = read_text(folder / name);
        EXPECT_TRUE(bytes == whole[0].at(name) || bytes == whole[1].at(name)) << name;
    };
    const auto is_running = [](const auto& run) { return run->is_running(); };
    while (std::ranges::any_of(runs, is_running))
        for (const auto& [name, bytes] : whole[0])
            if (fs::exists(folder / name)) expect_one_of_both(name);
    for (const auto& run : runs) {
        const ProcessResult result = run->wait();
        EXPECT_EQ(result.exit_status, 0) << result.err;
    }
    EXPECT_EQ(files_in(folder).size(), 40u);
    for (const auto& [name, bytes] : whole[0]) expect_one_of_both(name);
}

TEST(Faults, HardCase_FileThatAnotherProgramPutsAndRemovesIsWrittenAllTheSame) {
    const fs::path folder = fresh_folder("faults"), file = folder / "a", spare = folder / "spare";
    const std::vector<std::uint8_t> bytes{1};
    const mode_t mask = umask(027);
    write_whole_file(spare, bytes);
    std::atomic<bool> is_done = false;
    std::thread other([&] {
        while (!is_done) {
            if (link(spare.c_str(), file.c_str()) == 0) std::this_thread::yield();
            unlink(file.c_str());
        }
    });
    for (int i = 0; i < 500; ++i) {
        EXPECT_NO_THROW(write_whole_file(file, bytes)) << i;
        struct stat status{};
        if (stat(file.c_str(), &status) == 0) { EXPECT_EQ(status.st_mode & 07777, 0640u) << i; }
    }
    is_done = true;
    other.join();
    umask(mask);
}
