// SPDX-License-Identifier: MIT
/// @file
/// Of a test file, a page compiles the tests of the equations that are asked for.
#pragma once

#include <string_view>

namespace rasterbook::test {

/// They take many seconds in a page, or read the course's models.
constexpr std::string_view not_in_a_page[] = {
    "ExhaustiveAllLinesOfASmallGridAreIdeal",
    "ExhaustiveAllTrianglesOfAQuarterPixelLatticeAreExact",
    "RandomTrianglesOfAllSizesAreExact",
    "RandomTriangulationsCoverEachPixelOnce",
    "Eq4_13_WhatIsLeftOfTrianglesOfAllSizes",
    "Eq8_9_HeightMapsAndNormalMapsAgree"};

/// Whether a test's name begins with one of the equations in ASKED_EQUATIONS, as "Eq5_1_ Eq5_4_".
/// With "*", whether it is neither a hard case nor of a picture.
constexpr bool is_asked(std::string_view name) {
    if (name.find("HardCase") != std::string_view::npos || name.starts_with("PictureOf"))
        return false;
    for (const std::string_view other : not_in_a_page)
        if (name == other) return false;
    constexpr std::string_view asked = ASKED_EQUATIONS;
    if (asked == "*") return true;
    const std::size_t end = name.find('_', name.find('_') + 1) + 1;
    return name.starts_with("Eq") && asked.find(name.substr(0, end)) != std::string_view::npos;
}

}  // namespace rasterbook::test

#define IS_ASKED(name) rasterbook::test::is_asked(name)
#include "support/asked_tests.hpp"
