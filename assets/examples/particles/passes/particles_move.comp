//@pass particles_move "Particles: motion" dispatch=64 size=1x1 doc="Moves 16384 particles, which stay in a buffer from frame to frame"
#version 460
#include "interface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "passes/particle.glsl"

// A ring of particles around the model. Each is pulled to the model's center and goes around it, as the bodies of Saturn's rings do,
// and drifts with an Arnold-Beltrami-Childress flow, which has no sources and chaotic paths (Dombre et al. 1986, "Chaotic streamlines
// in the ABC flows", equation 1.1 with A = B = C). Semi-implicit Euler steps: velocity first, so that orbits keep their energy.
//
// Limits: particles pass through the model, and do not see each other. Steps of more than 50 ms count as 50 ms.

layout(local_size_x = 256) in;

buffer Particles { Particle particles[PARTICLES]; };

uniform ParticlesMove {
    float particles_speed;     //@ui "Speed" 0..3 unit="radii/s" doc="At a distance of one radius of the model's bounds" = 0.6
    float particles_drift;     //@ui "Drift" 0..3 unit="radii/s^2" doc="How strongly the flow pulls the particles out of the ring" = 0.15
    float particles_detail;    //@ui "Detail" 0.5..8 doc="Whirls of the flow along a radius" = 3
};

// The axis of the ring, unit.
const vec3 AXIS = vec3(0.259, 0.951, 0.169);

// The flow at a point: in radii of the model's bounds from its center. About unit length.
vec3 flow(vec3 at) {
    vec3 x = particles_detail * at + 0.4 * frame.time_s;
    return 0.6 * vec3(sin(x.z) + cos(x.y), sin(x.x) + cos(x.z), sin(x.y) + cos(x.x));
}

// A particle on a circle in the ring's plane, for birth number `birth`.
Particle born(uint i, uint birth) {
    vec3 random = random_numbers(uvec3(i, birth, 11u));
    mat3 plane = basis_around(AXIS);
    float distance = mix(0.75, 1.1, random.y);
    vec3 outward = plane * vec3(cos(2.0 * PI * random.x), sin(2.0 * PI * random.x), 0.0);
    vec3 velocity = cross(AXIS, outward) * particles_speed * inversesqrt(distance);
    float life_s = mix(3.0, 9.0, random.z);
    return Particle(frame.scene_center_ws + frame.scene_radius * distance * outward, 0.0, frame.scene_radius * velocity, life_s);
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    Particle p = particles[i];
    if (p.life_s == 0.0) {
        // Random ages, so that the first picture has young and old particles.
        p = born(i, 0u);
        p.age_s = p.life_s * random_numbers(uvec3(i, 0u, 13u)).x;
    }
    float step_s = min(frame.delta_s, 0.05);
    p.age_s += step_s;
    if (p.age_s > p.life_s) p = born(i, frame.frame_index + 1u);
    vec3 at = (p.position_ws - frame.scene_center_ws) / frame.scene_radius;
    float distance = max(length(at), 0.2);
    // The pull of a mass in the center, of which a circular orbit at distance 1 has the speed.
    vec3 pull = -at * (particles_speed * particles_speed) / (distance * distance * distance) + particles_drift * flow(at);
    p.velocity_ws += step_s * frame.scene_radius * pull;
    p.position_ws += step_s * p.velocity_ws;
    particles[i] = p;
}
