// A point on a surface as the shading sees it: textures are read, factors multiplied. material.glsl makes it.
#ifndef BRDF_SURFACE_GLSL
#define BRDF_SURFACE_GLSL

struct Surface {
    vec3 position_ws;
    vec3 n;                    // shading normal, world space, unit
    vec3 base_color;           // linear RGB: albedo of a dielectric, F0 of a metal
    float coverage;            // glTF's alpha; `alpha` is kept for the width of the GGX lobe
    float metallic;            // 0 dielectric .. 1 metal
    float roughness;           // perceptual, 0..1
    float occlusion;           // 1: sees the whole sky
    vec3 emissive;             // radiance
};

// Below this the lobe is narrower than the numbers can say. Its peak 1 / (pi alpha^2) must fit into a half float
// (65504), in which the scene color may be kept, so alpha > 0.0022; and D takes NoH^2 from 1, known to 6e-8 only, so
// alpha^2 must be far more. 0.0025 is a roughness of 0.05. At 0 a point light, having no size, has no reflection.
const float MIN_ALPHA = 0.0025;

// alpha = roughness^2 makes equal steps of roughness look equal (Burley 2012, section 5.4; glTF 2.0, appendix B.2.3).
float alpha_from_roughness(float roughness) { return max(roughness * roughness, MIN_ALPHA); }

// glTF fixes the index of refraction of dielectrics at 1.5: F0 = ((1.5 - 1) / (1.5 + 1))^2.
const float DIELECTRIC_F0 = 0.04;

#endif
