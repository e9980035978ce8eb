// SPDX-License-Identifier: MIT
// The vertex stage of lesson 12's scenes. tests/benchmarks/beside_opengl_scene.cpp puts #version
// and a material's #defines in front. What a fragment shader does not read, the linker leaves out.

uniform mat4 clip_from_world;
uniform vec2 uv_scale, uv_offset;

layout(location = 0) in vec3 vertex_position;
layout(location = 1) in vec3 vertex_normal;
layout(location = 2) in vec4 vertex_tangent;
layout(location = 3) in vec2 vertex_uv;
layout(location = 4) in vec4 vertex_color;

out vec3 position_world;
out vec3 smooth_normal;
out vec4 tangent;  // w is the handedness
out vec2 uv;
out vec4 tint;

invariant gl_Position;  // the depth-only program's positions are the same bits

void main() {
    position_world = vertex_position;
    smooth_normal = vertex_normal;
    tangent = vertex_tangent;
    uv = vertex_uv * uv_scale + uv_offset;
    tint = vertex_color;
    gl_Position = clip_from_world * vec4(vertex_position, 1.0);
}
