//! Checks of all settings.

use super::catalog::catalog;
use super::{Settings, added, factors};

impl Settings {
    /// Checks that every value is valid.
    ///
    /// # Errors
    /// A message with the setting, its value and the valid values.
    pub fn check(&self) -> Result<(), String> {
        for setting in catalog() {
            self.value(&setting.path).map_or(Ok(()), |value| setting.entry.check(&setting.path, &value))?;
        }
        factors::check(&self.materials)?;
        added::check(&self.added)?;
        let camera = &self.camera;
        for (name, vector) in [("camera.eye", camera.eye), ("camera.target", camera.target), ("camera.up", camera.up)] {
            if vector.is_some_and(|v| !v.iter().all(|c| c.is_finite())) {
                return Err(format!("{name} has a number that is not finite; it takes three numbers, as 0,1.5,3"));
            }
        }
        self.view.background_linear()?;
        if self.view.background == "env" && !self.environment.is_lit() {
            return Err("view.background is env, but environment.name is none, so there is no environment to show. \
                Choose another background or an environment"
                .into());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn check_names_what_no_picture_can_be_made_of() {
        Settings::default().check().unwrap();
        for (assignment, words) in [
            ("material.roughness=1.5", "material.roughness is 1.5; it can be 0 to 1"),
            ("material.base_color=[0, nan, 0]", "material.base_color.1 is NaN"),
            ("material.anisotropy_rotation=inf", "material.anisotropy_rotation is inf"),
            ("lights.rect.width=0", "lights.rect.width is 0; it can be 0.001 to 1000"),
            ("lights.rect.strength=inf", "lights.rect.strength is inf"),
            ("lights.orbit.1.color=[1, 1, -1]", "lights.orbit.1.color.2 is -1"),
            ("view.frames=0", "view.frames is 0; it can be 1 to 100000"),
            ("view.msaa=2", "view.msaa is 2; it can be 1 or 4"),
        ] {
            let mut settings = Settings::default();
            settings.assign(assignment).unwrap();
            let error = settings.check().unwrap_err();
            assert!(error.contains(words), "{assignment}: {error}");
        }
    }
}
