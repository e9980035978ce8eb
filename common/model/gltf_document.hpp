// SPDX-License-Identifier: MIT
/// @file
/// glTF files as they stand: the document that tinygltf makes of one, and the numbers in it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include <tiny_gltf.h>

#include "common/image/image_bytes.hpp"
#include "common/math/types.hpp"
#include "common/model/load_budget.hpp"

namespace rasterbook {

/// Reads a .gltf or .glb file, told apart by the content, and the buffers that it names. Pictures
/// beside it are not opened.
///
/// @param budget     Is charged with the bytes of files and buffers.
/// @param complaint  Takes what tinygltf found fault with and passed over; one line, or empty.
/// @throws InputError  When a file is missing or not regular, the JSON is broken or nested deeper
///          than 64, a .glb is truncated, a buffer is shorter or longer than said, an extension is
///          needed that is_known_gltf_extension() does not know, or tinygltf finds fault. One line.
tinygltf::Model read_gltf_document(const std::filesystem::path& file, LoadBudget& budget,
                                   std::string& complaint);

/// Whether all that can be drawn of an extension is read, or a picture is the same without it.
bool is_known_gltf_extension(const std::string& name);

/// The bytes of a buffer view.
///
/// @param what  Who asks, for the error: "image 3".
/// @throws InputError  When there is no such view, or it reaches beyond its buffer.
ByteView bytes_of_view(const tinygltf::Model& model, int view, const std::filesystem::path& file,
                       const std::string& what);

/// An array of numbers or of vectors of them, checked when it is opened.
class GltfArray {
  public:
    /// @param accessor  Index of the accessor.
    /// @param what      Who asks, for errors: "mesh 2: POSITION".
    /// @throws InputError  When there is no such accessor, it is sparse or has no bytes, its type
    ///          is unknown, or it reaches beyond its buffer view.
    GltfArray(const tinygltf::Model& model, int accessor, const std::filesystem::path& file,
              std::string what);

    std::size_t size() const { return count_; }
    int components() const { return components_; }  ///< 1 to 4, or 16.
    bool is_float() const { return type_ == TINYGLTF_COMPONENT_TYPE_FLOAT; }

    /// Whether its numbers are whole and not negative, as those of indices.
    bool is_unsigned() const;
    bool is_normalized() const { return is_normalized_; }

    /// One number. Whole ones become 0 to 1 or -1 to 1 where the accessor says so.
    ///
    /// @throws InputError  When it is not finite.
    double number(std::size_t element, int component) const;

    /// One vector; components that the array does not have are 0, the fourth is 1.
    dvec4 vector(std::size_t element) const;

    [[noreturn]] void fail(const std::string& what) const;

  private:
    std::filesystem::path file_;
    std::string what_;
    ByteView bytes_;  ///< From the first number on.
    std::size_t count_ = 0, stride_ = 0;
    int components_ = 0, type_ = 0;
    bool is_normalized_ = false;
};

}  // namespace rasterbook
