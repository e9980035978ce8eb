// SPDX-License-Identifier: MIT
/// @file
/// One way to draw a frame of lesson 11: the lesson's own, or a copy WITHOUT an effect. As
/// unused_effects_frame.cpp, but here most effects are compiled into some kernels and not into
/// others.
#include "benchmarks/unused_effects.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <syncstream>
#include <type_traits>
#include <utility>
#include <vector>

#include "11_scenes/finished_scene.hpp"
#include "11_scenes/kernels.hpp"

#define main inline lesson_main  // compiled only where it is called: nowhere
#include LESSON_MAIN
#undef main

namespace {

constexpr Without way = Without::WITHOUT;

constexpr bool has(Without effect) { return effect != way; }

/// What is left of a kernel; none where nobody calls it.
[[maybe_unused]] constexpr std::optional<KernelEffects> left_of(KernelEffects effects) {
    if (effects.look == Look::phong && !has(Without::light)) return {};
    if (effects.look == Look::toon && !has(Without::toon)) return {};
    effects.normal_map = effects.normal_map && has(Without::normal_map);
    effects.shadow = effects.shadow && has(Without::shadow);
    return effects;
}

/// What is left of a TriangleSurface with one of its two textures.
struct HalfSurface {
    static constexpr bool is_diffuse = has(Without::texture);

    const Material& material;
    Effects effects;
    const Texture* texture;
    std::array<vec2, 3> uvs;
    SurfaceColor own_color;

    HalfSurface(const LitScene& scene, const Mesh& mesh, const Triangle& triangle)
        : material(scene.materials[triangle.material]),
          effects(scene.effects[triangle.material]),
          texture((is_diffuse ? scene.diffuse_textures : scene.specular_textures)[triangle.material]
                      .get()),
          uvs(uvs_of(mesh, triangle, is_diffuse ? material.diffuse_map : material.specular_map)),
          own_color(surface_color(material)) {}

    template <typename CounterPolicy>
    std::array<SurfaceColor, most_points> colors(const ManyWeights& weights, Filter filter,
                                                 CounterPolicy& counters) const {
        std::array<SurfaceColor, most_points> colors;
        for (std::size_t i = 0; i < weights.count; ++i) colors[i] = own_color;
        if (is_diffuse ? effects.diffuse_map : effects.specular_map)
            sample_many(*texture, filter, uvs, weights, [&](std::size_t i, vec4 texel) {
                counters.add(Counter::texture_samples);
                if constexpr (is_diffuse)
                    colors[i].tint(vec3(texel));
                else
                    colors[i].specular *= vec3(texel);
            });
        return colors;
    }
};

constexpr bool has_all_textures = has(Without::texture) && has(Without::specular_map);

/// A Frame, and for each material a surface for TriangleLight to ask. It asks for the material
/// alone, and takes no HalfSurface.
struct CopyFrame : Frame {
    std::vector<TriangleSurface> for_light;
};

/// Shade, but what is left out is not compiled. Where one can see through nothing of it is left
/// out: the scenes have no such material, and their kernels are never called.
template <KernelEffects effects>
class CopyShade {
    static constexpr bool is_lit = effects.look != Look::unlit;
    static constexpr bool has_tints = effects.see_through || has(Without::vertex_colors);
    using Surface =
        std::conditional_t<effects.see_through || has_all_textures, TriangleSurface, HalfSurface>;

  public:
    CopyShade(const CopyFrame& frame, const ReadyTriangle& ready)
        : frame_(frame),
          surface(frame.scene, ready.mesh, ready.triangle),
          tints(frame.scene, ready.mesh, ready.triangle),
          toon_(frame.scene.materials[ready.triangle.material].toon),
          perspective_(ready.on_screen, ready.clipped),
          relief_(frame.normal_map, frame.scene, ready.mesh, ready.triangle, ready.is_back),
          light_(frame.shading, frame.scene.lit_by.lights, frame.eye_world, ready.mesh,
                 ready.triangle, ready.is_back, for_light(ready.triangle.material)),
          shadow_(frame.shadows, ready.mesh, ready.triangle) {
        if constexpr (effects.look == Look::toon) surface.own_color.ambient = toon_->shade;
    }

    template <typename CounterPolicy, typename Begin, typename Store>
    void operator()(const ManyFragments& fragments, CounterPolicy& counters, Begin&& begin,
                    Store&& store) {
        const ManyWeights weights = weights_of(fragments, perspective_);
        begin(weights);
        auto own = surface.colors(weights, frame_.filter, counters);
        if constexpr (has(Without::vertex_colors)) tints.tint(weights, own, counters);
        if constexpr (effects.look == Look::unlit) {
            for (std::size_t i = 0; i < fragments.count; ++i) store(i, unlit(own[i]));
        } else {
            BumpyPoints points;
            light_.add(weights, points, counters);
            if constexpr (effects.normal_map) relief_.add(weights, frame_.filter, points, counters);
            if constexpr (effects.shadow) shadow_.look_up(points, counters);
            if constexpr (effects.normal_map) relief_.tilt(points);
            if constexpr (effects.look == Look::phong) {
                compute(points);
                for (std::size_t i = 0; i < fragments.count; ++i)
                    store(i, phong(own[i], ambient_light, points.light(i)));
            } else {
                for (std::size_t i = 0; i < fragments.count; ++i) {
                    counters.add(Counter::toon_fragments);
                    store(i, own[i].emission +
                                 toon_paint(own[i].ambient, own[i].diffuse, level(points, i)));
                }
            }
        }
    }

  private:
    decltype(auto) for_light(std::size_t material) const {
        if constexpr (std::is_same_v<Surface, TriangleSurface>)
            return (surface);
        else
            return (frame_.for_light[material]);
    }

    void compute(BumpyPoints& points) {
        const auto share = [&]([[maybe_unused]] std::size_t l, [[maybe_unused]] std::size_t i) {
            if constexpr (effects.shadow)
                return shadow_(l, i);
            else
                return 1.0f;
        };
        if constexpr (!has(Without::highlight)) {
            if (reflect_light(
                    frame_.scene.lit_by.lights, frame_.eye_world, false, points,
                    [](float) { return 0.0f; }, share))
                return;
        }
        if constexpr (effects.shadow)
            light_.compute(points, shadow_);
        else
            light_.compute(points);
    }

    float level(const BumpyPoints& points, std::size_t i) const {
        return toon_level(frame_.scene.lit_by.lights, points.position_world[i],
                          points.normal_world[i], *toon_, [&]([[maybe_unused]] std::size_t l) {
                              if constexpr (effects.shadow)
                                  return shadow_(l, i);
                              else
                                  return 1.0f;
                          });
    }

    const CopyFrame& frame_;

  public:
    Surface surface;
    Only<has_tints, TriangleTints> tints;

  private:
    const std::optional<ToonLook>& toon_;
    PerspectiveWeights perspective_;
    Only<effects.normal_map, TriangleRelief> relief_;
    Only<is_lit, TriangleLight> light_;
    Only<effects.shadow, TriangleShadows> shadow_;
};

/// Takes the place of layers. The compiler looks at a call of add(), and leaves it out.
struct NoLayers {
    void add(const Layer&) {}
    void draw_over(Image<vec3>&) {}
};

using CopyLayers = std::conditional_t<has(Without::blend), Layers, NoLayers>;

template <KernelEffects effects, typename CounterPolicy>
void draw_copy_of_triangle(const CopyFrame& frame, const ReadyTriangle& ready, const Part& part,
                           [[maybe_unused]] CopyLayers& layers, CounterPolicy& counters) {
    CopyShade<effects> shade(frame, ready);
    const TriangleDepth triangle_depth(ready.depths);
    const auto write = [&](const ManyFragments& fragments) {
        if constexpr (!effects.see_through) {
            shade(
                fragments, counters, [](const ManyWeights&) {},
                [&](std::size_t i, vec3 color) { frame.color[fragments.pixels[i]] = color; });
        } else {
            Numbers opacities;
            shade(
                fragments, counters,
                [&](const ManyWeights& weights) {
                    opacities =
                        shade.tints.opacities(shade.surface, weights, frame.filter, counters);
                },
                [&](std::size_t i, vec3 color) {
                    const ivec2 pixel = fragments.pixels[i];
                    const float depth = triangle_depth.at(fragments.screen_weights[i]);
                    [[maybe_unused]] bool is_masked = false;
                    if constexpr (has(Without::mask)) {
                        is_masked = shade.tints.is_masked();
                        if (is_masked) {
                            counters.add(Counter::masked_fragments);
                            if (!is_there(opacities[i], shade.tints.cutoff())) return;
                        }
                    }
                    if constexpr (has(Without::blend))
                        if (shade.tints.is_layer()) {
                            counters.add(Counter::fragments_shaded);
                            counters.add(Counter::blended_fragments);
                            layers.add({pixel, depth, is_masked ? 1.0f : opacities[i], color});
                            return;
                        }
                    if (!frame.depth.test_and_write(pixel, depth)) return;
                    counters.add(Counter::fragments_shaded);
                    frame.color[pixel] = color;
                });
        }
    };
    Fragments visible(write);
    fill_part(ready.on_screen, part, [&](ivec2 pixel, vec3 screen_weights) {
        counters.add(Counter::fragments_tested);
        const float depth = triangle_depth.at(screen_weights);
        if constexpr (effects.see_through) {
            if (!(depth < frame.depth.depths()[pixel])) return;
        } else {
            if (!frame.depth.test_and_write(pixel, depth)) return;
            counters.add(Counter::fragments_shaded);
        }
        visible.add(pixel, screen_weights);
    });
    visible.finish();
}

/// Kernels, but for those that nobody calls.
template <typename CounterPolicy>
class CopyKernels {
  public:
    using Kernel = void (*)(const CopyFrame&, const ReadyTriangle&, const Part&, CopyLayers&,
                            CounterPolicy&);

    explicit CopyKernels(const ScenePlan& plan) {
        for (const MaterialPlan& material : plan.materials)
            of_material_.push_back(table[kernel_of(material)]);
    }

    Kernel operator[](std::size_t material) const { return of_material_[material]; }

  private:
    template <std::size_t i>
    static constexpr Kernel compiled() {
        if constexpr (constexpr auto effects = left_of(all_kernels[i]))
            return &draw_copy_of_triangle<*effects, CounterPolicy>;
        else
            return nullptr;
    }
    template <std::size_t... i>
    static constexpr std::array<Kernel, sizeof...(i)> all(std::index_sequence<i...>) {
        return {compiled<i>()...};
    }
    static constexpr auto table = all(std::make_index_sequence<all_kernels.size()>());

    std::vector<Kernel> of_material_;
};

/// The lesson's render(), but what is left out is not compiled.
template <typename CounterPolicy>
Image<vec3> copy_of_render(const Options& options, const FinishedScene& scene, ThreadPool& pool,
                           CounterPolicy& total) {
    const Camera camera = camera_of_picture(options, options.scene.camera, scene).camera;
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    WorkerCounters<CounterPolicy> counters_of(pool.size());
    const Shadows shadows = [&] {
        if constexpr (has(Without::shadow))
            return draw_shadows(pool, options.threads, options.shadow, options.shading.all_effects,
                                scene, scene.lit_by.lights, counters_of, scene.lit_by.casts);
        else
            return Shadows(options.shadow, false, scene, {}, counters_of[0],
                           [](ShadowMap&, bool) {});
    }();
    Image<vec3> color(options.size, unset);
    DepthBuffer depth(options.size, unset);

    std::vector<Mesh> outlines;
    if constexpr (has(Without::outline)) outlines = outlines_of(scene, camera);
    const std::vector<const Mesh*> meshes = seen_meshes(scene, outlines, clip_from_world, total);
    const Parts parts = options.threads.parts_of(options.size, pool.size());
    std::vector<BinnedTriangles> passes;
    for (const Pass& pass : passes_of(scene, meshes))
        passes.emplace_back(
            pool, pass.meshes, clip_from_world, parts, pass.two_sided,
            [&](std::size_t material) { return pass.takes(scene, material); }, counters_of);

    const CopyKernels<CounterPolicy> kernels(scene.plan);
    const ShadingVariant shading{options.shading};
    CopyFrame frame{{scene, shading, options.normal_map, options.texture.filter,
                     camera.position_world, shadows, color, depth},
                    {}};
    if constexpr (!has_all_textures)
        for (std::uint32_t i = 0; i < scene.materials.size(); ++i)
            frame.for_light.emplace_back(scene, scene.meshes[0], Triangle{{}, i});
    pool.run(parts.count(), [&](std::size_t part, std::size_t worker) {
        clear_part(color, depth, parts[part]);
        if constexpr (has(Without::outline))
            if (scene.is_on_paper) draw_paper(color, parts[part]);
        CopyLayers layers;
        for (const BinnedTriangles& pass : passes)
            for (const Chunk& chunk : pass.chunks)
                for (const std::size_t index : chunk.of(part)) {
                    const ReadyTriangle& ready = chunk.triangles[index];
                    kernels[ready.triangle.material](frame, ready, parts[part], layers,
                                                     counters_of[worker]);
                }
        layers.draw_over(color);
        if (options.threads.show) tint(color, parts[part], worker);
    });
    counters_of.add_to(total);
    if (options.show_depth) return depth_picture(depth);
    return color;
}

/// Both, as in the lesson's program.
Image<vec3> draw(const Options& options, const FinishedScene& scene, ThreadPool& pool,
                 auto& counters) {
    if constexpr (way == Without::own) {
        NoClock no_clock;
        return render(options, scene, pool, counters, no_clock);
    } else {
        return copy_of_render(options, scene, pool, counters);
    }
}

}  // namespace

template <>
Draw rasterbook::draw_of<LESSON, Without::WITHOUT>(const Scene& model) {
    static ThreadPool pool(1);
    return [scene = std::make_shared<FinishedScene>(model, Options())](Counters* counters) {
        NoCounters none;
        return counters ? draw(Options(), *scene, pool, *counters)
                        : draw(Options(), *scene, pool, none);
    };
}
