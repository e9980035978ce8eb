// SPDX-License-Identifier: MIT
#include "11_scenes/scene_options.hpp"

namespace rasterbook {

void SceneOptions::declare(OptionParser& parser) {
    const auto choose = [this](const Quality& quality) {
        texture.filter = quality.filter;
        shadow.size = quality.shadow_size;
        shadow.pcf = quality.pcf;
        if (samples_per_side == LessonOptions().samples_per_side)
            samples_per_side = quality.samples_per_side;
    };
    // Before the options that it sets: what they say counts more.
    parser.choice("--quality", "balanced",
                  {{"fast", [=] { choose(fast_quality); }},
                   {"balanced", [=] { choose(balanced_quality); }},
                   {"exact", [=] { choose(exact_quality); }}},
                  "Sets --filter, --shadow-size, --pcf and --samples together");
    parser.text("--camera", camera, "NAME|NUMBER|orbit|fit",
                "One of the file's cameras, or our own [the first one, if no orbit is asked for]");
    ThreadedSceneOptions::declare(parser);
}

}  // namespace rasterbook
