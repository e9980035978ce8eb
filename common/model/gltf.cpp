// SPDX-License-Identifier: MIT
#include "common/model/gltf.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "common/image/input_error.hpp"
#include "common/math/numerics.hpp"
#include "common/model/gltf_document.hpp"
#include "common/model/gltf_materials.hpp"
#include "common/model/mtl.hpp"
#include "common/model/world_box.hpp"

namespace rasterbook {
namespace {

namespace fs = std::filesystem;

/// A point of a mesh: points that agree in all of this are one.
struct PointKey {
    std::array<std::uint32_t, 7> bits;  ///< Of position and colour.
    bool operator==(const PointKey&) const = default;
};

struct PointHash {
    std::size_t operator()(const PointKey& key) const {
        std::uint64_t hash = 0;
        for (const std::uint32_t word : key.bits)
            hash = std::rotl((hash ^ word) * 0x9e3779b97f4a7c15, 27);
        return hash;
    }
};

/// Turns normals as a matrix turns surfaces: its inverse transpose but for a factor > 0, so that
/// it is of use where the matrix is singular, too.
dmat3 world_from_normal(const dmat4& world_from_node) {
    const dvec3 x = world_from_node[0], y = world_from_node[1], z = world_from_node[2];
    const dmat3 cofactors(glm::cross(y, z), glm::cross(z, x), glm::cross(x, y));
    return glm::dot(x, cofactors[0]) < 0 ? -cofactors : cofactors;
}

bool is_mirrored(const dmat4& world_from_node) {
    return glm::determinant(dmat3(world_from_node)) < 0;
}

/// Of a camera, which is turned and moved alone: what else its node does is taken away.
dmat4 without_scale(const dmat4& world_from_node) {
    const dvec3 z = normalize_or(dvec3(world_from_node[2]), dvec3(0, 0, 1));
    const dvec3 any = std::abs(z.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 x = normalize_or(glm::cross(dvec3(world_from_node[1]), z),
                                 normalize_or(glm::cross(any, z), any));
    return {dvec4(x, 0), dvec4(glm::cross(z, x), 0), dvec4(z, 0), world_from_node[3]};
}

/// Reads a scene.
class GltfReader {
  public:
    GltfReader(const fs::path& file, const LoadBudget& budget)
        : file_(file), budget_(budget), model_(read_gltf_document(file, budget_, warnings_)) {}
    Scene read();

  private:
    /// A node that is to be read.
    struct Visit {
        int node;
        dmat4 world_from_node;  ///< Of its parent, until it is the node's turn.
    };

    /// Four joints of each element, and how much each of them moves it.
    struct Influences {
        GltfArray joints, weights;
    };

    /// What a primitive's elements have; positions are always there.
    struct Arrays {
        std::optional<GltfArray> positions, normals, colors, uvs;
        std::vector<Influences> influences;  ///< Empty: the primitive stands where its node does.
    };

    /// Where a primitive stands.
    struct Place {
        dmat4 world_from_node;
        dmat3 world_from_normal;
    };

    void warn_of_document();
    std::vector<Visit> visits_of_nodes(const std::vector<int>& roots);
    void name_node(int index);
    void read_node(const Visit& visit);
    std::vector<int> roots() const;
    dmat4 parent_from_node(const tinygltf::Node& node) const;
    void read_mesh(const tinygltf::Node& node, const dmat4& world_from_node);
    const std::vector<dmat4>& world_from_bind_of(int skin_index);
    void read_primitive(const tinygltf::Primitive& primitive, const dmat4& world_from_node);
    Arrays arrays_of(const tinygltf::Primitive& primitive);
    void warn_of_missing_uvs(const tinygltf::Primitive& primitive, int uv_set);
    std::vector<Influences> influences_of(const tinygltf::Primitive& primitive, std::size_t points);
    dmat4 posed(const std::vector<Influences>& influences, std::size_t element);
    Vertex add_vertex(const Arrays& arrays, std::uint32_t element, const Place& place);
    void place_scene();
    void finish(Mesh& mesh, const std::vector<dvec3>& positions_world) const;
    std::vector<std::uint32_t> add_points(Mesh& mesh,
                                          const std::vector<dvec3>& positions_world) const;
    std::vector<std::uint32_t> triangle_vertices(const tinygltf::Primitive& primitive,
                                                 std::size_t points);
    void add_camera(const tinygltf::Node& node, const dmat4& world_from_node);
    void add_light(const tinygltf::Node& node, const dmat4& world_from_node);
    void add_cone(SceneLight& light, const tinygltf::SpotLight& spot) const;

    [[noreturn]] void fail(const std::string& what) const { throw InputError(file_, what); }
    void warn(const std::string& what) { warnings_.add(file_, 0, what); }
    /// An element of one of the document's lists.
    template <typename Element>
    const Element& at(const std::vector<Element>& list, int index, const std::string& what) const {
        if (index < 0 || static_cast<std::size_t>(index) >= list.size())
            fail(what + " " + std::to_string(index) + " is not there");
        return list[static_cast<std::size_t>(index)];
    }
    vec3 narrowed(dvec3 v, const std::string& what) const {
        const vec3 narrow(v);
        for (int i = 0; i < 3; ++i)
            if (!std::isfinite(narrow[i])) fail(what + " is too large");
        return narrow;
    }

    const fs::path& file_;
    LoadBudget budget_;
    Warnings warnings_;
    const tinygltf::Model model_;
    Scene scene_;
    std::string node_name_, where_;  ///< For messages: the node's, and the primitive's.
    std::vector<std::optional<dmat4>> world_from_node_;  ///< Of the scene's nodes.
    std::map<int, std::vector<dmat4>> skins_;            ///< By index: as of world_from_bind_of().

    // World space; of meshes, those of their vertices' elements, until the origin is known.
    std::vector<std::vector<dvec3>> positions_of_mesh_;
    std::vector<dvec3> positions_of_cameras_, positions_of_lights_;
    WorldBox box_;

    // Of the mesh that is being read; its colors are the elements'.
    const std::vector<dmat4>* world_from_bind_ = nullptr;  ///< Of its skin's joints, if it has one.
    Mesh mesh_;
    std::vector<dvec3> positions_world_;
    bool has_colors_ = false;
};

void GltfReader::warn_of_document() {
    for (const std::string& name : model_.extensionsUsed)
        if (!is_known_gltf_extension(name)) warn("the extension " + name + " is passed over");
    if (!model_.animations.empty())
        warn(model_.skins.empty() ? "animations are passed over"
                                  : "animations are passed over: figures stand in their bind pose");
}

Scene GltfReader::read() {
    warn_of_document();
    scene_.materials = gltf_materials(model_, file_, budget_, warnings_);
    // Where joints are has to be known before the first mesh.
    for (const Visit& visit : visits_of_nodes(roots())) read_node(visit);
    if (scene_.meshes.empty()) fail("holds no faces");
    place_scene();
    scene_.warnings = warnings_.take();
    scene_.is_gltf = true;
    scene_.budget = budget_;
    return std::move(scene_);
}

/// Of the default scene; of the first, where none is said to be that; of a file without scenes, all
/// nodes that are no other's child.
std::vector<int> GltfReader::roots() const {
    if (!model_.scenes.empty())
        return at(model_.scenes, std::max(model_.defaultScene, 0), "scene").nodes;
    std::vector<bool> is_child(model_.nodes.size());
    for (const tinygltf::Node& node : model_.nodes)
        for (const int child : node.children)
            if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
                is_child[static_cast<std::size_t>(child)] = true;
    std::vector<int> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i]) roots.push_back(static_cast<int>(i));
    return roots;
}

/// Depth first, in the order of the file; by a list of its own, for the depth may be any.
std::vector<GltfReader::Visit> GltfReader::visits_of_nodes(const std::vector<int>& roots) {
    world_from_node_.resize(model_.nodes.size());
    std::vector<Visit> visits, left;
    const auto add = [&](const std::vector<int>& nodes, const dmat4& world_from_parent) {
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node)
            left.push_back({*node, world_from_parent});
    };
    add(roots, dmat4(1));
    while (!left.empty()) {
        Visit visit = left.back();
        left.pop_back();
        const tinygltf::Node& node = at(model_.nodes, visit.node, "node");
        name_node(visit.node);
        std::optional<dmat4>& world = world_from_node_[static_cast<std::size_t>(visit.node)];
        if (world) fail(node_name_ + " has two parents, or is below itself");
        world = visit.world_from_node *= parent_from_node(node);
        visits.push_back(visit);
        add(node.children, *world);
    }
    return visits;
}

void GltfReader::name_node(int index) {
    const std::string& name = model_.nodes[static_cast<std::size_t>(index)].name;
    node_name_ = "node " + std::to_string(index) + (name.empty() ? "" : " \"" + name + "\"");
}

void GltfReader::read_node(const Visit& visit) {
    const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(visit.node)];
    name_node(visit.node);
    if (node.mesh >= 0) read_mesh(node, visit.world_from_node);
    if (node.camera >= 0) add_camera(node, visit.world_from_node);
    if (node.extensions.contains("KHR_lights_punctual")) add_light(node, visit.world_from_node);
}

/// The matrix, or what is first scaled, then turned, then moved.
dmat4 GltfReader::parent_from_node(const tinygltf::Node& node) const {
    const auto numbers = [&](const std::vector<double>& list, std::size_t count, const char* what) {
        if (!list.empty() && list.size() != count)
            fail(node_name_ + ": " + what + " has " + std::to_string(list.size()) +
                 " numbers, not " + std::to_string(count));
        return !list.empty();
    };
    dmat4 matrix(1);
    if (numbers(node.matrix, 16, "matrix")) {
        for (std::size_t i = 0; i < 16; ++i)
            matrix[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = node.matrix[i];
        return matrix;
    }
    if (numbers(node.rotation, 4, "rotation")) {
        const std::vector<double>& q = node.rotation;
        const dvec4 all(q[0], q[1], q[2], q[3]);
        const double square = glm::dot(all, all);
        if (!(square > 0) || !std::isfinite(square)) fail(node_name_ + ": rotation has no length");
        const double s = 2 / square;
        const auto [x, y, z, w] = std::array{q[0], q[1], q[2], q[3]};
        matrix = matrix_from_rows<double>(
            {1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w), 0},
            {s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w), 0},
            {s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y), 0}, {0, 0, 0, 1});
    }
    if (numbers(node.scale, 3, "scale"))
        for (int i = 0; i < 3; ++i) matrix[i] *= node.scale[static_cast<std::size_t>(i)];
    if (numbers(node.translation, 3, "translation"))
        for (int i = 0; i < 3; ++i) matrix[3][i] = node.translation[static_cast<std::size_t>(i)];
    return matrix;
}

void GltfReader::read_mesh(const tinygltf::Node& node, const dmat4& world_from_node) {
    const tinygltf::Mesh& from = at(model_.meshes, node.mesh, node_name_ + ": mesh");
    world_from_bind_ = node.skin >= 0 ? &world_from_bind_of(node.skin) : nullptr;
    mesh_ = {};
    positions_world_ = {};
    mesh_.name = node.name.empty() ? from.name : node.name;
    has_colors_ = std::ranges::any_of(from.primitives, [](const tinygltf::Primitive& primitive) {
        return primitive.attributes.contains("COLOR_0");
    });
    for (std::size_t i = 0; i < from.primitives.size(); ++i) {
        where_ = "mesh " + std::to_string(node.mesh) +
                 (from.name.empty() ? "" : " \"" + from.name + "\"") + ", primitive " +
                 std::to_string(i);
        read_primitive(from.primitives[i], world_from_node);
    }
    if (mesh_.triangles.empty()) return;
    scene_.meshes.push_back(std::move(mesh_));
    positions_of_mesh_.push_back(std::move(positions_world_));
}

/// What each of a skin's joints does to the figure as it was modelled.
const std::vector<dmat4>& GltfReader::world_from_bind_of(int skin_index) {
    const auto [found, is_new] = skins_.try_emplace(skin_index);
    std::vector<dmat4>& world_from_bind = found->second;
    if (!is_new) return world_from_bind;
    const tinygltf::Skin& skin = at(model_.skins, skin_index, node_name_ + ": skin");
    const std::string name = "skin " + std::to_string(skin_index);
    std::optional<GltfArray> inverse_binds;
    if (skin.inverseBindMatrices >= 0) {
        inverse_binds.emplace(model_, skin.inverseBindMatrices, file_,
                              name + ": inverseBindMatrices");
        if (inverse_binds->components() != 16 || inverse_binds->size() < skin.joints.size())
            inverse_binds->fail("has no matrix for each of " + std::to_string(skin.joints.size()) +
                                " joints");
    }
    if (skin.joints.empty()) fail(name + " has no joints");
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        const std::optional<dmat4>& joint =
            at(world_from_node_, skin.joints[i], name + ": its joint, node");
        if (!joint)
            fail(name + ": its joint, node " + std::to_string(skin.joints[i]) +
                 ", is not in the scene");
        world_from_bind.push_back(inverse_binds ? *joint * inverse_binds->matrix(i) : *joint);
    }
    return world_from_bind;
}

/// The points of a primitive's triangles: strips and fans are taken apart.
std::vector<std::uint32_t> GltfReader::triangle_vertices(const tinygltf::Primitive& primitive,
                                                         std::size_t points) {
    std::optional<GltfArray> indices;
    if (primitive.indices >= 0) {
        indices.emplace(model_, primitive.indices, file_, where_ + ": indices");
        if (indices->components() != 1 || !indices->is_unsigned())
            indices->fail("has no whole numbers, one by one");
        if (indices->is_normalized()) indices->fail("is normalized, which indices must not be");
    }
    const std::size_t count = indices ? indices->size() : points;
    const auto point = [&](std::size_t i) {
        const double index = indices ? indices->number(i, 0) : static_cast<double>(i);
        if (!(index < static_cast<double>(points)))
            fail(where_ + ": index " + std::to_string(static_cast<std::uint32_t>(index)) +
                 " is out of range: there are " + std::to_string(points) + " positions");
        return static_cast<std::uint32_t>(index);
    };
    const bool is_list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
    const bool is_strip = primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP;
    const std::size_t triangles = is_list ? count / 3 : std::max<std::size_t>(count, 2) - 2;
    if (is_list && count % 3 != 0)
        warn(where_ + ": " + std::to_string(count) + " vertices are not a number of triangles");
    budget_.charge(Resource::vertices, 3 * triangles, file_);
    std::vector<std::uint32_t> vertices;
    vertices.reserve(3 * triangles);
    for (std::size_t i = 0; i < triangles; ++i) {
        // Every second triangle of a strip has its first two vertices in the other order.
        const std::size_t odd = i % 2;
        const std::array<std::size_t, 3> at = is_list    ? std::array{3 * i, 3 * i + 1, 3 * i + 2}
                                              : is_strip ? std::array{i + odd, i + 1 - odd, i + 2}
                                                         : std::array{std::size_t{0}, i + 1, i + 2};
        for (const std::size_t vertex : at) vertices.push_back(point(vertex));
    }
    return vertices;
}

void GltfReader::read_primitive(const tinygltf::Primitive& primitive,
                                const dmat4& world_from_node) {
    budget_.charge(Resource::primitives, 1, file_);
    if (primitive.mode >= TINYGLTF_MODE_POINTS && primitive.mode <= TINYGLTF_MODE_LINE_STRIP)
        return warn(where_ + (primitive.mode == TINYGLTF_MODE_POINTS ? ": points" : ": lines") +
                    " are not drawn");
    if (primitive.mode < 0 || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
        fail(where_ + ": there is no mode " + std::to_string(primitive.mode));
    if (!primitive.targets.empty())
        warn("morph targets are passed over: meshes have their first shape");
    if (!primitive.attributes.contains("POSITION")) return warn(where_ + ": has no positions");
    const Arrays arrays = arrays_of(primitive);
    const Place of_node{world_from_node, world_from_normal(world_from_node)};
    const bool is_posed = !arrays.influences.empty(),
               node_is_mirrored = is_mirrored(world_from_node);
    const auto turns_winding = [&](std::uint32_t element) {
        return is_posed ? is_mirrored(posed(arrays.influences, element)) : node_is_mirrored;
    };
    const auto material = static_cast<std::uint32_t>(primitive.material + 1);

    std::unordered_map<std::uint32_t, Vertex> vertex_of_element;
    const auto vertex = [&](std::uint32_t element) {
        const auto [found, is_new] = vertex_of_element.try_emplace(element, Vertex{0});
        if (is_new && is_posed) {
            const dmat4 world_from_bind = posed(arrays.influences, element);
            found->second =
                add_vertex(arrays, element, {world_from_bind, world_from_normal(world_from_bind)});
        } else if (is_new) {
            found->second = add_vertex(arrays, element, of_node);
        }
        return found->second;
    };
    const std::vector<std::uint32_t> elements =
        triangle_vertices(primitive, arrays.positions->size());
    for (std::size_t i = 0; i < elements.size(); i += 3) {
        Triangle triangle{{vertex(elements[i]), vertex(elements[i + 1]), vertex(elements[i + 2])},
                          material};
        if (turns_winding(elements[i])) std::swap(triangle.vertices[1], triangle.vertices[2]);
        mesh_.triangles.push_back(triangle);
    }
}

/// The arrays of a primitive that are of use, all as long as its positions.
GltfReader::Arrays GltfReader::arrays_of(const tinygltf::Primitive& primitive) {
    int uv_set = 0;
    if (primitive.material != -1)
        uv_set = uv_set_of(at(model_.materials, primitive.material, where_ + ": material"));
    Arrays arrays;
    const auto open = [&](std::optional<GltfArray>& array, const std::string& name, int least,
                          int most) {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end()) return;
        array.emplace(model_, found->second, file_, where_ + ": " + name);
        if (array->components() < least || array->components() > most)
            array->fail("has " + std::to_string(array->components()) + " numbers an element");
        if (array->size() != arrays.positions->size())
            array->fail("has " + std::to_string(array->size()) + " elements for " +
                        std::to_string(arrays.positions->size()) + " positions");
    };
    open(arrays.positions, "POSITION", 3, 3);
    open(arrays.normals, "NORMAL", 3, 3);
    open(arrays.colors, "COLOR_0", 3, 4);
    open(arrays.uvs, "TEXCOORD_" + std::to_string(uv_set), 2, 2);
    if (!arrays.uvs) warn_of_missing_uvs(primitive, uv_set);
    if (world_from_bind_) arrays.influences = influences_of(primitive, arrays.positions->size());
    return arrays;
}

/// A texture without coordinates has one texel everywhere, and nothing else shows why.
void GltfReader::warn_of_missing_uvs(const tinygltf::Primitive& primitive, int uv_set) {
    if (primitive.material < 0) return;
    const tinygltf::Material& material =
        model_.materials[static_cast<std::size_t>(primitive.material)];
    if (material.pbrMetallicRoughness.baseColorTexture.index >= 0 ||
        material.normalTexture.index >= 0)
        warn(where_ + ": has no TEXCOORD_" + std::to_string(uv_set) + " for the texture of " +
             name_of_material(model_, primitive.material) + ": one texel is drawn everywhere");
}

/// JOINTS_0 and WEIGHTS_0, JOINTS_1 and so on.
std::vector<GltfReader::Influences> GltfReader::influences_of(const tinygltf::Primitive& primitive,
                                                              std::size_t points) {
    const auto open = [&](const std::string& name) {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end()) fail(where_ + ": has a skin, but no " + name);
        GltfArray array(model_, found->second, file_, where_ + ": " + name);
        if (array.components() != 4 || array.size() != points)
            array.fail("has no four numbers for each of " + std::to_string(points) + " positions");
        return array;
    };
    std::vector<Influences> influences;
    for (int set = 0; set == 0 || primitive.attributes.contains("JOINTS_" + std::to_string(set));
         ++set) {
        const std::string number = std::to_string(set);
        if (set > 0) budget_.charge(Resource::vertices, points, file_);  // a file may name many
        influences.push_back({open("JOINTS_" + number), open("WEIGHTS_" + number)});
        if (!influences.back().joints.is_unsigned() || influences.back().joints.is_normalized())
            influences.back().joints.fail("has no whole numbers");
    }
    return influences;
}

/// The mean of what a vertex's joints do to it, by its weights; without any, what its first one
/// does.
dmat4 GltfReader::posed(const std::vector<Influences>& influences, std::size_t element) {
    dmat4 sum(0);
    double total = 0;
    const auto add = [&](const GltfArray& joints, int i, double weight) {
        const double joint = joints.number(element, i);
        if (!(joint < static_cast<double>(world_from_bind_->size())))
            joints.fail("element " + std::to_string(element) + " names joint " +
                        std::to_string(static_cast<std::uint32_t>(joint)) + " of " +
                        std::to_string(world_from_bind_->size()));
        sum += weight * (*world_from_bind_)[static_cast<std::size_t>(joint)];
        total += weight;
    };
    for (const auto& [joints, weights] : influences)
        for (int i = 0; i < 4; ++i) {
            const double weight = weights.number(element, i);
            if (weight < 0)
                weights.fail("element " + std::to_string(element) + " has a weight below 0");
            if (weight > 0) add(joints, i, weight);
        }
    if (total == 0) {
        warn(where_ + ": vertices without weights follow their first joint");
        add(influences[0].joints, 0, 1);
    }
    return sum / total;
}

/// What a vertex has. Its position is the element's, until points of one place become one.
Vertex GltfReader::add_vertex(const Arrays& arrays, std::uint32_t element, const Place& place) {
    const dvec3 position(place.world_from_node * arrays.positions->vector(element));
    narrowed(position, where_ + ": a position");
    Vertex vertex{static_cast<std::uint32_t>(positions_world_.size())};
    positions_world_.push_back(position);
    box_.add(position);
    // Colours are brought into 0 to 1, as the specification has it.
    if (has_colors_)
        mesh_.colors.push_back(
            arrays.colors ? vec4(glm::clamp(arrays.colors->vector(element), 0.0, 1.0)) + 0.0f
                          : vec4(1));
    if (arrays.uvs) {
        const dvec4 uv = arrays.uvs->vector(element);
        vertex.uv = static_cast<std::uint32_t>(mesh_.uvs.size());
        mesh_.uvs.emplace_back(uv.x, 1 - uv.y);
        narrowed({mesh_.uvs.back(), 0}, where_ + ": a TEXCOORD");
    }
    if (arrays.normals) {
        const dvec3 normal = place.world_from_normal * dvec3(arrays.normals->vector(element));
        vertex.normal = static_cast<std::uint32_t>(mesh_.normals.size());
        mesh_.normals.push_back(vec3(normalize_or(normal, dvec3(0))));
    }
    return vertex;
}

/// Puts meshes, cameras and lights where they stand, relative to the scene's origin.
void GltfReader::place_scene() {
    scene_.origin = box_.origin();
    for (std::size_t i = 0; i < scene_.meshes.size(); ++i)
        finish(scene_.meshes[i], std::exchange(positions_of_mesh_[i], {}));
    for (std::size_t i = 0; i < scene_.cameras.size(); ++i)
        scene_.cameras[i].world_from_view[3] =
            vec4(narrowed(positions_of_cameras_[i] - scene_.origin, "a camera's place"), 1);
    for (std::size_t i = 0; i < scene_.lights.size(); ++i)
        scene_.lights[i].position_world =
            narrowed(positions_of_lights_[i] - scene_.origin, "a light's place");
}

/// Gives a mesh its points and faces. Where the file gives no normals, the face's own, as the
/// specification has it.
void GltfReader::finish(Mesh& mesh, const std::vector<dvec3>& positions_world) const {
    const std::vector<std::uint32_t> point_of_element = add_points(mesh, positions_world);
    mesh.faces.reserve(mesh.triangles.size());
    mesh.vertices.reserve(3 * mesh.triangles.size());
    for (Triangle& triangle : mesh.triangles) {
        for (Vertex& vertex : triangle.vertices)
            vertex.position = point_of_element[vertex.position];
        auto& [a, b, c] = triangle.vertices;
        if (a.normal == no_index) {
            const auto position = [&](Vertex v) { return dvec3(mesh.positions[v.position]); };
            const dvec3 across = glm::cross(position(b) - position(a), position(c) - position(a));
            a.normal = b.normal = c.normal = static_cast<std::uint32_t>(mesh.normals.size());
            mesh.normals.push_back(vec3(normalize_or(across, dvec3(0))));
        }
        mesh.faces.push_back(
            {static_cast<std::uint32_t>(mesh.vertices.size()), 3, triangle.material});
        mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    }
}

/// The points of a mesh, rounded to float: elements of one position and colour are one.
///
/// @return  For each element its point.
std::vector<std::uint32_t> GltfReader::add_points(Mesh& mesh,
                                                  const std::vector<dvec3>& positions_world) const {
    const std::vector<vec4> colors = std::exchange(mesh.colors, {});
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
    std::unordered_map<PointKey, std::uint32_t, PointHash> index_of_point;
    std::vector<std::uint32_t> point_of_element;
    point_of_element.reserve(positions_world.size());
    for (std::size_t i = 0; i < positions_world.size(); ++i) {
        const vec3 p = vec3(positions_world[i] - scene_.origin) + 0.0f;  // of -0 and 0 one
        const vec4 color = colors.empty() ? vec4(1) : colors[i];
        const PointKey key{{bits(p.x), bits(p.y), bits(p.z), bits(color.r), bits(color.g),
                            bits(color.b), bits(color.a)}};
        const auto [point, is_new] =
            index_of_point.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
        point_of_element.push_back(point->second);
        if (!is_new) continue;
        mesh.positions.push_back(p);
        mesh.bounds.add(p);
        if (!colors.empty()) mesh.colors.push_back(color);
    }
    return point_of_element;
}

void GltfReader::add_camera(const tinygltf::Node& node, const dmat4& world_from_node) {
    const tinygltf::Camera& from = at(model_.cameras, node.camera, node_name_ + ": camera");
    const std::string name = node.name.empty() ? from.name : node.name;
    if (from.type != "perspective")
        return warn(node_name_ + ": a camera without perspective is passed over");
    const tinygltf::PerspectiveCamera& lens = from.perspective;
    const double far = lens.zfar > 0 ? lens.zfar : std::numeric_limits<double>::infinity();
    const dmat4 place = without_scale(world_from_node);
    narrowed(place[3], node_name_ + ": its place");
    const SceneCamera camera{name, mat4(place), static_cast<float>(lens.yfov),
                             static_cast<float>(lens.znear), static_cast<float>(far)};
    if (!(camera.fov_y_radians > 0 && camera.fov_y_radians < 3.14159f && camera.near > 0 &&
          camera.near < camera.far))
        fail(node_name_ + ": its camera has no possible yfov, znear and zfar");
    scene_.cameras.push_back(camera);
    positions_of_cameras_.emplace_back(place[3]);
}

/// The cone of a spot, between whose angles its light fades.
void GltfReader::add_cone(SceneLight& light, const tinygltf::SpotLight& spot) const {
    const double inner = spot.innerConeAngle, outer = spot.outerConeAngle;
    if (!(inner >= 0 && inner <= outer && outer > 0 && outer < 1.5707964))
        fail(node_name_ + ": the cone of its light has no possible angles");
    light.cos_outer = static_cast<float>(std::cos(outer));
    light.cos_inner = static_cast<float>(std::cos(inner));
    // An edge without width would be a division by 0.
    light.cos_inner = std::max(light.cos_inner, std::nextafter(light.cos_outer, 2.0f));
}

void GltfReader::add_light(const tinygltf::Node& node, const dmat4& world_from_node) {
    const tinygltf::Value& extension = node.extensions.at("KHR_lights_punctual");
    const double index = std::clamp(number_in(extension, "light", -1), -1.0, 1e9);
    const tinygltf::Light& from =
        at(model_.lights, static_cast<int>(index), node_name_ + ": light");
    const std::map<std::string, SceneLight::Kind> kinds = {
        {"directional", SceneLight::Kind::directional},
        {"point", SceneLight::Kind::point},
        {"spot", SceneLight::Kind::spot}};
    if (!kinds.contains(from.type))
        fail(node_name_ + ": there is no kind of light \"" + from.type + "\"");
    if (!from.color.empty() && from.color.size() < 3)
        fail(node_name_ + ": the colour of its light has no 3 numbers");
    const dvec3 color =
        from.color.empty() ? dvec3(1) : dvec3(from.color[0], from.color[1], from.color[2]);

    SceneLight light{};
    light.name = node.name.empty() ? from.name : node.name;
    light.kind = kinds.at(from.type);
    light.color = narrowed(glm::max(from.intensity * color, dvec3(0)), node_name_ + ": its light");
    narrowed(world_from_node[3], node_name_ + ": its place");
    light.direction_world = vec3(normalize_or(-dvec3(world_from_node[2]), dvec3(0, 0, -1)));
    light.range =
        from.range > 0 ? static_cast<float>(from.range) : std::numeric_limits<float>::infinity();
    if (light.kind == SceneLight::Kind::spot) add_cone(light, from.spot);
    scene_.lights.push_back(light);
    positions_of_lights_.emplace_back(world_from_node[3]);
}

}  // namespace

Scene load_gltf(const fs::path& file, const LoadBudget& budget) {
    return GltfReader(file, budget).read();
}

}  // namespace rasterbook
