#version 460
#include "common/model.tesc.glsl"
#include "user/params.glsl"

// Divides the triangles of the model into small ones, which pbr.tese turns into rock.
void main() { divide_edges(part_px); }
