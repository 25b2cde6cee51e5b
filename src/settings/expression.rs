//! Settings of the watched expression.

use serde::{Deserialize, Serialize};

/// The expression of the shaders that the mode `expression` shows.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ExpressionSettings {
    /// `FILE:LINE:NAME`, as `brdf/ndf.glsl:20:a2`; empty for none.
    pub at: String,
    /// Which evaluation in a pixel counts, from 1, for code in loops and in functions that run once for each light; 0 is the last.
    pub evaluation: u32,
}
