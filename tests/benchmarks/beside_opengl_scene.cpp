// SPDX-License-Identifier: MIT
/// @file
/// A scene as OpenGL draws it. All is uploaded and compiled when it is made; a frame only draws.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include "04_mvp/clip.hpp"
#include "04_mvp/transform.hpp"
#include "06_phong/studio_lights.hpp"
#include "11_scenes/casters.hpp"
#include "benchmarks/beside_opengl.hpp"
#include "common/image/backdrop.hpp"
#include "common/math/color.hpp"

namespace rasterbook {

namespace {

// ---- Programs

std::string shader_file(const std::string& name) {
    const std::filesystem::path file =
        std::filesystem::path(RASTERBOOK_TEST_DATA) / "shaders" / name;
    std::ifstream in(file);
    if (!in) throw std::runtime_error(file.string() + ": cannot be opened");
    return {std::istreambuf_iterator<char>(in), {}};
}

void compile(GLuint program, GLenum kind, const std::string& source) {
    const GLuint shader = glCreateShader(kind);
    const char* const text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    std::string log(1000, '\0');
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    if (!good) throw std::runtime_error("OpenGL does not compile\n" + source + log.c_str());
    glAttachShader(program, shader);
    glDeleteShader(shader);  // when the program goes
}

GLuint program_of(const std::string& defines, const std::string& vertex,
                  const std::string& fragment) {
    const GLuint program = glCreateProgram();
    compile(program, GL_VERTEX_SHADER, "#version 400 core\n" + defines + vertex);
    compile(program, GL_FRAGMENT_SHADER, "#version 400 core\n" + defines + fragment);
    glLinkProgram(program);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (!good) throw std::runtime_error("OpenGL does not link\n" + defines);
    return program;
}

/// Sets the uniforms of a program by their names; names that it does not use are passed over.
class Uniforms {
  public:
    explicit Uniforms(GLuint program) : program_(program) { glUseProgram(program); }

    void set(const std::string& name, int value) { glUniform1i(at(name), value); }
    void set(const std::string& name, float value) { glUniform1f(at(name), value); }
    void set(const std::string& name, vec2 value) { glUniform2fv(at(name), 1, &value[0]); }
    void set(const std::string& name, vec3 value) { glUniform3fv(at(name), 1, &value[0]); }
    void set(const std::string& name, const mat4& value) {
        glUniformMatrix4fv(at(name), 1, GL_FALSE, &value[0][0]);
    }

  private:
    GLint at(const std::string& name) const { return glGetUniformLocation(program_, name.c_str()); }
    GLuint program_;
};

constexpr const char* backdrop_vertices = R"(
void main() {  // one triangle around the whole picture, behind all else
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
})";
constexpr const char* backdrop_fragments = R"(
uniform vec3 first, last;  // row
uniform float height;
out vec4 color;
void main() { color = vec4(mix(first, last, (gl_FragCoord.y - 0.5) / (height - 1.0)), 1.0); }
)";

/// What a material's shaders are compiled with (lessons/13_visibility_buffer/shaded.hpp).
std::string defines_of(const MaterialPlan& plan, bool two_sided, const SceneLights& lit_by,
                       const ShadowMaps& shadows, GlNumbers numbers) {
    std::string defines = plan[Effect::toon]    ? "#define TOON\n"
                          : plan[Effect::light] ? "#define PHONG\n"
                                                : "#define UNLIT\n";
    const auto define_if = [&](bool is_on, const char* name) {
        if (is_on) defines += "#define " + std::string(name) + "\n";
    };
    define_if(plan[Effect::texture], "TEXTURE");
    define_if(plan[Effect::normal_map], "NORMAL_MAP");
    define_if(plan[Effect::highlight], "HIGHLIGHT");
    define_if(plan[Effect::shadow], "SHADOW");
    define_if(two_sided, "TWO_SIDED");
    define_if(numbers == GlNumbers::bytes, "UNORM_NORMALS");
    std::string kinds, maps;
    for (std::size_t l = 0; l < lit_by.lights.size(); ++l) {
        const std::string comma = l == 0 ? "" : ", ";
        kinds += comma + "0";  // directional
        maps += comma + (shadows.of_light[l].maps.empty() ? "false" : "true");
    }
    return defines + "#define LIGHTS " + std::to_string(lit_by.lights.size()) +
           "\n#define LIGHT_KINDS " + kinds + "\n#define LIGHT_HAS_MAP " + maps + "\n";
}

// ---- Textures

/// A texture with the very levels of the course's, bound; it is repeated, which is OpenGL's
/// default.
GLuint upload(const Texture& texture, GLint format) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    for (std::size_t i = 0; i < texture.levels.size(); ++i) {
        const ivec2 size = texture.levels[i].size;
        Image<vec4> rows(size);  // the bottom one first, as v goes
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                vec4& texel = rows[{x, size.y - 1 - y}];
                texel = texture.levels[i].texels[ivec2(x, y) + 1];
                if (format == GL_RGBA32F) continue;
                if (format == GL_RGBA8) texel = 0.5f * texel + 0.5f;  // a normal
                if (format == GL_SRGB8_ALPHA8)                        // OpenGL takes encoded values
                    for (int c = 0; c < 3; ++c) texel[c] = srgb_from_linear(texel[c]);
            }
        glTexImage2D(GL_TEXTURE_2D, static_cast<GLint>(i), format, size.x, size.y, 0, GL_RGBA,
                     GL_FLOAT, rows.pixels().data());
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    return name;
}

/// What OpenGL draws into: a texture of a frame buffer in use, without levels.
GLuint attach(GLenum place, GLint format, GLenum pixel, ivec2 size) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, format, size.x, size.y, 0, pixel, GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glFramebufferTexture(GL_FRAMEBUFFER, place, name, 0);
    return name;
}

// ---- Meshes

struct GlVertex {
    vec3 position_world, normal_world{0};
    vec4 tangent_world{0};
    vec2 uv{0};
};

/// The triangles of one material of a mesh, each vertex once.
struct GlMesh {
    GLuint array = 0;
    GLsizei indices = 0;
    std::size_t material = 0;
    Bounds bounds;  ///< Of the whole mesh.

    void draw() const {
        glBindVertexArray(array);
        glDrawElements(GL_TRIANGLES, indices, GL_UNSIGNED_INT, nullptr);
    }
};

GlVertex vertex_of(const Mesh& mesh, const Vertex& at) {
    GlVertex vertex{mesh.positions[at.position]};
    if (at.normal != no_index) {
        vertex.normal_world = mesh.normals[at.normal];
        if (!mesh.tangents.empty()) vertex.tangent_world = mesh.tangents[at.normal];
    }
    if (at.uv != no_index) vertex.uv = mesh.uvs[at.uv];
    return vertex;
}

/// complete_normals() has given each vertex of each triangle a normal of its own: it is by their
/// numbers that vertices are the same.
using VertexKey =
    std::tuple<std::uint32_t, std::uint32_t, float, float, float, float, float, float, float>;
VertexKey key_of(const Vertex& at, const GlVertex& vertex) {
    const vec3 n = vertex.normal_world;
    const vec4 t = vertex.tangent_world;
    return {at.position, at.uv, n.x, n.y, n.z, t.x, t.y, t.z, t.w};
}

void add_attribute(GLuint index, GLint numbers, std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, numbers, GL_FLOAT, GL_FALSE, sizeof(GlVertex),
                          reinterpret_cast<const void*>(offset));
}

/// Uploads the triangles of one material.
GlMesh upload(const Mesh& mesh, std::size_t material) {
    std::vector<GlVertex> vertices;
    std::vector<std::uint32_t> indices;
    std::map<VertexKey, std::uint32_t> index_of;
    for (const Triangle& triangle : mesh.triangles) {
        if (triangle.material != material) continue;
        for (const Vertex& at : triangle.vertices) {
            const GlVertex vertex = vertex_of(mesh, at);
            const auto [found, is_new] = index_of.try_emplace(
                key_of(at, vertex), static_cast<std::uint32_t>(vertices.size()));
            if (is_new) vertices.push_back(vertex);
            indices.push_back(found->second);
        }
    }
    GlMesh uploaded{0, static_cast<GLsizei>(indices.size()), material, mesh.bounds};
    glGenVertexArrays(1, &uploaded.array);
    glBindVertexArray(uploaded.array);
    std::array<GLuint, 2> both{};
    glGenBuffers(2, both.data());
    glBindBuffer(GL_ARRAY_BUFFER, both[0]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(std::span(vertices).size_bytes()),
                 vertices.data(), GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, both[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(std::span(indices).size_bytes()),
                 indices.data(), GL_STATIC_DRAW);
    add_attribute(0, 3, offsetof(GlVertex, position_world));
    add_attribute(1, 3, offsetof(GlVertex, normal_world));
    add_attribute(2, 4, offsetof(GlVertex, tangent_world));
    add_attribute(3, 2, offsetof(GlVertex, uv));
    return uploaded;
}

}  // namespace

// ---- The scene

/// A material's program; all of its uniforms are set. Textures: diffuse, normals.
struct GlMaterial {
    GLuint program = 0;
    std::array<GLuint, 2> textures{};
    bool two_sided = false, casts = false;
};

struct GlShadowMap {
    GLuint frame = 0, depths = 0;
    mat4 clip_from_world;
    int size;
};

struct GlScene::Content {
    ivec2 size;
    GlOptions options;
    mat4 clip_from_world;  ///< Upside down, as support/opengl.hpp has it.
    std::vector<GlMaterial> materials;
    std::vector<GlMesh> meshes;  ///< Outlines last.
    std::size_t outlines = 0;
    std::vector<GlShadowMap> maps;
    GLuint frame = 0, color = 0, depth = 0, depth_only = 0, backdrop = 0, no_vertices = 0;
    std::map<const Texture*, GLuint> textures;

    /// @param format_of_bytes  Where it does not have floats.
    GLuint texture(const Texture* from, GLint format_of_bytes) {
        if (from == nullptr) return 0;
        GLuint& name = textures[from];
        if (name == 0)
            name =
                upload(*from, options.numbers == GlNumbers::floats ? GL_RGBA32F : format_of_bytes);
        return name;
    }

    void add_materials(const PlannedScene& assets, const Camera& camera, const ShadowMaps& shadows);
    void set_scene(Uniforms& uniforms, const PlannedScene& assets, const Camera& camera,
                   const ShadowMaps& shadows) const;
    void add_meshes(const Scene& scene, std::span<const Mesh> outline_meshes);
    void add_maps(const ShadowMaps& shadows);
    void add_frame(bool is_drawing);
    void draw_map(const GlShadowMap& map) const;
    void draw_picture() const;
};

namespace {

const mat4 upside_down = scaling(vec3(1, -1, 1));

/// The lights' maps as the course fits them, not drawn.
ShadowMaps fitted_maps(const PlannedScene& assets, const ShadowOptions& variant) {
    return draw_shadow_maps(variant, shadow_scene(assets, false), [](ShadowMap&, bool) {});
}

void set_material(Uniforms& uniforms, const Material& material, const MaterialPlan& plan) {
    SurfaceColor color = surface_color(material);
    if (plan[Effect::toon]) {
        color.ambient = material.toon->shade;
        uniforms.set("toon_half_width", 1 - material.toon->toony);
        uniforms.set("toon_shift", material.toon->shift);
    }
    uniforms.set("material.ambient", color.ambient);
    uniforms.set("material.diffuse", color.diffuse);
    uniforms.set("material.specular", color.specular);
    uniforms.set("material.emission", color.emission);
    uniforms.set("shininess", material.shininess);
    uniforms.set("opacity", material.opacity);
    uniforms.set("bump_multiplier", normal_map_of(material).bump_multiplier);
    uniforms.set("uv_scale", vec2(material.diffuse_map.scale));  // its normal map has the same uvs
    uniforms.set("uv_offset", vec2(material.diffuse_map.offset));
    uniforms.set("diffuse_map", 0), uniforms.set("normal_map", 1);
}

}  // namespace

void GlScene::Content::set_scene(Uniforms& uniforms, const PlannedScene& assets,
                                 const Camera& camera, const ShadowMaps& shadows) const {
    uniforms.set("clip_from_world", clip_from_world);
    uniforms.set("eye_world", camera.position_world);
    uniforms.set("ambient_light", ambient_light);
    for (std::size_t l = 0, next_map = 0; l < assets.lit_by.lights.size(); ++l) {
        const std::string of_light = "[" + std::to_string(l) + "]";
        const Light& light = assets.lit_by.lights[l];
        uniforms.set("lights" + of_light + ".color", light.color);
        uniforms.set("lights" + of_light + ".direction_world", light.direction_world);
        if (shadows.of_light[l].maps.empty()) continue;
        const ShadowMap& map = shadows.of_light[l].maps.front();
        uniforms.set("maps" + of_light + ".texels_from_world", map.texels_from_world);
        uniforms.set("maps" + of_light + ".plane_from_world", mat4(map.plane_from_world));
        uniforms.set("maps" + of_light + ".size", static_cast<float>(map.size));
        uniforms.set("maps" + of_light + ".rounding_texels",
                     static_cast<float>(map.rounding_texels));
        uniforms.set("maps" + of_light + ".rounding_depth", static_cast<float>(map.rounding_depth));
        uniforms.set("depths" + of_light, static_cast<int>(2 + next_map++));
    }
}

void GlScene::Content::add_materials(const PlannedScene& assets, const Camera& camera,
                                     const ShadowMaps& shadows) {
    const std::string vertex = shader_file("12_vertex.glsl"),
                      fragment = shader_file("12_fragment.glsl");
    for (std::size_t i = 0; i < assets.scene.materials.size(); ++i) {
        const Material& material = assets.scene.materials[i];
        const MaterialPlan& plan = assets.plan.materials[i];
        GlMaterial& made = materials.emplace_back();
        made.two_sided = assets.passes[i].culling == Culling::none;
        made.program =
            program_of(defines_of(plan, made.two_sided, assets.lit_by, shadows, options.numbers),
                       vertex, fragment);
        Uniforms uniforms(made.program);
        set_scene(uniforms, assets, camera, shadows);
        set_material(uniforms, material, plan);
        made.textures = {texture(assets.textures.diffuse[i].get(), GL_SRGB8_ALPHA8),
                         texture(assets.normal_maps.textures[i].get(), GL_RGBA8)};
        made.casts = casts_shadows(material);
    }
}

void GlScene::Content::add_meshes(const Scene& scene, std::span<const Mesh> outline_meshes) {
    const auto add = [&](const Mesh& mesh) {
        std::vector<bool> is_used(scene.materials.size());
        for (const Triangle& triangle : mesh.triangles) is_used[triangle.material] = true;
        for (std::size_t i = 0; i < is_used.size(); ++i)
            if (is_used[i]) meshes.push_back(upload(mesh, i));
    };
    std::ranges::for_each(scene.meshes, add);
    outlines = meshes.size();
    std::ranges::for_each(outline_meshes, add);
}

void GlScene::Content::add_maps(const ShadowMaps& shadows) {
    for (const LightShadowMaps& of_light : shadows.of_light) {
        for (const ShadowMap& from : of_light.maps) {
            GlShadowMap map{0, 0, upside_down * from.clip_from_world, from.size};
            glGenFramebuffers(1, &map.frame);
            glBindFramebuffer(GL_FRAMEBUFFER, map.frame);
            map.depths = attach(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT,
                                ivec2(map.size + 2 * max_pcf_radius));
            glDrawBuffer(GL_NONE);
            maps.push_back(map);
        }
    }
}

void GlScene::Content::add_frame(bool is_drawing) {
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    color =
        attach(GL_COLOR_ATTACHMENT0,
               options.numbers == GlNumbers::floats ? GL_RGBA32F : GL_SRGB8_ALPHA8, GL_RGBA, size);
    depth = attach(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, size);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error("OpenGL does not draw into such pictures");
    const std::string positions =
        "uniform mat4 clip_from_world;\n"
        "layout(location = 0) in vec3 position;\n"
        "invariant gl_Position;\n"
        "void main() { gl_Position = clip_from_world * "
        "vec4(position, 1.0); }\n";
    depth_only = program_of("", positions, "void main() {}\n");
    backdrop = program_of("", backdrop_vertices, backdrop_fragments);
    glGenVertexArrays(1, &no_vertices);
    Uniforms uniforms(backdrop);
    uniforms.set("first", is_drawing ? paper_color : backdrop_color(0, size.y));
    uniforms.set("last", is_drawing ? paper_color : backdrop_color(size.y - 1, size.y));
    uniforms.set("height", static_cast<float>(size.y));
}

void GlScene::Content::draw_map(const GlShadowMap& map) const {
    glBindFramebuffer(GL_FRAMEBUFFER, map.frame);
    glViewport(max_pcf_radius, max_pcf_radius, map.size, map.size);
    glClear(GL_DEPTH_BUFFER_BIT);
    glDisable(GL_CULL_FACE);
    Uniforms(depth_only).set("clip_from_world", map.clip_from_world);
    for (std::size_t i = 0; i < outlines; ++i)
        if (materials[meshes[i].material].casts) meshes[i].draw();
}

void GlScene::Content::draw_picture() const {
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glViewport(0, 0, size.x, size.y);
    glClear(GL_DEPTH_BUFFER_BIT);  // the backdrop covers what is left of the last picture
    const auto draw_with = [&](auto&& use) {
        for (const GlMesh& mesh : meshes) {
            if (is_outside_frustum(mesh.bounds, clip_from_world)) continue;
            use(materials[mesh.material]);
            (materials[mesh.material].two_sided ? glDisable : glEnable)(GL_CULL_FACE);
            mesh.draw();
        }
    };
    if (options.depth_first) {
        Uniforms(depth_only).set("clip_from_world", clip_from_world);
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        draw_with([](const GlMaterial&) {});
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    }
    glDepthFunc(options.depth_first ? GL_GEQUAL : GL_GREATER);
    for (std::size_t i = 0; i < maps.size(); ++i) {
        glActiveTexture(GL_TEXTURE2 + static_cast<GLenum>(i));
        glBindTexture(GL_TEXTURE_2D, maps[i].depths);
    }
    draw_with([](const GlMaterial& material) {
        glUseProgram(material.program);
        for (std::size_t i = 0; i < material.textures.size(); ++i) {
            glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
            glBindTexture(GL_TEXTURE_2D, material.textures[i]);
        }
    });
    glUseProgram(backdrop);
    glDisable(GL_CULL_FACE);
    glDepthFunc(GL_GEQUAL);
    glBindVertexArray(no_vertices);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthFunc(GL_GREATER);
}

GlScene::GlScene(const PlannedScene& assets, const Camera& camera, const EffectsOptions& options,
                 const GlOptions& gl)
    : content_(std::make_unique<Content>()) {
    content_->size = options.size;
    content_->options = gl;
    content_->clip_from_world = upside_down * camera.clip_from_world(options.size);
    const ShadowMaps shadows = fitted_maps(assets, options.shadow);
    content_->add_materials(assets, camera, shadows);
    std::vector<Mesh> outlines;
    for (const OutlineHull& hull : assets.hulls) outlines.push_back(pushed(hull, camera));
    content_->add_meshes(assets.scene, outlines);
    content_->add_maps(shadows);
    content_->add_frame(assets.is_drawing);
    if (gl.numbers == GlNumbers::bytes) glEnable(GL_FRAMEBUFFER_SRGB);
}

GlScene::~GlScene() = default;

void GlScene::draw() const {
    for (const GlShadowMap& map : content_->maps) content_->draw_map(map);
    content_->draw_picture();
    glFinish();
}

Image<u8vec3> GlScene::picture() const {
    const ivec2 size = content_->size;
    glBindFramebuffer(GL_FRAMEBUFFER, content_->frame);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    Image<u8vec3> encoded(size);
    if (content_->options.numbers == GlNumbers::bytes) {
        glReadPixels(0, 0, size.x, size.y, GL_RGB, GL_UNSIGNED_BYTE, encoded.pixels().data());
    } else {
        Image<vec3> linear(size);
        glReadPixels(0, 0, size.x, size.y, GL_RGB, GL_FLOAT, linear.pixels().data());
        encoded = srgb8_from_linear(linear);
    }
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
        throw std::runtime_error("OpenGL's error " + std::to_string(error));
    return encoded;
}

}  // namespace rasterbook
