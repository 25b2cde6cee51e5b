// The reference for the split sum: the same integrals by Monte Carlo, with the same evaluate_brdf.
//
//   L(v) = integral of L(l) f(l, v) |NoL| dl  =  mean of L(l) f |NoL| / p(l) over directions l drawn with density p
//
// No single density fits f: the highlight needs directions where D is large, the diffuse lobe follows the cosine. So
// each path picks one lobe's density at random, and p is the mean of all: the one-sample balance heuristic (Veach &
// Guibas 1995, eq. 14; Veach 1997, section 9.2.4), which is never much worse than the best density. Nothing is
// prefiltered or clamped. The brightest light of the environment has a density of its own (lighting/sun.glsl); other
// small lights cause bright dots ("fireflies") until enough frames have accumulated. Baked occlusion is ignored: this
// estimate assumes an unoccluded sky.
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
    float weight;              // |NoL| / density; 0: no contribution
};

// A lobe's tangent frame, and the eye in it.
struct LobeFrame {
    mat3 world_from_lobe;
    vec3 v;
    vec2 alpha;                // along the frame's x and y
};

// A normal map can turn n away from the eye; v is then clamped to a grazing angle. The estimate stays correct, since
// any density above 0 will do.
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

// Draws from one of `choices` densities, all equally likely: one per lobe, the same mirrored behind the surface where
// light is transmitted, and the sun's.
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

    // A direction below the surface contributes nothing, with two exceptions: transmission of the sun, and a coat whose
    // normal is not the base's.
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
    // The coat's own reflections below the base's horizon, in addition to the mirrored ones.
    if (HAS_COAT && LIGHT_PASSES && dot(s.n, l) < 0.0 && coat_lies_apart()) pdf += pdf_lobe(coat, l);
    // pdf = 0: a reflection below the coat's horizon.
    return Path(l, pdf > 0.0 ? abs(n_dot_l) * float(choices) / pdf : 0.0);
}

// Additive recurrence in three dimensions: point i is the fraction of i times (1/g, 1/g^2, 1/g^3), g^4 = g + 1 (Roberts
// 2018, "The unreasonable effectiveness of quasirandom sequences"). Every contiguous run fills the cube evenly, so each
// frame continues where the last one stopped. Integers, with 2^32 for 1, never lose digits. A random shift per pixel
// (Cranley & Patterson 1976) decorrelates neighboring pixels.
vec3 path_numbers(uint i, uvec3 shift) {
    return vec3((shift + i * uvec3(3518319155u, 2882110345u, 2360945575u)) >> 8) * exp2(-24.0);
}

// The furnace uses the same points for every pixel, so that its error is smooth instead of noisy: one Fibonacci lattice
// per density, whose second coordinate is periodic like the azimuth. For a white metal with a roughness of 0.1 or more,
// at up to 85 degrees, the result is at most 0.0045 too high and 0.01 too low.
const uint LATTICE = 89u;
const uint FURNACE_PATHS = LATTICE * PATH_LOBES * PATH_SIDES;
vec2 lattice_point(uint i) { return vec2(float(i) + 0.5, float(i * 55u % LATTICE)) / float(LATTICE); }

// Mean of the light that paths first .. first + count - 1 of this pixel bring from the unfiltered environment.
// `furnace`: uniform radiance 1 instead; the result is the albedo. By reciprocity that is also the fraction of a beam
// from the eye that is not absorbed. Requires first = 0 and count = FURNACE_PATHS.
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
        // Specular transmission is left out: lighting/transmission.glsl looks it up in the rendered scene.
        if (behind && !furnace) {
            value = (f.diffuse_transmitted * attenuation(s, s.thickness) + f.clearcoat) * path.weight;
        }
        sum += furnace ? value : value * environment_radiance(path.l, 0.0);
    }
    return sum / float(max(count, 1u));
}

#endif
