// Geometry of a cube map: faces +X -X +Y -Y +Z -Z, each spanning -1..1 (Vulkan 1.3, table "Cube map face and coordinate
// selection").
#ifndef IBL_MAPS_CUBE_MAP_GLSL
#define IBL_MAPS_CUBE_MAP_GLSL

// A point on a face. st runs right and down as seen from inside. Not unit: the largest component is 1, which is all
// that a cube lookup needs.
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

// The inverse: the face in direction d, and the point on it.
uint cube_face(vec3 d, out vec2 st) {
    vec3 size = abs(d);
    if (size.x >= size.y && size.x >= size.z) {
        st = vec2(d.x > 0.0 ? -d.z : d.z, -d.y) / size.x;
        return d.x > 0.0 ? 0u : 1u;
    }
    if (size.y >= size.z) {
        st = vec2(d.x, d.y > 0.0 ? d.z : -d.z) / size.y;
        return d.y > 0.0 ? 2u : 3u;
    }
    st = vec2(d.z > 0.0 ? d.x : -d.x, -d.y) / size.z;
    return d.z > 0.0 ? 4u : 5u;
}

vec2 texel_center(uvec2 texel, uvec2 size) { return (vec2(texel) + 0.5) * (2.0 / vec2(size)) - 1.0; }

// Steradians per unit area of the face: cos / distance^2 = (1 + s^2 + t^2)^(-3/2).
float solid_angle_density(vec2 st) {
    float inverse = inversesqrt(1.0 + dot(st, st));
    return inverse * inverse * inverse;
}

// Solid angle of a square on the face, `reach` from center to edge, by 2 x 2 Gauss quadrature (nodes at 1 / sqrt(3)).
// The closed form is a difference of four arctangents, which leaves a small texel two digits in floats. The error here
// is 2e-8 for 64 texels a side and 11 % for a whole face, where only ratios matter.
float solid_angle(vec2 st, float reach) {
    float d = 0.57735027 * reach;
    float sum = solid_angle_density(st + vec2(-d, -d)) + solid_angle_density(st + vec2(d, -d));
    sum += solid_angle_density(st + vec2(-d, d)) + solid_angle_density(st + vec2(d, d));
    return sum * reach * reach;
}

#endif
