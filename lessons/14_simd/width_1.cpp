// SPDX-License-Identifier: MIT
#include "14_simd/wide_shading.hpp"

template rasterbook::WideDrawing rasterbook::drawing_of_width<1>();
