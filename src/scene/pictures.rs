//! Small pictures of the built-in models and environments, for choosing. `scripts/make-pictures gallery` makes them.

use image::{RgbaImage, imageops};
use include_dir::{Dir, include_dir};

static FILES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/assets/gallery");

/// Width and height of a preview, in pixels.
pub const PICTURE_SIZE: (u32, u32) = (192, 144);

/// All previews in one image, side by side.
pub struct BuiltInPictures {
    /// The image.
    pub image: RgbaImage,
    /// The names, in the order from left to right: of models, and of environments after `environment-`.
    pub names: Vec<String>,
}

/// Decodes the previews, which takes some milliseconds. A damaged one stays black.
pub fn built_in_pictures() -> BuiltInPictures {
    let files: Vec<_> = FILES.files().collect();
    let (width, height) = PICTURE_SIZE;
    let mut image = RgbaImage::new(width * files.len().max(1) as u32, height);
    let mut names = Vec::new();
    for (index, file) in (0..).zip(&files) {
        names.push(file.path().file_stem().unwrap_or_default().to_string_lossy().into_owned());
        if let Ok(picture) = image::load_from_memory(file.contents()) {
            imageops::replace(&mut image, &picture.into_rgba8(), i64::from(index * width), 0);
        }
    }
    BuiltInPictures { image, names }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{BUILT_IN, environment};

    #[test]
    fn each_built_in_model_and_environment_has_a_picture() {
        let pictures = built_in_pictures();
        let environments = environment::BUILT_IN.map(|name| format!("environment-{name}"));
        for name in BUILT_IN.into_iter().map(str::to_owned).chain(environments) {
            let at = pictures.names.iter().position(|known| *known == name);
            let at = at.unwrap_or_else(|| panic!("no picture of {name}: run scripts/make-pictures gallery"));
            let (width, height) = PICTURE_SIZE;
            let view = image::imageops::crop_imm(&pictures.image, at as u32 * width, 0, width, height).to_image();
            assert!(view.pixels().any(|pixel| pixel != view.get_pixel(0, 0)), "the picture of {name} is empty");
        }
    }
}
