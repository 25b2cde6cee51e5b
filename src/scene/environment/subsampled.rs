//! Reads an OpenEXR whose channels have fewer samples than pixels, as luminance and chroma have. The `exr` crate decompresses the chunks
//! of such a file, but refuses its header.

use std::io::Cursor;

use exr::block::chunk::CompressedBlock;
use exr::block::reader::Reader;
use exr::compression::Compression;
use exr::error::{Error, Result};
use exr::meta::header::Header;
use exr::prelude::{IntegerBounds, SampleType, Vec2, f16};

/// A file with subsampled channels.
pub struct Subsampled {
    /// The file with a header that says that every pixel has a sample of each channel.
    pub bytes: Vec<u8>,
    /// How many columns and rows share a sample, of each channel.
    sampling: Vec<Vec2<usize>>,
}

impl Subsampled {
    /// `None` if no channel of the first part is subsampled.
    pub fn find(bytes: &[u8]) -> Option<Self> {
        const CHANNELS: &[u8] = b"channels\0chlist\0";
        let start = bytes.windows(CHANNELS.len()).position(|window| window == CHANNELS)?;
        let word = |at: usize| Some(i32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
        let mut copy = bytes.to_vec();
        let mut sampling = Vec::new();
        // The list follows its size in bytes: name, type, flags, columns and rows of each channel, and an empty name.
        let mut at = start + CHANNELS.len() + 4;
        while let length @ 1.. = bytes.get(at..)?.iter().position(|byte| *byte == 0)? {
            at += length + 1 + 8;
            let step = |at| usize::try_from(word(at)?).ok();
            sampling.push(Vec2(step(at)?, step(at + 4)?));
            for place in [at, at + 4] {
                copy[place..place + 4].copy_from_slice(&1_i32.to_le_bytes());
            }
            at += 8;
        }
        sampling.iter().any(|steps| *steps != Vec2(1, 1)).then_some(Self { bytes: copy, sampling })
    }

    /// Reads the channels of these names, with values between samples interpolated. A channel that the file lacks is 0. `header` is
    /// that of [`Self::bytes`].
    pub fn read(&self, reader: Reader<Cursor<&[u8]>>, mut header: Header, names: [&str; 3]) -> Result<Vec<[f32; 4]>> {
        self.restore(&mut header)?;
        let (size, origin) = (header.layer_size, header.own_attributes.layer_position);
        let mut planes: Vec<Plane> =
            header.channels.list.iter().map(|found| Plane::new(size, found.sampling)).collect();
        for chunk in reader.all_chunks(false)? {
            let CompressedBlock::ScanLine(block) = chunk?.compressed_block else { continue };
            let first = usize::try_from(i64::from(block.y_coordinate) - i64::from(origin.y()));
            let Some(first) = first.ok().filter(|first| *first < size.height()) else {
                return Err(Error::Invalid("scan line".into()));
            };
            let rows = header.max_block_pixel_size().height().min(size.height() - first);
            let position = Vec2(origin.x(), block.y_coordinate);
            let section = IntegerBounds { position, size: Vec2(size.width(), rows) };
            let bytes = decompress(&mut header, block.compressed_pixels_le, section)?;
            let mut rest = bytes.as_slice();
            for row in first..first + rows {
                for (plane, channel) in planes.iter_mut().zip(&header.channels.list) {
                    plane.take(row, channel.sample_type, &mut rest)?;
                }
            }
        }
        let named = |name: &str| header.channels.list.iter().position(|channel| channel.name.eq(name));
        let chosen = names.map(|name| named(name).map(|index| &planes[index]));
        let pixel = |at: usize| {
            let value =
                |plane: Option<&Plane>| plane.map_or(0.0, |plane| plane.at(at % size.width(), at / size.width()));
            let [a, b, c] = chosen.map(value);
            [a, b, c, 1.0]
        };
        Ok((0..size.area()).map(pixel).collect())
    }

    /// Gives the channels of a header their own sampling again.
    fn restore(&self, header: &mut Header) -> Result<()> {
        // Samples of B44 are grouped by blocks of a channel, which the crate does not divide by its sampling.
        if matches!(header.compression, Compression::B44 | Compression::B44A) {
            return Err(Error::NotSupported("subsampled channels with the compression B44".into()));
        }
        let (size, position) = (header.layer_size, header.own_attributes.layer_position);
        for (channel, steps) in header.channels.list.iter_mut().zip(&self.sampling) {
            let fits = |step: usize, size: usize, position: i32| {
                i32::try_from(step).is_ok_and(|whole| step > 0 && position % whole == 0) && size.is_multiple_of(step)
            };
            if !fits(steps.x(), size.x(), position.x()) || !fits(steps.y(), size.y(), position.y()) {
                return Err(Error::Invalid("size of a subsampled channel".into()));
            }
            channel.sampling = *steps;
        }
        Ok(())
    }
}

/// The samples of some scan lines: for each line, those of each channel that has any there.
fn decompress(header: &mut Header, compressed: Vec<u8>, section: IntegerBounds) -> Result<Vec<u8>> {
    let rows =
        |step: usize| (section.position.y()..section.end().y()).filter(|y| y.rem_euclid(step as i32) == 0).count();
    let bytes_of = |channel: &exr::meta::attribute::ChannelDescription| {
        let (columns, rows) = (section.size.width() / channel.sampling.x(), rows(channel.sampling.y()));
        columns * rows * channel.sample_type.bytes_per_sample()
    };
    let bytes = header.channels.list.iter().map(bytes_of).sum::<usize>();
    // A block that compression does not shorten is stored as it is.
    if compressed.len() == bytes {
        return Ok(compressed);
    }
    // The crate computes the size of the samples from this.
    if bytes % section.size.area() != 0 {
        return Err(Error::NotSupported("channels whose samples are not shared by whole pixels".into()));
    }
    header.channels.bytes_per_pixel = bytes / section.size.area();
    header.compression.decompress_image_section_from_le(header, compressed, section, false)
}

/// The samples of a channel.
struct Plane {
    sampling: Vec2<usize>,
    size: Vec2<usize>,
    samples: Vec<f32>,
}

impl Plane {
    fn new(size: Vec2<usize>, sampling: Vec2<usize>) -> Self {
        let size = Vec2(size.x() / sampling.x(), size.y() / sampling.y());
        Self { sampling, size, samples: vec![0.0; size.area()] }
    }

    /// Takes the samples of a row of pixels, if it has any.
    fn take(&mut self, row: usize, kind: SampleType, bytes: &mut &[u8]) -> Result<()> {
        if !row.is_multiple_of(self.sampling.y()) {
            return Ok(());
        }
        let width = self.size.width();
        let length = width * kind.bytes_per_sample();
        let (own, rest) = bytes.split_at_checked(length).ok_or(Error::Invalid("number of samples".into()))?;
        *bytes = rest;
        let start = row / self.sampling.y() * width;
        for (sample, bytes) in self.samples[start..].iter_mut().zip(own.chunks_exact(kind.bytes_per_sample())) {
            *sample = match (kind, bytes) {
                (SampleType::F16, [a, b]) => f16::from_ne_bytes([*a, *b]).to_f32(),
                (SampleType::F32, [a, b, c, d]) => f32::from_ne_bytes([*a, *b, *c, *d]),
                (SampleType::U32, [a, b, c, d]) => u32::from_ne_bytes([*a, *b, *c, *d]) as f32,
                _ => return Err(Error::Invalid("type of a sample".into())),
            };
        }
        Ok(())
    }

    /// The value at a pixel. A sample lies at the first of the pixels that share it.
    fn at(&self, x: usize, y: usize) -> f32 {
        let along = |at: usize, step: usize, count: usize| {
            let low = at / step;
            (low, (low + 1).min(count - 1), (at % step) as f32 / step as f32)
        };
        let (left, right, s) = along(x, self.sampling.x(), self.size.x());
        let (top, bottom, t) = along(y, self.sampling.y(), self.size.y());
        let mix = |a: f32, b: f32, t: f32| if t > 0.0 { a + (b - a) * t } else { a };
        let row = |row: usize| {
            let start = row * self.size.width();
            mix(self.samples[start + left], self.samples[start + right], s)
        };
        mix(row(top), row(bottom), t)
    }
}
