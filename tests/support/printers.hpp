// SPDX-License-Identifier: MIT
/// @file
/// How failing tests print vectors and matrices: (1, 2) instead of bytes. Include it before they
/// are compared.
#pragma once

#include <charconv>
#include <ostream>
#include <string>

#include "common/math/types.hpp"

namespace rasterbook::test {

/// A number with as few digits as tell it from its neighbours.
template <typename Number>
std::string text_of(Number x) {
    char text[64];
    return {text, std::to_chars(text, text + sizeof text, +x).ptr};
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
