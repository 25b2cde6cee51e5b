//! The settings and the files behind a picture, in its PNG file: a text chunk with the keyword `specula` holds the settings as a look file does, and one with
//! the keyword `specula-files` the model, the shader tree and other files, with paths from the picture's folder.

use std::fmt;
use std::io::{self, BufReader, Cursor, Read as _};
use std::path::{Component, Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::recovery::SessionState;
use crate::regular_file;
use crate::render::Capture;
use crate::scene::BUILT_IN;
use crate::settings::{LookError, Settings};

/// Keyword of the chunk of settings.
const SETTINGS: &str = "specula";
/// Keyword of the chunk of files.
const FILES: &str = "specula-files";
/// Most bytes of a look file, and most chunks before the pixels of a picture, that are read to tell whether there is a look.
const GLANCE: u64 = 64 << 10;
const MOST_CHUNKS: usize = 64;

/// The content of a look file, or of the texts in a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// The settings, with file paths as the picture found them.
    pub settings: Settings,
    /// The model's file, or the name of a built-in one. `None`: the file does not say.
    pub model: Option<PathBuf>,
    /// The scene of the model's file. `None`: the file's own.
    pub scene: Option<usize>,
    /// The shader tree. `None`: the built-in one, or the file does not say.
    pub shaders: Option<PathBuf>,
}

/// Why a look was not read.
#[derive(Debug)]
pub enum ReadError {
    /// The file cannot be read, or is a PNG without settings. The message names it.
    File(String),
    /// Its text is not a look file.
    Text(LookError),
}

/// The files behind a picture.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
struct Files {
    model: Option<PathBuf>,
    scene: Option<usize>,
    shaders: Option<PathBuf>,
    environment: Option<PathBuf>,
    measured: Option<PathBuf>,
    /// The models beside the first; an empty path for one that is built in.
    added: Vec<PathBuf>,
    /// The folder for which the picture was written, where the files are found if the picture alone was moved.
    folder: Option<PathBuf>,
}

impl Files {
    /// The files of a picture that is written to `folder`.
    fn of(work: &SessionState, folder: &Path) -> Self {
        let is_built_in = |path: &Path| BUILT_IN.iter().any(|name| Path::new(name) == path);
        let place = |path: &Path| path.exists().then(|| from_folder(path, folder));
        let model = work.model.clone().unwrap_or_else(|| BUILT_IN[0].into());
        Self {
            model: if is_built_in(&model) { Some(model) } else { place(&model) },
            scene: work.scene,
            shaders: work.tree.as_deref().and_then(place),
            environment: place(Path::new(&work.settings.environment.name)),
            measured: place(Path::new(&work.settings.measured)),
            added: work.settings.added.iter().map(|model| place(Path::new(&model.file)).unwrap_or_default()).collect(),
            folder: in_full(folder).ok(),
        }
    }

    /// The look with these files, resolved from the picture's folder.
    fn look(self, mut settings: Settings, folder: &Path) -> Look {
        // A missing file keeps its name, and whoever opens it reports the error.
        let found = |path: PathBuf| {
            let places = [Some(folder), self.folder.as_deref()].into_iter().flatten();
            places.map(|folder| folder.join(&path)).find(|there| there.exists()).unwrap_or(path)
        };
        let put = |name: &mut String, path: Option<PathBuf>| {
            if let Some(there) = path.map(found).filter(|there| there.exists()) {
                *name = there.display().to_string();
            }
        };
        put(&mut settings.environment.name, self.environment);
        put(&mut settings.measured, self.measured);
        let files = self.added.into_iter().map(|path| Some(path).filter(|path| !path.as_os_str().is_empty()));
        settings.added.iter_mut().zip(files).for_each(|(model, path)| put(&mut model.file, path));
        Look { settings, model: self.model.map(found), scene: self.scene, shaders: self.shaders.map(found) }
    }
}

/// The bytes of a PNG file in `folder`, with the settings and files of `work`.
pub(super) fn encode(capture: &Capture, work: &SessionState, folder: &Path) -> Result<Vec<u8>, String> {
    let files = toml::to_string(&Files::of(work, folder)).unwrap_or_default();
    let mut bytes = Cursor::new(Vec::new());
    let written = || -> Result<(), png::EncodingError> {
        let mut encoder = png::Encoder::new(&mut bytes, capture.width, capture.height);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Fast);
        encoder.add_itxt_chunk(SETTINGS.to_owned(), work.settings.to_toml())?;
        encoder.add_itxt_chunk(FILES.to_owned(), files)?;
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&capture.rgba8)?;
        writer.finish()
    };
    written().map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}

/// The relative path from `folder` to a path, with `..` where they part, so that both can be moved together. Unchanged if there
/// is none.
fn from_folder(path: &Path, folder: &Path) -> PathBuf {
    let (Ok(path_in_full), Ok(folder)) = (path.canonicalize(), in_full(folder)) else { return path.to_owned() };
    let (to, from): (Vec<_>, Vec<_>) = (path_in_full.components().collect(), folder.components().collect());
    let common = to.iter().zip(&from).take_while(|(a, b)| a == b).count();
    if common == 0 {
        return path_in_full;
    }
    let up = from[common..].iter().map(|_| Component::ParentDir);
    up.chain(to[common..].iter().copied()).collect()
}

/// A folder in full; an empty path is the working directory.
fn in_full(folder: &Path) -> io::Result<PathBuf> {
    if folder.as_os_str().is_empty() { Path::new(".").canonicalize() } else { folder.canonicalize() }
}

/// Reads a look file, or the texts in a PNG file of Specula.
///
/// # Errors
/// The file cannot be read, is a PNG without settings, or its text is no look. Values are not checked against their ranges.
pub fn read_look(path: &Path) -> Result<Look, ReadError> {
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
        let text = regular_file::read_text(path)
            .map_err(|e| ReadError::File(format!("{}: the look file cannot be read: {e}", path.display())))?;
        let settings = Settings::from_toml(&text).map_err(ReadError::Text)?;
        return Ok(Look { settings, model: None, scene: None, shaders: None });
    }
    let (text, files) = decode(path).map_err(|why| ReadError::File(format!("{}: {why}", path.display())))?;
    let settings = Settings::from_toml(&text).map_err(ReadError::Text)?;
    // The files of another version may be unreadable.
    let files: Files = files.and_then(|files| toml::from_str(&files).ok()).unwrap_or_default();
    Ok(files.look(settings, path.parent().unwrap_or(Path::new(""))))
}

/// The same look with values clamped to their ranges.
///
/// # Errors
/// A message with the position of what is wrong.
pub fn read_checked_look(path: &Path) -> Result<Look, String> {
    let error = |problem: &dyn fmt::Display| format!("{}: {problem}", path.display());
    let look = read_look(path).map_err(|why| match why {
        ReadError::File(message) => message,
        ReadError::Text(text) => error(&text),
    })?;
    look.settings.check().map_err(|problem| error(&problem))?;
    Ok(look)
}

/// Whether a file may hold a look, at a glance: a PNG has the chunk of settings before its pixels, and a look file names a setting.
pub fn may_hold_look(path: &Path) -> bool {
    match path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
        true => has_settings(path).unwrap_or(false),
        false => glance(path).is_ok_and(|text| Settings::may_be_toml(&text)),
    }
}

/// The begin of a text. The end of a longer one may be missing, so that it is no TOML.
fn glance(path: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    regular_file::open(path)?.into_inner().take(GLANCE).read_to_end(&mut bytes)?;
    // The limit may cut a character.
    if let Err(error) = std::str::from_utf8(&bytes)
        && error.error_len().is_none()
    {
        bytes.truncate(error.valid_up_to());
    }
    String::from_utf8(bytes).map_err(io::Error::other)
}

/// Whether a chunk before the pixels of a PNG is that of settings. Of each chunk, its head and keyword are read.
fn has_settings(path: &Path) -> io::Result<bool> {
    const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";
    let mut file = BufReader::with_capacity(64, regular_file::open(path)?.into_inner());
    let mut signature = [0; 8];
    file.read_exact(&mut signature)?;
    if signature != SIGNATURE {
        return Ok(false);
    }
    let keyword = [SETTINGS.as_bytes(), &[0]].concat();
    for _ in 0..MOST_CHUNKS {
        let mut head = [0; 8];
        file.read_exact(&mut head)?;
        let (length, kind) = (u32::from_be_bytes([head[0], head[1], head[2], head[3]]), &head[4..]);
        if kind == b"IDAT" || kind == b"IEND" {
            return Ok(false);
        }
        let mut start = vec![0; keyword.len().min(length as usize)];
        file.read_exact(&mut start)?;
        if kind == b"iTXt" && start == keyword {
            return Ok(true);
        }
        // The rest of the chunk and its checksum.
        file.seek_relative(i64::from(length) - start.len() as i64 + 4)?;
    }
    Ok(false)
}

/// The texts of settings and of files in a PNG file.
fn decode(path: &Path) -> Result<(String, Option<String>), String> {
    let file = regular_file::open(path).map_err(|e| format!("cannot be read: {e}"))?;
    let decoder = png::Decoder::new(BufReader::new(file));
    let reader = decoder.read_info().map_err(|e| format!("no PNG file: {e}"))?;
    let text = |keyword: &str| {
        let chunk = reader.info().utf8_text.iter().find(|chunk| chunk.keyword == keyword);
        chunk.cloned().map(unpacked).transpose().map_err(|why| format!("its settings cannot be read: {why}"))
    };
    let settings = text(SETTINGS)?.ok_or_else(|| "this PNG holds no settings of Specula".to_owned())?;
    Ok((settings, text(FILES)?))
}

/// The text of a chunk, which is packed in files of others. A small file could fill the memory.
fn unpacked(mut chunk: png::text_metadata::ITXtChunk) -> Result<String, String> {
    chunk.decompress_text_with_limit(regular_file::LONGEST_TEXT as usize).map_err(|error| error.to_string())?;
    let text = chunk.get_text().map_err(|error| error.to_string())?;
    if text.len() as u64 > regular_file::LONGEST_TEXT {
        return Err(format!("they have {} bytes; Specula reads at most {}", text.len(), regular_file::LONGEST_TEXT));
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    fn capture() -> Capture {
        Capture { width: 3, height: 2, rgba8: (0..3 * 2 * 4).collect(), ..Capture::default() }
    }

    #[test]
    fn settings_and_pixels_are_read_as_they_were_written() {
        let mut settings = Settings::default();
        (settings.mode, settings.view.ev) = ("d \u{3b1}".to_owned(), 1.5);
        let path = tempfile::Builder::new().suffix(".png").tempfile().unwrap();
        let work = SessionState { settings: Arc::new(settings.clone()), ..SessionState::default() };
        std::fs::write(path.path(), encode(&capture(), &work, Path::new("")).unwrap()).unwrap();
        let look = read_look(path.path()).unwrap();
        assert_eq!(look, Look { settings, model: Some(BUILT_IN[0].into()), scene: None, shaders: None });
        assert_eq!(image::open(path.path()).unwrap().into_rgba8().into_raw(), capture().rgba8);
    }

    #[test]
    fn files_are_found_after_their_folders_and_the_picture_moved_together() {
        let folder = tempfile::tempdir().unwrap();
        let first = folder.path().join("first");
        for name in ["pictures", "models", "glsl"] {
            std::fs::create_dir_all(first.join(name)).unwrap();
        }
        for name in ["models/duck.glb", "models/sky.hdr"] {
            std::fs::write(first.join(name), b"").unwrap();
        }
        let mut work = SessionState {
            model: Some(first.join("models/duck.glb")),
            scene: Some(1),
            tree: Some(first.join("glsl")),
            ..SessionState::default()
        };
        Arc::make_mut(&mut work.settings).environment.name = first.join("models/sky.hdr").display().to_string();
        let bytes = encode(&capture(), &work, &first.join("pictures")).unwrap();
        std::fs::write(first.join("pictures/look.png"), bytes).unwrap();
        let second = folder.path().join("second");
        std::fs::rename(first, &second).unwrap();
        let look = read_look(&second.join("pictures/look.png")).unwrap();
        let is = |path: Option<&Path>, name: &str| {
            assert_eq!(path.unwrap().canonicalize().unwrap(), second.join(name).canonicalize().unwrap());
        };
        is(look.model.as_deref(), "models/duck.glb");
        is(look.shaders.as_deref(), "glsl");
        is(Some(Path::new(&look.settings.environment.name)), "models/sky.hdr");
        assert_eq!(look.scene, Some(1));
    }

    #[test]
    fn files_are_found_after_the_picture_alone_moved() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["pictures", "glsl", "elsewhere/deep"] {
            std::fs::create_dir_all(folder.path().join(name)).unwrap();
        }
        let work = SessionState { tree: Some(folder.path().join("glsl")), ..SessionState::default() };
        let bytes = encode(&capture(), &work, &folder.path().join("pictures")).unwrap();
        let moved = folder.path().join("elsewhere/deep/look.png");
        std::fs::write(&moved, bytes).unwrap();
        let tree = read_look(&moved).unwrap().shaders.unwrap();
        assert_eq!(tree.canonicalize().unwrap(), folder.path().join("glsl").canonicalize().unwrap());
        // Without the place, its name stays.
        std::fs::remove_dir(folder.path().join("glsl")).unwrap();
        assert_eq!(read_look(&moved).unwrap().shaders, Some("../glsl".into()));
    }

    #[test]
    fn a_file_with_a_look_is_told_from_others() {
        let folder = tempfile::tempdir().unwrap();
        let is_look = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            may_hold_look(&path)
        };
        let with = encode(&capture(), &SessionState::default(), folder.path()).unwrap();
        let mut without = Cursor::new(Vec::new());
        image::RgbaImage::new(300, 200).write_to(&mut without, image::ImageFormat::Png).unwrap();
        let without = without.into_inner();
        assert!(is_look("a.png", &with) && !is_look("b.PNG", &without));
        assert!(!is_look("c.png", &with[..40]) && !is_look("d.png", b"") && !is_look("e.png", b"text"));
        assert!(is_look("f.toml", Settings::default().to_toml().as_bytes()));
        assert!(is_look("g.toml", b"[view]\nev = 1.0\n") && is_look("h.toml", b"[view\n"));
        // Longer than a glance, which ends within a character.
        let long = format!("mode = \"final\"\n# {}\n", "ä".repeat(GLANCE as usize));
        assert!(is_look("k.toml", long.as_bytes()));
        assert!(!is_look("i.toml", b"[package]\nname = \"a\"\n") && !is_look("j.toml", &[0xff; 9]));
        assert!(!may_hold_look(folder.path()));
    }

    #[test]
    fn a_file_without_settings_is_refused() {
        let message = |path: &Path| read_checked_look(path).unwrap_err();
        let path = tempfile::Builder::new().suffix(".png").tempfile().unwrap();
        image::RgbaImage::new(2, 2).save(path.path()).unwrap();
        assert!(message(path.path()).ends_with("this PNG holds no settings of Specula"));
        std::fs::write(path.path(), b"text").unwrap();
        assert!(message(path.path()).contains("no PNG file"));
    }

    /// A small file of packed text must not fill the memory.
    #[test]
    fn a_packed_text_is_limited() {
        let written = |text: String| {
            let file = tempfile::Builder::new().suffix(".png").tempfile().unwrap();
            let mut writer = png::Encoder::new(file.as_file(), 1, 1).write_header().unwrap();
            let mut chunk = png::text_metadata::ITXtChunk::new(SETTINGS, text);
            chunk.compressed = true;
            chunk.compress_text().unwrap();
            writer.write_text_chunk(&chunk).unwrap();
            writer.write_image_data(&[0]).unwrap();
            drop(writer);
            file
        };
        let look = written("mode = \"d\"".to_owned());
        assert_eq!(read_checked_look(look.path()).unwrap().settings.mode, "d");
        let bomb = written(format!("mode = \"{}\"", "A".repeat(20_000_000)));
        assert!(bomb.as_file().metadata().unwrap().len() < 100_000);
        let message = read_checked_look(bomb.path()).unwrap_err();
        assert!(message.contains("its settings cannot be read"), "{message}");
    }

    #[test]
    fn damaged_looks_cause_no_panic() {
        let folder = tempfile::tempdir().unwrap();
        let picture = encode(&capture(), &SessionState::default(), folder.path()).unwrap();
        let text = Settings::default().to_toml();
        for (name, whole) in [("look.png", &picture[..]), ("look.toml", text.as_bytes())] {
            let path = folder.path().join(name);
            crate::damaged::each(300, &[whole], |bytes| {
                std::fs::write(&path, bytes).unwrap();
                drop(read_checked_look(&path));
            });
        }
    }
}
