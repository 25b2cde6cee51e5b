// Specular antialiasing: widens a lobe by the normals that a pixel covers (Tokuyoshi & Kaplanyan 2019, "Improved Geometric
// Specular Antialiasing"). A pixel is shaded once, with one normal. Where the normal turns within a pixel by more than
// the lobe is wide, highlights break into dots that flicker; multisampling does not help, since it shades no more often.
//
// Off by default: it steadies moving pictures, but a still one comes out further from the mean of 64 samples a pixel. GGX
// has a longer tail than the mean of narrow lobes, so bright lights get halos (FLIP, 320x180, 4x multisampled: 0.025
// without, 0.058 with it for a normal-mapped model under three point lights).
#ifndef MATERIAL_ANTIALIASING_GLSL
#define MATERIAL_ANTIALIASING_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"

//@ui "Specular antialiasing" group="Sampling" doc="Widens lobes where normals turn within a pixel (Tokuyoshi & Kaplanyan 2019): highlights do not flicker, but get halos"
layout(constant_id = USER_CONSTANTS + 9) const bool SPECULAR_ANTIALIASING = false;

// alpha'^2 = alpha^2 + min(2 variance, 0.18)     variance = (|dn/dx|^2 + |dn/dy|^2) / 4
//
// The filter of a pixel has a standard deviation of half a pixel, hence 1/4; the lobe of D has a variance of about
// alpha^2 / 2 in the slope of h, hence 2. 0.18 bounds the blur where the derivatives, which are differences between two
// pixels, cross an edge (the paper's thresholds). The paper also has an anisotropic filter by h, which depends on the
// light; this isotropic form by n holds for the environment too.
float antialiased_roughness(float roughness, vec3 n) {
    vec3 dx = dFdx(n);
    vec3 dy = dFdy(n);
    float variance = 0.25 * (dot(dx, dx) + dot(dy, dy));
    float a2 = pow(roughness, 4.0) + min(2.0 * variance, 0.18);
    return saturate(sqrt(sqrt(a2)));
}

// Call it after the last change of normals and roughness, and outside of branches, where derivatives exist.
void antialias_specular(inout Surface s) {
    if (!SPECULAR_ANTIALIASING) return;
    s.roughness = antialiased_roughness(s.roughness, s.n);
    if ((FEATURES & FEATURE_CLEARCOAT) != 0u) {
        s.clearcoat_roughness = antialiased_roughness(s.clearcoat_roughness, s.clearcoat_n);
    }
}

#endif
