// SPDX-License-Identifier: MIT
#include "common/model/mtl.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace rasterbook {

namespace {

/// One number is a grey. Spectral and XYZ colours are not read.
void read_color(const StatementReader& in, const Statement& statement, vec3& color,
                Warnings& warnings) {
    std::string_view words = statement.arguments;
    const std::string_view first = next_word(words);
    if (first == "spectral" || first == "xyz")
        return warnings.add_unread(in, std::string(statement.keyword) + " " + std::string(first));
    const bool is_gray = next_word(words).empty();
    color = is_gray ? vec3(read_vector<1>(in, statement).x) : read_vector<3>(in, statement);
    color = glm::clamp(color, -max_color, max_color);
}

TextureMap* find_map(Material& material, std::string_view keyword) {
    if (keyword == "map_kd") return &material.diffuse_map;
    if (keyword == "map_ks") return &material.specular_map;
    if (keyword == "map_ke") return &material.emission_map;
    if (keyword == "map_d") return &material.opacity_map;
    if (keyword == "map_bump" || keyword == "bump") return &material.bump_map;
    if (keyword == "map_norm" || keyword == "norm") return &material.normal_map;
    return nullptr;
}

/// What changes nothing that the lessons draw: refraction and mirrors, and how a map is filtered.
bool changes_nothing(std::string_view keyword) {
    constexpr std::array known{"ni", "tf", "sharpness", "map_aat"};
    return std::ranges::count(known, keyword) > 0;
}

/// Up to three numbers of an option; the picture's name follows them.
dvec3 read_option_vector(const StatementReader& in, std::string_view& words, dvec3 vector) {
    vector.x = read_number(in, next_word(words));
    for (int i = 1; i < 3; ++i) {
        std::string_view after = words;
        float number = 0;
        if (parse(next_word(after), number) == std::errc::invalid_argument) break;
        vector[i] = read_number(in, next_word(words));
    }
    return vector;
}

}  // namespace

void Warnings::add_unread(const StatementReader& in, std::string_view keyword,
                          const std::string& why) {
    constexpr std::size_t most = 32;
    const std::string kind = in_quotes(keyword);
    if (unread_.size() > most || !unread_.emplace(in.file(), kind).second) return;
    add(in, unread_.size() > most ? "further kinds of statements are not read"
                                  : kind + " is not read" + why);
}

const std::string& NameOrComment::of_file(const std::filesystem::path& beside,
                                          const LoadBudget& budget) const {
    if (whole == cut) return cut;
    const std::filesystem::path file = path_beside(beside, whole);
    std::error_code ignored;  // where no file may be read, not even whether it exists is told
    return budget.allows(file) && std::filesystem::exists(file, ignored) ? whole : cut;
}

std::uint32_t MaterialReader::find(const NameOrComment& name) const {
    const auto find = [](const auto& names, const std::string& text) {
        const auto found = names.find(text);
        return found == names.end() ? 0 : found->second;
    };
    if (const std::uint32_t index = find(index_of_name_, name.whole)) return index;
    if (const std::uint32_t index = find(index_of_name_, name.cut)) return index;
    return name.has_hash_in_word() ? 0 : find(index_of_cut_name_, name.cut);
}

std::vector<Material> MaterialReader::take() {
    for (Material& material : materials_)
        if (!material.emission_map.file.empty() && material.emission == vec3(0))
            material.emission = vec3(1);
    return std::move(materials_);
}

void MaterialReader::read(const std::filesystem::path& file) {
    StatementReader in(file, budget_);
    current_ = &unused_;
    for (Statement statement; in.next(statement);) read_statement(in, statement);
}

/// The first material of a name counts.
void MaterialReader::begin_material(const StatementReader& in, const NameOrComment& names) {
    const auto index = std::uint32_t(materials_.size());
    const std::string& name = names.whole;
    const bool is_new = index_of_name_.emplace(name, index).second;
    if (names.cut != names.whole) index_of_cut_name_.emplace(names.cut, index);
    if (is_new) budget_.charge(Resource::materials, 1, in.file());
    if (is_new) materials_.emplace_back().name = name;
    if (!is_new) warnings_.add(in, "material " + in_quotes(name) + " is defined already");
    current_ = is_new ? &materials_.back() : &unused_;
    has_d_ = false;
}

void MaterialReader::read_statement(const StatementReader& in, const Statement& statement) {
    std::string keyword(statement.keyword);  // Exporters differ: map_Bump, map_bump.
    for (char& c : keyword) c = char(std::tolower(static_cast<unsigned char>(c)));
    Material& material = *current_;
    const auto number = [&] { return read_vector<1>(in, statement).x; };
    const auto read_color_into = [&](vec3& color) { read_color(in, statement, color, warnings_); };

    if (TextureMap* map = find_map(material, keyword))
        read_map(in, statement, *map);
    else if (keyword == "newmtl")
        begin_material(in, NameOrComment(statement));
    else if (keyword == "ka")
        read_color_into(material.ambient);
    else if (keyword == "kd")
        read_color_into(material.diffuse);
    else if (keyword == "ks")
        read_color_into(material.specular);
    else if (keyword == "ke")
        read_color_into(material.emission);
    else if (keyword == "ns")
        material.shininess = std::max(number(), 0.0f);
    else if (keyword == "illum")
        material.illumination = int(std::clamp(number(), 0.0f, 10.0f));
    else if (keyword == "d" && statement.arguments.starts_with("-halo"))
        warnings_.add_unread(in, "d -halo");
    else if (keyword == "d")
        material.opacity = std::clamp(number(), 0.0f, 1.0f), has_d_ = true;
    else if (keyword == "tr") {
        if (!has_d_) material.opacity = std::clamp(1 - number(), 0.0f, 1.0f);
    } else if (!changes_nothing(keyword) && !statement.arguments.empty())
        warnings_.add_unread(in, statement.keyword);
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
            map.offset = read_option_vector(in, words, dvec3(0));
        else if (option == "-s")
            map.scale = read_option_vector(in, words, dvec3(1));
        else if (option == "-t")
            read_option_vector(in, words, dvec3(0));
        else if (option == "-bm")
            map.bump_multiplier = static_cast<float>(read_number(in, next_word(words)));
        else if (option == "-clamp")
            map.clamp = bvec2(next_word(words) == "on");
        else if (option == "-mm")
            next_word(words), next_word(words);
        else if (std::ranges::count(with_one_word, option))
            next_word(words);
        else
            break;
    }
    const std::string_view all = statement.with_comment;
    const NameOrComment names({{}, name, all.substr(std::size_t(name.data() - all.data()))});
    const std::string& file = names.of_file(in.file(), budget_);
    if (file.empty()) return warnings_.add(in, std::string(statement.keyword) + " names no file");
    map.file = path_beside(in.file(), file);
    map.library = in.file();
    map.line = in.line();
}

}  // namespace rasterbook
