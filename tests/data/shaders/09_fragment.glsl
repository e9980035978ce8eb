// SPDX-License-Identifier: MIT
// Lesson 09's fragment stage: what render() in lessons/09_shadow_maps/main.cpp does with a fragment
// that has passed the depth test. Both lights are directional, and the first has a shadow map.
// tests/opengl_shader_test.cpp compares the pictures.
#version 330 core

struct SurfaceColor {
    vec3 ambient, diffuse, specular, emission;  // linear
};
struct Light {
    vec3 color;            // linear
    vec3 direction_world;  // towards the light, length 1
};
struct ReflectedLight {
    vec3 diffuse, specular;
};

uniform SurfaceColor material;
uniform float shininess;
uniform sampler2D diffuse_map, specular_map;  // white where the material names none
uniform sampler2D normal_map;                 // (0.5, 0.5, 1) where it names none

uniform vec3 eye_world;
uniform vec3 ambient_light;
uniform Light lights[2];

// The first light's ShadowMap.
uniform sampler2D depths;
uniform float size;
uniform mat4 texels_from_world;
uniform mat3 plane_from_world;
uniform float rounding_texels, rounding_depth;

const int max_pcf_radius = 3;    // so many texels lie around the map
const float reach_texels = 1.5;  // to the centre of the farthest of 3 x 3 taps
const float snapping = 0.5 / 256.0;
const float depth_quanta = 8.0 / 16777216.0;
const float max_slope = 1.0;
const float full_cosine = 0.1;

in vec3 position_world;
in vec3 smooth_normal;
in vec4 tangent;  // w is the handedness
in vec2 uv;

out vec4 color;

SurfaceColor surface_color() {
    SurfaceColor base_color = material;
    vec3 tint = texture(diffuse_map, uv).rgb;
    base_color.ambient *= tint;
    base_color.diffuse *= tint;
    base_color.specular *= texture(specular_map, uv).rgb;
    return base_color;
}

// A normal from its codes, which OpenGL has made numbers from 0 to 1 (Eq. 8.1).
vec3 normal_from_unorm(vec3 unorm) {
    return 2.0 * unorm - 1.0;
}

vec3 normal_mapped() {
    vec3 n = normalize(smooth_normal);
    vec3 t = normalize(tangent.xyz - dot(tangent.xyz, n) * n);  // Eq. 8.5
    vec3 b = tangent.w * cross(n, t);
    return mat3(t, b, n) * normal_from_unorm(texture(normal_map, uv).xyz);  // Eq. 8.7
}

// The flat triangle's normal, of any length and to any side: neighbouring pixels, too, are points
// of its plane.
vec3 face_normal() {
    return cross(dFdx(position_world), dFdy(position_world));
}

// By the slope, as Bias::slope has it.
float receiver_bias(vec3 face) {
    vec3 outward = dot(face, smooth_normal) < 0.0 ? -face : face;
    vec3 plane = plane_from_world * outward;  // Eq. 9.8
    if (plane.z <= 0.0) return 2.0;           // turned away from the light
    float slope = (abs(plane.x) + abs(plane.y)) / plane.z;
    if (slope > max_slope) return 2.0;
    float bias = (reach_texels + snapping) * slope + depth_quanta;  // Eq. 9.10
    return bias + rounding_texels * slope + rounding_depth;
}

float pcf_visibility(float bias) {
    vec3 place = (texels_from_world * vec4(position_world, 1.0)).xyz;  // Eq. 9.6
    if (any(lessThan(place.xy, vec2(0.0))) || any(greaterThanEqual(place.xy, vec2(size))))
        return 1.0;
    ivec2 texel = ivec2(place.xy) + max_pcf_radius;
    float depth = max(place.z + bias, 0.0);  // Eq. 9.7
    float lit = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
            lit += depth >= texelFetch(depths, texel + ivec2(x, y), 0).r ? 1.0 : 0.0;
    return lit / 9.0;  // Eq. 9.13
}

float light_visibility(vec3 face) {
    float cosine = dot(normalize(smooth_normal), lights[0].direction_world);
    if (cosine <= 0.0) return 0.0;
    float faded = min(cosine / full_cosine, 1.0);  // Eq. 9.16
    return faded * pcf_visibility(receiver_bias(face));
}

void add_light(inout ReflectedLight sum, Light light, vec3 normal, float visibility) {
    float cosine = dot(normal, light.direction_world);
    if (cosine <= 0.0) return;
    vec3 arriving = visibility * light.color;
    sum.diffuse += cosine * arriving;  // Eq. 6.1
    vec3 toward_eye = normalize(eye_world - position_world);
    vec3 mirrored = reflect(-light.direction_world, normal);  // Eq. 6.2
    float highlight = pow(clamp(dot(mirrored, toward_eye), 0.0, 1.0), shininess);  // Eq. 6.3
    sum.specular += highlight * arriving;
}

vec3 phong(SurfaceColor base_color, ReflectedLight light) {  // Eq. 6.5
    return base_color.emission + base_color.ambient * ambient_light +
           base_color.diffuse * light.diffuse + base_color.specular * light.specular;
}

void main() {
    SurfaceColor base_color = surface_color();
    vec3 normal = normalize(normal_mapped());
    vec3 face = face_normal();
    ReflectedLight reflected = ReflectedLight(vec3(0.0), vec3(0.0));
    add_light(reflected, lights[0], normal, light_visibility(face));
    add_light(reflected, lights[1], normal, 1.0);
    color = vec4(phong(base_color, reflected), 1.0);
}
