// The hook into the vertex stage: the model hops.
#ifndef USER_VERTEX_GLSL
#define USER_VERTEX_GLSL

#include "interface.glsl"
#include "user/params.glsl"

void user_vertex(inout Vertex vertex) {
    vertex.position.x += 0.35 * sin(2.0 * frame.time_s);
    vertex.position.y += 0.3 * abs(sin(4.0 * frame.time_s));
}

#endif
