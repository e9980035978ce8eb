// SPDX-License-Identifier: MIT
// The gallery on a full disk, interrupted, and made twice at once: its page is whole, or the older
// one.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "support/faults.hpp"
#include "support/lesson_process.hpp"
#include "support/stand_in_programs.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace fs = std::filesystem;

TEST(Faults, HardCase_GalleryOnAFullDiskLeavesTheOldPage) {
    if (mounter().empty()) SKIP_FAULT(cannot_mount);
    const fs::path disk = fresh_folder("disk");
    for (const char* left : {"0", "8k", "20k"}) {
        Files files;
        const ProcessResult result =
            on_disk(disk, "size=64k",
                    std::string("echo old >index.html; head -c ") + left + " /dev/zero >room; " +
                        fill + "; rm room",
                    {root / "lessons/make_gallery", stand_in_programs(), disk}, files);
        EXPECT_NE(result.exit_status, 0) << left;
        EXPECT_NE(result.err.find("No space left on device"), std::string::npos) << result.err;
        EXPECT_EQ(files["index.html"], "old\n") << left;
        for (const auto& [name, bytes] : files)
            EXPECT_TRUE(name == "index.html" || name == "fill" || name.ends_with(".png")) << name;
    }
}

TEST(Faults, HardCase_TwoGalleriesAtOnceMakeOneWholePage) {
    const fs::path programs = stand_in_programs(), gallery = fresh_folder("gallery");
    const auto make = [&] {
        return std::make_unique<StartedProgram>(root / "lessons/make_gallery",
                                                Words{programs, gallery});
    };
    EXPECT_EQ(make()->wait().exit_status, 0);
    const Files whole = files_in(gallery);
    const auto first = make(), second = make();
    for (StartedProgram* const each : {first.get(), second.get()}) {
        const ProcessResult result = each->wait();
        EXPECT_EQ(result.exit_status, 0) << result.err;
    }
    EXPECT_EQ(differing(files_in(gallery), whole), "");
}

TEST(Faults, HardCase_GalleryThatIsInterruptedLeavesNoHalfPage) {
    const fs::path programs = stand_in_programs(), gallery = fresh_folder("gallery");
    const auto expect_no_half_page = [&] {
        for (const auto& [name, bytes] : files_in(gallery)) {
            const bool is_page = bytes == "old" || bytes.ends_with("</html>\n");
            EXPECT_TRUE(name.ends_with(".png") || (name == "index.html" && is_page)) << name;
        }
    };
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        fs::remove_all(gallery);
        fs::create_directory(gallery);
        std::ofstream(gallery / "index.html") << "old";
        StartedProgram run(root / "lessons/make_gallery", Words{programs, gallery});
        while (run.is_running() && !fs::exists(gallery / (lessons()[1] + ".png"))) {}
        run.send(signal);
        // Of Ctrl+C, bash goes on if the program that it waits for ended well all the same.
        const int ended_by = run.wait().signal;
        if (signal != SIGINT || ended_by != 0) { EXPECT_EQ(ended_by, signal); }
        expect_no_half_page();
    }
    const ProcessResult result = in_shell(
        into_closed_pipe, {root / "lessons/make_gallery", programs, gallery}, gallery / "fifo");
    EXPECT_EQ(result.signal, SIGPIPE) << result.exit_status << result.err;
    expect_no_half_page();
}
