// SPDX-License-Identifier: MIT
#include "common/obj.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <locale>
#include <set>
#include <sstream>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "common/input_error.hpp"
#include "common/triangulate.hpp"

namespace rasterbook {
namespace {

namespace fs = std::filesystem;

bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// Takes the first word off the text; "" at its end.
std::string_view next_word(std::string_view& text) {
    const auto begin = std::find_if_not(text.begin(), text.end(), is_blank);
    const auto end = std::find_if(begin, text.end(), is_blank);
    text = {end, text.end()};
    return {begin, end};
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

/// A name without blanks and quotes around it.
std::string_view bare_name(std::string_view text) {
    text = trimmed(text);
    const bool has_quotes = text.size() >= 2 && text.front() == '"' && text.back() == '"';
    return has_quotes ? text.substr(1, text.size() - 2) : text;
}

/// A word as messages show it.
std::string in_quotes(std::string_view word) {
    constexpr std::size_t longest = 60;
    const char* end = word.size() > longest ? "...\"" : "\"";
    return '"' + std::string(word.substr(0, longest)) + end;
}

/// The file that another file names: relative to that file's folder, perhaps with backslashes.
fs::path path_beside(const fs::path& file, std::string_view name) {
    std::string path(name);
    std::replace(path.begin(), path.end(), '\\', '/');
    return file.parent_path() / path;
}

/// One statement of OBJ or MTL, as "v 1 2 3": without its comment, its continuation lines joined.
struct Statement {
    std::string_view keyword, arguments;
};

/// Reads statements and keeps no more of the file in memory than the longest of them.
class StatementReader {
  public:
    /// @throws InputError  When the file is missing, not regular, unreadable or UTF-16.
    explicit StatementReader(const fs::path& file);

    /// Goes on to the next statement, whose views last until the one after; false at the end.
    bool next(Statement& statement);

    const fs::path& file() const { return file_; }
    std::size_t line() const { return line_; }  ///< Where the statement begins.
    [[noreturn]] void fail(const std::string& what) const { throw InputError(file_, line_, what); }

  private:
    bool read_more();
    std::size_t find_line_end(std::size_t begin);
    std::size_t find_comment(std::size_t begin, std::size_t end) const;
    std::size_t find_next_line(std::size_t line_end);
    std::string_view next_logical_line();

    static constexpr std::size_t part_size_ = 1 << 16;
    fs::path file_;
    std::ifstream in_;
    std::string text_;           ///< The part of the file at hand.
    std::size_t begin_ = 0;      ///< Of the next line, in text_.
    std::size_t line_ = 1;       ///< Of the current statement, in the file.
    std::size_t next_line_ = 1;  ///< Of begin_, in the file.
};

StatementReader::StatementReader(const fs::path& file) : file_(file) {
    std::error_code ignored;
    if (!fs::exists(file, ignored)) throw InputError(file, "there is no such file");
    // Looked at before it is opened: to open a FIFO would wait for its writer.
    if (!fs::is_regular_file(file, ignored)) throw InputError(file, "not a regular file");
    in_.open(file, std::ios::binary);
    if (!in_) throw InputError(file, "cannot be opened");

    read_more();
    const std::string_view start = std::string_view(text_).substr(0, 2);
    const bool has_mark = start == "\xFF\xFE" || start == "\xFE\xFF";
    if (has_mark || (start.size() == 2 && (start[0] == '\0') != (start[1] == '\0')))
        fail("the text is UTF-16, not UTF-8");
    if (text_.starts_with("\xEF\xBB\xBF")) begin_ = 3;
}

bool StatementReader::next(Statement& statement) {
    while (begin_ < text_.size() || read_more()) {
        if (begin_ > part_size_) text_.erase(0, std::exchange(begin_, 0));
        std::string_view line = next_logical_line();
        statement.keyword = next_word(line);
        statement.arguments = trimmed(line);
        if (!statement.keyword.empty()) return true;
    }
    return false;
}

std::string_view StatementReader::next_logical_line() {
    line_ = next_line_;
    for (std::size_t begin = begin_;;) {
        const std::size_t line_end = find_line_end(begin);
        const std::size_t end = find_comment(begin, line_end);
        const bool goes_on = end > begin && text_[end - 1] == '\\';
        const std::size_t next = find_next_line(line_end);
        ++next_line_;
        if (!goes_on) {
            const std::size_t first = std::exchange(begin_, next);
            return std::string_view(text_).substr(first, end - first);
        }
        std::fill_n(&text_[end - 1], next - (end - 1), ' ');
        begin = next;
    }
}

std::size_t StatementReader::find_line_end(std::size_t begin) {
    // The '\0' behind the text ends the loop, as any control character does.
    const auto is_text = [](char c) { return static_cast<unsigned char>(c) >= ' ' || c == '\t'; };
    std::size_t end = begin;
    do {
        for (const char* text = text_.data(); is_text(text[end]);) ++end;
    } while (end == text_.size() && read_more());
    if (end == text_.size() || text_[end] == '\n' || text_[end] == '\r') return end;
    line_ = next_line_;
    fail("not text: control character " + std::to_string(int(text_[end])));
}

/// A comment begins with a '#' at the beginning of a word: there is none in "1.#IND".
std::size_t StatementReader::find_comment(std::size_t begin, std::size_t end) const {
    const std::string_view line = std::string_view(text_).substr(begin, end - begin);
    std::size_t at = line.find('#');
    while (at != line.npos && at > 0 && !is_blank(line[at - 1])) at = line.find('#', at + 1);
    return begin + std::min(at, line.size());
}

/// Lines end with "\n", "\r\n" or "\r".
std::size_t StatementReader::find_next_line(std::size_t line_end) {
    if (line_end == text_.size()) return line_end;
    if (text_[line_end] == '\n') return line_end + 1;
    const bool has_next = line_end + 1 < text_.size() || read_more();
    return line_end + (has_next && text_[line_end + 1] == '\n' ? 2 : 1);
}

bool StatementReader::read_more() {
    const std::size_t size = text_.size();
    text_.resize(size + part_size_);
    in_.read(&text_[size], part_size_);
    text_.resize(size + std::size_t(in_.gcount()));
    if (in_.bad()) throw InputError(file_, "cannot be read");
    return text_.size() > size;
}

/// Parses all of the word. from_chars knows no '+'.
template <typename Number>
std::errc parse(std::string_view word, Number& number) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    const char* word_end = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), word_end, number);
    return end == word_end ? error : std::errc::invalid_argument;
}

/// A number that from_chars finds out of range: infinite, or rounded when it is too small.
float read_extreme_number(std::string_view word) {
    std::istringstream stream{std::string(word)};
    stream.imbue(std::locale::classic());
    float number = 0;
    return stream >> number ? number : std::numeric_limits<float>::infinity();
}

/// @throws InputError  Unless the word is a number that is finite as a float.
float read_number(const StatementReader& in, std::string_view word) {
    float number = 0;
    const std::errc error = parse(word, number);
    if (error == std::errc::invalid_argument) in.fail(in_quotes(word) + " is not a number");
    if (error == std::errc::result_out_of_range) number = read_extreme_number(word);
    if (!std::isfinite(number)) in.fail(in_quotes(word) + " is not a finite number");
    return number;
}

/// The first numbers of a statement, 0 where those after `needed` are missing. What follows them,
/// as w or a colour, is not looked at.
template <int count>
glm::vec<count, float> read_vector(const StatementReader& in, const Statement& statement,
                                   int needed = count) {
    glm::vec<count, float> vector(0.0f);
    std::string_view words = statement.arguments;
    for (int i = 0; i < count; ++i) {
        const std::string_view word = next_word(words);
        if (word.empty() && i >= needed) break;
        if (word.empty())
            in.fail(std::string(statement.keyword) + " needs " + std::to_string(needed) +
                    " numbers and has " + std::to_string(i));
        vector[i] = read_number(in, word);
    }
    return vector;
}

/// What the loader passed over, each thing once.
class Warnings {
  public:
    void add(const StatementReader& in, const std::string& what) {
        add(in.file(), in.line(), what);
    }
    void add(const fs::path& file, std::size_t line, const std::string& what) {
        if (seen_.emplace(file.string(), what).second)
            texts_.push_back(InputError(file, line, what).what());
    }
    std::vector<std::string> take() { return std::move(texts_); }

  private:
    std::set<std::pair<std::string, std::string>> seen_;
    std::vector<std::string> texts_;
};

/// Reads material libraries.
class MaterialReader {
  public:
    explicit MaterialReader(Warnings& warnings) : warnings_(warnings) {}

    /// @throws InputError  When the library is not a regular file, or a number in it is wrong.
    void read(const fs::path& file);

    /// The index of a material, 0 when there is none of that name.
    std::uint32_t find(const std::string& name) const {
        const auto found = index_of_name_.find(name);
        return found == index_of_name_.end() ? 0 : found->second;
    }
    std::vector<Material> take() { return std::move(materials_); }

  private:
    void begin_material(const StatementReader& in, std::string_view name);
    void read_statement(const StatementReader& in, const Statement& statement);
    void read_map(const StatementReader& in, const Statement& statement, TextureMap& map);

    Warnings& warnings_;
    std::vector<Material> materials_{Material{}};
    std::unordered_map<std::string, std::uint32_t> index_of_name_;
    Material unused_;               ///< Takes what belongs to no material.
    Material* current_ = &unused_;  ///< The material that is being read.
    bool has_d_ = false;            ///< The current material has `d`, which counts more than `Tr`.
};

void MaterialReader::read(const fs::path& file) {
    StatementReader in(file);
    current_ = &unused_;
    for (Statement statement; in.next(statement);) read_statement(in, statement);
}

/// The first material of a name counts.
void MaterialReader::begin_material(const StatementReader& in, std::string_view name) {
    const auto index = std::uint32_t(materials_.size());
    const bool is_new = index_of_name_.emplace(name, index).second;
    if (is_new) materials_.emplace_back().name = name;
    if (!is_new) warnings_.add(in, "material " + in_quotes(name) + " is defined already");
    current_ = is_new ? &materials_.back() : &unused_;
    has_d_ = false;
}

/// One number is a grey. Spectral and XYZ colours are passed over.
void read_color(const StatementReader& in, const Statement& statement, vec3& color) {
    std::string_view words = statement.arguments;
    const std::string_view first = next_word(words);
    if (first == "spectral" || first == "xyz") return;
    const bool is_gray = next_word(words).empty();
    color = is_gray ? vec3(read_vector<1>(in, statement).x) : read_vector<3>(in, statement);
}

TextureMap* find_map(Material& material, std::string_view keyword) {
    if (keyword == "map_kd") return &material.diffuse_map;
    if (keyword == "map_ks") return &material.specular_map;
    if (keyword == "map_d") return &material.opacity_map;
    if (keyword == "map_bump" || keyword == "bump") return &material.bump_map;
    if (keyword == "map_norm" || keyword == "norm") return &material.normal_map;
    return nullptr;
}

void MaterialReader::read_statement(const StatementReader& in, const Statement& statement) {
    std::string keyword(statement.keyword);  // Exporters differ: map_Bump, map_bump.
    for (char& c : keyword) c = char(std::tolower(static_cast<unsigned char>(c)));
    Material& material = *current_;
    const auto number = [&] { return read_vector<1>(in, statement).x; };

    if (keyword == "newmtl") begin_material(in, bare_name(statement.arguments));
    if (keyword == "ka") read_color(in, statement, material.ambient);
    if (keyword == "kd") read_color(in, statement, material.diffuse);
    if (keyword == "ks") read_color(in, statement, material.specular);
    if (keyword == "ke") read_color(in, statement, material.emission);
    if (keyword == "ns") material.shininess = std::max(number(), 0.0f);
    if (keyword == "illum") material.illumination = int(std::clamp(number(), 0.0f, 10.0f));
    if (keyword == "d" && !statement.arguments.starts_with("-halo"))
        material.opacity = std::clamp(number(), 0.0f, 1.0f), has_d_ = true;
    if (keyword == "tr" && !has_d_) material.opacity = std::clamp(1 - number(), 0.0f, 1.0f);
    if (TextureMap* map = find_map(material, keyword)) read_map(in, statement, *map);
}

/// Up to three numbers of an option; the picture's name follows them.
vec3 read_option_vector(const StatementReader& in, std::string_view& words, vec3 vector) {
    vector.x = read_number(in, next_word(words));
    for (int i = 1; i < 3; ++i) {
        std::string_view after = words;
        float number = 0;
        if (parse(next_word(after), number) == std::errc::invalid_argument) break;
        vector[i] = read_number(in, next_word(words));
    }
    return vector;
}

void MaterialReader::read_map(const StatementReader& in, const Statement& statement,
                              TextureMap& map) {
    constexpr std::array with_one_word{"-blendu",  "-blendv", "-cc",  "-texres",
                                       "-imfchan", "-boost",  "-type"};
    map = {};
    std::string_view name = statement.arguments;
    for (std::string_view words = name;; name = words) {
        const std::string_view option = next_word(words);
        if (option == "-o")
            map.offset = read_option_vector(in, words, vec3(0.0f));
        else if (option == "-s")
            map.scale = read_option_vector(in, words, vec3(1.0f));
        else if (option == "-t")
            read_option_vector(in, words, vec3(0.0f));
        else if (option == "-bm")
            map.bump_multiplier = read_number(in, next_word(words));
        else if (option == "-clamp")
            map.clamp = next_word(words) == "on";
        else if (option == "-mm")
            next_word(words), next_word(words);
        else if (std::ranges::count(with_one_word, option))
            next_word(words);
        else
            break;
    }
    name = bare_name(name);
    if (name.empty()) return warnings_.add(in, std::string(statement.keyword) + " names no file");
    map.file = path_beside(in.file(), name);
}

/// Reads a model.
class ObjReader {
  public:
    ObjReader(const fs::path& file, std::size_t max_elements) : in_(file), limit_(max_elements) {}
    Scene read();

  private:
    static constexpr std::array<const char*, 3> kinds_{"positions", "uvs", "normals"};

    /// An index of an element that the file has yet to define.
    struct ForwardReference {
        std::size_t kind;  ///< Into kinds_.
        std::int64_t index;
        std::size_t line;
    };

    void read_statement(const Statement& statement);
    void read_face(std::string_view words);
    Corner read_corner(std::string_view word);
    std::uint32_t read_index(std::string_view text, std::size_t kind, std::string_view word);
    void begin_group(std::string_view name);
    void use_material(std::string_view name);
    void read_libraries(std::string_view names);
    bool read_library(std::string_view name);
    void check_forward_references() const;
    void resolve_materials();
    void share_out_elements();
    template <typename Element>
    void share_out(std::vector<Element>& all, std::vector<Element> Mesh::* own,
                   std::uint32_t Corner::* index);

    template <typename Element>
    void append(std::vector<Element>& elements, const Element& element, const char* kind) {
        if (elements.size() >= limit_) in_.fail("more than " + std::to_string(limit_) + " " + kind);
        elements.push_back(element);
    }
    std::size_t count_of(std::size_t kind) const {
        return kind == 0 ? positions_.size() : kind == 1 ? uvs_.size() : normals_.size();
    }

    StatementReader in_;
    std::size_t limit_;
    Warnings warnings_;
    MaterialReader materials_{warnings_};
    std::set<fs::path> libraries_;  ///< Those read.

    std::vector<vec3> positions_, normals_;
    std::vector<vec2> uvs_;
    std::vector<Mesh> meshes_;  ///< Their corners are indices into the three arrays above.
    std::unordered_map<std::string, std::size_t> mesh_of_group_;
    std::size_t mesh_ = 0;  ///< The current group's.

    /// A material's name, looked up when all libraries are read, and the line that uses it first.
    struct MaterialUse {
        std::string name;
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
    share_out_elements();
    return {std::move(meshes_), materials_.take(), warnings_.take()};
}

void ObjReader::read_statement(const Statement& statement) {
    const auto [keyword, arguments] = statement;
    if (keyword == "v")
        append(positions_, read_vector<3>(in_, statement), kinds_[0]);
    else if (keyword == "vt")
        append(uvs_, read_vector<2>(in_, statement, 1), kinds_[1]);
    else if (keyword == "vn")
        append(normals_, read_vector<3>(in_, statement), kinds_[2]);
    else if (keyword == "f")
        read_face(arguments);
    else if (keyword == "o" || keyword == "g")
        begin_group(bare_name(arguments));
    else if (keyword == "usemtl")
        use_material(bare_name(arguments));
    else if (keyword == "mtllib")
        read_libraries(arguments);
}

void ObjReader::read_face(std::string_view words) {
    Mesh& mesh = meshes_[mesh_];
    const std::size_t first = mesh.corners.size();
    for (auto word = next_word(words); !word.empty(); word = next_word(words))
        append(mesh.corners, read_corner(word), "corners in a group");
    const std::size_t count = mesh.corners.size() - first;
    if (count < 3) in_.fail("a face needs 3 corners and has " + std::to_string(count));
    mesh.faces.push_back({std::uint32_t(first), std::uint32_t(count), material_use_});
}

/// "position", "position/uv", "position//normal" or "position/uv/normal".
Corner ObjReader::read_corner(std::string_view word) {
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
        in_.fail(in_quotes(word) + " is not a corner of a face");
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

void ObjReader::use_material(std::string_view name) {
    const auto next = std::uint32_t(material_uses_.size());
    const auto [use, is_new] = use_of_material_.try_emplace(std::string(name), next);
    if (is_new) material_uses_.push_back({std::string(name), in_.line()});
    material_use_ = use->second;
}

/// The names stand side by side, but may hold blanks themselves.
void ObjReader::read_libraries(std::string_view names) {
    if (read_library(names)) return;
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
    if (bare_name(name).empty() || !fs::exists(file, ignored)) return false;
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
            warnings_.add(in_.file(), line, "there is no material " + in_quotes(name));
    }
    for (Mesh& mesh : meshes_)
        for (Face& face : mesh.faces)
            face.material = face.material == no_index ? 0 : material_of_use[face.material];
}

/// Gives each mesh the elements that its faces use, in the order of first use, and frees the rest.
template <typename Element>
void ObjReader::share_out(std::vector<Element>& all, std::vector<Element> Mesh::* own,
                          std::uint32_t Corner::* index) {
    std::vector<std::uint32_t> own_index_of(all.size(), no_index), used;
    for (Mesh& mesh : meshes_) {
        for (Corner& corner : mesh.corners) {
            if (corner.*index == no_index) continue;
            std::uint32_t& own_index = own_index_of[corner.*index];
            if (own_index == no_index)
                own_index = std::uint32_t(used.size()), used.push_back(corner.*index);
            corner.*index = own_index;
        }
        (mesh.*own).reserve(used.size());
        for (const std::uint32_t i : used)
            (mesh.*own).push_back(all[i]), own_index_of[i] = no_index;
        used.clear();
    }
    all = {};
}

void ObjReader::share_out_elements() {
    if (meshes_.size() == 1) {
        meshes_[0].positions = std::move(positions_);
        meshes_[0].uvs = std::move(uvs_);
        meshes_[0].normals = std::move(normals_);
        return;
    }
    share_out(positions_, &Mesh::positions, &Corner::position);
    share_out(uvs_, &Mesh::uvs, &Corner::uv);
    share_out(normals_, &Mesh::normals, &Corner::normal);
}

void cut_into_triangles(Mesh& mesh) {
    mesh.triangles.reserve(mesh.corners.size() - 2 * mesh.faces.size());
    std::vector<vec3> polygon;
    for (const Face& face : mesh.faces) {
        const auto corners = mesh.corners_of(face);
        const auto add = [&](std::size_t i, std::size_t j, std::size_t k) {
            mesh.triangles.push_back({{corners[i], corners[j], corners[k]}, face.material});
        };
        polygon.clear();
        for (const Corner& corner : corners) {
            polygon.push_back(mesh.positions[corner.position]);
            mesh.bounds.add(polygon.back());
        }
        if (corners.size() == 3)
            add(0, 1, 2);
        else
            for (const auto& [i, j, k] : triangulate(polygon)) add(i, j, k);
    }
}

}  // namespace

Scene load_obj(const fs::path& file, std::uint32_t max_elements) {
    Scene scene = ObjReader(file, max_elements).read();
    for (Mesh& mesh : scene.meshes) cut_into_triangles(mesh);
    return scene;
}

}  // namespace rasterbook
