// SPDX-License-Identifier: MIT
#include "11_scenes/casters.hpp"

namespace rasterbook {

template ShadowMaps draw_shadow_maps(ThreadPool&, const SceneRendererOptions&, const SceneAssets&,
                                     WorkerCounters<Counters>&);

}  // namespace rasterbook
