#version 460
#include "common/model.geom.glsl"

// Draws a line from each corner of a triangle along its normal. A vertex that several triangles share gets the same line from
// each of them.

uniform Normals {
    float normals_length;    //@ui "Length of normals" 0..0.3 = 0.04
};

layout(line_strip, max_vertices = 6) out;

void main() {
    for (int i = 0; i < 3; ++i) {
        copy_corner(i);
        EmitVertex();
        copy_corner(i);
        move_to(fragment.position_ws + normals_length * frame.scene_radius * fragment.normal_ws);
        EmitVertex();
        EndPrimitive();
    }
}
