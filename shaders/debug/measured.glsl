// Modes of the group Measured: shading with a measured BRDF (brdf/measured.glsl), next to the material's own.
#ifndef DEBUG_MEASURED_GLSL
#define DEBUG_MEASURED_GLSL

#include "interface.glsl"
#include "brdf/horizon.glsl"
#include "brdf/measured.glsl"
#include "brdf/surface.glsl"
#include "common/color.glsl"
#include "common/fragment.glsl"
#include "common/picture_px.glsl"
#include "debug/absent.glsl"
#include "debug/modes.glsl"
#include "lighting/punctual.glsl"
#include "lighting/shade.glsl"
#include "material/material.glsl"

struct MeasuredLight {
    vec3 radiance;             // towards the eye
    float irradiance;          // its luminance
};

// The sum over punctual lights, as in lighting/shade.glsl. An anisotropic material's grain follows the mesh's tangents.
MeasuredLight measured_light(Fragment f, Surface s, vec3 v, LightRange range) {
    vec3 t = f.tangent_ws.xyz;
    vec3 b = bitangent_ws(f);
    MeasuredLight sum = MeasuredLight(vec3(0.0), 0.0);
    for (uint i = range.first; i < range.end; ++i) {
        Light light = light_at(i, s.position_ws);
        if (light.kind == LIGHT_RECT) continue;
        Illumination arriving = illuminate(light, s.position_ws);
        vec3 irradiance = arriving.irradiance * (saturate(dot(s.n, arriving.l)) * bump_visibility(s.ng, s.n, arriving.l));
        sum.radiance += f_measured(arriving.l, v, s.n, t, b) * irradiance;
        sum.irradiance += luminance(irradiance);
    }
    return sum;
}

// `left` and `right` of the center of the view, with a white line two pixels wide between them.
vec3 split(vec3 left, vec3 right) {
    float x = picture_px().x - 0.5 * frame.viewport_px.x;
    if (abs(x) < 1.0) return vec3(1.0 / frame.exposure);
    return x < 0.0 ? left : right;
}

// The error of the mean f over the lights, weighted by irradiance. Undefined in shadow.
vec3 measured_error(MeasuredLight measured, vec3 analytic) {
    if (measured.irradiance <= 0.0) return if_present(false, vec3(0.0));
    return relative_error_color(measured.radiance / measured.irradiance, analytic / measured.irradiance);
}

bool debug_measured(Fragment f, Surface s, vec3 v, Lit lit, out vec3 value) {
    if (MODE != MODE_MEASURED && MODE != MODE_MEASURED_SPLIT && MODE != MODE_MEASURED_ERROR) return false;
    LightRange range = chosen_lights();
    MeasuredLight measured = measured_light(f, s, v, range);
    if (MODE == MODE_MEASURED) value = measured.radiance;
    else if (MODE == MODE_MEASURED_SPLIT) value = split(measured.radiance, lit.punctual.all);
    else value = measured_error(measured, lit.punctual.all);
    value = if_present(measured_kind != MEASURED_NONE && !is_empty(range), value);
    return true;
}

#endif
