// SPDX-License-Identifier: MIT
/// @file
/// How much a model's files may ask for, and where they may lie: a small file can ask for very
/// much.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "common/math/types.hpp"

namespace rasterbook {

/// What loading a model takes, and the words for it of `--limit`.
enum class Resource {
    bytes,       ///< Of files and of the buffers in them.
    pixels,      ///< Of all images; about 25 bytes of memory each.
    vertices,    ///< Of all triangles and polygons, those of each instance; about 100 bytes each.
    primitives,  ///< Of a glTF file's meshes, again for each node that has the mesh.
    objects,     ///< In the lists of a glTF file: nodes, meshes, images and so on.
    materials,   ///< About 5,000 bytes each.
    overdraw,    ///< How often triangles cover a picture or shadow map, on average.
};
constexpr std::array<std::string_view, 7> resource_names = {
    "bytes", "pixels", "vertices", "primitives", "objects", "materials", "overdraw"};

/// What is left of what a model may ask for. Loaders charge it before they take memory.
class LoadBudget {
  public:
    /// @param most  Replaces the default: 10^9 bytes, 6 * 10^7 pixels, 1.5 * 10^7 vertices, 10^6
    ///              primitives, 10^6 objects, 2 * 10^5 materials, 200 times overdraw.
    void set(Resource resource, std::uint64_t most) { most_[index(resource)] = most; }

    std::uint64_t left(Resource resource) const {
        return most_[index(resource)] - used_[index(resource)];
    }

    /// @throws InputError  When less than that is left: names the file, the limit and the option
    ///                     that changes it.
    void charge(Resource resource, std::uint64_t amount, const std::filesystem::path& file);

    /// From now on no file is read but those in a folder and in the folders below it.
    ///
    /// @throws InputError  When there is no such folder.
    void confine_to(const std::filesystem::path& folder);

    /// False when the file, all links followed, lies where none may be read.
    bool allows(const std::filesystem::path& file) const;

    /// @throws InputError  Unless allows(file).
    void check_place(const std::filesystem::path& file) const;

    /// Checks the place of a file that is about to be read, and charges its bytes; none where it
    /// has none to be told: who reads it says why.
    void charge_file(const std::filesystem::path& file);

    /// A picture or shadow map of less than 2^20 pixels counts as one of so many.
    ///
    /// @param work  About how many pixels are looked at to draw all triangles of a picture.
    /// @throws InputError  When that is more overdraw than is accepted.
    void check_overdraw(double work, ivec2 size, const std::filesystem::path& file) const;

  private:
    static std::size_t index(Resource resource) { return static_cast<std::size_t>(resource); }

    std::array<std::uint64_t, resource_names.size()> most_ = {
        1'000'000'000, 60'000'000, 15'000'000, 1'000'000, 1'000'000, 200'000, 200};
    std::array<std::uint64_t, resource_names.size()> used_{};
    std::filesystem::path folder_;  ///< Without links; empty: files may lie anywhere.
};

}  // namespace rasterbook
