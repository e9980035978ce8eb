// SPDX-License-Identifier: MIT
/// @file
/// A scene as a run of bytes: written when the site is built, read in a page, where there are no
/// files. Its images are in it, decoded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "common/image/image.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

using EmbeddedImage = std::shared_ptr<const std::vector<std::uint8_t>>;

struct SceneWriter {
    std::vector<std::uint8_t> written;
    std::map<std::filesystem::path, EmbeddedImage> images;  ///< So far: each is written once.

    void transfer_bytes(void* from, std::size_t count) {
        const std::size_t before = written.size();
        written.resize(before + count);
        if (count > 0) std::memcpy(written.data() + before, from, count);
    }
};

struct SceneReader {
    std::span<const std::uint8_t> left;
    std::map<std::filesystem::path, EmbeddedImage> images;

    void transfer_bytes(void* to, std::size_t count) {
        if (count > left.size()) std::abort();  // not what a SceneWriter has written
        if (count > 0) std::memcpy(to, left.data(), count);
        left = left.subspan(count);
    }
};

/// What follows names each field once, for writing and for reading.
template <typename Archive, typename T>
requires std::is_trivially_copyable_v<T>
void transfer(Archive& archive, T& value) {
    archive.transfer_bytes(&value, sizeof value);
}

template <typename Archive, typename List>
void transfer_list(Archive& archive, List& list) {
    auto size = static_cast<std::uint32_t>(list.size());
    transfer(archive, size);
    list.resize(size);
    if constexpr (std::is_trivially_copyable_v<typename List::value_type>)
        archive.transfer_bytes(list.data(), size * sizeof list[0]);
    else
        for (auto& entry : list) transfer(archive, entry);
}
template <typename Archive>
void transfer(Archive& archive, std::string& text) {
    transfer_list(archive, text);
}
template <typename Archive, typename T>
void transfer(Archive& archive, std::vector<T>& list) {
    transfer_list(archive, list);
}
template <typename Archive>
void transfer(Archive& archive, std::filesystem::path& path) {
    std::string text = path.string();
    transfer(archive, text);
    path = text;
}
template <typename Archive, typename T>
void transfer(Archive& archive, std::optional<T>& value) {
    bool has_value = value.has_value();
    transfer(archive, has_value);
    if (has_value) transfer(archive, value ? *value : value.emplace());
}

template <typename Archive, typename... Fields>
void transfer_all(Archive& archive, Fields&... fields) {
    (transfer(archive, fields), ...);
}

template <typename Archive>
void transfer(Archive& archive, Mesh& mesh) {
    transfer_all(archive, mesh.name, mesh.positions, mesh.uvs, mesh.normals, mesh.colors,
                 mesh.tangents, mesh.vertices, mesh.faces, mesh.triangles, mesh.bounds);
}

template <typename Archive>
void transfer(Archive& archive, TextureMap& map) {
    transfer_all(archive, map.file, map.offset, map.scale, map.bump_multiplier, map.clamp,
                 map.mirror);
    if (map.file.empty()) return;
    EmbeddedImage& image = archive.images[map.file];
    if (!image) {
        auto bytes = map.embedded ? *map.embedded : std::vector<std::uint8_t>();
        transfer(archive, bytes);
        image = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
    }
    map.embedded = image;
}

template <typename Archive>
void transfer(Archive& archive, Material& material) {
    transfer_all(archive, material.name, material.ambient, material.diffuse, material.specular,
                 material.emission, material.shininess, material.opacity, material.illumination,
                 material.diffuse_map, material.specular_map, material.opacity_map,
                 material.bump_map, material.normal_map, material.alpha, material.alpha_cutoff,
                 material.two_sided, material.toon);
}

template <typename Archive>
void transfer(Archive& archive, SceneCamera& camera) {
    transfer_all(archive, camera.name, camera.world_from_view, camera.fov_y_radians, camera.near,
                 camera.far);
}

template <typename Archive>
void transfer(Archive& archive, SceneLight& light) {
    transfer_all(archive, light.name, light.kind, light.color, light.position_world,
                 light.direction_world, light.range, light.cos_full, light.cos_none);
}

template <typename Archive>
void transfer(Archive& archive, Scene& scene) {
    transfer_all(archive, scene.meshes, scene.materials, scene.cameras, scene.lights, scene.is_gltf,
                 scene.file);
}

/// Four channels of a pixel's neighbours: left, above, and left above; 0 outside of the image.
///
/// @return  What PNG foretells of the pixel from them: smooth images become small numbers, which
///          compress well.
/// @see Portable Network Graphics (PNG) Specification, W3C, 2003, section 9.4
inline u8vec4 paeth(const Image<u8vec4>& image, ivec2 pixel) {
    const auto at = [&](ivec2 p) {
        return p.x < 0 || p.y < 0 ? glm::ivec4(0) : glm::ivec4(image[p]);
    };
    const glm::ivec4 a = at(pixel - ivec2(1, 0)), b = at(pixel - ivec2(0, 1)),
                     c = at(pixel - ivec2(1, 1));
    const glm::ivec4 from_a = glm::abs(b - c), from_b = glm::abs(a - c),
                     from_c = glm::abs(a + b - 2 * c);
    u8vec4 foretold;
    for (int i = 0; i < 4; ++i)
        foretold[i] =
            static_cast<std::uint8_t>(from_a[i] <= from_b[i] && from_a[i] <= from_c[i] ? a[i]
                                      : from_b[i] <= from_c[i]                         ? b[i]
                                                                                       : c[i]);
    return foretold;
}

/// An image's size and how its pixels differ from what was foretold.
inline std::vector<std::uint8_t> packed(Image<u8vec4> image) {
    SceneWriter writer;
    ivec2 size = image.size();
    transfer(writer, size);
    for (ivec2 p(0); p.y < size.y; ++p.y)
        for (p.x = 0; p.x < size.x; ++p.x) {
            u8vec4 difference = image[p] - paeth(image, p);
            transfer(writer, difference);
        }
    return writer.written;
}

inline Image<u8vec4> unpacked(const std::vector<std::uint8_t>& bytes) {
    SceneReader reader{bytes, {}};
    ivec2 size;
    transfer(reader, size);
    Image<u8vec4> image(size);
    for (ivec2 p(0); p.y < size.y; ++p.y)
        for (p.x = 0; p.x < size.x; ++p.x) {
            u8vec4 difference;
            transfer(reader, difference);
            image[p] = difference + paeth(image, p);
        }
    return image;
}

}  // namespace rasterbook
