// SPDX-License-Identifier: MIT
#include "common/model/load_budget.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>

#include "common/image/input_error.hpp"

namespace rasterbook {

void LoadBudget::charge(Resource resource, std::uint64_t amount,
                        const std::filesystem::path& file) {
    if (amount > left(resource)) {
        const std::string name(resource_names[index(resource)]);
        throw InputError(file, "more than " + std::to_string(most_[index(resource)]) + " " + name +
                                   " in all, the most that are accepted; see --limit " + name +
                                   "=N");
    }
    used_[index(resource)] += amount;
}

void LoadBudget::confine_to(const std::filesystem::path& folder) {
    std::error_code error;
    folder_ = std::filesystem::canonical(folder.empty() ? "." : folder, error);
    if (error) throw InputError(folder, "is not a folder that can be read");
}

bool LoadBudget::allows(const std::filesystem::path& file) const {
    if (folder_.empty()) return true;
    std::error_code error;
    const std::filesystem::path found = std::filesystem::weakly_canonical(file, error);
    return !error && std::ranges::mismatch(folder_, found).in1 == folder_.end();
}

void LoadBudget::check_place(const std::filesystem::path& file) const {
    if (!allows(file))
        throw InputError(file, "lies outside of the model's folder; --sandbox forbids that");
}

void LoadBudget::charge_file(const std::filesystem::path& file) {
    check_place(file);
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    if (!error) charge(Resource::bytes, bytes, file);
}

void LoadBudget::check_overdraw(double work, ivec2 size, const std::filesystem::path& file) const {
    const double times = work / std::max(static_cast<double>(size.x) * size.y, 0x1p20);
    const std::uint64_t most = most_[index(Resource::overdraw)];
    if (times > static_cast<double>(most))
        throw InputError(file, "covers a picture " +
                                   std::to_string(std::llround(std::ceil(times))) +
                                   " times, more than the " + std::to_string(most) +
                                   " that are accepted; see --limit overdraw=N");
}

}  // namespace rasterbook
