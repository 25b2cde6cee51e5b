//! Does what a chosen entry of the palette says.

use super::entries::Action;
use crate::app::command::Command;
use crate::app::layout::Panel;
use crate::app::panels::expression::watch;
use crate::app::panels::parameters::default_of;
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
        Action::ToggleHistogram => viewer.panels.legend.shows_histogram ^= true,
        Action::ToggleDifference => viewer.compare.shows_map ^= true,
        Action::Value(name, value) => drop(settings.shader.insert(name, value)),
        Action::Number(ask) => ask.set(settings),
        Action::Pass(name, on) => drop(settings.passes.insert(name, on)),
        Action::Open(panel) => {
            viewer.panels.visible = true;
            viewer.panels.layout.open(panel);
        }
        Action::Arrange(preset) => {
            viewer.panels.visible = true;
            viewer.panels.layout.arrange(preset);
        }
        Action::ResetLayout => {
            viewer.panels.visible = true;
            viewer.panels.layout.reset();
        }
        Action::ArrangeOwn => {
            viewer.panels.visible = true;
            viewer.panels.layout.arrange_own();
        }
        Action::WriteVersion(number) => {
            viewer.panels.visible = true;
            viewer.panels.layout.open(Panel::Timeline);
            viewer.panels.timeline.ask(number);
        }
        Action::AskExpression => {
            viewer.panels.visible = true;
            viewer.panels.layout.open(Panel::Expression);
            viewer.panels.expression.focus();
        }
        Action::Watch(at) => watch(settings, at),
        Action::WriteDefaults => viewer.panels.defaults.ask(None),
        Action::TogglePanels => viewer.panels.visible ^= true,
        Action::ToggleTheme => {
            let layout = &mut viewer.panels.layout;
            layout.set_light(!layout.is_light());
        }
        Action::ShowKeys => viewer.panels.show_keys = true,
    }
}
