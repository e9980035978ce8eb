// SPDX-License-Identifier: MIT
#include "13_visibility_buffer/visible_shading.hpp"

namespace rasterbook {

template class VisibleShaders<ShadowMapsOnDemand>;

}  // namespace rasterbook
