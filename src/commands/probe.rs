//! `specula probe`: the raw values of one pixel in every debug mode, with camera and lights.

use serde_json::{Map, Value, json};
use specula::frame::FrameState;
use specula::headless::Headless;
use specula::interface::{LIGHT_DIRECTIONAL, LIGHT_POINT, LIGHT_RECT, LIGHT_SPOT, Light};
use specula::render::Texel;
use specula::shader::PixelValue;
use specula::shader::expression;
use specula::shader::not_finite::NotFinite;
use specula::shader::{DrawAs, Mode, ShaderSet};

use super::common::frames::Frames;
use super::common::opened::Opened;
use super::common::parse::{inside, pixel};
use super::common::{Common, Models, check_mode, check_validation, warn_unmeasured};
use super::{Failure, print_json, tell_left_out};

/// Options of `probe`.
#[derive(clap::Args)]
#[command(
    after_help = "Without --mode, all modes are printed, except those of random paths, which take seconds each on a software device: add --paths, or \
    name them.\n\
    Values are in world space, before exposure, tone map and encoding. Color is multiplied by coverage. Angles are in degrees. Where the \
    picture shows a color for each number (triangle, front or back, NaN), the number or its meaning is printed.\n\
    In JSON, a value is [r, g, b, coverage], or, for modes that show a color for each number, that number or its name; null: the mode has no data at the pixel; \
    \"NaN\": the value is NaN or infinite. `not_finite` is then the first statement that made NaN or infinity, with the components of its value.\n\
    The pixel has one sample in its center: view.msaa is 1, so that no edge mixes two surfaces. An accumulating mode is the mean of \
    view.frames frames.\n\
    Where there is no model, as in a Shadertoy file, passes have values: `pass:image` is what is shown.\n\
    `textures` lists the texel of level 0 at the pixel in each texture of the material, as stored and as a linear number, unfiltered.\n\
    The falloff of a spot light is the square of angle_scale * cosine + angle_offset, clamped to 0..1 \
    (KHR_lights_punctual)."
)]
pub struct Args {
    #[command(flatten)]
    models: Models,
    /// Pixel to read, counted from the upper left corner
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, value_parser = pixel)]
    at: (u32, u32),
    /// Include the modes of random paths
    #[arg(long)]
    paths: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    frames: Frames,
    #[command(flatten)]
    common: Common,
}

/// Runs the command.
pub fn run(mut args: Args) -> Result<(), Failure> {
    args.common.take_files(&mut args.models)?;
    let mut slugs = std::mem::take(&mut args.common.mode);
    let (x, y) = args.at;
    inside(args.at, args.common.size())?;
    let sequence = args.frames.sequence()?;
    let mut settings = args.common.settings()?;
    settings.view.msaa = 1;
    if slugs.is_empty() && !settings.expression.at.is_empty() {
        slugs.push(expression::MODE.to_owned());
        expression::MODE.clone_into(&mut settings.mode);
    }
    slugs.iter().for_each(|slug| warn_unmeasured(slug, &settings));
    let Opened { gpu, mut headless, progress } = Opened::new(&args.common, &args.models, settings, sequence)?;
    let Chosen { modes, left_out } = chosen(&headless.shaders(), &slugs, args.paths)?;
    let state = headless.frame_state()?;
    progress.say("reading the pixel");
    let hit = state.pipelines.draws_model && is_hit(&mut headless, args.at)?;
    let modes: Vec<Mode> = match (hit, slugs.is_empty()) {
        (true, _) => modes,
        // Only passes have a value where there is no model. A toy has no model at all.
        (false, false) => modes.into_iter().filter(|mode| mode.pass.is_some()).collect(),
        (false, true) if !state.pipelines.draws_model => modes_of_passes(modes, &state),
        (false, true) => Vec::new(),
    };
    let shown = modes.as_slice();
    let read = headless.pixel_with(args.at, shown, |step| progress.step(step))?;
    let values: Vec<_> = shown.iter().zip(read).collect();
    let texels = if hit { headless.texels(args.at)? } else { Vec::new() };
    progress.say("looking for the first line with NaN or infinity");
    let not_finite = first_not_finite(&mut headless, args.at, &values);
    drop(progress);
    if args.json {
        let modes: Map<String, Value> =
            values.iter().map(|(mode, pixel)| (mode.slug.clone(), pixel.json(mode))).collect();
        let lights: Vec<Value> = state.lights.iter().map(light).collect();
        let textures: Vec<Value> = texels.iter().map(Texel::json).collect();
        let mut found = json!({ "pixel": [x, y], "hit": hit, "modes": modes, "camera": camera(&state),
            "lights": lights, "textures": textures });
        if let Some(not_finite) = &not_finite {
            found["not_finite"] = not_finite.json();
        }
        print_json(&found);
    } else {
        print_table(args.at, &values, &state);
        print_texels(&texels);
        if let Some(not_finite) = &not_finite {
            out!("\n{}", not_finite.text());
        }
    }
    tell_left_out(if hit { left_out } else { 0 });
    // The validation layers also report errors when objects are destroyed.
    drop(headless);
    check_validation(&gpu)
}

/// The modes to print.
struct Chosen {
    modes: Vec<Mode>,
    /// Path-traced modes that were neither named nor requested.
    left_out: usize,
}

/// The modes with these slugs; or all, with the path-traced ones only if `paths` is set or they are named.
fn chosen(shaders: &ShaderSet, slugs: &[String], paths: bool) -> Result<Chosen, Failure> {
    slugs.iter().filter(|slug| *slug != "all").try_for_each(|slug| check_mode(shaders, slug))?;
    let all = slugs.is_empty() || slugs.iter().any(|slug| slug == "all");
    if paths && !all {
        return Err(Failure::Usage("--paths adds modes to all others; a mode that is named needs no --paths".into()));
    }
    let is_named = |mode: &Mode| slugs.contains(&mode.slug);
    let wanted = shaders.modes.iter().filter(|mode| all || is_named(mode));
    let (modes, left_out): (Vec<&Mode>, Vec<&Mode>) =
        wanted.partition(|mode| paths || !mode.follows_paths() || is_named(mode));
    Ok(Chosen { modes: modes.into_iter().cloned().collect(), left_out: left_out.len() })
}

/// The modes of the passes that the picture consists of.
fn modes_of_passes(modes: Vec<Mode>, state: &FrameState) -> Vec<Mode> {
    let is_drawn =
        |name: &String| state.pipelines.passes.iter().any(|pass| pass.desc.images().any(|(image, _)| image == name));
    modes.into_iter().filter(|mode| mode.pass.as_ref().is_some_and(is_drawn)).collect()
}

/// The first statement that computes NaN or infinity: in the final picture, or else in the first of these modes that has one.
fn first_not_finite(headless: &mut Headless, at: (u32, u32), values: &[(&Mode, PixelValue)]) -> Option<NotFinite> {
    let mode = NotFinite::mode_of(values.iter().map(|(mode, value)| (*mode, value)))?;
    let found = headless.first_not_finite(at, mode).map_err(|error| error.to_string());
    Some(NotFinite { mode: mode.slug.clone(), found })
}

/// Whether the model covers the pixel, in a mode that draws surfaces and no environment.
fn is_hit(headless: &mut Headless, at: (u32, u32)) -> Result<bool, Failure> {
    let modes = &headless.shaders().modes;
    let plain = |mode: &&Mode| !mode.tonemap && !mode.accumulate && mode.draw == DrawAs::Surfaces;
    let mode: Vec<Mode> = modes.iter().find(plain).or(modes.first()).cloned().into_iter().collect();
    let before = std::mem::replace(&mut headless.settings_mut().view.background, "none".into());
    let values = headless.pixel(at, &mode)?;
    headless.settings_mut().view.background = before;
    Ok(values.iter().any(|pixel| pixel.value[3] > 0.0))
}

fn camera(state: &FrameState) -> Value {
    let camera = &state.camera;
    json!({ "eye": camera.eye.to_array(), "target": camera.target.to_array(), "fovy": camera.fovy_rad.to_degrees() })
}

fn kind(light: &Light) -> &'static str {
    match light.kind {
        LIGHT_DIRECTIONAL => "directional",
        LIGHT_POINT => "point",
        LIGHT_SPOT => "spot",
        LIGHT_RECT => "rect",
        _ => "unknown",
    }
}

fn position(light: &Light) -> [f32; 3] {
    let [x, y, z, _] = light.position_ws;
    [x, y, z]
}

/// A light with everything that a program needs to recompute the shading. A directional light has no position; `range` is present
/// only if the light has one.
fn light(light: &Light) -> Value {
    let placed = (light.kind != LIGHT_DIRECTIONAL).then(|| position(light));
    let mut value = json!({ "kind": kind(light), "position": placed, "direction": light.direction_ws,
        "intensity": light.intensity });
    if light.inverse_range > 0.0 {
        value["range"] = json!(light.inverse_range.recip());
    }
    if light.kind == LIGHT_SPOT {
        value["angle_scale"] = json!(light.angle_scale);
        value["angle_offset"] = json!(light.angle_offset);
    }
    if light.kind == LIGHT_RECT {
        value["half_x"] = json!(light.half_x_ws);
        value["half_y"] = json!(light.half_y_ws);
    }
    value
}

fn print_table((x, y): (u32, u32), values: &[(&Mode, PixelValue)], state: &FrameState) {
    out!("pixel      {x} {y}");
    let draws_model = state.pipelines.draws_model;
    if draws_model {
        let camera = &state.camera;
        out!(
            "camera     eye {}  target {}  fovy {:.2}",
            row(&camera.eye.to_array()),
            row(&camera.target.to_array()),
            camera.fovy_rad.to_degrees()
        );
    }
    for light in state.lights.iter().filter(|_| draws_model) {
        let place = match light.kind {
            LIGHT_DIRECTIONAL => format!("direction {}", row(&light.direction_ws)),
            LIGHT_POINT => format!("position {}", row(&position(light))),
            _ => format!("position {}  direction {}", row(&position(light)), row(&light.direction_ws)),
        };
        out!("light      {:11} {place}  intensity {}", kind(light), row(&light.intensity));
    }
    if values.is_empty() && draws_model {
        out!("\nthe model does not cover this pixel");
    }
    let width = values.iter().map(|(mode, _)| mode.slug.len()).max().unwrap_or(0);
    let mut group = "";
    for (mode, value) in values {
        if mode.group != group {
            out!("\n{}", mode.group);
            group = &mode.group;
        }
        out!("  {:width$}  {}", mode.slug, value.text(mode).trim_end());
    }
}

fn print_texels(texels: &[Texel]) {
    if !texels.is_empty() {
        out!("\nTextures");
    }
    let width = texels.iter().map(|texel| texel.place.slot_name().len()).max().unwrap_or(0);
    texels.iter().for_each(|texel| out!("  {:width$}  {}", texel.place.slot_name(), texel.text()));
}

fn row(numbers: &[f32]) -> String {
    numbers.iter().map(|x| shown(*x)).collect::<Vec<_>>().join(" ")
}

/// A number in a column: six digits, in powers of ten where fewer than three would be left.
fn shown(x: f32) -> String {
    let plain = x == 0.0 || !x.is_finite() || (1e-3..1e6).contains(&x.abs());
    if plain { format!("{x:>12.5}") } else { format!("{x:>12.4e}") }
}
