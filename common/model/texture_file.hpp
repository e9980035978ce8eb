// SPDX-License-Identifier: MIT
/// @file
/// Reads the images that materials name.
#pragma once

#include <string>

#include "common/image/image.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// The image that a material names, from its file or from inside the model's file.
///
/// @param statement   That names it, for the message.
/// @param scene       Its budget is charged with the image's bytes and pixels; takes warnings.
/// @param keep_going  An image that cannot be read is a warning, and a gaudy chessboard that nobody
///                    overlooks takes its place.
/// @throws InputError  Else: names the statement of the material library that asks for the image,
///                     and the image.
Image<u8vec4> read_texture_file(const TextureMap& map, const char* statement, bool keep_going,
                                Scene& scene);

/// Reads the image of a texture, and adds no message of its own.
///
/// @param remark       If not null, takes what is wrong with a file that can be read nevertheless.
/// @throws InputError  Names the image alone.
Image<u8vec4> read_texture_file(const TextureMap& map, LoadBudget& budget,
                                std::string* remark = nullptr);

}  // namespace rasterbook
