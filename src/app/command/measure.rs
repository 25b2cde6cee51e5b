//! Commands that measure and check, as those of the command line do.

use std::path::PathBuf;

use serde::Deserialize;
use serde_json::json;

use super::modes::shaders;
use super::spec::{Outcome, Spec, Until};
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::waiting::Work;
use crate::frame::stages::all_stages;
use crate::measure::{Furnace, Surface, prepare};
use crate::picture::{check_place, write_image};
use crate::picture_difference::{Comparison, Limits, Picture, listed, listed_all};
use crate::settings::Settings;
use crate::shader::{Library, check};

/// Fields of `furnace`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct FurnaceFields {
    metallic: Option<f32>,
    base_color: Option<[f32; 3]>,
}

pub(in crate::app) static FURNACE: Spec<FurnaceFields> = Spec::new("furnace", furnace).takes(
    r#""metallic"?: 0..1, "base_color"?: [r,g,b]"#,
    "The directional albedo by roughness and angle, with the shaders and their values of now. Without fields, of a white metal. Result: as \
     `specula brdf furnace --json`",
);

/// Fields of `diff`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct DiffFields {
    a: PathBuf,
    b: PathBuf,
    out: Option<PathBuf>,
    max: Option<f64>,
    max_channel: Option<f64>,
}

pub(in crate::app) static DIFF: Spec<DiffFields> = Spec::new("diff", |_, _, fields| diff(fields))
    .takes(
        r#""a": "a.png", "b": "b.png", "out"?: "map.png", "max"?: error, "max_channel"?: difference"#,
        "Compares two pictures of files; out is a map of the differences. Result: as `specula diff --json`",
    )
    .required(&["a", "b"]);

pub(in crate::app) static CHECK: Spec<()> = Spec::fallible("check", check_all)
    .line("Compiles every file of the shader tree, each library also by itself. Result: all diagnostics, as `specula check --json`");

fn furnace(state: &mut State, engine: &mut Engine, FurnaceFields { metallic, base_color }: FurnaceFields) -> Outcome {
    let surface = Surface { base_color: base_color.unwrap_or([1.0; 3]), metallic: metallic.unwrap_or(1.0) };
    if surface.base_color.into_iter().chain([surface.metallic]).any(|value| !(0.0..=1.0).contains(&value)) {
        return Err("`metallic` and each number of `base_color` can be 0 to 1".to_owned());
    }
    let (shaders, source) = (shaders(state)?, state.source.clone());
    let (gpu, compiler) = (engine.gpu.clone(), engine.compiler.clone());
    // Only the author's constants and parameters count.
    let settings = Settings { shader: state.session.settings.shader.clone(), ..Settings::default() };
    let run = move || {
        let meter = prepare(&gpu, &compiler, &source, &shaders.texts, &settings)?;
        let found = Furnace::measure(&meter, (&*shaders, &settings), surface).map_err(|error| error.to_string())?;
        Ok(found.json())
    };
    Ok(Until::Work(Work { uses_device: true, run: Box::new(run) }))
}

fn diff(DiffFields { a, b, out, max, max_channel }: DiffFields) -> Outcome {
    let limits = Limits { max: max.unwrap_or(0.0), max_channel };
    if [Some(limits.max), max_channel].into_iter().flatten().any(|limit| limit.is_nan() || limit < 0.0) {
        return Err("`max` and `max_channel` can be 0 or more".to_owned());
    }
    out.as_deref().map_or(Ok(()), check_place)?;
    let run = move || {
        let compared = Comparison::new(&Picture::open(&a)?, &Picture::open(&b)?)?;
        out.map_or(Ok(()), |out| write_image(compared.map(), &out))?;
        Ok(listed_all(vec![listed(&b.display().to_string(), &Ok(compared), limits)], limits))
    };
    Ok(Until::Work(Work { uses_device: false, run: Box::new(run) }))
}

fn check_all(state: &mut State, engine: &mut Engine, (): ()) -> Outcome {
    let (source, compiler) = (state.source.clone(), engine.compiler.clone());
    let run = move || {
        // Stages compile on the shared thread pool, where an edit would have to wait for these.
        let own = rayon::ThreadPoolBuilder::new().build().map_err(|error| error.to_string())?;
        let mut library = Library::new(source, compiler, &all_stages());
        Ok(json!(own.install(|| check::check(&mut library))))
    };
    Ok(Until::Work(Work { uses_device: false, run: Box::new(run) }))
}
