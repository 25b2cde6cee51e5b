//! The inspector: the pinned pixel, its value in every mode, and the curves of its material. The panel shows it, the screen reads it from
//! the device, and the viewer measures the curves.

pub(in crate::app) mod anchor;
pub(in crate::app) mod directions;
pub(in crate::app) mod text;

use std::collections::BTreeMap;

use serde_json::Value;

use crate::identity::Identity;
use crate::interface::Light;
use crate::measure::{Curves, Material};
use crate::render::Texel;
use crate::scene::CameraView;
use crate::settings::Settings;
use crate::shader::not_finite::NotFinite;
use crate::shader::{Mode, PixelValue};

use anchor::Anchor;
use directions::Directions;

/// Page that the inspector panel shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::app) enum Page {
    /// The value in every mode.
    #[default]
    Values,
    /// The lobe and the albedo of the material.
    Lobe,
}

impl Page {
    pub(in crate::app) const ALL: [Self; 2] = [Self::Values, Self::Lobe];

    /// Its name, and what it shows.
    pub(in crate::app) fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Values => ("Values", "The value of this pixel in every mode, before exposure, in world space"),
            Self::Lobe => ("BRDF", "The lobe and the albedo of this pixel's material, from your GLSL"),
        }
    }
}

/// The values that are known of the inspected pixel. Nothing is read or measured while its panel is out of sight.
#[derive(Default)]
pub(in crate::app) struct Inspection {
    /// The pixel that the user has clicked.
    pub(in crate::app) pin: Option<[u32; 2]>,
    /// The surface on which the pin stays, once the picture has changed its size.
    pub(in crate::app) anchor: Option<Anchor>,
    /// Whether the message that the panel reads pixels was shown.
    pub(in crate::app) was_mentioned: bool,
    /// Whether the pixel under the mouse is shown while none is pinned.
    pub(in crate::app) follows: bool,
    pub(in crate::app) page: Page,
    /// The newest values; they stay while newer ones are being read.
    pub(in crate::app) reading: Option<Reading>,
    /// Inputs of the newest request for curves.
    pub(in crate::app) asked: Option<Asked>,
    pub(in crate::app) curves: Option<Shown>,
    /// The search for the first statement that makes NaN or infinity at the pinned pixel.
    pub(in crate::app) search_not_finite: Option<NotFiniteSearch>,
    /// The picture and the pixel in which it looks. Another mode of them keeps the search.
    pub(in crate::app) searched: Option<SearchOf>,
}

impl Inspection {
    /// Records that the search has failed. The same search would fail again, so it is not repeated.
    pub(in crate::app) fn fail_search(&mut self) {
        if let Some(search) = &mut self.search_not_finite {
            let found = Err("the search failed".to_owned());
            search.found = Some(NotFinite { mode: search.mode.clone(), found });
        }
    }

    /// Whether a pixel is pinned, and visible.
    pub(in crate::app) fn is_pinned(&self) -> bool {
        self.pin.is_some()
    }

    /// Whether the pinned pixel has moved with its surface.
    pub(in crate::app) fn has_moved(&self) -> bool {
        self.pin.zip(self.anchor.as_ref()).is_some_and(|(pin, anchor)| anchor.at() == pin)
    }

    /// Unpins the pixel. Its values are dropped, unless the pixel under the mouse replaces it.
    pub(in crate::app) fn unpin(&mut self) {
        (self.pin, self.search_not_finite) = (None, None);
        if !self.follows {
            (self.reading, self.asked, self.curves) = (None, None, None);
        }
    }
}

/// The picture and the pixel in which a search looks.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::app) struct SearchOf {
    pub(in crate::app) at: [u32; 2],
    pub(in crate::app) generation: u64,
    pub(in crate::app) settings: Settings,
}

impl SearchOf {
    pub(in crate::app) fn new(at: [u32; 2], generation: u64, settings: &Settings) -> Self {
        Self { at, generation, settings: Settings { mode: String::new(), ..settings.clone() } }
    }
}

/// A search for the first statement that makes NaN or infinity.
#[derive(Clone, Debug)]
pub(in crate::app) struct NotFiniteSearch {
    /// Number of the request.
    pub(in crate::app) number: u64,
    /// Slug of the mode.
    pub(in crate::app) mode: String,
    /// The result; `None` while the search runs.
    pub(in crate::app) found: Option<NotFinite>,
}

/// The values of a pixel.
#[derive(Clone, Debug)]
pub(in crate::app) struct Reading {
    /// Pixels from the upper left corner of the picture.
    pub(in crate::app) at: [u32; 2],
    /// Value by slug of the mode, with the number of the picture that it was read from.
    pub(in crate::app) values: BTreeMap<String, (PixelValue, u64)>,
    /// Number of the picture that values are read from.
    pub(in crate::app) picture: u64,
    /// Whether all modes were read from that picture.
    pub(in crate::app) is_complete: bool,
    /// Whether the picture is that of a single shader file, so that the values are displayed colors and those of passes.
    pub(in crate::app) is_of_toy: bool,
    /// Factor from a value before exposure to one after it.
    pub(in crate::app) exposure: f32,
    /// The camera and the lights of the picture, world space.
    pub(in crate::app) camera: CameraView,
    pub(in crate::app) lights: Vec<Light>,
    /// Names of the node and of the material, if the pixel shows a surface of the model.
    pub(in crate::app) names: Option<[String; 2]>,
    /// The texels of the material's textures, once they are read.
    pub(in crate::app) texels: Vec<Texel>,
}

#[cfg(test)]
impl Reading {
    /// A complete reading of a picture with the number 1.
    pub(in crate::app) fn sample(values: BTreeMap<String, (PixelValue, u64)>) -> Self {
        use glam::Vec3;

        let bounds = crate::scene::Bounds { min: Vec3::NEG_ONE, max: Vec3::ONE };
        Self {
            at: [0, 0],
            values,
            picture: 1,
            is_complete: true,
            is_of_toy: false,
            exposure: 1.0,
            camera: CameraView::new(Vec3::Z * 4.0, Vec3::ZERO, 0.6, 1.0, &bounds),
            lights: Vec::new(),
            names: None,
            texels: Vec::new(),
        }
    }
}

impl Reading {
    /// The value of a mode, if it was read.
    pub(in crate::app) fn value(&self, slug: &str) -> Option<PixelValue> {
        self.values.get(slug).map(|(value, _)| *value)
    }

    /// The values of these modes that were read, in JSON.
    pub(in crate::app) fn json<'a>(&'a self, modes: &'a [Mode]) -> impl Iterator<Item = (String, Value)> + 'a {
        modes.iter().filter_map(|mode| Some((mode.slug.clone(), self.value(&mode.slug)?.json(mode))))
    }

    /// Whether the value of a mode belongs to an earlier frame.
    pub(in crate::app) fn is_old(&self, slug: &str) -> bool {
        self.values.get(slug).is_none_or(|(_, picture)| *picture != self.picture)
    }

    /// The three numbers of a mode that has data here.
    pub(in crate::app) fn numbers(&self, slug: &str) -> Option<[f32; 3]> {
        let value = self.value(slug).filter(|value| !value.no_data && !value.not_finite)?;
        // Color is multiplied by coverage.
        let [r, g, b, coverage] = value.value;
        (coverage > 0.0).then(|| [r, g, b].map(|number| number / coverage))
    }

    /// Whether the model covers the pixel. Only modes that draw no background show that.
    pub(in crate::app) fn is_hit(&self) -> bool {
        const WITHOUT_BACKGROUND: [&str; 3] = ["position", "depth", "shading-normal"];
        let covers = |value: PixelValue| value.value[3] > 0.0 || value.no_data || value.not_finite;
        WITHOUT_BACKGROUND.iter().filter_map(|slug| self.value(slug)).any(covers)
    }

    /// The normal, and the directions to the eye and to the light of this number, from 1; 0 is light 1 too.
    pub(in crate::app) fn directions(&self, light: u32) -> Option<Directions> {
        self.directions_to(self.light_of(light)?)
    }

    /// The selected light; 0 selects, of all lights, the one nearest to the normal.
    pub(in crate::app) fn light_of(&self, light: u32) -> Option<usize> {
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
    pub(in crate::app) fn material(&self, light: u32) -> Option<Material> {
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

/// Inputs of curves. Equal inputs give equal curves.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::app) struct Asked {
    /// Number of the request.
    pub(in crate::app) number: u64,
    pub(in crate::app) material: Material,
    /// The shaders, and those of the version before.
    pub(in crate::app) shaders: [Identity; 2],
    /// The author's constants and parameters, in a comparable form.
    pub(in crate::app) settings: String,
}

/// The curves on screen.
pub(in crate::app) struct Shown {
    pub(in crate::app) of: Material,
    pub(in crate::app) now: Result<Curves, String>,
    pub(in crate::app) before: Option<Curves>,
}
