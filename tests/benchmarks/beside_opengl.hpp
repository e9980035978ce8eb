// SPDX-License-Identifier: MIT
/// @file
/// What beside_opengl.cpp compares: a scene, drawn by a lesson and by OpenGL.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "04_mvp/camera.hpp"
#include "12_effects/effects_options.hpp"
#include "12_effects/planned_scene.hpp"
#include "common/image/image.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

using DrawFrame = std::function<Image<vec3>()>;

/// Draws a scene with a lesson's render(), shadow maps included: linear colors.
///
/// @param options  Of lesson 12; a lesson's further ones have their defaults.
/// @param assets   Have to outlive the result.
template <int lesson>
DrawFrame frame_of(const EffectsOptions& options, const PlannedScene& assets);

/// The scenes that are made for this comparison, and toon.glb.
struct BenchmarkScene {
    std::string name, what;
    std::function<Scene()> make;
};
std::vector<BenchmarkScene> benchmark_scenes();

/// In which numbers OpenGL stores textures and its picture.
enum class GlNumbers {
    floats,  ///< Linear floats, as the course: RGBA32F. Whoever shows the picture encodes it.
    bytes    ///< SRGB8_ALPHA8, with GL_FRAMEBUFFER_SRGB; normals and specular maps: RGBA8.
};

struct GlOptions {
    GlNumbers numbers = GlNumbers::floats;
    bool depth_first = false;  ///< All depths are drawn before anything is shaded.
};

/// A scene as OpenGL has it: uploaded and compiled once, to be drawn many times. The context frees
/// it at the end.
class GlScene {
  public:
    /// A context is current; support/opengl.hpp has made it.
    ///
    /// @param assets  Of a benchmark's scene: opaque, lit by directional lights, without specular
    ///                maps and vertex colors.
    GlScene(const PlannedScene& assets, const Camera& camera, const EffectsOptions& options,
            const GlOptions& gl);
    ~GlScene();

    /// Draws a frame, shadow maps included, and comes back when it is finished.
    void draw() const;

    /// The last frame, sRGB-encoded.
    Image<u8vec3> picture() const;

  private:
    struct Content;
    std::unique_ptr<Content> content_;
};

}  // namespace rasterbook
