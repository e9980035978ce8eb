// SPDX-License-Identifier: MIT
/// @file
/// glTF files as the generator writes them.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "assets/generate/model.hpp"
#include "common/image/image_bytes.hpp"

namespace rasterbook::assets {

using nlohmann::json;

/// A corner as glTF has it: all of its numbers together are one vertex.
struct GltfVertex {
    vec3 position, normal{0};
    vec2 uv{0};
    vec3 color{1};  ///< Linear, 0 to 1.
};

/// The vertices and triangles of one material.
class GltfPrimitive {
  public:
    /// What is written beside the positions.
    struct Has {
        bool normals = true, uvs = true, colors = false;
    };

    GltfPrimitive(int material, Has has) : material_(material), has_(has) {}

    /// @param polygon  Convex; cut into a fan.
    void add(const std::vector<GltfVertex>& polygon) {
        for (std::size_t i = 2; i < polygon.size(); ++i)
            for (const std::size_t corner : {std::size_t{0}, i - 1, i})
                indices_.push_back(index_of(polygon[corner]));
    }

    int material() const { return material_; }
    Has has() const { return has_; }
    const std::vector<GltfVertex>& vertices() const { return vertices_; }
    const std::vector<std::uint32_t>& indices() const { return indices_; }

  private:
    std::uint32_t index_of(const GltfVertex& vertex) {
        const std::array<float, 11> key{vertex.position.x, vertex.position.y, vertex.position.z,
                                        vertex.normal.x,   vertex.normal.y,   vertex.normal.z,
                                        vertex.uv.x,       vertex.uv.y,       vertex.color.x,
                                        vertex.color.y,    vertex.color.z};
        const auto [found, is_new] =
            indices_of_vertices_.try_emplace(key, static_cast<std::uint32_t>(vertices_.size()));
        if (is_new) vertices_.push_back(vertex);
        return found->second;
    }

    int material_;
    Has has_;
    std::vector<GltfVertex> vertices_;
    std::vector<std::uint32_t> indices_;
    std::map<std::array<float, 11>, std::uint32_t> indices_of_vertices_;
};

/// A file in the making.
class GltfFile {
  public:
    explicit GltfFile(const std::string& scene_name)
        : json_{{"asset", {{"version", "2.0"}, {"generator", "Rasterbook"}}},
                {"scene", 0},
                {"scenes", json::array({{{"name", scene_name}, {"nodes", json::array()}}})}} {}

    /// Adds to one of the file's lists; gives the index there.
    int add(const char* list, json object) {
        json_[list].push_back(std::move(object));
        return static_cast<int>(json_[list].size()) - 1;
    }

    int add_node(json node) {
        const int index = add("nodes", std::move(node));
        json_["scenes"][0]["nodes"].push_back(index);
        return index;
    }

    void use_extension(const char* name) { json_["extensionsUsed"].push_back(name); }

    /// A picture beside the file, repeated.
    json texture(const std::string& uri) {
        const auto [found, is_new] = textures_.try_emplace(uri, 0);
        if (is_new) {
            if (!json_.contains("samplers"))  // linear, with smaller copies; repeated
                add("samplers", {{"magFilter", 9729}, {"minFilter", 9987}});
            found->second =
                add("textures", {{"sampler", 0}, {"source", add("images", {{"uri", uri}})}});
        }
        return {{"index", found->second}};
    }

    int add_mesh(const std::string& name, const std::vector<GltfPrimitive>& primitives) {
        json mesh{{"name", name}, {"primitives", json::array()}};
        for (const GltfPrimitive& primitive : primitives)
            mesh["primitives"].push_back(written(primitive));
        return add("meshes", std::move(mesh));
    }

    /// A node that stands at `eye` and looks along -z at `target`, y up.
    static json looking(dvec3 eye, dvec3 target) {
        // + 0.0: no -0
        const dvec3 z = glm::normalize(eye - target) + 0.0;
        const dvec3 x = glm::normalize(glm::cross(dvec3(0, 1, 0), z)) + 0.0;
        const dvec3 y = glm::cross(z, x) + 0.0;
        return {{"matrix",
                 {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, eye.x, eye.y, eye.z, 1}}};
    }

    void add_camera(const std::string& name, dvec3 eye, dvec3 target, double yfov) {
        json node = looking(eye, target);
        node["name"] = name;
        node["camera"] = add("cameras", {{"type", "perspective"},
                                         {"perspective", {{"yfov", yfov}, {"znear", 0.1}}}});
        add_node(node);
    }

    /// @param light  As KHR_lights_punctual has it.
    void add_light(const std::string& name, dvec3 eye, dvec3 target, json light) {
        json& lights = json_["extensions"]["KHR_lights_punctual"]["lights"];
        json node = looking(eye, target);
        node["name"] = name;
        node["extensions"]["KHR_lights_punctual"]["light"] = lights.size();
        lights.push_back(std::move(light));
        add_node(node);
    }

    /// The JSON of a file whose bytes stand in another one.
    std::string text(const std::string& buffer_uri) {
        json_["buffers"] = json::array({{{"byteLength", bytes_.size()}, {"uri", buffer_uri}}});
        return json_.dump(1) + '\n';
    }
    const Bytes& bytes() const { return bytes_; }

    /// The whole as one file: 12 bytes, then JSON and numbers as two chunks.
    Bytes glb() {
        json_["buffers"] = json::array({{{"byteLength", bytes_.size()}}});
        std::string text = json_.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        Bytes file{'g', 'l', 'T', 'F'};
        append_u32(file, 2);
        append_u32(file, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + bytes_.size()));
        append_u32(file, static_cast<std::uint32_t>(text.size()));
        file.insert(file.end(), {'J', 'S', 'O', 'N'});
        file.insert(file.end(), text.begin(), text.end());
        append_u32(file, static_cast<std::uint32_t>(bytes_.size()));
        file.insert(file.end(), {'B', 'I', 'N', 0});
        file.insert(file.end(), bytes_.begin(), bytes_.end());
        return file;
    }

  private:
    static constexpr int gl_unsigned_short = 5123, gl_unsigned_int = 5125, gl_float = 5126;
    static constexpr int for_vertices = 34962, for_indices = 34963;

    /// One accessor of a buffer view of its own.
    ///
    /// @param append  Called for each element as append(i); appends its bytes.
    template <typename Append>
    int add_array(std::size_t count, const char* type, int component, int target, Append&& append) {
        const std::size_t begin = bytes_.size();
        for (std::size_t i = 0; i < count; ++i) append(i);
        const int view = add("bufferViews", {{"buffer", 0},
                                             {"byteOffset", begin},
                                             {"byteLength", bytes_.size() - begin},
                                             {"target", target}});
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
        return add(
            "accessors",
            {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
    }

    void append_float(float x) { append_u32(bytes_, std::bit_cast<std::uint32_t>(x + 0.0f)); }

    json written(const GltfPrimitive& primitive) {
        const std::vector<GltfVertex>& all = primitive.vertices();
        vec3 least(std::numeric_limits<float>::infinity()), most = -least;
        for (const GltfVertex& vertex : all)
            least = glm::min(least, vertex.position), most = glm::max(most, vertex.position);
        json attributes;
        const auto append3 = [&](vec3 v) {
            append_float(v.x), append_float(v.y), append_float(v.z);
        };
        const int positions = add_array(all.size(), "VEC3", gl_float, for_vertices,
                                        [&](std::size_t i) { append3(all[i].position); });
        json_["accessors"][static_cast<std::size_t>(positions)]["min"] = {least.x, least.y,
                                                                          least.z};
        json_["accessors"][static_cast<std::size_t>(positions)]["max"] = {most.x, most.y, most.z};
        attributes["POSITION"] = positions;
        if (primitive.has().normals)
            attributes["NORMAL"] = add_array(all.size(), "VEC3", gl_float, for_vertices,
                                             [&](std::size_t i) { append3(all[i].normal); });
        if (primitive.has().uvs)  // v points down there
            attributes["TEXCOORD_0"] = add_array(
                all.size(), "VEC2", gl_float, for_vertices,
                [&](std::size_t i) { append_float(all[i].uv.x), append_float(1 - all[i].uv.y); });
        if (primitive.has().colors) {
            const int colors =
                add_array(all.size(), "VEC4", gl_unsigned_short, for_vertices, [&](std::size_t i) {
                    for (int k = 0; k < 3; ++k)
                        append_u16(bytes_, static_cast<std::uint16_t>(
                                               std::floor(all[i].color[k] * 65535 + 0.5f)));
                    append_u16(bytes_, 65535);
                });
            json_["accessors"][static_cast<std::size_t>(colors)]["normalized"] = true;
            attributes["COLOR_0"] = colors;
        }
        const bool is_short = all.size() <= 65535;
        const int indices = add_array(
            primitive.indices().size(), "SCALAR", is_short ? gl_unsigned_short : gl_unsigned_int,
            for_indices, [&](std::size_t i) {
                if (is_short)
                    append_u16(bytes_, static_cast<std::uint16_t>(primitive.indices()[i]));
                else
                    append_u32(bytes_, primitive.indices()[i]);
            });
        return {
            {"attributes", attributes}, {"indices", indices}, {"material", primitive.material()}};
    }

    json json_;
    Bytes bytes_;
    std::map<std::string, int> textures_;
};

/// The parts of a model, each with the index of its material.
///
/// @param material_of  Called as material_of(std::string): the index of a material of that name.
template <typename MaterialOf>
std::vector<GltfPrimitive> primitives_of(const std::vector<Part>& parts, GltfPrimitive::Has has,
                                         MaterialOf&& material_of) {
    std::vector<GltfPrimitive> primitives;
    std::map<int, std::size_t> of_material;
    for (const Part& part : parts) {
        const int material = material_of(part.material);
        const auto [found, is_new] = of_material.try_emplace(material, primitives.size());
        if (is_new) primitives.emplace_back(material, has);
        for (const Polygon& polygon : part.faces) {
            std::vector<GltfVertex> corners;
            for (const Vertex& vertex : polygon) {
                GltfVertex corner{vec3(vertex.position)};
                if (has.normals) corner.normal = vec3(vertex.normal);
                if (has.uvs) corner.uv = vec2(vertex.uv);
                corners.push_back(corner);
            }
            primitives[found->second].add(corners);
        }
    }
    return primitives;
}

}  // namespace rasterbook::assets
