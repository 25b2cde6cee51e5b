//! Does what a chosen entry of the palette says.

use super::entries::Action;
use crate::app::command::Command;
use crate::app::numbers::default_of;
use crate::app::source_line::watch;
use crate::app::state::arrangement::Panel;
use crate::app::state::workspace::PanelRequest;
use crate::app::viewer::Viewer;
use crate::shader::values::number;

/// Whether the action is a choice of a setting that has this value already.
pub(super) fn is_in_force(action: &Action, viewer: &Viewer) -> bool {
    let settings = &viewer.session.settings;
    match action {
        Action::Mode(slug) => viewer.session.mode().is_some_and(|mode| mode.slug == *slug),
        Action::Environment(name) => settings.environment.name == *name,
        Action::Set(path, value) => settings.value(path).as_ref() == Some(value),
        Action::Value(name, value) => viewer.session.shaders.as_ref().is_some_and(|shaders| {
            let constant = shaders.constants.iter().find(|constant| constant.name == *name);
            let parameter = shaders.parameters.iter().find(|parameter| parameter.name == *name);
            let of_constant = constant.map(|constant| (&constant.choices, Some(default_of(constant))));
            let of_parameter = parameter.map(|parameter| (&parameter.choices, parameter.default.first().copied()));
            of_constant.or(of_parameter).is_some_and(|(choices, default)| {
                let now = settings.shader.get(name).and_then(|value| number(value, choices)).or(default);
                now.is_some() && now == number(value, choices)
            })
        }),
        _ => false,
    }
}

/// Carries out the action of the chosen entry.
pub(super) fn act(viewer: &mut Viewer, action: Action, commands: &mut Vec<Command>) {
    let settings = &mut viewer.session.settings;
    match action {
        Action::Mode(slug) => settings.mode = slug,
        Action::Do(command) => commands.push(command),
        Action::Environment(name) => settings.environment.name = name,
        Action::Set(path, value) => settings.set_value(&path, &value),
        Action::ToggleHistogram => viewer.workspace.request(PanelRequest::ToggleHistogram),
        Action::ToggleDifference => viewer.compare.shows_map ^= true,
        Action::Value(name, value) => drop(settings.shader.insert(name, value)),
        Action::Number(ask) => ask.set(settings),
        Action::Pass(name, on) => drop(settings.passes.insert(name, on)),
        Action::Open(panel) => viewer.workspace.request_in_sight(PanelRequest::Open(panel)),
        Action::Arrange(preset) => viewer.workspace.request_in_sight(PanelRequest::Arrange(preset)),
        Action::ResetLayout => viewer.workspace.request_in_sight(PanelRequest::ResetArrangement),
        Action::ArrangeOwn => viewer.workspace.request_in_sight(PanelRequest::ArrangeOwn),
        Action::WriteVersion(number) => {
            viewer.workspace.request_in_sight(PanelRequest::Open(Panel::Timeline));
            viewer.workspace.request(PanelRequest::AskVersion(number));
        }
        Action::AskExpression => {
            viewer.workspace.request_in_sight(PanelRequest::Open(Panel::Expression));
            viewer.workspace.request(PanelRequest::FocusExpression);
        }
        Action::Watch(at) => watch(settings, at),
        Action::WriteDefaults => viewer.workspace.request(PanelRequest::AskDefaults),
        Action::TogglePanels => viewer.workspace.request(PanelRequest::Toggle),
        Action::ToggleTheme => viewer.workspace.request(PanelRequest::ToggleTheme),
        Action::ShowKeys => viewer.workspace.request(PanelRequest::ShowKeys),
    }
}
