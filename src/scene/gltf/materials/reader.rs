//! Reads the members of one material extension.

use std::ops::RangeInclusive;

use super::textures::{Collector, TextureSlot};
use crate::scene::error::Problem;
use crate::scene::gltf::left_out::Part;
use crate::scene::gltf::values::{Extensions, Fields};
use crate::scene::material::Material;

/// An extension of a material in a file.
pub struct Reader<'a, 'root> {
    /// The material that takes its values.
    pub material: &'a mut Material,
    /// Takes its textures and warnings.
    pub collector: &'a mut Collector<'root>,
    /// Its members.
    pub fields: Fields<'a>,
    /// All extensions of the material.
    pub others: &'a Extensions,
}

impl Reader<'_, '_> {
    /// Whether the material has an extension of this name.
    pub fn has(&self, name: &str) -> bool {
        self.others.contains_key(name)
    }

    /// A number, 0..1.
    pub fn unit(&mut self, key: &str, default: f32) -> Result<f32, Problem> {
        self.within(key, default, 0.0..=1.0)
    }

    /// A number in a range.
    pub fn within(&mut self, key: &str, default: f32, range: RangeInclusive<f32>) -> Result<f32, Problem> {
        self.fields.clamped(key, default, range, &mut self.collector.warnings)
    }

    /// A number that has been checked, or its default.
    pub fn or_default(&mut self, key: &str, checked: Result<f32, Problem>, default: f32) -> f32 {
        self.collector.left_out.unless(Part::NUMBER, &self.fields.at(key), checked).unwrap_or(default)
    }

    /// Numbers, each 0..1.
    pub fn unit_all<const N: usize>(&mut self, key: &str, default: [f32; N]) -> Result<[f32; N], Problem> {
        self.fields.clamped_all(key, default, 0.0..=1.0, &mut self.collector.warnings)
    }

    /// A number that is not negative.
    pub fn at_least_0(&mut self, key: &str, default: f32) -> Result<f32, Problem> {
        self.within(key, default, 0.0..=f32::MAX)
    }

    /// Numbers that are not negative.
    pub fn all_at_least_0<const N: usize>(&mut self, key: &str, default: [f32; N]) -> Result<[f32; N], Problem> {
        self.fields.clamped_all(key, default, 0.0..=f32::MAX, &mut self.collector.warnings)
    }

    /// The texture at a member, as `interface::TEXTURE_*`.
    pub fn texture(&mut self, key: &str, texture: u32) {
        let slot = TextureSlot::of(&self.fields, key);
        self.collector.bind(self.material, texture, slot, &self.fields.at(key));
    }
}
