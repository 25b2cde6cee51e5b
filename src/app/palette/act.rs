//! Does what a chosen entry of the palette says.

use super::entries::Action;
use crate::app::command::Command;
use crate::app::layout::Panel;
use crate::app::panels::expression::watch;
use crate::app::viewer::Viewer;

/// Carries out the action of the chosen entry.
pub(super) fn act(viewer: &mut Viewer, action: Action, commands: &mut Vec<Command>) {
    let settings = &mut viewer.session.settings;
    match action {
        Action::Mode(slug) => settings.mode = slug,
        Action::Do(command) => commands.push(command),
        Action::Environment(name) => settings.environment.name = name,
        Action::Assign(assignment) => {
            if let Err(message) = settings.assign(&assignment) {
                viewer.say(message);
            }
        }
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
