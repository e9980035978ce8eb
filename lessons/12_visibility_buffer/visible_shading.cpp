// SPDX-License-Identifier: MIT
#include "12_visibility_buffer/visible_shading.hpp"

namespace rasterbook {

template class VisibleShaders<ShadowMapsOnDemand>;

}  // namespace rasterbook
