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

GLuint link(const std::string& statements) {
    const GLuint program = glCreateProgram();
    compile(program, GL_VERTEX_SHADER, vertex_shader);
    compile(program, GL_FRAGMENT_SHADER, fragment_shader + statements + " }\n");
    glLinkProgram(program);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (!good) throw std::runtime_error("OpenGL does not link\n" + statements);
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
std::vector<T> read_back(GLuint texture, GLenum pixel, ivec2 size, int layers) {
    std::vector<T> pixels(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                          static_cast<std::size_t>(layers));
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
    glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, pixel, GL_FLOAT, pixels.data());
    return pixels;
}

template <typename T>
Image<T> layer_of(const std::vector<T>& pixels, ivec2 size, int layer) {
    Image<T> image(size, T(0));
    const auto count = static_cast<std::ptrdiff_t>(image.pixels().size());
    std::copy_n(pixels.begin() + layer * count, count, image.pixels().begin());
    return image;
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
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    for (std::size_t i = 0; i < texture.levels.size(); ++i) {
        const ivec2 size = texture.levels[i].size;
        Image<vec4> bottom_first(size);  // as v goes
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                bottom_first[{x, size.y - 1 - y}] = texture.levels[i].texels[ivec2(x, y) + 1];
        glTexImage2D(GL_TEXTURE_2D, static_cast<GLint>(i), GL_RGBA32F, size.x, size.y, 0, GL_RGBA,
                     GL_FLOAT, bottom_first.pixels().data());
    }
    const GLint wrap = texture.wrap == Wrap::repeat   ? GL_REPEAT
                       : texture.wrap == Wrap::mirror ? GL_MIRRORED_REPEAT
                                                      : GL_CLAMP_TO_EDGE;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
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

    GLuint vertex_array = 0, buffer = 0, frame = 0;
    glGenVertexArrays(1, &vertex_array);
    glBindVertexArray(vertex_array);
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)),
                 vertices.data(), GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
    glEnableVertexAttribArray(1);
    glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                          reinterpret_cast<const void*>(offsetof(Vertex, uv)));

    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    const GLuint color = attach(GL_COLOR_ATTACHMENT0, GL_RGBA32F, GL_RGBA, view.size, layers);
    const GLuint depth =
        attach(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, view.size, layers);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error("OpenGL does not draw into pictures of floats");
    glViewport(view.viewport_low.x, view.viewport_low.y, view.viewport_size.x,
               view.viewport_size.y);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);

    const GLuint program = link(shader);
    glUseProgram(program);
    glUniform1i(glGetUniformLocation(program, "each_its_own"), each_its_own);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));

    std::vector<OpenGlPicture> pictures;
    const auto colors = read_back<vec4>(color, GL_RGBA, view.size, layers);
    const auto depths = read_back<float>(depth, GL_DEPTH_COMPONENT, view.size, layers);
    for (int i = 0; i < layers; ++i)
        pictures.push_back({layer_of(colors, view.size, i), layer_of(depths, view.size, i)});
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
        throw std::runtime_error("OpenGL's error " + std::to_string(error));

    glDeleteProgram(program);
    glDeleteTextures(1, &color);
    glDeleteTextures(1, &depth);
    glDeleteFramebuffers(1, &frame);
    glDeleteBuffers(1, &buffer);
    glDeleteVertexArrays(1, &vertex_array);
    return pictures;
}

}  // namespace rasterbook::test
