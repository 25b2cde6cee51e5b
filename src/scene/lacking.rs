//! Looks that were made with another model.

use super::model::Model;
use crate::settings::Settings;

impl Model {
    /// Leaves out of `settings` what `look` says about parts that this model lacks: its variant, materials, nodes and camera. Returns a
    /// sentence for each kind. What `settings` have from elsewhere stays.
    pub fn leave_out_lacking(&self, look: &Settings, settings: &mut Settings) -> Vec<String> {
        let mut told = Vec::new();
        if let Err(problem) = self.variant(&look.variant)
            && settings.variant == look.variant
        {
            settings.variant.clear();
            told.push(problem);
        }
        if settings.camera.name == look.camera.name
            && let Some(problem) = self.unknown_camera(&look.camera)
        {
            settings.camera.name.clear();
            told.push(problem);
        }
        if settings.animation.clips == look.animation.clips
            && let Some(problem) = self.unknown_clip(&look.animation)
        {
            settings.animation.clips.clear();
            told.push(problem);
        }
        if settings.animation.weights == look.animation.weights
            && let Some(problem) = self.unknown_target(&look.animation)
        {
            settings.animation.weights.clear();
            told.push(problem);
        }
        let is_known = |name: &String| self.unknown_material(std::iter::once(name)).is_none();
        let lacking: Vec<&String> = look.materials.keys().filter(|name| !is_known(name)).collect();
        settings
            .materials
            .retain(|name, values| !lacking.contains(&name) || look.materials.get(name) != Some(&*values));
        told.extend(self.unknown_material(lacking.into_iter()));
        told.extend(self.unknown_part(&look.scene));
        let leave_out = |names: &mut Vec<String>, of_look: &[String]| {
            let has = |name: &String| self.has_part(name) || !of_look.contains(name);
            names.retain(has);
        };
        leave_out(&mut settings.scene.hidden, &look.scene.hidden);
        leave_out(&mut settings.scene.isolated, &look.scene.isolated);
        told
    }
}
