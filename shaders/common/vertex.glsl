// Shared by the vertex stages that draw the model: the current vertex, and fragment_of(), which moves it to world space.
#ifndef COMMON_VERTEX_GLSL
#define COMMON_VERTEX_GLSL

#include "interface.glsl"
#include "common/to_world.glsl"

// The current vertex of the mesh: object space. Vertices are read through a buffer device address, so pipelines declare no
// vertex input.
Vertex mesh_vertex() { return draw.vertices.at[gl_VertexIndex]; }

#endif
