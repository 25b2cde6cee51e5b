//! Settings of the watched expression.

use serde::{Deserialize, Serialize};

use super::declare::settings;

settings! {
    /// The expression of the shaders that the mode `expression` shows.
    #[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct ExpressionSettings {
        /// Expression of the shaders that the mode `expression` shows: FILE:LINE:NAME, as `brdf/ndf.glsl:20:a2`.
        at: String;
        /// Which evaluation of the expression in a pixel counts, from 1, for code in loops and in functions that run once for each light.
        /// 0: the last.
        evaluation: u32;
    }
}
