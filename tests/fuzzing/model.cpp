// SPDX-License-Identifier: MIT
// Random bytes as a model's file, or a material library: it is read, and then all indices and
// numbers are as drawing takes them for granted; or it is refused by an InputError.
//
// What follows the first zero byte is a second file, of the name 201: a library for OBJ, a buffer
// for glTF. A picture has the name 202. All are files in memory.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/image/png.hpp"
#include "common/model/gltf.hpp"
#include "common/model/mtl.hpp"
#include "common/model/obj.hpp"

using namespace rasterbook;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

constexpr std::string_view target = TARGET;

/// A file in memory, whose name is its number: /proc/self/fd/NUMBER.
class MemoryFile {
  public:
    explicit MemoryFile(int number) : number_(number) {
        const int descriptor = memfd_create("fuzz", 0);
        if (descriptor < 0 || dup2(descriptor, number) < 0) std::abort();
        close(descriptor);
    }
    std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(number_); }
    void write(std::string_view bytes) const {
        if (ftruncate(number_, static_cast<off_t>(bytes.size())) != 0 ||
            pwrite(number_, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
            std::abort();
    }

  private:
    int number_;
};

void expect(bool is_true) {
    if (!is_true) std::abort();
}

template <typename Vector>
bool are_finite(const std::vector<Vector>& vectors) {
    return std::ranges::all_of(vectors, [](const Vector& v) {
        for (int i = 0; i < Vector::length(); ++i)
            if (!std::isfinite(v[i])) return false;
        return true;
    });
}

void check(const Scene& scene) {
    for (const Mesh& mesh : scene.meshes) {
        expect(are_finite(mesh.positions) && are_finite(mesh.uvs) && are_finite(mesh.normals));
        expect(mesh.colors.empty() || mesh.colors.size() == mesh.positions.size());
        for (const vec4 color : mesh.colors) expect(glm::clamp(color, 0.0f, 1.0f) == color);
        expect(!mesh.triangles.empty());
        for (const Face& face : mesh.faces)
            expect(face.vertex_count >= 3 && face.material < scene.materials.size() &&
                   face.first_vertex + face.vertex_count <= mesh.vertices.size());
        for (const Triangle& triangle : mesh.triangles) {
            expect(triangle.material < scene.materials.size());
            for (const Vertex& vertex : triangle.vertices)
                expect(vertex.position < mesh.positions.size() &&
                       (vertex.uv == no_index || vertex.uv < mesh.uvs.size()) &&
                       (vertex.normal == no_index || vertex.normal < mesh.normals.size()));
        }
    }
    for (const Material& material : scene.materials) {
        for (const vec3 color :
             {material.ambient, material.diffuse, material.specular, material.emission})
            expect(glm::clamp(color, -max_color, max_color) == color);
        expect(material.shininess >= 0 && std::isfinite(material.shininess));
        expect(material.opacity >= 0 && material.opacity <= 1);
    }
    for (const SceneCamera& camera : scene.cameras) {
        expect(camera.near > 0 && camera.far > camera.near && camera.fov_y_radians > 0);
        for (int i = 0; i < 4; ++i) expect(are_finite(std::vector{camera.world_from_view[i]}));
    }
    for (const SceneLight& light : scene.lights) {
        expect(are_finite(std::vector{light.color, light.position_world, light.direction_world}));
        expect(light.cos_outer < light.cos_inner);
    }
}

/// Mutates one of a .glb file's first two chunks, and makes all lengths right again.
std::size_t mutate_chunk(std::uint8_t* data, std::size_t size, std::size_t max_size,
                         unsigned seed) {
    constexpr std::size_t header = 12, chunk_header = 8;
    const auto number_at = [&](std::size_t at) {
        std::uint32_t number;
        std::memcpy(&number, data + at, 4);
        return std::size_t{number};
    };
    const auto set_number = [&](std::size_t at, std::size_t number) {
        const auto narrow = static_cast<std::uint32_t>(number);
        std::memcpy(data + at, &narrow, 4);
    };
    std::size_t at = header;
    if (size < at + chunk_header || number_at(at) > size - at - chunk_header) return 0;
    const std::size_t next = at + chunk_header + number_at(at);
    if (seed % 2 == 0 && next + chunk_header < size) at = next;
    const std::size_t begin = at + chunk_header;
    const std::size_t end = at == next ? size : next, rest = size - end;
    std::vector<std::uint8_t> chunk(data + begin, data + end);
    const std::size_t most = std::min(max_size - begin - rest, chunk.size() + 64);
    chunk.resize(std::max(most, chunk.size()));
    const std::size_t length = LLVMFuzzerMutate(chunk.data(), end - begin, most);
    std::memmove(data + begin + length, data + end, rest);
    std::copy_n(chunk.begin(), length, data + begin);
    set_number(at, length);
    set_number(8, begin + length + rest);
    return begin + length + rest;
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
    if (target == "glb" && seed % 8 != 0 && size < max_size)
        if (const std::size_t mutated = mutate_chunk(data, size, max_size, seed / 8); mutated > 0)
            return mutated;
    return LLVMFuzzerMutate(data, size, max_size);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const MemoryFile model(200), second(201), picture(202);
    static const LoadBudget budget = [] {
        const Bytes png = encode_png(Image<u8vec3>({2, 2}, {10, 200, 90}), "picture");
        picture.write({reinterpret_cast<const char*>(png.data()), png.size()});
        LoadBudget tight;
        tight.set(Resource::bytes, 100'000);
        tight.set(Resource::pixels, 10'000);
        tight.set(Resource::vertices, 10'000);
        for (const Resource resource :
             {Resource::primitives, Resource::objects, Resource::materials})
            tight.set(resource, 1'000);
        return tight;
    }();
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const bool has_second = target == "obj" || target == "gltf";
    const std::size_t end = has_second ? std::min(text.find('\0'), size) : size;
    model.write(text.substr(0, end));
    if (has_second) second.write(text.substr(std::min(end + 1, size)));
    try {
        if (target == "mtl") {
            LoadBudget left = budget;
            Warnings warnings;
            MaterialReader reader(left, warnings);
            reader.read(model.path());
            check({.meshes = {}, .materials = reader.take(), .warnings = warnings.take()});
        } else {
            check(target == "obj" ? load_obj(model.path(), budget)
                                  : load_gltf(model.path(), budget));
        }
    } catch (const InputError&) {}
    return 0;
}
