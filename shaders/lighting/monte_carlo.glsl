// The truth that the split sum is held against: the same integrals by random paths, with the same evaluate_brdf.
//
//   L(v) = integral of L(l) f(l, v) |NoL| dl  =  mean of L(l) f |NoL| / p(l) over directions l drawn with density p
//
// One density fits no f: the highlight wants directions where D is large, the diffuse part where the cosine is. So p is
// the mean of one density for each lobe, from which one is drawn by chance: the balance heuristic (Veach & Guibas 1995,
// eq. 14; one-sample form: Veach 1997, section 9.2.4), which is never much worse than the best of them. Nothing is
// prefiltered or clamped. Lights smaller than the sun's surroundings, all but the brightest, make bright dots
// ("fireflies") until enough frames have come together; the brightest has a density of its own (lighting/sun.glsl).
// Occlusion is left out: it is the texture's word about a shape, which an integral over the whole sky does not know.
#ifndef LIGHTING_MONTE_CARLO_GLSL
#define LIGHTING_MONTE_CARLO_GLSL

#include "interface.glsl"
#include "brdf/evaluate.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "lighting/environment.glsl"
#include "lighting/lobes.glsl"
#include "lighting/sun.glsl"
#include "lighting/transmission.glsl"

const bool HAS_COAT = (FEATURES & FEATURE_CLEARCOAT) != 0u;
const uint PATH_LOBES = HAS_COAT ? 3u : 2u;   // specular, diffuse, coat
const uint PATH_SIDES = LIGHT_PASSES ? 2u : 1u;

struct Path {
    vec3 l;                    // unit, world space
    float weight;              // |NoL| / density; 0: the path leads nowhere
};

// A lobe's frame, and the eye in it.
struct LobeFrame {
    mat3 world_from_lobe;
    vec3 v;
    vec2 alpha;                // along x and y
};

// A normal map can turn n away from the eye; the lobe is then drawn as for a grazing angle. Any density > 0 will do.
LobeFrame lobe_frame(mat3 world_from_lobe, vec3 v, vec2 alpha) {
    vec3 v_lobe = v * world_from_lobe;
    return LobeFrame(world_from_lobe, normalize(vec3(v_lobe.xy, max(v_lobe.z, 1e-4))), alpha);
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

// One of `choices` densities, each drawn equally often: those of the lobes, the same mirrored behind the surface where
// light passes, and the sun.
Path sample_path(Surface s, vec3 v, vec2 u, uint choice, uint choices, Sun sun) {
    LobeFrame specular = specular_frame(s, v);
    LobeFrame coat = specular;
    if (HAS_COAT) coat = coat_frame(s, v);

    uint lobe = choice % PATH_LOBES;
    vec3 l;
    if (choice >= PATH_LOBES * PATH_SIDES) l = sample_sun(sun, u);
    else if (HAS_COAT && lobe == 2u) l = sample_lobe(coat, u);
    else if (lobe == 1u) l = specular.world_from_lobe * sample_cosine(u);
    else l = sample_lobe(specular, u);

    // A reflection into the surface leads nowhere; below it the sun shines through, and a coat that lies flatter than the
    // bumps of its base is lit.
    bool by_sun = choice >= PATH_LOBES * PATH_SIDES;
    bool mirrored = !by_sun && choice >= PATH_LOBES;
    float n_dot_l = dot(s.n, l);
    bool by_coat = HAS_COAT && lobe == 2u && !by_sun && !mirrored;
    bool may_be_below = (by_sun && LIGHT_PASSES) || (coat_lies_apart() && (by_sun || by_coat));
    if (n_dot_l == 0.0 || (n_dot_l < 0.0 && !may_be_below)) return Path(s.n, 0.0);
    if (mirrored) l -= 2.0 * n_dot_l * s.n;

    vec3 front = LIGHT_PASSES ? unfolded(s.n, l) : l;
    float pdf = pdf_lobe(specular, front) + pdf_cosine(dot(s.n, front)) + pdf_sun(sun, l);
    if (HAS_COAT) pdf += pdf_lobe(coat, front);
    // What the coat sends below the base, beside what is mirrored there.
    if (HAS_COAT && LIGHT_PASSES && dot(s.n, l) < 0.0 && coat_lies_apart()) pdf += pdf_lobe(coat, l);
    // 0: a reflection into the coat.
    return Path(l, pdf > 0.0 ? abs(n_dot_l) * float(choices) / pdf : 0.0);
}

// Additive recurrence in three dimensions: point i is the fraction of i times (1/g, 1/g^2, 1/g^3), g^4 = g + 1 (Roberts
// 2018, "The unreasonable effectiveness of quasirandom sequences"). Any run of it fills the cube evenly, so frames
// can go on where the last one ended. In integers, 2^32 standing for 1, it never loses digits; the pixel's own random
// shift (Cranley & Patterson 1976) keeps neighbors from having the same error.
vec3 path_numbers(uint i, uvec3 shift) {
    return vec3((shift + i * uvec3(3518319155u, 2882110345u, 2360945575u)) >> 8) * exp2(-24.0);
}

// A furnace has the same points for each pixel, so that the error is smooth, not noise: Fibonacci's lattice, whose
// second coordinate is periodic as the azimuth is, once for each density. For a white metal of a roughness of 0.1 and
// more, at up to 85 degrees, the result is at most 0.0045 too high and 0.01 too low.
const uint LATTICE = 89u;
const uint FURNACE_PATHS = LATTICE * PATH_LOBES * PATH_SIDES;
vec2 lattice_point(uint i) { return vec2(float(i) + 0.5, float(i * 55u % LATTICE)) / float(LATTICE); }

// Mean over paths number first .. first + count - 1 of this pixel of the light that they bring from the environment,
// sharp. `furnace`: a radiance of 1 comes from everywhere instead. That is the albedo; by reciprocity, the part of a
// beam from the eye that is not absorbed. It takes FURNACE_PATHS, from 0.
vec3 monte_carlo(Surface s, vec3 v, bool furnace, uint first, uint count) {
    uvec3 shift = random_words(uvec3(gl_FragCoord.xy, 0u));
    Sun sun = Sun(s.n, false);
    if (!furnace) sun = find_sun();
    uint choices = PATH_LOBES * PATH_SIDES + (sun.counts ? 1u : 0u);
    vec3 sum = vec3(0.0);
    for (uint i = first; i < first + count; ++i) {
        vec3 u = path_numbers(i, shift);
        uint choice = uint(u.z * float(choices));
        if (furnace) {
            u.xy = lattice_point(i % LATTICE);
            choice = i / LATTICE;
        }
        Path path = sample_path(s, v, u.xy, choice, choices, sun);
        if (path.weight == 0.0) continue;
        bool behind = LIGHT_PASSES && dot(s.n, path.l) < 0.0;
        Brdf f = evaluate_brdf(s, path.l, v);
        vec3 value = f.value * path.weight;
        // What passes straight through is not the sky's alone: lighting/transmission.glsl looks up the scene for it.
        if (behind && !furnace) {
            value = (f.diffuse_transmitted * attenuation(s, s.thickness) + f.clearcoat) * path.weight;
        }
        sum += furnace ? value : value * environment_radiance(path.l, 0.0);
    }
    return sum / float(max(count, 1u));
}

#endif
