// SPDX-License-Identifier: MIT
// What is known of a lesson's picture: its scene's triangles where they are to be seen.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "common/model/model_file.hpp"
#include "support/coffee_pot.hpp"
#include "support/image_doctor.hpp"

namespace rasterbook::test {

namespace {

/// The word behind the option, or "" when it is not among the arguments.
std::string option_value(const std::vector<std::string>& arguments, const std::string& option) {
    std::string value;
    for (std::size_t i = 0; i < arguments.size(); ++i)
        if (arguments[i] == option && i + 1 < arguments.size())
            value = arguments[i + 1];
        else if (arguments[i].starts_with(option + "="))
            value = arguments[i].substr(option.size() + 1);
    return value;
}

/// @param on_screen  Gives a position's place.
std::vector<ScreenPatch> patches_of(const Scene& scene, auto&& on_screen) {
    std::vector<ScreenPatch> patches;
    for (const Mesh& mesh : scene.meshes)
        for (const auto& [vertices, material] : mesh.triangles)
            patches.push_back({on_screen(mesh.positions[vertices[0].position]),
                               on_screen(mesh.positions[vertices[1].position]),
                               on_screen(mesh.positions[vertices[2].position])});
    return patches;
}

}  // namespace

std::vector<ScreenPatch> parallel_patches(const Scene& scene, const OrthographicView& view) {
    return patches_of(scene, [&](vec3 p) { return view.screen_from_model({p})[0]; });
}

std::vector<ScreenPatch> perspective_patches(const Scene& scene, const Bounds& bounds,
                                             const Orbit& orbit, ivec2 size) {
    const dvec3 center = 0.5 * (dvec3(bounds.min) + dvec3(bounds.max));
    const double radius = glm::length(dvec3(bounds.max) - center);
    const double yaw_radians = glm::radians(double{orbit.yaw_degrees});
    const double pitch_radians = glm::radians(double{orbit.pitch_degrees});
    const dvec3 back(std::cos(pitch_radians) * std::sin(yaw_radians), std::sin(pitch_radians),
                     std::cos(pitch_radians) * std::cos(yaw_radians));
    const double distance = orbit.distance * radius;
    // GLM's far is our near: the depth is 1 there.
    const dmat4 clip_from_world = glm::perspectiveRH_ZO(glm::radians(double{orbit.fov_degrees}),
                                                        double{1.0 * size.x} / size.y,
                                                        2 * (distance + radius), 0.001 * distance) *
                                  glm::lookAtRH(center + distance * back, center, dvec3(0, 1, 0));
    return patches_of(scene, [&](vec3 position) {
        const dvec4 clip = clip_from_world * dvec4(position, 1);
        if (!(clip.w > 0)) return vec3(std::numeric_limits<float>::quiet_NaN());
        const dvec3 ndc = dvec3(clip) / clip.w;
        return vec3(0.5 * (ndc.x + 1) * size.x, 0.5 * (1 - ndc.y) * size.y, ndc.z);
    });
}

PictureFacts picture_facts(const std::string& lesson, const std::vector<std::string>& arguments,
                           ivec2 size) {
    PictureFacts facts;
    facts.has_depth_buffer = lesson >= "03";
    facts.shows_barycentrics = option_value(arguments, "--paint") == "barycentric";
    facts.shows_depth = std::find(arguments.begin(), arguments.end(), "--depth") != arguments.end();
    if (lesson < "02" || lesson >= "11") return facts;  // from 11 on a file has its own camera
    Orbit orbit;
    std::filesystem::path model = option_value(arguments, "--model");
    if (model.empty())
        model = lesson < "04" ? "teapot.obj" : lesson < "08" ? "scene.obj" : "scene_bumpy.obj";
    if (lesson.starts_with("07")) {
        orbit.distance = 2.75f, orbit.pitch_degrees = 13;
        if (option_value(arguments, "--model").empty()) model = "figure.obj";
    }
    if (!std::filesystem::exists(model))
        model = std::filesystem::path(RASTERBOOK_ASSETS) / "models" / model;
    const Scene scene = load_model(model);
    Scene pot;
    const auto take = [&](const char* option, float& value) {
        const std::string word = option_value(arguments, option);
        if (!word.empty()) value = std::strtof(word.c_str(), nullptr);
    };
    take("--yaw", orbit.yaw_degrees);
    take("--pitch", orbit.pitch_degrees);
    take("--distance", orbit.distance);
    take("--fov", orbit.fov_degrees);
    if (lesson.starts_with("04")) {
        float turn_degrees = pot_turn_degrees;
        take("--turn", turn_degrees);
        pot = pot_of(scene, world_from_pot(turn_degrees));
    }
    const bool is_parallel = lesson < "04" || option_value(arguments, "--view") == "orthographic";
    for (const Scene& part : {std::cref(scene), std::cref(pot)}) {
        const std::vector<ScreenPatch> patches =
            is_parallel ? parallel_patches(part, OrthographicView(scene, size))
                        : perspective_patches(part, scene.bounds(), orbit, size);
        facts.patches.insert(facts.patches.end(), patches.begin(), patches.end());
    }
    return facts;
}

}  // namespace rasterbook::test
