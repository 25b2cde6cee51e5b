//! Valid and invalid images, and the built-in environments.

mod built_in;
mod hdr;
mod open_exr;

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::direction::{TexelDirections, texel_solid_angle};
use super::*;

impl Environment {
    /// Mean radiance over the sphere, linear RGB, weighted by solid angle.
    pub fn mean_radiance(&self) -> Vec3 {
        (self.integrate(|_| 1.0) / (4.0 * std::f64::consts::PI)).as_vec3()
    }

    /// Irradiance of a surface with the unit normal `n`, linear RGB: the integral of radiance times cos(theta) over the
    /// hemisphere. Sums over every texel, as a reference for faster methods.
    pub fn irradiance(&self, n: Vec3) -> Vec3 {
        self.integrate(|direction| f64::from(direction.dot(n).max(0.0))).as_vec3()
    }

    /// Integral of radiance times `weight` over the sphere.
    fn integrate(&self, weight: impl Fn(Vec3) -> f64 + Sync) -> glam::DVec3 {
        let (width, height) = (self.width as usize, self.height as usize);
        let directions = TexelDirections::new(width, height);
        let sums = self.pixels.par_chunks_exact(width.max(1)).enumerate().map(|(y, row)| {
            let texels = row.iter().zip(directions.row(y));
            let sum: glam::DVec3 = texels.map(|(&[r, g, b, _], at)| Vec3::new(r, g, b).as_dvec3() * weight(at)).sum();
            sum * texel_solid_angle(y, width, height)
        });
        // Collecting the rows before summing gives the same bits for any number of threads.
        sums.collect::<Vec<_>>().into_iter().sum()
    }
}

/// Writes bytes to a file and loads it as an environment.
fn load(name: &str, bytes: &[u8]) -> Result<Environment, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    let file = EnvironmentFile::open(path.to_str().unwrap()).unwrap();
    assert_eq!(file.files, std::slice::from_ref(&path));
    let decoded = file.decode();
    decoded.map_err(|error| {
        let (message, prefix) = (error.to_string(), format!("{}: ", path.display()));
        assert_eq!(error.files, [path]);
        // A caught panic would be a bug of the decoder, not an answer.
        assert!(!message.contains("decoder panicked"), "{message}");
        message.strip_prefix(&prefix).unwrap_or_else(|| panic!("no file name: {message}")).to_owned()
    })
}

fn error(name: &str, bytes: &[u8]) -> String {
    load(name, bytes).unwrap_err()
}

/// A file that is neither HDR nor EXR is refused, and the message names its format.
#[test]
fn other_files() {
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbImage::new(2, 1).write_to(&mut png, image::ImageFormat::Png).unwrap();
    assert!(error("a.hdr", b"").starts_with("is empty. Expected a Radiance HDR or OpenEXR image"));
    assert!(error("a.hdr", &png.into_inner()).starts_with("is a PNG image, of low dynamic range"));
    assert!(error("a.exr", &[0xff, 0xd8, 0xff, 0xe0, 0, 0]).starts_with("is a JPEG image"));
    assert!(error("a.exr", b"hello, world").contains("found 12 bytes of something else"));
    assert!(error("a.hdr", b"#").contains("found 1 bytes of something else"));
    let folder = tempfile::tempdir().unwrap();
    let missing = EnvironmentFile::open(folder.path().join("studo").to_str().unwrap()).unwrap_err();
    assert!(missing.to_string().contains("one of the built-in environments: studio, furnace, sky"), "{missing}");
    assert_eq!(missing.files, [folder.path().join("studo")]);
    let folder = EnvironmentFile::open(folder.path().to_str().unwrap()).unwrap_err();
    assert!(folder.to_string().contains("not a regular file"), "{folder}");
}

/// The fingerprint depends on the content, not the name, and is the same in every build.
#[test]
fn fingerprints() {
    let folder = tempfile::tempdir().unwrap();
    let fingerprint_of = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        EnvironmentFile::open(path.to_str().unwrap()).unwrap().fingerprint
    };
    let one = fingerprint_of("a.hdr", b"one");
    assert_eq!(one, fingerprint_of("b.hdr", b"one"));
    assert_ne!(one, fingerprint_of("a.hdr", b"onf"));
    assert_eq!(one, FINGERPRINT_OF_ONE);
    let built_in = BUILT_IN.map(|name| EnvironmentFile::open(name).unwrap().fingerprint);
    assert!(built_in[0] != built_in[1] && built_in[1] != built_in[2] && built_in[0] != built_in[2]);
}

/// XXH3 with 128 bits and the seed 2 of the bytes "one".
const FINGERPRINT_OF_ONE: u128 = 243_352_345_090_925_128_196_976_051_893_803_719_279;

/// The center column looks down -Z, the columns right of it towards +X, and the top row is +Y.
#[test]
fn directions() {
    let cases = [
        (Vec2::new(0.5, 0.5), Vec3::NEG_Z),
        (Vec2::new(0.75, 0.5), Vec3::X),
        (Vec2::new(0.25, 0.5), Vec3::NEG_X),
        (Vec2::new(1.0, 0.5), Vec3::Z),
        (Vec2::new(0.5, 0.0), Vec3::Y),
        (Vec2::new(0.5, 1.0), Vec3::NEG_Y),
    ];
    for (uv, expected) in cases {
        assert!(direction_from_uv(uv.x, uv.y).distance(expected) < 1e-6, "{uv}");
    }
    for (x, y) in (0..64).flat_map(|x| (0..32).map(move |y| (x, y))) {
        let uv = Vec2::new((x as f32 + 0.5) / 64.0, (y as f32 + 0.5) / 32.0);
        let direction = direction_from_uv(uv.x, uv.y);
        assert!((direction.length() - 1.0).abs() < 1e-6);
        assert!(uv_from_direction(direction * 3.0).distance(uv) < 1e-6, "{uv}");
    }
}
