// Geometry of a cube map: faces +X -X +Y -Y +Z -Z, each over -1..1 (Vulkan 1.3, section 16.5.4: cube map face selection).
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

// The texel beside a face's edge, on the neighbor face: `texel` is one step outside of 0 .. side - 1 in x or in y; z is
// the face. Both rows lie along the same edge, so the way leads over the point of the edge next to both.
ivec3 texel_across_edge(ivec3 texel, int side) {
    vec2 st = clamp((vec2(texel.xy) + 0.5) * (2.0 / float(side)) - 1.0, -1.0, 1.0);
    vec3 edge = cube_position(st, uint(texel.z));
    // The other coordinate of size 1 than this face's own is the axis of the neighbor.
    int axis = texel.z / 2 == 0 ? (abs(edge.y) == 1.0 ? 1 : 2) : texel.z / 2 == 1 ? (abs(edge.x) == 1.0 ? 0 : 2)
                                                              : (abs(edge.x) == 1.0 ? 0 : 1);
    int face = 2 * axis + (edge[axis] < 0.0 ? 1 : 0);
    vec2 neighbor = axis == 0 ? vec2(-edge.z * edge.x, -edge.y)
                  : axis == 1 ? vec2(edge.x, edge.z * edge.y) : vec2(edge.x * edge.z, -edge.y);
    return ivec3(clamp(ivec2(floor((neighbor * 0.5 + 0.5) * float(side))), ivec2(0), ivec2(side - 1)), face);
}

vec2 texel_center(uvec2 texel, uvec2 size) { return (vec2(texel) + 0.5) * (2.0 / vec2(size)) - 1.0; }

// Steradians for each unit of area of the face, cos / distance^2 = (1 + s^2 + t^2)^(-3/2).
float solid_angle_density(vec2 st) {
    float inverse = inversesqrt(1.0 + dot(st, st));
    return inverse * inverse * inverse;
}

// Solid angle of a square of the face with half a side `reach`, by Gauss's rule with 2 x 2 points: 1 / sqrt(3) of the way out.
// The closed form is a difference of four arctangents, which leaves only two digits of a small texel in floats; this
// is off by 1e-8 for 64 texels a side and by 2 % for a whole face.
float solid_angle(vec2 st, float reach) {
    float d = 0.57735027 * reach;
    float sum = solid_angle_density(st + vec2(-d, -d)) + solid_angle_density(st + vec2(d, -d));
    sum += solid_angle_density(st + vec2(-d, d)) + solid_angle_density(st + vec2(d, d));
    return sum * reach * reach;
}

#endif
