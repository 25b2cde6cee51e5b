//! Captured frames as files: PNG for the picture, EXR for the raw values behind it.

use std::path::{Path, PathBuf};

use image::{ImageBuffer, ImageFormat, Rgba};

use crate::render::Capture;

/// Fails before any work when `path` can hold no picture.
///
/// # Errors
/// An ending other than .png or .exr, or a folder that is not there, in words.
pub fn check_path(path: &Path) -> Result<(), String> {
    format_of(path)?;
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    match folder {
        Some(folder) if !folder.is_dir() => {
            Err(format!("cannot write {}: there is no folder {}", path.display(), folder.display()))
        }
        _ if path.is_dir() => Err(format!("cannot write {}: it is a folder", path.display())),
        _ => Ok(()),
    }
}

/// `out` with the mode's name before the ending: `helmet.png` gives `helmet.metallic.png`.
pub fn path_of_mode(out: &Path, slug: &str) -> PathBuf {
    let ending = out.extension().unwrap_or_default().to_string_lossy();
    out.with_extension(format!("{slug}.{ending}"))
}

/// Writes a capture whole: into a file beside it, which then takes its name, so no reader ever sees half a picture.
///
/// # Errors
/// A place that cannot be written, in words.
pub fn write(capture: &Capture, path: &Path) -> Result<(), String> {
    let format = format_of(path)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let part = path.with_file_name(format!(".{name}.{}.part", std::process::id()));
    let written = save(capture, &part, format).and_then(|()| std::fs::rename(&part, path).map_err(|e| e.to_string()));
    written.map_err(|e| {
        let _ = std::fs::remove_file(&part);
        format!("cannot write {}: {e}", path.display())
    })
}

fn save(capture: &Capture, path: &Path, format: ImageFormat) -> Result<(), String> {
    let (width, height) = (capture.width, capture.height);
    let size = || "the picture's size does not match its pixels".to_owned();
    let saved = match format {
        ImageFormat::OpenExr => {
            let floats = capture.raw.as_flattened();
            let image: ImageBuffer<Rgba<f32>, &[f32]> =
                ImageBuffer::from_raw(width, height, floats).ok_or_else(size)?;
            image.save_with_format(path, format)
        }
        _ => {
            let image: ImageBuffer<Rgba<u8>, &[u8]> =
                ImageBuffer::from_raw(width, height, capture.rgba8.as_slice()).ok_or_else(size)?;
            image.save_with_format(path, format)
        }
    };
    saved.map_err(|e| e.to_string())
}

fn format_of(path: &Path) -> Result<ImageFormat, String> {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    match ending.as_str() {
        "png" => Ok(ImageFormat::Png),
        "exr" => Ok(ImageFormat::OpenExr),
        _ => Err(format!("cannot write {}: the file must end in .png or .exr", path.display())),
    }
}
