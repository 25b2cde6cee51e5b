// The hook into the picture behind the model. By default it changes nothing.
#ifndef USER_BACKGROUND_GLSL
#define USER_BACKGROUND_GLSL

#include "interface.glsl"
#include "user/params.glsl"

// The environment where nothing covers it (--background env). `radiance`, cd/m^2: what the environment shows there, sharp
// or blurred. `direction_ws`: from the eye, unit. The light on the model does not change with it.
vec3 user_background(vec3 direction_ws, vec3 radiance) {
    return radiance;
}

#endif
