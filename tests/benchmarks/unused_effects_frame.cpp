// SPDX-License-Identifier: MIT
/// @file
/// One way to draw a frame: the render() of LESSON, in namespace LESSON_NAMESPACE, compiled WITHOUT
/// an effect: promises.hpp is included first.
#include "benchmarks/unused_effects.hpp"

#include <memory>

// All types that the functions below name, whichever lesson it is.
#include "07_toon/toon_options.hpp"
#include "12_effects/effects_program.hpp"

#include LESSON_HEADER

using namespace rasterbook;
using namespace LESSON_NAMESPACE;

namespace {

template <typename AnyOptions>
auto assets_of(const Scene& model, const AnyOptions& options) {
    if constexpr (LESSON == 12)
        return load_planned_scene(model, options);
    else
        return make_assets(model, options);
}

Image<vec3> draw(const auto& options, const auto& assets) {
    if constexpr (LESSON == 12) {
        static ThreadPool pool(1);
        StepClock clock;
        return render(options, assets, pool, clock);
    } else {
        return render(options, assets);
    }
}

}  // namespace

template <>
__attribute__((visibility("default"))) Draw
rasterbook::draw_of<LESSON, Without::WITHOUT>(const Scene& model) {
    const auto options = [](auto knobs) {
        if constexpr (requires { knobs.shading.outline; }) knobs.shading.outline = Outline::none;
        return knobs;
    }(Options());
    using Assets = decltype(assets_of(model, options));
    return [options, assets = std::make_shared<const Assets>(assets_of(model, options))](
               Counters* counters) {
        thread_counters = {};
        Image<vec3> picture = draw(options, *assets);
        if (counters) *counters = thread_counters;
        return picture;
    };
}
