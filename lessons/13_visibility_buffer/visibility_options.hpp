// SPDX-License-Identifier: MIT
/// @file
/// What this lesson can be asked for: `--show`, `--max-ids` and `--shadow-part`;
/// measured in docs/accuracy/13_visibility_buffer.md.
#pragma once

#include <cstddef>
#include <limits>

#include "common/app/lesson_app.hpp"

namespace rasterbook {

/// What the picture shows.
enum class Show {
    picture,
    ids,         ///< Neighbouring triangles in different colours.
    shading,     ///< How often each pixel was shaded.
    shadow_map,  ///< The first shadow map, and which of its parts were drawn.
};

struct VisibilityOptions {
    Show show = Show::picture;
    int max_ids = std::numeric_limits<int>::max();
    int shadow_part = 64;  ///< Texels along a side of what is drawn of a shadow map at once.

    std::size_t most_ids() const { return static_cast<std::size_t>(max_ids); }

    void declare(OptionParser& parser) {
        parser.choice("--show", show,
                      {{"picture", Show::picture},
                       {"ids", Show::ids},
                       {"shading", Show::shading},
                       {"shadow-map", Show::shadow_map}},
                      "The picture, its triangles, how often each pixel was shaded, or the first "
                      "shadow map");
        parser.number("--max-ids", max_ids, 1, std::numeric_limits<int>::max(),
                      "Shade what is visible after so many triangles of a tile; with 1, all that "
                      "lesson 12 shades");
        parser.number("--shadow-part", shadow_part, 32, 8192,
                      "Texels along a side of what is drawn of a shadow map at once");
    }
};

}  // namespace rasterbook
