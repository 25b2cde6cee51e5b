//! The shading inputs at a pixel: from the renderer's debug modes, or from the model's file if no mode shows them.

use std::collections::BTreeMap;

use glam::DVec3;
use specula::headless::Headless;
use specula::interface;
use specula::render::Capture;
use specula::scene::{Material, Model};

use super::brdf::{Coat, Surface};
use super::film::Film;
use crate::support::render;

/// Modes that every material has.
const COMMON: [&str; 6] = ["position", "shading-normal", "geometric-normal", "base-color", "metallic", "roughness"];

/// The rendered modes, and the materials by pixel.
pub struct Inputs {
    modes: BTreeMap<&'static str, Capture>,
    materials: Vec<Material>,
    /// Index into `materials`.
    numbers: Vec<usize>,
}

/// The model with opaque colors that identify its materials.
fn numbered(model: &Model) -> Model {
    let mut model = model.clone();
    for (i, material) in std::sync::Arc::make_mut(&mut model.materials).iter_mut().enumerate() {
        *material = Material { double_sided: material.double_sided, ..Material::default() };
        material.numbers.base_color_factor = [i as f32, 0.0, 0.0, 1.0];
    }
    model
}

impl Inputs {
    /// Renders them. `model`: the one that is shown, with its pixels; `extensions`: the modes that its extensions have.
    pub fn render(headless: &mut Headless, model: &Model, extensions: &[&'static str]) -> Self {
        let mut shown = |slug: &'static str| (slug, render(headless, slug));
        let modes = COMMON.iter().chain(extensions).map(|slug| shown(slug)).collect();
        headless.set_model(numbered(model)).unwrap();
        let numbers = render(headless, "base-color").raw.iter().map(|value| value[0].round() as usize).collect();
        let materials = model.materials.to_vec();
        headless.set_model(model.clone()).unwrap();
        Self { modes, materials, numbers }
    }

    /// The pixels on the model.
    pub fn covered(&self) -> impl Iterator<Item = usize> + '_ {
        let position = &self.modes["position"].raw;
        (0..position.len()).filter(|i| position[*i][3] == 1.0)
    }

    /// The material of a pixel.
    pub fn material(&self, pixel: usize) -> &Material {
        &self.materials[self.numbers[pixel]]
    }

    /// The value of a mode that every material has.
    pub fn shown(&self, pixel: usize, slug: &str) -> DVec3 {
        let [r, g, b, _] = self.modes[slug].raw[pixel];
        DVec3::new(r.into(), g.into(), b.into())
    }

    /// The value of another mode; none if it was not rendered, or has no data at the pixel.
    pub fn extra(&self, pixel: usize, slug: &str) -> Option<DVec3> {
        (!self.modes.get(slug)?.no_data[pixel]).then(|| self.shown(pixel, slug))
    }

    /// The BRDF's inputs.
    pub fn surface(&self, pixel: usize) -> Surface {
        let number = |slug: &str| self.extra(pixel, slug).map_or(0.0, |value| value.x);
        let material = self.material(pixel);
        let n = self.shown(pixel, "shading-normal").normalize();
        let coat_n = self.extra(pixel, "clearcoat-normal").map_or(n, DVec3::normalize);
        let ior = f64::from(material.numbers.ior);
        let (f0, f90) = self.dielectric(pixel, ior);
        Surface {
            n,
            ng: self.shown(pixel, "geometric-normal").normalize(),
            base_color: self.base_color(pixel),
            metallic: self.shown(pixel, "metallic").x,
            roughness: self.shown(pixel, "roughness").x,
            ior,
            f0,
            f90,
            emissive: DVec3::from(material.numbers.emissive_factor.map(f64::from)),
            t: self.extra(pixel, "anisotropy-direction"),
            anisotropy: number("anisotropy"),
            coat: Coat { n: coat_n, factor: number("clearcoat"), roughness: number("clearcoat-roughness") },
            sheen_color: self.extra(pixel, "sheen-color").unwrap_or_default(),
            sheen_roughness: number("sheen-roughness"),
            film: Film {
                strength: number("iridescence"),
                ior: material.numbers.iridescence_ior.into(),
                thickness: 1e3 * number("iridescence-thickness"),
                // A partial coat counts as an index in between.
                outside: 1.0 + 0.5 * number("clearcoat"),
            },
            transmission: number("transmission"),
            diffuse_transmission: number("diffuse-transmission"),
            diffuse_transmission_color: self.extra(pixel, "diffuse-transmission-color").unwrap_or(DVec3::ONE),
            attenuation: self.attenuation(pixel),
        }
    }

    /// KHR_materials_pbrSpecularGlossiness: `c_diff`, from the file if there is no texture.
    fn base_color(&self, pixel: usize) -> DVec3 {
        let material = self.material(pixel);
        if !material.specular_glossiness || material.textures.iter().any(Option::is_some) {
            return self.shown(pixel, "base-color");
        }
        let specular = DVec3::from(material.numbers.specular_color.map(f64::from));
        let [r, g, b, _] = material.numbers.base_color_factor.map(f64::from);
        DVec3::new(r, g, b) * (1.0 - specular.max_element())
    }

    /// F0 and F90 of the dielectric: from the file if there are no textures, else from the modes.
    fn dielectric(&self, pixel: usize, ior: f64) -> (DVec3, f64) {
        let material = self.material(pixel);
        let textures =
            [interface::TEXTURE_SPECULAR, interface::TEXTURE_SPECULAR_COLOR, interface::TEXTURE_METALLIC_ROUGHNESS];
        if textures.iter().any(|texture| material.textures[*texture as usize].is_some()) {
            let f90 = self.extra(pixel, "specular-factor").map_or(1.0, |factor| factor.x);
            let plain = DVec3::splat(((ior - 1.0) / (ior + 1.0)).powi(2));
            return (self.extra(pixel, "specular-color").unwrap_or(plain), f90);
        }
        let color = DVec3::from(material.numbers.specular_color.map(f64::from));
        // KHR_materials_pbrSpecularGlossiness: `specular` is F0 itself.
        if material.specular_glossiness {
            return (color, 1.0);
        }
        let weight = f64::from(material.numbers.specular_factor);
        let f0 = color * ((1.0 - ior) / (1.0 + ior)).powi(2);
        (f0.min(DVec3::ONE) * weight, weight)
    }

    /// Transmittance of KHR_materials_volume: attenuationColor^(thickness / attenuationDistance).
    fn attenuation(&self, pixel: usize) -> DVec3 {
        let shown = (self.extra(pixel, "thickness"), self.extra(pixel, "attenuation-color"));
        let (Some(thickness), Some(color)) = shown else { return DVec3::ONE };
        color.powf(thickness.x / f64::from(self.material(pixel).numbers.attenuation_distance))
    }
}
