//! Thumbnails of debug modes: several in one draw, each like the large picture of its mode.

use crate::support::{Session, assert_validated, model, renderer, settings};
use specula::headless::{Headless, Thumbnail};
use specula::render::Capture;
use specula::shader::Mode;

/// Width and height of a thumbnail, pixels.
const SMALL: (u32, u32) = (48, 36);
/// The large picture has this many pixels per pixel of a thumbnail, along each side.
const TIMES: u32 = 4;

fn modes(headless: &Headless, slugs: &[&str]) -> Vec<Mode> {
    headless.shaders().modes.iter().filter(|mode| slugs.contains(&&*mode.slug)).cloned().collect()
}

/// The mean of the blocks of a large picture that the pixels of a thumbnail show.
fn scaled_down(large: &Capture) -> Vec<f64> {
    let mut out = Vec::new();
    for y in 0..SMALL.1 {
        for x in 0..SMALL.0 {
            for channel in 0..3 {
                let of = |dx: u32, dy: u32| ((y * TIMES + dy) * large.width + x * TIMES + dx) as usize * 4 + channel;
                let block = (0..TIMES * TIMES).map(|at| f64::from(large.rgba8[of(at % TIMES, at / TIMES)]));
                out.push(block.sum::<f64>() / f64::from(TIMES * TIMES));
            }
        }
    }
    out
}

/// The mean difference of a thumbnail and a scaled picture, in steps of 8 bits.
fn difference(small: &Thumbnail, large: &[f64]) -> f64 {
    let rgb = small.rgba8.chunks_exact(4).flat_map(|pixel| &pixel[..3]);
    rgb.zip(large).map(|(a, b)| (f64::from(*a) - b).abs()).sum::<f64>() / large.len() as f64
}

/// The largest mean difference, in steps of 8 bits, of a thumbnail and its large picture scaled down: edges of the model and small
/// highlights are sampled at other places.
const CLOSE: f64 = 6.0;

#[test]
fn a_thumbnail_is_the_picture_of_its_mode() {
    // A channel, vectors, terms of the BRDF, light with a background, edges, and the final picture.
    let slugs =
        ["final", "clay", "roughness", "metallic", "base-color", "shading-normal", "wireframe", "d", "f", "n-dot-v"];
    let more =
        ["ambient", "direct-specular", "light-2", "luminance", "dfg", "nan", "false-color", "dielectric", "metal"];
    let slugs = [&slugs[..], &more[..]].concat();
    let large = (SMALL.0 * TIMES, SMALL.1 * TIMES);
    let mut headless = renderer(model("shader-ball"), settings(&["environment.name=studio"]), large);
    let wanted = modes(&headless, &slugs);
    let thumbnails = headless.thumbnails(SMALL, &wanted).unwrap();
    assert_validated();
    assert_eq!(thumbnails.len(), slugs.len());
    let pictures: Vec<Vec<f64>> = thumbnails
        .iter()
        .map(|thumbnail| scaled_down(&crate::support::render(&mut headless, &thumbnail.slug)))
        .collect();
    for (index, thumbnail) in thumbnails.iter().enumerate() {
        let own = difference(thumbnail, &pictures[index]);
        assert!(own < CLOSE, "{}: {own}", thumbnail.slug);
        // It is the picture of this mode, and of no other.
        let others = pictures.iter().enumerate().filter(|(other, _)| *other != index);
        for (other, picture) in others {
            let distance = difference(thumbnail, picture);
            assert!(own <= distance, "{} looks like {}: {own}, {distance}", thumbnail.slug, thumbnails[other].slug);
        }
    }
}

#[test]
fn modes_without_data_show_a_checkerboard_and_do_not_spoil_the_modes_beside_them() {
    // In one draw: the flag of the first mode must not reach the second.
    let mut headless = renderer(model("shader-ball"), settings(&[]), SMALL);
    let wanted = modes(&headless, &["uv1", "clearcoat", "sheen-color", "roughness", "position"]);
    let thumbnails = headless.thumbnails(SMALL, &wanted).unwrap();
    assert_eq!((wanted.len(), thumbnails.len()), (5, 5));
    for thumbnail in &thumbnails {
        let capture = crate::support::render(&mut headless, &thumbnail.slug);
        let same = capture.rgba8.chunks_exact(4).zip(thumbnail.rgba8.chunks_exact(4)).filter(|(a, b)| a[..3] == b[..3]);
        let same = same.count() as f64 / f64::from(SMALL.0 * SMALL.1);
        assert!(same > 0.99, "{}: {same} of all pixels are the same", thumbnail.slug);
    }
}

#[test]
fn an_edit_changes_thumbnails_and_a_failing_edit_leaves_them() {
    let mut session = Session::new(model("shader-ball"), settings(&[]));
    let wanted = modes(&session.headless, &["roughness", "metallic", "ggx-alpha"]);
    let of = |thumbnails: &[Thumbnail], slug: &str| {
        thumbnails.iter().find(|thumbnail| thumbnail.slug == slug).map(|thumbnail| thumbnail.rgba8.clone()).unwrap()
    };
    let before = session.headless.thumbnails(SMALL, &wanted).unwrap();
    let line = "else if (MODE == MODE_ROUGHNESS) value = vec3(s.roughness);";
    let reload = session.edit("debug/surface.glsl", line, "else if (MODE == MODE_ROUGHNESS) value = vec3(nothing);");
    crate::support::failed(&reload);
    let failed = session.headless.thumbnails(SMALL, &wanted).unwrap();
    assert!(wanted.iter().all(|mode| of(&failed, &mode.slug) == of(&before, &mode.slug)));
    session.tree.write(
        "debug/surface.glsl",
        &session.tree.read("debug/surface.glsl").replace("vec3(nothing)", "vec3(1.0 - s.roughness)"),
    );
    crate::support::ready(&session.changed(&["debug/surface.glsl"]));
    let after = session.headless.thumbnails(SMALL, &wanted).unwrap();
    assert_ne!(of(&after, "roughness"), of(&before, "roughness"));
    assert_eq!(of(&after, "metallic"), of(&before, "metallic"));
    assert_validated();
}

#[test]
fn masked_blended_and_layered_materials_have_thumbnails() {
    for name in ["clearcoat", "transmission", "sheen"] {
        let mut headless = renderer(model(name), settings(&["environment.name=studio"]), SMALL);
        let wanted =
            modes(&headless, &["shading-normal", "roughness", "clearcoat", "transmission", "sheen-color", "alpha"]);
        let thumbnails = headless.thumbnails(SMALL, &wanted).unwrap();
        assert_eq!((wanted.len(), thumbnails.len()), (6, 6), "{name}");
        for thumbnail in thumbnails {
            let large = crate::support::render(&mut headless, &thumbnail.slug);
            let equal =
                large.rgba8.chunks_exact(4).zip(thumbnail.rgba8.chunks_exact(4)).filter(|(a, b)| a[..3] == b[..3]);
            let equal = equal.count() as f64 / f64::from(SMALL.0 * SMALL.1);
            assert!(equal > 0.97, "{name}, {}: {equal} of all pixels are the same", thumbnail.slug);
        }
        assert_validated();
    }
}
