//! Valid and invalid files of both formats, through `Measured::open`.

use std::cell::RefCell;
use std::f32::consts::{FRAC_PI_2, PI};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use glam::{Mat3, Vec3};

use super::kind::MERL_HEADER_BYTES;
use super::{MeasuredBrdf, MeasuredKind, merl, recognize, utia};

const MERL_PLANE: usize = 90 * 90 * 180;
const UTIA_PLANE: usize = 288 * 288;

/// Lambert plus GGX of roughness 0.4 with height-correlated Smith and Schlick's Fresnel, as in shaders/brdf.
fn analytic(l: Vec3, v: Vec3) -> Vec3 {
    let alpha2 = 0.4f32.powi(4);
    let h = (l + v).normalize();
    let d = alpha2 / (PI * (h.z * h.z * (alpha2 - 1.0) + 1.0).powi(2));
    let root = |c: f32| (c * c * (1.0 - alpha2) + alpha2).sqrt();
    let visibility = 0.5 / (v.z * root(l.z) + l.z * root(v.z));
    let fresnel = 0.04 + 0.96 * (1.0 - v.dot(h)).powi(5);
    Vec3::new(0.6, 0.3, 0.1) / PI * (1.0 - fresnel) + Vec3::splat(d * visibility * fresnel)
}

fn direction(theta_deg: f32, phi_deg: f32) -> Vec3 {
    let (sin_theta, cos_theta) = theta_deg.to_radians().sin_cos();
    let (sin_phi, cos_phi) = phi_deg.to_radians().sin_cos();
    Vec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
}

/// Pairs of directions, evenly spread in theta (up to `largest_deg`) and phi by a Kronecker sequence of square roots.
fn pairs(count: usize, largest_deg: f32) -> impl Iterator<Item = (Vec3, Vec3)> {
    let fraction = |n: usize, root: f64| (n as f64 * root).fract() as f32;
    (1..=count).map(move |n| {
        let l = direction(largest_deg * fraction(n, 2f64.sqrt()), 360.0 * fraction(n, 3f64.sqrt()));
        (l, direction(largest_deg * fraction(n, 5f64.sqrt()), 360.0 * fraction(n, 7f64.sqrt())))
    })
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

fn open(name: &str, bytes: &[u8]) -> MeasuredBrdf {
    let folder = tempfile::tempdir().unwrap();
    MeasuredBrdf::open(&write(folder.path(), name, bytes)).unwrap()
}

fn refusal(name: &str, bytes: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    MeasuredBrdf::open(&write(folder.path(), name, bytes)).unwrap_err().to_string()
}

/// Overwrites double number `index` of the file's data with `value`.
fn poke(bytes: &mut [u8], header: usize, index: usize, value: f64) {
    bytes[header + 8 * index..][..8].copy_from_slice(&value.to_le_bytes());
}

/// Encoded once, since each has 35 MB.
static MERL_BYTES: LazyLock<Vec<u8>> = LazyLock::new(|| MeasuredKind::Merl.encode(analytic));
static MERL: LazyLock<MeasuredBrdf> = LazyLock::new(|| open("plastic.binary", &MERL_BYTES));
static UTIA: LazyLock<MeasuredBrdf> = LazyLock::new(|| open("plastic.bin", &MeasuredKind::Utia.encode(analytic)));

#[test]
fn merl_gives_back_the_brdf_that_it_was_made_of() {
    assert_eq!((MERL.name.as_str(), MERL.kind), ("plastic", MeasuredKind::Merl));
    assert!(MERL.files[0].is_absolute() && MERL.files[0].ends_with("plastic.binary"), "{:?}", MERL.files);
    assert_eq!(MERL.warnings, Vec::<String>::new());

    // Linear interpolation errs by up to (step^2 / 8) |f''|: 0.26 % of f over theta_h (most on the highlight's flank,
    // at 15 degrees), 0.61 % over theta_d (most where Fresnel and visibility rise together, in the mirror direction at
    // 75 degrees), 0.01 % over phi_d. The sum is below 0.9 %; taking bins at their lower edges would err by 8 %.
    let mut worst = 0.0f32;
    for (l, v) in pairs(20_000, 75.0) {
        let expected = analytic(l, v);
        worst = worst.max(((MERL.evaluate(l, v) - expected) / expected).abs().max_element());
    }
    assert!(worst < 0.009, "{worst}");

    // On the peak itself, where theta_h's bins are hundredths of a degree wide.
    for theta in [0.0, 20.0, 60.0] {
        let (l, v) = (direction(theta, 30.0), direction(theta, 210.0));
        let (found, expected) = (MERL.evaluate(l, v), analytic(l, v));
        assert!(((found - expected) / expected).abs().max_element() < 0.009, "{theta}: {found} {expected}");
    }
}

#[test]
fn merl_is_reciprocal_and_isotropic() {
    for (n, (l, v)) in pairs(2_000, 89.0).enumerate() {
        let found = MERL.evaluate(l, v);
        let turned = Mat3::from_rotation_z(n as f32);
        for other in [MERL.evaluate(v, l), MERL.evaluate(turned * l, turned * v)] {
            assert!((other - found).abs().max_element() <= 2e-3 * found.max_element(), "{l} {v}: {found} {other}");
        }
    }
}

/// The layout according to the database's description: the angles of one bin, and where its numbers are in the file.
#[test]
fn merl_values_are_where_the_format_has_them() {
    let (theta_h, theta_d, phi_d) = (30, 20, 45);
    let mut bytes = MERL_BYTES.clone();
    let index = phi_d + 180 * (theta_d + 90 * theta_h);
    for (channel, stored) in [1500.0 * 2.0, 1500.0 / 1.15 * 3.0, 1500.0 / 1.66 * 4.0].into_iter().enumerate() {
        poke(&mut bytes, 12, channel * MERL_PLANE + index, stored);
    }
    let d = direction(20.5, 45.5);
    let onto_h = Mat3::from_rotation_z(1.0) * Mat3::from_rotation_y(FRAC_PI_2 * (30.5f32 / 90.0).powi(2));
    let (l, v) = (onto_h * d, onto_h * Vec3::new(-d.x, -d.y, d.z));
    let merl = open("a.binary", &bytes);
    for found in [merl.evaluate(l, v), merl.evaluate(v, l)] {
        assert!(found.abs_diff_eq(Vec3::new(2.0, 3.0, 4.0), 1e-2), "{found}");
    }
}

#[test]
fn merl_has_no_dark_rim_at_the_horizon() {
    let chalk = open("chalk.binary", &MeasuredKind::Merl.encode(|_, _| Vec3::splat(0.25)));
    for (l, v) in pairs(20_000, 89.99) {
        let found = chalk.evaluate(l, v);
        assert!(found.abs_diff_eq(Vec3::splat(0.25), 1e-6), "{l} {v}: {found}");
    }
    assert_eq!(chalk.evaluate(direction(90.1, 0.0), Vec3::Z), Vec3::ZERO);
    assert_eq!(chalk.evaluate(Vec3::Z, direction(120.0, 0.0)), Vec3::ZERO);
}

#[test]
fn utia_gives_back_every_direction_that_it_holds() {
    assert_eq!((UTIA.name.as_str(), UTIA.kind), ("plastic", MeasuredKind::Utia));
    assert_eq!(UTIA.warnings, Vec::<String>::new());
    for n in 0..2_000 {
        let (l, v) = (n * 37 % 288, n * 101 % 288);
        let at = |n: usize| direction(15.0 * (n / 48) as f32, 7.5 * (n % 48) as f32);
        let (found, expected) = (UTIA.evaluate(at(l), at(v)), analytic(at(l), at(v)));
        // The angles went through sine and arctangent, which err by 1e-6 of a step, and f is steep beside a highlight.
        assert!(((found - expected) / expected).abs().max_element() < 1e-4, "{l} {v}: {found} {expected}");
    }
}

/// A smooth function that differs in all four angles, so that a swapped or mirrored angle changes the result.
fn woven(l: Vec3, v: Vec3) -> Vec3 {
    Vec3::new(1.0 + 0.5 * l.x, 1.0 + 0.5 * v.y, 1.0 + 0.5 * l.y * v.x)
}

#[test]
fn utia_is_linear_between_its_directions_and_holds_the_last_beyond_75_degrees() {
    let cloth = open("cloth.bin", &MeasuredKind::Utia.encode(woven));
    // The error is at most the sum of (step^2 / 8) |f''| over the angles. 0.5 sin cos has second derivatives of at most
    // 0.5, with steps of 15 and 7.5 degrees: (0.0685 + 0.0171) / 8 * 0.5 for red and green, twice that for blue.
    let bound = Vec3::new(0.00536, 0.00536, 0.01072);
    let mut worst = Vec3::ZERO;
    for (l, v) in pairs(20_000, 75.0) {
        worst = worst.max((cloth.evaluate(l, v) - woven(l, v)).abs());
    }
    assert!(worst.cmple(bound).all() && worst.cmpge(0.5 * bound).all(), "{worst}, expected just below {bound}");

    let found = cloth.evaluate(direction(88.0, 15.0), direction(80.0, 300.0));
    assert!(found.abs_diff_eq(woven(direction(75.0, 15.0), direction(75.0, 300.0)), 1e-4), "{found}");
}

#[test]
fn utia_values_are_where_the_format_has_them() {
    let mut bytes = MeasuredKind::Utia.encode(analytic);
    // Light at theta 30, phi 15 degrees; view at theta 60, phi 352.5 degrees.
    let index = 288 * (48 * 2 + 2) + 48 * 4 + 47;
    for channel in 0..3 {
        poke(&mut bytes, 0, channel * UTIA_PLANE + index, 2.0 + channel as f64);
    }
    let found = open("a.bin", &bytes).evaluate(direction(30.0, 15.0), direction(60.0, 352.5));
    assert!(found.abs_diff_eq(Vec3::new(2.0, 3.0, 4.0), 1e-3), "{found}");
}

#[test]
fn warnings_tell_what_is_odd() {
    // 1 in 100 is normal.
    let few = |l: Vec3, v: Vec3| if l.z * v.z > 0.99 { Vec3::splat(-0.1) } else { analytic(l, v) };
    let few = open("few.binary", &MeasuredKind::Merl.encode(few));
    assert_eq!((few.warnings.len(), few.evaluate(Vec3::Z, Vec3::Z)), (0, Vec3::ZERO));

    let many = |l: Vec3, v: Vec3| if l.z > 0.7 { Vec3::splat(-0.1) } else { analytic(l, v) };
    for (kind, name) in [(MeasuredKind::Merl, "many.binary"), (MeasuredKind::Utia, "many.bin")] {
        let many = open(name, &kind.encode(many));
        assert!(many.warnings.len() == 1 && many.warnings[0].contains("are negative"), "{:?}", many.warnings);
        assert!(many.values.iter().all(|&value| value >= 0.0));
    }

    // Lambertian with an albedo of 2 in red. The first ring, 1.7 %, is not counted.
    let bright = open("bright.bin", &MeasuredKind::Utia.encode(|_, _| Vec3::new(2.0, 0.5, 0.5) / PI));
    assert!(bright.warnings.len() == 1 && bright.warnings[0].contains("reflects 2.0 times"), "{:?}", bright.warnings);
}

#[test]
fn bad_files_are_refused_with_what_was_found_and_expected() {
    let utia = MeasuredKind::Utia.encode(analytic);
    let header = |dimensions: [i32; 3]| dimensions.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>();
    let with = |index: usize, value: f64| {
        let mut bytes = utia.clone();
        poke(&mut bytes, 0, index, value);
        bytes
    };
    let mut infinite = MERL_BYTES.clone();
    poke(&mut infinite, 12, MERL_PLANE + 7, f64::INFINITY);

    let cases: [(&str, &[u8], &[&str]); 13] = [
        ("a.binary", &[], &["is empty", "34992012 bytes", "1990656 bytes"]),
        ("a.binary", &header([90, 90, 360]), &["90 x 90 x 360", "expected 90 x 90 x 180"]),
        ("a.binary", &header([-1, i32::MAX, 0]), &["a MERL file (.binary, 34992012 bytes", "found a file of 12 bytes"]),
        ("a.dat", &header([64, 64, 64]), &["64 x 64 x 64", "expected 90 x 90 x 180"]),
        ("a.binary", &header([90, 90, 180]), &["has 12 bytes, expected 34992012 of a MERL file", "cut short"]),
        ("a.binary", &MERL_BYTES[..utia.len()], &["has 1990656 bytes, expected 34992012", "cut short"]),
        ("a.binary", &[&MERL_BYTES[..], &[0]].concat(), &["has 34992013 bytes", "more than the data"]),
        (
            "a.bin",
            &utia[..1_000_000],
            &["has 1000000 bytes, expected 1990656 of a UTIA file", "cut short", "the .gltf beside it"],
        ),
        ("a.binary", &[1, 2, 3], &["not a measured BRDF", "of 3 bytes"]),
        ("a.png", &utia[..1_000_000], &["not a measured BRDF", "of 1000000 bytes"]),
        ("a.binary", &infinite, &["holds inf at green value 7"]),
        ("a.bin", &with(2 * UTIA_PLANE + 5, f64::NAN), &["holds NaN at blue value 5"]),
        ("a.bin", &with(3, 1e300), &["at red value 3"]),
    ];
    for (name, bytes, expected) in cases {
        let message = refusal(name, bytes);
        for part in expected.iter().chain(&[name]) {
            assert!(message.contains(part), "expected `{part}` in: {message}");
        }
    }
    for (name, kind) in [("a.binary", MeasuredKind::Merl), ("a.bin", MeasuredKind::Utia)] {
        let message = refusal(name, &kind.encode(|_, _| Vec3::ZERO));
        assert!(message.contains("is black"), "{message}");
    }

    let folder = tempfile::tempdir().unwrap();
    let message = |path: &Path| MeasuredBrdf::open(path).unwrap_err().to_string();
    assert!(message(folder.path()).contains("is not a file"));
    assert!(message(&folder.path().join("absent.bin")).contains("cannot be read"));
    // A correct header in a file of a terabyte: refused by its length, not read.
    let huge = write(folder.path(), "huge.binary", &header([90, 90, 180]));
    std::fs::File::options().write(true).open(&huge).unwrap().set_len(1 << 40).unwrap();
    assert!(message(&huge).contains("has 1099511627776 bytes, expected 34992012"));
}

/// Damages the start of a file of `few`, in memory: files of 2 and 35 MB are too large to write ten thousand of each.
fn damage(few: usize, extension: &str, whole: &[u8]) {
    /// The header of a MERL file and some numbers.
    const START: usize = 256;

    let bytes = RefCell::new(whole.to_vec());
    crate::damaged::each(few, &[&whole[..START]], |start| {
        let length = (whole.len() - START + start.len()) as u64;
        let header = &start[..start.len().min(MERL_HEADER_BYTES)];
        let kind = recognize(header, length, Some(extension.as_ref()));
        if let Some(kind) = kind.ok().filter(|_| start.len() == START) {
            let mut bytes = bytes.borrow_mut();
            bytes[..START].copy_from_slice(start);
            drop(match kind {
                MeasuredKind::Merl => merl::decode(&bytes),
                MeasuredKind::Utia => utia::decode(&bytes),
            });
        }
    });
}

#[test]
fn damaged_merl_files_cause_no_panic() {
    damage(30, "binary", &MERL_BYTES);
}

#[test]
fn damaged_utia_files_cause_no_panic() {
    damage(100, "bin", &MeasuredKind::Utia.encode(analytic));
}
