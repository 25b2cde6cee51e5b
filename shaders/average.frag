//@pass mean "Mean" to=mean doc="The mean of all frames since the picture last changed, in modes that accumulate"
#version 460
#include "interface.glsl"

// One frame of an accumulating mode. The blend unit mixes its color into the mean of all frames with weight 1 / n: the running
// mean (Welford 1962) m_n = m_(n-1) + (x_n - m_(n-1)) / n. Of alpha it keeps the largest, so that a flag of one frame stays.

uniform sampler2D picture;

layout(location = 0) out vec4 out_color;

void main() { out_color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0); }
