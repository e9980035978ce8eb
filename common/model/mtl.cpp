// SPDX-License-Identifier: MIT
#include "common/model/mtl.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace rasterbook {

namespace {

/// One number is a grey. Spectral and XYZ colours are passed over.
void read_color(const StatementReader& in, const Statement& statement, vec3& color) {
    std::string_view words = statement.arguments;
    const std::string_view first = next_word(words);
    if (first == "spectral" || first == "xyz") return;
    const bool is_gray = next_word(words).empty();
    color = is_gray ? vec3(read_vector<1>(in, statement).x) : read_vector<3>(in, statement);
    color = glm::clamp(color, -max_color, max_color);
}

TextureMap* find_map(Material& material, std::string_view keyword) {
    if (keyword == "map_kd") return &material.diffuse_map;
    if (keyword == "map_ks") return &material.specular_map;
    if (keyword == "map_d") return &material.opacity_map;
    if (keyword == "map_bump" || keyword == "bump") return &material.bump_map;
    if (keyword == "map_norm" || keyword == "norm") return &material.normal_map;
    return nullptr;
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

}  // namespace

void MaterialReader::read(const std::filesystem::path& file) {
    StatementReader in(file, budget_);
    current_ = &unused_;
    for (Statement statement; in.next(statement);) read_statement(in, statement);
}

/// The first material of a name counts.
void MaterialReader::begin_material(const StatementReader& in, std::string_view name) {
    const auto index = std::uint32_t(materials_.size());
    const bool is_new = index_of_name_.emplace(name, index).second;
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
    map.library = in.file();
    map.line = in.line();
}

}  // namespace rasterbook
