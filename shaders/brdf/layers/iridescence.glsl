// Thin-film interference, as on soap or oil: reflections from the film's two faces interfere, so the color depends on
// the angle. The result replaces F (KHR_materials_iridescence, after Belcour & Barla 2017).
#ifndef BRDF_LAYERS_IRIDESCENCE_GLSL
#define BRDF_LAYERS_IRIDESCENCE_GLSL

#include "brdf/fresnel.glsl"
#include "common/math.glsl"

// The eye's response to cos(2 pi path / wavelength + shift), linear RGB. Four Gaussians over the wavenumber approximate
// the CIE color matching functions; their Fourier transforms are Gaussians over the path (Belcour & Barla 2017, section
// 4, which gives the constants in SI units).
vec3 film_sensitivity(float path_nm, vec3 shift) {
    const vec3 HEIGHT = vec3(5.4856e-13, 4.4201e-13, 5.2481e-13);
    const vec3 PLACE = vec3(1.6810e6, 1.7953e6, 2.2084e6);
    const vec3 VARIANCE = vec3(4.3278e9, 9.3046e9, 6.6121e9);
    const mat3 RGB_FROM_XYZ = mat3(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314,
                                   0.0415560, 1.0572252);
    float phase = 2.0 * PI * path_nm * 1e-9;
    float phase2 = phase * phase;
    vec3 xyz = HEIGHT * sqrt(2.0 * PI * VARIANCE) * cos(PLACE * phase + shift) * exp(-phase2 * VARIANCE);
    // X has a second peak, in the blue.
    xyz.x += 9.7470e-14 * sqrt(2.0 * PI * 4.5282e9) * cos(2.2399e6 * phase + shift.x) * exp(-4.5282e9 * phase2);
    return RGB_FROM_XYZ * (xyz / 1.0685e-7);
}

// F of a film. f0: reflectance of the base in air; a metal is treated as a dielectric with that f0. outside: index of the
// medium above the film. c: the cosine in air, which Snell's law refracts into that medium. The series of reflections
// between the faces ignores polarization and is cut off after the second order:
//
//   F = R12 + Rs + sum over m of 2 (Rs - T12) (R12 R23)^(m/2) S(m path, m shift)     Rs = T12^2 R23 / (1 - R12 R23)
//   path = 2 ior nm cos2                                                      cos2: cosine of the refracted angle
//
// Reflection at a denser medium shifts the phase by pi. Below 30 nm the film's index fades to that of the medium above,
// so that zero thickness means no film. Belcour & Barla's code fades below 0.03 micrometers; the text of
// KHR_materials_iridescence has the same 0.03, but of a thickness in nanometers, which is surely a slip. Viewers that
// follow it to the letter show a film of 15 nm with its full index, and this one with half of the step. The truncated
// series and colors outside sRGB can leave 0..1, so the result is clamped.
vec3 f_film(vec3 f0, float ior, float nm, float outside, float c) {
    ior = mix(outside, ior, smoothstep(0.0, 30.0, nm));
    float sin2 = 1.0 - c * c;
    float cos2_squared = 1.0 - sin2 / (ior * ior);
    if (cos2_squared < 0.0) return vec3(1.0);   // total internal reflection: film index below that of air
    float cos2 = sqrt(cos2_squared);

    float r12 = f_schlick(f0_from_ior(ior / outside), sqrt(1.0 - sin2 / (outside * outside)));
    float t12 = 1.0 - r12;
    // 0.9999: f0 = 1 would need an infinite index.
    vec3 root = sqrt(min(f0, 0.9999));
    vec3 base_ior = (1.0 + root) / (1.0 - root);
    vec3 ratio = (base_ior - ior) / (base_ior + ior);
    vec3 r23 = f_schlick(ratio * ratio, vec3(1.0), cos2);

    vec3 shift = vec3(ior < outside ? 0.0 : PI) + vec3(lessThan(base_ior, vec3(ior))) * PI;
    float path_nm = 2.0 * ior * nm * cos2;
    vec3 r123 = clamp(r12 * r23, 1e-5, 0.9999);   // keeps the square root and the quotient below finite
    vec3 r = sqrt(r123);
    vec3 rs = t12 * t12 * r23 / (1.0 - r123);
    vec3 fresnel = r12 + rs;
    vec3 order = (rs - t12) * r;
    fresnel += 2.0 * order * film_sensitivity(path_nm, shift);
    fresnel += 2.0 * order * r * film_sensitivity(2.0 * path_nm, 2.0 * shift);
    return saturate(fresnel);
}

#endif
