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
                 mesh.tangents, mesh.vertices, mesh.faces, mesh.triangles, mesh.bounds,
                 mesh.smoothing_groups, mesh.shared_positions);
}

template <typename Archive>
void transfer(Archive& archive, TextureMap& map) {
    transfer_all(archive, map.file, map.offset, map.scale, map.bump_multiplier, map.clamp,
                 map.mirror, map.nearest_magnified, map.nearest_minified);
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
                 material.diffuse_map, material.specular_map, material.emission_map,
                 material.opacity_map, material.bump_map, material.normal_map, material.alpha,
                 material.alpha_cutoff, material.two_sided, material.toon);
}

template <typename Archive>
void transfer(Archive& archive, SceneCamera& camera) {
    transfer_all(archive, camera.name, camera.world_from_view, camera.fov_y_radians, camera.near,
                 camera.far);
}

template <typename Archive>
void transfer(Archive& archive, SceneLight& light) {
    transfer_all(archive, light.name, light.kind, light.color, light.position_world,
                 light.direction_world, light.range, light.cos_inner, light.cos_outer);
}

template <typename Archive>
void transfer(Archive& archive, Scene& scene) {
    transfer_all(archive, scene.meshes, scene.materials, scene.cameras, scene.lights, scene.is_gltf,
                 scene.file);
}

/// A pixel as it is predicted from its neighbours to the left, above, and left above, which are 0
/// outside of the image: what is left of a smooth image is small numbers, which compress well.
///
/// @see Weinberger et al., "The LOCO-I lossless image compression algorithm", 2000, section III.A
inline u8vec4 predicted(const Image<u8vec4>& image, ivec2 pixel) {
    const auto at = [&](ivec2 p) {
        return p.x < 0 || p.y < 0 ? glm::ivec4(0) : glm::ivec4(image[p]);
    };
    const glm::ivec4 left = at(pixel - ivec2(1, 0)), above = at(pixel - ivec2(0, 1));
    return u8vec4(glm::clamp(left + above - at(pixel - ivec2(1)), glm::min(left, above),
                             glm::max(left, above)));
}

/// Red and blue as they differ from green, modulo 256, of which there is less; and back.
inline u8vec4 from_green(u8vec4 c) { return c - u8vec4(c.g, 0, c.g, 0); }
inline u8vec4 with_green(u8vec4 c) { return c + u8vec4(c.g, 0, c.g, 0); }

/// An image's size, and channel by channel the residuals: how its pixels differ from what is
/// predicted.
inline std::vector<std::uint8_t> packed(Image<u8vec4> image) {
    for (u8vec4& color : image.pixels()) color = from_green(color);
    SceneWriter writer;
    ivec2 size = image.size();
    transfer(writer, size);
    for (int channel = 0; channel < 4; ++channel)
        for (ivec2 p(0); p.y < size.y; ++p.y)
            for (p.x = 0; p.x < size.x; ++p.x)
                writer.written.push_back((image[p] - predicted(image, p))[channel]);
    return writer.written;
}

inline Image<u8vec4> unpacked(const std::vector<std::uint8_t>& bytes) {
    SceneReader reader{bytes, {}};
    ivec2 size;
    transfer(reader, size);
    Image<u8vec4> image(size);
    for (int channel = 0; channel < 4; ++channel)
        for (u8vec4& color : image.pixels()) transfer(reader, color[channel]);
    for (ivec2 p(0); p.y < size.y; ++p.y)
        for (p.x = 0; p.x < size.x; ++p.x) image[p] += predicted(image, p);
    for (u8vec4& color : image.pixels()) color = with_green(color);
    return image;
}

}  // namespace rasterbook
