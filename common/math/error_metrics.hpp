// SPDX-License-Identifier: MIT
/// @file
/// One number for how far a result is from its reference.
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

#include "common/math/types.hpp"

namespace rasterbook {

/// The greatest absolute difference of two lists of equal length; NaN when any difference is NaN.
inline double greatest_error(std::span<const float> actual, std::span<const float> reference) {
    assert(actual.size() == reference.size() && "one reference for each value");
    double greatest = 0;
    for (std::size_t i = 0; i < actual.size(); ++i) {
        const double error = std::abs(double{actual[i]} - double{reference[i]});
        if (std::isnan(error)) return error;
        greatest = std::max(greatest, error);
    }
    return greatest;
}

/// The root of the mean squared difference of two lists of equal length; 0 for empty ones.
inline double root_mean_square_error(std::span<const float> actual,
                                     std::span<const float> reference) {
    assert(actual.size() == reference.size() && "one reference for each value");
    if (actual.empty()) return 0;
    double sum = 0;
    for (std::size_t i = 0; i < actual.size(); ++i) {
        const double error = double{actual[i]} - double{reference[i]};
        sum += error * error;
    }
    return std::sqrt(sum / static_cast<double>(actual.size()));
}

/// Peak signal-to-noise ratio in decibels of a root mean square error; infinite for no error.
///
/// @param peak  The greatest value that a signal can have: 1 for linear colour, 255 for bytes.
inline double peak_signal_to_noise_decibels(double rms_error, double peak = 1.0) {
    return rms_error == 0 ? std::numeric_limits<double>::infinity()
                          : 20 * std::log10(peak / rms_error);
}

/// The angle between two directions, 0 to pi; accurate for small angles too, where acos is not.
///
/// @param a,b  Any length but 0.
inline double angle_radians(vec3 a, vec3 b) {
    const dvec3 u(a), v(b);
    return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

}  // namespace rasterbook
