// SPDX-License-Identifier: MIT
// Scenes far from the world's origin: stored relative to a point near their middle, and drawn as
// they are drawn at the origin.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "common/model/model_file.hpp"
#include "common/model/world_box.hpp"
#include "support/gltf_builder.hpp"
#include "support/lesson_process.hpp"
#include "support/texts.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

namespace fs = std::filesystem;
using Whole3 = glm::vec<3, std::int64_t>;

/// Offsets in units, as maps, buildings and globes have them: multiples of 32.
const std::vector<Whole3> offsets = {{500000, 0, -4600000},     {0, 0, 10000000},
                                     {-10000000, 0, 0},         {0, 1000000, 0},
                                     {4096, -1000000, 9999968}, {-2000000, 64, 1000000}};

/// Thousandths as files have them, every digit: "-12.345".
std::string decimal(std::int64_t thousandths) {
    const std::int64_t size = std::abs(thousandths);
    const std::string digits = std::to_string(size % 1000 + 1000).substr(1);
    return (thousandths < 0 ? "-" : "") + std::to_string(size / 1000) + '.' + digits;
}

/// Random triangles in thousandths of a unit, each seen from both sides.
struct Shape {
    std::vector<Whole3> points;

    /// @param half  Half of the side of the cube that they lie in, up to 5000.
    Shape(std::uint64_t seed, std::int64_t half, int triangles = 12) {
        const auto coordinate = [&] {
            seed = seed * 6364136223846793005 + 1442695040888963407;
            return static_cast<std::int64_t>((seed >> 33) % static_cast<std::uint64_t>(2 * half)) -
                   half;
        };
        for (int i = 0; i < 3 * triangles; ++i) {
            const std::int64_t x = coordinate(), y = coordinate();
            points.push_back({x, y, coordinate()});
        }
    }

    /// @param offset  In units.
    fs::path write_obj(const fs::path& file, Whole3 offset) const {
        std::ofstream out(file);
        for (const Whole3 p : points) {
            out << 'v';
            for (int i = 0; i < 3; ++i) out << ' ' << decimal(1000 * offset[i] + p[i]);
            out << '\n';
        }
        for (std::size_t i = 1; i < points.size(); i += 3)
            out << "f " << i << ' ' << i + 1 << ' ' << i + 2 << "\nf " << i << ' ' << i + 2 << ' '
                << i + 1 << '\n';
        return file;
    }

    /// A mesh, a camera and two lights below some nodes, each in the one before.
    GltfBuilder gltf(const std::vector<json>& nodes) const {
        GltfBuilder made;
        std::vector<double> numbers, indices;
        for (const Whole3 p : points)
            for (int i = 0; i < 3; ++i) numbers.push_back(static_cast<double>(p[i]) / 1000);
        for (std::size_t i = 0; i < points.size(); i += 3)
            for (const std::size_t k : std::initializer_list<std::size_t>{0, 1, 2, 0, 2, 1})
                indices.push_back(static_cast<double>(i + k));
        made.document["meshes"] = {
            {{"primitives",
              {{{"attributes", {{"POSITION", made.add(numbers, "VEC3", gl_float)}}},
                {"indices", made.add(indices, "SCALAR", gl_unsigned_short)}}}}}};
        made.document["cameras"] = {
            {{"type", "perspective"}, {"perspective", {{"yfov", 0.9}, {"znear", 0.01}}}}};
        made.document["extensions"]["KHR_lights_punctual"]["lights"] = {
            {{"type", "point"}, {"intensity", 400}},
            {{"type", "spot"}, {"intensity", 900}, {"spot", json::object()}}};
        const auto light = [](int i, std::vector<double> at) {
            return json{{"translation", at},
                        {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}};
        };
        made.document["nodes"] = nodes;
        for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
            made.document["nodes"][i]["children"] = {i + 1};
        const std::size_t first = nodes.size();
        made.document["nodes"][first - 1]["children"] = {first, first + 1, first + 2, first + 3};
        for (const json& node : {json{{"mesh", 0}}, json{{"camera", 0}, {"translation", {0, 0, 9}}},
                                 light(0, {3, 4, 5}), light(1, {-1, 0, 12})})
            made.document["nodes"].push_back(node);
        return made;
    }
};

json moved(Whole3 by) { return {{"translation", {by.x, by.y, by.z}}}; }
const json turned = {{"rotation", {0.48, 0.6, 0.0, 0.64}}, {"scale", {0.5, 0.25, 1.0}}};

std::string drawn(const std::string& lesson, const fs::path& model) {
    return bytes_of_picture(lesson, {"--size", "120x90", "--model", model.string()});
}

}  // namespace

TEST(FarScenes, PositionsLoseNothingByStandingFarAway) {
    const fs::path file = fresh_folder("far") / "a.obj";
    for (std::uint64_t seed = 1; seed <= 20; ++seed)
        for (const Whole3 offset : offsets) {
            const Shape shape(seed, 250 * static_cast<std::int64_t>(seed));
            const Whole3 odd = offset + Whole3(seed, -seed, 7 * seed);  // multiples of nothing
            const Scene scene = load_model(shape.write_obj(file, odd));
            ASSERT_NE(scene.origin, dvec3(0));
            const float radius = scene.bounds().radius();
            for (std::size_t i = 0; i < shape.points.size(); ++i)
                for (int axis = 0; axis < 3; ++axis) {
                    const std::int64_t here = 1000 * odd[axis] + shape.points[i][axis] -
                                              std::llround(1000 * scene.origin[axis]);
                    const double expected = static_cast<double>(here) / 1000, far = 1e7;
                    // Within half an ulp of what the scene says; and the scene keeps nothing large.
                    ASSERT_NEAR(double{scene.meshes.at(0).positions.at(i)[axis]}, expected,
                                0x1p-24 * std::abs(expected) + 0x1p-53 * far)
                        << "seed " << seed << ", point " << i << ", axis " << axis;
                    ASSERT_LE(std::abs(expected), 4 * radius);
                }
        }
}

TEST(FarScenes, AScenesNumbersAreThoseOfTheFileUpToEightRadii) {
    for (const double radii : {-7.9, -1.0, 0.0, 7.9, 8.1, -8.1})
        for (int axis = 0; axis < 3; ++axis) {
            WorldBox box;
            dvec3 middle(0);
            middle[axis] = radii * std::sqrt(3.0);
            box.add(middle - 1.0), box.add(middle + 1.0);
            const dvec3 origin = box.origin();
            EXPECT_EQ(origin == dvec3(0), std::abs(radii) < 8) << radii;
            EXPECT_LE(std::abs(origin[axis] - middle[axis]), std::abs(radii) < 8 ? 14 : 4) << radii;
        }
    WorldBox box;
    EXPECT_EQ(box.origin(), dvec3(0)) << "of no points";
    box.add(dvec3(1e7));
    EXPECT_EQ(box.origin(), dvec3(0)) << "of no size";
}

TEST(FarScenes, EachLessonDrawsTheSamePictureOfAnObjFile) {
    const fs::path folder = fresh_folder("far");
    for (const std::string& lesson : lessons()) {
        const Shape shape(1, 3000);
        const std::string expected = drawn(lesson, shape.write_obj(folder / "near.obj", {}));
        for (const Whole3 offset : offsets)
            EXPECT_EQ(drawn(lesson, shape.write_obj(folder / "far.obj", offset)), expected)
                << lesson << " draws another picture at " << testing::PrintToString(offset);
    }
}

TEST(FarScenes, NodesFarAwayAndThoseThatCancelGiveTheSamePicture) {
    const fs::path folder = fresh_folder("far");
    const Shape shape(7, 3000);
    const auto picture = [&](const char* lesson, const std::vector<json>& nodes) {
        return drawn(lesson, shape.gltf(nodes).write(folder / "a.gltf"));
    };
    for (const char* lesson :
         {"06_phong", "11_scenes", "12_effects", "13_visibility_buffer", "14_simd"}) {
        const std::string expected = picture(lesson, {moved({})});
        const std::string expected_turned = picture(lesson, {turned});
        for (const Whole3 offset : offsets) {
            const std::string at = std::string(lesson) + testing::PrintToString(offset);
            EXPECT_EQ(picture(lesson, {moved(offset)}), expected) << at;
            EXPECT_EQ(picture(lesson, {moved(offset), turned}), expected_turned) << at;
            EXPECT_EQ(picture(lesson, {moved(offset), moved({1, 2, 3}), moved(-offset)}),
                      picture(lesson, {moved({1, 2, 3})}))
                << at;
        }
    }
}

TEST(FarScenes, MeshesCamerasAndLightsStandWhereTheFileSays) {
    const fs::path file = fresh_folder("far") / "a.gltf";
    const Shape shape(3, 2000);
    for (const Whole3 offset : offsets) {
        const Scene scene = load_model(shape.gltf({moved(offset)}).write(file));
        const dvec3 origin = scene.origin;
        EXPECT_NE(origin, dvec3(0));
        for (std::size_t i = 0; i < shape.points.size(); ++i) {
            const vec3 own = vec3(dvec3(shape.points[i]) / 1000.0);  // as the file has it
            const dvec3 found = origin + dvec3(scene.meshes.at(0).positions.at(i));
            ASSERT_LE(glm::distance(found, dvec3(offset) + dvec3(own)), 1e-6) << "point " << i;
        }
        EXPECT_EQ(origin + dvec3(scene.cameras.at(0).world_from_view[3]),
                  dvec3(offset) + dvec3(0, 0, 9));
        EXPECT_EQ(origin + dvec3(scene.lights.at(0).position_world),
                  dvec3(offset) + dvec3(3, 4, 5));
        EXPECT_EQ(origin + dvec3(scene.lights.at(1).position_world),
                  dvec3(offset) + dvec3(-1, 0, 12));
    }
}

TEST(FarScenes, ProbeAndExplainSpeakOfTheWorld) {
    const fs::path folder = fresh_folder("far"), file = folder / "a.obj";
    std::ofstream(file) << "v 500000 0 -4600000\nv 500008 0 -4600000\nv 500008 8 -4600000\n"
                           "v 500000 8 -4600000\nf 1 2 3 4\n";
    for (const char* lesson :
         {"06_phong_complete", "09_shadow_maps_complete", "11_scenes_complete"}) {
        const ProcessResult said =
            run_program(lesson, {"--size", "65x65", "--yaw", "0", "--pitch", "0", "--distance", "3",
                                 "--probe", "32,32", "--model", file.string()});
        EXPECT_NE(said.out.find("500004.000 4.000 -4600000.000"), std::string::npos)
            << lesson << said.out << said.err;
    }
    const ProcessResult said =
        run_program("12_effects", {"--size", "8x8", "--explain", "--model", file.string(), "--out",
                                   (folder / "a.png").string()});
    EXPECT_NE(said.out.find("relative to 500000.000 0.000 -4600000.000"), std::string::npos)
        << said.out << said.err;
}
