// SPDX-License-Identifier: MIT
/// @file
/// Models as the generator builds them, and the OBJ text that they become.
#pragma once

#include <charconv>
#include <cstddef>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/math/types.hpp"

namespace rasterbook::assets {

struct Vertex {
    dvec3 position;
    dvec2 uv;
    dvec3 normal;
};

using Polygon = std::vector<Vertex>;  ///< Counter-clockwise seen from outside.

/// Faces of one group and one material.
struct Part {
    std::string group;
    std::string material;
    std::vector<Polygon> faces;
};

struct Model {
    std::string comment;           ///< One line, without the `#`.
    std::string material_library;  ///< File name, beside the model.
    std::vector<Part> parts;
};

/// The number with at most five decimals: no exponent, no trailing zeros, no "-0".
inline std::string text_of(double value) {
    char buffer[64];
    const auto result =
        std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, 5);
    std::string text(buffer, result.ptr);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

/// Statements of one kind (v, vt or vn), each distinct one once, numbered from 1 as OBJ does.
///
/// Told apart by their text: corners that agree to the last digit written share an index.
class NumberedLines {
  public:
    std::size_t number_of(const std::string& line) {
        const auto [entry, is_new] = numbers_.try_emplace(line, numbers_.size() + 1);
        if (is_new) text_ += line + '\n';
        return entry->second;
    }

    const std::string& text() const { return text_; }

  private:
    std::unordered_map<std::string, std::size_t> numbers_;
    std::string text_;
};

template <int n>
std::string line_of(const char* keyword, const glm::vec<n, double>& v) {
    std::string line = keyword;
    for (int i = 0; i < n; ++i) {
        line += ' ';
        line += text_of(v[i]);
    }
    return line;
}

/// The model as a Wavefront OBJ file.
inline std::string obj_text(const Model& model) {
    NumberedLines positions, uvs, normals;
    std::string faces, group;
    for (const Part& part : model.parts) {
        if (part.group != group) faces += "g " + (group = part.group) + '\n';
        faces += "usemtl " + part.material + '\n';
        for (const Polygon& polygon : part.faces) {
            faces += 'f';
            for (const Vertex& vertex : polygon)
                faces += ' ' + std::to_string(positions.number_of(line_of("v", vertex.position))) +
                         '/' + std::to_string(uvs.number_of(line_of("vt", vertex.uv))) + '/' +
                         std::to_string(normals.number_of(line_of("vn", vertex.normal)));
            faces += '\n';
        }
    }
    return "# " + model.comment + "\nmtllib " + model.material_library + '\n' + positions.text() +
           uvs.text() + normals.text() + faces;
}

}  // namespace rasterbook::assets
