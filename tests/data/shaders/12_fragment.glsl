// SPDX-License-Identifier: MIT
// The fragment stage of lesson 12's opaque materials: lessons/13_visibility_buffer/shaded.hpp in GLSL.
//
// tests/benchmarks/beside_opengl_scene.cpp puts in front of it #version and a material's #defines:
// UNLIT, PHONG or TOON, and of TEXTURE, SPECULAR_MAP, VERTEX_COLORS, NORMAL_MAP, HIGHLIGHT, SHADOW,
// MASK, TWO_SIDED those effects that the material has. LIGHTS is the number of lights; LIGHT_KINDS
// (0: directional, 1: point, 2: spot) and LIGHT_HAS_MAP are lists of it, so that the compiler
// unrolls all loops and leaves out the other kinds. UNORM_NORMALS: normals are stored as 0 to 1.
//
// No fragment branches by its own numbers. llvmpipe computes both ways of a branch for the
// fragments that it draws together, and with masks: a lit and shadowed picture took half as long
// again.

struct SurfaceColor {
    vec3 ambient, diffuse, specular, emission;  // linear
};
struct Light {
    vec3 color;            // linear
    vec3 direction_world;  // towards a directional light; where a spotlight shines
    vec3 position_world;
    float half_distance, cos_inner, cos_outer;
};
struct ShadowMap {
    mat4 texels_from_world, plane_from_world;
    float size, rounding_texels, rounding_depth;
};
struct Incoming {
    vec3 toward, color;
};
struct LightSum {
    vec3 diffuse, specular;
};

uniform SurfaceColor material;  // for TOON, ambient is the shade
uniform float shininess, opacity, alpha_cutoff, bump_multiplier;
uniform float toon_half_width, toon_shift;
uniform sampler2D diffuse_map, specular_map, normal_map;

uniform vec3 eye_world, ambient_light;
uniform Light lights[LIGHTS];
uniform ShadowMap maps[LIGHTS];
uniform sampler2D depths[LIGHTS];  // with max_pcf_radius texels around each map
const int kinds[LIGHTS] = int[LIGHTS](LIGHT_KINDS);
const bool has_map[LIGHTS] = bool[LIGHTS](LIGHT_HAS_MAP);

const int max_pcf_radius = 3;
const float reach_texels = 1.5;  // to the centre of the farthest of 3 x 3 taps
const float snapping = 0.5 / 256.0;
const float depth_quanta = 8.0 / 16777216.0;
const float max_slope = 1.0;
const float full_cosine = 0.1;
const float min_highlight = 1.0 / 67108864.0;

in vec3 position_world;
in vec3 smooth_normal;
in vec4 tangent;  // w is the handedness
in vec2 uv;
in vec4 tint;

out vec4 color;

float side() {
#ifdef TWO_SIDED
    return gl_FrontFacing ? 1.0 : -1.0;
#else
    return 1.0;
#endif
}

// The material's colors, tinted; discards the holes of a material with an alpha mask.
SurfaceColor surface_color() {
    SurfaceColor own = material;
    vec4 texel = vec4(1.0, 1.0, 1.0, opacity);
#ifdef TEXTURE
    texel *= texture(diffuse_map, uv);
#endif
#ifdef VERTEX_COLORS
    texel *= tint;
#endif
#ifdef MASK
    if (!(texel.a >= alpha_cutoff)) discard;
#endif
    own.ambient *= texel.rgb;
    own.diffuse *= texel.rgb;
#ifdef SPECULAR_MAP
    own.specular *= texture(specular_map, uv).rgb;
#endif
    return own;
}

vec3 shading_normal() {
    vec3 n = normalize(smooth_normal);
#ifdef NORMAL_MAP
    vec3 in_map = texture(normal_map, uv).xyz;
#ifdef UNORM_NORMALS
    in_map = 2.0 * in_map - 1.0;  // Eq. 8.1
#endif
    vec3 t = normalize(tangent.xyz - dot(tangent.xyz, n) * n);  // Eq. 8.5
    vec3 b = tangent.w * cross(n, t);
    in_map.xy *= bump_multiplier;
    n = normalize(mat3(t, b, n) * in_map);  // Eq. 8.7
#endif
    return side() * n;
}

Incoming incoming_light(int l) {
    Light light = lights[l];
    if (kinds[l] == 0) return Incoming(light.direction_world, light.color);
    vec3 to_light = (light.position_world - position_world) / light.half_distance;
    vec3 toward = normalize(to_light);
    float attenuation = 1.0 / (1.0 + dot(to_light, to_light));  // Eq. 6.6
    if (kinds[l] == 2)                                          // Eq. 6.7
        attenuation *= smoothstep(light.cos_outer, light.cos_inner,
                                  -dot(toward, light.direction_world));
    return Incoming(toward, attenuation * light.color);
}

#ifdef SHADOW
// The bias of the flat triangle, of which neighbouring pixels, too, are points: Bias::slope.
float receiver_bias(int l, float inv_w) {
    vec3 face = cross(dFdx(position_world), dFdy(position_world));
    vec3 outward = dot(face, smooth_normal) * side() < 0.0 ? -face : face;
    float offset = kinds[l] == 0 ? 0.0 : -dot(outward, position_world);
    vec3 plane = (maps[l].plane_from_world * vec4(outward, offset)).xyz;  // Eq. 9.8
    float slope = (abs(plane.x) + abs(plane.y)) / plane.z;
    bool is_turned_away = plane.z <= 0.0 || slope > max_slope;  // from the light, or nearly
    float bias = (reach_texels + snapping) * slope + depth_quanta +  // Eq. 9.10
                 (maps[l].rounding_texels * slope + maps[l].rounding_depth) * inv_w;
    return is_turned_away ? 2.0 : bias;
}

float lit_of(vec4 four_taps, float depth) {
    return dot(vec4(greaterThanEqual(vec4(depth), four_taps)), vec4(1.0));
}

// Nine taps by three gathers, which are faster than nine fetches.
float pcf_visibility(int l) {
    vec4 place = maps[l].texels_from_world * vec4(position_world, 1.0);  // Eq. 9.6
    float inv_w = 1.0;
    if (kinds[l] != 0) inv_w = 1.0 / place.w;
    place.xyz *= inv_w;
    ivec2 texel = ivec2(clamp(place.xy, 0.0, maps[l].size - 1.0)) + max_pcf_radius;
    float depth = max(place.z + receiver_bias(l, inv_w), 0.0);  // Eq. 9.7
    vec2 per_texel = 1.0 / vec2(textureSize(depths[l], 0));
    vec2 middle = vec2(texel) * per_texel;  // four texels meet there
    float lit = lit_of(textureGather(depths[l], middle), depth);
    vec4 right = textureGather(depths[l], middle + vec2(2.0, 0.0) * per_texel);
    vec4 below = textureGather(depths[l], middle + vec2(0.0, 2.0) * per_texel);
    lit += lit_of(vec4(right.xw, below.zw), depth);
    lit += depth >= texelFetch(depths[l], texel + 1, 0).r ? 1.0 : 0.0;
    bool is_in_map = all(greaterThanEqual(place.xy, vec2(0.0))) &&
                     all(lessThan(place.xy, vec2(maps[l].size))) && place.w > 0.0;
    return is_in_map ? lit / 9.0 : 1.0;  // Eq. 9.13
}
#endif

float light_visibility(int l, vec3 toward) {
#ifdef SHADOW
    if (has_map[l]) {
        float cosine = dot(side() * normalize(smooth_normal), toward);
        return clamp(cosine / full_cosine, 0.0, 1.0) * pcf_visibility(l);  // Eq. 9.16
    }
#endif
    return 1.0;
}

vec3 phong(SurfaceColor own) {
    vec3 normal = shading_normal();
    vec3 toward_eye = normalize(eye_world - position_world);
    LightSum sum = LightSum(vec3(0.0), vec3(0.0));
    for (int l = 0; l < LIGHTS; ++l) {
        Incoming light = incoming_light(l);
        float cosine = dot(normal, light.toward);
        float is_lit = cosine > 0.0 ? 1.0 : 0.0;
        vec3 arriving = is_lit * light_visibility(l, light.toward) * light.color;
        sum.diffuse += cosine * arriving;  // Eq. 6.1
#ifdef HIGHLIGHT
        float mirrored = dot(reflect(-light.toward, normal), toward_eye);   // Eq. 6.2
        float highlight = pow(clamp(mirrored, 0.0, 1.0), shininess);        // Eq. 6.3
        sum.specular += (highlight < min_highlight ? 0.0 : highlight) * arriving;
#endif
    }
    return own.emission + own.ambient * ambient_light + own.diffuse * sum.diffuse +
           own.specular * sum.specular;  // Eq. 6.5
}

float toon_step(float cosine) {  // Eq. 7.15
    float turned = cosine + toon_shift;
    if (toon_half_width <= 0.0) return turned >= 0.0 ? 1.0 : 0.0;
    return clamp((turned + toon_half_width) / (2.0 * toon_half_width), 0.0, 1.0);
}

vec3 toon(SurfaceColor own) {
    vec3 normal = shading_normal();
    float sum = 0.0, brightest = 0.0;
    for (int l = 0; l < LIGHTS; ++l) {
        Incoming light = incoming_light(l);
        float arriving = max(light.color.r, max(light.color.g, light.color.b));
        brightest = max(brightest, arriving);
        float level = arriving * toon_step(dot(normal, light.toward));
        sum += light_visibility(l, light.toward) >= 0.5 ? level : 0.0;
    }
    float level = brightest > 0.0 ? min(sum / brightest, 1.0) : 0.0;  // Eq. 7.16
    return own.emission + mix(own.ambient, own.diffuse, level);
}

void main() {
    SurfaceColor own = surface_color();
#if defined(PHONG)
    color = vec4(phong(own), 1.0);
#elif defined(TOON)
    color = vec4(toon(own), 1.0);
#else
    color = vec4(own.emission + own.diffuse, 1.0);
#endif
}
