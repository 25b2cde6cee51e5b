//! Commands that select, hide and show parts of the scene.

use serde::Deserialize;
use serde_json::json;

use super::about::Group;
use super::shortcut::Shortcut;
use super::spec::{Outcome, Spec, Until};
use crate::app::actions::inspect::inspect;
use crate::app::actions::select::{hide_selected, isolate_selected, place_rectangle, select_at, show_all};
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::arrangement::Panel;
use crate::app::state::inspection::Page;
use crate::app::state::selection::Selected;
use crate::app::state::workspace::PanelRequest;
use crate::settings::LightSettings;

/// Fields of `pick`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct Pick {
    /// A pixel of the picture, counted from its upper left corner; without it, the last click is taken back.
    at: Option<[u32; 2]>,
}

pub(in crate::app) static PICK: Spec<Pick> = Spec::new("pick", pick).takes(
    r#""at"?: [x,y]"#,
    "Does what a click on a pixel of the picture does: pins it for the inspector and selects what it shows. Without `at` it takes \
     both back. Result: instance, node, primitive, material",
);

/// A click on a pixel; a second one takes the first one back.
pub(in crate::app) static CLICK: Spec<[u32; 2]> = Spec::act("click", |state, _, at| click(state, at));

/// Pins a pixel and opens the inspector, which finds the line that makes NaN there.
pub(in crate::app) static INSPECT_PIXEL: Spec<[u32; 2]> = Spec::act("inspect-pixel", |state, _, at| {
    (state.inspection.pin, state.inspection.page) = (Some(at), Page::Values);
    state.workspace.request_in_sight(PanelRequest::Open(Panel::INSPECTOR));
})
.of_window();

/// Forgets the pixel that the inspector reads.
pub(in crate::app) static UNPIN: Spec<()> = Spec::plain("unpin", |state, _, ()| state.inspection.unpin());

/// Whether the inspector reads the pixel under the mouse.
pub(in crate::app) static FOLLOW_MOUSE: Spec<bool> =
    Spec::act("follow-mouse", |state, _, follows| state.inspection.follows = follows);

pub(in crate::app) static SELECT: Spec<Selected> =
    Spec::act("select", |state, _, selected: Selected| state.select(selected));

pub(in crate::app) static HIDE: Spec<()> = Spec::plain("hide", |state, _, ()| hide_selected(state))
    .label("Hide the selection", "scene node primitive")
    .shortcuts(Group::Picture, &[Shortcut::key('h').ctrl()], "hide the selection");

pub(in crate::app) static ISOLATE: Spec<()> = Spec::plain("isolate", |state, _, ()| isolate_selected(state))
    .label("Isolate the selection", "scene node solo local view")
    .shortcuts(Group::Picture, &[Shortcut::key('/')], "draw only the selection; press again to draw everything");

pub(in crate::app) static SHOW_ALL: Spec<()> = Spec::plain("show-all", |state, _, ()| show_all(state))
    .label("Show everything", "scene hidden unhide reveal")
    .shortcuts(Group::Picture, &[Shortcut::key('h').alt()], "draw everything again");

pub(in crate::app) static SELECT_NOTHING: Spec<()> =
    Spec::plain("select-nothing", |state, _, ()| state.select(Selected::Nothing))
        .label("Select nothing", "scene deselect")
        .keys("Esc");

pub(in crate::app) static PLACE_RECTANGLE: Spec<()> =
    Spec::plain("place-rectangle", |state, _, ()| place_rectangle(state))
        .label("Place the rectangular light", "area light handle gizmo");

pub(in crate::app) static SPIN_LIGHTS: Spec<()> = Spec::plain("spin-lights", |state, _, ()| {
    let lights = &mut state.session.settings.lights;
    lights.spin = if lights.spin == 0.0 { 30.0 } else { LightSettings::default().spin };
})
.shortcuts(Group::Picture, &[Shortcut::key('l')], "start or stop the orbiting lights")
.of_window();

fn click(state: &mut State, at: [u32; 2]) {
    inspect(state, at);
    select_at(state, at);
}

fn pick(state: &mut State, _: &mut Engine, Pick { at }: Pick) -> Outcome {
    match at {
        None => {
            state.inspection.unpin();
            state.select(Selected::Nothing);
        }
        Some([x, y]) => {
            let (width, height) = state.shown().ok_or("there is no picture yet")?.size;
            if x >= width || y >= height {
                return Err(format!("[{x}, {y}] is outside of the picture, which has {width}x{height} pixels"));
            }
            // A second click on a place would take the first one back.
            state.inspection.unpin();
            state.selected = Selected::Nothing;
            click(state, [x, y]);
        }
    }
    Ok(Until::Now(json!(state.selected_event())))
}
