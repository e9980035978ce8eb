// SPDX-License-Identifier: MIT
/// @file
/// Memory for one frame after another.
#pragma once

#include <cstdlib>  // says whether the C library is glibc

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace rasterbook {

/// What is freed stays with the program: the pictures of a frame take the memory of the frame
/// before. Else the C library gives large blocks back, and the system clears each page anew when it
/// is asked for again. In other threads than the first one that holds for blocks below 64 MB. Does
/// nothing where the C library is not glibc.
inline void keep_freed_memory() {
#ifdef __GLIBC__
    constexpr int all = 1 << 30;
    mallopt(M_MMAP_THRESHOLD, all);  // blocks below this size are kept
    mallopt(M_TRIM_THRESHOLD, all);
#endif
}

}  // namespace rasterbook
