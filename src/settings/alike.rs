//! Comparisons that leave out what changes while the user only looks: camera, mode, orbiting lights, animations.

use super::{LightSettings, Settings};

impl LightSettings {
    /// These lights in the directions of the orbiting lights of `view`.
    #[must_use]
    pub fn turned_as(&self, view: &Self) -> Self {
        let mut turned = self.clone();
        for (light, seen) in turned.orbit.iter_mut().zip(&view.orbit) {
            light.azimuth = seen.azimuth;
        }
        turned
    }
}

impl Settings {
    /// Whether both are equal but for the camera, the directions of orbiting lights and the animations. These select no pipelines and no baked
    /// light, change in many frames, and never make a shader hang by themselves.
    pub fn is_alike(&self, other: &Self) -> bool {
        (&self.mode, &self.expression) == (&other.mode, &other.expression)
            && self.lights == other.lights.turned_as(&self.lights)
            && self.rest() == other.rest()
    }

    /// Whether both are equal but for the mode.
    pub fn is_of_other_mode(&self, other: &Self) -> bool {
        let parts = |of: &Self| (of.camera.clone(), of.lights.clone(), of.animation.clone(), of.expression.clone());
        parts(self) == parts(other) && self.rest() == other.rest()
    }

    /// Whether both are equal but for the camera, the mode, the watched expression and, while they orbit, the directions of lights.
    pub fn is_other_view(&self, other: &Self) -> bool {
        let turned = if other.lights.spin == 0.0 { self.lights.clone() } else { self.lights.turned_as(&other.lights) };
        turned == other.lights && self.animation == other.animation && self.rest() == other.rest()
    }

    /// These settings with the camera, the directions of orbiting lights and the animations of `view`.
    #[must_use]
    pub fn placed_as(&self, view: &Self) -> Self {
        let lights = self.lights.turned_as(&view.lights);
        Self { camera: view.camera.clone(), animation: view.animation.clone(), lights, ..self.clone() }
    }

    /// All but the mode, the watched expression, the camera, the lights and the animations.
    fn rest(&self) -> impl PartialEq {
        let Self {
            mode: _,
            camera: _,
            lights: _,
            animation: _,
            variant,
            material,
            materials,
            scene,
            model,
            added,
            environment,
            measured,
            expression: _,
            view,
            bookmarks,
            passes,
            shader,
        } = self;
        let of_model = (variant, material, materials, scene, model, added);
        (of_model, environment, measured, view, bookmarks, passes, shader)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_comparison_leaves_out_what_it_says() {
        let settings = Settings::of_window();
        let with = |assignment: &str| {
            let mut other = settings.clone();
            other.assign(assignment).unwrap();
            let (alike, of_mode, view) =
                (settings.is_alike(&other), settings.is_of_other_mode(&other), settings.is_other_view(&other));
            assert_ne!(other, settings, "{assignment}");
            (alike, of_mode, view)
        };
        assert_eq!(with("camera.fovy=50"), (true, false, true));
        assert_eq!(with("lights.orbit.1.azimuth=1"), (true, false, false));
        assert_eq!(with("animation.speed=2"), (true, false, false));
        assert_eq!(with("mode=normal"), (false, true, true));
        assert_eq!(with("expression.evaluation=2"), (false, false, true));
        for other in ["lights.orbit.1.strength=1", "view.ev=1", "rim=0.5", "passes.ground=false", "variant=red"] {
            assert_eq!(with(other), (false, false, false), "{other}");
        }
        let turning =
            Settings { lights: LightSettings { spin: 1.0, ..LightSettings::default() }, ..Settings::default() };
        let mut turned = turning.clone();
        turned.lights.orbit[1].azimuth += 5.0;
        assert!(turning.is_other_view(&turned) && turning.placed_as(&turned) == turned);
    }
}
