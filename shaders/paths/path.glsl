// Path tracing: the rendering equation (Kajiya 1986) by Monte Carlo, with the picture's own evaluate_brdf.
//
//   L(v) = L_e + integral of L(l) f(l, v) |NoL| dl  =  L_e + mean of L(l) f |NoL| / p(l) over directions l of density p
//
// At each point that a path visits, two directions are drawn: one towards a light and one of the BRDF's lobes, along which
// the path goes on. Both may arrive at the same rectangle or part of the sky; the balance heuristic weights each by how
// likely it was (Veach & Guibas 1995; Veach 1997, section 9.2). Nothing is prefiltered or clamped, so small bright things
// that no light sampling knows, such as a light's reflection, cause bright dots ("fireflies") until enough paths have
// accumulated.
//
// The first point is the fragment with its full material. paths/scene.glsl says what the points after it lack.
#ifndef PATHS_PATH_GLSL
#define PATHS_PATH_GLSL

#include "interface.glsl"
#include "brdf/evaluate.glsl"
#include "brdf/surface.glsl"
#include "lighting/transmission.glsl"
#include "paths/bvh.glsl"
#include "paths/lights.glsl"
#include "paths/numbers.glsl"

// Radiance towards the eye, without the first surface's own emission, split by where it comes from.
struct PathLight {
    vec3 unoccluded;           // the environment, reflected once, as if nothing stood in its way
    vec3 sky;                  // the same where nothing stands in its way
    vec3 lamps;                // punctual lights and rectangles, reflected once, with their shadows
    vec3 model;                // from other surfaces of the model: emitted there, or reflected more than once
    uint not_finite;           // number of paths that were dropped since their light was no radiance
};

// No light source is brighter than this, in cd/m^2, and its square still is a float. (The sun has 1.6e9.) A path with more
// comes from a broken formula; it would swamp the mean of all others.
const float MOST_RADIANCE = 1e15;

// Rays start this fraction of the model's radius above the facet, so that rounding does not make it shadow itself. Geometry
// closer together than this leaks light.
const float RAY_OFFSET = 1e-4;

Ray ray_from(vec3 position_ws, vec3 facet_n, vec3 l, uint seed) {
    float side = dot(l, facet_n) < 0.0 ? -1.0 : 1.0;
    return Ray(position_ws + facet_n * (side * RAY_OFFSET * frame.scene_radius), l, seed);
}

// Whether an edit made a factor negative that cannot be. The sum of all lobes may hide it. 1e-3 is far above rounding errors.
bool has_negative_factor(Brdf brdf) {
    vec3 least = min(min(brdf.f_dielectric, brdf.f_metal), min(brdf.diffuse, vec3(min(brdf.distribution, brdf.visibility))));
    return any(lessThan(least, vec3(-1e-3)));
}

// f |NoL| for light from direction l; NaN if a factor is negative. What a surface transmits crosses its volume. Its specular transmission is that of
// punctual lights only: as in the picture, lighting/transmission.glsl looks all else up in the drawn scene.
vec3 reflected(Surface s, vec3 l, vec3 v, bool is_point) {
    Brdf brdf = evaluate_brdf(s, l, v);
    if (has_negative_factor(brdf)) return vec3(uintBitsToFloat(0x7fc00000u));
    vec3 value = brdf.value;
    if (LIGHT_PASSES && dot(s.n, l) < 0.0) {
        vec3 passes = brdf.diffuse_transmitted + (is_point ? brdf.transmitted : vec3(0.0));
        value = passes * attenuation(s, s.thickness) + brdf.clearcoat;
    }
    return value * abs(dot(s.n, l));
}

// One path from the surface `s`, seen from v. Without `traces`, it ends after one reflection and sees no punctual lights and no
// obstacles. `facet_n`: normal of the triangle towards v.
PathLight trace_path(Surface s, vec3 v, vec3 facet_n, uint path, bool traces) {
    PathLight light = PathLight(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0u);
    PathNumbers numbers = path_numbers(path);
    vec3 throughput = vec3(1.0);
    uint bounces = traces ? frame.path_bounces : 0u;
    for (uint vertex = 0u; vertex <= bounces; ++vertex) {
        // First towards a light, then of a lobe. One loop for both: each call of evaluate_brdf or trace would cost the
        // driver another copy of it to compile.
        for (uint technique = 0u; technique < 2u; ++technique) {
            bool to_light = technique == 0u;
            vec3 u = numbers_of(numbers, vertex, to_light);
            LightSample towards = LightSample(vec3(0.0), FAR_AWAY, vec3(0.0), 0.0, false, false);
            DirectionSample drawn;
            if (to_light) {
                towards = sample_light(s.position_ws, u, traces);
                drawn = DirectionSample(towards.l, can_contribute(dot(s.n, towards.l)) ? towards.pdf : 0.0);
            } else {
                drawn = sample_lobes(s, v, u.xy, min(uint(u.z * float(LOBE_CHOICES)), LOBE_CHOICES - 1u));
            }
            if (drawn.pdf <= 0.0) {
                if (!to_light) throughput = vec3(0.0);
                continue;
            }
            vec3 weight = throughput * reflected(s, drawn.l, v, towards.is_point) / drawn.pdf;
            if (!to_light) throughput = weight;

            // The sky's light along l, whichever way l was drawn, and that of a light sampled on purpose.
            float other = to_light ? (towards.is_point ? 0.0 : pdf_lobes(s, v, drawn.l))
                                   : sky_probability(traces) * pdf_environment(drawn.l);
            vec3 sky = vec3(0.0);
            if (!to_light || towards.is_sky) sky = weight * sky_radiance(drawn.l) * balance(drawn.pdf, other);
            vec3 lamp = vec3(0.0);
            if (to_light && !towards.is_sky) lamp = weight * towards.radiance * balance(drawn.pdf, other);
            if (vertex == 0u) light.unoccluded += sky;
            // Opaque triangles block what their shading normals let pass to the wrong side: a ray would start behind its own surface.
            // (Vertex normals may point away from the eye, and then count for both sides.)
            float is_through = dot(facet_n, drawn.l) * dot(s.ng, drawn.l) * dot(facet_n, s.ng);
            if (traces && is_through <= 0.0) {
                weight = vec3(0.0);
                if (!to_light) throughput = vec3(0.0);
            }
            if (!traces || max_component(abs(weight)) == 0.0) continue;

            Ray ray = ray_from(s.position_ws, facet_n, drawn.l, seed_of(numbers, vertex, to_light));
            Hit hit;
            bool is_blocked = trace(ray, towards.distance, to_light, hit);
            if (!to_light) lamp = weight * rectangles_along(ray, hit.distance, drawn.pdf);
            if (is_blocked) sky = vec3(0.0);
            if (is_blocked && to_light) lamp = vec3(0.0);
            light.sky += vertex == 0u ? sky : vec3(0.0);
            light.lamps += vertex == 0u ? lamp : vec3(0.0);
            light.model += vertex == 0u ? vec3(0.0) : sky + lamp;
            if (to_light) continue;
            if (!is_blocked) {
                throughput = vec3(0.0);
                continue;
            }
            // The path goes on from where it has hit the model.
            v = -ray.direction_ws;
            facet_n = hit_facet_normal(hit, v);
            s = hit_surface(ray, hit, facet_n);
            light.model += throughput * s.emissive;
        }
        if (max_component(abs(throughput)) == 0.0) break;
    }
    return light;
}

bool is_radiance(vec3 x) { return !any(isnan(x)) && max_component(abs(x)) < MOST_RADIANCE; }

// Mean of paths first .. first + count - 1 of this pixel. A path whose light is not finite, or more than MOST_RADIANCE,
// counts as black and is reported.
PathLight trace_paths(Surface s, vec3 v, vec3 facet_n, uint first, uint count, bool traces) {
    PathLight mean = PathLight(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0u);
    float weight = 1.0 / float(max(count, 1u));
    for (uint i = first; i < first + count; ++i) {
        PathLight light = trace_path(s, v, facet_n, i, traces);
        bool is_good = is_radiance(light.unoccluded) && is_radiance(light.sky) && is_radiance(light.lamps)
                    && is_radiance(light.model);
        if (!is_good) {
            ++mean.not_finite;
            continue;
        }
        mean.unoccluded += light.unoccluded * weight;
        mean.sky += light.sky * weight;
        mean.lamps += light.lamps * weight;
        mean.model += light.model * weight;
    }
    return mean;
}

#endif
