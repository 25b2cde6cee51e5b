// The model as path tracing sees it after the first hit: triangles in buffers, one struct per material, and base color,
// metallic-roughness and emission as small layers of one array texture.
//
// Materials are metallic-roughness there, with the index of refraction and KHR_materials_specular's factors. Left out:
// normal textures, specular and all other extension textures, clear coat, sheen, anisotropy, iridescence, volume; textures
// repeat and have no mip levels. A transmissive surface lets a fraction of the rays straight through, without its tint.
//
// user_surface changes these surfaces as it changes the first one. Here it runs in a loop that neighboring pixels leave at other
// times, so they share no derivatives: in the copies of functions that hooked_surface calls, Specula makes texture() read level 0
// and dFdx, dFdy and fwidth 0.
#ifndef PATHS_SCENE_GLSL
#define PATHS_SCENE_GLSL

#include "interface.glsl"
#include "brdf/energy/multiscatter.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "material/user_surface.glsl"

layout(set = SET_FRAME, binding = BINDING_TRACED_TRIANGLES, scalar) readonly buffer TracedTriangles {
    TracedTriangle traced_triangles[];
};
layout(set = SET_FRAME, binding = BINDING_TRACED_CORNERS, scalar) readonly buffer TracedCornersOfAll {
    TracedCorners traced_corners[];
};
layout(set = SET_FRAME, binding = BINDING_TRACED_MATERIALS, scalar) readonly buffer TracedMaterials {
    TracedMaterial traced_materials[];
};
layout(set = SET_FRAME, binding = BINDING_TRACED_TEXTURES) uniform sampler2DArray traced_textures;

// A ray. Partly covered surfaces stop or let pass by chance, which `seed` decides.
struct Ray {
    vec3 origin_ws;
    vec3 direction_ws;         // unit
    uint seed;
};

// The place where a ray hits a triangle: corner + u edge_1 + v edge_2.
struct Hit {
    float distance;            // meters
    uint triangle;
    vec2 uv;
};

// The material at a hit, and the interpolated attributes that its textures are read with.
struct HitMaterial {
    TracedMaterial m;
    vec2 uv;
    vec4 color;                // COLOR_0
};

HitMaterial hit_material(Hit hit) {
    TracedCorners c = traced_corners[hit.triangle];
    vec3 weights = vec3(1.0 - hit.uv.x - hit.uv.y, hit.uv);
    vec2 uv = c.uv_0 * weights.x + c.uv_1 * weights.y + c.uv_2 * weights.z;
    mat3x4 colors = mat3x4(unpackUnorm4x8(c.colors.x), unpackUnorm4x8(c.colors.y), unpackUnorm4x8(c.colors.z));
    return HitMaterial(traced_materials[c.material], uv, colors * weights);
}

// Texture `which` (0 base color, 1 metallic-roughness, 2 emissive), linear; white where there is none.
vec4 hit_texture(HitMaterial hit, uint which) {
    if (hit.m.layers[which] == NO_TEXTURE) return vec4(1.0);
    vec2 uv = hit.m.uv_from_texture[which] * vec3(hit.uv, 1.0);
    return textureLod(traced_textures, vec3(uv, float(hit.m.layers[which])), 0.0);
}

vec4 hit_base_color(HitMaterial hit) { return hit_texture(hit, 0u) * hit.m.base_color_factor * hit.color; }

// An octahedron unfolded to a square (Meyer et al. 2010): the lower half is folded back.
vec3 octahedral_normal(uint packed) {
    vec2 xy = unpackSnorm2x16(packed);
    float z = 1.0 - abs(xy.x) - abs(xy.y);
    float fold = max(-z, 0.0);
    return vec3(xy.x + (xy.x >= 0.0 ? -fold : fold), xy.y + (xy.y >= 0.0 ? -fold : fold), z);
}

// The interpolated normal, unit, on the side of facet_n. Where it faces away from v, the facet's normal replaces it.
vec3 hit_normal(Hit hit, vec3 facet_n, vec3 v) {
    uvec3 packed = traced_corners[hit.triangle].normals_ws;
    vec3 n = normalize(octahedral_normal(packed.x)) * (1.0 - hit.uv.x - hit.uv.y);
    n += normalize(octahedral_normal(packed.y)) * hit.uv.x + normalize(octahedral_normal(packed.z)) * hit.uv.y;
    n = safe_normalize(n, facet_n);
    if (dot(n, facet_n) < 0.0) n = -n;
    return dot(n, v) > 0.0 ? n : facet_n;
}

// Normal of the triangle, unit, on the side of v.
vec3 hit_facet_normal(Hit hit, vec3 v) {
    TracedTriangle t = traced_triangles[hit.triangle];
    vec3 n = safe_normalize(cross(t.edge_1_ws, t.edge_2_ws), v);
    return dot(n, v) < 0.0 ? -n : n;
}

// Neutral extensions. FEATURES is that of the first hit's material, so evaluate_brdf may still read these.
void clear_traced_extensions(inout Surface s) {
    clear_extensions(s);
    mat3 basis = basis_around(s.n);
    s.t = basis[0];
    s.b = basis[1];
    complex_ior(s.base_color, EDGE_TINT, s.conductor_n, s.conductor_k);
}

// The direction in which the texture coordinates' u grows along the triangle, unit, world space, and the sign of the bitangent: as
// Fragment has it, but constant over a triangle. 0 where the coordinates span no area.
vec4 hit_tangent(Hit hit) {
    TracedTriangle t = traced_triangles[hit.triangle];
    TracedCorners c = traced_corners[hit.triangle];
    vec2 uv_1 = c.uv_1 - c.uv_0;
    vec2 uv_2 = c.uv_2 - c.uv_0;
    float area = uv_1.x * uv_2.y - uv_1.y * uv_2.x;
    float side = area < 0.0 ? -1.0 : 1.0;
    return vec4(safe_normalize((t.edge_1_ws * uv_2.y - t.edge_2_ws * uv_1.y) * side, vec3(0.0)), -side);
}

// The fragment at a hit, for user_surface: its interpolated vertex attributes. The paths keep one set of texture coordinates: that of the material's textures.
Fragment hit_fragment(Ray ray, Hit hit, HitMaterial h, vec3 n) {
    Fragment f;
    f.position_ws = ray.origin_ws + ray.direction_ws * hit.distance;
    f.to_eye_ws = -ray.direction_ws * hit.distance;
    f.normal_ws = n;
    f.tangent_ws = hit_tangent(hit);
    f.uv0 = f.uv1 = h.uv;
    f.color = h.color;
    return f;
}

// The surface at a hit of `ray` with what its textures say, as user_surface leaves it.
Surface hooked_surface(Ray ray, Hit hit, HitMaterial h, vec3 facet_n) {
    vec4 metallic_roughness = hit_texture(h, 1u);
    vec4 base_color = hit_base_color(h);
    bool is_unlit = h.m.unlit != 0u;
    vec3 v = -ray.direction_ws;

    Surface s;
    s.position_ws = ray.origin_ws + ray.direction_ws * hit.distance;
    s.n = s.ng = hit_normal(hit, facet_n, v);
    // An unlit surface emits its color and reflects nothing.
    s.base_color = is_unlit ? vec3(0.0) : base_color.rgb;
    s.coverage = h.m.alpha_mode == ALPHA_OPAQUE ? 1.0 : base_color.a;
    s.metallic = saturate(metallic_roughness.b * h.m.metallic_factor);
    s.roughness = saturate(metallic_roughness.g * h.m.roughness_factor);
    s.occlusion = 1.0;
    s.emissive = is_unlit ? base_color.rgb : hit_texture(h, 2u).rgb * h.m.emissive_factor;
    s.ior = h.m.ior;
    s.f0 = is_unlit ? vec3(0.0) : h.m.f0;
    s.f90 = is_unlit ? 0.0 : h.m.f90;
    s.multiple = vec3(0.0);
    clear_traced_extensions(s);
    s.transmission = h.m.transmission;
    apply_user_surface(s, hit_fragment(ray, hit, h, s.n), v);
    return s;
}

// Whether user_surface has discarded the surface at a hit. A `discard` would end the pixel, so Specula makes the copy of the hook
// that hits call set this variable and return instead.
bool is_discarded_at_hit = false;

// Whether a ray stops at a hit, or passes through a hole, a partly covered or a transmissive surface. `random`: uniform.
bool stops_ray(Ray ray, Hit hit, float random) {
    TracedMaterial m = traced_materials[traced_corners[hit.triangle].material];
    vec3 facet_n = hit_facet_normal(hit, -ray.direction_ws);
    is_discarded_at_hit = false;
    // Of an opaque surface the hook's coverage does not count, so the optimizer drops all that nothing else depends on.
    if (m.alpha_mode == ALPHA_OPAQUE) {
        float transmission = hooked_surface(ray, hit, hit_material(hit), facet_n).transmission;
        return !is_discarded_at_hit && random >= transmission;
    }
    Surface s = hooked_surface(ray, hit, hit_material(hit), facet_n);
    float coverage = m.alpha_mode == ALPHA_MASK ? (s.coverage < m.alpha_cutoff ? 0.0 : 1.0) : s.coverage;
    return !is_discarded_at_hit && random < coverage * (1.0 - s.transmission);
}

// The surface at a hit where a ray stops, ready for evaluate_brdf.
Surface hit_surface(Ray ray, Hit hit, vec3 facet_n) {
    Surface s = hooked_surface(ray, hit, hit_material(hit), facet_n);
    // The rays that it transmits have passed.
    s.transmission = 0.0;
    complete_surface(s, -ray.direction_ws);
    return s;
}

#endif
