// SPDX-License-Identifier: MIT
// Lesson 04's vertex stage, and what lesson 09 interpolates between vertices.
#version 330 core

uniform mat4 clip_from_world;

layout(location = 0) in vec3 vertex_position;
layout(location = 1) in vec3 vertex_normal;
layout(location = 2) in vec4 vertex_tangent;
layout(location = 3) in vec2 vertex_uv;

out vec3 position_world;
out vec3 smooth_normal;
out vec4 tangent;  // w is the handedness
out vec2 uv;

void main() {
    position_world = vertex_position;
    smooth_normal = vertex_normal;
    tangent = vertex_tangent;
    uv = vertex_uv;
    gl_Position = clip_from_world * vec4(vertex_position, 1.0);
}
