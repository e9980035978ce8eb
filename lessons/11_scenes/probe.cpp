// SPDX-License-Identifier: MIT
#include "11_scenes/probe.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "04_mvp/probe.hpp"
#include "06_phong/report.hpp"
#include "08_normal_maps/report.hpp"
#include "09_shadow_maps/report.hpp"
#include "10_threading/thread_pool.hpp"
#include "11_scenes/blending.hpp"
#include "11_scenes/casters.hpp"
#include "11_scenes/scene_camera.hpp"
#include "11_scenes/shaders.hpp"

namespace rasterbook {

namespace {

/// A fragment, and what the shader of its material makes of it.
struct DrawnFragment {
    SeenFragment seen;
    TransparentFragment drawn;  ///< Where it is opaque, its opacity is 1.
};

const MaterialPlan& plan_of(const Frame<>& frame, const SeenFragment& of) {
    return frame.assets.plan.materials[of.projected->triangle.material];
}

/// Says how much light falls on a toon material.
template <typename Visibility>
void report_toon(PixelReport& report, std::span<const Light> lights,
                 const SurfacePoint<float>& point, const SurfaceColor& color,
                 const ToonMaterial& look, const Visibility& visibility) {
    for (std::size_t l = 0; l < lights.size(); ++l) {
        const Incoming<float> incoming = incoming_light(lights[l], point.position_world);
        const float cosine = glm::dot(point.normal_world, incoming.toward);
        report.line(("light " + std::to_string(l + 1)).c_str(), incoming.color);
        report.line("  cosine", cosine, "Eq. 6.1");
        report.line("  step", toon_step(cosine, look), "Eq. 11.4");
        visibility(l);
    }
    report.line("shade", color.ambient);
    report.line("lit", color.diffuse);
}

/// Says what the stages of a shader make of a fragment.
void report_stages(PixelReport& report, const Frame<>& frame, const SeenFragment& seen) {
    const Permutation& with = all_permutations[permutation_of(plan_of(frame, seen))];
    TriangleInputs inputs = triangle_inputs(with, frame, *seen.projected);
    auto [surface, at, color] = report_surface(report, seen, inputs.surface, frame.filter);
    if (inputs.colors.are_there) {
        const vec3 of_vertices(inputs.colors.at(at.here));
        report.line("colour of vertices", of_vertices, "Eq. 11.10");
        color.tint(of_vertices);
    }
    if (with.model == ShadingModel::unlit) {
        report_unlit(report, color);
        return;
    }
    const vec3 own_normal = interpolate(surface.normals_world, at.here);
    const vec3 normal = report_normal(report, inputs.normal_map, at, own_normal, frame.filter);
    const SurfacePoint<float> point = surface_point(surface, at.here, normal, frame.eye_world);
    report_point(report, point, frame.assets.scene.origin);
    const std::span<const Light> lights = frame.assets.lit_by.lights;
    const auto said_visibility = [&](std::size_t l) {
        return with.shadow ? report_visibility(report, frame.shadow_maps, l, inputs.shadow_biases,
                                               point.position_world, own_normal)
                           : 1.0f;
    };
    const auto visibility = [&](std::size_t l) {
        return with.shadow ? light_visibility(frame.shadow_maps, l, inputs.shadow_biases,
                                              point.position_world, own_normal)
                           : 1.0f;
    };
    if (with.model == ShadingModel::phong) {
        const PhongHighlight highlight = highlight_of(surface);
        report_lights(report, lights, point, highlight, said_visibility);
        report_phong(report, color, ambient_light,
                     reflected_light(lights, point, highlight, visibility));
    } else {
        const ToonMaterial& look = *surface.material.toon;
        report_toon(report, lights, point, color, look, said_visibility);
        report.line("level", toon_level(lights, point.position_world, normal, look, visibility),
                    "Eq. 11.5");
    }
}

/// What a shader makes of a triangle in a pixel where nothing else is.
///
/// @return  None in a hole.
std::optional<TransparentFragment> draw_alone(const Frame<>& frame, const Shaders& shaders,
                                              ivec2 pixel, const SeenFragment& of) {
    TransparentFragments transparent;
    frame.depth.clear(pixel, pixel);
    shaders[of.projected->triangle.material](frame, *of.projected, Tile{{pixel, pixel}},
                                             transparent);
    if (!transparent.empty()) return transparent.fragments().front();
    if (frame.depth.depths()[pixel] == frame.depth.farthest()) return {};
    return TransparentFragment{pixel, of.depth, 1, frame.color[pixel]};
}

/// The alpha of a fragment, which decides whether there is a hole.
float alpha_of(const Frame<>& frame, const SeenFragment& of) {
    const AlphaInputs inputs = alpha_inputs(frame.assets, *of.projected);
    const FragmentBarycentrics at = perspective_correct(inputs.setup, of.on_screen);
    return opacity_at(inputs.surface, inputs.colors, at.here,
                      texture_sample(inputs.surface, at, frame.filter));
}

class SceneProbe {
  public:
    SceneProbe(const SceneRendererOptions& options, const SceneAssets& assets)
        : options_(options),
          assets_(assets),
          camera_(camera_of_picture(options, assets.scene).camera),
          outlines_(outlines_of(assets, camera_)),
          shaders_(assets.plan) {
        const Scene& scene = assets.scene;
        ThreadPool pool(1);
        shadow_maps_ = draw_shadow_maps(pool, options, assets);
        const mat4 clip_from_world = camera_.clip_from_world(options.size);
        const std::vector<const Mesh*> meshes = seen_meshes(scene, outlines_, clip_from_world);
        for (const Pass& pass : passes_of(assets.plan, meshes))
            for (const Mesh* mesh : pass.meshes) {
                const std::vector<vec4> positions = transform(clip_from_world, mesh->positions);
                for (const Triangle& triangle : mesh->triangles)
                    if (pass.takes(assets.plan.materials[triangle.material]))
                        for (const ClippedTriangle& clipped :
                             clip_triangle(vertices_of(triangle, positions)))
                            (pass.is_blended ? blended_ : opaque_)
                                .push_back(project(*mesh, triangle, clipped, options.size));
            }
    }

    vec3 operator()(ivec2 pixel, PixelReport& report) const {
        Image<vec3> picture(options_.size, unset);  // but for one pixel, nobody looks at them
        DepthBuffer depth(options_.size, unset, camera_.farthest_depth());
        const Frame<> frame = make_frame(options_, assets_, camera_, shadow_maps_, picture, depth);
        DepthBuffer nearest(ivec2(1), camera_.farthest_depth());
        PixelHistory history;
        std::optional<DrawnFragment> seen;
        std::vector<DrawnFragment> transparent;
        for (const ProjectedTriangle& projected : opaque_) {
            const auto of = drawn_here(projected, pixel, frame, nearest, history);
            if (!of) continue;
            test_depth(nearest, name(of->seen), of->seen.on_screen, of->seen.depth, history);
            seen = of;
        }
        for (const ProjectedTriangle& projected : blended_) {
            const auto of = drawn_here(projected, pixel, frame, nearest, history);
            if (!of) continue;
            history.lost(name(of->seen), of->seen.on_screen, of->seen.depth,
                         "blended over what lies behind, opacity " + words(of->drawn.opacity) +
                             " (Eq. 11.7)");
            transparent.push_back(*of);
        }
        history.print(report, assets_.scene.meshes);
        vec3 color = assets_.is_on_paper ? paper_color : backdrop_color(pixel.y, options_.size.y);
        if (seen) {
            report_fragment(report, seen->seen, assets_.scene);
            report_stages(report, frame, seen->seen);
            color = seen->drawn.color;
        } else {
            report.section(assets_.is_on_paper ? "behind: the paper" : "behind: the backdrop");
        }
        if (transparent.empty()) return color;
        picture[pixel] = color;
        blend(report, frame, transparent, pixel);
        return picture[pixel];
    }

  private:
    std::string name(const SeenFragment& of) const { return name_of(*of.projected, assets_.scene); }

    /// What is drawn of a triangle in a pixel; nothing, and a note of why, where it is not.
    std::optional<DrawnFragment> drawn_here(const ProjectedTriangle& projected, ivec2 pixel,
                                            const Frame<>& frame, const DepthBuffer& nearest,
                                            PixelHistory& history) const {
        if (!box_holds(projected.on_screen, pixel)) return {};
        const auto at = covered(projected.on_screen, pixel);
        if (!at) {
            history.missed(name_of(projected, assets_.scene),
                           why_not_covered(projected.on_screen, pixel));
            return {};
        }
        const SeenFragment of{&projected, *at, projected.depth.at(*at)};
        const float before = nearest.depths()[ivec2(0)];
        const Material& material = assets_.scene.materials[projected.triangle.material];
        std::string why;
        if (projected.is_back_facing && !plan_of(frame, of).two_sided)
            why = "faces away (Eq. 2.2)";
        else if (!(of.depth > before))
            why = "behind: not nearer than " + words(before, 7) + " (Eq. 3.1)";
        else if (const auto drawn = draw_alone(frame, shaders_, pixel, of))
            return DrawnFragment{of, *drawn};
        else
            why = "a hole: alpha " + words(alpha_of(frame, of)) + " is below " +
                  words(material.alpha_cutoff) + " (Eq. 11.7)";
        history.lost(name(of), *at, of.depth, why);
        return {};
    }

    /// Blends transparent fragments over what lies behind.
    void blend(PixelReport& report, const Frame<>& frame,
               std::span<const DrawnFragment> transparent, ivec2 pixel) const {
        std::vector<std::size_t> order(transparent.size());  // from back to front
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return std::pair(transparent[b].seen.depth, b) <
                   std::pair(transparent[a].seen.depth, a);
        });
        const SeenFragment& on_top = transparent[order.back()].seen;
        report.section("seen through, the nearest: " + name(on_top));
        report_stages(report, frame, on_top);
        report.section("blended from back to front (Eq. 11.8 and 11.9)");
        vec3 behind = frame.color[pixel];
        report.line("behind", behind);
        for (const std::size_t i : order) {
            const TransparentFragment& drawn = transparent[i].drawn;
            behind = over(drawn.color, drawn.opacity, behind);
            report.line("over it", words(drawn.color) + ", opacity " + words(drawn.opacity) +
                                       ": gives " + words(behind));
        }
        TransparentFragments fragments;
        for (const DrawnFragment& of : transparent) fragments.add(of.drawn);
        fragments.blend_over(frame.color);
    }

    const SceneRendererOptions& options_;
    const SceneAssets& assets_;
    Camera camera_;
    std::vector<Mesh> outlines_;
    Shaders shaders_;
    ShadowMaps shadow_maps_{};
    std::vector<ProjectedTriangle> opaque_, blended_;  ///< In drawing order.
};

}  // namespace

PixelProbe scene_probe(const SceneRendererOptions& options, const SceneAssets& assets) {
    const auto probe = std::make_shared<const SceneProbe>(options, assets);
    return [probe](ivec2 pixel, PixelReport& report) { return (*probe)(pixel, report); };
}

}  // namespace rasterbook
