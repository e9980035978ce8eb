// SPDX-License-Identifier: MIT
/// @file
/// The plan of a picture in words: what runs, what does not and why, counters, and times.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "12_effects/planned_scene.hpp"
#include "common/app/counters.hpp"

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

/// What a scene is lit by: a string for each light, and one for an exposure below 1; or that no
/// material calls for light.
std::vector<std::string> lights_in_words(const SceneLights& lit_by, const ScenePlan& plan);

/// Writes on standard output what of a scene is drawn and what is not, and what this thread has
/// counted. Several threads may do so at once.
///
/// @param camera  Its name.
/// @param clock   Its last step ends now.
void explain(const PlannedScene& assets, const std::string& camera, StepClock& clock);

}  // namespace rasterbook
