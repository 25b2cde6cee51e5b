// Octahedral maps: all directions in one square, the upper hemisphere in its inner diamond and the lower one in its
// corners (Engelhardt & Dachsbacher 2008; Cigolle et al. 2014, "A Survey of Efficient Representations for Independent
// Unit Vectors"). A lookup reads a plain image, without choosing a face first, and all levels of roughness fit into one image
// with any sizes.
#ifndef IBL_MAPS_OCTAHEDRAL_GLSL
#define IBL_MAPS_OCTAHEDRAL_GLSL

#include "interface.glsl"

vec2 with_sign_of(float x, vec2 p) { return vec2(p.x < 0.0 ? -x : x, p.y < 0.0 ? -x : x); }

// The point of the square, -1..1, for a direction of any length: d projected onto the octahedron |x| + |y| + |z| = 1, seen
// from above, with the lower half folded outwards.
vec2 octahedral_point(vec3 d) {
    d /= abs(d.x) + abs(d.y) + abs(d.z);
    return d.xz + with_sign_of(max(-d.y, 0.0), d.xz);
}

// The inverse. Each edge of the square meets its own other half, so a point just outside is the point just inside on the
// other side of the edge's center.
vec3 octahedral_direction(vec2 p) {
    if (abs(p.x) > 1.0) p = vec2(2.0 * sign(p.x) - p.x, -p.y);
    if (abs(p.y) > 1.0) p = vec2(-p.x, 2.0 * sign(p.y) - p.y);
    float y = 1.0 - abs(p.x) - abs(p.y);
    return normalize(vec3(p - with_sign_of(max(-y, 0.0), p), y).xzy);
}

// A square of an image that holds a map, in texels. The square -1..1 ends one texel before the edge, so a bilinear lookup
// never reads beyond the tile. The texels of that border hold what lies beyond the square.
struct Tile {
    vec2 corner;
    float side;
};

vec2 place_in_tile(vec2 p, Tile tile) { return tile.corner + 0.5 * tile.side + p * (0.5 * tile.side - 1.0); }

// The center of a texel as a point of the square.
vec2 point_of_texel(ivec2 texel, Tile tile) {
    return (vec2(texel) + 0.5 - tile.corner - 0.5 * tile.side) / (0.5 * tile.side - 1.0);
}

// Whether the tile contains the center of the texel. Corner and side need not be whole numbers.
bool contains(Tile tile, ivec2 texel) {
    vec2 place = vec2(texel) + 0.5 - tile.corner;
    return all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, vec2(tile.side)));
}

Tile irradiance_tile() { return Tile(vec2(0.0), float(IRRADIANCE_SIDE)); }

#endif
