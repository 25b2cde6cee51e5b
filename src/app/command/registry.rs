//! All commands of the window, and those that list them. Palette, keys, lists of keys, `specula help commands`, socket and stdin read
//! [`REGISTRY`], in its order.

use serde::{Deserialize, Serialize};
use serde_json::json;

use super::spec::{Registered, Spec, Until};
use super::{
    camera, capture, checks, compare, costs, file, history, layout, look, measure, models, modes, numbers, playback,
    program, scene, settings, shaders, source, texts,
};
use crate::app::palette::entries::{entries, entry_with};

/// All commands.
pub(in crate::app) static REGISTRY: &[&dyn Registered] = &[
    &settings::SET,
    &settings::GET,
    &settings::CHANGE,
    &modes::MODE,
    &modes::MODE_AT,
    &modes::PREVIOUS_MODE,
    &modes::NEXT_MODE,
    &modes::TOGGLE_MODE,
    &modes::BACK,
    &camera::CAMERA,
    &capture::CAPTURE,
    &capture::PICTURE,
    &capture::PROBE,
    &file::SHOW_GALLERY,
    &file::RESTORE_SESSION,
    &file::RESTORE_ALWAYS,
    &layout::PALETTE,
    &layout::PANELS,
    &file::REFUSE_SESSION,
    &file::CHOOSE,
    &file::CHOOSE_BESIDE,
    &models::REMOVE_MODEL,
    &models::SCENE,
    &file::CHOOSE_TREE,
    &file::OPEN_BUILT_IN,
    &file::NEW_TREE,
    &file::OPEN_EDITOR,
    &camera::FRAME,
    &camera::VIEW_FROM,
    &camera::KEEP_CAMERA,
    &camera::RECALL_CAMERA,
    &camera::LOOK_THROUGH,
    &shaders::RELOAD,
    &texts::EDIT,
    &texts::FILE,
    &texts::FILES,
    &file::OPEN,
    &look::SAVE_LOOK,
    &look::CHOOSE_LOOK,
    &compare::COMPARE,
    &compare::TOGGLE_COMPARE,
    &compare::TOGGLE_DIFFERENCE,
    &shaders::ASK_DRIVER,
    &shaders::VERSIONS,
    &shaders::ASK_VERSION,
    &modes::GRID,
    &scene::PICK,
    &scene::CLICK,
    &scene::SELECT,
    &scene::INSPECT_PIXEL,
    &scene::UNPIN,
    &scene::FOLLOW_MOUSE,
    &source::SOURCE,
    &source::SHOW_FILE,
    &source::SHOW_LINE,
    &source::SAVE_FILE,
    &measure::CHECK,
    &measure::FURNACE,
    &measure::DIFF,
    &checks::CHECKS,
    &checks::SHOW_FAILURE,
    &costs::COST,
    &source::CHOOSE_STAGE,
    &source::PINNED,
    &source::TRACE,
    &source::CHOOSE_TRACE,
    &shaders::ASK_EXPRESSION,
    &shaders::ASK_DEFAULTS,
    &shaders::WRITE_DEFAULTS,
    &shaders::DRAFT,
    &shaders::WRITE_EDITS,
    &numbers::NUMBERS,
    &history::UNDO,
    &history::REDO,
    &shaders::PASS,
    &playback::PLAYBACK,
    &modes::MODES,
    &settings::SETTINGS,
    &COMMANDS,
    &HELP,
    &ENTRIES,
    &RUN,
    &capture::SHEET,
    &capture::TURNTABLE,
    &capture::TIMELINE,
    &capture::SCREENSHOT,
    &layout::KEYS,
    &layout::OPEN_PANEL,
    &layout::OPEN_INSPECTOR,
    &layout::ARRANGE,
    &layout::ARRANGE_OWN,
    &layout::TOGGLE_HISTOGRAM,
    &layout::RESET_LAYOUT,
    &layout::TOGGLE_PANELS,
    &layout::TOGGLE_THEME,
    &scene::HIDE,
    &scene::ISOLATE,
    &scene::SHOW_ALL,
    &scene::SELECT_NOTHING,
    &scene::PLACE_RECTANGLE,
    &scene::SPIN_LIGHTS,
    &program::LEARN,
    &program::SAY,
    &file::LIST_FOLDER,
    &file::OPEN_PATH,
    &capture::CANCEL,
    &capture::CANCEL_ONE,
    &program::HIDE_WARNINGS,
    &program::DISMISS_HINT,
    &program::QUIT,
];

/// A command in words.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Described {
    /// Its name.
    pub command: &'static str,
    /// Its fields, as JSON that could be sent. `?` marks those that may be left out.
    pub takes: &'static str,
    /// Description of the command and its result.
    pub doc: &'static str,
    /// Whether it is about the window, so that a session without one refuses it.
    pub needs_window: bool,
}

/// The commands that a line of the socket or of stdin can name.
pub fn described() -> impl Iterator<Item = Described> {
    let described = |about: &'static super::about::About| {
        Some(Described { command: about.id, takes: about.takes?, doc: about.doc, needs_window: about.needs_window })
    };
    REGISTRY.iter().filter_map(move |command| described(command.about()))
}

static COMMANDS: Spec<()> = Spec::fallible("commands", |_, _, ()| Ok(Until::Now(list()))).line("This list");

static HELP: Spec<()> = Spec::fallible("help", |_, _, ()| Ok(Until::Now(list()))).line("This list");

fn list() -> serde_json::Value {
    json!(described().collect::<Vec<_>>())
}

static ENTRIES: Spec<()> = Spec::fallible("entries", |state, _, ()| Ok(Until::Now(json!(entries(state, REGISTRY)))))
    .line("What the command palette can do at the moment; `now` marks the choices in force");

/// Fields of `run`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Run {
    entry: String,
    value: Option<f64>,
}

static RUN: Spec<Run> = Spec::new("run", |state, engine, Run { entry, value }| {
    let command = entry_with(&entries(state, REGISTRY), &entry, value)?;
    command.about.refusal(state).map_or(Ok(()), Err)?;
    if let Err(message) = command.run(state, engine) {
        state.say(message);
    }
    Ok(Until::SHOWN)
})
.takes(
    r#""entry": "Layout: Look", "value"?: number"#,
    "Does what an entry of the command palette does; value is for numbers",
)
.required(&["entry"]);

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::app::command::fields::Fields;

    fn parsed(command: &str, fields: serde_json::Value) -> Result<crate::app::command::spec::Command, String> {
        let fields: Fields = serde_json::from_value(fields).unwrap();
        let known = REGISTRY.iter().find(|known| known.about().id == command).unwrap();
        known.parse(fields).unwrap()
    }

    #[test]
    fn names_and_keys_are_given_once() {
        let mut seen = BTreeSet::new();
        for about in REGISTRY.iter().map(|command| command.about()) {
            assert!(seen.insert(about.id.to_owned()), "two commands are named {}", about.id);
            for shortcut in about.shortcuts {
                assert!(seen.insert(format!("key {}", shortcut.text())), "{} of {}", shortcut.text(), about.id);
            }
        }
    }

    #[test]
    fn every_shortcut_has_its_command() {
        for command in REGISTRY {
            let about = command.about();
            for index in 0..about.shortcuts.len() {
                assert!(command.at(index).is_some_and(|bound| bound.is_a(*command)), "{} {index}", about.id);
            }
            assert_eq!(about.shortcuts.is_empty(), about.keys_doc.is_empty(), "{}", about.id);
            assert!(about.label.is_empty() || command.at(0).is_some(), "{}", about.id);
        }
    }

    #[test]
    fn fields_become_arguments() {
        assert_eq!(parsed("set", json!({"values": {"view.ev": 1}})), Ok(settings::SET.with(vec!["view.ev=1".into()])));
        let capture = json!({"file": "a.exr", "size": [64, 32], "mode": null});
        let expected =
            capture::Capture { file: Some("a.exr".into()), size: Some([64, 32]), ..capture::Capture::default() };
        assert_eq!(parsed("capture", capture), Ok(capture::CAPTURE.with(expected)));
        let model = file::Open::Model("sphere-grid".into());
        assert_eq!(parsed("open", json!({"model": "sphere-grid"})), Ok(file::OPEN.with(model)));
        let pass = shaders::Pass { name: "bloom".into(), on: None };
        assert_eq!(parsed("pass", json!({"name": "bloom"})), Ok(shaders::PASS.with(pass)));
    }

    #[test]
    fn no_command_takes_an_unknown_field() {
        for known in described() {
            assert!(parsed(known.command, json!({"nonsense": 1})).is_err(), "{}", known.command);
        }
    }

    #[test]
    fn mistakes_are_told() {
        for (command, fields, part) in [
            ("probe", json!({}), "`probe` needs \"at\": [x,y]"),
            ("probe", json!({"at": [1, "x"]}), "`at`: invalid type"),
            ("probe", json!({"at": [1, -2]}), "`at`: invalid value"),
            ("capture", json!({"sise": 1}), "unknown field `sise`, expected one of"),
            ("undo", json!({"twice": true}), "`undo` has no field `twice`; it takes none"),
            ("open", json!({}), "`open` needs"),
            ("open", json!({"modell": "a"}), "Did you mean `model`?"),
            ("mode", json!({"name": 1}), "`name` takes text, found a number"),
            ("pass", json!({"name": "a", "on": 1}), "`on` cannot be 1; it takes true or false"),
        ] {
            let error = parsed(command, fields).unwrap_err();
            assert!(error.contains(part), "{command}: {error}");
        }
    }
}
