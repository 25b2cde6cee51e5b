// The mesh as the horizon of its bumps. A normal texture tilts the shading normal n, but the surface still ends at the plane of its
// geometric normal ng: light from behind that plane must not reach the front, although n may face it.
#ifndef BRDF_HORIZON_GLSL
#define BRDF_HORIZON_GLSL

#include "common/math.glsl"

// The part of a light at l that bumps as steep as n leave visible, 0..1: Smith's G1 of GGX (Estevez, Lecocq & Stein 2019, "A
// Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem", Ray Tracing Gems, chapter 12):
//
//   G = 2 / (1 + sqrt(1 + alpha^2 tan^2(ng, l)))        alpha^2 = min(tan^2(ng, n) / 8, 1)
//
// It falls to 0 at the mesh's horizon without an edge, and is 0 where n and ng disagree on which side l is. For l behind both
// normals it is the same for light that the surface transmits. n = ng -> 1. 1e-4: n perpendicular to ng.
float bump_visibility(vec3 ng, vec3 n, vec3 l) {
    float cosine = dot(ng, l);
    float sin2_n = sin2_between(ng, n);
    float a2 = min(0.125 * sin2_n / max(1.0 - sin2_n, 1e-4), 1.0);
    float root = sqrt(mix(cosine * cosine, 1.0, a2));
    return cosine * dot(n, l) > 0.0 ? 2.0 * abs(cosine) / (abs(cosine) + root) : 0.0;
}

// The part of a lobe around d that leaves the mesh, 0..1, for light without a single direction. d may point below the mesh, where
// the reflection is of the bumps themselves, which this shading does not know. So the lobe fades within 90 degrees below the
// horizon (Russell 2015, "Horizon Occlusion for Normal Mapped Reflections"; the square is also in Filament's documentation, 5.3.4).
// d: of any length. n = ng -> 1.
float reflection_visibility(vec3 ng, vec3 d) {
    float below = min(dot(ng, d) * inversesqrt(dot(d, d)), 0.0);
    return (1.0 + below) * (1.0 + below);
}

#endif
