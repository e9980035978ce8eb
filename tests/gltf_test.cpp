// SPDX-License-Identifier: MIT
/// @file
/// The geometry of glTF files: attributes, transforms, and the order of vertices.
#include "common/model/gltf.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "support/gltf_builder.hpp"
#include "support/lesson_process.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

Scene read(const GltfBuilder& made, GltfForm form = GltfForm::embedded) {
    return load_gltf(made.write(
        fresh_folder("gltf") / (form == GltfForm::binary ? "scene.glb" : "scene.gltf"), form));
}

/// Of a triangle's vertex.
vec3 position(const Mesh& mesh, std::size_t triangle, std::size_t vertex) {
    return mesh.positions.at(mesh.triangles.at(triangle).vertices[vertex].position);
}

vec3 normal(const Mesh& mesh, std::size_t triangle, std::size_t vertex) {
    return mesh.normals.at(mesh.triangles.at(triangle).vertices[vertex].normal);
}

using Wide = long double;
using Wide3 = glm::vec<3, Wide>;
using Wide4 = glm::mat<4, 4, Wide>;
using Wide33 = glm::mat<3, 3, Wide>;

/// Any matrix that turns, scales, shears and moves, and mirrors now and then.
Wide4 any_affine(std::mt19937& random) {
    std::uniform_real_distribution<float> number(-0.5f, 0.5f);  // floats, as the file has them
    Wide4 matrix(1);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row) matrix[column][row] += number(random);
    if (random() % 4 == 0) matrix[0] = -matrix[0];
    return matrix;
}

std::vector<double> numbers_of(const Wide4& matrix) {
    std::vector<double> numbers;
    for (int i = 0; i < 16; ++i) numbers.push_back(double(matrix[i / 4][i % 4]));
    return numbers;
}

/// Each vertex of one_triangle() is where its matrix takes it, and so is its normal; the order
/// keeps them on the same side.
void expect_transformed(const Scene& scene, const std::array<Wide4, 3>& matrices) {
    // Products in double of numbers up to about 10 are rounded to float: half an ulp.
    constexpr Wide position_tolerance = 4e-6L, normal_tolerance = 1e-6L;
    const bool is_mirrored = glm::determinant(Wide33(matrices[0])) < 0;
    for (std::size_t vertex = 0; vertex < 3; ++vertex) {
        const std::size_t from = is_mirrored && vertex > 0 ? 3 - vertex : vertex;
        const glm::vec<4, Wide> source(from == 1 ? 1 : 0, from == 2 ? 1 : 0, 0, 1);
        const Wide3 world = Wide3(position(scene.meshes.at(0), 0, vertex)) + Wide3(scene.origin);
        EXPECT_LT(glm::distance(world, Wide3(matrices[from] * source)), position_tolerance)
            << "position of vertex " << vertex;
        const Wide3 expected_normal =
            glm::normalize(glm::transpose(glm::inverse(Wide33(matrices[from]))) * Wide3(0, 0, 1));
        EXPECT_LT(glm::distance(Wide3(normal(scene.meshes[0], 0, vertex)), expected_normal),
                  normal_tolerance)
            << "normal of vertex " << vertex;
    }
}

}  // namespace

TEST(Gltf, ATriangleIsTheSameInAllThreeFormsOfFiles) {
    const std::array uvs = {dvec2(0, 0), dvec2(1, 0), dvec2(0, 0.75)};  // v upside down
    for (const GltfForm form : {GltfForm::embedded, GltfForm::separate, GltfForm::binary}) {
        const Scene scene = read(one_triangle(), form);
        ASSERT_EQ(scene.meshes.size(), 1u);
        const Mesh& mesh = scene.meshes[0];
        EXPECT_EQ(mesh.name, "triangle");
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_EQ(position(mesh, 0, i), vec3(i == 1, i == 2, 0));
            EXPECT_EQ(normal(mesh, 0, i), vec3(0, 0, 1));
            EXPECT_EQ(mesh.uvs.at(mesh.triangles[0].vertices[i].uv), uvs[i]);
        }
        ASSERT_EQ(scene.materials.size(), 2u);
        EXPECT_EQ(scene.materials[0].diffuse, vec3(0.8f));  // for faces without a material
        EXPECT_EQ(scene.materials[mesh.triangles[0].material].name, "paint");
        EXPECT_EQ(mesh.faces.size(), 1u);
        EXPECT_EQ(mesh.faces[0].vertex_count, 3u);
        EXPECT_EQ(scene.bounds().max, vec3(1, 1, 0));
        EXPECT_TRUE(scene.warnings.empty());
        EXPECT_TRUE(scene.cameras.empty() && scene.lights.empty());
    }
}

TEST(Gltf, NodesTransformAsInExactArithmetic) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> number(-1, 1), size(0.5, 2);
    for (int i = 0; i < 200; ++i) {
        SCOPED_TRACE("seed 1, case " + std::to_string(i));
        GltfBuilder made = one_triangle();
        json& nodes = made.document["nodes"] = json::array();
        Wide4 world(1);
        for (int depth = 0; depth < 4; ++depth) {
            json node = {{"children", {depth + 1}}};
            if (depth == 3) node = {{"mesh", 0}};
            Wide4 own(1);
            if (depth == 2) {
                own = any_affine(random);
                node["matrix"] = numbers_of(own);
            } else {
                glm::dvec4 q(number(random), number(random), number(random), number(random));
                q /= glm::length(q);
                const Wide3 s(size(random), -size(random), size(random));
                const Wide3 t(number(random), number(random), number(random));
                node["rotation"] = {q.x, q.y, q.z, q.w};
                node["scale"] = {double(s.x), double(s.y), double(s.z)};
                node["translation"] = {double(t.x), double(t.y), double(t.z)};
                // q v q* by cross products: v + 2 w (u x v) + 2 u x (u x v).
                const Wide3 u(q.x, q.y, q.z);
                for (int axis = 0; axis < 3; ++axis) {
                    Wide3 v(0);
                    v[axis] = s[axis];
                    own[axis] = glm::vec<4, Wide>(v + Wide(2) * Wide(q.w) * glm::cross(u, v) +
                                                      Wide(2) * glm::cross(u, glm::cross(u, v)),
                                                  0);
                }
                own[3] = glm::vec<4, Wide>(t, 1);
            }
            nodes.push_back(node);
            world = world * own;
        }
        if (std::abs(glm::determinant(Wide33(world))) < 0.01L) continue;
        expect_transformed(read(made), {world, world, world});
    }
}

TEST(Gltf, ANodeWithoutExtentGivesFiniteNormals) {
    GltfBuilder made = one_triangle();
    made.document["nodes"][0]["scale"] = {1, 1, 0};
    const Scene flat = read(made);
    EXPECT_EQ(normal(flat.meshes.at(0), 0, 0), vec3(0, 0, 1));
    made.document["nodes"][0]["scale"] = {0, 1, 0};
    const Scene line = read(made);
    EXPECT_EQ(normal(line.meshes.at(0), 0, 0), vec3(0));
    EXPECT_EQ(line.bounds().max, vec3(0, 1, 0));
}

TEST(Gltf, EachNodeOfTheSceneIsAMeshOfItsOwn) {
    GltfBuilder made = one_triangle();
    made.set(R"("/nodes": [{"mesh": 0, "name": "near", "children": [1]},
                           {"mesh": 0, "translation": [0, 0, -5]},
                           {"mesh": 0, "name": "in another scene"}],
                "/scenes/1/nodes": [2])");
    const Scene scene = read(made);
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.meshes[0].name, "near");
    EXPECT_EQ(scene.meshes[1].name, "triangle");
    EXPECT_EQ(scene.meshes[1].bounds.min.z, -5);
    EXPECT_EQ(read(made.set(R"("/scene": 1)")).meshes.at(0).name, "in another scene");
    made.set(R"("/scene": null, "/scenes": null)");
    EXPECT_EQ(read(made).meshes.size(), 3u);  // all that are no child, and their children
}

TEST(Gltf, ListsStripsAndFansAreTriangles) {
    const std::vector<double> square = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
    const auto vertices = [&](int mode, const std::vector<double>& indices, int type) {
        GltfBuilder made = one_triangle();
        made.primitive() = {{"attributes", {{"POSITION", made.add(square, "VEC3", gl_float)}}},
                            {"mode", mode}};
        if (!indices.empty()) made.primitive()["indices"] = made.add(indices, "SCALAR", type);
        std::string text;
        const Scene scene = read(made);
        for (std::size_t t = 0; t < scene.meshes.at(0).triangles.size(); ++t) {
            if (t > 0) text += ' ';
            for (std::size_t c = 0; c < 3; ++c) {
                const vec3 p = position(scene.meshes[0], t, c);
                text += char('0' + int(p.x) + 2 * int(p.y));
            }
        }
        return text;
    };
    for (const int type : {gl_unsigned_byte, gl_unsigned_short, gl_unsigned_int})
        EXPECT_EQ(vertices(4, {0, 1, 2, 2, 1, 3}, type), "012 213");
    EXPECT_EQ(vertices(5, {}, 0), "012 213 234");  // every second one has its vertices swapped
    EXPECT_EQ(vertices(5, {0, 1, 2, 3}, gl_unsigned_byte), "012 213");
    EXPECT_EQ(vertices(6, {0, 1, 3, 2}, gl_unsigned_byte), "013 032");
    EXPECT_EQ(vertices(4, {0, 1, 2, 3}, gl_unsigned_byte), "012");  // and a warning
}

TEST(Gltf, WithoutNormalsEachFaceHasItsOwn) {
    GltfBuilder made = one_triangle();
    made.primitive()["attributes"] = {
        {"POSITION", made.add({0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2}, "VEC3", gl_float)}};
    made.primitive()["indices"] = made.add({0, 1, 2, 0, 3, 1}, "SCALAR", gl_unsigned_byte);
    const Scene scene = read(made);
    const Mesh& mesh = scene.meshes.at(0);
    for (std::size_t vertex = 0; vertex < 3; ++vertex) {
        EXPECT_EQ(normal(mesh, 0, vertex), vec3(0, 0, 1));
        EXPECT_EQ(normal(mesh, 1, vertex), vec3(0, 1, 0));
    }
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.triangles[0].vertices[0].uv, no_index);
}

TEST(Gltf, PointsThatDifferInColourAloneStayApart) {
    GltfBuilder made = one_triangle();
    made.primitive() = {
        {"attributes",
         {{"POSITION",
           made.add({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 0, -0.0, 0, 1, 1, 0}, "VEC3", gl_float)},
          {"COLOR_0",
           made.add({0, 0, 0, 51, 102, 153, 0, 0, 255, 255, 0, 0, 0, 0, 0, 255, 255, 255}, "VEC3",
                    gl_unsigned_byte, true)}}}};
    const Scene scene = read(made);
    const Mesh& mesh = scene.meshes.at(0);
    ASSERT_EQ(mesh.positions.size(), 5u);  // 0 and 4 agree, 1 and 3 do not
    ASSERT_EQ(mesh.colors.size(), 5u);
    EXPECT_EQ(mesh.colors[mesh.vertices[1].position], vec4(0.2f, 0.4f, 0.6f, 1));
    EXPECT_EQ(mesh.colors[mesh.vertices[3].position], vec4(1, 0, 0, 1));
    EXPECT_EQ(mesh.vertices[0].position, mesh.vertices[4].position);

    std::vector<double> points, colors;
    for (int i = 0; i < 9; ++i) {  // four points, again with another channel each, and the first
        points.insert(points.end(), {double(i % 4), 0, 0});
        for (int c = 0; c < 4; ++c) colors.push_back(i == 4 + c ? 0.25 : 0.5);
    }
    made.primitive()["attributes"] = {{"POSITION", made.add(points, "VEC3", gl_float)},
                                      {"COLOR_0", made.add(colors, "VEC4", gl_float)}};
    EXPECT_EQ(read(made).meshes.at(0).positions.size(), 8u);
}

TEST(Gltf, ColoursAreBroughtIntoTheirRange) {
    GltfBuilder made = one_triangle();
    made.primitive()["attributes"]["COLOR_0"] =
        made.add({3e38, -3e38, 0.5, 7, 1, 0, -0.5, -1, 1, 1, 1, 0.25}, "VEC4", gl_float);
    made.material()["emissiveFactor"] = {3e38, 1, 0};
    const Scene scene = read(made);
    const Mesh& mesh = scene.meshes.at(0);
    EXPECT_EQ(mesh.colors.at(mesh.vertices.at(0).position), vec4(1, 0, 0.5f, 1));
    EXPECT_EQ(mesh.colors.at(mesh.vertices.at(1).position), vec4(1, 0, 0, 0));
    EXPECT_EQ(mesh.colors.at(mesh.vertices.at(2).position), vec4(1, 1, 1, 0.25f));
    EXPECT_EQ(scene.materials.at(1).emission, vec3(max_color, 1, 0));
}

TEST(Gltf, PrimitivesOfAMeshShareItsPointsAndKeepTheirMaterials) {
    GltfBuilder made = one_triangle();
    json second = made.primitive();
    second.erase("material");
    second["attributes"]["COLOR_0"] =
        made.add({0.5, 0.5, 0.5, 0.25, 1, 1, 1, 1, 1, 1, 1, 1}, "VEC4", gl_float);
    made.document["meshes"][0]["primitives"].push_back(second);
    const Scene scene = read(made);
    const Mesh& mesh = scene.meshes.at(0);
    ASSERT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.triangles[0].material, 1u);
    EXPECT_EQ(mesh.triangles[1].material, 0u);
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
    EXPECT_EQ(mesh.positions.size(), 4u);  // the first has no colours: they count as white
    EXPECT_EQ(mesh.colors[mesh.triangles[1].vertices[0].position], vec4(0.5f, 0.5f, 0.5f, 0.25f));
    EXPECT_EQ(mesh.triangles[0].vertices[1].position, mesh.triangles[1].vertices[1].position);
}

TEST(Gltf, AttributesMayBeWholeNumbersAndInterleaved) {
    GltfBuilder made = one_triangle();
    // Whole positions, as of KHR_mesh_quantization; normals and uvs as normalized whole numbers.
    made.document["extensionsRequired"] = {"KHR_mesh_quantization"};
    json& attributes = made.primitive()["attributes"];
    attributes["POSITION"] = made.add({0, 0, 0, 300, 0, 0, 0, -300, 0}, "VEC3", gl_short);
    attributes["NORMAL"] = made.add({0, 0, 127, 0, 0, -128, 0, -127, 0}, "VEC3", gl_byte, true);
    attributes["TEXCOORD_0"] =
        made.add({0, 65535, 13107, 0, 0, 0}, "VEC2", gl_unsigned_short, true);
    const Scene whole = read(made);
    EXPECT_EQ(position(whole.meshes.at(0), 0, 2), vec3(0, -300, 0));
    EXPECT_EQ(normal(whole.meshes[0], 0, 0), vec3(0, 0, 1));
    EXPECT_EQ(normal(whole.meshes[0], 0, 1), vec3(0, 0, -1));
    EXPECT_EQ(whole.meshes[0].uvs.at(0), dvec2(0, 0));
    EXPECT_EQ(vec2(whole.meshes[0].uvs.at(1)), vec2(0.2f, 1));
    attributes["TEXCOORD_0"] = made.add({-128, -128, 127, 0, -127, 0}, "VEC2", gl_byte, true);
    const Scene with_signs = read(made);
    EXPECT_EQ(with_signs.meshes.at(0).uvs.at(0), dvec2(-1, 2));
    EXPECT_EQ(with_signs.meshes[0].uvs.at(1), dvec2(1, 1));
    EXPECT_EQ(with_signs.meshes[0].uvs.at(2), dvec2(-1, 1));

    GltfBuilder mixed = one_triangle();  // positions and normals in turn
    mixed.add({0, 0, 7, 0, 1, 0, 4, 0, 7, 0, 1, 0, 0, 4, 7, 0, 1, 0}, "VEC3", gl_float);
    mixed.set(R"("/bufferViews/4/byteStride": 24, "/accessors/4/count": 3)");
    mixed.document["accessors"][5] = mixed.document["accessors"][4];
    mixed.set(R"("/accessors/5/byteOffset": 12,
                 "/meshes/0/primitives/0/attributes/POSITION": 4,
                 "/meshes/0/primitives/0/attributes/NORMAL": 5)");
    const Scene scene = read(mixed);
    EXPECT_EQ(position(scene.meshes.at(0), 0, 1), vec3(4, 0, 7));
    EXPECT_EQ(normal(scene.meshes[0], 0, 2), vec3(0, 1, 0));
}

TEST(Gltf, FiguresStandInTheirBindPose) {
    std::mt19937 random(2);
    int compared = 0;
    for (int i = 0; i < 400; ++i) {
        SCOPED_TRACE("seed 2, case " + std::to_string(i));
        const int joint_type = i % 2 ? gl_unsigned_byte : gl_unsigned_short;
        const int weight_type = std::array{gl_float, gl_unsigned_byte,
                                           gl_unsigned_short}[static_cast<std::size_t>(i % 3)];
        const double whole = std::array{1, 255, 65535}[static_cast<std::size_t>(i % 3)];
        const bool has_inverse_binds = i % 5 != 0;
        constexpr std::size_t count = 5;
        // Node 0 has the mesh, and a place that must not matter; then a chain of joints.
        GltfBuilder made = one_triangle();
        made.set(R"("/nodes/0/skin": 0, "/scenes/0/nodes": [0, 1])");
        json& nodes = made.document["nodes"];
        nodes[0]["matrix"] = numbers_of(any_affine(random));
        std::vector<Wide4> world_from_bind;
        std::vector<double> inverse_binds;
        Wide4 world(1);
        for (std::size_t joint = 0; joint < count; ++joint) {
            const Wide4 own = any_affine(random), inverse_bind = any_affine(random);
            world = world * own;
            nodes.push_back({{"matrix", numbers_of(own)}});
            if (joint + 1 < count) nodes.back()["children"] = {joint + 2};
            made.document["skins"][0]["joints"].push_back(joint + 1);
            world_from_bind.push_back(has_inverse_binds ? world * inverse_bind : world);
            for (const double x : numbers_of(inverse_bind)) inverse_binds.push_back(x);
        }
        if (has_inverse_binds)
            made.document["skins"][0]["inverseBindMatrices"] =
                made.add(inverse_binds, "MAT4", gl_float);
        std::array<Wide4, 3> posed{Wide4(0), Wide4(0), Wide4(0)};
        json& attributes = made.primitive()["attributes"];
        for (int set = 0; set < 1 + i / 2 % 2; ++set) {
            std::vector<double> joints, weights;
            for (std::size_t vertex = 0; vertex < 3; ++vertex)
                for (std::size_t k = 0; k < 4; ++k) {
                    const std::size_t joint = random() % count;
                    const double weight = double(random() % 4) * (whole == 1 ? 0.25 : 15);
                    joints.push_back(double(joint)), weights.push_back(weight);
                    posed[vertex] += Wide(weight) / Wide(whole) * world_from_bind[joint];
                }
            const std::string number = std::to_string(set);
            attributes["JOINTS_" + number] = made.add(joints, "VEC4", joint_type);
            attributes["WEIGHTS_" + number] =
                made.add(weights, "VEC4", weight_type, weight_type != gl_float);
        }
        const bool are_of_use = std::ranges::all_of(posed, [](Wide4& matrix) {
            const Wide total = matrix[3][3];  // the weights of a file may have any sum
            if (total > 0) matrix /= total;
            return total > 0 && std::abs(glm::determinant(Wide33(matrix))) > 0.1L;
        });
        if (!are_of_use) continue;
        ++compared;
        const Scene scene = read(made);
        EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.at(0);
        expect_transformed(scene, posed);
    }
    EXPECT_GT(compared, 50);
}

TEST(Gltf, AVertexWithoutWeightsFollowsItsFirstJoint) {
    GltfBuilder made = one_triangle();
    made.set(R"("/nodes": [{"mesh": 0, "skin": 0},
                           {"translation": [0, 0, 5], "scale": [2, 2, 2]},
                           {"translation": [0, 0, 7]}],
                "/scenes/0/nodes": [0, 1, 2], "/skins/0/joints": [1, 2])");
    json& attributes = made.primitive()["attributes"];
    // A joint that does not count may be any.
    attributes["JOINTS_0"] =
        made.add({1, 0, 0, 0, 0, 99, 0, 0, 0, 1, 0, 0}, "VEC4", gl_unsigned_byte);
    attributes["WEIGHTS_0"] = made.add({0, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0}, "VEC4", gl_float);
    const Scene scene = read(made);
    EXPECT_EQ(position(scene.meshes.at(0), 0, 0), vec3(0, 0, 7));
    EXPECT_EQ(position(scene.meshes[0], 0, 1), vec3(2, 0, 5));
    EXPECT_EQ(position(scene.meshes[0], 0, 2), vec3(0, 1.5f, 6));
    ASSERT_EQ(scene.warnings.size(), 1u) << scene.warnings.at(1);
    EXPECT_NE(scene.warnings[0].find("vertices without weights follow their first joint"),
              std::string::npos);
}

TEST(Gltf, CamerasAndLightsMoveWithTheirNodes) {
    GltfBuilder made = one_triangle();
    // The parent turns x to -z and is twice as large; the camera below it looks along its -z.
    made.set(R"("/nodes": [
        {"mesh": 0, "children": [1, 2, 3, 4], "scale": [2, 2, 2],
         "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476]},
        {"camera": 0, "name": "eye", "translation": [1, 2, 3]},
        {"extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"extensions": {"KHR_lights_punctual": {"light": 1}}, "translation": [0, 1, 0]},
        {"extensions": {"KHR_lights_punctual": {"light": 2}}, "name": "point"}],
      "/cameras": [{"type": "perspective", "perspective": {"yfov": 0.75, "znear": 0.5}}],
      "/extensions/KHR_lights_punctual/lights": [
        {"type": "directional", "name": "directional", "color": [1, 0.5, 0.25], "intensity": 4},
        {"type": "spot", "range": 9, "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}},
        {"type": "point"}])");
    const Scene scene = read(made);
    constexpr float tolerance = 1e-6f;  // sqrt(0.5) is rounded, and so is the result
    ASSERT_EQ(scene.cameras.size(), 1u);
    const SceneCamera& camera = scene.cameras[0];
    EXPECT_EQ(camera.name, "eye");
    EXPECT_EQ(camera.fov_y_radians, 0.75f);
    EXPECT_EQ(camera.near, 0.5f);
    EXPECT_TRUE(std::isinf(camera.far));
    const auto expect_near = [&](vec3 a, vec3 b) { EXPECT_LT(glm::distance(a, b), tolerance); };
    expect_near(vec3(camera.world_from_view[3]), vec3(6, 4, -2));
    expect_near(vec3(camera.world_from_view[0]), vec3(0, 0, -1));  // without the parent's scale
    expect_near(vec3(camera.world_from_view[1]), vec3(0, 1, 0));
    expect_near(vec3(camera.world_from_view[2]), vec3(1, 0, 0));

    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].kind, SceneLight::Kind::directional);
    EXPECT_EQ(scene.lights[0].name, "directional");
    EXPECT_EQ(scene.lights[0].color, vec3(4, 2, 1));
    expect_near(scene.lights[0].direction_world, vec3(-1, 0, 0));
    EXPECT_EQ(scene.lights[1].kind, SceneLight::Kind::spot);
    expect_near(scene.lights[1].position_world, vec3(0, 2, 0));
    EXPECT_EQ(scene.lights[1].range, 9);
    EXPECT_FLOAT_EQ(scene.lights[1].cos_inner, std::cos(0.25f));
    EXPECT_FLOAT_EQ(scene.lights[1].cos_outer, std::cos(0.5f));
    EXPECT_EQ(scene.lights[2].kind, SceneLight::Kind::point);
    EXPECT_EQ(scene.lights[2].name, "point");
    EXPECT_EQ(scene.lights[2].color, vec3(1));
    EXPECT_TRUE(std::isinf(scene.lights[2].range));
}
