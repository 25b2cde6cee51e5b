// Finds where a ray hits the model: walks a bounding volume hierarchy, nearest children first.
//
// Rust builds the hierarchy (src/scene/bvh.rs). Each node is a box around its two children, or around the triangles of a
// leaf. A ray that misses the box misses all that is inside.
#ifndef PATHS_BVH_GLSL
#define PATHS_BVH_GLSL

#include "interface.glsl"
#include "paths/scene.glsl"

layout(set = SET_FRAME, binding = BINDING_BVH, scalar) readonly buffer BoundingVolumes { BvhNode bvh[]; };

const float NO_HIT = 3.4e38;

// 1 / d for each axis, finite. With a d of 0, a ray that starts on a face of a box would have a distance of 0 times infinity
// to it, a NaN, of which min and max are undefined. 1e-20 is far below the rounding errors of a unit vector, and its inverse
// times a distance of less than 1e18 m is finite.
vec3 inverse_of(vec3 d) { return 1.0 / mix(d, vec3(1e-20), lessThan(abs(d), vec3(1e-20))); }

// Distance at which the ray enters the box, or NO_HIT if it misses it or enters beyond `farthest`. The slabs of the three
// axes overlap inside the box (Kay & Kajiya 1986).
//
// All factors are finite (inverse_of), so no product is a NaN. The boxes are 1e-10 m larger, so that a ray along a box's face
// is inside of that face's slab. `leave` is 2 ulp larger, so that rounding does not let a ray pass between two boxes (Ize
// 2013, "Robust BVH Ray Traversal").
float box_distance(BvhNode node, vec3 origin, vec3 inverse_direction, float farthest) {
    vec3 low = (node.min_ws - origin - 1e-10) * inverse_direction;
    vec3 high = (node.max_ws - origin + 1e-10) * inverse_direction;
    float enter = max(max_component(min(low, high)), 0.0);
    float leave = min(min_component(max(low, high)) * 1.00000024, farthest);
    return enter <= leave ? enter : NO_HIT;
}

// Moller & Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection", from both sides. A degenerate triangle has a
// determinant of 0, and the infinities or NaNs that follow fail the comparisons.
bool hits_triangle(Ray ray, uint index, float farthest, out Hit hit) {
    TracedTriangle t = traced_triangles[index];
    vec3 p = cross(ray.direction_ws, t.edge_2_ws);
    float inverse = 1.0 / dot(t.edge_1_ws, p);
    vec3 from_corner = ray.origin_ws - t.corner_ws;
    vec3 q = cross(from_corner, t.edge_1_ws);
    hit.uv = vec2(dot(from_corner, p), dot(ray.direction_ws, q)) * inverse;
    hit.distance = dot(t.edge_2_ws, q) * inverse;
    hit.triangle = index;
    return hit.uv.x >= 0.0 && hit.uv.y >= 0.0 && hit.uv.x + hit.uv.y <= 1.0
        && hit.distance > 0.0 && hit.distance < farthest;
}

// The nearest hit closer than `farthest`, or with `any_hit` the first one found, which is all that a shadow needs. Returns
// false if nothing stops the ray.
bool trace(Ray ray, float farthest, bool any_hit, out Hit nearest) {
    vec3 inverse_direction = inverse_of(ray.direction_ws);
    nearest = Hit(farthest, 0u, vec2(0.0));
    bool found = false;
    uint waiting[MAX_BVH_DEPTH];
    uint count = 0u;
    uint at = 0u;
    while (true) {
        BvhNode node = bvh[at];
        bool is_leaf = node.count > 0u || node.first == 0u;
        for (uint i = node.first; i < node.first + node.count; ++i) {
            Hit hit;
            if (hits_triangle(ray, i, nearest.distance, hit) && stops_ray(ray, hit, random_numbers(uvec3(ray.seed, i, 2u)).x)) {
                nearest = hit;
                found = true;
            }
        }
        if (found && any_hit) return true;

        // Goes on with the nearer child, and remembers the other.
        float left = NO_HIT;
        float right = NO_HIT;
        if (!is_leaf) {
            left = box_distance(bvh[node.first], ray.origin_ws, inverse_direction, nearest.distance);
            right = box_distance(bvh[node.first + 1u], ray.origin_ws, inverse_direction, nearest.distance);
        }
        if (min(left, right) < NO_HIT) {
            bool left_first = left <= right;
            at = node.first + (left_first ? 0u : 1u);
            if (max(left, right) < NO_HIT) waiting[count++] = node.first + (left_first ? 1u : 0u);
        } else {
            if (count == 0u) return found;
            at = waiting[--count];
        }
    }
}

#endif
