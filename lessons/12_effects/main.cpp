// SPDX-License-Identifier: MIT
/// @file
/// Lesson 12: only the effects that a scene calls for.
#include "06_phong/studio_lights.hpp"
#include "07_toon/toon_material.hpp"
#include "11_scenes/camera_choice.hpp"
#include "11_scenes/casters.hpp"
#include "11_scenes/opacity.hpp"
#include "11_scenes/passes.hpp"
#include "12_effects/effects_program.hpp"
#include "12_effects/permutation.hpp"

using namespace rasterbook;

static Image<vec3> render(const EffectsOptions& options, const PlannedScene& assets, Workers& pool,
                          StepClock& clock) {
    const Scene& scene = assets.scene;
    const Camera camera = camera_of_picture(options, scene).camera;
    const std::span<const Light> lights = assets.lit_by.lights;
    clock.begin("shadow maps");
    const ShadowMaps shadow_maps = draw_shadow_maps(pool, options, assets);
    Image<vec3> color(options.size, unset);
    DepthBuffer depth(options.size, unset, camera.farthest_depth());

    const auto draw = [&]<Permutation with>(const ProjectedTriangle& projected, const Tile& tile,
                                            TransparentFragments& transparent) {
        const TriangleSurface surface = triangle_surface(assets, projected);
        const VertexColors colors = vertex_colors(projected);
        const PerspectiveSetup setup = perspective_setup(projected);
        TriangleNormalMap normal_map;
        if constexpr (with.normal_map)
            normal_map = triangle_normal_map(scene, assets.normal_maps, projected);
        const bool is_masked = surface.effects[Effect::mask];
        ShadowBiasCache shadow_biases(surface.positions_world);

        fill_tile(projected.on_screen, tile, [&](ivec2 pixel, Barycentrics on_screen) {
            count(Counter::fragments_tested);
            const float z = projected.depth.at(on_screen);
            if (!is_nearer(depth, pixel, z)) return;
            const FragmentBarycentrics on_surface = perspective_correct(setup, on_screen);
            const vec4 in_texture = texture_sample(surface, on_surface, options.texture.filter);
            const float opacity = opacity_at(surface, colors, on_surface.here, in_texture);
            if (is_hole(surface, opacity)) return;
            count(Counter::fragments_shaded);
            const auto write = [&](vec3 shaded) {
                if (surface.effects[Effect::blend]) {
                    transparent.add({pixel, z, is_masked ? 1 : opacity, shaded});
                    return;
                }
                depth.test_and_write(pixel, z);
                color[pixel] = shaded;
            };
            const SurfaceColor base_color = surface_color(surface, colors, on_surface,
                                                          vec3(in_texture), options.texture.filter);
            if constexpr (with.model == ShadingModel::unlit) return write(unlit(base_color));
            const vec3 smooth_normal = interpolate(surface.normals_world, on_surface.here);
            vec3 normal = smooth_normal;
            if constexpr (with.normal_map)
                normal =
                    normal_mapped(normal_map, on_surface, smooth_normal, options.texture.filter);
            const SurfacePoint<float> point =
                surface_point(surface, on_surface.here, normal, camera.position_world);
            const auto visibility = [&](std::size_t light) {
                if constexpr (!with.shadow) return 1.0f;
                return light_visibility(shadow_maps, light, shadow_biases, point.position_world,
                                        smooth_normal);
            };
            if constexpr (with.model == ShadingModel::toon)
                return write(toon_color(base_color, lights, point.position_world, normal,
                                        *surface.material.toon, visibility));
            const ReflectedLight reflected =
                reflected_light(lights, point, highlight_of(surface), visibility);
            write(phong(base_color, ambient_light, reflected));
        });
    };
    clock.begin("triangles");
    const Tiling tiling = options.threads.tiling_of(options.size, pool.size());
    const BinnedPasses triangles(pool, assets, camera, tiling);

    clock.begin("picture");
    const Shaders shaders(draw, assets.effects);
    pool.run(tiling.count(), [&](std::size_t i, std::size_t worker) {
        const Tile tile = tiling[i];
        clear_tile(assets, color, depth, tile);
        TransparentFragments transparent;
        triangles.for_each_opaque_in(
            i, [&](const ProjectedTriangle& projected) { shaders(projected, tile, transparent); });
        for_each_part(tile, triangles.count_blended_in(i), [&](const Tile& part) {
            triangles.for_each_blended_in(i, [&](const ProjectedTriangle& projected) {
                shaders(projected, part, transparent);
            });
            transparent.blend_over(color);
        });
        if (options.threads.show) tint(color, tile, worker);
    });
    if (options.show_depth) return depth_picture(depth);
    return color;
}

int main(int argc, char** argv) {
    return run_effects_lesson<EffectsOptions>(
        argc, argv, "12_effects", "Draws a scene of any file, and only what it calls for.", render);
}
