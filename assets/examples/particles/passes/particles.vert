#version 460
#include "interface.glsl"
#include "passes/particle.glsl"

// A square that faces the camera, for each particle. Two triangles have the corners 0 to 5.

readonly buffer Particles { Particle particles[PARTICLES]; };

uniform ParticlesLook {
    float particles_size;      //@ui "Size" 0.001..0.03 doc="Radius of a particle, in radii of the model's bounds" = 0.0045
};

layout(location = 0) out vec2 corner;        // -1..1 across the square
layout(location = 1) out flat float age;     // 0 at birth .. 1 at death

const vec2 CORNERS[6] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, -1), vec2(1, 1), vec2(-1, 1));

void main() {
    Particle p = particles[gl_InstanceIndex];
    corner = CORNERS[gl_VertexIndex];
    age = p.age_s / max(p.life_s, 1e-3);
    // The camera's right and up are the first two rows of its rotation.
    mat3 world_from_view = transpose(mat3(frame.view_from_world));
    vec3 offset = world_from_view * vec3(corner * particles_size * frame.scene_radius, 0.0);
    gl_Position = frame.clip_from_world * vec4(p.position_ws + offset, 1.0);
}
