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
    vec3 f0;                   // of the dielectric: reflectance along the normal
    float f90;                 // of the dielectric: reflectance at a grazing angle
    float ior;                 // of the dielectric
    vec4 dfg;                  // albedo terms towards the eye: see brdf/energy.glsl
    vec3 multiple;             // strength of multiple scattering: see brdf/multiscatter.glsl, which fills in both

    // What follows is set where FEATURES has the extension's bit, and neutral else.
    vec3 t;                    // FEATURE_ANISOTROPY: direction in which the lobe is stretched, unit, at right angles to n
    vec3 b;                    // cross(n, t)
    float anisotropy;          // 0 round .. 1
    vec3 conductor_n;          // FEATURE_CONDUCTOR: complex index of refraction of the metal, n + i k
    vec3 conductor_k;
    vec3 clearcoat_n;          // FEATURE_CLEARCOAT
    float clearcoat;           // 0 none .. 1
    float clearcoat_roughness; // perceptual
    vec3 sheen_color;          // FEATURE_SHEEN: linear RGB
    float sheen_roughness;     // perceptual
    float iridescence;         // FEATURE_IRIDESCENCE: 0 none .. 1
    float iridescence_ior;     // of the film
    float iridescence_nm;      // thickness of the film, nanometers
    float transmission;        // FEATURE_TRANSMISSION: 0 none .. 1
    float thickness;           // FEATURE_VOLUME: world meters, 0 is a thin wall
    vec3 attenuation_color;    // what is left of white light after attenuation_distance
    float attenuation_distance; // meters
    float dispersion;          // FEATURE_DISPERSION: 20 / Abbe number
    float diffuse_transmission; // FEATURE_DIFFUSE_TRANSMISSION: part of the diffuse light that passes through
    vec3 diffuse_transmission_color;
};

// Below this the lobe is narrower than the numbers can say. Its peak 1 / (pi alpha^2) must fit into a half float
// (65504), in which the scene color may be kept, so alpha > 0.0022; and D takes NoH^2 from 1, known to 6e-8 only, so
// alpha^2 must be far more. 0.0025 is a roughness of 0.05. At 0 a point light, having no size, has no reflection.
const float MIN_ALPHA = 0.0025;

// alpha = roughness^2 makes equal steps of roughness look equal (Burley 2012, section 5.4; glTF 2.0, appendix B.2.3).
float alpha_from_roughness(float roughness) { return max(roughness * roughness, MIN_ALPHA); }

#endif
