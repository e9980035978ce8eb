// SPDX-License-Identifier: MIT
#include "11_scenes/probe.hpp"

#include <algorithm>
#include <array>
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
#include "11_scenes/blending.hpp"
#include "11_scenes/scene_camera.hpp"
#include "11_scenes/shaders.hpp"

namespace rasterbook {

namespace {

/// A transparent fragment, and where it comes from.
struct SeenThrough {
    SeenFragment seen;
    TransparentFragment fragment;
};

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
void report_stages(PixelReport& report, const Frame<>& frame, const Permutation& with,
                   TriangleInputs& inputs, const SeenFragment& seen) {
    NoCounters uncounted;
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
    const vec3 normal =
        report_normal(report, inputs.normal_map, frame.normal_map, at, own_normal, frame.filter);
    const SurfacePoint<float> point =
        surface_point(surface, at.here, normal, frame.eye_world, uncounted);
    report_point(report, point);
    const std::span<const Light> lights = frame.assets.lit_by.lights;
    const auto said_visibility = [&](std::size_t l) {
        return with.shadow ? report_visibility(report, frame.shadow_maps, l, inputs.receiver,
                                               point.position_world, own_normal)
                           : 1.0f;
    };
    const auto visibility = [&](std::size_t l) {
        return with.shadow ? light_visibility(frame.shadow_maps, l, inputs.receiver,
                                              point.position_world, own_normal, uncounted)
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

/// The colour of a fragment.
///
/// @param report  Null: nothing is said.
template <Permutation with>
vec3 shaded_with(const Frame<>& frame, const SeenFragment& seen, PixelReport* report) {
    NoCounters uncounted;
    TriangleInputs inputs = triangle_inputs<with>(frame, *seen.projected);
    if (report != nullptr) report_stages(*report, frame, with, inputs, seen);
    return shaded<with>(frame, inputs, perspective_correct(inputs.setup, seen.on_screen),
                        uncounted);
}

vec3 shaded_color(const Frame<>& frame, const SeenFragment& seen, PixelReport* report) {
    constexpr auto shaders = []<std::size_t... i>(std::index_sequence<i...>) {
        return std::array{&shaded_with<all_permutations[i]>...};
    }(std::make_index_sequence<all_permutations.size()>());
    const MaterialPlan& plan = frame.assets.plan.materials[seen.projected->triangle.material];
    return shaders[permutation_of(plan)](frame, seen, report);
}

/// The opacity of a fragment, by lesson 11's way to it: 1 where it is neither glass nor has holes.
float opacity_of(const Frame<>& frame, const SeenFragment& seen) {
    const MaterialPlan& plan = frame.assets.plan.materials[seen.projected->triangle.material];
    if (!plan.is_glass && !plan[Effect::mask]) return 1;
    NoCounters uncounted;
    const TriangleInputs inputs = triangle_inputs<Permutation{}>(frame, *seen.projected);
    return opacity_at(inputs.surface, inputs.colors,
                      perspective_correct(inputs.setup, seen.on_screen), frame.filter, uncounted);
}

class SceneProbe {
  public:
    SceneProbe(const SceneRendererOptions& options, const SceneAssets& assets)
        : options_(options),
          assets_(assets),
          camera_(camera_of_picture(options, options.scene.camera, assets.scene).camera),
          outlines_(outlines_of(assets, camera_)) {
        NoCounters uncounted;
        const Scene& scene = assets.scene;
        const auto casts = [&](std::size_t material) {
            return casts_shadows(scene.materials[material]);
        };
        shadow_maps_ =
            draw_shadow_maps(options.shadow, options.shading.all_effects, scene,
                             assets.shadow_bounds, assets.lit_by.lights, assets.lit_by.casts,
                             uncounted, [&](ShadowMap& map, bool is_drawn) {
                                 map.depths.clear(ivec2(0), map.depths.depths().size() - 1);
                                 for (const Mesh& mesh : scene.meshes)
                                     if (is_drawn) draw_casters(map, mesh, casts, uncounted);
                             });
        const mat4 clip_from_world = camera_.clip_from_world(options.size);
        const std::vector<const Mesh*> meshes =
            seen_meshes(scene, outlines_, clip_from_world, uncounted);
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
        Image<vec3> color(
            ivec2(1), assets_.is_on_paper ? paper_color : backdrop_color(pixel.y, options_.size.y));
        DepthBuffer nearest(ivec2(1));
        const Frame<> frame = make_frame(options_, assets_, camera_, shadow_maps_, color, nearest);
        PixelHistory history;
        std::optional<SeenFragment> seen;
        std::vector<SeenThrough> transparent;
        for_each_here(opaque_, pixel, frame, history, [&](const SeenFragment& of, float) {
            test_depth(nearest, name(of), of.on_screen, of.depth, history);
            seen = of;
        });
        for_each_here(blended_, pixel, frame, history, [&](const SeenFragment& of, float opacity) {
            history.lost(
                name(of), of.on_screen, of.depth,
                "blended over what lies behind, opacity " + words(opacity) + " (Eq. 11.7)");
            transparent.push_back({of, {ivec2(0), of.depth, opacity, vec3(0)}});
        });
        history.print(report, assets_.scene.meshes);
        if (seen) {
            report_fragment(report, *seen, assets_.scene);
            color[ivec2(0)] = shaded_color(frame, *seen, &report);
        } else {
            report.section(assets_.is_on_paper ? "behind: the paper" : "behind: the backdrop");
        }
        if (!transparent.empty()) blend(report, frame, transparent, color);
        return color[ivec2(0)];
    }

  private:
    std::string name(const SeenFragment& of) const { return name_of(*of.projected, assets_.scene); }

    /// Notes why triangles are not drawn in a pixel, and visits the others.
    ///
    /// @param visit  Called as visit(SeenFragment, opacity).
    template <typename Visit>
    void for_each_here(std::span<const ProjectedTriangle> triangles, ivec2 pixel,
                       const Frame<>& frame, PixelHistory& history, const Visit& visit) const {
        for (const ProjectedTriangle& projected : triangles) {
            if (!box_holds(projected.on_screen, pixel)) continue;
            const MaterialPlan& plan = assets_.plan.materials[projected.triangle.material];
            const auto at = covered(projected.on_screen, pixel);
            if (!at) {
                history.missed(name_of(projected, assets_.scene),
                               why_not_covered(projected.on_screen, pixel));
                continue;
            }
            const SeenFragment of{&projected, *at, projected.depth.at(*at)};
            const auto lost = [&](const std::string& why) {
                history.lost(name(of), *at, of.depth, why);
            };
            const float before = frame.depth.depths()[ivec2(0)];
            if (projected.is_back_facing && !plan.two_sided) {
                lost("faces away (Eq. 2.2)");
            } else if (!(of.depth < before)) {
                lost("behind: not nearer than " + words(before, 7) + " (Eq. 3.1)");
            } else {
                const float opacity = opacity_of(frame, of);
                const float cutoff =
                    assets_.scene.materials[projected.triangle.material].alpha_cutoff;
                if (plan[Effect::mask] && !passes_alpha_test(opacity, cutoff))
                    lost("a hole: alpha " + words(opacity) + " is below " + words(cutoff) +
                         " (Eq. 11.7)");
                else
                    visit(of, plan[Effect::mask] ? 1.0f : opacity);
            }
        }
    }

    /// Shades transparent fragments, and blends them over what lies behind.
    void blend(PixelReport& report, const Frame<>& frame, std::span<SeenThrough> transparent,
               Image<vec3>& color) const {
        std::vector<std::size_t> order(transparent.size());  // from back to front
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
            return std::pair(transparent[b].fragment.depth, b) <
                   std::pair(transparent[a].fragment.depth, a);
        });
        // What lies on top is said in full.
        report.section("seen through, the nearest: " + name(transparent[order.back()].seen));
        TransparentFragments fragments;
        for (std::size_t i = 0; i < transparent.size(); ++i) {
            auto& [of, fragment] = transparent[i];
            fragment.color = shaded_color(frame, of, i == order.back() ? &report : nullptr);
            fragments.add(fragment);
        }
        report.section("blended from back to front (Eq. 11.8 and 11.9)");
        vec3 behind = color[ivec2(0)];
        report.line("behind", behind);
        for (const std::size_t i : order) {
            const TransparentFragment& fragment = transparent[i].fragment;
            behind = over(fragment.color, fragment.opacity, behind);
            report.line("over it", words(fragment.color) + ", opacity " + words(fragment.opacity) +
                                       ": gives " + words(behind));
        }
        fragments.blend_over(color);
    }

    const SceneRendererOptions& options_;
    const SceneAssets& assets_;
    Camera camera_;
    std::vector<Mesh> outlines_;
    ShadowMaps shadow_maps_{};
    std::vector<ProjectedTriangle> opaque_, blended_;  ///< In drawing order.
};

}  // namespace

PixelProbe scene_probe(const SceneRendererOptions& options, const SceneAssets& assets) {
    const auto probe = std::make_shared<const SceneProbe>(options, assets);
    return [probe](ivec2 pixel, PixelReport& report) { return (*probe)(pixel, report); };
}

}  // namespace rasterbook
