//! Radiance HDR files.

use super::*;

/// An HDR file with flat RGBE pixels, row by row.
fn flat(width: usize, rgbe: &[[u8; 4]]) -> Vec<u8> {
    let size = format!("-Y {} +X {width}\n", rgbe.len() / width);
    with_header("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n", &size, rgbe.as_flattened())
}

fn with_header(header: &str, size: &str, pixels: &[u8]) -> Vec<u8> {
    [header.as_bytes(), size.as_bytes(), pixels].concat()
}

/// 16x2 pixels with new run lengths: red constantly 128, green 0 to 15, blue 0, exponent 129 (so that 128 is 1.0).
fn run_lengths() -> Vec<u8> {
    let row = |exponent: u8| {
        let literal: Vec<u8> = (0..16).collect();
        [&[2, 2, 0, 16][..], &[128 + 16, 128], &[16], &literal, &[128 + 16, 0], &[128 + 16, exponent]].concat()
    };
    with_header("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n", "-Y 2 +X 16\n", &[row(129), row(130)].concat())
}

#[test]
fn known_values() {
    // mantissa * 2^(exponent - 136): Ward 1991, "Real Pixels".
    let environment = load("a.hdr", &flat(2, &[[128, 64, 32, 129], [0, 0, 0, 0]])).unwrap();
    assert_eq!((environment.width, environment.height, environment.name.as_str()), (2, 1, "a"));
    assert_eq!(environment.pixels, [[1.0, 0.5, 0.25, 1.0], [0.0, 0.0, 0.0, 1.0]]);
    assert_eq!((environment.peak, environment.warnings.len()), (1.0, 0));

    let environment = load("a.pic", &run_lengths()).unwrap();
    for (i, pixel) in environment.pixels.iter().enumerate() {
        let scale = if i < 16 { 1.0 } else { 2.0 };
        assert_eq!(*pixel, [scale, scale * (i % 16) as f32 / 128.0, 0.0, 1.0], "{i}");
    }
    // Old run lengths: repeats the previous pixel 3 + 1 * 256 times. The first line has the other common form.
    let old = [[128, 128, 128, 129], [1, 1, 1, 3], [1, 1, 1, 1]];
    let old = with_header("#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n", "-Y 1 +X 260\n", old.as_flattened());
    assert_eq!(load("a.hdr", &old).unwrap().pixels, [[1.0; 4]; 260]);
}

#[test]
fn a_bright_pixel_at_three_quarters_lights_from_plus_x() {
    let mut pixels = [[0; 4]; 16 * 8];
    pixels[4 * 16 + 12] = [128, 128, 128, 129];
    pixels[3 * 16 + 11] = [128, 128, 128, 129];
    let environment = load("a.hdr", &flat(16, &pixels)).unwrap();
    let at = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z].map(|n| environment.irradiance(n).x);
    assert!(at[0] > 0.2 && at[0] > 4.0 * at[2], "{at:?}");
    assert!(at[1] == 0.0 && (at[2] - at[3]).abs() < 1e-5 && (at[4] - at[5]).abs() < 1e-5, "{at:?}");
}

#[test]
fn exposure_of_the_header_is_divided_out() {
    let header = "#?RADIANCE\nEXPOSURE=2\nEXPOSURE=4\nFORMAT=32-bit_rle_rgbe\n\n";
    let pixels = [[128, 128, 128, 130]; 2];
    let environment = load("a.hdr", &with_header(header, "-Y 1 +X 2\n", pixels.as_flattened())).unwrap();
    assert_eq!(environment.pixels[0], [0.25, 0.25, 0.25, 1.0]);
    assert!(environment.warnings[0].contains("EXPOSURE"));
    for exposure in ["0", "-1", "NaN", "inf", "1e-40"] {
        let header = header.replace("=2\n", &format!("={exposure}\n"));
        let message = error("a.hdr", &with_header(&header, "-Y 1 +X 2\n", pixels.as_flattened()));
        assert!(message.contains("EXPOSURE") && message.contains("expected positive"), "{message}");
    }
}

#[test]
fn warnings() {
    let black = load("a.hdr", &flat(2, &[[0; 4]; 2])).unwrap();
    assert!(black.warnings[0].contains("black everywhere") && black.warnings.len() == 1);
    let square = load("a.hdr", &flat(2, &[[128; 4]; 4])).unwrap();
    assert!(square.warnings[0].contains("2x2 pixels") && square.warnings.len() == 1);
}

/// The resolution string names the axes in the order of the file: scan lines along the second, each next one along the first
/// (Radiance's `resolu.h`).
#[test]
fn all_eight_orientations() {
    let upright: Vec<[u8; 4]> = (1..=8).map(|value| [value * 8, value * 16, 0, 129]).collect();
    let expected = load("a.hdr", &flat(4, &upright)).unwrap();
    for (line, along_rows) in [
        ("-Y 2 +X 4", true),
        ("-Y 2 -X 4", true),
        ("+Y 2 +X 4", true),
        ("+Y 2 -X 4", true),
        ("+X 4 -Y 2", false),
        ("-X 4 -Y 2", false),
        ("+X 4 +Y 2", false),
        ("-X 4 +Y 2", false),
    ] {
        let (mut xs, mut ys): (Vec<usize>, Vec<usize>) = ((0..4).collect(), (0..2).collect());
        if line.contains("-X") {
            xs.reverse();
        }
        if line.contains("+Y") {
            ys.reverse();
        }
        let places: Vec<(usize, usize)> = match along_rows {
            true => ys.iter().flat_map(|y| xs.iter().map(move |x| (*x, *y))).collect(),
            false => xs.iter().flat_map(|x| ys.iter().map(move |y| (*x, *y))).collect(),
        };
        let pixels: Vec<[u8; 4]> = places.into_iter().map(|(x, y)| upright[y * 4 + x]).collect();
        let header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
        let environment = load("a.hdr", &with_header(header, &format!("{line}\n"), pixels.as_flattened())).unwrap();
        assert_eq!((environment.width, environment.height), (4, 2), "{line}");
        assert_eq!(environment.pixels, expected.pixels, "{line}");
    }
}

/// Each face has its own color, so directions show which face is where.
#[test]
fn crosses_and_strips_of_cube_faces() {
    let side = 4;
    // Right, left, up, down, front (-Z), back.
    let directions = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::NEG_Z, Vec3::Z];
    let layouts = [
        (4, 3, [(2, 1), (0, 1), (1, 0), (1, 2), (1, 1), (3, 1)], "horizontal cross"),
        (3, 4, [(2, 1), (0, 1), (1, 0), (1, 2), (1, 1), (1, 3)], "vertical cross"),
        (6, 1, [(0, 0), (1, 0), (2, 0), (3, 0), (4, 0), (5, 0)], "from left to right"),
        (1, 6, [(0, 0), (0, 1), (0, 2), (0, 3), (0, 4), (0, 5)], "one below the other"),
    ];
    for (columns, rows, faces, name) in layouts {
        let mut pixels = vec![[0_u8; 4]; columns * rows * side * side];
        for (number, (column, row)) in faces.into_iter().enumerate() {
            for at in 0..side * side {
                let (x, y) = (column * side + at % side, row * side + at / side);
                pixels[y * columns * side + x] = [16 * (number as u8 + 1), 0, 0, 129];
            }
        }
        let environment = load("a.hdr", &flat(columns * side, &pixels)).unwrap();
        assert_eq!((environment.width, environment.height), (16, 8), "{name}");
        assert!(environment.warnings[0].contains(name), "{:?}", environment.warnings);
        for (number, direction) in directions.into_iter().enumerate() {
            let uv = uv_from_direction(direction);
            let (x, y) = ((uv.x * 16.0).min(15.0) as usize, (uv.y * 8.0).min(7.0) as usize);
            let expected = 16.0 * (number as f32 + 1.0) / 128.0;
            assert_eq!(environment.pixels[y * 16 + x][0], expected, "{name}: {direction}");
        }
    }
}

/// In the vertical cross, the back is upside down, so that it goes on below the lower face.
#[test]
fn neighboring_faces_of_a_cross_go_on_in_each_other() {
    let side = 8;
    let down_to_back = |y: usize| if y < 2 * side { 0 } else { (y - 2 * side) as u8 * 8 };
    let pixels: Vec<[u8; 4]> = (0..12 * side * side).map(|at| [down_to_back(at / (3 * side)), 0, 0, 129]).collect();
    let environment = load("a.hdr", &flat(3 * side, &pixels)).unwrap();
    // From the front's lower edge over the nadir and up the back.
    let red = |degrees: f32| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let uv = uv_from_direction(Vec3::new(0.0, -cos, -sin));
        let (width, height) = (environment.width as usize, environment.height as usize);
        let (x, y) = ((uv.x * width as f32) as usize % width, ((uv.y * height as f32) as usize).min(height - 1));
        environment.pixels[y * width + x][0]
    };
    let path: Vec<f32> = [40.0, 20.0, 0.0, -20.0, -40.0, -60.0, -80.0].map(red).to_vec();
    assert!(path.windows(2).all(|pair| pair[0] < pair[1] + 1e-3) && path[6] > path[0] + 0.5, "{path:?}");
}

#[test]
fn cut_short_at_every_byte() {
    for whole in [run_lengths(), flat(4, &[[9, 8, 7, 129]; 8])] {
        load("a.hdr", &whole).unwrap();
        for length in 0..whole.len() {
            assert!(load("a.hdr", &whole[..length]).is_err(), "{length} of {} bytes", whole.len());
        }
    }
    let whole = run_lengths();
    assert!(error("a.hdr", &whole[..whole.len() - 1]).contains("cut short"));
}

#[test]
fn every_byte_changed() {
    let whole = run_lengths();
    for (at, value) in (0..whole.len()).flat_map(|at| [0, 1, 2, 127, 128, 255].map(|value| (at, value))) {
        let mut bytes = whole.clone();
        bytes[at] = value;
        let _ = load("a.hdr", &bytes);
    }
}

#[test]
fn bad_headers() {
    let message = |header: &str, size: &str| error("a.hdr", &with_header(header, size, &[0; 64]));
    let good = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    assert!(message(good, "-Y 9000 +X 18000\n").contains("has 18000x9000 pixels, expected 1x1 to 16384x8192"));
    assert!(message(good, "-Y 4294967295 +X 4294967295\n").contains("4294967295"));
    assert!(message(good, "-Y 0 +X 4\n").contains("has 4x0 pixels"));
    assert!(message(good, "-Y 4096 +X 8192\n").contains("cut short: its header says 8192x4096 pixels"));
    assert!(
        message(good, "+Y 4 +Y 8\n").contains("does not decode") || message(good, "+Y 4 +Y 8\n").contains("expected")
    );
    assert!(message(good, "-Y four +X 8\n").contains("height"));
    assert!(message(&good.replace("rgbe", "xyze"), "-Y 4 +X 8\n").contains("32-bit_rle_xyze"));
}

#[test]
fn damaged_files_cause_no_panic() {
    let (packed, plain) = (run_lengths(), flat(4, &[[9, 8, 7, 129]; 8]));
    crate::damaged::each(300, &[&packed, &plain], |bytes| drop(load("a.hdr", bytes)));
}
