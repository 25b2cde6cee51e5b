// Calls user_surface, the hook into the material. Every stage that makes a surface calls apply_user_surface, so that what the
// hook does to the picture, it also does to shadows, occlusion, the ground and path tracing.
#ifndef MATERIAL_USER_SURFACE_GLSL
#define MATERIAL_USER_SURFACE_GLSL

#include "interface.glsl"
#include "brdf/fresnel.glsl"
#include "brdf/reflectance.glsl"
#include "brdf/surface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "user.glsl"

// F0 after a change of the index of refraction: F0 keeps the color and the factor of KHR_materials_specular, which have scaled
// the F0 of the old index. Limit: where min(F0 color, 1) has clamped the old F0, the part that it cut is lost.
vec3 f0_after(Surface before, float ior) {
    float old_f0 = f0_from_ior(before.ior);
    float new_f0 = f0_from_ior(ior);
    // An index of 1 has an F0 of 0, which keeps no color.
    return old_f0 > 0.0 ? min(before.f0 * (new_f0 / old_f0), vec3(before.f90)) : vec3(new_f0 * before.f90);
}

// Brings into line what depends on the members that the hook has changed. The comparisons are of bits, so the optimizer decides them
// for a hook that leaves those members alone, and all of this is gone.
void follow_changes(Surface before, inout Surface s) {
    bool is_ior_set = !is_same_bits(s.ior, before.ior);
    bool is_f0_set = !is_same_bits(s.f0, before.f0);
    bool is_tilted = !is_same_bits(s.n, before.n);
    bool is_coat_tilted = !is_same_bits(s.clearcoat_n, before.clearcoat_n);
    bool is_turned = !is_same_bits(s.t, before.t);

    // Specular-glossiness gives F0 itself. A condition of one comparison is decided at once, one that joins several is not.
    if ((FEATURES & FEATURE_SPECULAR_GLOSSINESS) == 0u) {
        if (is_ior_set) {
            if (!is_f0_set) s.f0 = f0_after(before, s.ior);
        }
    }
    if (is_tilted) {
        s.n = safe_normalize(s.n, before.n);
        // Without a normal of its own, the clear coat lies on the base.
        if (!is_coat_tilted && before.clearcoat_n == before.n) s.clearcoat_n = s.n;
    }
    if (is_coat_tilted) s.clearcoat_n = safe_normalize(s.clearcoat_n, s.n);
    if ((FEATURES & FEATURE_ANISOTROPY) != 0u && (is_tilted || is_turned)) {
        s.t = safe_normalize(s.t - s.n * dot(s.n, s.t), any_perpendicular(s.n));
        s.b = cross(s.n, s.t);
    }
    // n = 1 and k = 0 stand for a metal whose n and k are not given. The color that the hook leaves determines them.
    if ((FEATURES & FEATURE_CONDUCTOR) != 0u && s.conductor_n == vec3(1.0) && s.conductor_k == vec3(0.0)) {
        complex_ior(s.base_color, EDGE_TINT, s.conductor_n, s.conductor_k);
    }
}

// Lets the author's hook change a surface that make_surface or a hit of path tracing has made. `v`: towards the viewer, unit.
void apply_user_surface(inout Surface s, Fragment f, vec3 v) {
    Surface before = s;
    user_surface(s, f, v);
    follow_changes(before, s);
}

#endif
