// SPDX-License-Identifier: MIT
/// @file
/// The vectors and matrices of the course: GLM's types under the conventions of
/// docs/conventions.md.
#pragma once

/// @cond
#define GLM_FORCE_UNRESTRICTED_GENTYPE  // vectors of any number type: Vec3<F>
/// @endcond
#include <glm/gtc/type_precision.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace rasterbook {

using glm::bvec2, glm::ivec2, glm::ivec3, glm::uvec3;
using glm::dmat3, glm::dmat4, glm::dvec2, glm::dvec3, glm::dvec4;
using glm::mat3, glm::mat4, glm::vec2, glm::vec3, glm::vec4;
using glm::u8vec3, glm::u8vec4;

/// Three numbers of a type F: float, or a struct of several floats (common/math/functions.hpp).
template <typename F>
using Vec3 = glm::vec<3, F>;

/// The 3x3 matrix with these rows, as it stands on paper. (GLM's own constructor takes columns.)
template <typename T>
constexpr glm::mat<3, 3, T> matrix_from_rows(glm::vec<3, T> row0, glm::vec<3, T> row1,
                                             glm::vec<3, T> row2) {
    return {row0.x, row1.x, row2.x, row0.y, row1.y, row2.y, row0.z, row1.z, row2.z};
}

/// The 4x4 matrix with these rows, as it stands on paper.
template <typename T>
constexpr glm::mat<4, 4, T> matrix_from_rows(glm::vec<4, T> row0, glm::vec<4, T> row1,
                                             glm::vec<4, T> row2, glm::vec<4, T> row3) {
    return {row0.x, row1.x, row2.x, row3.x, row0.y, row1.y, row2.y, row3.y,
            row0.z, row1.z, row2.z, row3.z, row0.w, row1.w, row2.w, row3.w};
}

/// In float, so that braces suffice: `matrix_from_rows({1, 0, 0, t.x}, ...)`.
constexpr mat4 matrix_from_rows(vec4 row0, vec4 row1, vec4 row2, vec4 row3) {
    return matrix_from_rows<float>(row0, row1, row2, row3);
}

/// In float, so that braces suffice.
constexpr mat3 matrix_from_rows(vec3 row0, vec3 row1, vec3 row2) {
    return matrix_from_rows<float>(row0, row1, row2);
}

}  // namespace rasterbook
