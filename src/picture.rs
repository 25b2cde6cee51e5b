//! Captured frames as files: PNG for the picture, EXR for the raw values behind it, and NumPy arrays of either.

mod look;
mod npy;
mod part;

use std::fs::{File, OpenOptions};
use std::io::{self, Cursor, Write as _};
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageBuffer, ImageFormat};

use crate::recovery::SessionState;
use crate::render::Capture;
use crate::settings::Settings;
pub use look::{Look, ReadError, may_hold_look, read_checked_look, read_look};
use part::PartFile;
pub use part::{Halt, remove_unfinished};

/// Linux gives up after this many symbolic links, too.
const MAX_LINKS: usize = 40;

/// The form of a picture in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Display colors, with the settings.
    Png,
    /// Raw values.
    Exr,
    /// A NumPy array: of raw values, or of display colors.
    Npy {
        /// Whether the values are raw, 32-bit floats.
        raw: bool,
    },
}

impl Encoding {
    /// The encoding that the extension of `path` names. An array has raw values.
    ///
    /// # Errors
    /// The file extension is none of .png, .exr and .npy.
    pub fn of(path: &Path) -> Result<Self, String> {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        Self::named(&ending)
            .ok_or_else(|| format!("cannot write {}: the file must end in .png, .exr or .npy", path.display()))
    }

    /// The encoding with this file extension.
    pub fn named(ending: &str) -> Option<Self> {
        match ending {
            "png" => Some(Self::Png),
            "exr" => Some(Self::Exr),
            "npy" => Some(Self::Npy { raw: true }),
            _ => None,
        }
    }

    /// Whether it holds linear light, before the tone map.
    pub fn holds_light(self) -> bool {
        matches!(self, Self::Exr | Self::Npy { raw: true })
    }
}

/// Fails if no picture format has the extension of `path`.
///
/// # Errors
/// As [`Encoding::of`].
pub fn check_ending(path: &Path) -> Result<(), String> {
    Encoding::of(path).map(|_| ())
}

/// Writes a capture to the next free [`numbered`] path, with its settings and files. Returns the path.
///
/// # Errors
/// As [`write()`].
pub fn write_numbered(capture: &Capture, work: &SessionState) -> Result<PathBuf, String> {
    let path = numbered();
    write(capture, work, &path).map(|()| path)
}

/// `specula-N.png` with the first free number, in the working directory.
pub fn numbered() -> PathBuf {
    numbered_as("specula", "png")
}

/// `STEM-N.ENDING` with the first free number, in the working directory.
pub fn numbered_as(stem: &str, ending: &str) -> PathBuf {
    let free = (1..).map(|n| PathBuf::from(format!("{stem}-{n}.{ending}"))).find(|path| !path.exists());
    free.unwrap_or_else(|| format!("{stem}.{ending}").into())
}

/// Writes a look file.
///
/// # Errors
/// A message: the name does not end in `.toml`, or the file cannot be written.
pub fn write_look(settings: &Settings, path: &Path) -> Result<(), String> {
    let cannot = |why: &dyn std::fmt::Display| format!("cannot write {}: {why}", path.display());
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
        return Err(cannot(&"the name of a look file ends in .toml"));
    }
    check_place(path)?;
    part::replace(path, settings.to_toml().as_bytes()).map_err(|error| cannot(&error))
}

/// Fails before any work if no picture can be written to `path`.
///
/// # Errors
/// As [`Encoding::of`] and [`check_place`].
pub fn check_path(path: &Path) -> Result<(), String> {
    check_ending(path)?;
    check_place(path)
}

/// Fails if no file can be written to `path`, whatever its extension.
///
/// # Errors
/// The folder does not exist, or `path` is a folder.
pub fn check_place(path: &Path) -> Result<(), String> {
    let cannot = |why: String| Err(format!("cannot write {}: {why}", path.display()));
    if path.is_dir() {
        return cannot("it is a folder".to_owned());
    }
    let target = match follow_links(path) {
        Ok(target) => target,
        Err(error) => return cannot(error.to_string()),
    };
    match target.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        Some(folder) if !is_stream(path) && !is_descriptor(path) && !folder.is_dir() => {
            cannot(format!("there is no folder {}", folder.display()))
        }
        _ => Ok(()),
    }
}

/// `out` with the mode's name before the extension: `helmet.png` becomes `helmet.metallic.png`.
pub fn path_of_mode(out: &Path, slug: &str) -> PathBuf {
    let ending = out.extension().unwrap_or_default().to_string_lossy();
    // Some file systems do not allow a colon in names.
    out.with_extension(format!("{}.{ending}", slug.replace(':', "-")))
}

/// Writes a capture to a file, as [`write_image`] does: a PNG gets 8-bit color with the settings and files, an EXR or an array the raw
/// values.
///
/// # Errors
/// As [`write_image`].
pub fn write(capture: &Capture, work: &SessionState, path: &Path) -> Result<(), String> {
    write_as(capture, work, path, Encoding::of(path)?)
}

/// [`write()`] with an encoding that the extension need not name.
///
/// # Errors
/// The system cannot write it.
pub fn write_as(capture: &Capture, work: &SessionState, path: &Path, encoding: Encoding) -> Result<(), String> {
    let cannot = |why: String| format!("cannot write {}: {why}", path.display());
    let size = (capture.width, capture.height);
    let bytes = match encoding {
        Encoding::Png => look::encode(capture, work, path.parent().unwrap_or(Path::new(""))).map_err(cannot)?,
        Encoding::Npy { raw: true } => npy::of_floats(size, &capture.raw),
        Encoding::Npy { raw: false } => npy::of_bytes(size, &capture.rgba8),
        Encoding::Exr => {
            let floats = capture.raw.iter().flatten().copied().collect();
            let image = ImageBuffer::from_raw(capture.width, capture.height, floats).map(DynamicImage::ImageRgba32F);
            let image = image.ok_or_else(|| cannot("the picture's size does not match its pixels".to_owned()))?;
            encoded(&image, ImageFormat::OpenExr).map_err(cannot)?
        }
    };
    write_bytes(&bytes, path).map_err(|e| cannot(e.to_string()))
}

/// Writes an image whole: to a temporary file beside `path`, which then takes the name, so that no reader ever sees half a
/// picture, and the old file stays when anything fails. Through a symbolic link, the file that it leads to is replaced. A
/// pipe or a device is written to directly.
///
/// # Errors
/// No picture format has the file extension, the format cannot hold the image, or the system cannot write it.
pub fn write_image(image: &DynamicImage, path: &Path) -> Result<(), String> {
    let cannot = |why: String| format!("cannot write {}: {why}", path.display());
    let size = (image.width(), image.height());
    let bytes = match (Encoding::of(path)?, image) {
        (Encoding::Png, _) => encoded(image, ImageFormat::Png).map_err(cannot)?,
        (Encoding::Exr, _) => encoded(image, ImageFormat::OpenExr).map_err(cannot)?,
        (Encoding::Npy { .. }, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_)) => {
            let pixels: Vec<[f32; 4]> = image.to_rgba32f().pixels().map(|pixel| pixel.0).collect();
            npy::of_floats(size, &pixels)
        }
        (Encoding::Npy { .. }, _) => npy::of_bytes(size, image.to_rgba8().as_raw()),
    };
    write_bytes(&bytes, path).map_err(|e| cannot(e.to_string()))
}

fn encoded(image: &DynamicImage, format: ImageFormat) -> Result<Vec<u8>, String> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}

/// Replaces the content of a file at once, through symbolic links, with the permissions that it has.
///
/// # Errors
/// The system cannot write it; the file is then as it was.
pub fn replace_file(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut replacement = Replacement::begin(path)?;
    replacement.file.write_all(bytes)?;
    replacement.finish()
}

/// The next content of a file, written piece by piece to a temporary file beside it. The file stays as it was until
/// [`Replacement::finish`]; a replacement that is dropped unfinished leaves nothing.
pub(crate) struct Replacement {
    target: PathBuf,
    pub(crate) file: PartFile,
}

impl Replacement {
    /// Creates the temporary file. Through symbolic links, it is beside the file that they lead to.
    pub(crate) fn begin(path: &Path) -> io::Result<Self> {
        let target = follow_links(path)?;
        let file = PartFile::create(&target)?;
        Ok(Self { target, file })
    }

    /// Replaces the file, whose permissions stay.
    pub(crate) fn finish(self) -> io::Result<()> {
        let permissions = self.target.metadata().ok().map(|metadata| metadata.permissions());
        self.file.finish()?;
        permissions.map_or(Ok(()), |permissions| std::fs::set_permissions(&self.target, permissions))
    }
}

fn write_bytes(bytes: &[u8], path: &Path) -> io::Result<()> {
    if is_descriptor(path) {
        return OpenOptions::new().write(true).truncate(true).open(path)?.write_all(bytes);
    }
    if is_stream(path) {
        let _reader = open_pipe(path)?;
        return OpenOptions::new().write(true).open(path)?.write_all(bytes);
    }
    part::replace(&follow_links(path)?, bytes)
}

/// Opens a pipe, if `path` leads to one. Fails if nobody reads it: opening it in the usual way would wait for a reader, perhaps for ever.
fn open_pipe(path: &Path) -> io::Result<Option<File>> {
    #[cfg(target_os = "linux")]
    if std::os::unix::fs::FileTypeExt::is_fifo(&path.metadata()?.file_type()) {
        let mut options = OpenOptions::new();
        std::os::unix::fs::OpenOptionsExt::custom_flags(
            &mut options,
            rustix::fs::OFlags::NONBLOCK.bits().cast_signed(),
        );
        let opened = options.write(true).open(path);
        return opened.map(Some).map_err(|error| io::Error::other(format!("nobody reads this pipe ({error})")));
    }
    Ok(None)
}

/// Whether `path` names an open file of this process by its number. Such a file need not have a name of its own, as one in memory.
fn is_descriptor(path: &Path) -> bool {
    ["/proc/self/fd", "/dev/fd"].iter().any(|folder| path.parent() == Some(Path::new(folder))) && !is_stream(path)
}

/// Whether `path` leads to a pipe, a device or a socket.
fn is_stream(path: &Path) -> bool {
    path.metadata().is_ok_and(|metadata| !metadata.is_file() && !metadata.is_dir())
}

/// The file to which `path` leads, which need not exist.
fn follow_links(path: &Path) -> io::Result<PathBuf> {
    let mut target = path.to_owned();
    for _ in 0..MAX_LINKS {
        if !target.is_symlink() {
            return Ok(target);
        }
        let link = target.read_link()?;
        target = target.parent().unwrap_or(Path::new("")).join(link);
    }
    Err(io::Error::other(format!("more than {MAX_LINKS} symbolic links lead to each other")))
}

/// Whether a file with this name holds linear light, before the tone map.
pub fn holds_light(path: &Path) -> bool {
    Encoding::of(path).is_ok_and(Encoding::holds_light)
}
