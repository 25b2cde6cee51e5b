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
    let message = error("a.exr", &plain(&[(3, 0, (f32::INFINITY, 0.0, 0.0))]));
    assert!(message.contains("the first is inf in red at x = 3, y = 0"), "{message}");
}

#[test]
fn negative_values_are_counted_and_become_0() {
    let environment = load("a.exr", &plain(&[(0, 1, (0.0, 0.0, -0.25)), (1, 1, (-1e-7, -1e-6, 2.0))])).unwrap();
    assert_eq!(environment.pixels[4..6], [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 2.0, 1.0]]);
    assert_eq!(environment.warnings.len(), 1);
    let warning = &environment.warnings[0];
    assert!(warning.contains("2 pixels of the environment are negative, down to -0.25"), "{warning}");
}

/// A 4x2 file with these channels, each with the same value everywhere.
fn flat(channels: &[(&str, f32)]) -> Vec<u8> {
    let channel = |(name, value): &(&str, f32)| AnyChannel::new(*name, FlatSamples::F32(vec![*value; 8]));
    write(Image::from_channels((4, 2), AnyChannels::sort(channels.iter().map(channel).collect())))
}

#[test]
fn other_channels() {
    let message = error("a.exr", &flat(&[("Z", 1.0), ("Diffuse.R", 1.0), ("Diffuse.G", 1.0)]));
    assert!(
        message.contains("with the channels Diffuse.G, Diffuse.R, Z, expected channels R, G and B, or Y"),
        "{message}"
    );
}

#[test]
fn luminance_with_and_without_chroma() {
    let gray = load("a.exr", &flat(&[("Y", 0.5)])).unwrap();
    let is = |pixel: [f32; 4], expected: [f32; 3]| {
        assert!(pixel.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-3), "{pixel:?}, expected {expected:?}");
    };
    is(gray.pixels[7], [0.5; 3]);
    // 0.2126 + 0.7152 * 2 + 0.0722 * 4 = 1.9318.
    let y = 1.9318;
    let color = load("a.exr", &flat(&[("Y", y), ("RY", 1.0 / y - 1.0), ("BY", 4.0 / y - 1.0)])).unwrap();
    is(color.pixels[7], [1.0, 2.0, 4.0]);
}

/// Files that OpenEXR 3.3 has written: one sample of RY and BY for four pixels, in whole and half blocks of lines.
#[test]
fn subsampled_chroma_is_interpolated() {
    for bytes in SUBSAMPLED {
        let environment = load("a.exr", bytes).unwrap();
        assert_eq!((environment.width, environment.height), (64, 34));
        for (at, pixel) in environment.pixels.iter().enumerate() {
            let (x, y) = (at % 64, at / 64);
            let luminance = 1.0 + (x / 8) as f32 * 0.25 + (y / 8) as f32 * 0.5;
            // Beyond the last sample there is none to go on to.
            let red = (x.min(62) as f32 / 64.0 + 2.0) * luminance;
            let blue = (y.min(32) as f32 / 32.0 + 2.0) * luminance;
            let green = (luminance - 0.2126 * red - 0.0722 * blue) / 0.7152;
            let expected = [red, green, blue];
            let is_near = |(a, b): (&f32, f32)| (a - b).abs() < 2e-3 * b.abs();
            assert!(pixel.iter().zip(expected).all(is_near), "{x}, {y}: {pixel:?}, expected {expected:?}");
        }
    }
    let mut odd = SUBSAMPLED[0].to_vec();
    let at = odd.windows(3).position(|window| window == b"RY\0").unwrap() + 3 + 8;
    odd[at] = 3;
    assert!(error("a.exr", &odd).contains("size of a subsampled channel"), "{}", error("a.exr", &odd));
}

const SUBSAMPLED: [&[u8]; 2] = [
    include_bytes!("../../../../tests/textures/chroma_zip.exr"),
    include_bytes!("../../../../tests/textures/chroma_piz.exr"),
];

#[test]
fn the_first_part_with_color_is_used() {
    let part = |name: &str, channels: &[&str], value: f32| {
        let channel = |name: &&str| AnyChannel::new(*name, FlatSamples::F32(vec![value; 8]));
        let channels = AnyChannels::sort(channels.iter().map(channel).collect());
        Layer::new((4, 2), LayerAttributes::named(name), Encoding::FAST_LOSSLESS, channels)
    };
    let parts =
        vec![part("depth", &["Z"], 9.0), part("left", &["R", "G", "B"], 1.0), part("right", &["R", "G", "B"], 2.0)];
    let environment = load("a.exr", &write(Image::from_layers(ImageAttributes::with_size((4, 2)), parts))).unwrap();
    assert_eq!(environment.pixels, [[1.0; 4]; 8]);
    assert!(environment.warnings[0].contains("has 3 parts: 'left' is used"), "{:?}", environment.warnings);

    let mut deep = plain(&[]);
    deep[5] |= 0x08;
    assert!(error("a.exr", &deep).contains("is a deep EXR"));
}

#[test]
fn a_part_of_a_picture_and_more_than_it() {
    let windowed = |display: IntegerBounds, position: (i32, i32)| {
        let attributes = LayerAttributes { layer_position: position.into(), ..LayerAttributes::default() };
        let channels = SpecificChannels::rgb(|at: Vec2<usize>| value(&[], at));
        let mut image = Image::from_layer(Layer::new((4, 2), attributes, Encoding::FAST_LOSSLESS, channels));
        image.attributes.display_window = display;
        write(image)
    };
    // The stored 4x2 pixels are at 2, 1 of 8x4.
    let crop = windowed(IntegerBounds::new((-1, 0), (8, 4)), (1, 1));
    let environment = load("a.exr", &crop).unwrap();
    assert_eq!((environment.width, environment.height), (8, 4));
    for (at, pixel) in environment.pixels.iter().enumerate() {
        let (x, y) = (at % 8, at / 8);
        let is_stored = (2..6).contains(&x) && (1..3).contains(&y);
        let expected = if is_stored { [(x - 2) as f32, (y - 1) as f32, 0.5, 1.0] } else { [0.0, 0.0, 0.0, 1.0] };
        assert_eq!(*pixel, expected, "{x}, {y}");
    }
    assert!(environment.warnings[0].contains("stores 4x2 pixels at 2, 1 of a picture of 8x4"));
    // Overscan: two columns of four are the picture.
    let overscan = load("a.exr", &windowed(IntegerBounds::new((0, 0), (2, 1)), (-1, 0))).unwrap();
    assert_eq!(overscan.pixels, [[1.0, 0.0, 0.5, 1.0], [2.0, 0.0, 0.5, 1.0]]);
    let tiny = error("a.exr", &windowed(IntegerBounds::new((0, 0), (16384, 8192)), (0, 0)));
    assert!(tiny.contains("stores less than 1/64 of its picture"), "{tiny}");
}

#[test]
fn other_primaries_are_converted() {
    let with = |chromaticities, color: Value| {
        let mut image = Image::from_channels((4, 2), SpecificChannels::rgb(move |_: Vec2<usize>| color));
        image.attributes.chromaticities = chromaticities;
        load("a.exr", &write(image)).unwrap()
    };
    let xyz = exr::meta::attribute::Chromaticities {
        red: Vec2(1.0, 0.0),
        green: Vec2(0.0, 1.0),
        blue: Vec2(0.0, 0.0),
        white: Vec2(1.0 / 3.0, 1.0 / 3.0),
    };
    // The XYZ of Rec. 709's green, and of its white (IEC 61966-2-1).
    for (color, expected) in [((0.3576, 0.7152, 0.1192), [0.0, 1.0, 0.0]), ((0.9505, 1.0, 1.089), [1.0; 3])] {
        let environment = with(Some(xyz), color);
        let pixel = environment.pixels[0];
        assert!(pixel.iter().zip(expected).all(|(a, b)| (a - b).abs() < 2e-3), "{pixel:?}");
    }
    // ITU-R BT.2020 has colors that Rec. 709 lacks.
    let wide = exr::meta::attribute::Chromaticities {
        red: Vec2(0.708, 0.292),
        green: Vec2(0.170, 0.797),
        blue: Vec2(0.131, 0.046),
        white: Vec2(0.3127, 0.3290),
    };
    let green = with(Some(wide), (0.0, 1.0, 0.0));
    assert!(green.pixels[0][0] == 0.0 && green.pixels[0][1] > 1.1 && green.warnings[0].contains("8 pixels"));
    // An identical set changes nothing.
    let rec_709 = exr::meta::attribute::Chromaticities {
        red: Vec2(0.64, 0.33),
        green: Vec2(0.3, 0.6),
        blue: Vec2(0.15, 0.06),
        white: Vec2(0.3127, 0.329),
    };
    assert_eq!(with(Some(rec_709), (1.0, 2.0, 3.0)).pixels, with(None, (1.0, 2.0, 3.0)).pixels);
}

/// Radiance of a scene without symmetries, by a direction in OpenEXR's space (ImfEnvmap.h).
fn scene([x, y, z]: [f32; 3]) -> Value {
    (2.0 + x + 0.5 * y * z, 2.0 + y - 0.5 * x, 2.0 + z + 0.25 * x * y)
}

#[test]
fn a_cube_and_a_latitude_longitude_map_of_a_scene_are_alike() {
    use std::f32::consts::PI;
    let with = |size: (usize, usize), map, pixel: &dyn Fn(usize, usize) -> Value| {
        let pixels: Vec<Value> = (0..size.0 * size.1).map(|at| pixel(at % size.0, at / size.0)).collect();
        let channels = SpecificChannels::rgb(move |at: Vec2<usize>| pixels[at.y() * size.0 + at.x()]);
        let attributes = LayerAttributes { environment_map: Some(map), ..LayerAttributes::default() };
        load("a.exr", &write(Image::from_layer(Layer::new(size, attributes, Encoding::FAST_LOSSLESS, channels))))
            .unwrap()
    };
    // LatLongMap::direction: longitude goes down from left to right.
    let flat = with((64, 32), exr::meta::attribute::EnvironmentMap::LatitudeLongitude, &|x, y| {
        let latitude = PI * (0.5 - (y as f32 + 0.5) / 32.0);
        let longitude = PI * (1.0 - 2.0 * (x as f32 + 0.5) / 64.0);
        scene([longitude.sin() * latitude.cos(), latitude.sin(), longitude.cos() * latitude.cos()])
    });
    // CubeMap::direction: faces +X -X +Y -Y +Z -Z, one below the other.
    let side = 16;
    let cube = with((side, 6 * side), exr::meta::attribute::EnvironmentMap::Cube, &|column, row| {
        let (x, y) = (column, row % side);
        let at = |pixel: usize| pixel as f32 / (side - 1) as f32 * 2.0 - 1.0;
        let (right, left, down, up) = (at(x), at(side - 1 - x), at(y), at(side - 1 - y));
        let [x, y, z] = match row / side {
            0 => [1.0, up, right],
            1 => [-1.0, up, left],
            2 => [right, 1.0, up],
            3 => [right, -1.0, down],
            4 => [left, up, 1.0],
            _ => [right, up, -1.0],
        };
        let length = (x * x + y * y + z * z).sqrt();
        scene([x / length, y / length, z / length])
    });
    assert_eq!((cube.width, cube.height), (64, 32));
    for (at, (a, b)) in cube.pixels.iter().zip(&flat.pixels).enumerate() {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.03), "{}, {}: {a:?} {b:?}", at % 64, at / 64);
    }
    assert!(flat.warnings.is_empty() && cube.warnings[0].contains("its attribute envmap"), "{:?}", cube.warnings);
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
    let files = files.iter().flatten().chain(&b44).map(Vec::as_slice);
    let files: Vec<&[u8]> = files.chain(SUBSAMPLED).collect();
    crate::damaged::each(300, &files, |bytes| drop(float_image::decode(bytes)));
}
