//! Suns of an environment: small bright sources of its map, which light the scene as directional lights. The bake finds them
//! (ibl/small_lights/find.glsl).

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::direction::{TexelDirections, texel_solid_angle};
use super::{BUILT_IN, Environment};
use crate::interface::{self, Light};
use crate::settings::EnvironmentSettings;

/// A sun in the environment's map. It has the layout of `SmallLight` in ibl/small_lights/list.glsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Sun {
    /// Unit vector to its center, in the map.
    pub direction: [f32; 3],
    /// Irradiance on a surface that faces it, in the unit of the environment's images.
    pub intensity: [f32; 3],
    /// Variance of its directions along one axis, radians squared.
    pub variance: f32,
}

impl Sun {
    /// The sun as a directional light, where the map has turned by an angle with this cosine and sine, and `factor` leads from the
    /// unit of the images to lux.
    pub fn light(&self, [cosine, sine]: [f32; 2], factor: f32) -> Light {
        let [x, y, z] = self.direction;
        // `world_from_map` of lighting/environment_map.glsl.
        let towards = Vec3::new(cosine * x + sine * z, y, cosine * z - sine * x);
        Light {
            position_ws: towards.extend(0.0).to_array(),
            direction_ws: (-towards).to_array(),
            kind: interface::LIGHT_DIRECTIONAL,
            intensity: (Vec3::from(self.intensity) * factor).to_array(),
            angle_offset: 1.0,
            ..Light::default()
        }
    }
}

/// Whether this built-in environment has a sun, which is known before it is baked.
pub fn has_exact_sun(name: &str) -> bool {
    name == "sky"
}

/// Whether the bake of this environment separates suns, which lighting then adds. The other built-in environments have none; for
/// a file this is unknown until it is decoded.
pub fn separates_suns(settings: &EnvironmentSettings) -> bool {
    let has_none = BUILT_IN.contains(&settings.name.as_str()) && !has_exact_sun(&settings.name);
    settings.suns && settings.is_lit() && !has_none
}

/// Distance from a sun's center within which light is its own, radians: `SUN_REACH` of ibl/small_lights/find.glsl.
const REACH: f32 = 0.02;

/// Gives suns the light that the images lack because half floats end at `limit`, after the map's values are multiplied by
/// `scale`. Such a sun is so bright that the light around it makes no difference.
pub fn restore_clipped(suns: &mut [Sun], map: &Environment, scale: f32, limit: f32) {
    if map.peak * scale <= limit {
        return;
    }
    let (width, height) = (map.width as usize, map.height as usize);
    let directions = TexelDirections::new(width, height);
    let mut sums = vec![glam::DVec3::ZERO; suns.len()];
    for (y, row) in map.pixels.chunks_exact(width.max(1)).enumerate() {
        let solid_angle = texel_solid_angle(y, width, height);
        for (&[r, g, b, _], at) in row.iter().zip(directions.row(y)) {
            // A sun beyond the range of half floats hides texels that are darker by more than their digits.
            if r.max(g).max(b) * scale < limit / 4096.0 {
                continue;
            }
            let near = suns.iter().position(|sun| Vec3::from(sun.direction).distance(at) < REACH);
            if let Some(sun) = near {
                sums[sun] += Vec3::new(r, g, b).as_dvec3() * (solid_angle * f64::from(scale));
            }
        }
    }
    for (sun, sum) in suns.iter_mut().zip(sums) {
        sun.intensity = Vec3::from(sun.intensity).max(sum.as_vec3()).to_array();
    }
}
