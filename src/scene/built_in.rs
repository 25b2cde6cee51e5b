//! The models that are embedded in the program, so that it can show something from any directory.

use super::{LoadError, Model, load_bytes};

/// A model of `assets/` and its name.
macro_rules! embedded {
    ($($name:literal),+ $(,)?) => {
        [$(($name, include_bytes!(concat!("../../assets/", $name, ".glb")))),+]
    };
}

const MODELS: [(&str, &[u8]); 17] = embedded![
    "shader-ball",
    "sphere-grid",
    "metal-grid",
    "material-override",
    "many-lights",
    "clearcoat",
    "anisotropy",
    "sheen",
    "specular",
    "ior",
    "iridescence",
    "transmission",
    "volume",
    "dispersion",
    "diffuse-transmission",
    "variants",
    "specular-glossiness",
];

/// Names of the built-in models; the first is the default.
pub const BUILT_IN: [&str; MODELS.len()] = {
    let mut names = [""; MODELS.len()];
    let mut i = 0;
    while i < names.len() {
        names[i] = MODELS[i].0;
        i += 1;
    }
    names
};

/// A built-in model by its name.
///
/// # Errors
/// As [`load_bytes`]; `None` for a name that is not in [`BUILT_IN`].
pub fn built_in(name: &str) -> Option<Result<Model, LoadError>> {
    let (_, bytes) = MODELS.iter().find(|(known, _)| *known == name)?;
    Some(load_bytes(name, bytes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::{self, FEW_LIGHTS};

    fn model(name: &str) -> Model {
        built_in(name).unwrap().unwrap()
    }

    #[test]
    fn every_model_of_the_assets_folder_is_built_in_and_loads() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets");
        let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let glbs = paths.filter(|path| path.extension().is_some_and(|extension| extension == "glb"));
        let mut files: Vec<String> = glbs.map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned()).collect();
        let mut names = BUILT_IN.to_vec();
        files.sort();
        names.sort_unstable();
        assert_eq!(files, names);
        for name in names {
            assert!(!model(name).primitives.is_empty(), "{name}");
        }
        assert!(built_in("clearcoat.glb").is_none());
    }

    #[test]
    fn the_shapes_to_override_have_tangents_and_no_textures() {
        let model = model("material-override");
        let tangents = |name: &str| {
            let primitive = model.primitives.iter().find(|primitive| primitive.name.starts_with(name)).unwrap();
            assert!(model.materials[primitive.material].textures.iter().all(Option::is_none), "{name}");
            primitive.attributes & interface::ATTRIBUTE_TANGENT != 0
        };
        assert!(["Sphere", "Cube", "Cylinder"].into_iter().all(tangents));
    }

    #[test]
    fn many_lights_are_so_many_that_shaders_look_them_up_in_the_grid() {
        let lights = model("many-lights").lights.len();
        assert!(lights == 160 && lights > FEW_LIGHTS);
    }
}
