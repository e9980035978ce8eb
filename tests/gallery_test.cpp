// SPDX-License-Identifier: MIT
// What ./lessons/run makes when it is given no lesson, with programs that stand in for the
// lessons'.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "support/lesson_process.hpp"
#include "support/stand_in_programs.hpp"
#include "support/texts.hpp"

namespace fs = std::filesystem;
using namespace rasterbook::test;

namespace {

ProcessResult make_gallery(const fs::path& programs, const fs::path& gallery) {
    return run_program(root / "lessons/make_gallery", {programs, gallery});
}

/// All that stands in the page between two marks.
std::vector<std::string> in_page(const fs::path& gallery, const char* begin, const char* end) {
    return all_between(read_text(gallery / "index.html"), begin, end);
}

}  // namespace

TEST(Gallery, ShowsAPictureOfEachLesson) {
    const fs::path gallery = fresh_folder("gallery");
    const ProcessResult result = make_gallery(stand_in_programs(), gallery);
    EXPECT_EQ(result.exit_status, 0);
    EXPECT_EQ(result.err, "");
    const auto pictures = in_page(gallery, "<img src=\"", "\"");
    EXPECT_GT(pictures.size(), lessons().size());  // most have further ones
    for (const std::string& lesson : lessons())
        EXPECT_EQ(std::ranges::count(pictures, lesson + ".png"), 1) << lesson;
    for (const std::string& picture : pictures)
        EXPECT_EQ(read_text(gallery / picture), "drawn\n") << picture;
    EXPECT_EQ(in_page(gallery, "drawn in ", " ms").size(), pictures.size());
}

TEST(Gallery, ALessonThatFailsCostsNoOtherItsPicture) {
    const fs::path programs = stand_in_programs(), gallery = fresh_folder("gallery");
    make_gallery(programs, gallery);
    const auto all = in_page(gallery, "<img src=\"", "\"");
    std::ofstream(programs / lessons()[1]) << "#!/bin/sh\necho 'error: a & b < c' >&2\nexit 3\n";
    std::ofstream(programs / lessons()[2]) << "#!/bin/sh\nkill -SEGV $$\n";
    const ProcessResult result = make_gallery(programs, gallery);
    EXPECT_EQ(result.exit_status, 1);

    const auto fails = [](const std::string& picture) {
        return picture.starts_with(lessons()[1]) || picture.starts_with(lessons()[2]);
    };
    std::vector<std::string> others = all;
    std::erase_if(others, fails);
    EXPECT_EQ(in_page(gallery, "<img src=\"", "\""), others);
    EXPECT_EQ(in_page(gallery, "<h2>", "</h2>").size(), all.size());
    for (const std::string& picture : all)  // an earlier run's would be taken for this one's
        EXPECT_EQ(fs::exists(gallery / picture), !fails(picture)) << picture;

    const auto failed = std::to_string(all.size() - others.size());
    EXPECT_NE(result.err.find("error: " + failed + " of " + std::to_string(all.size()) +
                              " pictures failed:\n  ./lessons/run 02\n"),
              std::string::npos)
        << result.err;
    const std::string page = read_text(gallery / "index.html");
    EXPECT_NE(page.find("error: a &amp; b &lt; c"), std::string::npos);
    EXPECT_NE(page.find("ended by signal 11: SEGV"), std::string::npos);
    EXPECT_TRUE(page.ends_with("</html>\n"));
}

TEST(Ci, HardCase_RefusesToRunOverAReadersWork) {
    const fs::path clone = fresh_folder("clone_with_mine");
    fs::create_directories(clone / ".ci");
    fs::create_directories(clone / "mine/03_z_buffer");
    fs::copy_file(root / ".ci/run", clone / ".ci/run");
    std::ofstream(clone / "mine/03_z_buffer/depth_buffer.hpp") << "a reader's work\n";
    const ProcessResult result = run_program(clone / ".ci/run", {"0"});
    EXPECT_EQ(result.exit_status, 2);
    EXPECT_TRUE(result.err.starts_with("error: mine/ is there")) << result.err;
    EXPECT_EQ(read_text(clone / "mine/03_z_buffer/depth_buffer.hpp"), "a reader's work\n");
}
