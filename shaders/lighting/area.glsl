// One-sided rectangular lights, by linearly transformed cosines (Heitz, Dupuy, Hill & Neubelt 2016).
//
// The fraction of a lobe that falls on a polygon is an integral over the polygon's solid angle. For a cosine lobe it
// has a closed form, the form factor E (Lambert 1760). A GGX lobe is close to a cosine lobe that a matrix M has
// stretched and tilted. Transforming lobe and polygon by M^-1 does not change the fraction (section 3 of the paper):
//
//            | a 0 b |
//     M^-1 = | 0 1 0 |      part of the lobe inside = E(M^-1 p_0, M^-1 p_1, ...)     x: towards v,  z: n
//            | c 0 d |
#ifndef LIGHTING_AREA_GLSL
#define LIGHTING_AREA_GLSL

#include "interface.glsl"
#include "brdf/visibility.glsl"
#include "common/math.glsl"

layout(set = SET_FRAME, binding = BINDING_LTC) uniform sampler2D ltc_table;   // (a, b, c, d): scripts/make-ltc

// The fraction of each lobe that the light covers, 0..1. With L the light's radiance, the eye receives L albedo diffuse
// (Lambert) and L (f0 A + f90 B) specular: the table holds the lobe's shape for F = 1, and A + B is its albedo.
struct AreaLight {
    float diffuse;
    float specular;
};

// Where a polygon's outline passes below the plane z = 0, and where it comes back up.
struct Rim {
    vec3 leave;
    vec3 enter;
};

// Columns are roughness, rows sqrt(1 - NoV); both run from 0 to 1 between the centers of the first and last texels.
vec4 ltc_inverse(float roughness, float n_dot_v) {
    float size = float(textureSize(ltc_table, 0).x);
    return textureLod(ltc_table, (vec2(roughness, sqrt(1.0 - n_dot_v)) * (size - 1.0) + 0.5) / size, 0.0);
}

// Rows: x is v projected into the tangent plane, y completes the frame, z is n. At v = n the lobe is isotropic and any
// x will do. 1e-8 is the square of 1e-4 rad, where the cross product still has a direction despite rounding (1e-7).
mat3 tangent_from_world(vec3 n, vec3 v) {
    vec3 any = abs(n.z) < 0.7 ? vec3(n.y, -n.x, 0.0) : vec3(0.0, n.z, -n.y);
    vec3 y = cross(n, v);
    y = normalize(dot(y, y) > 1e-8 ? y : any);
    return transpose(mat3(cross(y, n), y, n));
}

// One edge of E = 1 / (2 pi) sum of angle(a, b) (a x b)_z / |a x b| (Lambert 1760; Baum, Rushmeier & Winget 1989).
// The angle is atan(|a x b|, a . b), which is precise at all angles and for a, b of any length. acos(a . b) loses half
// its digits near 0 and pi (Kahan, "Computing Cross-Products and Rotations", section 13), where all edges of a small
// light are. a x (b - a) equals a x b, but keeps its digits if a is close to b. 1e-18, whose square is still a float,
// makes an edge without length, or one that points at the surface, count 0.
float edge_form_factor(vec3 a, vec3 b) {
    vec3 across = cross(a, b - a);
    float size = max(length(across), 1e-18);
    return atan(size, dot(a, b)) * (across.z / size);
}

// Clips the edge to z > 0; returns false if nothing is left. If the ends are on different sides, one has z > 0, so the
// quotient's denominator is not 0. A convex outline crosses at most twice; its new edge runs from rim.leave to
// rim.enter.
bool clip_edge(inout vec3 a, inout vec3 b, inout Rim rim) {
    bool above_a = a.z > 0.0;
    bool above_b = b.z > 0.0;
    if (above_a != above_b) {
        vec3 on = vec3(a.xy + (b.xy - a.xy) * (a.z / (a.z - b.z)), 0.0);
        if (above_a) rim.leave = b = on; else rim.enter = a = on;
    }
    return above_a || above_b;
}

// Walks the outline once. Clips each edge at the horizon and counts it for the diffuse (cosine) lobe; then transforms
// it by M^-1, clips it at the cosine's own horizon and counts it for the specular lobe. Edge 4 lies in the horizon.
//
// If c is not 0, the transformed lobe reaches below the surface. That part was clipped, so the rest is scaled up: it is
// (1 + cos beta) / 2 of a cosine, with beta the angle between the two horizons (E of a lune, Lambert again). In the
// cosine's space the surface normal is (-c, 0, a). So a light that fills the hemisphere gives exactly 1 in both lobes.
AreaLight integrate_rect(Light light, vec3 position_ws, vec3 n, vec3 v, float roughness) {
    vec3 to_center = light.position_ws.xyz - position_ws;
    if (dot(to_center, light.direction_ws) >= 0.0) return AreaLight(0.0, 0.0);   // it faces away, or is edge-on

    // E does not depend on scale; unit scale keeps squares and cubes in the range of floats.
    float unit = inversesqrt(dot(to_center, to_center) + dot(light.half_x_ws, light.half_x_ws)
                             + dot(light.half_y_ws, light.half_y_ws));
    mat3 to_tangent = tangent_from_world(n, v) * unit;
    vec3 center = to_tangent * to_center;
    vec3 x = to_tangent * light.half_x_ws;
    vec3 y = to_tangent * light.half_y_ws;

    vec4 m = ltc_inverse(roughness, n_dot_v_of(n, v));
    mat3 inverse_m = mat3(m.x, 0.0, m.z, 0.0, 1.0, 0.0, m.y, 0.0, m.w);
    Rim horizon = Rim(vec3(0.0), vec3(0.0));
    Rim rim = horizon;
    vec2 sum = vec2(0.0);      // diffuse, specular; both negative if the outline runs clockwise
    for (int edge = 0; edge < 5; ++edge) {
        vec3 a = center + x + y;
        vec3 turned = -x;
        x = y;                 // a quarter turn: the next corner
        y = turned;
        vec3 b = center + x + y;
        if (edge == 4) {
            a = horizon.leave;
            b = horizon.enter;
        } else if (!clip_edge(a, b, horizon)) {
            continue;
        }
        sum.x += edge_form_factor(a, b);
        a = inverse_m * a;
        b = inverse_m * b;
        if (clip_edge(a, b, rim)) sum.y += edge_form_factor(a, b);
    }
    sum.y += edge_form_factor(rim.leave, rim.enter);

    float above = 0.5 + 0.5 * m.x * inversesqrt(m.x * m.x + m.z * m.z);
    sum = abs(sum) / (2.0 * PI * vec2(1.0, above));
    return AreaLight(saturate(sum.x), saturate(sum.y));
}

#endif
