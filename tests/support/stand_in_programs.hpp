// SPDX-License-Identifier: MIT
/// @file
/// Programs that stand in for the lessons', so that a gallery takes no time.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "support/lesson_process.hpp"
#include "support/texts.hpp"

namespace rasterbook::test {

/// A folder with a program of each lesson's name, which writes "drawn" in place of a picture.
inline std::filesystem::path stand_in_programs() {
    const std::filesystem::path folder = fresh_folder("programs");
    for (const std::string& lesson : lessons()) {
        std::ofstream(folder / lesson) << "#!/bin/sh\nwhile [ \"$1\" != --out ]; do shift; done\n"
                                          "echo drawn >\"$2\"\necho '{ \"render_ms\": 12.34 }'\n";
        std::filesystem::permissions(folder / lesson, std::filesystem::perms::owner_all);
    }
    return folder;
}

}  // namespace rasterbook::test
