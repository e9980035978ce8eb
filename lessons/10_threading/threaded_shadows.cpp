// SPDX-License-Identifier: MIT
#include "10_threading/threaded_shadows.hpp"

namespace rasterbook {

template ShadowMaps draw_shadow_maps(ThreadPool&, const ThreadOptions&, const ShadowVariant&, bool,
                                     const Scene&, const ShadowBounds&, std::span<const Light>,
                                     WorkerCounters<Counters>&, std::span<const bool>);

}  // namespace rasterbook
