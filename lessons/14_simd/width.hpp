// SPDX-License-Identifier: MIT
/// @file
/// How many pixels are drawn at a time: chosen when the program runs, compiled once for each width.
/// Introduced in lesson 14.
#pragma once

#include "10_threading/binned_triangles.hpp"
#include "13_visibility_buffer/visible_shading.hpp"
#include "14_simd/wide_triangles.hpp"
#include "common/app/lesson_app.hpp"

namespace rasterbook {

/// The functions that draw so many pixels at a time. What else a frame takes stays as it is
/// (Eq. 14.5).
struct WideDrawing {
    using Maps = ShadowMapsOnDemand;

    ProjectTriangles* project_triangles;
    void (*draw_id)(const Frame<Maps>&, const ProjectedTriangle&, const Tile&, TileDepths&,
                    VisibilityBuffer&);
    void (*shade_visible)(const Frame<Maps>&, VisibilityBuffer&, Show, HeatMap&);
    void (*draw_transparent)(const Frame<Maps>&, const ProjectedTriangle&, const Tile&, TileDepths&,
                             TransparentFragments&, HeatMap&);
};

/// Compiled apart, in width_4.cpp and so on.
template <int N>
WideDrawing drawing_of_width();

/// Whether a program has --width. A reader's own has the native width alone, so that its picture
/// takes less time to come; ./lessons/run builds another when it is asked for.
#ifdef RASTERBOOK_NATIVE_WIDTH_ALONE
constexpr bool has_each_width = false;
#else
constexpr bool has_each_width = true;
#endif

/// @param width  1, 4, 8 or 16.
inline WideDrawing drawing_of_width(int width) {
    if constexpr (has_each_width) {
        if (width == 1) return drawing_of_width<1>();
        if (width == 4) return drawing_of_width<4>();
        if (width == 8) return drawing_of_width<8>();
        if (width == 16) return drawing_of_width<16>();
    }
    return drawing_of_width<native_width>();
}

struct WidthOptions {
    int width = native_width;

    void declare(OptionParser& parser) {
        if constexpr (has_each_width)
            parser.choice("--width", width, {{"1", 1}, {"4", 4}, {"8", 8}, {"16", 16}},
                          "Pixels that are drawn at a time");
    }
};

}  // namespace rasterbook
