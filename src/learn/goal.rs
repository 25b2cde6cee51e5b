//! The goals of an exercise: what is measured, and what is expected.

use serde::{Deserialize, Serialize};

/// A goal, as `[[goal]]` in `exercise.toml` describes it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Goal {
    /// The goal in a sentence.
    pub says: String,
    /// Settings of its measurement, as `--set` takes them, after those of the exercise.
    #[serde(default)]
    pub set: Vec<String>,
    /// The measurement that decides the goal.
    pub check: Check,
}

/// A measurement and its limits.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Check {
    /// The albedo of a surface under uniform light, over roughness and angle (`specula brdf furnace`).
    Furnace {
        /// 0 dielectric .. 1 metal.
        metallic: f32,
        /// Linear RGB; white by default.
        #[serde(default = "white")]
        base_color: [f32; 3],
        /// First and last roughness.
        #[serde(default = "all_roughness")]
        roughness: (f32, f32),
        /// Largest distance from 1, or from the albedo of the solution for a base color that is not white.
        within: f64,
    },
    /// The integral of D NoH is 1.
    Normalization {
        /// Largest distance from 1.
        within: f64,
    },
    /// f(l, v) = f(v, l)
    Reciprocity {
        /// Largest relative difference of both.
        within: f64,
    },
    /// The raw values of a mode equal those of the solution.
    Values {
        /// Slug of the mode.
        mode: String,
        /// How the message calls the value, as `D`.
        name: String,
        /// Largest difference, relative to the value or to `scale`, whichever is larger.
        within: f64,
        /// Values below this count as this large.
        scale: f64,
    },
    /// The displayed picture equals that of the solution.
    Picture {
        /// Largest difference of a channel, of 255.
        within: u8,
        /// Frames to draw; the last one is compared.
        #[serde(default = "one")]
        frames: u32,
    },
    /// No pixel of the picture is NaN or infinite.
    Finite,
    /// The tree declares a debug mode.
    Mode {
        /// Its slug.
        slug: String,
        /// Components of its value.
        components: u8,
    },
    /// The tree declares a parameter.
    Parameter {
        /// Its name in GLSL.
        name: String,
        /// Its range.
        range: (f64, f64),
        /// Its default.
        default: f64,
    },
    /// The tree declares a pass that is on, and that changes the light of a pixel by a factor.
    Light {
        /// Name of the pass.
        pass: String,
        /// The pixel, 0..1 from the upper left corner.
        at: (f32, f32),
        /// The factor that the pass must have there.
        factor: f64,
        /// Largest difference from it.
        within: f64,
    },
}

fn white() -> [f32; 3] {
    [1.0; 3]
}

fn all_roughness() -> (f32, f32) {
    (0.1, 1.0)
}

fn one() -> u32 {
    1
}

/// Result of checking a goal.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// The goal in a sentence.
    pub goal: String,
    /// Whether it is reached.
    pub passed: bool,
    /// The measured value, and the expected value if it differs.
    pub found: String,
}
