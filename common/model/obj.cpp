// SPDX-License-Identifier: MIT
#include "common/model/obj.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <unordered_map>
#include <utility>

#include "common/math/color.hpp"
#include "common/model/mtl.hpp"
#include "common/model/statements.hpp"
#include "common/model/triangulate.hpp"
#include "common/model/world_box.hpp"

namespace rasterbook {
namespace {

namespace fs = std::filesystem;

/// Reads a model.
class ObjReader {
  public:
    ObjReader(const fs::path& file, const LoadBudget& budget, std::size_t max_elements)
        : budget_(budget), in_(file, budget_), limit_(max_elements) {}
    Scene read();

  private:
    static constexpr std::array<const char*, 3> kinds_{"positions", "uvs", "normals"};

    /// An index of an element that the file has yet to define.
    struct ForwardReference {
        std::size_t kind;  ///< Into kinds_.
        std::int64_t index;
        std::size_t line;
    };

    /// What all elements of a kind have, and which of a mesh takes its own.
    template <typename Element>
    struct Column {
        std::vector<Element>& all;
        std::vector<Element> Mesh::* own;
    };

    void read_statement(const Statement& statement);
    void read_position(const Statement& statement);
    void read_color(std::string_view words);
    void read_smoothing(std::string_view group);
    void read_face(std::string_view words);
    Vertex read_vertex(std::string_view word);
    std::uint32_t read_index(std::string_view text, std::size_t kind, std::string_view word);
    void begin_group(std::string_view name);
    void use_material(const NameOrComment& name);
    void read_libraries(const Statement& statement);
    bool read_library(std::string_view name);
    void check_forward_references() const;
    void resolve_materials();
    void decode_colors();
    dvec3 round_positions();
    void share_out_elements();
    template <typename... Element>
    void share_out(std::uint32_t Vertex::* index, std::size_t count, Column<Element>... columns);

    template <typename Element>
    void append(std::vector<Element>& elements, const Element& element, const char* kind) {
        if (elements.size() >= limit_) in_.fail("more than " + std::to_string(limit_) + " " + kind);
        elements.push_back(element);
    }
    std::size_t count_of(std::size_t kind) const {
        return kind == 0 ? positions_world_.size() : kind == 1 ? uvs_.size() : normals_.size();
    }

    LoadBudget budget_;
    StatementReader in_;
    std::size_t limit_;
    Warnings warnings_;
    MaterialReader materials_{budget_, warnings_};
    std::set<fs::path> libraries_;  ///< Those read.

    std::vector<dvec3> positions_world_;
    std::vector<vec3> positions_, normals_;  ///< Positions: relative to the scene's origin.
    std::vector<dvec2> uvs_;
    std::vector<vec4> colors_;                   ///< Of the positions, as written, opaque; 0: none.
    std::size_t colors_line_ = 0;                ///< Of the first number above 1.
    std::uint32_t smoothing_ = smooth_by_angle;  ///< The current smoothing group.
    bool lacks_normals_ = false;                 ///< A face has vertices without.
    std::vector<Mesh> meshes_;  ///< Their vertices are indices into the arrays above.
    std::unordered_map<std::string, std::size_t> mesh_of_group_;
    std::size_t mesh_ = 0;  ///< The current group's.

    /// A material's name, looked up when all libraries are read, and the line that uses it first.
    struct MaterialUse {
        NameOrComment name;
        std::size_t line;
    };
    std::vector<MaterialUse> material_uses_;
    std::unordered_map<std::string, std::uint32_t> use_of_material_;
    std::uint32_t material_use_ = no_index;  ///< The current one.

    std::vector<ForwardReference> forward_references_;  ///< With rising indices for each kind.
    std::array<std::int64_t, 3> highest_index_{};       ///< For each kind.
};

Scene ObjReader::read() {
    begin_group("");
    for (Statement statement; in_.next(statement);) read_statement(statement);
    check_forward_references();
    std::erase_if(meshes_, [](const Mesh& mesh) { return mesh.faces.empty(); });
    if (meshes_.empty()) throw InputError(in_.file(), "holds no faces");
    resolve_materials();
    const dvec3 origin = round_positions();
    decode_colors();
    share_out_elements();
    Scene scene{std::move(meshes_), materials_.take(), warnings_.take()};
    scene.origin = origin;
    scene.budget = budget_;
    return scene;
}

void ObjReader::read_statement(const Statement& statement) {
    const std::string_view keyword = statement.keyword, arguments = statement.arguments;
    if (keyword == "v")
        read_position(statement);
    else if (keyword == "vt")
        append(uvs_, read_vector<2, double>(in_, statement, 1, 3), kinds_[1]);
    else if (keyword == "vn")
        append(normals_, read_vector<3>(in_, statement), kinds_[2]);
    else if (keyword == "f")
        read_face(arguments);
    else if (keyword == "o" || keyword == "g")
        begin_group(bare_name(arguments));
    else if (keyword == "usemtl")
        use_material(NameOrComment(statement));
    else if (keyword == "mtllib")
        read_libraries(statement);
    else if (keyword == "s")
        read_smoothing(arguments);
    else
        warnings_.add_unread(in_, keyword,
                             keyword == "l"   ? ": lines are not drawn"
                             : keyword == "p" ? ": points are not drawn"
                                              : "");
}

void ObjReader::read_position(const Statement& statement) {
    std::string_view rest;
    append(positions_world_, read_vector<3, double>(in_, statement, 3, 3, &rest), kinds_[0]);
    if (!rest.empty()) read_color(rest);
}

/// Red, green and blue, as MeshLab and Blender write them; a single number is a weight, w, and a
/// fourth one would be opacity: these two are ignored.
void ObjReader::read_color(std::string_view words) {
    vec4 color(0);
    for (int i = 0; i < 4; ++i) {
        const std::string_view word = next_word(words);
        if (word.empty() && i < 3) return;
        if (!word.empty()) color[i] = static_cast<float>(read_number(in_, word));
    }
    color.a = 1;
    if (colors_line_ == 0 && glm::max(color, vec4(1)) != vec4(1)) colors_line_ = in_.line();
    colors_.resize(positions_world_.size() - 1, vec4(0));
    colors_.push_back(color);
}

/// A number from 1, or "off" or 0.
void ObjReader::read_smoothing(std::string_view group) {
    constexpr std::int64_t highest = smooth_by_angle - 1;
    std::int64_t number = 0;
    if (group == "on")
        number = 1;
    else if (group != "off" && parse(group, number) != std::errc{})
        return warnings_.add(in_, in_quotes(group) + " is not a smoothing group");
    smoothing_ = std::uint32_t(std::clamp<std::int64_t>(number, no_smoothing, highest));
}

void ObjReader::read_face(std::string_view words) {
    Mesh& mesh = meshes_[mesh_];
    const std::size_t first = mesh.vertices.size();
    for (auto word = next_word(words); !word.empty(); word = next_word(words))
        append(mesh.vertices, read_vertex(word), "vertices in a group");
    const std::size_t count = mesh.vertices.size() - first;
    if (count < 3) in_.fail("a face needs 3 vertices and has " + std::to_string(count));
    budget_.charge(Resource::vertices, count, in_.file());
    if (smoothing_ != smooth_by_angle) {  // of count - 2 triangles
        mesh.smoothing_groups.resize(first - 2 * mesh.faces.size(), smooth_by_angle);
        mesh.smoothing_groups.resize(mesh.smoothing_groups.size() + count - 2, smoothing_);
    }
    mesh.faces.push_back({std::uint32_t(first), std::uint32_t(count), material_use_});
}

/// "position", "position/uv", "position//normal" or "position/uv/normal".
Vertex ObjReader::read_vertex(std::string_view word) {
    std::array<std::uint32_t, 3> indices{no_index, no_index, no_index};
    std::string_view rest = word;
    for (std::size_t kind = 0;; ++kind) {
        if (kind == 3) in_.fail(in_quotes(word) + " has more than 3 indices");
        const std::size_t length = std::min(rest.find('/'), rest.size());
        if (length > 0) indices[kind] = read_index(rest.substr(0, length), kind, word);
        if (length == rest.size()) break;
        rest.remove_prefix(length + 1);
    }
    if (indices[0] == no_index) in_.fail(in_quotes(word) + " has no position");
    if (indices[2] == no_index) lacks_normals_ = true;
    return {indices[0], indices[1], indices[2]};
}

/// Indices count from 1, or back from the last element so far with -1.
std::uint32_t ObjReader::read_index(std::string_view text, std::size_t kind,
                                    std::string_view word) {
    std::int64_t index = 0;
    const std::errc error = parse(text, index);
    const auto fail = [&](const std::string& what) {
        in_.fail("index " + std::string(text) + (text == word ? "" : " in " + in_quotes(word)) +
                 what);
    };
    if (error == std::errc::invalid_argument)
        in_.fail(in_quotes(word) + " is not a vertex of a face");
    if (error == std::errc::result_out_of_range) fail(" is out of range");
    if (error == std::errc{} && index == 0) fail(" is out of range: the first is 1");

    const auto count = std::int64_t(count_of(kind));
    if (index < -count)
        fail(" is out of range: there are " + std::to_string(count) + " " + kinds_[kind] +
             " so far");
    if (index < 0) return std::uint32_t(count + index);
    if (index > std::max(count, highest_index_[kind]))
        forward_references_.push_back({kind, index, in_.line()});
    highest_index_[kind] = std::max(highest_index_[kind], index);
    return std::uint32_t(std::min(index, std::int64_t(no_index)) - 1);
}

void ObjReader::begin_group(std::string_view name) {
    const auto [group, is_new] = mesh_of_group_.try_emplace(std::string(name), meshes_.size());
    if (is_new) meshes_.emplace_back().name = name;
    mesh_ = group->second;
}

void ObjReader::use_material(const NameOrComment& name) {
    const auto next = std::uint32_t(material_uses_.size());
    const auto [use, is_new] = use_of_material_.try_emplace(name.whole, next);
    if (is_new) material_uses_.push_back({name, in_.line()});
    material_use_ = use->second;
}

/// The names stand side by side, but may hold blanks themselves.
void ObjReader::read_libraries(const Statement& statement) {
    const std::string_view names = statement.arguments;
    if (read_library(NameOrComment(statement).of_file(in_.file(), budget_))) return;
    std::vector<std::string_view> missing;
    bool found_one = false;
    std::string_view words = names;
    for (auto word = next_word(words); !word.empty(); word = next_word(words))
        if (read_library(word))
            found_one = true;
        else
            missing.push_back(word);
    if (!found_one) missing = {names};
    for (const std::string_view name : missing)
        warnings_.add(in_, "there is no material library " + in_quotes(bare_name(name)));
}

/// False when there is no such file.
bool ObjReader::read_library(std::string_view name) {
    const fs::path file = path_beside(in_.file(), bare_name(name));
    std::error_code ignored;
    if (bare_name(name).empty()) return false;
    budget_.check_place(file);  // not even whether it exists is told
    if (!fs::exists(file, ignored)) return false;
    if (libraries_.insert(file.lexically_normal()).second) materials_.read(file);
    return true;
}

void ObjReader::check_forward_references() const {
    for (const auto& [kind, index, line] : forward_references_)
        if (index > std::int64_t(count_of(kind)))
            throw InputError(in_.file(), line,
                             "index " + std::to_string(index) + " is out of range: the file has " +
                                 std::to_string(count_of(kind)) + " " + kinds_[kind]);
}

void ObjReader::resolve_materials() {
    std::vector<std::uint32_t> material_of_use;
    for (const auto& [name, line] : material_uses_) {
        material_of_use.push_back(materials_.find(name));
        if (material_of_use.back() == 0)
            warnings_.add(in_.file(), line, "there is no material " + in_quotes(name.whole));
    }
    for (Mesh& mesh : meshes_)
        for (Face& face : mesh.faces)
            face.material = face.material == no_index ? 0 : material_of_use[face.material];
}

/// From sRGB to linear. In a file where any number is above 1, they go up to 255.
void ObjReader::decode_colors() {
    if (colors_.empty()) return;
    colors_.resize(positions_.size(), vec4(0));
    if (colors_line_ > 0)
        warnings_.add(in_.file(), colors_line_, "colours above 1: all are taken as 0 to 255");
    const float most = colors_line_ > 0 ? 255.0f : 1.0f;
    for (vec4& color : colors_) {
        if (color.a == 0) color = vec4(most);  // white
        for (int i = 0; i < 3; ++i)
            color[i] = linear_from_srgb(glm::clamp(color[i] / most, 0.0f, 1.0f));
        color.a = 1;
    }
}

/// Rounds all positions to float, relative to the scene's origin, which it returns.
dvec3 ObjReader::round_positions() {
    WorldBox box;
    for (const Mesh& mesh : meshes_)
        for (const Vertex& vertex : mesh.vertices) box.add(positions_world_[vertex.position]);
    const dvec3 origin = box.origin();
    positions_.reserve(positions_world_.size());
    for (const dvec3 position : positions_world_) positions_.emplace_back(position - origin);
    positions_world_ = {};
    return origin;
}

/// Gives each mesh the elements that its faces use, in the order of first use, and frees the rest.
///
/// @param count  Of all elements.
template <typename... Element>
void ObjReader::share_out(std::uint32_t Vertex::* index, std::size_t count,
                          Column<Element>... columns) {
    std::vector<std::uint32_t> own_index_of(count, no_index), used;
    for (Mesh& mesh : meshes_) {
        for (Vertex& vertex : mesh.vertices) {
            if (vertex.*index == no_index) continue;
            std::uint32_t& own_index = own_index_of[vertex.*index];
            if (own_index == no_index)
                own_index = std::uint32_t(used.size()), used.push_back(vertex.*index);
            vertex.*index = own_index;
        }
        const auto take = [&](const auto& column) {
            if (column.all.empty()) return;
            (mesh.*column.own).reserve(used.size());
            for (const std::uint32_t i : used) (mesh.*column.own).push_back(column.all[i]);
        };
        (take(columns), ...);
        for (const std::uint32_t i : used) own_index_of[i] = no_index;
        used.clear();
    }
    ((columns.all = {}), ...);
}

void ObjReader::share_out_elements() {
    if (!lacks_normals_)
        for (Mesh& mesh : meshes_) mesh.smoothing_groups = {};
    if (meshes_.size() == 1) {
        meshes_[0].positions = std::move(positions_);
        meshes_[0].colors = std::move(colors_);
        meshes_[0].uvs = std::move(uvs_);
        meshes_[0].normals = std::move(normals_);
        return;
    }
    std::vector<std::uint32_t> numbers(lacks_normals_ ? positions_.size() : 0);
    std::iota(numbers.begin(), numbers.end(), 0u);
    share_out(&Vertex::position, positions_.size(), Column{positions_, &Mesh::positions},
              Column{colors_, &Mesh::colors}, Column{numbers, &Mesh::shared_positions});
    share_out(&Vertex::uv, uvs_.size(), Column{uvs_, &Mesh::uvs});
    share_out(&Vertex::normal, normals_.size(), Column{normals_, &Mesh::normals});
}

void cut_into_triangles(Mesh& mesh, const fs::path& file) {
    mesh.triangles.reserve(mesh.vertices.size() - 2 * mesh.faces.size());
    std::vector<vec3> polygon;
    for (const Face& face : mesh.faces) {
        const auto vertices = mesh.vertices_of(face);
        const auto add = [&](std::size_t i, std::size_t j, std::size_t k) {
            mesh.triangles.push_back({{vertices[i], vertices[j], vertices[k]}, face.material});
        };
        polygon.clear();
        for (const Vertex& vertex : vertices) {
            polygon.push_back(mesh.positions[vertex.position]);
            mesh.bounds.add(polygon.back());
        }
        if (vertices.size() == 3) {
            add(0, 1, 2);
            continue;
        }
        if (most_returns(polygon) > max_returns)
            throw InputError(file, "a polygon returns to one point more than " +
                                       std::to_string(max_returns) + " times");
        for (const auto& [i, j, k] : triangulate(polygon)) add(i, j, k);
    }
}

}  // namespace

Scene load_obj(const fs::path& file, const LoadBudget& budget, std::uint32_t max_elements) {
    Scene scene = ObjReader(file, budget, max_elements).read();
    for (Mesh& mesh : scene.meshes) cut_into_triangles(mesh, file);
    return scene;
}

}  // namespace rasterbook
