//! The inspector: the pinned pixel, its value in every mode, and the curves of its material. The panel shows it, the screen reads it from
//! the device, and the viewer measures the curves.

pub(super) mod directions;
pub(super) mod text;

use std::collections::BTreeMap;

use serde_json::Value;

use crate::interface::Light;
use crate::measure::{Curves, Material};
use crate::render::Texel;
use crate::scene::CameraView;
use crate::shader::not_finite::NotFinite;
use crate::shader::{Mode, PixelValue};

use directions::Directions;

/// Page that the inspector panel shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Page {
    /// The value in every mode.
    #[default]
    Values,
    /// The lobe and the albedo of the material.
    Lobe,
}

impl Page {
    pub(super) const ALL: [Self; 2] = [Self::Values, Self::Lobe];

    /// Its name, and what it shows.
    pub(super) fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Values => ("Values", "The value of this pixel in every mode, before exposure, in world space"),
            Self::Lobe => ("BRDF", "The lobe and the albedo of this pixel's material, from your GLSL"),
        }
    }
}

/// State of the inspector. Nothing is read or measured while its panel is out of sight.
#[derive(Default)]
pub(super) struct Inspector {
    /// Whether the panel is in sight in this frame.
    pub(super) is_visible: bool,
    /// The pixel that the user has clicked.
    pub(super) pin: Option<[u32; 2]>,
    /// Whether a message has said that the panel reads pixels.
    pub(super) was_mentioned: bool,
    /// Whether the pixel under the mouse is shown while none is pinned.
    pub(super) follows: bool,
    pub(super) page: Page,
    pub(super) search: String,
    /// The newest values, also while newer ones are being read.
    pub(super) reading: Option<Reading>,
    /// Inputs of the newest request for curves.
    pub(super) asked: Option<Asked>,
    pub(super) curves: Option<Shown>,
    /// The search for the first statement that makes NaN or infinity at the pinned pixel.
    pub(super) search_not_finite: Option<NotFiniteSearch>,
    /// How far the user has turned the lobe in space, degrees.
    pub(super) turn_deg: f32,
}

impl Inspector {
    /// Learns that the search has failed. The same search would fail again, so it is not repeated.
    pub(super) fn fail_search(&mut self) {
        if let Some(search) = &mut self.search_not_finite {
            let found = Err("the search failed".to_owned());
            search.found = Some(NotFinite { mode: search.mode.clone(), found });
        }
    }

    /// Whether a pixel is pinned, and the user sees it.
    pub(super) fn is_pinned(&self) -> bool {
        self.is_visible && self.pin.is_some()
    }

    /// Unpins the pixel. Its values go, unless the pixel under the mouse takes its place.
    pub(super) fn unpin(&mut self) {
        (self.pin, self.search_not_finite) = (None, None);
        if !self.follows {
            (self.reading, self.asked, self.curves) = (None, None, None);
        }
    }
}

/// A search for the first statement that makes NaN or infinity.
#[derive(Clone, Debug)]
pub(super) struct NotFiniteSearch {
    /// Number of the request.
    pub(super) number: u64,
    /// Slug of the mode.
    pub(super) mode: String,
    /// The result; none while the search goes on.
    pub(super) found: Option<NotFinite>,
}

/// The values of a pixel.
#[derive(Clone, Debug)]
pub(super) struct Reading {
    /// Pixels from the upper left corner of the picture.
    pub(super) at: [u32; 2],
    /// Value by slug of the mode, with the number of the picture that it was read from.
    pub(super) values: BTreeMap<String, (PixelValue, u64)>,
    /// Number of the picture that values are read from.
    pub(super) picture: u64,
    /// Whether all modes were read from that picture.
    pub(super) is_complete: bool,
    /// Factor from a value before exposure to one after it.
    pub(super) exposure: f32,
    /// The camera and the lights of the picture, world space.
    pub(super) camera: CameraView,
    pub(super) lights: Vec<Light>,
    /// Names of the node and of the material, if the pixel shows a surface of the model.
    pub(super) names: Option<[String; 2]>,
    /// The texels of the material's textures, once they are read.
    pub(super) texels: Vec<Texel>,
}

impl Reading {
    /// The value of a mode, if it was read.
    pub(super) fn value(&self, slug: &str) -> Option<PixelValue> {
        self.values.get(slug).map(|(value, _)| *value)
    }

    /// The values of these modes that were read, in JSON.
    pub(super) fn json<'a>(&'a self, modes: &'a [Mode]) -> impl Iterator<Item = (String, Value)> + 'a {
        modes.iter().filter_map(|mode| Some((mode.slug.clone(), self.value(&mode.slug)?.json(mode))))
    }

    /// Whether the value of a mode is that of an earlier picture.
    pub(super) fn is_old(&self, slug: &str) -> bool {
        self.values.get(slug).is_none_or(|(_, picture)| *picture != self.picture)
    }

    /// The three numbers of a mode that has data here.
    pub(super) fn numbers(&self, slug: &str) -> Option<[f32; 3]> {
        let value = self.value(slug).filter(|value| !value.no_data && !value.not_finite)?;
        // Color is multiplied by coverage.
        let [r, g, b, coverage] = value.value;
        (coverage > 0.0).then(|| [r, g, b].map(|number| number / coverage))
    }

    /// Whether the model covers the pixel. Only modes that draw no background tell.
    pub(super) fn is_hit(&self) -> bool {
        const WITHOUT_BACKGROUND: [&str; 3] = ["position", "depth", "shading-normal"];
        let covers = |value: PixelValue| value.value[3] > 0.0 || value.no_data || value.not_finite;
        WITHOUT_BACKGROUND.iter().filter_map(|slug| self.value(slug)).any(covers)
    }

    /// The normal, and the directions to the eye and to the light of this number, from 1; 0 is light 1 too.
    pub(super) fn directions(&self, light: u32) -> Option<Directions> {
        self.directions_to(self.light_of(light)?)
    }

    /// Index of the light that is meant: of all (0), the one nearest to the normal.
    pub(super) fn light_of(&self, light: u32) -> Option<usize> {
        if light > 0 {
            return Some(light as usize - 1);
        }
        let angles = (0..self.lights.len()).filter_map(|index| Some((index, self.directions_to(index)?.light_deg)));
        angles.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(index, _)| index)
    }

    fn directions_to(&self, light: usize) -> Option<Directions> {
        let (position, normal) = (self.numbers("position")?, self.numbers("shading-normal")?);
        Directions::new(position.into(), normal.into(), self.camera.eye, self.lights.get(light)?)
    }

    /// The material at the pixel, lit by the light of this number.
    pub(super) fn material(&self, light: u32) -> Option<Material> {
        let [base_color, metallic, roughness] = ["base-color", "metallic", "roughness"].map(|slug| self.numbers(slug));
        let light_deg = self.directions(light)?.light_deg;
        Some(Material {
            base_color: base_color?.map(|channel| channel.clamp(0.0, 1.0)),
            metallic: metallic?[0].clamp(0.0, 1.0),
            roughness: roughness?[0].clamp(0.0, 1.0),
            // The measuring stages take a light above the horizon.
            light_deg: light_deg.min(89.0),
        })
    }
}

/// Inputs of curves. While they are the same, the curves are.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Asked {
    /// Number of the request.
    pub(super) number: u64,
    pub(super) material: Material,
    /// Addresses of the shaders: generations may count from 1 again.
    pub(super) shaders: [usize; 2],
    /// The author's constants and parameters, as they are compared.
    pub(super) settings: String,
}

/// The curves on screen.
pub(super) struct Shown {
    pub(super) of: Material,
    pub(super) now: Result<Curves, String>,
    pub(super) before: Option<Curves>,
}
