// SPDX-License-Identifier: MIT
/// @file
/// The laboratory: other methods for what a lesson does, drawn, compared and timed.
#pragma once

#include <functional>
#include <string>

#include "common/app/lesson_app.hpp"

namespace rasterbook {

/// Runs a lesson's laboratory.
///
/// Without arguments it lists what one can choose. Where choices are given several words each, as
/// in
/// `--line bresenham,wu`, it draws a picture for each combination, by turns, and prints how far
/// each is from the reference and how long it takes; else it draws one picture, like a lesson's
/// program.
///
/// @param make       Called for each picture: a program, with options of its own.
/// @param reference  Options that draw what errors are measured against, such as
///                   "--line bresenham"; nothing: what the program draws unasked.
/// @return           The exit status: 0, 1 for bad input or what cannot be written, 2 for bad
///                   usage; errors are one line on stderr.
int run_lab(const std::function<LessonProgram()>& make, const std::string& reference, int argc,
            char** argv);

}  // namespace rasterbook
