//! An animated WebP: the container (RFC 9649) around frames that libwebp encodes. Their colors are compressed with loss, which takes a tenth of
//! the bytes; numbered PNGs lose nothing.

use image::RgbaImage;

/// Quality of the colors, 0 to 100.
const QUALITY: f32 = 90.0;
/// Length of the chunk `VP8X` with its name and size, bytes.
const EXTENDED: usize = 18;
/// Largest width and height.
pub(super) const LARGEST: u32 = 16_383;

/// The frames so far.
pub(super) struct AnimatedWebP {
    size: (u32, u32),
    has_alpha: bool,
    /// Chunks `ANMF`.
    frames: Vec<u8>,
}

impl AnimatedWebP {
    pub(super) fn new(size: (u32, u32)) -> Self {
        Self { size, has_alpha: false, frames: Vec::new() }
    }

    /// Adds a frame that is shown for `ms` milliseconds.
    pub(super) fn add(&mut self, frame: &RgbaImage, ms: u32) -> Result<(), String> {
        let (width, height) = frame.dimensions();
        self.has_alpha |= frame.pixels().any(|pixel| pixel[3] != 255);
        let encoder = webp::Encoder::from_rgba(frame.as_raw(), width, height);
        let file = encoder.encode_simple(false, QUALITY).map_err(|error| format!("{error:?}"))?;
        // A file of one frame is `RIFF`, its size, `WEBP`, with alpha a chunk `VP8X`, and the chunks that also go into an animation.
        let still = file.get(12..).ok_or("a frame was not encoded whole")?;
        let still = if still.starts_with(b"VP8X") { still.get(EXTENDED..).unwrap_or_default() } else { still };
        let mut content = Vec::with_capacity(still.len() + 16);
        content.extend([u24(0), u24(0), u24(width - 1), u24(height - 1), u24(ms)].concat());
        // The frame replaces all earlier ones, also where it is transparent.
        content.push(0b10);
        content.extend_from_slice(still);
        chunk(&mut self.frames, b"ANMF", &content)
    }

    /// The bytes of the file, which repeats forever.
    pub(super) fn finish(self) -> Result<Vec<u8>, String> {
        const ANIMATION: u8 = 0b10;
        const ALPHA: u8 = 0b1_0000;
        let mut body = b"WEBP".to_vec();
        let flags = if self.has_alpha { ANIMATION | ALPHA } else { ANIMATION };
        let extended = [&[flags, 0, 0, 0][..], &u24(self.size.0 - 1), &u24(self.size.1 - 1)].concat();
        chunk(&mut body, b"VP8X", &extended)?;
        // Background color, and the number of repetitions: 0 is forever.
        chunk(&mut body, b"ANIM", &[0; 6])?;
        body.extend(self.frames);
        let mut file = Vec::with_capacity(body.len() + 8);
        chunk(&mut file, b"RIFF", &body)?;
        Ok(file)
    }
}

/// Adds a chunk: name, size, content, and a padding byte for an odd size.
fn chunk(to: &mut Vec<u8>, name: &[u8; 4], content: &[u8]) -> Result<(), String> {
    let size = u32::try_from(content.len()).map_err(|_| "the animation is larger than 4 GiB")?;
    to.extend_from_slice(name);
    to.extend(size.to_le_bytes());
    to.extend_from_slice(content);
    if content.len() % 2 == 1 {
        to.push(0);
    }
    Ok(())
}

/// A number of 24 bits.
fn u24(number: u32) -> [u8; 3] {
    let [a, b, c, _] = number.to_le_bytes();
    [a, b, c]
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use image::codecs::webp::WebPDecoder;
    use image::{AnimationDecoder as _, Rgba};

    use super::*;

    #[test]
    fn frames_are_read_nearly_as_they_were_added() {
        let frames: Vec<RgbaImage> =
            (0..3).map(|n| RgbaImage::from_fn(5, 3, |x, y| Rgba([n * 80, x as u8, y as u8, 255 - n * 100]))).collect();
        let mut animation = AnimatedWebP::new((5, 3));
        for frame in &frames {
            animation.add(frame, 40).unwrap();
        }
        let bytes = animation.finish().unwrap();
        let decoder = WebPDecoder::new(Cursor::new(bytes)).unwrap();
        let read = decoder.into_frames().collect_frames().unwrap();
        assert_eq!(read.len(), 3);
        for (read, frame) in read.iter().zip(&frames) {
            assert_eq!(read.delay().numer_denom_ms(), (40, 1));
            let pairs = read.buffer().pixels().zip(frame.pixels());
            for (read, pixel) in pairs {
                let apart = (0..3).map(|channel| read[channel].abs_diff(pixel[channel])).max().unwrap();
                assert!(apart < 12 && read[3] == pixel[3], "{read:?} of {pixel:?}");
            }
        }
    }
}
