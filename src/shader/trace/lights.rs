//! The lights that calls in a trace are about.

use serde_json::{Value, json};

use super::TracedValue;

/// A light of the traced frame.
#[derive(Clone, Debug, PartialEq)]
pub struct TracedLight {
    /// The name in the model's file, or the setting that has the light, as `lights.orbit.0`; may be empty.
    pub name: String,
    /// Directional, point, spot or rectangle.
    pub kind: &'static str,
    /// Linear RGB times `unit`.
    pub intensity: [f32; 3],
    /// Unit of the intensity.
    pub unit: &'static str,
}

impl TracedLight {
    /// The light for a reader, as `lamp, point, 12 cd`.
    pub fn text(&self) -> String {
        let most = self.intensity.into_iter().fold(0.0, f32::max);
        let digits = if most > 0.0 { (2 - most.log10().floor() as i32).clamp(0, 9) } else { 0 };
        let scale = 10_f32.powi(digits);
        let strength = format!("{} {}", TracedValue::float((most * scale).round() / scale).text(), self.unit);
        let parts = [self.name.as_str(), self.kind, &strength];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
    }

    /// The light for programs. `number`: from 1, as in the paths of calls.
    pub(super) fn json(&self, number: usize) -> Value {
        let Self { name, kind, intensity, unit } = self;
        json!({ "light": number, "name": name, "kind": kind, "intensity": intensity, "unit": unit })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_is_told_by_its_name_and_strength() {
        let light = TracedLight { name: "lamp".into(), kind: "point", intensity: [12.0, 6.5, 0.0], unit: "cd" };
        assert_eq!(light.text(), "lamp, point, 12 cd");
        for (intensity, text) in [(47.88926, "47.9 cd"), (0.012_345, "0.0123 cd"), (683.2, "683 cd"), (0.0, "0 cd")] {
            let light = TracedLight { name: String::new(), intensity: [intensity; 3], ..light.clone() };
            assert_eq!(light.text(), format!("point, {text}"));
        }
        assert_eq!(TracedLight { name: String::new(), ..light }.text(), "point, 12 cd");
    }
}
