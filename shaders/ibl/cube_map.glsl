// Geometry of a cube map: faces +X -X +Y -Y +Z -Z, each over -1..1 (Vulkan 1.3, table "Cube map face and coordinate
// selection").
#ifndef IBL_CUBE_MAP_GLSL
#define IBL_CUBE_MAP_GLSL

// From the center to a point of the face: st runs right and down as seen from inside. Not of unit length: its largest
// component is 1, and a cube map's lookup needs no more.
vec3 cube_position(vec2 st, uint face) {
    switch (face) {
        case 0u: return vec3(1.0, -st.y, -st.x);
        case 1u: return vec3(-1.0, -st.y, st.x);
        case 2u: return vec3(st.x, 1.0, st.y);
        case 3u: return vec3(st.x, -1.0, -st.y);
        case 4u: return vec3(st.x, -st.y, 1.0);
        default: return vec3(-st.x, -st.y, -1.0);
    }
}

vec2 texel_center(uvec2 texel, uvec2 size) { return (vec2(texel) + 0.5) * (2.0 / vec2(size)) - 1.0; }

// Steradians for each unit of area of the face, cos / distance^2 = (1 + s^2 + t^2)^(-3/2).
float solid_angle_density(vec2 st) {
    float inverse = inversesqrt(1.0 + dot(st, st));
    return inverse * inverse * inverse;
}

// Solid angle of a square of the face with half a side `reach`, by Gauss's rule with 2 x 2 points: 1 / sqrt(3) of the
// way out. The closed form is a difference of four arctangents, which leaves only two digits of a small texel in
// floats; this is off by 2e-8 for 64 texels a side, and by 11 % for a
// whole face, of which only ratios are needed.
float solid_angle(vec2 st, float reach) {
    float d = 0.57735027 * reach;
    float sum = solid_angle_density(st + vec2(-d, -d)) + solid_angle_density(st + vec2(d, -d));
    sum += solid_angle_density(st + vec2(-d, d)) + solid_angle_density(st + vec2(d, d));
    return sum * reach * reach;
}

#endif
