//! Commands that choose the debug modes of the picture.

use serde::Deserialize;
use serde_json::json;
use winit::keyboard::NamedKey;

use super::about::Group;
use super::fields;
use super::settings::adopt;
use super::shortcut::Shortcut;
use super::spec::{Outcome, Spec, Until};
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::grid::Grid;
use crate::app::state::selection::Selected;
use crate::message::did_you_mean;
use crate::settings::Settings;
use crate::shader::annotation::neighbors;
use crate::shader::{Mode, ShaderSet};

pub(in crate::app) static MODE: Spec<String> = Spec::new("mode", |state, _, name: String| {
    adopt(state, Settings { mode: name, ..state.session.settings.clone() })?;
    Ok(Until::SHOWN)
})
.parsed(r#""name": "d""#, "Shows a debug mode", |about, mut fields| {
    let name = fields::text(&mut fields, "name")?.ok_or_else(|| fields::needs(about))?;
    fields::end(about, name, fields)
});

/// Shows one of the first ten modes.
pub(in crate::app) static MODE_AT: Spec<usize> = Spec::act("mode-at", |state, _, index| set_mode(state, index))
    .arguments(|index| index)
    .shortcuts(Group::Picture, &const { Shortcut::keys(b"1234567890") }, "the first ten modes")
    .keys("1 … 9, 0");

pub(in crate::app) static PREVIOUS_MODE: Spec<()> = Spec::plain("previous-mode", |state, _, ()| step(state, 0))
    .shortcuts(Group::Picture, &[Shortcut::key('[')], "previous mode of the list; modes without data are passed over")
    .repeats();

pub(in crate::app) static NEXT_MODE: Spec<()> = Spec::plain("next-mode", |state, _, ()| step(state, 1))
    .shortcuts(Group::Picture, &[Shortcut::key(']')], "next mode of the list")
    .repeats();

/// Shows a mode, or the final picture if that mode is shown already.
pub(in crate::app) static TOGGLE_MODE: Spec<String> = Spec::act("toggle-mode", |state, _, slug: String| {
    let mode = &mut state.session.settings.mode;
    *mode = if *mode == slug { "final".to_owned() } else { slug };
});

/// Goes back by one step. A click pins a pixel and selects what it shows, so one step takes both back.
pub(in crate::app) static BACK: Spec<()> = Spec::plain("back", |state, _, ()| {
    let is_pinned = state.workspace.sight.inspector && state.inspection.is_pinned();
    if state.selected != Selected::Nothing || is_pinned {
        state.inspection.unpin();
        state.select(Selected::Nothing);
    } else if state.grid.is_on() {
        state.grid.end();
    } else {
        set_mode(state, 0);
    }
})
.shortcuts(
    Group::Picture,
    &[Shortcut::named(NamedKey::Escape)],
    "close the palette or a list, unpin the pixel, select nothing, or show one mode alone; otherwise the final picture",
);

/// Fields of `grid`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct GridModes {
    /// Fewer than two end the grid.
    pub(in crate::app) modes: Vec<String>,
}

pub(in crate::app) static GRID: Spec<GridModes> = Spec::new("grid", show_grid)
    .takes(
        r#""modes": ["final", "d", "f"]"#,
        "Shows up to nine modes side by side; the selected mode becomes one of them. An empty list shows it alone. Result: modes",
    )
    .required(&["modes"])
    .of_window();

pub(in crate::app) static MODES: Spec<()> =
    Spec::fallible("modes", |state, _, ()| Ok(Until::Now(json!(shaders(state)?.modes))))
        .line("All debug modes: id, name, slug, group, encode, doc");

/// The shaders, or why there are none.
pub(super) fn shaders(state: &State) -> Result<std::sync::Arc<ShaderSet>, String> {
    state.session.shaders.clone().ok_or_else(|| "the shaders have not been compiled yet".to_owned())
}

fn show(state: &mut State, mode: Option<String>) {
    mode.into_iter().for_each(|mode| state.session.settings.mode = mode);
}

fn set_mode(state: &mut State, index: usize) {
    let modes = state.session.shaders.iter().flat_map(|shaders| &shaders.modes);
    let mode = modes.map(|mode| mode.slug.clone()).nth(index);
    show(state, mode);
}

/// Selects the mode before (0) or after (1) the current one.
fn step(state: &mut State, direction: usize) {
    let session = &state.session;
    let (Some(shaders), features) = (&session.shaders, session.features()) else { return };
    let around: Option<[&Mode; 2]> = neighbors(&shaders.modes, &session.settings.mode, features);
    let mode = around.map(|around| around[direction].slug.clone());
    show(state, mode);
}

/// Shows modes side by side.
fn show_grid(state: &mut State, _: &mut Engine, GridModes { modes }: GridModes) -> Outcome {
    let shaders = shaders(state)?;
    for name in &modes {
        let mode = shaders.modes.iter().find(|mode| mode.slug == *name).ok_or_else(|| {
            let hint = did_you_mean(name, shaders.modes.iter().map(|mode| mode.slug.as_str()));
            format!("there is no mode `{name}`.{hint} `modes` lists them all")
        })?;
        if !Grid::can_show(mode) {
            return Err(format!("`{name}` takes many frames, and can only be shown alone"));
        }
    }
    let selected = state.session.settings.mode.clone();
    if let Some(first) = modes.first().filter(|_| !modes.contains(&selected)) {
        adopt(state, Settings { mode: first.clone(), ..state.session.settings.clone() })?;
    }
    state.grid.show(modes)?;
    Ok(Until::Settled(|state| json!({ "modes": state.grid.modes() })))
}
