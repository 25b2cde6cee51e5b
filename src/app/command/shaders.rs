//! Commands about the shaders: reloads, versions, passes, expressions, and edits that the window makes.

use serde::Deserialize;
use serde_json::{Value, json};
use winit::keyboard::NamedKey;

use super::about::{About, Group};
use super::fields::{self, Fields};
use super::settings::adopt;
use super::shortcut::Shortcut;
use super::spec::{Outcome, Spec, Until};
use crate::app::actions::compare::write::write_version;
use crate::app::actions::edits::{draft, write_edits};
use crate::app::actions::files::reload;
use crate::app::actions::restored::{show_newest, show_version};
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::arrangement::Panel;
use crate::app::state::shaders::edits::NO_FOLDER;
use crate::app::state::workspace::PanelRequest;
use crate::shader::rewrite::Edit;

pub(in crate::app) static RELOAD: Spec<()> = Spec::fallible("reload", |state, engine, ()| {
    reload(state, engine);
    Ok(Until::Reloaded)
})
.line("Compiles all shaders again. Result: generation; an error lists the diagnostics")
.label("Reload all shaders", "compile")
.shortcuts(Group::Program, &[Shortcut::named(NamedKey::F5).everywhere()], "compile everything again");

/// Whether the driver is asked about its code.
pub(in crate::app) static ASK_DRIVER: Spec<bool> = Spec::act("ask-driver", |state, _, asks| {
    (state.shader.asks_driver, state.shader.told) = (asks, None);
})
.of_window();

/// A use of the command `versions`.
#[derive(Clone, Copy, Debug)]
pub(in crate::app) enum VersionsRequest {
    List,
    /// Writes one over the files.
    Write(u64),
    /// Shows one in place of the newest.
    Show(u64),
    ShowNewest,
}

pub(in crate::app) static VERSIONS: Spec<VersionsRequest> = Spec::new("versions", |state, engine, what| match what {
    VersionsRequest::List => Ok(Until::Now(versions_json(state))),
    VersionsRequest::ShowNewest => {
        show_newest(state, engine);
        Ok(Until::Reloaded)
    }
    VersionsRequest::Show(number) => {
        if state.versions.get(number).is_none() {
            return Err(format!("version {number} is no longer kept"));
        }
        show_version(state, engine, number);
        Ok(Until::Reloaded)
    }
    VersionsRequest::Write(number) => {
        if state.files_of_version(number).is_empty() {
            return Err(format!("the files are those of version {number}, or it is no longer kept"));
        }
        write_version(state, engine, number);
        Ok(Until::VersionWritten(number))
    }
})
.parsed(
    r#""show"?: number | "newest", "write"?: number"#,
    "Versions of the shaders since the start; show puts one in place of the newest until a file is saved, write puts it into the files",
    parse_versions,
);

/// Asks in the timeline whether to write a version to the files.
pub(in crate::app) static ASK_VERSION: Spec<u64> = Spec::act("ask-version", |state, _, number| {
    state.workspace.request_in_sight(PanelRequest::Open(Panel::TIMELINE));
    state.workspace.request(PanelRequest::AskVersion(number));
})
.of_window();

pub(in crate::app) static ASK_EXPRESSION: Spec<()> = Spec::plain("ask-expression", |state, _, ()| {
    state.workspace.request_in_sight(PanelRequest::Open(Panel::EXPRESSION));
    state.workspace.request(PanelRequest::FocusExpression);
})
.label("Watch an expression of the shaders…", "variable value debug line")
.of_window();

pub(in crate::app) static ASK_DEFAULTS: Spec<()> =
    Spec::plain("ask-defaults", |state, _, ()| state.workspace.request(PanelRequest::AskDefaults))
        .label("Write the values of parameters to GLSL…", "save defaults annotation")
        .of_window();

/// Fields of `write-defaults`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct WriteDefaults {
    /// Parameters; empty for all.
    names: Vec<String>,
}

pub(in crate::app) static WRITE_DEFAULTS: Spec<WriteDefaults> = Spec::new("write-defaults", write_defaults).takes(
    r#""names"?: ["rim_strength", ...]"#,
    "Writes the values of these parameters, or of all, into the GLSL as their defaults. Does not ask. Result: edits",
);

/// Shows the picture with these numbers in the texts, without a change of the files; none goes back to the files.
pub(in crate::app) static DRAFT: Spec<Vec<Edit>> = Spec::act("draft", draft);

/// Writes values into the files.
pub(in crate::app) static WRITE_EDITS: Spec<Vec<Edit>> = Spec::new("write-edits", write_listed);

/// Fields of `pass`.
#[derive(Clone, Debug)]
pub(in crate::app) struct Pass {
    pub(in crate::app) name: String,
    /// `None` changes it.
    pub(in crate::app) on: Option<bool>,
}

pub(in crate::app) static PASS: Spec<Pass> = Spec::new("pass", |state, _, Pass { name, on }| {
    let mut settings = state.session.settings.clone();
    let pass = state.session.shaders.as_ref().and_then(|shaders| shaders.graph.pass(&name).cloned());
    let on = on.unwrap_or_else(|| pass.is_none_or(|pass| !pass.is_wanted(&settings.passes)));
    settings.passes.insert(name, on);
    adopt(state, settings)?;
    Ok(Until::SHOWN)
})
.parsed(r#""name": "bloom", "on"?: true | false"#, "Switches a pass on or off", |about, mut fields| {
    let name = fields::text(&mut fields, "name")?.ok_or_else(|| fields::needs(about))?;
    let on = fields::take(&mut fields, "on");
    let on = on.map(|on| on.as_bool().ok_or(format!("`on` cannot be {on}; it takes true or false")));
    fields::end(about, Pass { name, on: on.transpose()? }, fields)
});

fn parse_versions(about: &About, mut fields: Fields) -> Result<VersionsRequest, String> {
    let number = |field: &str, value: Value| {
        value.as_u64().ok_or_else(|| format!("`{field}` is no number of a version: {value}"))
    };
    let what = match (fields::take(&mut fields, "write"), fields::take(&mut fields, "show")) {
        (None, None) => VersionsRequest::List,
        (Some(write), _) => VersionsRequest::Write(number("write", write)?),
        (None, Some(show)) if show == "newest" => VersionsRequest::ShowNewest,
        (None, Some(show)) => VersionsRequest::Show(number("show", show)?),
    };
    fields::end(about, what, fields)
}

fn versions_json(state: &State) -> Value {
    let versions = state.versions.iter().map(|version| {
        let reload = &version.reload;
        json!({ "number": version.number, "title": version.title(), "since": version.since.to_rfc3339(),
            "changed": reload.changed, "compile_ms": reload.compile_ms, "pipeline_ms": reload.pipeline_ms,
            "first_frame_ms": reload.first_frame_ms, "device_ms": version.device_ms,
            "is_shown": state.shows_version(version), "can_compare": state.can_show(version) })
    });
    versions.collect()
}

/// Writes the values of parameters into the files.
fn write_defaults(state: &mut State, engine: &mut Engine, WriteDefaults { names }: WriteDefaults) -> Outcome {
    let edits = match names.as_slice() {
        [] => state.edits_of_defaults(None)?,
        names => {
            let of_each = names.iter().map(|name| state.edits_of_defaults(Some(name)));
            of_each.collect::<Result<Vec<_>, _>>()?.concat()
        }
    };
    if edits.is_empty() {
        return Err("the shader files have these values already".into());
    }
    write_listed(state, engine, edits)
}

/// Writes edits into the files. The result lists them.
pub(super) fn write_listed(state: &mut State, engine: &mut Engine, edits: Vec<Edit>) -> Outcome {
    if edits.iter().any(|edit| state.source.path_of_file(&edit.path).is_none()) {
        return Err(NO_FOLDER.into());
    }
    let told = edits.iter().map(|edit| json!({ "name": edit.name, "file": edit.path, "line": edit.line }));
    let told = told.collect();
    write_edits(state, engine, edits);
    Ok(Until::EditsWritten(told))
}
