//! Pictures with their names.

use image::{DynamicImage, RgbaImage};

use super::encode::{escaped, uri_of};

/// A picture with its name.
#[derive(Clone, Debug)]
pub struct Tile {
    /// Its name, as `Roughness 0.25`.
    pub name: String,
    /// Text after the name.
    pub note: String,
    /// The picture.
    pub image: RgbaImage,
}

pub(super) fn html(tiles: &[Tile], columns: Option<u32>) -> Result<String, String> {
    let mut figures = String::new();
    for tile in tiles {
        let uri = uri_of(&DynamicImage::ImageRgba8(tile.image.clone()))?;
        let (name, note) = (escaped(&tile.name), escaped(&tile.note));
        figures += &format!(
            "<figure><button type=\"button\"><img src=\"{uri}\" alt=\"{name}\" width=\"{}\" height=\"{}\"></button>\
             <figcaption>{name} <span class=\"quiet\">{note}</span></figcaption></figure>\n",
            tile.image.width(),
            tile.image.height(),
        );
    }
    let style = columns.map(|columns| format!(" style=\"--columns:{columns}\"")).unwrap_or_default();
    Ok(format!("<div class=\"gallery\"{style}>\n{figures}</div>"))
}
