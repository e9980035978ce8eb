// SPDX-License-Identifier: MIT
// Signals that end a program in the midst of a sequence: whole frames, nothing else.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
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

bool has_part(const fs::path& folder) {
    return std::ranges::any_of(fs::directory_iterator(folder), [](const auto& entry) {
        return entry.path().extension() == ".part";
    });
}

/// As a program that is started from a terminal; in the background, a shell has SIGINT ignored.
void protect_files_as_from_a_terminal() {
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, SIG_DFL);
    protect_files();
}

}  // namespace

TEST(Faults, HardCase_SignalInASequenceLeavesWholeFramesAndNothingElse) {
    const Words options{"--model", "triangle.obj", "--size", "500x400", "--jobs", "3"};
    const Files whole = whole_frames("0-9/999", options);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const fs::path folder = fresh_folder("faults");
        const Words out{"--out", folder / "turn_%04d.bmp"};
        StartedProgram sequence("04_mvp", options + Words{"--frames", "999"} + out);
        while (sequence.is_running() &&
               !(fs::exists(folder / "turn_0001.bmp") && has_part(folder))) {}
        sequence.send(signal);
        const ProcessResult result = sequence.wait();
        EXPECT_EQ(result.signal, signal) << "exit status " << result.exit_status << result.err;
        EXPECT_EQ(result.out + result.err, "");
        const Files finished = files_in(folder);
        EXPECT_LT(finished.size(), 999u);
        expect_whole(finished, whole);

        // A restart draws the rest.
        const ProcessResult rest =
            run_program("04_mvp", options + Words{"--frames", "0-9/999"} + out);
        EXPECT_EQ(rest.exit_status, 0) << rest.err;
        Files again = files_in(folder);
        std::erase_if(again, [&](const auto& file) { return !whole.contains(file.first); });
        EXPECT_EQ(differing(again, whole), "");
    }
}

TEST(Faults, HardCase_SignalWaitsForTheFileAndLetsNoOtherBegin) {
    const fs::path folder = fresh_folder("faults");
    const auto put = [&](const char* name) {
        write_whole_file(folder / name, std::vector<std::uint8_t>{1});
    };
    const auto write_while_it_comes = [&](int signal) {
        protect_files_as_from_a_terminal();
        {
            const UninterruptedWrite write;
            raise(signal);
            std::thread([&] { put("begun_after"); }).detach();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            std::ofstream(folder / "begun_before") << "whole";
        }
        put("too_late");
    };
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        EXPECT_EXIT(write_while_it_comes(signal), testing::KilledBySignal(signal), "");
        EXPECT_EQ(differing(files_in(folder), {{"begun_before", "whole"}}), "");
    }
    const auto draw_while_it_comes = [] {
        protect_files_as_from_a_terminal();
        raise(SIGINT);
        _exit(0);
    };
    EXPECT_EXIT(draw_while_it_comes(), testing::KilledBySignal(SIGINT), "") << "at once";
}

TEST(Faults, SignalThatIsIgnoredStaysIgnored) {
    const fs::path folder = fresh_folder("faults");
    StartedProgram sequence(
        "/bin/sh", Words{"-c", "trap '' HUP INT; exec \"$@\"", "nohup", program("04_mvp")} +
                       frames_of_04 + Words{"--frames", "99", "--out", folder / "turn_%04d.bmp"});
    while (sequence.is_running() && fs::is_empty(folder)) {}
    sequence.send(SIGHUP);
    sequence.send(SIGINT);
    EXPECT_EQ(sequence.wait().exit_status, 0);
    EXPECT_EQ(files_in(folder).size(), 99u);
}
