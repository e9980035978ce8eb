// SPDX-License-Identifier: MIT
#include "11_scenes/shaders.hpp"

namespace rasterbook {

template class Shaders<Counters>;

}  // namespace rasterbook
