// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?": what `--probe` says of a pixel. Neither streams nor files, threads or
/// exceptions are used here, so that it works in a web page, too.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/image/image.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// Numbers as they are printed.
///
/// @param digits  Significant ones of a single number. Vectors have three behind the point.
std::string words(float number, int digits = 4);
std::string words(vec2 numbers);
std::string words(vec3 numbers);
std::string words(dvec3 numbers);
std::string words(ivec2 numbers);

/// "teapot #12 (copper)": the mesh, the triangle's number in it, from 0, and its material.
std::string name_of(const Mesh& mesh, const Triangle& triangle,
                    const std::vector<Material>& materials);

/// Text about a pixel, in sections of lines.
class PixelReport {
  public:
    void section(const std::string& title);

    /// A name, its value, and the equation that the value comes from, such as "Eq. 5.3".
    void line(const char* name, const std::string& value, const char* equation = "");
    void line(const char* name, float value, const char* equation = "");
    void line(const char* name, vec3 value, const char* equation = "");

    /// A line as it is.
    void text(const std::string& words);

    const std::string& all() const { return text_; }

  private:
    std::string text_;
};

/// What became of one triangle in a pixel, in words.
struct TriangleInPixel {
    std::string triangle, barycentrics, depth, fate;
    bool covers;  ///< The pixel's centre.
};

/// What became of the triangles of a picture in one pixel, in drawing order.
class PixelHistory {
  public:
    /// It does not cover the pixel's centre.
    void missed(const std::string& triangle, const std::string& why);

    /// It covers the pixel's centre, and its colour is not written there.
    ///
    /// @param barycentrics,depth  None where the lesson has none.
    void lost(const std::string& triangle, std::optional<vec3> barycentrics,
              std::optional<float> depth, const std::string& why);

    /// It is written over what was there before.
    void written(const std::string& triangle, std::optional<vec3> barycentrics,
                 std::optional<float> depth);

    void print(PixelReport& report, const std::string& title) const;

    /// @param meshes  All whose triangles might have been here.
    void print(PixelReport& report, const std::vector<Mesh>& meshes) const;

  private:
    std::vector<TriangleInPixel> entries_;
    std::optional<std::size_t> last_written_;  ///< Index into entries_.
};

/// Explains one pixel of what a lesson renders, and gives its colour, linear.
using PixelProbe = std::function<vec3(ivec2 pixel, PixelReport& report)>;

/// Explains a pixel of the picture.
///
/// @param pixel             From 0, 0, the upper left one.
/// @param samples_per_side  Of the picture: the pixel is the mean of their square.
/// @param drawn             What the picture has in this pixel.
/// @return  Lines of text; the last one is `drawn` as "#rrggbb".
std::string explained(const PixelProbe& probe, ivec2 pixel, int samples_per_side, u8vec3 drawn);

/// The colour that a probe finds for a pixel, as it is stored.
u8vec3 probed_color(const PixelProbe& probe, ivec2 pixel, int samples_per_side,
                    PixelReport& report);

}  // namespace rasterbook
