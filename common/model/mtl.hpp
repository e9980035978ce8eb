// SPDX-License-Identifier: MIT
/// @file
/// Material libraries, as OBJ files name them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/model/mesh.hpp"
#include "common/model/statements.hpp"

namespace rasterbook {

/// What the loader passed over, each thing once.
class Warnings {
  public:
    void add(const StatementReader& in, const std::string& what) {
        add(in.file(), in.line(), what);
    }
    void add(const std::filesystem::path& file, std::size_t line, const std::string& what) {
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
    /// @param budget  Is charged with bytes and materials.
    MaterialReader(LoadBudget& budget, Warnings& warnings) : budget_(budget), warnings_(warnings) {}

    /// @throws InputError  When the library is not a regular file, or a number in it is wrong.
    void read(const std::filesystem::path& file);

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

    LoadBudget& budget_;
    Warnings& warnings_;
    std::vector<Material> materials_{Material{}};
    std::unordered_map<std::string, std::uint32_t> index_of_name_;
    Material unused_;               ///< Takes what belongs to no material.
    Material* current_ = &unused_;  ///< The material that is being read.
    bool has_d_ = false;            ///< The current material has `d`, which counts more than `Tr`.
};

}  // namespace rasterbook
