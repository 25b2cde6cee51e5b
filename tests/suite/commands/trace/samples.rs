//! Pixels of several samples: which of them each fragment covers, and the mean that the picture has.

use serde_json::json;
use specula::headless::{Headless, TraceRequest};
use specula::shader::Mode;
use specula::shader::trace::{FragmentState, Trace};

use crate::support::process::run;
use crate::support::{glb, load, renderer, settings};

const SIZE: (u32, u32) = (96, 64);
const EYE: &str = "0.31,0.17,6";

fn of_slug(headless: &Headless, slug: &str) -> Mode {
    headless.shaders().modes.iter().find(|mode| mode.slug == slug).cloned().unwrap()
}

/// The traces of a row of pixels that the model covers.
fn row(headless: &mut Headless, mode: &Mode, y: u32) -> Vec<((u32, u32), Trace)> {
    let traced = |x: u32| {
        let request = TraceRequest {
            at: (x, y),
            mode,
            stage: None,
            invocation: None,
            files: &["pbr.frag"],
            is_interactive: false,
        };
        Some(((x, y), headless.trace(&request).ok()?))
    };
    (0..SIZE.0).filter_map(traced).collect()
}

/// The color that each sample shows: of the nearest fragment that covers it.
fn shown(trace: &Trace) -> [Option<[f64; 4]>; 4] {
    std::array::from_fn(|sample| {
        let covers = |samples: Option<u32>| samples.unwrap() >> sample & 1 == 1;
        let nearest = trace.fragments.iter().find(|of| covers(of.samples) && of.color.is_some())?;
        Some(nearest.color?.map(|bits| f64::from(f32::from_bits(bits))))
    })
}

fn close(found: [f32; 4], expected: [f64; 4], what: &str) {
    for (found, expected) in found.into_iter().zip(expected) {
        let error = (f64::from(found) - expected).abs() / expected.abs().max(1e-6);
        assert!(error <= 4.0 * f64::from(f32::EPSILON), "{what}: {found} is not {expected}: {error:e}");
    }
}

#[test]
fn fragments_of_an_edge_have_their_samples_and_together_the_picture() {
    let material =
        |name: &str, color: [f32; 4]| json!({ "name": name, "pbrMetallicRoughness": { "baseColorFactor": color } });
    let scene = glb::scene(&[
        (glb::cuboid([-1.5, -1.0, -2.0], [1.5, 1.0, -1.0], true), material("back", [1.0, 0.1, 0.1, 1.0])),
        (glb::cuboid([-0.6, -0.6, 0.0], [0.6, 0.6, 1.0], true), material("front", [0.1, 0.2, 1.0, 1.0])),
    ]);
    let eye = format!("camera.eye=[{EYE}]");
    let assigned = ["environment.name=none", "view.msaa=4", &eye, "camera.target=[0,0,0]"];
    let mut headless = renderer(load(&scene), settings(&assigned), SIZE);
    let (light, triangle) = (of_slug(&headless, "final"), of_slug(&headless, "triangle-id"));
    let traces = row(&mut headless, &light, 30);
    let (mut whole, mut edges, mut silhouettes) = (0, Vec::new(), 0);
    for (at, trace) in &traces {
        let what = format!("{at:?}: {trace:?}");
        let visible = trace.visible().unwrap();
        assert_eq!(trace.samples, 4);
        // All fragments but hidden ones have their part in the picture, whose raw value is the plain mean of the samples.
        let is_hidden = |of: usize| matches!(trace.state(of), Some(FragmentState::Covered(_)));
        for fragment in (0..trace.fragments.len()).filter(|of| !is_hidden(*of)) {
            let text = trace.proof_text(fragment);
            assert!(
                trace.is_proven(fragment) || text.contains(" ulp from the picture: the device rounds"),
                "{text} {what}"
            );
        }
        let shown = shown(trace);
        let sum = |channel: usize| shown.iter().flatten().map(|color| color[channel]).sum::<f64>() / 4.0;
        close(trace.picture.map(f32::from_bits), std::array::from_fn(sum), &what);
        // The samples do not make the stage run more often: one fragment covers them all.
        if trace.fragments[visible].samples == Some(0b1111) && visible == 0 {
            whole += 1;
            assert_eq!(trace.proof_text(visible), "equal to the picture", "{what}");
            let number = headless.pixel(*at, std::slice::from_ref(&triangle)).unwrap()[0].value[0];
            assert_eq!(trace.fragments[visible].primitive, Some(number as u32), "{what}");
        }
        let parts: Vec<u32> = trace.fragments.iter().map(|of| of.samples.unwrap()).collect();
        if let [first, second, ..] = parts[..]
            && first != 0b1111
            && first | second == 0b1111
        {
            edges.push((*at, trace));
        }
        silhouettes += usize::from(shown.iter().any(Option::is_none));
    }
    assert!(whole > 10 && !edges.is_empty() && silhouettes > 0, "{whole} {} {silhouettes}", edges.len());

    // The inspector and files of linear light have the same value. On the display, the samples are weighted by their brightness.
    let (at, trace) = edges[0];
    let value = |headless: &mut Headless| headless.pixel(at, std::slice::from_ref(&light)).unwrap()[0].value;
    headless.set_linear(true);
    assert_eq!(value(&mut headless).map(f32::to_bits), trace.picture);
    headless.set_linear(false);
    let exposure = 1.0 / (1.2 * f64::from(headless.settings_mut().view.ev).exp2());
    let weighted = shown(trace).map(|color| {
        let [r, g, b, _] = color.unwrap();
        (1.0 / (1.0 + exposure * r.max(g).max(b)), [r, g, b])
    });
    let weights: f64 = weighted.iter().map(|(weight, _)| weight).sum();
    let mean = |channel: usize| weighted.iter().map(|(weight, color)| weight * color[channel]).sum::<f64>() / weights;
    let display = value(&mut headless);
    assert_ne!(display.map(f32::to_bits), trace.picture, "the weights make no difference here");
    for (channel, found) in display[..3].iter().enumerate() {
        let (found, expected) = (f64::from(*found), mean(channel));
        assert!((found - expected).abs() <= 1e-5 * expected, "{found} {expected}");
    }

    // The same on the command line, whose picture has four samples unless it is told otherwise.
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("two.glb"), scene).unwrap();
    let place = format!("{},{}", at.0, at.1);
    let view = ["two.glb", "--at", &place, "--eye", EYE, "--target", "0,0,0", "--file", "pbr.frag", "--size", "96x64"];
    let traced = |more: &[&str]| {
        run(directory.path(), &[&["trace"], &view[..], &["--env", "none", "--validate"], more].concat())
    };
    let text = traced(&["--fragment", "0"]).expect(0, &[]).stdout.clone();
    assert!(text.contains("the picture by 4 samples"), "{text}");
    let line = text.lines().find(|line| line.starts_with("covers sample")).unwrap_or_else(|| panic!("{text}"));
    assert!(line.contains(" of 4 · primitive "), "{line}");
    let found = traced(&["--json"]).expect(0, &[]).json();
    let samples: Vec<u64> = found["fragments"].as_array().unwrap()[..2]
        .iter()
        .flat_map(|of| of["samples"].as_array().unwrap())
        .map(|of| of.as_u64().unwrap())
        .collect();
    assert!((0..4).all(|sample| samples.contains(&sample)) && found["samples"] == 4, "{found}");
    assert!(found["fragments"][0]["primitive"].is_u64() && found["fragments"][0]["state"] == "shares", "{found}");
    assert!(found["proof"]["blended_ulp"].as_u64().unwrap() <= 4, "{}", found["proof"]);
}
