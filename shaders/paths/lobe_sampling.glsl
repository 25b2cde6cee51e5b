// Draws directions as the BRDF reflects them.
//
// No single density fits f: the highlight needs directions where D is large, the diffuse lobe follows the cosine. So each
// draw picks one lobe at random, and the density is the mean over all lobes: the one-sample balance heuristic (Veach &
// Guibas 1995, eq. 14; Veach 1997, section 9.2.4), which is never much worse than the best single lobe.
#ifndef PATHS_LOBE_SAMPLING_GLSL
#define PATHS_LOBE_SAMPLING_GLSL

#include "interface.glsl"
#include "brdf/evaluate.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "lighting/lobe_frame.glsl"
#include "lighting/lobes.glsl"

const bool HAS_COAT = (FEATURES & FEATURE_CLEARCOAT) != 0u;
const uint LOBES = HAS_COAT ? 3u : 2u;   // specular, diffuse, coat
const uint SIDES = LIGHT_PASSES ? 2u : 1u;
const uint LOBE_CHOICES = LOBES * SIDES;

// A drawn direction.
struct DirectionSample {
    vec3 l;                    // unit, world space
    float pdf;                 // 1/sr; 0: contributes nothing
};

// Below the surface l contributes nothing, with two exceptions: transmission, and a coat whose normal is not the base's.
bool can_contribute(float n_dot_l) { return n_dot_l > 0.0 || (n_dot_l < 0.0 && (LIGHT_PASSES || coat_lies_apart())); }

// Density with which sample_lobes draws l, 1/sr. Each lobe also exists mirrored behind a surface that transmits light.
float pdf_lobes(Surface s, vec3 v, vec3 l) {
    LobeFrame specular = specular_frame(s, v);
    vec3 front = LIGHT_PASSES ? mirrored_to_front(s.n, l) : l;
    float pdf = pdf_lobe(specular, front) + pdf_cosine(dot(s.n, front));
    if (HAS_COAT) {
        LobeFrame coat = coat_frame(s, v);
        pdf += pdf_lobe(coat, front);
        // The coat's own reflections below the base's horizon, in addition to the mirrored ones.
        if (LIGHT_PASSES && dot(s.n, l) < 0.0 && coat_lies_apart()) pdf += pdf_lobe(coat, l);
    }
    return pdf / float(LOBE_CHOICES);
}

// Draws from lobe number `choice` of LOBE_CHOICES, all equally likely.
DirectionSample sample_lobes(Surface s, vec3 v, vec2 u, uint choice) {
    uint lobe = choice % LOBES;
    bool is_mirrored = choice >= LOBES;
    bool is_coat = HAS_COAT && lobe == 2u;
    vec3 l;
    if (is_coat) l = sample_lobe(coat_frame(s, v), u);
    else if (lobe == 1u) l = basis_around(s.n) * sample_cosine(u);
    else l = sample_lobe(specular_frame(s, v), u);

    float n_dot_l = dot(s.n, l);
    bool may_be_below = coat_lies_apart() && is_coat && !is_mirrored;
    if (n_dot_l == 0.0 || (n_dot_l < 0.0 && !may_be_below)) return DirectionSample(s.n, 0.0);
    if (is_mirrored) l -= 2.0 * n_dot_l * s.n;
    return DirectionSample(l, pdf_lobes(s, v, l));   // 0 for a reflection below the coat's horizon
}

#endif
