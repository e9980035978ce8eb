// SPDX-License-Identifier: MIT
/// @file
/// Pictures that a lesson draws of the course's models, and what is asked of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>

#include "common/app/counters.hpp"
#include "common/image/image.hpp"
#include "common/model/mesh.hpp"
#include "common/model/model_file.hpp"

namespace rasterbook::test {

/// One of the course's models: "scene.obj".
inline Scene loaded(const std::string& name) {
    return load_model(std::filesystem::path(RASTERBOOK_ASSETS) / "models" / name);
}

/// Whether two pictures agree in every bit: -0 differs from 0, and NaN agrees with itself.
inline bool are_the_same_bits(const Image<vec3>& a, const Image<vec3>& b) {
    return a.size() == b.size() &&
           std::memcmp(a.pixels().data(), b.pixels().data(), a.pixels().size_bytes()) == 0;
}

/// What this thread counts from now on.
class CountedSince {
  public:
    operator Counters() const {
        Counters counted = thread_counters;
        for (std::size_t i = 0; i < counted.values.size(); ++i)
            counted.values[i] -= then_.values[i];
        return counted;
    }
    auto values() const { return Counters(*this).values; }
    std::uint64_t operator[](Counter counter) const { return Counters(*this)[counter]; }

  private:
    Counters then_ = thread_counters;
};

/// A picture, and what was done to make it.
struct Drawn {
    Image<vec3> picture;
    Counters counters;

    std::uint64_t count(Counter counter) const { return counters[counter]; }
};

/// @param render  Called as render(options, assets): that of a lesson (support/lesson_NN.hpp).
template <typename Options, typename Assets, typename Render>
Drawn drawn(const Options& options, const Assets& assets, Render&& render) {
    const CountedSince counters;
    Image<vec3> picture = render(options, assets);
    return {std::move(picture), counters};
}

}  // namespace rasterbook::test
