//! The material extensions of glTF, a file each.

mod anisotropy;
mod clearcoat;
mod descriptor;
mod diffuse_transmission;
mod dispersion;
mod ior;
mod iridescence;
mod sheen;
mod specular;
mod specular_glossiness;
mod transmission;
mod volume;

pub(super) use descriptor::factor;
pub use descriptor::{Extension, Field, LARGEST_IOR, MaterialFactor, bit_if};

/// All extensions, in the order in which they are read.
pub const EXTENSIONS: &[Extension] = &[
    specular_glossiness::EXTENSION,
    anisotropy::EXTENSION,
    clearcoat::EXTENSION,
    diffuse_transmission::EXTENSION,
    dispersion::EXTENSION,
    iridescence::EXTENSION,
    sheen::EXTENSION,
    specular::EXTENSION,
    transmission::EXTENSION,
    volume::EXTENSION,
    ior::EXTENSION,
];

/// It replaces metallic-roughness.
pub const SPECULAR_GLOSSINESS: &str = specular_glossiness::EXTENSION.name;
