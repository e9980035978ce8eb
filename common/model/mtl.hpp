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
    /// That a kind of statement is not read, and why that counts. The first 32 kinds have names.
    void add_unread(const StatementReader& in, std::string_view keyword,
                    const std::string& why = "");
    std::vector<std::string> take() { return std::move(texts_); }

  private:
    std::set<std::pair<std::string, std::string>> seen_, unread_;
    std::vector<std::string> texts_;
};

/// The names that a statement may give: all of it, and without what may be a comment.
struct NameOrComment {
    std::string whole, cut;

    explicit NameOrComment(const Statement& statement)
        : whole(bare_name(statement.with_comment)), cut(bare_name(statement.arguments)) {}

    /// Whether a '#' has no blank behind it, as in `Paint #3`.
    bool has_hash_in_word() const {
        const std::size_t hash = whole.find('#', cut.size()), behind = hash + 1;
        return hash != whole.npos && behind < whole.size() && !is_blank(whole[behind]);
    }

    /// That of the two which is a file's, beside another one: the whole name if there is such a
    /// file.
    const std::string& of_file(const std::filesystem::path& beside, const LoadBudget& budget) const;
};

/// Reads material libraries.
class MaterialReader {
  public:
    /// @param budget  Is charged with bytes and materials.
    MaterialReader(LoadBudget& budget, Warnings& warnings) : budget_(budget), warnings_(warnings) {}

    /// @throws InputError  When the library is not a regular file, or a number in it is wrong.
    void read(const std::filesystem::path& file);

    /// The index of a material, 0 when there is none of that name: of the whole name, or of what
    /// stands before a comment here, or before one that its `newmtl` may have.
    std::uint32_t find(const NameOrComment& name) const;
    /// Where there is an emission map, a Ke of 0, or none, counts as 1: exporters write it so.
    std::vector<Material> take();

  private:
    void begin_material(const StatementReader& in, const NameOrComment& names);
    void read_statement(const StatementReader& in, const Statement& statement);
    void read_map(const StatementReader& in, const Statement& statement, TextureMap& map);

    LoadBudget& budget_;
    Warnings& warnings_;
    std::vector<Material> materials_{Material{}};
    std::unordered_map<std::string, std::uint32_t> index_of_name_;      ///< The whole name.
    std::unordered_map<std::string, std::uint32_t> index_of_cut_name_;  ///< Where it has a '#'.
    Material unused_;               ///< Takes what belongs to no material.
    Material* current_ = &unused_;  ///< The material that is being read.
    bool has_d_ = false;            ///< The current material has `d`, which counts more than `Tr`.
};

}  // namespace rasterbook
