//! Commands that arrange the panels.

use winit::keyboard::NamedKey;

use super::about::Group;
use super::shortcut::Shortcut;
use super::spec::Spec;
use crate::app::state::arrangement::{Panel, Preset};
use crate::app::state::inspection::Page;
use crate::app::state::workspace::PanelRequest;

/// Changes the panels.
pub(in crate::app) static PANELS: Spec<PanelRequest> =
    Spec::act("panels", |state, _, request| state.workspace.request(request)).of_window();

/// Opens a panel, or shows its tab.
pub(in crate::app) static OPEN_PANEL: Spec<Panel> =
    Spec::act("panel", |state, _, panel| state.workspace.request_in_sight(PanelRequest::Open(panel))).of_window();

/// Opens the inspector at a page.
pub(in crate::app) static OPEN_INSPECTOR: Spec<Page> = Spec::act("inspector", |state, _, page| {
    state.inspection.page = page;
    state.workspace.request_in_sight(PanelRequest::Open(Panel::INSPECTOR));
})
.of_window();

pub(in crate::app) static ARRANGE: Spec<Preset> =
    Spec::act("layout", |state, _, preset| state.workspace.request_in_sight(PanelRequest::Arrange(preset))).of_window();

/// Shows the user's own arrangement of the panels.
pub(in crate::app) static ARRANGE_OWN: Spec<()> =
    Spec::plain("own-layout", |state, _, ()| state.workspace.request_in_sight(PanelRequest::ArrangeOwn))
        .enabled(|state| state.workspace.sight.has_own_arrangement)
        .of_window();

pub(in crate::app) static RESET_LAYOUT: Spec<()> =
    Spec::plain("reset-layout", |state, _, ()| state.workspace.request_in_sight(PanelRequest::ResetArrangement))
        .label("Reset the arrangement of the panels", "default layout restore tiles")
        .of_window();

pub(in crate::app) static TOGGLE_PANELS: Spec<()> =
    Spec::plain("toggle-panels", |state, _, ()| state.workspace.request(PanelRequest::Toggle))
        .label("Hide or show the panels", "")
        .shortcuts(Group::Program, &[Shortcut::key('h')], "hide or show the panels")
        .of_window();

pub(in crate::app) static TOGGLE_THEME: Spec<()> =
    Spec::plain("toggle-theme", |state, _, ()| state.workspace.request(PanelRequest::ToggleTheme))
        .label("Light or dark theme", "colors appearance")
        .of_window();

pub(in crate::app) static TOGGLE_HISTOGRAM: Spec<()> =
    Spec::plain("toggle-histogram", |state, _, ()| state.workspace.request(PanelRequest::ToggleHistogram))
        .label("Show or hide the histogram", "distribution values")
        .of_window();

pub(in crate::app) static PALETTE: Spec<()> =
    Spec::plain("palette", |state, _, ()| state.workspace.request(PanelRequest::TogglePalette))
        .shortcuts(
            Group::Program,
            &[Shortcut::key('p').ctrl().everywhere()],
            "find a mode, setting, panel or command by its name; set a number",
        )
        .of_window();

pub(in crate::app) static KEYS: Spec<()> =
    Spec::plain("keys", |state, _, ()| state.workspace.request(PanelRequest::ToggleKeys))
        .label("Keys", "shortcuts help")
        .shortcuts(Group::Program, &[Shortcut::named(NamedKey::F1).everywhere(), Shortcut::key('?')], "list the keys")
        .of_window();
