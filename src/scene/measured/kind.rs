//! The formats of measured BRDFs and the sizes of their files.

/// MERL's steps of theta_h, theta_d and phi_d, as in the header.
pub(super) const MERL_DIMENSIONS: [i32; 3] = [90, 90, 180];
/// Size of the header: the dimensions.
pub(super) const MERL_HEADER_BYTES: usize = size_of::<[i32; 3]>();
/// Values of a channel of a MERL file.
pub(super) const MERL_CELLS: usize = 90 * 90 * 180;
/// UTIA's steps of theta, and of phi for each.
pub(super) const UTIA_STEPS: [usize; 2] = [6, 48];
/// UTIA's directions of the light, and as many of the view.
pub(super) const UTIA_DIRECTIONS: usize = UTIA_STEPS[0] * UTIA_STEPS[1];

/// The database whose format a file has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasuredKind {
    /// Isotropic; theta_h x theta_d x phi_d = 90 x 90 x 180.
    Merl,
    /// Anisotropic; (theta x phi) of the light by (theta x phi) of the view, (6 x 48) x (6 x 48).
    Utia,
}

impl MeasuredKind {
    /// The database's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Merl => "MERL",
            Self::Utia => "UTIA",
        }
    }

    /// Whether a file of a format has so many bytes.
    pub fn has_length(bytes: u64) -> bool {
        [Self::Merl, Self::Utia].iter().any(|kind| kind.file_bytes() as u64 == bytes)
    }

    /// The size of every file of this format, bytes.
    pub fn file_bytes(self) -> usize {
        match self {
            Self::Merl => MERL_HEADER_BYTES + MERL_CELLS * size_of::<[f64; 3]>(),
            Self::Utia => UTIA_DIRECTIONS * UTIA_DIRECTIONS * size_of::<[f64; 3]>(),
        }
    }
}
