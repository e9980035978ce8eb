// SPDX-License-Identifier: MIT
/// @file
/// OpenGL on Mesa's software driver, without a window: a rasteriser that others wrote, to compare
/// with.
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "05_textures/texture.hpp"
#include "common/image/image.hpp"

namespace rasterbook::test {

struct OpenGlTriangle {
    std::array<vec4, 3> vertices_clip;
    std::array<vec2, 3> uv = {};
};

/// Which part of the plane is drawn.
struct OpenGlView {
    ivec2 size;           ///< Of the picture, in pixels.
    ivec2 viewport_size;  ///< Of the square that NDC from -1 to 1 fill, in pixels: up to 16384.
    ivec2 viewport_low;   ///< Its corner with the lowest coordinates, in the picture's pixels.

    explicit OpenGlView(ivec2 picture) : OpenGlView(picture, picture, ivec2(0)) {}
    OpenGlView(ivec2 picture, ivec2 viewport, ivec2 low)
        : size(picture), viewport_size(viewport), viewport_low(low) {}
};

struct OpenGlPicture {
    Image<vec4> color;   ///< What the fragment shader wrote; 0 where nothing was drawn.
    Image<float> depth;  ///< 0 to 1; 0 where nothing was drawn.
};

/// What shaders from files are given of a vertex: their attributes 0 to 3.
struct OpenGlVertex {
    vec3 position_world, normal_world;
    vec4 tangent_world;  ///< With handedness.
    vec2 uv;
};

/// What shaders are given by name.
struct OpenGlInputs {
    std::map<std::string, std::variant<float, vec3, mat3, mat4>> uniforms;
    /// Level 0 of textures, filtered linearly; or floats as they are, the first row as row 0.
    std::map<std::string, std::variant<const Texture*, const Image<float>*>> textures;
};

/// Triangles of one material.
struct OpenGlPart {
    std::uint32_t material;
    std::vector<OpenGlVertex> vertices{};  ///< Three for each triangle.
    OpenGlInputs inputs{};
};

/// The texts of a vertex shader and a fragment shader.
struct OpenGlShaders {
    std::string vertex, fragment;
};

/// A context without a display, made current.
///
/// Front faces alone are drawn, nearer ones over farther ones. Pictures have their first row at
/// the top. That is not a matter of turning them round after they are drawn: their rows would then
/// be right, but a pixel's centre on a horizontal side would belong to the triangle above it. So
/// the vertex shader or its matrix negates y, and what OpenGL takes for the bottom row is our top
/// one. (Seen that way round, front faces are clockwise.)
class OpenGl {
  public:
    // Shaders: a fragment's statements, from `vec2 uv` and `sampler2D levels` to `vec4 color`.
    // level() is the level at which the longer side of the pixel's footprint is a texel.

    /// 1 where the triangle is, then uv.
    static constexpr const char* coverage_and_uv = "color = vec4(1, uv, 0);";
    static constexpr const char* uv_and_level = "color = vec4(1, uv, level());";
    static constexpr const char* bilinear = "color = textureLod(levels, uv, 0.0);";
    static constexpr const char* trilinear = "color = textureLod(levels, uv, level());";

    /// @throw std::runtime_error  There is no such driver; says what to install.
    OpenGl();
    ~OpenGl();
    OpenGl(const OpenGl&) = delete;
    OpenGl& operator=(const OpenGl&) = delete;

    /// Uploads a texture, all of its levels as they are, to be filtered linearly.
    void set_texture(const Texture& texture);

    /// Draws all into one picture.
    OpenGlPicture draw(std::span<const OpenGlTriangle> triangles, const OpenGlView& view,
                       const std::string& shader = coverage_and_uv);

    /// Draws each triangle into a picture of its own.
    std::vector<OpenGlPicture> draw_each(std::span<const OpenGlTriangle> triangles,
                                         const OpenGlView& view,
                                         const std::string& shader = coverage_and_uv);

    /// Draws parts of a scene, one after the other, into one picture.
    ///
    /// @param shaders  That y is to be negated is not for them but for a matrix of the inputs.
    /// @param inputs   Of all parts.
    OpenGlPicture draw(std::span<const OpenGlPart> parts, ivec2 size, const OpenGlShaders& shaders,
                       const OpenGlInputs& inputs);

  private:
    std::vector<OpenGlPicture> draw_layers(std::span<const OpenGlTriangle> triangles,
                                           const OpenGlView& view, const std::string& shader,
                                           bool each_its_own);

    void* display_;
    void* context_ = nullptr;
    unsigned texture_ = 0;
};

/// Tests that need OpenGL: skipped where it is missing, or failing when RASTERBOOK_OPENGL_REQUIRED
/// is set.
class OpenGlTest : public testing::Test {
  protected:
    void SetUp() override {
        try {
            gl = std::make_unique<OpenGl>();
        } catch (const std::runtime_error& error) {
            if (std::getenv("RASTERBOOK_OPENGL_REQUIRED")) FAIL() << error.what();
            GTEST_SKIP() << error.what();
        }
    }

    std::unique_ptr<OpenGl> gl;
};

}  // namespace rasterbook::test
