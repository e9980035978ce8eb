// SPDX-License-Identifier: MIT
// Several frames: which, how many at once, and that it cannot be seen how they were split.
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/app/counters.hpp"
#include "common/app/image_sequence.hpp"
#include "common/app/threads.hpp"
#include "support/lesson_process.hpp"

using namespace rasterbook;
using rasterbook::test::ProcessResult, rasterbook::test::run_program,
    rasterbook::test::fresh_folder, rasterbook::test::read_text, rasterbook::test::expect_error,
    rasterbook::test::Files, rasterbook::test::files_in, rasterbook::test::differing;

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// Runs a lesson once for each list of options, all writing into one new folder.
Files sequence_of(const std::string& lesson, const std::vector<Words>& runs) {
    const auto folder = fresh_folder("sequence");
    for (Words words : runs) {
        words.insert(words.end(),
                     {"--size", "32x18", "--out", (folder / "turn_%04d.png").string()});
        const ProcessResult result = run_program(lesson, words);
        EXPECT_EQ(result.exit_status, 0) << result.err;
        EXPECT_EQ(result.err, "");
    }
    return files_in(folder);
}

/// The counters that --stats prints.
std::vector<long> counters_of(const ProcessResult& result) {
    const auto stats = nlohmann::json::parse(result.out);
    EXPECT_GE(stats.at("total_ms"), stats.at("load_ms"));
    std::vector<long> counters;
    for (const auto name : counter_names) counters.push_back(stats.at(std::string(name)));
    return counters;
}

}  // namespace

TEST(Frames, AreReadAsANumberOrAPart) {
    for (const auto& [text, first, last, of_turn] :
         {std::tuple{"1", 0, 0, 1}, {"9999", 0, 9998, 9999}, {"0030-0059/0090", 30, 59, 90}}) {
        const Frames frames = frames_from(text);
        EXPECT_EQ(frames.first, first) << text;
        EXPECT_EQ(frames.last, last) << text;
        EXPECT_EQ(frames.of_turn, of_turn) << text;
        EXPECT_EQ(frames.count(), last - first + 1) << text;
    }
}

TEST(Frames, HardCase_AnythingElseIsExitStatus2AndSaysWhy) {
    const auto folder = fresh_folder("sequence");
    const auto refuse = [&](const std::string& text, const std::string& why) {
        expect_error(run_program("04_mvp", {"--size", "8x8", "--frames", text, "--out",
                                            (folder / "turn_%04d.png").string()}),
                     2, "--frames: '" + text + "' " + why);
    };
    for (const char* text :
         {"0", "10000", "", "-1", "+1", "2.5", " 9", "9 ", "0-0/0", "3/9", "0-/9", "-3/9", "0-3/",
          "0-3/9/9", "9/0-3", "0-3/10000", "0--3/9", "0-3/x", "18446744073709551617"})
        refuse(text, "is not a number of frames from 1 to 9999, nor a part of them");
    refuse("0-9", "does not say of how many frames");
    refuse("5-4/9", "ends before it begins");
    refuse("5-9/9", "ends behind the last frame, which is 8");
    for (const char* jobs : {"0", "-1", "257", "x", ""})
        expect_error(run_program("04_mvp", {"--frames", "2", "--jobs", jobs}), 2, "--jobs");
    expect_error(run_program("04_mvp", {"--frames", "7-7/9", "--out", (folder / "a.png").string()}),
                 2, "--out");
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST(Frames, AreAsManyAtOnceAsThreadsFramesAndMemoryAllow) {
    const ivec2 hd(1280, 720);
    EXPECT_EQ(frames_at_once(2, frames_from("90"), hd), 2);
    EXPECT_EQ(frames_at_once(8, frames_from("3"), hd), 3);
    EXPECT_EQ(frames_at_once(8, frames_from("80-81/90"), hd), 2);
    EXPECT_EQ(frames_at_once(8, frames_from("1"), hd), 1);
    EXPECT_EQ(frames_at_once(256, frames_from("999"), hd), 29) << "2^30 / (40 * 1280 * 720) = 29.1";
    EXPECT_EQ(frames_at_once(256, frames_from("999"), hd * 2), 7);
    EXPECT_EQ(frames_at_once(256, frames_from("999"), {5793, 4633}), 1) << "40 bytes below 2^30";
    EXPECT_EQ(frames_at_once(256, frames_from("999"), {131072, 131072}), 1);
    EXPECT_EQ(frames_at_once(256, frames_from("9999"), {1, 1}), 256);
}

TEST(AtOnce, AsManyAsAskedForRunAtATimeAndEachIsDoneOnce) {
    constexpr int at_once = 4;
    std::mutex mutex;
    std::condition_variable has_come;
    int here = 0, most = 0;
    std::vector<int> done;
    // Each of the first four waits until all four are there: in one thread they would never be.
    for_each_at_once(at_once, 3, 40, [&](int i) {
        std::unique_lock lock(mutex);
        most = std::max(most, ++here);
        has_come.notify_all();
        if (done.size() < at_once) {
            EXPECT_TRUE(
                has_come.wait_for(lock, std::chrono::seconds(60), [&] { return most == at_once; }));
        }
        done.push_back(i);
        --here;
    });
    EXPECT_EQ(most, at_once);
    std::ranges::sort(done);
    std::vector<int> each(38);
    std::iota(each.begin(), each.end(), 3);
    EXPECT_EQ(done, each);
}

TEST(AtOnce, HardCase_TheFirstErrorInOrderIsThrownAndNoneIsBegunAfter) {
    constexpr int tasks = 10000;  // of a millisecond each: nobody does them all by mistake
    for (const int at_once : {1, 2, 4})
        for (int repeat = 0; repeat < 20; ++repeat) {
            std::atomic<int> begun = 0;
            const auto task = [&](int i) {
                ++begun;
                if (i == 4) throw std::runtime_error("4");  // sooner than 3, if not alone
                if (i >= 3) std::this_thread::sleep_for(std::chrono::milliseconds(1));
                if (i == 3) throw std::runtime_error("3");
            };
            try {
                for_each_at_once(at_once, 0, tasks - 1, task);
                FAIL() << "nothing was thrown";
            } catch (const std::runtime_error& error) { EXPECT_STREQ(error.what(), "3"); }
            EXPECT_GE(begun, 4);
            if (at_once == 1) { EXPECT_EQ(begun, 4); }
            EXPECT_LT(begun, tasks / 2) << "it went on";
        }
}

TEST(ImageSequence, ItsPartsAreTheWhole) {
    for (const char* lesson : {"04_mvp", "10_threading", "11_scenes"}) {
        const auto whole = sequence_of(lesson, {{"--frames", "7"}});
        EXPECT_EQ(whole.size(), 7u);
        EXPECT_NE(whole.at("turn_0000.png"), whole.at("turn_0006.png")) << "the camera moves";
        const Files parts = sequence_of(  // two halves, and the last frame again
            lesson, {{"--frames", "0-3/7"}, {"--frames", "4-6/7"}, {"--frames", "6-6/7"}});
        EXPECT_EQ(differing(parts, whole), "")
            << lesson << ": a part of one frame is not a picture alone";
    }
}

TEST(ImageSequence, AnyNumberAtOnceGivesTheSameFilesAndCounters) {
    for (const char* lesson : {"04_mvp", "07_toon", "09_shadow_maps", "11_scenes", "14_simd"}) {
        const bool has_threads = lesson[0] == '1';
        const auto run = [&](const char* jobs, const char* threads) {
            const auto folder = fresh_folder("sequence");
            const std::string out = (folder / "turn_%d.bmp").string();
            Words words = {"--size", "48x27", "--samples", "4",     "--frames", "9",
                           "--jobs", jobs,    "--stats",   "--out", out};
            if (has_threads) words.insert(words.end(), {"--threads", threads});
            const ProcessResult result = run_program(lesson, words);
            EXPECT_EQ(result.exit_status, 0) << result.err;
            return std::pair(files_in(folder), counters_of(result));
        };
        const auto expected = run("1", "1");
        EXPECT_EQ(expected.first.size(), 9u);
        for (const auto& [jobs, threads] :
             {std::pair("2", "2"), {"3", "8"}, {"8", "1"}, {"256", "16"}}) {
            const auto actual = run(jobs, threads);
            EXPECT_EQ(differing(actual.first, expected.first), "")
                << lesson << ", " << jobs << " at once";
            EXPECT_EQ(actual.second, expected.second) << lesson << ", " << jobs << " at once";
        }
    }
}

TEST(ImageSequence, ThreadsAreSharedOutAmongTheFrames) {
    // Each thread's pixels have its colour: those of one thread alone show that it had no others.
    for (const char* lesson : {"10_threading", "11_scenes"}) {
        const auto sequence = [&](Words options) {
            options.insert(options.end(), {"--show-threads", "--tile", "8", "--frames", "4"});
            return sequence_of(lesson, {options});
        };
        const auto alone = sequence({"--jobs", "1", "--threads", "1"});
        EXPECT_EQ(differing(sequence({"--jobs", "2", "--threads", "3"}), alone), "");
        EXPECT_EQ(differing(sequence({"--threads", "4"}), alone), "")
            << "as many frames at once as threads";
    }
}

TEST(ImageSequence, SaysWhatItHasWritten) {
    const auto folder = fresh_folder("sequence");
    const auto said = [&](const char* frames) {
        const ProcessResult result = run_program(
            "04_mvp",
            {"--size", "8x8", "--frames", frames, "--out", (folder / "turn_%04d.png").string()});
        EXPECT_EQ(result.err, "");
        return result.out;
    };
    const auto file = [&](const char* name) { return (folder / name).string(); };
    EXPECT_EQ(said("7-7/120"), "wrote " + file("turn_0007.png") + "\n");
    EXPECT_EQ(said("8-9/120"), "wrote 2 pictures, " + file("turn_0008.png") + " and so on\n");
    EXPECT_EQ(said("0-0/1"), "wrote " + file("turn_%04d.png") + "\n") << "as without --frames";
    EXPECT_EQ(files_in(folder).size(), 4u);
}

TEST(ImageSequence, HardCase_TheFirstErrorInOrderIsSaidAndNothingIsHalfWritten) {
    const auto whole = sequence_of("04_mvp", {{"--frames", "0-19/999"}});
    for (const char* jobs : {"1", "8"}) {
        const auto folder = fresh_folder("sequence");
        fs::create_directory(folder / "turn_0002.png");  // where a file should go
        fs::create_directory(folder / "turn_0003.png");
        const mode_t before = umask(027);  // the program inherits it
        const ProcessResult result =
            run_program("04_mvp", {"--size", "32x18", "--frames", "999", "--jobs", jobs, "--out",
                                   (folder / "turn_%04d.png").string()});
        umask(before);
        expect_error(result, 1, (folder / "turn_0002.png").string() + ": cannot be written");
        const auto written = files_in(folder);
        EXPECT_TRUE(written.contains("turn_0000.png") && written.contains("turn_0001.png"));
        EXPECT_FALSE(written.contains("turn_0998.png")) << "it went on";
        for (const auto& [name, bytes] : written) {
            EXPECT_TRUE(name.starts_with("turn_")) << name << " was left behind";
            EXPECT_EQ(fs::status(folder / name).permissions(), fs::perms{0640}) << name;
            if (whole.contains(name)) { EXPECT_TRUE(bytes == whole.at(name)) << name; }
        }
    }
}

TEST(ImageSequence, WhatIsSeenInOneFrameIsNoReasonToWarn) {
    const auto folder = fresh_folder("sequence");
    const auto warnings = [&](const char* face) {
        std::ofstream(folder / "a.obj") << "v -1 0 0\nv 1 0 0\nv 0 1 0\n" << face << '\n';
        const ProcessResult result = run_program(
            "04_mvp", {"--size", "64x36", "--frames", "6", "--model", (folder / "a.obj").string(),
                       "--out", (folder / "turn_%d.png").string()});
        EXPECT_EQ(result.exit_status, 0);
        return result.err;
    };
    EXPECT_EQ(warnings("f 1 2 3"), "") << "from behind it is not to be seen";
    const std::string text = warnings("f 1 2 1");
    EXPECT_NE(text.find("nothing of it is to be seen"), text.npos);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << "once, not for each frame";
}

TEST(ImageSequence, EachExplanationIsWhole) {
    const auto folder = fresh_folder("sequence");
    const ProcessResult result = run_program(
        "12_effects", {"--size", "8x8", "--frames", "64", "--jobs", "16", "--model", "unlit.glb",
                       "--explain", "--stats", "--out", (folder / "turn_%d.bmp").string()});
    ASSERT_EQ(result.exit_status, 0) << result.err;
    const std::string text = result.out.substr(0, result.out.find("{\"lesson\""));
    const auto without_numbers = [](std::string part) {
        std::erase_if(part, [](char c) {
            return std::isdigit(static_cast<unsigned char>(c)) || c == '.' || c == 'e' ||
                   c == '-' || c == '+';
        });
        return part;
    };
    const auto second = text.find(" meshes, ", 9);
    ASSERT_NE(second, text.npos);
    std::string first = without_numbers(text.substr(0, text.rfind('\n', second) + 1)), all;
    for (int i = 0; i < 64; ++i) all += first;
    EXPECT_EQ(without_numbers(text), all);
}
