// SPDX-License-Identifier: MIT
#include "support/opengl.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>

namespace rasterbook::test {

namespace {

// Each triangle's layer is drawn at the same place: were they side by side in one large picture,
// the positions of most would be rounded to fewer bits.
constexpr const char* vertex_shader = R"(#version 330 core
#extension GL_AMD_vertex_shader_layer : require
layout(location = 0) in vec4 position_clip;
layout(location = 1) in vec2 vertex_uv;
uniform bool each_its_own;
out vec2 uv;
void main() {
    uv = vertex_uv;
    gl_Position = vec4(position_clip.x, -position_clip.y, position_clip.zw);
    gl_Layer = each_its_own ? gl_VertexID / 3 : 0;
}
)";

// level() is not left to texture(): that takes differences between neighbours for derivatives,
// which are far off where uv bends, and llvmpipe takes the logarithm only roughly; colours come out
// up to 8 of 255 levels away. Here the differences are taken of u/w, v/w and 1/w, which are linear
// on the screen, so that they are derivatives. (gl_FragCoord.w is 1/w.)
constexpr const char* fragment_shader = R"(#version 330 core
uniform sampler2D levels;
in vec2 uv;
out vec4 color;
float level() {
    float inverse_w = gl_FragCoord.w;
    vec2 texels = vec2(textureSize(levels, 0)) / inverse_w;
    vec2 across = texels * (dFdx(uv * inverse_w) - uv * dFdx(inverse_w));
    vec2 down = texels * (dFdy(uv * inverse_w) - uv * dFdy(inverse_w));
    return max(0.0, log2(max(length(across), length(down))));
}
void main() { )";

void check(bool good, const std::string& what) {
    if (!good)
        throw std::runtime_error(what +
                                 " (Debian's packages: libegl-dev libopengl-dev "
                                 "libgl1-mesa-dri)");
}

void compile(GLuint program, GLenum kind, const std::string& source) {
    const GLuint shader = glCreateShader(kind);
    const char* text = source.c_str();
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

GLuint link(const OpenGlShaders& shaders) {
    const GLuint program = glCreateProgram();
    compile(program, GL_VERTEX_SHADER, shaders.vertex);
    compile(program, GL_FRAGMENT_SHADER, shaders.fragment);
    glLinkProgram(program);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (!good) throw std::runtime_error("OpenGL does not link\n" + shaders.fragment);
    return program;
}

/// A stack of pictures, bound to the frame buffer.
GLuint attach(GLenum place, GLenum format, GLenum pixel, ivec2 size, int layers) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, static_cast<GLint>(format), size.x, size.y, layers, 0,
                 pixel, GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glFramebufferTexture(GL_FRAMEBUFFER, place, texture, 0);
    return texture;
}

template <typename T>
std::vector<Image<T>> read_back(GLuint texture, GLenum pixel, ivec2 size, int layers) {
    Image<T> all({size.x, size.y * layers}, T(0));
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
    glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, pixel, GL_FLOAT, all.pixels().data());
    std::vector<Image<T>> images;
    for (auto from = all.pixels().begin(); from != all.pixels().end(); from += size.x * size.y)
        std::copy_n(from, size.x * size.y, images.emplace_back(size, T(0)).pixels().begin());
    return images;
}

/// Pictures of floats that OpenGL draws into, cleared.
class Frame {
  public:
    Frame(const OpenGlView& view, int layers) : size_(view.size), layers_(layers) {
        glGenFramebuffers(1, &frame_);
        glBindFramebuffer(GL_FRAMEBUFFER, frame_);
        color_ = attach(GL_COLOR_ATTACHMENT0, GL_RGBA32F, GL_RGBA, size_, layers);
        depth_ =
            attach(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, size_, layers);
        if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
            throw std::runtime_error("OpenGL does not draw into pictures of floats");
        glViewport(view.viewport_low.x, view.viewport_low.y, view.viewport_size.x,
                   view.viewport_size.y);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    }
    ~Frame() {
        glDeleteTextures(1, &color_);
        glDeleteTextures(1, &depth_);
        glDeleteFramebuffers(1, &frame_);
    }
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;

    std::vector<OpenGlPicture> pictures() const {
        std::vector<OpenGlPicture> pictures;
        const auto colors = read_back<vec4>(color_, GL_RGBA, size_, layers_);
        const auto depths = read_back<float>(depth_, GL_DEPTH_COMPONENT, size_, layers_);
        for (std::size_t i = 0; i < colors.size(); ++i) pictures.push_back({colors[i], depths[i]});
        if (const GLenum error = glGetError(); error != GL_NO_ERROR)
            throw std::runtime_error("OpenGL's error " + std::to_string(error));
        return pictures;
    }

  private:
    ivec2 size_;
    int layers_;
    GLuint frame_ = 0, color_ = 0, depth_ = 0;
};

/// A vertex buffer, bound, and what its vertices consist of.
template <typename Vertex>
class VertexBuffer {
  public:
    explicit VertexBuffer(std::span<const Vertex> vertices) {
        glGenVertexArrays(1, &array_);
        glBindVertexArray(array_);
        glGenBuffers(1, &buffer_);
        glBindBuffer(GL_ARRAY_BUFFER, buffer_);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size_bytes()),
                     vertices.data(), GL_STATIC_DRAW);
    }
    ~VertexBuffer() {
        glDeleteBuffers(1, &buffer_);
        glDeleteVertexArrays(1, &array_);
    }
    VertexBuffer(const VertexBuffer&) = delete;
    VertexBuffer& operator=(const VertexBuffer&) = delete;

    void add_attribute(GLuint index, GLint numbers, std::size_t offset) {
        glEnableVertexAttribArray(index);
        glVertexAttribPointer(index, numbers, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                              reinterpret_cast<const void*>(offset));
    }

  private:
    GLuint array_ = 0, buffer_ = 0;
};

/// A texture, bound; the caller deletes it.
///
/// @param levels  So many of them, the first ones.
GLuint upload(const Texture& texture, std::size_t levels, GLint min_filter) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    for (std::size_t i = 0; i < levels; ++i) {
        const ivec2 size = texture.levels[i].size;
        Image<vec4> bottom_first(size);  // as v goes
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                bottom_first[{x, size.y - 1 - y}] = texture.levels[i].texels[ivec2(x, y) + 1];
        glTexImage2D(GL_TEXTURE_2D, static_cast<GLint>(i), GL_RGBA32F, size.x, size.y, 0, GL_RGBA,
                     GL_FLOAT, bottom_first.pixels().data());
    }
    const auto gl_wrap = [](Wrap wrap) {
        return wrap == Wrap::repeat   ? GL_REPEAT
               : wrap == Wrap::mirror ? GL_MIRRORED_REPEAT
                                      : GL_CLAMP_TO_EDGE;
    };
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, gl_wrap(texture.wrap.u));
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, gl_wrap(texture.wrap.v));
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, min_filter);
    return name;
}

GLuint upload(const Image<float>& numbers) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, numbers.size().x, numbers.size().y, 0, GL_RED, GL_FLOAT,
                 numbers.pixels().data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    return name;
}

void set_uniform(GLint place, float value) { glUniform1f(place, value); }
void set_uniform(GLint place, const vec3& value) { glUniform3fv(place, 1, &value[0]); }
void set_uniform(GLint place, const mat3& value) {
    glUniformMatrix3fv(place, 1, GL_FALSE, &value[0][0]);
}
void set_uniform(GLint place, const mat4& value) {
    glUniformMatrix4fv(place, 1, GL_FALSE, &value[0][0]);
}

/// Gives a program in use its inputs.
///
/// @param textures  Takes those that are bound, the first to unit 0; the caller deletes them.
void set_inputs(GLuint program, const OpenGlInputs& inputs, std::vector<GLuint>& textures) {
    for (const auto& [name, value] : inputs.uniforms)
        std::visit(
            [&](const auto& number) {
                set_uniform(glGetUniformLocation(program, name.c_str()), number);
            },
            value);
    for (const auto& [name, picture] : inputs.textures) {
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(textures.size()));
        glUniform1i(glGetUniformLocation(program, name.c_str()),
                    static_cast<GLint>(textures.size()));
        const auto* const texture = std::get_if<const Texture*>(&picture);
        textures.push_back(texture ? upload(**texture, 1, GL_LINEAR)
                                   : upload(*std::get<const Image<float>*>(picture)));
    }
    glActiveTexture(GL_TEXTURE0);
}

}  // namespace

OpenGl::OpenGl() {
    // The software driver also where there is a graphics card: the rules of cards differ.
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);  // it would lie in the home directory
    display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    check(display_ != EGL_NO_DISPLAY && eglInitialize(display_, nullptr, nullptr),
          "There is no EGL without a display here");
    eglBindAPI(EGL_OPENGL_API);
    constexpr EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3,
                                     EGL_NONE};
    context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    check(context_ != EGL_NO_CONTEXT &&
              eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_),
          "There is no OpenGL 3.3 here");
    const std::string driver = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    check(driver.starts_with("llvmpipe"), "OpenGL's driver is not llvmpipe but " + driver);
    glEnable(GL_DEPTH_TEST);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);  // as docs/conventions.md has it, C4 and C5
    glDepthFunc(GL_GREATER);
    glClearDepth(0);
    glEnable(GL_CULL_FACE);
    glFrontFace(GL_CW);
}

// The display stays: eglTerminate would unload the driver, and what the driver keeps until the end
// of the program would then be a leak to AddressSanitizer.
OpenGl::~OpenGl() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
}

void OpenGl::set_texture(const Texture& texture) {
    glDeleteTextures(1, &texture_);
    texture_ = upload(texture, texture.levels.size(), GL_LINEAR_MIPMAP_LINEAR);
}

OpenGlPicture OpenGl::draw(std::span<const OpenGlTriangle> triangles, const OpenGlView& view,
                           const std::string& shader) {
    return draw_layers(triangles, view, shader, false).front();
}

std::vector<OpenGlPicture> OpenGl::draw_each(std::span<const OpenGlTriangle> triangles,
                                             const OpenGlView& view, const std::string& shader) {
    constexpr std::size_t most_layers = 512;  // OpenGL promises no more than 256, llvmpipe 2048
    std::vector<OpenGlPicture> pictures;
    for (std::size_t i = 0; i < triangles.size(); i += most_layers) {
        const auto some = triangles.subspan(i, std::min(most_layers, triangles.size() - i));
        for (OpenGlPicture& picture : draw_layers(some, view, shader, true))
            pictures.push_back(std::move(picture));
    }
    return pictures;
}

std::vector<OpenGlPicture> OpenGl::draw_layers(std::span<const OpenGlTriangle> triangles,
                                               const OpenGlView& view, const std::string& shader,
                                               bool each_its_own) {
    const int layers = each_its_own ? static_cast<int>(triangles.size()) : 1;
    struct Vertex {
        vec4 position_clip;
        vec2 uv;
    };
    std::vector<Vertex> vertices;
    for (const OpenGlTriangle& triangle : triangles)
        for (std::size_t i = 0; i < 3; ++i)
            vertices.push_back({triangle.vertices_clip[i], triangle.uv[i]});

    VertexBuffer<Vertex> buffer(vertices);
    buffer.add_attribute(0, 4, offsetof(Vertex, position_clip));
    buffer.add_attribute(1, 2, offsetof(Vertex, uv));
    const Frame frame(view, layers);
    const GLuint program = link({vertex_shader, fragment_shader + shader + " }\n"});
    glUseProgram(program);
    glUniform1i(glGetUniformLocation(program, "each_its_own"), each_its_own);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));
    glDeleteProgram(program);  // when another one is used
    return frame.pictures();
}

OpenGlPicture OpenGl::draw(std::span<const OpenGlPart> parts, ivec2 size,
                           const OpenGlShaders& shaders, const OpenGlInputs& inputs) {
    const Frame frame{OpenGlView(size), 1};
    const GLuint program = link(shaders);
    glUseProgram(program);
    std::vector<GLuint> textures;
    set_inputs(program, inputs, textures);
    const std::size_t of_all = textures.size();
    for (const OpenGlPart& part : parts) {
        VertexBuffer<OpenGlVertex> buffer(part.vertices);
        buffer.add_attribute(0, 3, offsetof(OpenGlVertex, position_world));
        buffer.add_attribute(1, 3, offsetof(OpenGlVertex, normal_world));
        buffer.add_attribute(2, 4, offsetof(OpenGlVertex, tangent_world));
        buffer.add_attribute(3, 2, offsetof(OpenGlVertex, uv));
        set_inputs(program, part.inputs, textures);
        glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(part.vertices.size()));
        glDeleteTextures(static_cast<GLsizei>(textures.size() - of_all), textures.data() + of_all);
        textures.resize(of_all);
    }
    glDeleteTextures(static_cast<GLsizei>(textures.size()), textures.data());
    glDeleteProgram(program);
    return frame.pictures().front();
}

}  // namespace rasterbook::test
