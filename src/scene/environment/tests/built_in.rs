//! The built-in environments.

use std::f32::consts::PI;

use super::super::{built_in, sky};
use super::*;

fn open(name: &str) -> Environment {
    EnvironmentFile::open(name).unwrap().decode().unwrap()
}

/// Luminance of linear RGB (Rec. 709).
fn luminance(rgb: Vec3) -> f32 {
    rgb.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

#[test]
fn all_are_whole() {
    for name in BUILT_IN {
        let environment = open(name);
        assert_eq!(environment.name, name);
        assert_eq!(environment.width, environment.height * 2);
        assert_eq!(environment.pixels.len(), (environment.width * environment.height) as usize);
        let values = environment.pixels.iter().flatten();
        assert!(values.clone().all(|value| value.is_finite() && *value >= 0.0), "{name}");
        let peak = environment.pixels.iter().fold(0.0, |peak: f32, [r, g, b, _]| peak.max(*r).max(*g).max(*b));
        assert_eq!(environment.peak, peak, "{name}");
        assert!(environment.pixels.iter().all(|pixel| pixel[3] == 1.0));
        // Every run gives the same bits, however the rows are distributed over threads.
        assert_eq!(environment, open(name));
    }
}

#[test]
fn a_furnace_gives_pi() {
    let furnace = open("furnace");
    assert!(furnace.mean_radiance().distance(Vec3::ONE) < 1e-6);
    for n in [Vec3::X, Vec3::Y, Vec3::NEG_Z, Vec3::new(1.0, -2.0, 0.5).normalize()] {
        let irradiance = furnace.irradiance(n);
        assert!((irradiance / PI - 1.0).abs().max_element() < 2e-3, "{n}: {irradiance}");
    }
}

#[test]
fn the_studio_is_balanced() {
    let studio = open("studio");
    let mean = studio.mean_radiance();
    assert!((0.5..0.8).contains(&luminance(mean)), "{mean}");
    assert!(mean.max_element() / mean.min_element() < 1.08, "not neutral: {mean}");
    assert!((8.0..14.0).contains(&studio.peak), "{}", studio.peak);
    let [up, down] = [Vec3::Y, Vec3::NEG_Y].map(|n| luminance(studio.irradiance(n)));
    assert!(up > 4.0 * down && up < 12.0 * down, "{up} {down}");
}

/// Splits the sky's light into the sun's texels, which are far brighter than any other, and the rest.
fn split(environment: &Environment) -> (Environment, Environment) {
    let (mut sun, mut rest) = (environment.clone(), environment.clone());
    for (sun, rest) in sun.pixels.iter_mut().zip(&mut rest.pixels) {
        if sun[0] > 30.0 { *rest = [0.5; 4] } else { *sun = [0.0; 4] }
    }
    (sun, rest)
}

/// The sun's energy is the same at any resolution, since each texel receives the area that the disc covers.
#[test]
fn the_suns_energy_does_not_depend_on_resolution() {
    let [small, medium, large] = [256, 1024, 2048].map(|width| {
        let environment = sky::make(width);
        let (sun, _) = split(&environment);
        let energy = luminance(sun.mean_radiance()) * 4.0 * PI;
        let facing = luminance(sun.irradiance(sky::sun_direction()));
        assert!((facing / energy - 1.0).abs() < 1e-3, "the sun is elsewhere: {facing} {energy}");
        let brightest = sun.pixels.iter().map(|&[r, g, b, _]| luminance(Vec3::new(r, g, b))).fold(0.0, f32::max);
        (energy, brightest)
    });
    assert!((medium.0 / small.0 - 1.0).abs() < 2e-3, "{small:?} {medium:?}");
    assert!((medium.0 / large.0 - 1.0).abs() < 2e-3, "{large:?} {medium:?}");
    // At this resolution some texels lie inside the disc and have its true radiance.
    let solid_angle = 2.0 * PI * (1.0 - sky::SUN_RADIUS.cos()) as f32;
    assert!((large.1 * solid_angle / large.0 - 1.0).abs() < 0.01, "{large:?}");
    assert!(small.1 < 0.5 * medium.1 && medium.1 < large.1, "{small:?} {medium:?} {large:?}");
}

#[test]
fn the_sky_has_a_clear_days_light() {
    let environment = built_in::make("sky");
    let (sun, mut rest) = split(&environment);
    let lower = rest.pixels.len() / 2;
    rest.pixels[lower..].fill([0.0; 4]);
    let mean = luminance(rest.mean_radiance()) * 2.0;
    assert!((0.48..0.52).contains(&mean), "{mean}");
    let sky = luminance(rest.irradiance(Vec3::Y));
    for (n, ratio) in [(sky::sun_direction(), 8.0), (Vec3::Y, 8.0 * sky::sun_direction().y)] {
        let found = luminance(sun.irradiance(n)) / sky;
        assert!((found / ratio - 1.0).abs() < 0.01, "{found}, expected {ratio}");
    }
    let zenith = rest.pixels[0];
    assert!(zenith[2] > 1.5 * zenith[0], "a blue zenith: {zenith:?}");
}
