// Two steps of Jacobi's method for the pressure, laplacian(p) = div u, in one. A file that includes this declares the
// image with which the steps start, and defines PRESSURE_BEFORE as its name.
//
//   p'(x) = (sum of p at the four neighbors - div u(x)) / 4
//
// The second step put into the first: p'' is a mean of p over nine texels, less a mean of div u over five. Places outside the image
// count as the nearest texel, so that pressure does not change across the border.
#ifndef PASSES_FLUID_JACOBI_GLSL
#define PASSES_FLUID_JACOBI_GLSL

#include "pass.glsl"

#ifndef PRESSURE_BEFORE
#define PRESSURE_BEFORE fluid_divergence   // so that this file compiles by itself
#endif

uniform sampler2D fluid_divergence;

ivec2 inside(ivec2 at) { return clamp(at, ivec2(0), ivec2(pass.size_px) - 1); }
float pressure_at(ivec2 at) { return texelFetch(PRESSURE_BEFORE, inside(at), 0).r; }
float divergence_at(ivec2 at) { return texelFetch(fluid_divergence, inside(at), 0).r; }

float after_two_steps(ivec2 at) {
    float p = 4.0 * pressure_at(at);
    float divergence = 4.0 * divergence_at(at);
    for (int i = -1; i <= 1; i += 2) {
        p += pressure_at(at + ivec2(2 * i, 0)) + pressure_at(at + ivec2(0, 2 * i));
        p += 2.0 * (pressure_at(at + ivec2(i, i)) + pressure_at(at + ivec2(i, -i)));
        divergence += divergence_at(at + ivec2(i, 0)) + divergence_at(at + ivec2(0, i));
    }
    return (p - divergence) / 16.0;
}

#endif
