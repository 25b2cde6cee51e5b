//! Tools that read, change and check shaders.

use std::path::Path;

use serde::Deserialize;
use serde_json::{Map, Value, json};
use similar::TextDiff;

use super::arguments::{flag, read, text as text_argument, whole};
use super::tool::{Caller, Content, Effect, Tool, failed, text};
use crate::mcp::diagnostics;
use crate::mcp::places::of_tree;
use crate::mcp::program::{Call, Failure};
use crate::mcp::shared::lock;

/// The tree without --shaders.
const BUILT_IN: &str =
    "built in; edits stay in the memory of the program (start specula mcp with --shaders DIR to keep them)";

pub static READ_SHADER: Tool = Tool {
    name: "read_shader",
    title: "Read a shader",
    doc: "Returns the text of a file of the shader tree; without `file`, the list of all files.",
    effect: Effect::Reads,
    schema: || {
        let properties = json!({
            "file": text_argument("Path in the tree, such as brdf/ndf.glsl"),
            "first": whole("First line, from 1"),
            "last": whole("Last line"),
        });
        (properties, &[])
    },
    run: read_shader,
};

pub static EDIT_SHADER: Tool = Tool {
    name: "edit_shader",
    title: "Edit a shader",
    doc: "Changes a file of the shader tree, on disk, and compiles it. Give `old` and `new`: `old` must be in the file exactly once; or \
        `text`, the whole file, which makes a new one as well; an old one must have been read before. The answer shows what changed, or the compiler's messages with the line and \
        a caret; the picture then stays that of the last good shaders.",
    effect: Effect::Writes,
    schema: || {
        let properties = json!({
            "file": text_argument("Path in the tree, such as brdf/ndf.glsl"),
            "old": text_argument("Text to replace, which the file has exactly once"),
            "new": text_argument("Text in its place"),
            "text": text_argument("The whole file, instead of `old` and `new`"),
        });
        (properties, &["file"])
    },
    run: edit_shader,
};

pub static CHECK: Tool = Tool {
    name: "check",
    title: "Check all shaders",
    doc: "Compiles every file of the tree and lists errors and warnings. With `assertions`, it also draws the picture and lists each \
        `assert()` that fails and each `print()`; with `undefined`, operations whose result GLSL leaves open as well, such as a division \
        by zero.",
    effect: Effect::Reads,
    schema: || {
        let properties = json!({
            "assertions": flag("Also draw the picture and check its assertions"),
            "undefined": flag("Also draw the picture and check operations that are undefined"),
        });
        (properties, &[])
    },
    run: check,
};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Read {
    file: Option<String>,
    first: Option<usize>,
    last: Option<usize>,
}

fn read_shader(caller: &Caller<'_>, arguments: Map<String, Value>) -> Content {
    let Read { file, first, last } = read(arguments)?;
    let Some(file) = file else {
        let found = caller.ask("files", &json!({}))?;
        let files = found["files"].as_array().into_iter().flatten().filter_map(Value::as_str);
        let tree = found["tree"].as_str().unwrap_or(BUILT_IN);
        return Ok(vec![text(format!("Shader tree: {tree}\n{}", files.collect::<Vec<_>>().join("\n")))]);
    };
    let all = text_of(caller, &file)?;
    lock(&caller.shared.seen).insert(file, all.clone());
    let first = first.unwrap_or(1).max(1);
    let lines =
        all.lines().skip(first - 1).take(last.map_or(usize::MAX, |last| last.saturating_add(1).saturating_sub(first)));
    Ok(vec![text(match (first, last) {
        (1, None) => all,
        _ => lines.collect::<Vec<_>>().join("\n"),
    })])
}

fn text_of(caller: &Caller<'_>, file: &str) -> Result<String, Failure> {
    let found = caller.ask("file", &json!({ "file": file }))?;
    Ok(found["text"].as_str().unwrap_or_default().to_owned())
}

/// Where an edit goes.
struct Place {
    /// Its name for the agent.
    name: String,
    /// Whether the file is there already.
    is_there: bool,
}

/// Where an edit of a file goes.
///
/// # Errors
/// The agent may not write there.
fn place_of(caller: &Caller<'_>, file: &str) -> Result<Place, Failure> {
    let listed = caller.ask("files", &json!({}))?;
    let is_there = listed["files"].as_array().is_some_and(|files| files.iter().any(|of| *of == *file));
    let Some(folder) = listed["folder"].as_str() else {
        let name = format!("{file} of the shader tree, {BUILT_IN}");
        return Ok(Place { name, is_there });
    };
    let below = listed["below"].as_str().unwrap_or_default();
    let name = if below.is_empty() {
        file
    } else {
        file.strip_prefix(below).and_then(|file| file.strip_prefix('/')).ok_or_else(|| {
            failed(format!(
                "the shader is a single file, and `{file}` is one of the program around it: name one below {below}/"
            ))
        })?
    };
    let path = of_tree(Path::new(folder), name).map_err(failed)?;
    let (name, exists) = (path.display().to_string(), path.exists());
    // The folder of a single file has others, which the agent was not given.
    if exists && !is_there && !lock(&caller.shared.made).contains(&name) {
        return Err(failed(format!("{name} does not belong to the shader tree, so it stays as it is")));
    }
    Ok(Place { name, is_there: is_there || exists })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Edit {
    file: String,
    old: Option<String>,
    new: Option<String>,
    text: Option<String>,
}

fn edit_shader(caller: &Caller<'_>, arguments: Map<String, Value>) -> Content {
    let Edit { file, old, new, text: whole } = read(arguments)?;
    // Until the answer, no other edit begins.
    let mut seen = lock(&caller.shared.seen);
    let Place { name: place, is_there } = place_of(caller, &file)?;
    let before = if is_there { Some(text_of(caller, &file)?) } else { None };
    let after = match (old, new, whole) {
        (None, None, Some(whole)) => {
            // Text that the agent has not seen may be the user's work.
            if before.is_some() && seen.get(&file) != before.as_ref() {
                return Err(failed(format!(
                    "{file} is not as you have last read it, so it stays as it is: read it again with read_shader"
                )));
            }
            whole
        }
        (Some(old), Some(new), None) => {
            let text = before.as_deref().ok_or_else(|| failed(format!("the tree has no file {file}")))?;
            match text.matches(&old).count() {
                1 => text.replacen(&old, &new, 1),
                0 => return Err(failed(format!("{file} does not have the text `old`; read_shader shows it"))),
                count => {
                    return Err(failed(format!(
                        "{file} has the text `old` {count} times; give more of its surroundings"
                    )));
                }
            }
        }
        _ => return Err(failed("give `old` and `new`, or `text`".to_owned())),
    };
    let begun = before.as_deref().unwrap_or_default();
    let changes = TextDiff::from_lines(begun, &after).unified_diff().context_radius(1).to_string();
    let said = match (before.is_some(), changes.is_empty()) {
        (true, true) => format!("{place} has this text already."),
        (true, false) => format!("Wrote {place}:\n{}", changes.trim_end()),
        (false, _) => format!("Made {place}."),
    };
    if before.is_none() {
        lock(&caller.shared.made).insert(place.clone());
    }
    let generation = caller.ask("pinned", &json!({}))?["generation"].clone();
    // A save of the user in between stays.
    let outcome = caller.ask("edit", &json!({ "file": file, "text": after, "base": before }));
    seen.insert(file, after);
    drop(seen);
    match outcome {
        Ok(shown) => {
            let result = match shown["generation"] == generation {
                true => {
                    "The picture stays as it is: no stage includes this file, or its code is the same. `check` compiles all files."
                }
                false => "It compiles, and the picture shows it.",
            };
            Ok(vec![text(format!("{said}\n{result}"))])
        }
        Err(Failure::Refused { diagnostics, .. }) if !diagnostics.is_empty() => Err(Failure::Refused {
            message: format!("{said}\nIt does not compile. The picture stays that of the last good shaders.\n"),
            diagnostics,
        }),
        Err(failure) => Err(failure),
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Check {
    #[serde(default)]
    assertions: bool,
    #[serde(default)]
    undefined: bool,
}

fn check(caller: &Caller<'_>, arguments: Map<String, Value>) -> Content {
    let Check { assertions, undefined } = read(arguments)?;
    let found = caller.ask("check", &json!({}))?;
    let found = found.as_array().cloned().unwrap_or_default();
    let mut said = match found.is_empty() {
        true => "All files compile, without warnings.".to_owned(),
        false => diagnostics::text_of(&found),
    };
    if (assertions || undefined) && !diagnostics::has_errors(&found) {
        said += "\n";
        said += &checks_of_picture(caller, undefined)?;
    }
    Ok(vec![text(said)])
}

/// Checks the picture, and leaves the setting as it was.
fn checks_of_picture(caller: &Caller<'_>, undefined: bool) -> Result<String, Failure> {
    let _one_at_a_time = lock(&caller.shared.checking);
    let before = caller.ask("get", &json!({ "path": "view.checks" }))?;
    let kind = if undefined { "undefined" } else { "assertions" };
    let found =
        caller.ask("set", &json!({ "values": { "view.checks": kind } })).and_then(|_| caller.ask("checks", &json!({})));
    // Also if the client has canceled the call, which asks nothing more.
    let restored = json!({ "values": { "view.checks": before } });
    caller.shared.program.ask(&Call::new(None), "set", &restored)?;
    let found = found?;
    let line = |check: &Value| {
        let field = |name: &str| check[name].as_str().unwrap_or_default();
        format!(
            "{}:{}: {}: {} ({} times, first at {})",
            field("file"),
            check["line"],
            field("rule"),
            field("message"),
            check["count"],
            check["first"]
        )
    };
    let lines: Vec<String> = found.as_array().into_iter().flatten().map(line).collect();
    Ok(match lines.as_slice() {
        [] => "No check of the picture failed.".to_owned(),
        lines => lines.join("\n"),
    })
}
