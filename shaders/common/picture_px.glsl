// Where a fragment of the model is in the picture.
#ifndef COMMON_PICTURE_PX_GLSL
#define COMMON_PICTURE_PX_GLSL

#include "interface.glsl"

// Pixels from the upper left corner of the picture. The model's target begins there, unless the window reads a few pixels
// alone: then the target begins at these, and the origin of the picture is negative.
vec2 picture_px() { return gl_FragCoord.xy - min(frame.viewport_origin_px, vec2(0.0)); }

#endif
