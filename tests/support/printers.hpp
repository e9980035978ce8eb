// SPDX-License-Identifier: MIT
/// @file
/// How failing tests print vectors and matrices: (1, 2) instead of bytes. Include it before they
/// are compared.
#pragma once

#include <concepts>
#include <limits>
#include <ostream>
#include <sstream>
#include <string>

#include "common/math/types.hpp"

namespace rasterbook::test {

/// A number with as many digits as it takes to tell it from its neighbours: 0.5, 0.700000048.
template <typename Number>
std::string text_of(Number x) {
    std::ostringstream text;
    text << +x;
    if constexpr (std::floating_point<Number>)
        if (x == x && static_cast<Number>(std::stold(text.str())) != x) {
            text.str("");
            text.precision(std::numeric_limits<Number>::max_digits10);
            text << x;
        }
    return text.str();
}

}  // namespace rasterbook::test

namespace glm {

template <length_t n, typename T>
void PrintTo(const vec<n, T>& v, std::ostream* out) {
    for (length_t i = 0; i < n; ++i)
        *out << (i == 0 ? "(" : ", ") << rasterbook::test::text_of(v[i]);
    *out << ')';
}

/// Row by row, as on paper.
template <length_t columns, length_t rows, typename T>
void PrintTo(const mat<columns, rows, T>& m, std::ostream* out) {
    for (length_t row = 0; row < rows; ++row) {
        *out << (row == 0 ? "rows " : ", ");
        for (length_t column = 0; column < columns; ++column)
            *out << (column == 0 ? "(" : ", ") << rasterbook::test::text_of(m[column][row]);
        *out << ')';
    }
}

}  // namespace glm
