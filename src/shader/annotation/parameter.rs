//! The constants and parameters that `//@ui` declares.

use serde::Serialize;

use crate::shader::spirv::reflect::Scalar;

/// A specialization constant of the author. A change builds new pipelines.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Constant {
    /// Name in GLSL; the key in `settings.shader`.
    pub name: String,
    /// `constant_id`
    pub id: u32,
    /// Display name.
    pub label: String,
    /// Type.
    #[serde(skip)]
    pub scalar: Scalar,
    /// Bits of the default; 0 or 1 for `bool`.
    pub default: u32,
    /// Smallest and largest value.
    pub range: Option<(f64, f64)>,
    /// Named values; empty if all values are allowed.
    pub choices: Vec<(String, i64)>,
    /// Description of each choice, with its source; may be empty.
    #[serde(skip)]
    pub choice_docs: Vec<String>,
    /// Choices that guarantee never to reflect more light than arrives (`conserves=`). `None` if the constant does not affect
    /// that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub conserves: Option<Vec<String>>,
    /// Choices that guarantee reciprocity: the same value with light and eye swapped (`reciprocal=`). `None` if the constant does
    /// not affect that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reciprocal: Option<Vec<String>>,
    /// Heading under which the window shows it; empty for none.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub group: String,
    /// Description of the parameter, with its source; may be empty.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub doc: String,
    /// Unit of the number; empty for none.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub unit: String,
    /// File as printed.
    #[serde(skip)]
    pub file: String,
    /// 1-based line of the annotation.
    #[serde(skip)]
    pub line: u32,
}

/// Type of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ParameterType {
    /// `float`
    Float,
    /// `int`
    Int,
    /// `uint`
    Uint,
    /// `bool`, four bytes in a block.
    Bool,
    /// `vec2`
    Vec2,
    /// `vec3`
    Vec3,
    /// `vec4`
    Vec4,
}

impl ParameterType {
    /// The type of its components.
    pub fn scalar(self) -> Scalar {
        match self {
            Self::Int => Scalar::Int,
            Self::Uint => Scalar::Uint,
            Self::Bool => Scalar::Bool,
            Self::Float | Self::Vec2 | Self::Vec3 | Self::Vec4 => Scalar::Float,
        }
    }

    /// Number of components.
    pub fn components(self) -> usize {
        match self {
            Self::Vec2 => 2,
            Self::Vec3 => 3,
            Self::Vec4 => 4,
            _ => 1,
        }
    }
}

/// A member of the author's `Params` block, or of a pass's own uniform block. A change only updates a uniform buffer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// Name in GLSL; the key in `settings.shader`.
    pub name: String,
    /// Display name.
    pub label: String,
    /// Bytes from the start of `Params`; `None` for a member of a pass's own block.
    pub offset: Option<u32>,
    /// Type.
    #[serde(rename = "type")]
    pub kind: ParameterType,
    /// Smallest and largest value.
    pub range: Option<(f64, f64)>,
    /// One number per component; a `bool` is 0 or 1.
    pub default: Vec<f64>,
    /// Whether the panel shows a color picker (linear RGB).
    pub color: bool,
    /// Named values; empty for free choice.
    pub choices: Vec<(String, i64)>,
    /// Description of each choice, with its source; may be empty.
    #[serde(skip)]
    pub choice_docs: Vec<String>,
    /// The constant that must not be 0 for it to have an effect: the window shows it only then.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub when: Option<String>,
    /// Heading under which the window shows it; empty for none.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub group: String,
    /// Description of the parameter, with its source; may be empty.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub doc: String,
    /// Unit of the number; empty for none.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub unit: String,
    /// File as printed.
    #[serde(skip)]
    pub file: String,
    /// 1-based line of the annotation.
    #[serde(skip)]
    pub line: u32,
}
