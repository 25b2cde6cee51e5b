// A particle, and how many there are. The buffer of the three stages has the same members everywhere.
#ifndef PASSES_PARTICLE_GLSL
#define PASSES_PARTICLE_GLSL

struct Particle {
    vec3 position_ws;          // World space.
    float age_s;               // Seconds since its birth.
    vec3 velocity_ws;          // Meters a second.
    float life_s;              // Seconds from birth to death; 0 before the first frame.
};

// instances= in particles.frag, and dispatch= times local_size_x in particles_move.comp.
const uint PARTICLES = 16384u;

#endif
