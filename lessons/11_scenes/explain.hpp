// SPDX-License-Identifier: MIT
/// @file
/// The plan of a picture in words: what runs, what does not and why, counters, and times.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "11_scenes/scene_plan.hpp"
#include "common/app/counters.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// Takes the times of a picture's steps.
class StepClock {
  public:
    /// Ends the step before, if there is one.
    void begin(const char* step) {
        end();
        is_over_ = false;
        steps_.emplace_back(step, 0.0);
        start_ = std::chrono::steady_clock::now();
    }
    void end() {
        if (is_over_) return;
        const auto now = std::chrono::steady_clock::now();
        steps_.back().second = std::chrono::duration<double, std::milli>(now - start_).count();
        is_over_ = true;
    }

    /// Each step and its milliseconds.
    const std::vector<std::pair<const char*, double>>& steps() const { return steps_; }

  private:
    std::vector<std::pair<const char*, double>> steps_;
    std::chrono::steady_clock::time_point start_;
    bool is_over_ = true;
};

/// Writes on standard output what of a scene is drawn and what is not, and what this thread has
/// counted. Several threads may do so at once.
///
/// @param camera    Its name.
/// @param lights    As lights_in_words() has them.
/// @param clock     Its last step ends now.
void explain(const Scene& scene, const ScenePlan& plan, const std::string& camera,
             const std::vector<std::string>& lights, StepClock& clock);

}  // namespace rasterbook
