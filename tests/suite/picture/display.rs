//! Values as the display shows them: range, channels, colormap, dither and edges. None of them changes a value.

use crate::support::{load, model, render, renderer, settings};
use specula::render::Capture;
use specula::settings::Colormap;

const SIZE: (u32, u32) = (96, 64);

/// A picture of the built-in spheres.
fn picture(slug: &str, assignments: &[&str]) -> Capture {
    let mut headless = renderer(model("sphere-grid"), settings(assignments), SIZE);
    render(&mut headless, slug)
}

/// Byte and raw value of each pixel that the model covers whole.
fn covered(capture: &Capture) -> Vec<([u8; 4], [f32; 4])> {
    let bytes = capture.rgba8.chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2], pixel[3]]);
    bytes.zip(capture.raw.iter().copied()).filter(|(_, raw)| raw[3] == 1.0).collect()
}

fn srgb(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[test]
fn a_range_spreads_its_values_from_black_to_white() {
    let plain = picture("depth", &[]);
    let ranged = picture("depth", &["view.range=5..12"]);
    assert!(plain.raw == ranged.raw, "the values themselves");
    assert!(covered(&plain).iter().all(|(bytes, _)| bytes[0] == 255), "depth is white without a range");
    for (bytes, raw) in covered(&ranged) {
        let expected = 255.0 * ((raw[0] - 5.0) / 7.0).clamp(0.0, 1.0);
        assert!((f32::from(bytes[0]) - expected).abs() <= 1.0, "{bytes:?} for {raw:?}");
    }
}

#[test]
fn an_automatic_range_is_that_of_the_picture() {
    for (slug, assignment) in [("depth", "view.range=auto"), ("d", "view.range=auto"), ("final", "view.range=fit")] {
        let pixels = covered(&picture(slug, &[assignment]));
        let (least, most) =
            (pixels.iter().map(|(b, _)| b[1]).min().unwrap(), pixels.iter().map(|(b, _)| b[1]).max().unwrap());
        assert!(least < 40 && most > 200, "{slug}: {least} to {most}");
        // Values keep their order.
        let mut greens: Vec<(f32, u8)> = pixels.iter().map(|(bytes, raw)| (raw[1], bytes[1])).collect();
        greens.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert!(greens.windows(2).all(|pair| pair[0].1 <= pair[1].1), "{slug}");
    }
    // What fits is left alone, and so is light.
    for slug in ["roughness", "final", "shading-normal"] {
        assert!(picture(slug, &["view.range=auto"]).rgba8 == picture(slug, &[]).rgba8, "{slug}");
    }
}

#[test]
fn a_picture_does_not_depend_on_the_range_before() {
    let mut headless = renderer(model("sphere-grid"), settings(&["view.range=auto"]), SIZE);
    let first = render(&mut headless, "depth");
    headless.settings_mut().camera.fovy = 33.0;
    render(&mut headless, "depth");
    headless.settings_mut().camera.fovy = 35.0;
    assert!(render(&mut headless, "depth").rgba8 == first.rgba8);
}

#[test]
fn one_channel_is_gray() {
    let all = covered(&picture("base-color", &[]));
    for (index, channel) in ["r", "g", "b"].into_iter().enumerate() {
        let one = covered(&picture("base-color", &[&format!("view.channels={channel}")]));
        for ((all, _), (one, _)) in all.iter().zip(&one) {
            assert!(one[..3].iter().all(|byte| byte.abs_diff(all[index]) <= 1), "{channel}: {one:?} of {all:?}");
        }
    }
    let coverage = covered(&picture("base-color", &["view.channels=a"]));
    assert!(coverage.iter().all(|(bytes, _)| bytes[..3] == [255; 3]));
}

#[test]
fn colors_stand_for_numbers() {
    for (map, name) in [(Colormap::Viridis, "viridis"), (Colormap::Turbo, "turbo"), (Colormap::Coolwarm, "coolwarm")] {
        let colors = map.colors();
        for (bytes, raw) in covered(&picture("roughness", &[&format!("view.colormap={name}")])) {
            let at = raw[0].clamp(0.0, 1.0) * 16.0;
            let low = (at as usize).min(15);
            for channel in 0..3 {
                let linear =
                    colors[low][channel] + (colors[low + 1][channel] - colors[low][channel]) * (at - low as f32);
                let expected = 255.0 * srgb(linear);
                assert!((f32::from(bytes[channel]) - expected).abs() <= 1.5, "{name}: {bytes:?} for {raw:?}");
            }
        }
    }
    let color = picture("base-color", &["view.colormap=viridis"]);
    assert!(color.rgba8 == picture("base-color", &[]).rgba8, "a color is no number");
}

#[test]
fn some_modes_have_colors_and_a_range_of_their_own() {
    // Blue 6 stops below middle gray, red 6 above; the value is the stops.
    let colors = Colormap::Heat.colors();
    for (bytes, raw) in covered(&picture("false-color", &[])) {
        let at = ((raw[0] + 6.0) / 12.0).clamp(0.0, 1.0) * 16.0;
        let low = (at as usize).min(15);
        let red = colors[low][0] + (colors[low + 1][0] - colors[low][0]) * (at - low as f32);
        assert!((f32::from(bytes[0]) - 255.0 * srgb(red)).abs() <= 1.5, "{bytes:?} for {raw:?}");
    }
}

#[test]
fn dither_is_half_a_step_and_only_where_it_is_asked_for() {
    let (plain, dithered) = (picture("final", &[]), picture("final", &["view.dither=true"]));
    let differences: Vec<u8> = plain.rgba8.iter().zip(&dithered.rgba8).map(|(a, b)| a.abs_diff(*b)).collect();
    assert!(differences.iter().all(|difference| *difference <= 1));
    assert!(differences.contains(&1));
    assert!(plain.raw == dithered.raw);
    let data = picture("roughness", &["view.dither=true"]);
    assert!(data.rgba8 == picture("roughness", &[]).rgba8, "data are stored as they are");
}

#[test]
fn edges_lie_over_every_mode() {
    let quad = || load(&crate::support::glb::model(&crate::support::glb::quad(1.0), &crate::support::glb::gray()));
    for slug in ["final", "roughness", "depth"] {
        let show = |assignments: &[&str]| render(&mut renderer(quad(), settings(assignments), SIZE), slug);
        let (plain, edges) = (show(&[]), show(&["view.wireframe=true"]));
        let changed = plain.rgba8.chunks(4).zip(edges.rgba8.chunks(4)).filter(|(a, b)| a != b).count();
        // Two triangles have five edges.
        assert!(changed > 60 && changed < plain.raw.len() / 4, "{slug}: {changed} pixels");
    }
}

#[test]
fn a_range_that_is_none_is_refused() {
    for (assignment, words) in
        [("view.range=wide", "mode, auto, fit"), ("view.range=3..1", "not below"), ("view.channels=x", "rgb, r, g")]
    {
        let error = specula::settings::Settings::default().assign(assignment).unwrap_err();
        assert!(error.contains(words), "{assignment}: {error}");
    }
}
