//! OpenEXR files.

use exr::image::write::layers::WritableLayers;
use exr::prelude::*;

use super::{error, float_image, load};

type Value = (f32, f32, f32);

/// A 4x2 image whose pixel (x, y) is (x, y, 0.5), except for the given ones.
fn value(replaced: &[(usize, usize, Value)], at: Vec2<usize>) -> Value {
    let found = replaced.iter().find(|(x, y, _)| (*x, *y) == (at.x(), at.y()));
    found.map_or((at.x() as f32, at.y() as f32, 0.5), |(_, _, value)| *value)
}

fn encode(compression: Compression, blocks: Blocks, replaced: &'static [(usize, usize, Value)]) -> Vec<u8> {
    let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
    let channels = SpecificChannels::rgb(|at: Vec2<usize>| value(replaced, at));
    write(Image::from_layer(Layer::new((4, 2), LayerAttributes::default(), encoding, channels)))
}

fn write<L: for<'a> WritableLayers<'a>>(image: Image<L>) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

fn plain(replaced: &'static [(usize, usize, Value)]) -> Vec<u8> {
    encode(Compression::ZIP16, Blocks::ScanLines, replaced)
}

#[test]
fn known_values() {
    let compressions = [Compression::Uncompressed, Compression::RLE, Compression::ZIP1, Compression::PIZ];
    let tiles = Blocks::Tiles(Vec2(3, 2));
    for (compression, blocks) in compressions.iter().flat_map(|c| [(*c, Blocks::ScanLines), (*c, tiles)]) {
        let environment = load("a.exr", &encode(compression, blocks, &[])).unwrap();
        assert_eq!((environment.width, environment.height, environment.peak), (4, 2, 3.0));
        for (i, pixel) in environment.pixels.iter().enumerate() {
            assert_eq!(*pixel, [(i % 4) as f32, (i / 4) as f32, 0.5, 1.0], "{compression} {blocks:?}");
        }
        assert!(environment.warnings.is_empty());
    }
}

#[test]
fn values_that_are_no_light() {
    let message = error("a.exr", &plain(&[(2, 1, (0.0, f32::NAN, 0.0)), (3, 1, (f32::NAN, 0.0, 0.0))]));
    assert!(
        message.contains("has 2 pixels that cannot be light: the first is NaN in green at x = 2, y = 1"),
        "{message}"
    );
    let message = error("a.exr", &plain(&[(0, 1, (0.0, 0.0, -0.25))]));
    assert!(
        message.contains("has 1 pixel that cannot be light: the first is -0.25 in blue at x = 0, y = 1"),
        "{message}"
    );
    let message = error("a.exr", &plain(&[(3, 0, (f32::INFINITY, 0.0, 0.0))]));
    assert!(message.contains("the first is inf in red at x = 3, y = 0"), "{message}");
}

#[test]
fn other_channels() {
    let names = ["Y", "Diffuse.R", "Diffuse.G"];
    let channel = |name: &&str| AnyChannel::new(*name, FlatSamples::F32(vec![1.0; 8]));
    let channels = AnyChannels::sort(names.iter().map(channel).collect());
    let message = error("a.exr", &write(Image::from_channels((4, 2), channels)));
    assert!(message.contains("with the channels Diffuse.G, Diffuse.R, Y, expected channels R, G and B"), "{message}");
}

#[test]
fn parts_deep_data_and_crops() {
    let part = |name: &str| {
        let attributes = LayerAttributes::named(name);
        let channels = SpecificChannels::rgb(|at: Vec2<usize>| value(&[], at));
        Layer::new((4, 2), attributes, Encoding::FAST_LOSSLESS, channels)
    };
    let parts = Image::from_layers(ImageAttributes::with_size((4, 2)), vec![part("left"), part("right")]);
    assert!(error("a.exr", &write(parts)).contains("is an EXR with several parts, expected one flat part"));

    let mut deep = plain(&[]);
    deep[5] |= 0x08;
    assert!(error("a.exr", &deep).contains("is a deep EXR"));

    let mut cropped = Image::from_layer(part("cropped"));
    cropped.attributes.display_window = IntegerBounds::from_dimensions((8, 4));
    let message = error("a.exr", &write(cropped));
    assert!(message.contains("stores 4x2 pixels at 0, 0 of a picture of 8x4 at 0, 0"), "{message}");
}

#[test]
fn other_primaries_are_told() {
    let mut image = Image::from_channels((4, 2), SpecificChannels::rgb(|at: Vec2<usize>| value(&[], at)));
    image.attributes.chromaticities = Some(exr::meta::attribute::Chromaticities {
        red: Vec2(0.713, 0.293),
        green: Vec2(0.165, 0.830),
        blue: Vec2(0.128, 0.044),
        white: Vec2(0.32168, 0.33767),
    });
    assert!(load("a.exr", &write(image)).unwrap().warnings[0].contains("primaries other than Rec. 709"));
}

/// The data window is four i32 (inclusive bounds) after the attribute's name, type and size.
#[test]
fn sizes_that_the_file_cannot_hold() {
    let with_size = |compression, width: i32, height: i32| {
        let mut bytes = encode(compression, Blocks::ScanLines, &[]);
        // Most writers omit this attribute; here it would contradict the new size.
        let count = bytes.windows(11).position(|window| window == b"chunkCount\0").unwrap();
        bytes[count] = b'x';
        for name in [&b"dataWindow\0box2i\0"[..], b"displayWindow\0box2i\0"] {
            let at = bytes.windows(name.len()).position(|window| window == name).unwrap() + name.len() + 4 + 8;
            bytes[at..at + 4].copy_from_slice(&(width - 1).to_le_bytes());
            bytes[at + 4..at + 8].copy_from_slice(&(height - 1).to_le_bytes());
        }
        error("a.exr", &bytes)
    };
    let assert_says = |compression, width, height, words: &str| {
        let message = with_size(compression, width, height);
        assert!(message.contains(words), "{width}x{height}: {message}");
    };
    assert_says(Compression::ZIP16, 20000, 10000, "has 20000x10000 pixels, expected 1x1 to");
    assert_says(Compression::ZIP16, i32::MAX / 2, i32::MAX / 2, "expected");
    assert_says(Compression::ZIP16, 16384, 8192, "cut short: its header says 16384x8192");
    assert_says(Compression::Uncompressed, 64, 2, "cut short: its header says 64x2");
    assert_says(Compression::ZIP16, 0, 0, "found");
}

#[test]
fn cut_short_at_every_byte() {
    for compression in [Compression::Uncompressed, Compression::ZIP1, Compression::PIZ] {
        let whole = encode(compression, Blocks::ScanLines, &[]);
        load("a.exr", &whole).unwrap();
        for length in 0..whole.len() {
            assert!(load("a.exr", &whole[..length]).is_err(), "{compression}: {length} of {} bytes", whole.len());
        }
    }
}

/// The decoder panics on some of these. The panic is caught on the calling thread, and the process continues.
#[test]
fn every_byte_changed() {
    for compression in [Compression::ZIP16, Compression::B44] {
        let whole = encode(compression, Blocks::ScanLines, &[]);
        for (at, value) in (0..whole.len()).flat_map(|at| [0, 127, 255].map(|value| (at, value))) {
            let mut bytes = whole.clone();
            bytes[at] = value;
            if let Ok(environment) = float_image::decode(&bytes) {
                assert_eq!(environment.pixels.len(), (environment.width * environment.height) as usize);
            }
        }
    }
}

/// The decoder of some compressions panics at damaged data. That is caught, and an error like others.
#[test]
fn damaged_files_are_errors_or_images() {
    let tiles = Blocks::Tiles(Vec2(3, 2));
    let compressions =
        [Compression::Uncompressed, Compression::RLE, Compression::ZIP16, Compression::PIZ, Compression::PXR24];
    let files =
        compressions.map(|compression| [Blocks::ScanLines, tiles].map(|blocks| encode(compression, blocks, &[])));
    let b44 = [Compression::B44, Compression::B44A].map(|compression| encode(compression, Blocks::ScanLines, &[]));
    let files: Vec<&[u8]> = files.iter().flatten().chain(&b44).map(Vec::as_slice).collect();
    crate::damaged::each(300, &files, |bytes| drop(float_image::decode(bytes)));
}
