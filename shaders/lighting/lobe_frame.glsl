// Directions around a specular lobe: reflections by the visible normals of a GGX as wide as the lobe, and their density. A
// density need not fit the selected D, V and F; the better it does, the fewer samples an estimate takes.
#ifndef LIGHTING_LOBE_FRAME_GLSL
#define LIGHTING_LOBE_FRAME_GLSL

#include "interface.glsl"
#include "brdf/energy/albedo.glsl"
#include "brdf/surface.glsl"
#include "brdf/visibility.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"

// A lobe's tangent frame, and the eye in it.
struct LobeFrame {
    mat3 world_from_lobe;
    vec3 v;
    vec2 alpha;                // along the frame's x and y
};

// A normal map can turn n away from the eye; v is then mirrored, as in evaluate_brdf.
LobeFrame lobe_frame(mat3 world_from_lobe, vec3 v, vec2 alpha) {
    vec3 v_lobe = v * world_from_lobe;
    return LobeFrame(world_from_lobe, normalize(vec3(v_lobe.xy, max(abs(v_lobe.z), MIN_N_DOT_V))), alpha);
}

LobeFrame specular_frame(Surface s, vec3 v) {
    bool is_round = (FEATURES & FEATURE_ANISOTROPY) == 0u;
    return lobe_frame(is_round ? basis_around(s.n) : mat3(s.t, s.b, s.n), v, alpha_sides(s));
}

LobeFrame coat_frame(Surface s, vec3 v) {
    return lobe_frame(basis_around(s.clearcoat_n), v, vec2(alpha_from_roughness(s.clearcoat_roughness)));
}

vec3 sample_lobe(LobeFrame lobe, vec2 u) {
    return lobe.world_from_lobe * reflect(-lobe.v, sample_ggx_vndf(u, lobe.v, lobe.alpha));
}

float pdf_lobe(LobeFrame lobe, vec3 l) {
    vec3 l_lobe = l * lobe.world_from_lobe;
    if (l_lobe.z <= 0.0) return 0.0;
    vec3 h = safe_normalize(l_lobe + lobe.v, vec3(0.0, 0.0, 1.0));
    return pdf_reflected(pdf_ggx_vndf(lobe.v, h, lobe.alpha), dot(lobe.v, h));
}

#endif
