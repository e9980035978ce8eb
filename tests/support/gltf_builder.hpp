// SPDX-License-Identifier: MIT
/// @file
/// Small glTF files for tests: a JSON value to change at will, and its bytes.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/image/input_error.hpp"
#include "common/math/types.hpp"

namespace rasterbook::test {

using nlohmann::json;

constexpr int gl_byte = 5120, gl_unsigned_byte = 5121, gl_short = 5122, gl_unsigned_short = 5123,
              gl_unsigned_int = 5125, gl_float = 5126;

inline std::string base64(const std::string& bytes) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
    }
    return text;
}

/// The lowest byte first.
inline std::string little_endian(std::uint64_t value, int size) {
    std::string bytes;
    for (int i = 0; i < size; ++i) bytes += char(value >> (8 * i));
    return bytes;
}

/// How a file is written.
enum class GltfForm { embedded, separate, binary };

struct GltfBuilder {
    json document = {{"asset", {{"version", "2.0"}}},
                     {"scenes", json::array({{{"nodes", {0}}}})},
                     {"nodes", json::array({{{"mesh", 0}}})},
                     {"buffers", json::array({json::object()})}};
    std::string bytes;

    /// Adds an accessor with a view of its own; gives its index.
    int add(const std::vector<double>& numbers, const char* type, int component,
            bool normalized = false) {
        static constexpr std::array size_of{1, 1, 2, 2, 4, 4, 4};
        const int size = size_of[std::size_t(component - gl_byte)];
        const std::size_t begin = bytes.size();
        for (const double number : numbers)
            bytes += component == gl_float
                         ? little_endian(std::bit_cast<std::uint32_t>(float(number)), 4)
                         : little_endian(std::uint64_t(std::int64_t(number)), size);
        const std::string name = type;
        const int width = name == "SCALAR" ? 1 : name == "MAT4" ? 16 : name.back() - '0';
        const int view = add_view(begin);
        json accessor = {{"bufferView", view},
                         {"componentType", component},
                         {"count", numbers.size() / std::size_t(width)},
                         {"type", type}};
        if (normalized) accessor["normalized"] = true;
        document["accessors"].push_back(accessor);
        return int(document["accessors"].size()) - 1;
    }

    /// A buffer view of the bytes from `begin` on.
    int add_view(std::size_t begin) {
        document["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes.size() - begin}});
        bytes.resize((bytes.size() + 3) / 4 * 4);
        return int(document["bufferViews"].size()) - 1;
    }

    /// Sets what JSON pointers name, and removes what becomes null: set(R"("/scene": 1)").
    GltfBuilder& set(const std::string& changes) {
        const json values = json::parse("{" + changes + "}");
        for (const auto& [name, value] : values.items()) {
            const json::json_pointer where(name);
            if (value.is_null())
                document[where.parent_pointer()].erase(where.back());
            else
                document[where] = value;
        }
        return *this;
    }

    /// Gives the material a base colour texture: the picture of a URI.
    GltfBuilder& set_texture(const std::string& uri) {
        document["images"] = json::array({{{"uri", uri}}});
        document["textures"] = json::array({{{"source", 0}}});
        material()["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
        return *this;
    }

    json& primitive() { return document["meshes"][0]["primitives"][0]; }
    json& material() { return document["materials"][0]; }

    std::filesystem::path write(const std::filesystem::path& file,
                                GltfForm form = GltfForm::embedded) const {
        json all = document;
        json none, &buffer = all["buffers"].empty() ? none : all["buffers"][0];
        if (!buffer.contains("byteLength")) buffer["byteLength"] = bytes.size();
        if (form == GltfForm::embedded && !buffer.contains("uri"))
            buffer["uri"] = "data:application/octet-stream;base64," + base64(bytes);
        if (form == GltfForm::separate) {
            const auto bin = std::filesystem::path(file).replace_extension(".bin");
            std::ofstream(bin, std::ios::binary) << bytes;
            buffer["uri"] = bin.filename().string();
        }
        std::string text = all.dump();
        if (form == GltfForm::binary) {
            text.resize((text.size() + 3) / 4 * 4, ' ');
            text = "glTF" + little_endian(2, 4) +
                   little_endian(12 + 8 + text.size() + 8 + bytes.size(), 4) +
                   little_endian(text.size(), 4) + "JSON" + text + little_endian(bytes.size(), 4) +
                   std::string("BIN\0", 4) + bytes;
        }
        std::ofstream(file, std::ios::binary) << text;
        return file;
    }
};

/// One triangle in the plane z = 0 with a material. Its accessors and their views are, in order, of
/// positions, normals, uvs and indices.
inline GltfBuilder one_triangle() {
    GltfBuilder made;
    made.add({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", gl_float);
    made.add({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", gl_float);
    made.add({0, 1, 1, 1, 0, 0.25}, "VEC2", gl_float);
    made.add({0, 1, 2}, "SCALAR", gl_unsigned_short);
    return made.set(R"("/meshes": [{"name": "triangle", "primitives": [{
                           "attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2},
                           "indices": 3, "material": 0}]}],
                       "/materials": [{"name": "paint", "pbrMetallicRoughness": {
                           "metallicFactor": 0, "roughnessFactor": 0.5}}])");
}

}  // namespace rasterbook::test
