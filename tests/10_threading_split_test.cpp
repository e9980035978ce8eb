// SPDX-License-Identifier: MIT
// The tiles of a picture, and what a schedule predicts: without threads, so that a page can run
// them.
#include "10_threading/split.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "10_threading/schedule.hpp"
#include "common/image/image.hpp"
#include "support/look_up.hpp"
#include "support/name_of_split.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// "tile 2 of 7"
std::string numbered(std::size_t tile, const Tiling& tiling) {
    return "tile " + std::to_string(tile) + " of " + std::to_string(tiling.count());
}

/// "a picture of 65 x 63, interleaved rows, 7 workers, tile side 64"
std::string named(ivec2 size, Split split, int workers, int side) {
    return "a picture of " + std::to_string(size.x) + " x " + std::to_string(size.y) + ", " +
           name_of(split) + ", " + std::to_string(workers) + " workers, tile side " +
           std::to_string(side);
}

/// By definition, pixel by pixel: which tile a pixel is in.
std::size_t tile_of(ivec2 pixel, Split split, ivec2 size, int workers, int side) {
    const int n = std::min(workers, size.y);
    if (split == Split::interleaved) return static_cast<std::size_t>(pixel.y % n);
    if (split == Split::tiles)
        return static_cast<std::size_t>((pixel.y / side) * ((size.x + side - 1) / side) +
                                        pixel.x / side);
    int tile = 0;  // whose rows end in front of row (tile + 1) H / n, rounded down
    for (int y = 0; y <= pixel.y; ++y)
        while ((tile + 1) * size.y / n <= y) ++tile;
    return static_cast<std::size_t>(tile);
}

/// Any triangle around a picture: from a fraction of a pixel to far larger than it.
ScreenTriangle any_triangle(std::mt19937& random, ivec2 size) {
    std::uniform_real_distribution<float> any(-1, 1), power(-2, 3);
    const float extent = std::pow(10.0f, power(random));
    const auto coordinate = [&](int side) {
        return 0.5f * static_cast<float>(side) * (1 + 1.2f * any(random));
    };
    const float x = coordinate(size.x), y = coordinate(size.y);
    const auto vertex = [&] {
        const float dx = any(random), dy = any(random);
        return vec2(x, y) + extent * vec2(dx, dy);
    };
    const vec2 a = vertex(), b = vertex(), c = vertex();
    return snap_triangle(a, b, c);
}

}  // namespace

TEST(Threading, Eq10_3_NoWorkerHasTwoRowsMoreThanAnother) {
    // The worked example: 1080 rows, 7 workers.
    const Tiling tiling(Split::rows, {1920, 1080}, 7, 64);
    ASSERT_EQ(tiling.count(), 7u);
    constexpr std::array first_rows = {0, 154, 308, 462, 617, 771, 925, 1080};
    for (std::size_t i = 0; i < 7; ++i) {
        const std::string where = numbered(i, tiling) + ", of 1080 rows";
        ASSERT_EQ(tiling[i].box.first, ivec2(0, first_rows.at(i))) << "first pixel of " << where;
        ASSERT_EQ(tiling[i].box.last, ivec2(1919, first_rows.at(i + 1) - 1))
            << "last pixel of " << where;
        ASSERT_EQ(tiling[i].row_step, 1) << where;
    }
}

TEST(Threading, Eq10_4_InterleavedRowsGoRound) {
    const Tiling tiling(Split::interleaved, {5, 10}, 4, 64);
    ASSERT_EQ(tiling.count(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        std::vector<int> rows;
        for_each_strip(tiling[i], [&](const PixelBox& strip) {
            EXPECT_EQ(strip.first.x, 0);
            EXPECT_EQ(strip.last, ivec2(4, strip.first.y))
                << "the last pixel of a strip of " << numbered(i, tiling)
                << ", interleaved rows of a picture of 5 x 10: it is one row, which begins at "
                << testing::PrintToString(strip.first);
            rows.push_back(strip.first.y);
        });
        const int first = static_cast<int>(i);
        ASSERT_EQ(rows, i < 2 ? (std::vector{first, first + 4, first + 8})
                              : (std::vector{first, first + 4}))
            << "rows of " << numbered(i, tiling) << ", of 10 rows";
    }
}

TEST(Threading, Eq10_5_TilesOfTheWorkedExample) {
    const Tiling tiling(Split::tiles, {1920, 1080}, 7, 64);
    ASSERT_EQ(tiling.count(), 30u * 17u)
        << "tiles of 64 x 64 in 1920 x 1080 pixels: 30 columns, and 17 rows with the last in part";
    EXPECT_EQ(tiling[1].box.first, ivec2(64, 0)) << "tile 1 is on the right of tile 0";
    EXPECT_EQ(tiling[31].box.first, ivec2(64, 64)) << "tile 31 of 30 columns: column 1, row 1";
    EXPECT_EQ(tiling[31].box.last, ivec2(127, 127)) << "tile 31: the last pixel is its own";
    EXPECT_EQ(tiling[509].box.first, ivec2(1856, 1024)) << "the last tile";
    EXPECT_EQ(tiling[509].box.last, ivec2(1919, 1079)) << "the last row of tiles is 56 pixels high";
}

TEST(Threading, HardCase_EachPixelIsInOneTile) {
    look_up("Eq. 10.5");
    for (const ivec2 size : {ivec2(1, 1), {1, 9}, {9, 1}, {64, 64}, {65, 63}, {33, 130}, {3, 1021}})
        for (const int workers : thread_counts)
            for (const Split split : splits)
                for (const int side : {1, 2, 8, 63, 64, 1000}) {
                    const Tiling tiling(split, size, static_cast<std::size_t>(workers), side);
                    const std::string where = named(size, split, workers, side);
                    int pixels = 0;
                    for (std::size_t i = 0; i < tiling.count(); ++i)
                        for_each_strip(tiling[i], [&](const PixelBox& strip) {
                            for (int y = strip.first.y; y <= strip.last.y; ++y)
                                for (int x = strip.first.x; x <= strip.last.x; ++x, ++pixels) {
                                    ASSERT_TRUE(x >= 0 && y >= 0 && x < size.x && y < size.y)
                                        << "tile " << i << " has (" << x << ", " << y << "), "
                                        << where;
                                    ASSERT_EQ(i, tile_of({x, y}, split, size, workers, side))
                                        << "the tile of (" << x << ", " << y << "), " << where;
                                }
                        });
                    ASSERT_FALSE(HasFatalFailure());
                    ASSERT_EQ(pixels, size.x * size.y) << "pixels of all tiles, " << where;
                }
}

TEST(Threading, HardCase_MoreWorkersThanRowsOrTiles) {
    look_up("Eq. 10.3");
    for (const Split split : splits) {
        const std::size_t tiles = split == Split::tiles ? 2 : 3;
        EXPECT_EQ(Tiling(split, {100, 3}, 61, 64).count(), tiles)
            << name_of(split) << " of a picture of 100 x 3, 61 workers";
        for (const ivec2 size : {ivec2(0), ivec2(0, 5), ivec2(5, 0)}) {
            const Tiling none(split, size, 4, 64);
            EXPECT_EQ(none.count(), 0u) << "no pixels, no tiles";
            none.for_each_in({{0, 0}, {5, 5}}, [](std::size_t) { ADD_FAILURE(); });
        }
    }
}

TEST(Threading, Eq10_6_ATriangleIsListedInJustTheTilesThatItsBoxMeets) {
    const auto tiles_met = [](const Tiling& tiling, const PixelBox& box) {
        std::vector<std::size_t> met;
        tiling.for_each_in(box, [&](std::size_t tile) { met.push_back(tile); });
        std::ranges::sort(met);
        return met;
    };
    // The worked example: a box of pixels from (100, 50) to (130, 70) meets four tiles.
    EXPECT_EQ(tiles_met(Tiling(Split::tiles, {1920, 1080}, 4, 64), {{100, 50}, {130, 70}}),
              (std::vector<std::size_t>{1, 2, 31, 32}))
        << "tiles of 64 x 64, 30 a row, that a box from (100, 50) to (130, 70) meets";

    // Of a triangle: the pixels whose centres lie in its box.
    const PixelBox known =
        box_around(snap_triangle({1.25f, 2.75f}, {4.75f, 2.75f}, {1.25f, 5.25f}));
    const char* const what =
        " pixel of the triangle (1.25, 2.75), (4.75, 2.75), (1.25, 5.25): centres lie at 1/2";
    EXPECT_EQ(known.first, ivec2(1, 3)) << "the first" << what;
    EXPECT_EQ(known.last, ivec2(4, 4)) << "the last" << what;

    std::mt19937 random(1);
    const ivec2 size(70, 50);
    for (int k = 0; k < 2000; ++k) {
        const auto [first, last] = box_around(any_triangle(random, size));
        const Split split = splits[random() % 3];
        const int workers = thread_counts[random() % thread_counts.size()];
        const int side = 1 + static_cast<int>(random() % 40);
        std::set<std::size_t> expected;
        for (int y = std::max(first.y, 0); y <= std::min(last.y, size.y - 1); ++y)
            for (int x = std::max(first.x, 0); x <= std::min(last.x, size.x - 1); ++x)
                expected.insert(tile_of({x, y}, split, size, workers, side));
        ASSERT_EQ(
            tiles_met(Tiling(split, size, static_cast<std::size_t>(workers), side), {first, last}),
            std::vector(expected.begin(), expected.end()))
            << "tiles that the box from " << testing::PrintToString(first) << " to "
            << testing::PrintToString(last) << " meets in " << named(size, split, workers, side)
            << " (seed 1, " << k << ")";
    }
}

TEST(Threading, Eq10_7_TilesTogetherAreTheWholeTriangleBitForBit) {
    std::mt19937 random(2);
    const ivec2 size(150, 90);
    long pixels = 0;
    for (int k = 0; k < 3000; ++k) {
        const ScreenTriangle triangle = any_triangle(random, size);
        const Split split = splits[static_cast<std::size_t>(k) % 3];
        const int workers = thread_counts[random() % thread_counts.size()];
        const int side = 1 + static_cast<int>(random() % 80);
        const std::string where = "the triangle " + testing::PrintToString(triangle.vertices) +
                                  " in 1/256 pixel, " + named(size, split, workers, side) +
                                  " (seed 2, " + std::to_string(k) + ")";
        Image<vec3> left(size, vec3(-1));
        long pixels_left = 0;
        fill_triangle(triangle, size, [&](ivec2 pixel, vec3 barycentrics) {
            left[pixel] = barycentrics;
            ++pixels_left, ++pixels;
        });
        const Tiling tiling(split, size, static_cast<std::size_t>(workers), side);
        for (std::size_t i = 0; i < tiling.count(); ++i)
            fill_tile(triangle, tiling[i], [&](ivec2 pixel, vec3 barycentrics) {
                ASSERT_EQ(barycentrics, left[pixel])
                    << "as fill_tile() and as fill_triangle() have it; -1 where it is drawn twice, "
                    << "or not the triangle's: at the pixel " << testing::PrintToString(pixel)
                    << ", in " << numbered(i, tiling) << " of " << where;
                left[pixel] = vec3(-1);
                --pixels_left;
            });
        ASSERT_FALSE(HasFatalFailure());
        ASSERT_EQ(pixels_left, 0) << "pixels that are in no tile, of " << where;
    }
    EXPECT_GT(pixels, 100000);
}

TEST(Threading, Eq10_1_NoScheduleIsShorterThanItsWorkOrItsLongestTask) {
    // The worked example: tasks of 4, 3, 2, 2 and 1.
    const std::array times = {4.0, 3.0, 2.0, 2.0, 1.0};
    EXPECT_EQ(schedule_of(times, 1).least(), 12) << "tasks of 4, 3, 2, 2, 1; one worker: all";
    EXPECT_EQ(schedule_of(times, 2).least(), 6) << "tasks of 4, 3, 2, 2, 1; two workers: half";
    EXPECT_EQ(schedule_of(times, 3).least(), 4) << "tasks of 4, 3, 2, 2, 1; three workers: the 4";
}

TEST(Threading, Eq10_2_WhatIsLeftToOneWorkerBoundsAll) {
    // The worked examples; in double, so within a few ulp of a rounded sum.
    EXPECT_NEAR(amdahl_speedup(0.1, 2), 1 / 0.55, 1e-15);
    EXPECT_NEAR(amdahl_speedup(0.1, 16), 6.4, 1e-14);
    EXPECT_EQ(amdahl_speedup(0, 16), 16);
    EXPECT_EQ(amdahl_speedup(1, 16), 1);
    EXPECT_LT(amdahl_speedup(0.1, 1000000), 10);
}

TEST(Threading, Eq10_8_EachTaskGoesToWhoeverIsFreeFirst) {
    // The worked example, and the same tasks with the shortest first.
    EXPECT_EQ(schedule_of(std::array{4.0, 3.0, 2.0, 2.0, 1.0}, 2).finish, 6)
        << "tasks of 4, 3, 2, 2, 1, two workers";
    EXPECT_EQ(schedule_of(std::array{1.0, 2.0, 2.0, 3.0, 4.0}, 2).finish, 7)
        << "tasks of 1, 2, 2, 3, 4, two workers";
    EXPECT_EQ(schedule_of(std::array{9.0, 1.0, 2.0, 3.0}, 3).finish, 9)
        << "tasks of 9, 1, 2, 3, three workers: the first is the last to be done";
    EXPECT_EQ(schedule_of({}, 3).finish, 0) << "no tasks";
}

TEST(Threading, Eq10_9_TheBoundIsMet) {
    // The worked example: 12 tasks of 1, and one of 4 that comes last.
    std::vector<double> worst(12, 1);
    worst.push_back(4);
    const Schedule met = schedule_of(worst, 4);
    EXPECT_EQ(met.finish, 7) << "12 tasks of 1 and then one of 4; four workers";
    EXPECT_EQ(met.most(), 7) << "12 tasks of 1 and then one of 4; four workers: no less would hold";
}

TEST(Threading, Eq10_10_IdleShares) {
    // The worked examples.
    EXPECT_EQ(schedule_of(std::array{4.0, 3.0, 2.0, 2.0, 1.0}, 2).idle_share(), 0)
        << "tasks of 4, 3, 2, 2, 1, two workers";
    EXPECT_NEAR(schedule_of(std::array{1.0, 2.0, 2.0, 3.0, 4.0}, 2).idle_share(), 1.0 / 7, 1e-15)
        << "tasks of 1, 2, 2, 3, 4, two workers";
    EXPECT_EQ(schedule_of(std::array{5.0}, 4).idle_share(), 0.75) << "three have nothing to do";
    EXPECT_EQ(schedule_of({}, 4).idle_share(), 0);
    EXPECT_EQ(schedule_of(std::array{0.0, 0.0}, 4).idle_share(), 0);
}
