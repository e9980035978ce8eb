// SPDX-License-Identifier: MIT
#include "common/model/load_budget.hpp"

#include <string>

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

}  // namespace rasterbook
