//! The settings of a picture in its PNG file: a text chunk with the keyword `specula` holds them as a look file does.

use std::fs::File;
use std::io::{BufReader, Cursor};
use std::path::Path;

use crate::render::Capture;
use crate::settings::Settings;

/// Keyword of the chunk.
const KEYWORD: &str = "specula";

/// The bytes of a PNG file with a picture and its settings.
pub(super) fn encode(capture: &Capture, settings: &Settings) -> Result<Vec<u8>, String> {
    let mut bytes = Cursor::new(Vec::new());
    let mut written = || -> Result<(), png::EncodingError> {
        let mut encoder = png::Encoder::new(&mut bytes, capture.width, capture.height);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Fast);
        encoder.add_itxt_chunk(KEYWORD.to_owned(), settings.to_toml())?;
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&capture.rgba8)?;
        writer.finish()
    };
    written().map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}

/// Settings as text: a look file, or what a PNG file of Specula holds.
///
/// # Errors
/// A message if the file cannot be read, or is a PNG without settings.
pub fn read_look(path: &Path) -> Result<String, String> {
    match path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
        true => decode(path),
        false => {
            std::fs::read_to_string(path).map_err(|e| format!("{}: the look file cannot be read: {e}", path.display()))
        }
    }
}

/// The settings of a look file, or of a PNG file of Specula.
///
/// # Errors
/// A message with the position of what is wrong.
pub fn read_settings(path: &Path) -> Result<Settings, String> {
    let error = |text: String| format!("{}: {text}", path.display());
    let settings = Settings::from_toml(&read_look(path)?).map_err(|e| error(e.to_string()))?;
    settings.check().map_err(|problem| error(problem.to_string()))?;
    Ok(settings)
}

/// The settings in a PNG file as the text of a look file.
fn decode(path: &Path) -> Result<String, String> {
    let error = |why: String| format!("{}: {why}", path.display());
    let file = File::open(path).map_err(|e| error(format!("cannot be read: {e}")))?;
    let decoder = png::Decoder::new(BufReader::new(file));
    let reader = decoder.read_info().map_err(|e| error(format!("no PNG file: {e}")))?;
    let chunk = reader.info().utf8_text.iter().find(|chunk| chunk.keyword == KEYWORD);
    let chunk = chunk.ok_or_else(|| error("this PNG holds no settings of Specula".to_owned()))?;
    chunk.get_text().map_err(|e| error(format!("its settings cannot be read: {e}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_and_pixels_are_read_as_they_were_written() {
        let mut settings = Settings::default();
        (settings.mode, settings.view.ev) = ("d \u{3b1}".to_owned(), 1.5);
        let rgba8: Vec<u8> = (0..3 * 2 * 4).collect();
        let capture = Capture { width: 3, height: 2, rgba8: rgba8.clone(), ..Capture::default() };
        let path = tempfile::Builder::new().suffix(".png").tempfile().unwrap();
        std::fs::write(path.path(), encode(&capture, &settings).unwrap()).unwrap();
        assert_eq!(Settings::from_toml(&read_look(path.path()).unwrap()), Ok(settings));
        assert_eq!(image::open(path.path()).unwrap().into_rgba8().into_raw(), rgba8);
    }

    #[test]
    fn a_file_without_settings_is_refused() {
        let path = tempfile::Builder::new().suffix(".png").tempfile().unwrap();
        image::RgbaImage::new(2, 2).save(path.path()).unwrap();
        assert!(read_look(path.path()).unwrap_err().ends_with("this PNG holds no settings of Specula"));
        std::fs::write(path.path(), b"text").unwrap();
        assert!(read_look(path.path()).unwrap_err().contains("no PNG file"));
    }
}
