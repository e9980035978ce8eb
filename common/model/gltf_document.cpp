// SPDX-License-Identifier: MIT
// tinygltf is one header, and includes less than it needs. It is given JSON alone: files and images
// are read by our own functions, which are more careful.
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

/// @cond
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_INCLUDE_JSON
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
/// @endcond
#include "common/model/gltf_document.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "common/image/file.hpp"
#include "common/image/input_error.hpp"

namespace rasterbook {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t max_bytes = std::numeric_limits<int>::max();  // tinygltf counts in int

/// All bytes of a file, charged before they are read.
Bytes read_charged(const fs::path& file, LoadBudget& budget) {
    budget.charge_file(file);
    return read_whole_file(file, max_bytes);
}

/// A message of a library as one line that is not too long.
std::string one_line(std::string text) {
    constexpr std::size_t most = 300;
    while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    if (text.size() > most) text = text.substr(0, most) + "...";
    return text;
}

/// What a file holds: JSON, and behind it the bytes of a .glb file's own buffer.
struct Content {
    ByteView text;  ///< The JSON.
    std::optional<ByteView> own_buffer;
};

/// A .glb file begins with 12 bytes: "glTF", the version and the length of the file. Then come
/// chunks: a length, a kind and as many bytes. The first is JSON; the second may be the buffer.
Content content_of(ByteView bytes, const fs::path& file, Warnings& warnings) {
    constexpr std::size_t header = 12, chunk_header = 8;
    constexpr std::uint32_t json_kind = 0x4e4f534a, buffer_kind = 0x004e4942;  // "JSON", "BIN\0"
    if (bytes.size() < 4 || std::memcmp(bytes.data(), "glTF", 4) != 0) return {bytes, {}};
    if (bytes.size() < header + chunk_header)
        throw InputError(file, "truncated: the header of a .glb file has 20 bytes");
    if (u32_at(bytes, 4) != 2)
        throw InputError(file, "is glTF " + std::to_string(u32_at(bytes, 4)) + ", not 2");
    const std::size_t length = u32_at(bytes, 8);
    if (length > bytes.size())
        throw InputError(file, "truncated: " + std::to_string(bytes.size()) + " of " +
                                   std::to_string(length) + " bytes are there");
    if (length < bytes.size())
        warnings.add(file, 0,
                     std::to_string(bytes.size() - length) + " bytes behind its end are ignored");
    ByteView rest = bytes.first(length);
    const auto take = [&](std::size_t count) {
        if (count > rest.size())
            throw InputError(file, "damaged: a chunk reaches beyond the end of the file");
        const ByteView taken = rest.first(count);
        rest = rest.subspan(count);
        return taken;
    };
    take(header);
    const auto take_chunk = [&](std::uint32_t kind) {
        const ByteView head = take(chunk_header), chunk = take(u32_at(head, 0));
        return u32_at(head, 4) == kind ? std::optional(chunk) : std::nullopt;
    };
    const std::optional<ByteView> text = take_chunk(json_kind);
    if (!text) throw InputError(file, "damaged: its first chunk is not JSON");
    return {*text, rest.empty() ? std::nullopt : take_chunk(buffer_kind)};
}

/// A whole number in an object; `missing` when there is none that is >= 0.
std::uint64_t whole_number(const json& object, const char* key, std::uint64_t missing) {
    const auto found = object.is_object() ? object.find(key) : object.end();
    return found != object.end() && found->is_number_unsigned() ? found->get<std::uint64_t>()
                                                                : missing;
}

/// Before tinygltf makes objects of a few hundred bytes, or buffers, of a few letters.
void charge_document(const json& document, const fs::path& file, LoadBudget& budget) {
    for (const auto& [name, list] : document.items()) {
        if (!list.is_array()) continue;
        budget.charge(name == "materials" ? Resource::materials : Resource::objects, list.size(),
                      file);
        for (const json& object : list) {
            if (name == "buffers")  // each has bytes of its own, even where several are of one file
                budget.charge(Resource::bytes, whole_number(object, "byteLength", 0), file);
            if (name == "meshes" && object.is_object() && object.contains("primitives"))
                budget.charge(Resource::objects, object["primitives"].size(), file);
        }
    }
}

void check_required_extensions(const json& document, const fs::path& file) {
    const auto required = document.find("extensionsRequired");
    if (required == document.end() || !required->is_array()) return;
    for (const json& name : *required)
        if (name.is_string() && !is_known_gltf_extension(name))
            throw InputError(file, "needs the extension " + one_line(name) + ", which is not read");
}

/// tinygltf takes nested values apart by recursion: deeper files would exhaust the stack.
void check_depth(ByteView text, const fs::path& file) {
    constexpr int most_depth = 64;
    int depth = 0;
    bool is_in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::uint8_t c = text[i];
        if (c == '"') is_in_string = !is_in_string;
        if (is_in_string && c == '\\') ++i;
        if (is_in_string) continue;
        if (c == '[' || c == '{') ++depth;
        if (c == ']' || c == '}') --depth;
        if (depth > most_depth)
            throw InputError(file, "is nested deeper than " + std::to_string(most_depth));
    }
}

/// Broken JSON has a message with line and column; what tinygltf would stumble over has one, too.
json checked_json(ByteView text, const fs::path& file, LoadBudget& budget) {
    check_depth(text, file);
    json document;
    try {
        document = json::parse(text.begin(), text.end());
    } catch (const json::exception& error) {
        const std::string_view words = error.what();  // "[json.exception.x.1] parse error at ..."
        throw InputError(
            file, "is not JSON: " + one_line(std::string(words.substr(words.find("] ") + 2))));
    }
    if (!document.is_object()) throw InputError(file, "is JSON, but not glTF: no object");
    const json& asset = document.contains("asset") ? document["asset"] : document;
    const bool has_version = asset.is_object() && asset.contains("version");
    if (!has_version || !asset["version"].is_string())
        throw InputError(file, "is JSON, but not glTF: there is no asset.version");
    const std::string version = asset["version"];
    if (!version.starts_with("2."))
        throw InputError(file, "is glTF " + one_line(version) + ", not 2");
    charge_document(document, file, budget);
    check_required_extensions(document, file);
    return document;
}

/// A text in an object; empty when there is none.
const std::string& text_in(const json& object, const char* key) {
    static const std::string none;
    const auto found = object.is_object() ? object.find(key) : object.end();
    return found != object.end() && found->is_string() ? found->get_ref<const std::string&>()
                                                       : none;
}

/// A URI's bytes, of which some are encoded as "%20" and the like.
std::string decoded_uri(std::string_view uri) {
    const auto digit = [](char c) {
        if (c >= '0' && c <= '9') return c - '0';
        if (c >= 'a' && c <= 'f') return c - 'a' + 10;
        return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
    };
    std::string text;
    text.reserve(uri.size());
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool is_code =
            uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
        text += is_code ? static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2])) : uri[i];
        if (is_code) i += 2;
    }
    return text;
}

/// The elements of one of the document's lists, which then is no longer in it.
json take_list(json& document, const char* key) {
    const auto found = document.find(key);
    if (found == document.end()) return json::array();
    json list = found->is_array() ? std::move(*found) : json::array();
    document.erase(found);
    return list;
}

/// The bytes of a buffer, as many as it says it has: a file or data URI may be longer.
Bytes bytes_of_buffer(const json& buffer, const std::optional<ByteView>& own, const fs::path& file,
                      const std::string& label, LoadBudget& budget) {
    constexpr auto missing = std::numeric_limits<std::uint64_t>::max();
    const std::uint64_t length = whole_number(buffer, "byteLength", missing);
    if (length == missing) throw InputError(file, label + " has no byteLength");
    const std::string& uri = text_in(buffer, "uri");
    std::string from = label;
    Bytes bytes;
    if (is_data_uri(uri)) {
        bytes = bytes_of_data_uri(uri, file, label);
    } else if (!uri.empty()) {
        const fs::path beside = file_of_uri(file, uri);
        from = beside.string();
        try {
            bytes = read_charged(beside, budget);
        } catch (const InputError& failure) { throw InputError(file, one_line(failure.what())); }
    } else if (own) {
        bytes.assign(own->begin(),
                     own->begin() +
                         static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(length, own->size())));
    } else {
        throw InputError(file, label + " has no uri");
    }
    if (bytes.size() < length)
        throw InputError(file, from + ": truncated: " + std::to_string(bytes.size()) + " of " +
                                   std::to_string(length) + " bytes are there");
    bytes.resize(static_cast<std::size_t>(length));
    return bytes;
}

void add_buffers(tinygltf::Model& model, const json& buffers, const Content& content,
                 const fs::path& file, LoadBudget& budget) {
    for (const json& buffer : buffers) {
        const std::size_t i = model.buffers.size();
        model.buffers.emplace_back().data =
            bytes_of_buffer(buffer, i == 0 ? content.own_buffer : std::nullopt, file,
                            "buffer " + std::to_string(i), budget);
    }
}

void add_images(tinygltf::Model& model, const json& images, const fs::path& file) {
    for (const json& from : images) {
        tinygltf::Image& image = model.images.emplace_back();
        image.uri = text_in(from, "uri");
        image.mimeType = text_in(from, "mimeType");
        if (!from.is_object() || !from.contains("bufferView")) continue;
        constexpr std::uint64_t most = std::numeric_limits<int>::max();
        image.bufferView = static_cast<int>(std::min(whole_number(from, "bufferView", most), most));
        bytes_of_view(model, image.bufferView, file,
                      "image " + std::to_string(model.images.size() - 1));
    }
}

}  // namespace

bool is_known_gltf_extension(const std::string& name) {
    static const std::set<std::string> known = {
        "KHR_lights_punctual",   "KHR_materials_emissive_strength",
        "KHR_materials_unlit",   "KHR_mesh_quantization",
        "KHR_texture_transform", "VRM",
        "VRMC_materials_mtoon",  "VRMC_node_constraint",
        "VRMC_springBone",       "VRMC_vrm"};
    return known.contains(name);
}

fs::path file_of_uri(const fs::path& file, std::string_view uri) {
    const fs::path decoded = file.parent_path() / decoded_uri(uri);
    const fs::path as_it_is = file.parent_path() / fs::path(uri);
    std::error_code ignored;
    return !fs::exists(decoded, ignored) && fs::exists(as_it_is, ignored) ? as_it_is : decoded;
}

Bytes bytes_of_data_uri(std::string_view uri, const fs::path& file, const std::string& what) {
    const std::size_t comma = uri.find(',');
    if (comma == uri.npos) throw InputError(file, what + ": its data URI has no data");
    const std::string data = decoded_uri(uri.substr(comma + 1));
    if (!uri.substr(0, comma).ends_with(";base64")) return {data.begin(), data.end()};
    const auto digit = [](char c) {
        if (c >= 'A' && c <= 'Z') return c - 'A';
        if (c >= 'a' && c <= 'z') return c - 'a' + 26;
        if (c >= '0' && c <= '9') return c - '0' + 52;
        return c == '+' ? 62 : c == '/' ? 63 : -1;
    };
    Bytes bytes;
    bytes.reserve(data.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int place = 0;  // of a digit in its four
    for (const char c : std::string_view(data).substr(0, data.find_last_not_of('=') + 1)) {
        if (digit(c) < 0) throw InputError(file, what + ": its data URI is not base64");
        bits = bits << 6 | static_cast<std::uint32_t>(digit(c));
        if (place > 0) bytes.push_back(static_cast<std::uint8_t>(bits >> (2 * (3 - place))));
        place = (place + 1) % 4;
    }
    return bytes;
}

tinygltf::Model read_gltf_document(const fs::path& file, LoadBudget& budget, Warnings& warnings) {
    const Bytes bytes = read_charged(file, budget);
    const Content content = content_of(bytes, file, warnings);
    json document = checked_json(content.text, file, budget);
    // Buffers and images are read here: tinygltf takes "+" in a URI for a blank, and refuses much.
    const json buffers = take_list(document, "buffers"), images = take_list(document, "images");
    // It also finds fault with skins without matrices, which they need not have.
    if (document.contains("skins") && document["skins"].is_array())
        for (json& skin : document["skins"])
            if (skin.is_object()) skin.emplace("inverseBindMatrices", -1);
    const std::string text = document.dump();
    document = nullptr;

    tinygltf::Model model;
    tinygltf::TinyGLTF reader;
    std::string error, warning;
    bool is_read = false;
    try {
        is_read = reader.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                             static_cast<unsigned int>(text.size()), "");
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& failure) {  // of its own .at() or JSON
        throw InputError(file, "damaged: " + one_line(failure.what()));
    }
    if (!is_read) throw InputError(file, one_line(error.empty() ? "damaged" : error));
    if (!error.empty()) warnings.add(file, 0, one_line(error));
    add_buffers(model, buffers, content, file, budget);
    add_images(model, images, file);
    return model;
}

ByteView bytes_of_view(const tinygltf::Model& model, int view, const fs::path& file,
                       const std::string& what) {
    if (view < 0 || static_cast<std::size_t>(view) >= model.bufferViews.size())
        throw InputError(file, what + ": there is no buffer view " + std::to_string(view));
    const tinygltf::BufferView& found = model.bufferViews[static_cast<std::size_t>(view)];
    if (found.buffer < 0 || static_cast<std::size_t>(found.buffer) >= model.buffers.size())
        throw InputError(file, what + ": there is no buffer " + std::to_string(found.buffer));
    const ByteView all = model.buffers[static_cast<std::size_t>(found.buffer)].data;
    if (found.byteOffset > all.size() || found.byteLength > all.size() - found.byteOffset)
        throw InputError(
            file, what + ": buffer view " + std::to_string(view) + " reaches beyond its buffer");
    return all.subspan(found.byteOffset, found.byteLength);
}

GltfArray::GltfArray(const tinygltf::Model& model, int accessor, const fs::path& file,
                     std::string what)
    : file_(file), what_(std::move(what)) {
    if (accessor < 0 || static_cast<std::size_t>(accessor) >= model.accessors.size())
        fail("there is no accessor " + std::to_string(accessor));
    const tinygltf::Accessor& found = model.accessors[static_cast<std::size_t>(accessor)];
    what_ += ": accessor " + std::to_string(accessor);
    if (found.sparse.isSparse) fail("is sparse, which is not read");
    if (found.bufferView < 0) fail("has no buffer view");
    bytes_ = bytes_of_view(model, found.bufferView, file, what_);

    count_ = found.count;
    type_ = found.componentType;
    is_normalized_ = found.normalized;
    components_ = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(found.type));
    const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type_));
    if (components_ < 1 || size < 1 || type_ == TINYGLTF_COMPONENT_TYPE_INT ||
        type_ == TINYGLTF_COMPONENT_TYPE_DOUBLE)
        fail("has numbers of an unknown type, " + std::to_string(type_));

    const auto element = static_cast<std::size_t>(components_ * size);
    stride_ = model.bufferViews[static_cast<std::size_t>(found.bufferView)].byteStride;
    if (stride_ == 0) stride_ = element;
    if (stride_ < element)
        fail("has elements of " + std::to_string(element) + " bytes, one every " +
             std::to_string(stride_));
    if (found.byteOffset > bytes_.size()) fail("begins beyond its buffer view");
    bytes_ = bytes_.subspan(found.byteOffset);
    if (count_ > 0 && (bytes_.size() < element || (bytes_.size() - element) / stride_ < count_ - 1))
        fail("has " + std::to_string(count_) + " elements, more than its buffer view can hold");
}

bool GltfArray::is_unsigned() const {
    return type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
           type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

double GltfArray::number(std::size_t element, int component) const {
    const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type_));
    const std::size_t at = element * stride_ + static_cast<std::size_t>(component * size);
    const auto whole = [&](double value, double greatest) {
        return is_normalized_ ? std::max(value / greatest, -1.0) : value;
    };
    switch (type_) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return whole(bytes_[at], 255);
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return whole(static_cast<std::int8_t>(bytes_[at]), 127);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return whole(u16_at(bytes_, at), 65535);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return whole(static_cast<std::int16_t>(u16_at(bytes_, at)), 32767);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return whole(u32_at(bytes_, at), 4294967295);
        default: {
            const auto value = std::bit_cast<float>(u32_at(bytes_, at));
            if (!std::isfinite(value))
                fail("element " + std::to_string(element) + " is not a finite number");
            return value;
        }
    }
}

dvec4 GltfArray::vector(std::size_t element) const {
    dvec4 vector(0, 0, 0, 1);
    for (int i = 0; i < std::min(components_, 4); ++i) vector[i] = number(element, i);
    return vector;
}

dmat4 GltfArray::matrix(std::size_t element) const {
    dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = number(element, i);
    return matrix;
}

void GltfArray::fail(const std::string& what) const { throw InputError(file_, what_ + ' ' + what); }

}  // namespace rasterbook
