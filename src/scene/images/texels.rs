//! The texels of a file, in the form that it has.

use super::basis::Basis;
use super::form::TexelForm;

/// The texels of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Texels {
    /// Texels or blocks.
    Stored {
        /// Their form.
        form: TexelForm,
        /// The number of levels: 1, or the mip levels of the file.
        levels: u32,
        /// The levels one after the other, the largest first. Empty after the upload.
        bytes: Vec<u8>,
    },
    /// A KTX2 file that is transcoded into a form which the device samples.
    Basis(Basis),
}

impl Texels {
    /// Whether the upload has freed them.
    pub fn is_empty(&self) -> bool {
        matches!(self, Self::Stored { bytes, .. } if bytes.is_empty())
    }

    /// The number of levels in the file.
    pub(super) fn levels(&self) -> u32 {
        match self {
            Self::Stored { levels, .. } => *levels,
            Self::Basis(basis) => basis.levels,
        }
    }

    /// The forms that they can take on a device without a loss, the best first.
    pub(super) fn forms(&self) -> &[TexelForm] {
        match self {
            Self::Stored { form, .. } => std::slice::from_ref(form),
            Self::Basis(basis) => &basis.targets,
        }
    }

    pub(in crate::scene) fn is_hdr(&self) -> bool {
        match self {
            Self::Stored { form, .. } => form.is_hdr(),
            Self::Basis(basis) => basis.is_hdr,
        }
    }
}
