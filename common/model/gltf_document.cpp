// SPDX-License-Identifier: MIT
// tinygltf is one header, and includes less than it needs. Files and pictures are read by our own
// functions, which are more careful.
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
#include <set>
#include <string_view>

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

/// The JSON of a file, which for .glb is the first of its chunks.
///
/// Chunks: a length, a kind and as many bytes. The whole begins with 12 bytes: "glTF", the version
/// and the length of the file.
ByteView json_of(ByteView bytes, const fs::path& file) {
    constexpr std::size_t header = 12, chunk_header = 8;
    if (bytes.size() < 4 || std::memcmp(bytes.data(), "glTF", 4) != 0) return bytes;
    if (bytes.size() < header + chunk_header)
        throw InputError(file, "truncated: the header of a .glb file has 20 bytes");
    if (u32_at(bytes, 4) != 2)
        throw InputError(file, "is glTF " + std::to_string(u32_at(bytes, 4)) + ", not 2");
    if (u32_at(bytes, 8) != bytes.size())
        throw InputError(file, (u32_at(bytes, 8) > bytes.size() ? "truncated: " : "damaged: ") +
                                   std::to_string(bytes.size()) + " of " +
                                   std::to_string(u32_at(bytes, 8)) + " bytes are there");
    for (std::size_t at = header; at < bytes.size();) {
        if (bytes.size() - at < chunk_header ||
            u32_at(bytes, at) > bytes.size() - at - chunk_header)
            throw InputError(file, "damaged: a chunk reaches beyond the end of the file");
        at += chunk_header + u32_at(bytes, at);
    }
    if (u32_at(bytes, 16) != 0x4e4f534a)  // "JSON"
        throw InputError(file, "damaged: its first chunk is not JSON");
    return bytes.subspan(header + chunk_header, u32_at(bytes, header));
}

/// A whole number in an object; `missing` when there is none that is >= 0.
std::uint64_t whole_number(const json& object, const char* key, std::uint64_t missing) {
    const auto found = object.is_object() ? object.find(key) : object.end();
    return found != object.end() && found->is_number_unsigned() ? found->get<std::uint64_t>()
                                                                : missing;
}

const json& at_or_null(const json& array, std::uint64_t index) {
    static const json null;
    return array.is_array() && index < array.size() ? array[index] : null;
}

/// What tinygltf takes for granted: pictures in buffer views begin inside their buffers.
void check_image_views(const json& document, const fs::path& file) {
    const json none = json::array();
    const json& images = document.contains("images") ? document["images"] : none;
    const json& views = document.contains("bufferViews") ? document["bufferViews"] : none;
    const json& buffers = document.contains("buffers") ? document["buffers"] : none;
    for (std::size_t i = 0; images.is_array() && i < images.size(); ++i) {
        if (!images[i].is_object() || !images[i].contains("bufferView")) continue;
        constexpr auto missing = std::numeric_limits<std::uint64_t>::max();
        const json& view = at_or_null(views, whole_number(images[i], "bufferView", missing));
        const json& buffer = at_or_null(buffers, whole_number(view, "buffer", missing));
        const std::uint64_t end = whole_number(buffer, "byteLength", 0);
        const std::uint64_t begin = whole_number(view, "byteOffset", 0);
        if (begin >= end || whole_number(view, "byteLength", missing) > end - begin)
            throw InputError(file, "image " + std::to_string(i) + " lies beyond its buffer");
    }
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
void check_json(ByteView text, const fs::path& file, LoadBudget& budget) {
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
    check_image_views(document, file);
}

/// For the files that a document names.
struct FileAccess {
    LoadBudget& budget;
    std::string error;  ///< The first.
};

/// Our own file access, which tinygltf is given in place of its own. From 2.9 on it takes all of
/// the functions or none; before 2.8.17 it has no member for the last of them.
template <typename Callbacks = tinygltf::FsCallbacks>
Callbacks file_callbacks(FileAccess& access) {
    Callbacks callbacks{};
    // The first place that is looked in, beside the scene's file, is the only one.
    callbacks.FileExists = [](const std::string&, void*) { return true; };
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>* bytes, std::string*,
                                 const std::string& path, void* user_data) {
        auto& [budget, error] = *static_cast<FileAccess*>(user_data);
        try {
            *bytes = read_charged(path, budget);
            return true;
        } catch (const InputError& failure) {
            error = failure.what();
            return false;
        }
    };
    callbacks.WriteWholeFile = [](std::string*, const std::string&,
                                  const std::vector<unsigned char>&, void*) { return false; };
    if constexpr (requires { callbacks.GetFileSizeInBytes; })  // read_whole_file() limits the size
        callbacks.GetFileSizeInBytes = [](std::size_t* size, std::string*, const std::string&,
                                          void*) {
            *size = 0;
            return true;
        };
    callbacks.user_data = &access;
    return callbacks;
}

/// Keeps the bytes of a picture that stands in the JSON itself; those of a view are there already.
bool keep_image(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                const unsigned char* bytes, int size, void*) {
    if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
    return true;
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

tinygltf::Model read_gltf_document(const fs::path& file, LoadBudget& budget,
                                   std::string& complaint) {
    const Bytes bytes = read_charged(file, budget);
    const ByteView text = json_of(bytes, file);
    check_json(text, file, budget);

    tinygltf::Model model;
    tinygltf::TinyGLTF reader;
    FileAccess access{budget, {}};
    std::string error, warning;
    reader.SetFsCallbacks(file_callbacks(access));
    reader.SetImageLoader(keep_image, nullptr);
    bool is_read = false;
    try {
        const auto size = static_cast<unsigned int>(bytes.size());
        const std::string folder = file.parent_path().string();
        is_read =
            text.data() == bytes.data()
                ? reader.LoadASCIIFromString(&model, &error, &warning,
                                             reinterpret_cast<const char*>(bytes.data()), size,
                                             folder)
                : reader.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(), size, folder);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& failure) {  // of its own .at() or JSON
        throw InputError(file, "damaged: " + one_line(failure.what()));
    }
    if (!access.error.empty()) throw InputError(file, one_line(access.error));
    if (!is_read) throw InputError(file, one_line(error.empty() ? "damaged" : error));
    complaint = one_line(error);
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

void GltfArray::fail(const std::string& what) const { throw InputError(file_, what_ + ' ' + what); }

}  // namespace rasterbook
