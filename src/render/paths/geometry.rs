//! The triangles of a scene in world space, in the order of the leaves of their bounding volume hierarchy.

use glam::{Mat3, Vec3, Vec4};

use super::PathTracingError;
use crate::frame::Scene;
use crate::gpu::PrimitiveClass;
use crate::interface::{ATTRIBUTE_COLOR, BvhNode, TracedCorners, TracedTriangle, Vertex};
use crate::render::scene::normals_from;
use crate::scene::{Bvh, Instance, Material, triangles};

/// Most triangles that can be traced. Nodes, triangles and corners then take up to 128 MiB each, the largest storage buffer that
/// every Vulkan device supports.
pub(super) const MOST_TRIANGLES: usize = 1 << 21;

/// The geometry that path tracing intersects.
#[derive(Default)]
pub(super) struct Geometry {
    pub(super) nodes: Vec<BvhNode>,
    pub(super) triangles: Vec<TracedTriangle>,
    pub(super) corners: Vec<TracedCorners>,
}

impl Geometry {
    /// The triangles of all instances that the scene draws; points and lines have none. `TracedCorners::material` is an index
    /// into the model's materials, or their number for the material override.
    pub(super) fn new(scene: &Scene) -> Result<Self, PathTracingError> {
        let model = scene.model();
        let replacement = scene.replacement();
        let (mut positions, mut corners) = (Vec::new(), Vec::new());
        for instance in scene.visible_instances() {
            let appearance = scene.appearance(instance, replacement.as_ref());
            if appearance.variant.class != PrimitiveClass::Triangles {
                continue;
            }
            let index = appearance.material.unwrap_or(model.materials.len());
            let own = appearance.material.map(|index| scene.material(index));
            let Some(material) = own.or(replacement.as_ref()) else { continue };
            let primitive = &model.primitives[instance.primitive];
            let placed = Placed::new(instance, material, index as u32, appearance.attributes & ATTRIBUTE_COLOR != 0);
            let indices = triangles(primitive.topology, &primitive.indices);
            if positions.len() + indices.len() > MOST_TRIANGLES {
                return Err(PathTracingError::TooManyTriangles { most: MOST_TRIANGLES });
            }
            let deformed = model.vertices(instance);
            for triangle in indices {
                let vertices = triangle.map(|index| &deformed[index as usize]);
                positions.push(vertices.map(|vertex| placed.position(vertex)));
                corners.push(placed.corners(vertices));
            }
        }
        let Bvh { nodes, order } = Bvh::new(&positions);
        let triangle = |index: &u32| {
            let [a, b, c] = positions[*index as usize];
            let [corner_ws, edge_1_ws, edge_2_ws] = [a, b - a, c - a].map(|v| v.to_array());
            TracedTriangle { corner_ws, edge_1_ws, edge_2_ws }
        };
        Ok(Self {
            nodes,
            triangles: order.iter().map(triangle).collect(),
            corners: order.iter().map(|index| corners[*index as usize]).collect(),
        })
    }
}

/// An instance with its transforms.
struct Placed<'a> {
    instance: &'a Instance,
    normals: Mat3,
    material: u32,
    /// TEXCOORD set of the material's textures.
    uv_set: u32,
    has_colors: bool,
}

impl<'a> Placed<'a> {
    fn new(instance: &'a Instance, material: &Material, index: u32, has_colors: bool) -> Self {
        let normals = normals_from(Mat3::from_mat4(instance.world_from_object));
        Self { instance, normals, material: index, uv_set: super::materials::uv_set(material), has_colors }
    }

    fn position(&self, vertex: &Vertex) -> Vec3 {
        self.instance.world_from_object.transform_point3(vertex.position.into())
    }

    fn corners(&self, vertices: [&Vertex; 3]) -> TracedCorners {
        let uv = |vertex: &Vertex| if self.uv_set == 0 { vertex.uv0 } else { vertex.uv1 };
        let color = |vertex: &Vertex| if self.has_colors { vertex.color.into() } else { Vec4::ONE };
        TracedCorners {
            normals_ws: vertices.map(|vertex| octahedral(self.normals * Vec3::from(vertex.normal))),
            colors: vertices.map(|vertex| unorm_4x8(color(vertex))),
            uv_0: uv(vertices[0]),
            uv_1: uv(vertices[1]),
            uv_2: uv(vertices[2]),
            material: self.material,
        }
    }
}

/// A direction as two signed 16-bit numbers: the octahedron |x| + |y| + |z| = 1 unfolded to a square (Meyer et al. 2010, "On
/// Floating-Point Normal Vectors"). A zero vector becomes +Z.
fn octahedral(n: Vec3) -> u32 {
    let n = n / n.abs().element_sum().max(f32::MIN_POSITIVE);
    let sign = |x: f32| if x < 0.0 { -1.0 } else { 1.0 };
    let [x, y] = if n.z < 0.0 { [(1.0 - n.y.abs()) * sign(n.x), (1.0 - n.x.abs()) * sign(n.y)] } else { [n.x, n.y] };
    let snorm = |x: f32| u32::from((x.clamp(-1.0, 1.0) * 32767.0).round() as i16 as u16);
    snorm(x) | snorm(y) << 16
}

fn unorm_4x8(color: Vec4) -> u32 {
    let byte = |x: f32| (x.clamp(0.0, 1.0) * 255.0).round() as u32;
    byte(color.x) | byte(color.y) << 8 | byte(color.z) << 16 | byte(color.w) << 24
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `unpackSnorm2x16` and the folding of shaders/paths/scene.glsl.
    fn decoded(packed: u32) -> Vec3 {
        let part = |bits: u32| (f32::from(bits as u16 as i16) / 32767.0).max(-1.0);
        let (x, y) = (part(packed), part(packed >> 16));
        let z = 1.0 - x.abs() - y.abs();
        let fold = (-z).max(0.0);
        let away = |x: f32| if x >= 0.0 { x - fold } else { x + fold };
        Vec3::new(away(x), away(y), z).normalize()
    }

    #[test]
    fn octahedral_normals_are_exact_to_a_ten_thousandth() {
        for i in 0..1000u32 {
            let hash = |k: u32| (i * 3 + k).wrapping_mul(2_654_435_761) as f32 / u32::MAX as f32 - 0.5;
            let n = Vec3::new(hash(0), hash(1), hash(2)).normalize();
            assert!(decoded(octahedral(3.0 * n)).distance(n) < 1e-4, "{n}");
        }
        for axis in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z] {
            assert_eq!(decoded(octahedral(axis)), axis);
        }
        assert_eq!(decoded(octahedral(Vec3::ZERO)), Vec3::Z);
    }
}
