//! Does what a chosen entry of the palette says.

use super::entries::Action;
use crate::app::command::Command;
use crate::app::numbers::default_of;
use crate::app::source_line::watch;
use crate::app::state::State;
use crate::app::state::arrangement::Panel;
use crate::app::state::workspace::PanelRequest;
use crate::settings::Settings;
use crate::shader::values::number;

/// Whether the action is a choice of a setting that has this value already.
pub(super) fn is_in_force(action: &Action, state: &State) -> bool {
    let settings = &state.session.settings;
    match action {
        Action::Mode(slug) => state.session.mode().is_some_and(|mode| mode.slug == *slug),
        Action::Environment(name) => settings.environment.name == *name,
        Action::Set(path, value) => settings.value(path).as_ref() == Some(value),
        Action::Value(name, value) => state.session.shaders.as_ref().is_some_and(|shaders| {
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
pub(super) fn act(action: Action, settings: &mut Settings, commands: &mut Vec<Command>) {
    let mut ask = |requests: &[PanelRequest]| commands.extend(requests.iter().cloned().map(Command::Panels));
    match action {
        Action::Mode(slug) => settings.mode = slug,
        Action::Do(command) => commands.push(command),
        Action::Environment(name) => settings.environment.name = name,
        Action::Set(path, value) => settings.set_value(&path, &value),
        Action::ToggleHistogram => ask(&[PanelRequest::ToggleHistogram]),
        Action::ToggleDifference => commands.push(Command::ToggleDifference),
        Action::Value(name, value) => drop(settings.shader.insert(name, value)),
        Action::Number(number) => number.set(settings),
        Action::Pass(name, on) => drop(settings.passes.insert(name, on)),
        Action::Open(panel) => ask(&[PanelRequest::Unhide, PanelRequest::Open(panel)]),
        Action::Arrange(preset) => ask(&[PanelRequest::Unhide, PanelRequest::Arrange(preset)]),
        Action::ResetLayout => ask(&[PanelRequest::Unhide, PanelRequest::ResetArrangement]),
        Action::ArrangeOwn => ask(&[PanelRequest::Unhide, PanelRequest::ArrangeOwn]),
        Action::WriteVersion(number) => {
            ask(&[PanelRequest::Unhide, PanelRequest::Open(Panel::Timeline), PanelRequest::AskVersion(number)]);
        }
        Action::AskExpression => {
            ask(&[PanelRequest::Unhide, PanelRequest::Open(Panel::Expression), PanelRequest::FocusExpression]);
        }
        Action::Watch(at) => watch(settings, at),
        Action::WriteDefaults => ask(&[PanelRequest::AskDefaults]),
        Action::TogglePanels => ask(&[PanelRequest::Toggle]),
        Action::ToggleTheme => ask(&[PanelRequest::ToggleTheme]),
        Action::ShowKeys => ask(&[PanelRequest::ShowKeys]),
    }
}
