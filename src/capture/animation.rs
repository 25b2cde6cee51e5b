//! Frames to a file: MP4, GIF, animated WebP, or numbered PNGs for another encoder.

use std::cell::RefCell;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, Frame, RgbaImage};

use super::CaptureError;
use super::mp4::Mp4;
use super::webp::{AnimatedWebP, LARGEST};
use super::write;
use crate::picture;

/// Frames a second that the formats can hold.
const FPS: std::ops::RangeInclusive<f32> = 0.1..=100.0;

/// The format of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Gif,
    WebP,
    Mp4,
    Frames,
}

/// An animation that is being written. Before [`Animation::finish`], nothing but numbered PNGs is on disk under its name.
pub struct Animation {
    path: PathBuf,
    fps: f32,
    /// Frames that are expected.
    expected: usize,
    size: Option<(u32, u32)>,
    encoder: Encoder,
    /// Frames so far.
    count: u32,
}

enum Encoder {
    Gif(Box<GifEncoder<Shared>>, Shared),
    /// `None` before the first frame.
    WebP(Option<AnimatedWebP>),
    /// `None` before the first frame.
    Mp4(Option<Box<Mp4>>),
    Frames,
}

/// Bytes that the encoder writes and the animation reads.
#[derive(Clone, Default)]
struct Shared(Rc<RefCell<Vec<u8>>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Fails before any work when no animation can be written to `path` at this speed.
///
/// # Errors
/// A message about the ending, the folder or the speed.
pub fn check_animation(path: &Path, fps: f32) -> Result<(), String> {
    format_of(path)?;
    if !FPS.contains(&fps) {
        return Err(format!("{fps} frames a second: an animation can have {} to {}", FPS.start(), FPS.end()));
    }
    match path.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.is_dir()) {
        Some(folder) => Err(format!("cannot write {}: there is no folder {}", path.display(), folder.display())),
        None => Ok(()),
    }
}

impl Animation {
    /// Begins an animation of about `expected` frames: with no more than that, the index of a video is at its beginning.
    ///
    /// # Errors
    /// As [`check_animation`].
    pub fn new(path: &Path, fps: f32, expected: usize) -> Result<Self, CaptureError> {
        check_animation(path, fps).map_err(CaptureError::Usage)?;
        let encoder = match format_of(path).map_err(CaptureError::Usage)? {
            Format::Gif => {
                let bytes = Shared::default();
                // Of 1 (best) to 30: colors are chosen from every 10th pixel.
                let mut encoder = GifEncoder::new_with_speed(bytes.clone(), 10);
                encoder.set_repeat(Repeat::Infinite).map_err(|error| CaptureError::Write(error.to_string()))?;
                Encoder::Gif(Box::new(encoder), bytes)
            }
            Format::WebP => Encoder::WebP(None),
            Format::Mp4 => Encoder::Mp4(None),
            Format::Frames => Encoder::Frames,
        };
        Ok(Self { path: path.to_owned(), fps, expected, size: None, encoder, count: 0 })
    }

    /// Adds a frame. All must have the size of the first.
    ///
    /// # Errors
    /// A size that the format cannot hold, or a file that cannot be written.
    pub fn add(&mut self, mut frame: RgbaImage) -> Result<(), CaptureError> {
        let cannot = |why: String| CaptureError::Write(format!("cannot write {}: {why}", self.path.display()));
        let size = *self.size.get_or_insert(frame.dimensions());
        if size != frame.dimensions() {
            return Err(cannot("its frames differ in size".to_owned()));
        }
        self.count += 1;
        let ms = (1000.0 / self.fps).round().max(1.0) as u32;
        match &mut self.encoder {
            Encoder::Gif(encoder, _) => {
                if size.0.max(size.1) > u32::from(u16::MAX) {
                    return Err(cannot("a GIF has at most 65535 pixels a side".to_owned()));
                }
                // GIF has no partly transparent pixels.
                frame.pixels_mut().for_each(|pixel| pixel.0[3] = if pixel[3] < 128 { 0 } else { 255 });
                let frame = Frame::from_parts(frame, 0, 0, Delay::from_numer_denom_ms(ms, 1));
                encoder.encode_frame(frame).map_err(|error| cannot(error.to_string()))
            }
            Encoder::WebP(animation) => {
                if size.0.max(size.1) > LARGEST {
                    return Err(cannot(format!("a WebP has at most {LARGEST} pixels a side")));
                }
                animation.get_or_insert_with(|| AnimatedWebP::new(size)).add(&frame, ms).map_err(cannot)
            }
            Encoder::Mp4(video) => {
                let video = match video {
                    Some(video) => video,
                    None => {
                        let begun = Mp4::begin(&self.path, self.fps, size, self.expected).map_err(cannot)?;
                        video.insert(Box::new(begun))
                    }
                };
                video.add(&frame).map_err(cannot)
            }
            Encoder::Frames => write(frame, &numbered(&self.path, self.count)),
        }
    }

    /// Writes the file.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn finish(self) -> Result<(), CaptureError> {
        let cannot = |why: String| CaptureError::Write(format!("cannot write {}: {why}", self.path.display()));
        let bytes = match self.encoder {
            Encoder::Gif(encoder, bytes) => {
                // The encoder writes the end of the file when it is dropped.
                drop(encoder);
                bytes.0.take()
            }
            Encoder::WebP(Some(animation)) => animation.finish().map_err(cannot)?,
            Encoder::Mp4(Some(video)) => return video.finish().map_err(cannot),
            Encoder::WebP(None) | Encoder::Mp4(None) => return Err(cannot("it has no frames".to_owned())),
            Encoder::Frames => return Ok(()),
        };
        picture::replace_file(&self.path, &bytes).map_err(|error| cannot(error.to_string()))
    }
}

/// `spin.png` becomes `spin.0001.png`.
fn numbered(path: &Path, number: u32) -> PathBuf {
    path.with_extension(format!("{number:04}.png"))
}

fn format_of(path: &Path) -> Result<Format, String> {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    match ending.as_str() {
        "gif" => Ok(Format::Gif),
        "webp" => Ok(Format::WebP),
        "png" => Ok(Format::Frames),
        "mp4" => Ok(Format::Mp4),
        "mov" | "mkv" | "webm" => Err(format!(
            "cannot write {0}: a video must end in .mp4. For another format, write numbered frames, as --out {1}, and join them: ffmpeg -i {2} {0}",
            path.display(),
            path.with_extension("png").display(),
            path.with_extension("%04d.png").display(),
        )),
        _ => Err(format!(
            "cannot write {}: an animation must end in .mp4, .gif or .webp, or in .png for numbered frames",
            path.display()
        )),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use image::codecs::gif::GifDecoder;
    use image::{AnimationDecoder as _, Rgba};

    use super::*;

    #[test]
    fn a_gif_holds_all_frames() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.gif");
        let mut animation = Animation::new(&path, 25.0, 3).unwrap();
        for value in [0, 120, 240] {
            animation.add(RgbaImage::from_pixel(8, 4, Rgba([value, 10, 20, 255]))).unwrap();
        }
        assert!(!path.exists(), "nothing is on disk before the end");
        assert!(animation.add(RgbaImage::new(9, 4)).is_err());
        animation.finish().unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let frames = GifDecoder::new(Cursor::new(bytes)).unwrap().into_frames().collect_frames().unwrap();
        assert_eq!(frames.len(), 3);
        assert_eq!(frames[0].delay().numer_denom_ms(), (40, 1));
        let reds: Vec<u8> = frames.iter().map(|frame| frame.buffer().get_pixel(3, 2)[0]).collect();
        assert!(reds[0] < 20 && reds[1].abs_diff(120) < 20 && reds[2] > 220, "{reds:?}");
    }

    #[test]
    fn frames_are_numbered() {
        let folder = tempfile::tempdir().unwrap();
        let mut animation = Animation::new(&folder.path().join("a.png"), 25.0, 2).unwrap();
        animation.add(RgbaImage::new(2, 2)).unwrap();
        animation.add(RgbaImage::new(2, 2)).unwrap();
        animation.finish().unwrap();
        assert!(folder.path().join("a.0001.png").exists() && folder.path().join("a.0002.png").exists());
    }

    #[test]
    fn what_cannot_be_written_is_told_at_once() {
        for (path, fps, part) in [
            ("a.webm", 25.0, "ffmpeg -i a.%04d.png a.webm"),
            ("a.jpg", 25.0, "must end in .mp4, .gif"),
            ("a.gif", 1000.0, "can have 0.1 to 100"),
            ("no-such-folder/a.gif", 25.0, "there is no folder"),
        ] {
            let error = check_animation(Path::new(path), fps).unwrap_err();
            assert!(error.contains(part), "{error}");
        }
    }
}
