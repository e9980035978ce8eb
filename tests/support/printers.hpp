// SPDX-License-Identifier: MIT
/// @file
/// How failing tests print vectors: (1, 2) instead of bytes. Include it before they are compared.
#pragma once

#include <ostream>

#include "common/math/types.hpp"

namespace glm {

template <length_t n, typename T>
void PrintTo(const vec<n, T>& v, std::ostream* out) {
    for (length_t i = 0; i < n; ++i) *out << (i == 0 ? "(" : ", ") << +v[i];
    *out << ')';
}

}  // namespace glm
