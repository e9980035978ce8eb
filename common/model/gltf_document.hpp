// SPDX-License-Identifier: MIT
/// @file
/// glTF files as they stand: the document that tinygltf makes of one, and the numbers in it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include <tiny_gltf.h>

#include "common/image/image_bytes.hpp"
#include "common/math/types.hpp"
#include "common/model/load_budget.hpp"
#include "common/model/mtl.hpp"

namespace rasterbook {

/// Reads a .gltf or .glb file, told apart by the content, and the buffers that it names. Images are
/// not opened: of them there are `uri`, `bufferView` and `mimeType`.
///
/// @param budget    Is charged with the bytes of files and buffers.
/// @param warnings  Takes what is wrong and does not matter: bytes behind a .glb file's end, and
///                  what tinygltf found fault with.
/// @throws InputError  When a file is missing or not regular, the JSON is broken or nested deeper
///          than 64, a .glb is truncated, a buffer has fewer bytes than it says, an image's view
///          reaches beyond its buffer, an extension is needed that is_known_gltf_extension() does
///          not know, or tinygltf finds fault. One line.
tinygltf::Model read_gltf_document(const std::filesystem::path& file, LoadBudget& budget,
                                   Warnings& warnings);

/// Whether a URI is the data itself: "data:image/png;base64,...".
inline bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

/// The file that a URI names beside a file: "%20" and the like stand for bytes, "+" is itself (RFC
/// 3986). Where there is none of that name, the URI may be the name: some exporters encode nothing.
std::filesystem::path file_of_uri(const std::filesystem::path& file, std::string_view uri);

/// The bytes of a data URI (RFC 2397), in base64 or as text, whatever its media type is.
///
/// @param what  Who asks, for the error: "image 3".
/// @throws InputError  When it has no data, or is not base64 though it says so.
Bytes bytes_of_data_uri(std::string_view uri, const std::filesystem::path& file,
                        const std::string& what);

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

    /// One matrix of an array of 16 numbers an element.
    dmat4 matrix(std::size_t element) const;

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
