// SPDX-License-Identifier: MIT
#include "common/model/gltf_materials.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "common/math/color.hpp"
#include "common/model/metallic_roughness.hpp"
#include "common/model/texture_file.hpp"

namespace rasterbook {
namespace {

namespace fs = std::filesystem;
using tinygltf::Value;

/// The extension of that name, or null.
const Value* find_extension(const tinygltf::ExtensionMap& extensions, const std::string& name) {
    const auto found = extensions.find(name);
    return found != extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

/// Three numbers from 0 to 1 of an object of an extension.
vec3 color_in(const Value& object, const std::string& key, vec3 missing) {
    if (!object.Has(key)) return missing;
    const Value& color = object.Get(key);
    if (!color.IsArray() || color.ArrayLen() < 3) return missing;
    for (int i = 0; i < 3; ++i) {
        const Value& number = color.Get(i);
        if (!number.IsNumber()) return missing;
        missing[i] = static_cast<float>(std::clamp(number.GetNumberAsDouble(), 0.0, 1.0));
    }
    return missing;
}

/// Makes our materials of those of a file.
class MaterialMaker {
  public:
    MaterialMaker(const tinygltf::Model& model, const fs::path& file, LoadBudget& budget,
                  Warnings& warnings)
        : model_(model), file_(file), budget_(budget), warnings_(warnings) {}

    Material make(std::size_t index);

  private:
    /// An image in the file.
    struct Embedded {
        std::shared_ptr<const Bytes> bytes;
        fs::path name;  ///< With the media type.
    };

    TextureMap map_of(int texture, const tinygltf::ExtensionMap& extensions, const char* which);
    void add_picture(TextureMap& map, int texture);
    Embedded embedded(const tinygltf::Image& from, const std::string& label);
    void add_sampler(TextureMap& map, int sampler);
    void add_look(Material& material, const tinygltf::Material& from);
    void add_toon(Material& material, const tinygltf::Material& from, std::size_t index);
    vec3 mean_of(const TextureMap& map, bool is_srgb);

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(file_, name_ + ": " + what);
    }
    void warn(const std::string& what) { warnings_.add(file_, 0, name_ + ": " + what); }
    float finite(double number, const char* what) const {
        const auto narrow = static_cast<float>(number);
        if (!std::isfinite(narrow)) fail(std::string(what) + " is out of range");
        return narrow;
    }

    const tinygltf::Model& model_;
    const fs::path& file_;
    LoadBudget& budget_;
    Warnings& warnings_;

    std::map<std::pair<int, int>, Embedded> embedded_;  ///< By buffer view, or -1 and the image.
    std::map<std::pair<fs::path, bool>, vec3> means_;   ///< Of pictures, as sRGB or plain.
    std::string name_;                                  ///< Of the material, for messages.
};

/// A picture beside the file, or in it.
void MaterialMaker::add_picture(TextureMap& map, int texture) {
    const tinygltf::Texture& named = model_.textures[static_cast<std::size_t>(texture)];
    if (named.source == -1) {
        map.file = file_.string() + ", texture " + std::to_string(texture);
        map.unreadable = "has no image";
        for (const auto& [name, extension] : named.extensions)
            if (extension.Has("source"))
                map.unreadable += " but that of " + name + ", which is not read";
        return;
    }
    const std::string label = "image " + std::to_string(named.source);
    if (named.source < 0 || static_cast<std::size_t>(named.source) >= model_.images.size())
        throw InputError(file_, map.asked_by + " names " + label + ", which is not there");
    const tinygltf::Image& from = model_.images[static_cast<std::size_t>(named.source)];
    if (from.bufferView < 0 && !is_data_uri(from.uri)) {
        map.file = file_of_uri(file_, from.uri);
        if (from.uri.empty()) map.unreadable = label + " has neither uri nor bufferView";
        return;
    }
    // Images of one view are one: its name is that of the first.
    Embedded& own = embedded_[{from.bufferView, from.bufferView < 0 ? named.source : 0}];
    if (!own.bytes) own = embedded(from, label);
    map.embedded = own.bytes;
    map.file = own.name;
}

/// @param label  Of the image, for messages.
MaterialMaker::Embedded MaterialMaker::embedded(const tinygltf::Image& from,
                                                const std::string& label) {
    Bytes bytes;
    std::string media_type = from.mimeType;
    if (from.bufferView < 0) {
        bytes = bytes_of_data_uri(from.uri, file_, label);
        media_type = from.uri.substr(5, from.uri.find_first_of(",;") - 5);
    } else {
        const ByteView view = bytes_of_view(model_, from.bufferView, file_, label);
        bytes.assign(view.begin(), view.end());
    }
    budget_.charge(Resource::bytes, bytes.size(), file_);
    return {std::make_shared<const Bytes>(std::move(bytes)),
            file_.string() + ", " + label +
                (media_type.empty() ? "" : " (" + media_type.substr(0, 40) + ")")};
}

/// Wrapping, and whether texels are to be sharp. Mip levels are read as --filter has it: some
/// exporters ask for the nearest texel there where none is meant.
void MaterialMaker::add_sampler(TextureMap& map, int sampler) {
    if (sampler < 0) return;
    if (static_cast<std::size_t>(sampler) >= model_.samplers.size())
        throw InputError(file_, map.asked_by + " names sampler " + std::to_string(sampler) +
                                    ", which is not there");
    const tinygltf::Sampler& from = model_.samplers[static_cast<std::size_t>(sampler)];
    const std::array wraps{from.wrapS, from.wrapT};
    for (int axis = 0; axis < 2; ++axis) {
        const int wrap = wraps[static_cast<std::size_t>(axis)];
        map.clamp[axis] = wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
        map.mirror[axis] = wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    }
    map.nearest_magnified = from.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    map.nearest_minified = from.minFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
}

TextureMap MaterialMaker::map_of(int texture, const tinygltf::ExtensionMap& extensions,
                                 const char* which) {
    TextureMap map;
    if (texture < 0) return map;
    map.library = file_;
    map.asked_by = name_ + ": " + which;
    if (static_cast<std::size_t>(texture) >= model_.textures.size())
        fail(std::string(which) + " names texture " + std::to_string(texture) +
             ", which is not there");
    const tinygltf::Texture& from = model_.textures[static_cast<std::size_t>(texture)];
    add_picture(map, texture);
    add_sampler(map, from.sampler);
    if (const Value* transform = find_extension(extensions, "KHR_texture_transform")) {
        const auto numbers = [&](const char* key, float missing) {
            dvec2 pair(missing);
            if (transform->Has(key) && transform->Get(key).ArrayLen() >= 2)
                for (int i = 0; i < 2; ++i) {
                    const Value& number = transform->Get(key).Get(i);
                    if (number.IsNumber()) pair[i] = number.GetNumberAsDouble();
                }
            return pair;
        };
        const dvec2 offset = numbers("offset", 0), scale = numbers("scale", 1);
        // There v points down: 1 - v becomes (1 - v) s + o, and v becomes v s + (1 - s - o).
        finite(glm::length(scale), "scale"), finite(glm::length(offset), "offset");
        map.scale = {scale, 1};
        map.offset = {offset.x, 1 - scale.y - offset.y, 0};
        if (transform->Has("texCoord"))
            warn(std::string(which) +
                 ": KHR_texture_transform's own set of texture coordinates is "
                 "passed over");
        if (number_in(*transform, "rotation", 0) != 0)
            warn(std::string(which) + " is turned (KHR_texture_transform), which is passed over");
    }
    return map;
}

/// The mean of a picture's colours; 1, with a warning, where it cannot be read.
vec3 MaterialMaker::mean_of(const TextureMap& map, bool is_srgb) {
    const auto known = means_.find({map.file, is_srgb});
    if (known != means_.end()) return known->second;
    try {
        const Image<u8vec4> picture = read_texture_file(map, budget_);
        std::array<std::array<std::uint64_t, 256>, 3> counts{};
        for (const u8vec4 pixel : picture.pixels())
            for (int i = 0; i < 3; ++i) ++counts[static_cast<std::size_t>(i)][pixel[i]];
        dvec3 sum(0);
        for (int i = 0; i < 3; ++i)
            for (std::size_t stored = 0; stored < 256; ++stored) {
                const double value = static_cast<double>(stored) / 255;
                sum[i] += static_cast<double>(counts[static_cast<std::size_t>(i)][stored]) *
                          (is_srgb ? linear_from_srgb(value) : value);
            }
        return means_[{map.file, is_srgb}] =
                   vec3(sum / static_cast<double>(picture.pixels().size()));
    } catch (const InputError& error) {
        warnings_.add(file_, 0, map.asked_by + ": " + error.what());
        return means_[{map.file, is_srgb}] = vec3(1);
    }
}

/// Colours and highlight (docs/gltf.md).
void MaterialMaker::add_look(Material& material, const tinygltf::Material& from) {
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    vec3 base;
    for (int i = 0; i < 3; ++i)
        base[i] =
            std::clamp(finite(pbr.baseColorFactor[static_cast<std::size_t>(i)], "baseColorFactor"),
                       0.0f, 1.0f);
    material.diffuse_map =
        map_of(pbr.baseColorTexture.index, pbr.baseColorTexture.extensions, "baseColorTexture");
    if (material.illumination == 0 || material.toon) {  // these know no metal
        material.diffuse = material.ambient = base;
        return;
    }
    float metallic = std::clamp(finite(pbr.metallicFactor, "metallicFactor"), 0.0f, 1.0f);
    float roughness = std::clamp(finite(pbr.roughnessFactor, "roughnessFactor"), 0.0f, 1.0f);
    const TextureMap map =
        map_of(pbr.metallicRoughnessTexture.index, pbr.metallicRoughnessTexture.extensions,
               "metallicRoughnessTexture");
    if (!map.file.empty()) {
        const vec3 mean = mean_of(map, false);
        roughness *= mean.g, metallic *= mean.b;
    }
    material.diffuse = material.ambient = base * (1 - metallic);
    // A metal has the colour of its highlight from the picture, too: from its mean.
    const bool is_tinted = metallic > 0 && !material.diffuse_map.file.empty();
    const PhongNumbers phong = phong_from_metallic_roughness(
        is_tinted ? base * mean_of(material.diffuse_map, true) : base, metallic, roughness);
    material.specular = phong.specular;
    material.shininess = phong.shininess;
}

/// By VRMC_materials_mtoon, or by VRM 0, whose list of properties has one entry a material.
///
/// @see UniVRM, MToon10Migrator.cs, for what the older numbers mean in the newer ones
void MaterialMaker::add_toon(Material& material, const tinygltf::Material& from,
                             std::size_t index) {
    ToonMaterial toon;
    if (const Value* mtoon = find_extension(from.extensions, "VRMC_materials_mtoon")) {
        toon.shade = color_in(*mtoon, "shadeColorFactor", vec3(0));
        toon.toony = finite(number_in(*mtoon, "shadingToonyFactor", toon.toony), "toony");
        toon.shift = finite(number_in(*mtoon, "shadingShiftFactor", toon.shift), "shift");
        toon.outline_color = color_in(*mtoon, "outlineColorFactor", toon.outline_color);
        toon.outline_width = finite(number_in(*mtoon, "outlineWidthFactor", 0), "outline");
        const Value& mode = mtoon->Get("outlineWidthMode");
        const std::string word = mode.IsString() ? mode.Get<std::string>() : "none";
        if (word == "worldCoordinates") toon.outline = ToonMaterial::Outline::world;
        if (word == "screenCoordinates") toon.outline = ToonMaterial::Outline::screen;
        for (const char* part :
             {"shadeMultiplyTexture", "shadingShiftTexture", "matcapTexture", "rimMultiplyTexture",
              "outlineWidthMultiplyTexture", "uvAnimationMaskTexture"})
            if (mtoon->Has(part)) warn(std::string(part) + " is passed over");
    } else {
        const Value* vrm = find_extension(model_.extensions, "VRM");
        if (!vrm || !vrm->Has("materialProperties")) return;
        const Value& all = vrm->Get("materialProperties");
        if (!all.IsArray() || index >= all.ArrayLen()) return;
        const Value& own = all.Get(static_cast<int>(index));
        if (!own.IsObject() || !own.Has("shader") || !own.Get("shader").IsString() ||
            own.Get("shader").Get<std::string>() != "VRM/MToon")
            return;
        const Value &numbers = own.Get("floatProperties"), &colors = own.Get("vectorProperties");
        const auto linear = [](vec3 color) {
            return vec3(linear_from_srgb(color.r), linear_from_srgb(color.g),
                        linear_from_srgb(color.b));
        };
        toon.shade = linear(color_in(colors, "_ShadeColor", {0.97f, 0.81f, 0.86f}));
        toon.outline_color = linear(color_in(colors, "_OutlineColor", toon.outline_color));
        // Light begins at `from_cosine` and is full at `to_cosine`.
        const double from_cosine = number_in(numbers, "_ShadeShift", 0);
        const double to_cosine = 1 + (from_cosine - 1) * number_in(numbers, "_ShadeToony", 0.9);
        toon.toony = finite((2 - (to_cosine - from_cosine)) / 2, "_ShadeToony");
        toon.shift = finite(-(to_cosine + from_cosine) / 2, "_ShadeShift");
        const double mode = number_in(numbers, "_OutlineWidthMode", 0);
        if (mode == 1) toon.outline = ToonMaterial::Outline::world;
        if (mode == 2) toon.outline = ToonMaterial::Outline::screen;
        // In centimetres, or in hundredths of half of the picture's height.
        const double share = toon.outline == ToonMaterial::Outline::screen ? 0.005 : 0.01;
        toon.outline_width =
            finite(share * number_in(numbers, "_OutlineWidth", 0), "_OutlineWidth");
    }
    toon.toony = std::clamp(toon.toony, 0.0f, 1.0f);
    toon.shift = std::clamp(toon.shift, -1.0f, 1.0f);
    toon.outline_width = std::max(toon.outline_width, 0.0f);
    material.toon = toon;
}

Material MaterialMaker::make(std::size_t index) {
    const tinygltf::Material& from = model_.materials[index];
    name_ = name_of_material(model_, static_cast<int>(index));
    Material material;
    material.name = from.name;
    add_toon(material, from, index);
    const bool is_unlit = from.extensions.contains("KHR_materials_unlit");
    // Files for MToon say "unlit" for programs that do not know it.
    if (material.toon)
        material.illumination = 1;
    else if (is_unlit)
        material.illumination = 0;
    add_look(material, from);

    if (material.illumination > 0) {
        float strength = 1;
        if (const Value* emissive =
                find_extension(from.extensions, "KHR_materials_emissive_strength"))
            strength = finite(number_in(*emissive, "emissiveStrength", 1), "emissiveStrength");
        for (int i = 0; i < 3; ++i)
            material.emission[i] =
                std::clamp(finite(strength * from.emissiveFactor[static_cast<std::size_t>(i)],
                                  "emissiveFactor"),
                           -max_color, max_color);
        if (from.emissiveTexture.index >= 0 && material.emission != vec3(0)) {
            material.emission_map = map_of(from.emissiveTexture.index,
                                           from.emissiveTexture.extensions, "emissiveTexture");
        }
        if (from.occlusionTexture.index >= 0) warn("occlusionTexture is passed over");
        material.normal_map =
            map_of(from.normalTexture.index, from.normalTexture.extensions, "normalTexture");
        material.normal_map.bump_multiplier = finite(from.normalTexture.scale, "scale");
    }

    if (from.alphaMode == "MASK") material.alpha = AlphaMode::mask;
    if (from.alphaMode == "BLEND") material.alpha = AlphaMode::blend;
    material.alpha_cutoff = finite(from.alphaCutoff, "alphaCutoff");
    if (material.alpha != AlphaMode::opaque)
        material.opacity = std::clamp(
            finite(from.pbrMetallicRoughness.baseColorFactor[3], "baseColorFactor"), 0.0f, 1.0f);
    material.two_sided = from.doubleSided;

    const int set = uv_set_of(from);
    for (const auto& [texture, uv_set] :
         {std::pair(from.pbrMetallicRoughness.baseColorTexture.index,
                    from.pbrMetallicRoughness.baseColorTexture.texCoord),
          std::pair(from.emissiveTexture.index, from.emissiveTexture.texCoord),
          std::pair(from.normalTexture.index, from.normalTexture.texCoord)})
        if (texture >= 0 && uv_set != set)
            warn("its textures have several sets of texture coordinates; set " +
                 std::to_string(set) + " is taken for all");
    return material;
}

}  // namespace

double number_in(const Value& object, const std::string& key, double missing) {
    if (!object.IsObject() || !object.Has(key) || !object.Get(key).IsNumber()) return missing;
    return object.Get(key).GetNumberAsDouble();
}

std::string name_of_material(const tinygltf::Model& model, int index) {
    const std::string& name = model.materials[static_cast<std::size_t>(index)].name;
    return "material " + std::to_string(index) + (name.empty() ? "" : " \"" + name + "\"");
}

int uv_set_of(const tinygltf::Material& material) {
    const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    if (pbr.baseColorTexture.index >= 0) return pbr.baseColorTexture.texCoord;
    if (material.normalTexture.index >= 0) return material.normalTexture.texCoord;
    return material.emissiveTexture.index >= 0 ? material.emissiveTexture.texCoord : 0;
}

std::vector<Material> gltf_materials(const tinygltf::Model& model, const fs::path& file,
                                     LoadBudget& budget, Warnings& warnings) {
    std::vector<Material> materials{Material{}};
    MaterialMaker maker(model, file, budget, warnings);
    for (std::size_t i = 0; i < model.materials.size(); ++i) materials.push_back(maker.make(i));
    return materials;
}

}  // namespace rasterbook
