// SPDX-License-Identifier: MIT
/// @file
/// Wavefront OBJ and MTL, as real exporters write them.
#pragma once

#include <filesystem>

#include "common/model/mesh.hpp"

namespace rasterbook {

/// Reads a model and the material libraries that it names.
///
/// Time is linear in the file's size, for faces of very many vertices see triangulate(). Of each
/// kind of statement that is not read there is one warning. Behind x y z, colours are read: encoded
/// as sRGB, 0 to 1, or to 255 where any is above 1. Other numbers there and behind u v are ignored.
/// The smoothing group is that of the last `s`, smooth_by_angle before the first. A comment begins
/// with a `#` at the beginning of a word; it belongs to a name where a material or file has that
/// whole name. A positive index may refer to an element further down. Positions far from 0 are
/// stored relative to Scene::origin. A missing material library or an unknown material is a warning
/// and gives the default material; of two materials with one name the first counts.
///
/// @param budget        What the files may ask for.
/// @param max_elements  As many positions, uvs, normals, and vertices of one group, are accepted.
/// @return  One mesh for each name of a group (`o` or `g`) that has faces; polygons as written and
///          cut into triangles. A single mesh keeps all positions, uvs and normals of the file; of
///          several, each has those that its faces use.
/// @throws InputError  With file and line, when an index is 0 or out of range, a face has fewer
///          than 3 vertices, a number does not parse or is not finite, the file is not text
///          (control characters, UTF-16), or it has more elements than accepted; without line, when
///          it has no faces, is missing or is not a regular file, asks for more than is accepted,
///          or has a polygon that returns to one point more than 1,000 times. The file may also be
///          a material library.
Scene load_obj(const std::filesystem::path& file, const LoadBudget& budget = {},
               std::uint32_t max_elements = no_index);

}  // namespace rasterbook
