// A point on a surface, as shading uses it: textures sampled, factors applied. material/material.glsl builds it.
#ifndef BRDF_SURFACE_GLSL
#define BRDF_SURFACE_GLSL

#include "brdf/energy/dfg.glsl"

struct Surface {
    vec3 position_ws;
    vec3 n;                    // shading normal, world space, unit
    vec3 ng;                   // geometric normal: the mesh's own, without normal textures; on the eye's side, unit
    vec3 base_color;           // linear RGB: albedo of a dielectric, F0 of a metal
    float coverage;            // glTF's alpha; the name `alpha` means roughness^2
    float metallic;            // 0 dielectric .. 1 metal
    float roughness;           // perceptual, 0..1
    float occlusion;           // 1: unoccluded
    vec3 emissive;             // radiance, cd/m^2
    vec3 f0;                   // of the dielectric: reflectance at normal incidence
    float f90;                 // of the dielectric: reflectance at grazing incidence
    float ior;                 // of the dielectric

    // complete_surface (brdf/energy/multiscatter.glsl) computes these from the members above.
    vec3 dielectric_average;   // cosine-weighted F of the boundary, 2 integral F(c) c dc, if it were all dielectric
    vec3 metal_average;        // the same if it were all metal
    Dfg dfg;                   // of the specular lobe towards the eye
    Dfg mean_dfg;              // the mean over all directions
    vec3 multiple;             // multiple scattering
    float boundary;            // total reflectance of the dielectric boundary towards the eye
    float mean_boundary;       // the mean over all directions

    // The members below are neutral unless FEATURES has the extension's bit.
    vec3 t;                    // FEATURE_ANISOTROPY: direction of the larger alpha, unit, perpendicular to n
    vec3 b;                    // cross(n, t)
    float anisotropy;          // 0 isotropic .. 1
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
    float thickness;           // FEATURE_VOLUME: meters in world space along the refracted ray, 0 is thin-walled
    vec3 attenuation_color;    // transmittance of attenuation_distance
    float attenuation_distance; // meters
    float dispersion;          // FEATURE_DISPERSION: 20 / Abbe number
    float diffuse_transmission; // FEATURE_DIFFUSE_TRANSMISSION: transmitted fraction of the diffuse light
    vec3 diffuse_transmission_color;
};

// Sets every member that belongs to an extension to its neutral value.
void clear_extensions(inout Surface s) {
    s.t = s.b = vec3(0.0);
    s.anisotropy = 0.0;
    s.conductor_n = vec3(1.0);
    s.conductor_k = vec3(0.0);
    s.clearcoat_n = s.n;
    s.clearcoat = s.clearcoat_roughness = 0.0;
    s.sheen_color = vec3(0.0);
    s.sheen_roughness = 0.0;
    s.iridescence = s.iridescence_nm = 0.0;
    s.iridescence_ior = 1.0;
    s.transmission = s.thickness = s.dispersion = 0.0;
    s.attenuation_color = vec3(1.0);
    s.attenuation_distance = 1.0;
    s.diffuse_transmission = 0.0;
    s.diffuse_transmission_color = vec3(1.0);
}

// Smallest alpha. The peak 1 / (pi alpha^2) must fit into a half float (65504), the format of the scene color, so
// alpha > 0.0022; and alpha^2 must be far above the rounding error of NoH^2, 6e-8. 0.0025 is a roughness of 0.05. (With
// alpha = 0, a punctual light would have no reflection at all.)
const float MIN_ALPHA = 0.0025;

// alpha = roughness^2 makes roughness perceptually uniform (Burley 2012, section 5.4; glTF 2.0, appendix B.2.3).
float alpha_from_roughness(float roughness) { return max(roughness * roughness, MIN_ALPHA); }

#endif
