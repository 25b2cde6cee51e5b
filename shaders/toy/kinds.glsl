// Reads of a channel without a file as if it were a cube map or a volume, which a file alone does not tell.
#ifndef TOY_KINDS_GLSL
#define TOY_KINDS_GLSL

vec2 toy_flat(vec3 place) { return place.xy + 0.37 * place.z; }

vec4 texture(sampler2D image, vec3 place) { return texture(image, toy_flat(place)); }
vec4 texture(sampler2D image, vec3 place, float bias) { return texture(image, toy_flat(place), bias); }
vec4 textureLod(sampler2D image, vec3 place, float lod) { return textureLod(image, toy_flat(place), lod); }
vec4 texelFetch(sampler2D image, ivec3 place, int lod) { return texelFetch(image, (place.xy + place.z) & 255, lod); }

#endif
