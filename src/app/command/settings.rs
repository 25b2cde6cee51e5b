//! Commands that read and change settings.

use std::fmt::{Debug, Formatter};
use std::rc::Rc;

use serde_json::{Value as Json, json};

use super::about::About;
use super::assignments::assignments;
use super::fields::{self, Fields};
use super::spec::{Command, Spec, Until};
use crate::app::actions::files::begin_reading;
use crate::app::control::short;
use crate::app::state::State;
use crate::message::did_you_mean;
use crate::settings::{Setting, Settings, ShaderValue, catalog};
use crate::shader::{Diagnostic, expression};

pub(in crate::app) static SET: Spec<Vec<String>> = Spec::new("set", |state, _, assignments: Vec<String>| {
    let mut settings = state.session.settings.clone();
    assignments.iter().try_for_each(|assignment| settings.assign(assignment))?;
    adopt(state, settings)?;
    Ok(Until::SHOWN)
})
.parsed(
    r#""values": "path=value" | ["path=value", ...] | {"path": value}"#,
    "Changes settings, all or none. Done when their final picture is on screen",
    |about: &About, mut fields: Fields| {
        let values = fields.remove("values").unwrap_or_default();
        fields::end(about, assignments(&values)?, fields)
    },
);

pub(in crate::app) static GET: Spec<Option<String>> =
    Spec::new("get", |state, _, path: Option<String>| Ok(Until::Now(get(&state.session.settings, path.as_deref())?)))
        .parsed(r#""path"?: "view.ev""#, "The settings, or the one at a path", |about, mut fields| {
            let path = fields::text(&mut fields, "path")?;
            fields::end(about, path, fields)
        });

pub(in crate::app) static SETTINGS: Spec<()> = Spec::fallible("settings", |_, _, ()| Ok(Until::Now(settings_json())))
    .line("All settings, with what each takes, its range, unit and meaning");

/// A change of the settings.
#[derive(Clone)]
pub(in crate::app) struct Change {
    text: String,
    change: Rc<dyn Fn(&mut Settings)>,
}

impl Debug for Change {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.text)
    }
}

pub(super) static CHANGE: Spec<Change> =
    Spec::act("change", |state, _, Change { change, .. }| change(&mut state.session.settings));

/// The command that changes the settings. `text` names the change in tests.
pub(in crate::app) fn change(text: impl Into<String>, change: impl Fn(&mut Settings) + 'static) -> Command {
    CHANGE.with(Change { text: text.into(), change: Rc::new(change) })
}

/// The command that sets a constant or a parameter of the shaders.
pub(in crate::app) fn set_shader(name: &str, value: &ShaderValue) -> Command {
    let (name, value) = (name.to_owned(), value.clone());
    change(name.clone(), move |settings| drop(settings.shader.insert(name.clone(), value.clone())))
}

/// Takes settings, if nothing is wrong with them that was not wrong before. They are one step of undo.
pub(super) fn adopt(state: &mut State, settings: Settings) -> Result<(), String> {
    settings.check()?;
    let shaders = state.session.shaders.clone();
    // A stage that is pending may declare a name that is not known yet.
    let is_complete = shaders.as_ref().is_some_and(|shaders| shaders.is_complete());
    let before = state.session.problems(is_complete);
    let shared = state.session.shared_settings();
    state.history.record(&shared, false);
    let old = std::mem::replace(&mut state.session.settings, settings);
    let mut problems = state.session.problems(is_complete).into_iter().filter(|problem| !before.contains(problem));
    let problem = problems.next().or_else(|| {
        let (shaders, mode) = (shaders.filter(|_| is_complete)?, &state.session.settings.mode);
        let expression = &state.session.settings.expression;
        if *mode == expression::MODE && !expression.at.is_empty() {
            // Another expression is compiled first.
            let error = shaders.expression_error().filter(|_| *expression == old.expression);
            return error.map(Diagnostic::one_line);
        }
        let is_unknown = state.session.mode().is_none() && *mode != old.mode;
        let hint = did_you_mean(mode, shaders.modes.iter().map(|mode| mode.slug.as_str()));
        is_unknown.then(|| format!("there is no mode `{mode}`.{hint} `modes` lists them all"))
    });
    if let Some(problem) = problem {
        state.session.settings = old;
        return Err(problem);
    }
    begin_reading(state, &shared);
    state.history.record(&state.session.shared_settings(), false);
    Ok(())
}

/// The settings at a path, or all.
fn get(settings: &Settings, path: Option<&str>) -> Result<Json, String> {
    let all = short(settings);
    let Some(path) = path.filter(|path| !path.is_empty()) else { return Ok(all) };
    let at = |path: &str| {
        path.split('.').try_fold(&all, |value, key| match value {
            Json::Array(list) => key.parse::<usize>().ok().and_then(|index| list.get(index)),
            value => value.get(key),
        })
    };
    let found = at(path).or_else(|| at(&format!("shader.{path}")));
    found.cloned().ok_or_else(|| {
        let hint = did_you_mean(path, catalog().iter().map(|setting| setting.path.as_str()));
        format!("`{path}` has no value of its own.{hint} `settings` lists all; what is not set has its default")
    })
}

fn settings_json() -> Json {
    let setting = |setting: &Setting| {
        json!({ "path": setting.path, "takes": setting.takes, "default": setting.default.to_string(),
            "range": setting.entry.valid.text(), "unit": setting.entry.unit.name, "doc": setting.doc() })
    };
    catalog().iter().map(setting).collect()
}
