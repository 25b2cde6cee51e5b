//! Executes the commands of the control interface.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::Next;
use crate::app::command::{Command, Side, open_as};
use crate::app::control::compare::compare_as;
use crate::app::control::numbers::{numbers_as, write_edits_of};
use crate::app::engine::Engine;
use crate::app::execute::execute;
use crate::app::palette;
use crate::app::state::State;
use crate::app::state::captures::Job;
use crate::app::state::grid::Grid;
use crate::app::state::selection::Selected;
use crate::app::state::waiting::Until;
use crate::capture::modes_of;
use crate::control::{COMMANDS, Camera, Capture, Open, Playback, Probe, Request, Run, VersionsRequest};
use crate::message::did_you_mean;
use crate::picture;
use crate::scene::BUILT_IN;
use crate::settings::{Setting, Settings, catalog};
use crate::shader::Source;

/// Carries out a command, or begins to.
pub(in crate::app) fn request(state: &mut State, engine: &mut Engine, request: Request) -> Result<Next, String> {
    let shown = Next::Wait(Until::Shown);
    Ok(match request {
        Request::Set(assignments) => {
            let mut settings = state.session.settings.clone();
            assignments.iter().try_for_each(|assignment| settings.assign(assignment))?;
            adopt(state, settings)?;
            shown
        }
        Request::Get(path) => Next::Done(get(&state.session.settings, path.as_deref())?),
        Request::Mode(name) => {
            adopt(state, Settings { mode: name, ..state.session.settings.clone() })?;
            shown
        }
        Request::Camera(camera) => {
            move_camera(state, camera)?;
            Next::Wait(Until::Camera)
        }
        Request::Capture(capture) => Next::Wait(capture_of(capture)?),
        Request::Probe(Probe { at, modes }) => {
            let names = modes.unwrap_or_default();
            // The names are looked up again when the picture is there.
            if state.session.shaders.as_ref().is_some_and(|shaders| shaders.is_complete()) {
                modes_of(&state.session, &names)?;
            }
            Next::Wait(Until::Picture(Job::Probe { at: at.into(), names }))
        }
        Request::Reload => {
            execute(state, engine, Command::Reload);
            Next::Wait(Until::Reloaded)
        }
        Request::Open(what) => Next::Wait(open(state, engine, what)?),
        Request::Compare(compare) => compare_as(state, engine, compare)?,
        Request::Versions(versions) => versions_as(state, engine, versions)?,
        Request::Grid(modes) => show_grid(state, modes)?,
        Request::Pick(at) => Next::Done(pick(state, engine, at)?),
        Request::WriteDefaults(names) => write_defaults(state, engine, &names)?,
        Request::Numbers(numbers) => numbers_as(state, engine, numbers)?,
        Request::Undo if !state.history.undo(&mut state.session.settings) => {
            return Err("there is nothing to undo".into());
        }
        Request::Redo if !state.history.redo(&mut state.session.settings) => {
            return Err("there is nothing to redo".into());
        }
        Request::Undo | Request::Redo => shown,
        Request::Pass(name, on) => {
            let mut settings = state.session.settings.clone();
            let pass = state.session.shaders.as_ref().and_then(|shaders| shaders.graph.pass(&name).cloned());
            let on = on.unwrap_or_else(|| pass.is_none_or(|pass| !pass.is_wanted(&settings.passes)));
            settings.passes.insert(name, on);
            adopt(state, settings)?;
            shown
        }
        Request::Playback(playback) => Next::Done(play(state, &playback)?),
        Request::Modes => {
            let shaders = state.session.shaders.as_ref().ok_or("the shaders have not been compiled yet")?;
            Next::Done(json!(shaders.modes))
        }
        Request::Settings => Next::Done(settings_json()),
        Request::Commands => Next::Done(json!(COMMANDS)),
        Request::Entries => Next::Done(json!(palette::listed(state))),
        Request::Run(Run { entry, value }) => {
            palette::run(state, engine, &entry, value)?;
            shown
        }
        Request::Sheet(sheet) => Next::Wait(Until::Picture(Job::sheet(sheet)?)),
        Request::Turntable(turntable) => Next::Wait(Until::Picture(Job::turntable(turntable)?)),
        Request::Timeline(timeline) => Next::Wait(Until::Picture(Job::timeline(timeline)?)),
        Request::Cancel => {
            state.cancel_captures();
            Next::Done(Value::Null)
        }
        Request::Quit => {
            state.quit = true;
            Next::Done(Value::Null)
        }
    })
}

/// Takes settings, if nothing is wrong with them that was not wrong before. They are one step of undo.
fn adopt(state: &mut State, settings: Settings) -> Result<(), String> {
    settings.check()?;
    let shaders = state.session.shaders.clone();
    // A stage that is pending may declare a name that is not known yet.
    let is_complete = shaders.as_ref().is_some_and(|shaders| shaders.is_complete());
    let before = state.session.problems(is_complete);
    state.history.record(&state.session.shared_settings(), false);
    let old = std::mem::replace(&mut state.session.settings, settings);
    let mut problems = state.session.problems(is_complete).into_iter().filter(|problem| !before.contains(problem));
    let problem = problems.next().or_else(|| {
        let (shaders, mode) = (shaders.filter(|_| is_complete)?, &state.session.settings.mode);
        let is_unknown = state.session.mode().is_none() && *mode != old.mode;
        let hint = did_you_mean(mode, shaders.modes.iter().map(|mode| mode.slug.as_str()));
        is_unknown.then(|| format!("there is no mode `{mode}`.{hint} `modes` lists them all"))
    });
    if let Some(problem) = problem {
        state.session.settings = old;
        return Err(problem);
    }
    state.history.record(&state.session.shared_settings(), false);
    Ok(())
}

fn move_camera(state: &mut State, asked: Camera) -> Result<(), String> {
    let mut settings = state.session.settings.clone();
    let camera = &mut settings.camera;
    let frames = asked.frame || asked.view.is_some() || asked.azimuth.is_some() || asked.elevation.is_some();
    if frames {
        camera.frame_model();
    }
    if let Some(name) = &asked.view {
        let names = || Side::ALL.into_iter().map(|side| side.words().0);
        let side = Side::ALL.into_iter().find(|side| side.words().0.eq_ignore_ascii_case(name));
        let unknown = || {
            format!(
                "no view is named `{name}`.{} It can be {}",
                did_you_mean(name, names()),
                names().collect::<Vec<_>>().join(", ")
            )
        };
        [camera.azimuth, camera.elevation] = side.ok_or_else(unknown)?.angles();
    }
    camera.eye = asked.eye.or(camera.eye);
    camera.target = asked.target.or(camera.target);
    if let Some(fovy) = asked.fovy {
        // That of a camera of the file would win.
        camera.name.clear();
        camera.fovy = fovy;
    }
    camera.azimuth = asked.azimuth.unwrap_or(camera.azimuth);
    camera.elevation = asked.elevation.unwrap_or(camera.elevation);
    adopt(state, settings)
}

/// Opens a file or folder, and tells what its end is.
fn open(state: &mut State, engine: &mut Engine, open: Open) -> Result<Until, String> {
    let command = match open {
        Open::File(path) => open_as(path)?,
        Open::Model(path) => {
            let is_built_in = BUILT_IN.iter().any(|name| std::path::Path::new(name) == path);
            if !is_built_in && !path.exists() {
                let hint = did_you_mean(&path.to_string_lossy(), BUILT_IN);
                return Err(format!(
                    "{}: there is no such file, and no built-in model of this name.{hint}",
                    path.display()
                ));
            }
            Command::OpenModel(path)
        }
        Open::Environment(path) => Command::OpenEnvironment(path),
        Open::Tree(path) => Source::find(&path).map(|_| Command::OpenTree(path))?,
        Open::Look(path) => Command::OpenLook(path),
        Open::Measured(path) => Command::OpenMeasured(path),
    };
    let until = match &command {
        Command::OpenModel(path) => Until::Model(path.clone()),
        Command::OpenTree(_) => Until::Reloaded,
        Command::OpenLook(_) => Until::Look,
        _ => Until::Shown,
    };
    execute(state, engine, command);
    Ok(until)
}

/// Shows modes side by side.
fn show_grid(state: &mut State, modes: Vec<String>) -> Result<Next, String> {
    let shaders = state.session.shaders.clone().ok_or("the shaders have not been compiled yet")?;
    for name in &modes {
        let mode = shaders.modes.iter().find(|mode| mode.slug == *name).ok_or_else(|| {
            let hint = did_you_mean(name, shaders.modes.iter().map(|mode| mode.slug.as_str()));
            format!("there is no mode `{name}`.{hint} `modes` lists them all")
        })?;
        if !Grid::can_show(mode) {
            return Err(format!("`{name}` takes many frames, and can only be shown alone"));
        }
    }
    let selected = state.session.settings.mode.clone();
    if let Some(first) = modes.first().filter(|_| !modes.contains(&selected)) {
        adopt(state, Settings { mode: first.clone(), ..state.session.settings.clone() })?;
    }
    state.grid.show(modes)?;
    Ok(Next::Wait(Until::Grid))
}

/// Does what a click on a pixel does, or takes that back.
fn pick(state: &mut State, engine: &mut Engine, at: Option<[u32; 2]>) -> Result<Value, String> {
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
            execute(state, engine, Command::Pick([x, y]));
        }
    }
    Ok(json!(state.selected_event()))
}

/// Writes the values of parameters into the files.
fn write_defaults(state: &mut State, engine: &mut Engine, names: &[String]) -> Result<Next, String> {
    let edits = match names {
        [] => state.edits_of_defaults(None)?,
        names => {
            let of_each = names.iter().map(|name| state.edits_of_defaults(Some(name)));
            of_each.collect::<Result<Vec<_>, _>>()?.concat()
        }
    };
    if edits.is_empty() {
        return Err("the shader files have these values already".into());
    }
    write_edits_of(state, engine, edits)
}

/// Lists the versions of the shaders, shows one, or writes one into the files.
fn versions_as(state: &mut State, engine: &mut Engine, request: VersionsRequest) -> Result<Next, String> {
    Ok(match request {
        VersionsRequest::List => Next::Done(versions_json(state)),
        VersionsRequest::ShowNewest => {
            execute(state, engine, Command::ShowVersion(None));
            Next::Wait(Until::Reloaded)
        }
        VersionsRequest::Show(number) => {
            if state.versions.get(number).is_none() {
                return Err(format!("version {number} is no longer kept"));
            }
            execute(state, engine, Command::ShowVersion(Some(number)));
            Next::Wait(Until::Reloaded)
        }
        VersionsRequest::Write(number) => {
            if state.files_of_version(number).is_empty() {
                return Err(format!("the files are those of version {number}, or it is no longer kept"));
            }
            execute(state, engine, Command::WriteVersion(number));
            Next::Wait(Until::Written(number))
        }
    })
}

fn versions_json(state: &State) -> Value {
    let newest = state.shown_generation();
    let versions = state.versions.iter().map(|version| {
        let reload = &version.reload;
        json!({ "number": version.number, "title": version.title(), "since": version.since.to_rfc3339(),
            "changed": reload.changed, "compile_ms": reload.compile_ms, "pipeline_ms": reload.pipeline_ms,
            "first_frame_ms": reload.first_frame_ms, "device_ms": version.device_ms,
            "is_shown": version.number == newest, "can_compare": state.versions.can_show(version, newest) })
    });
    versions.collect()
}

fn play(state: &mut State, asked: &Playback) -> Result<Value, String> {
    if asked.time.is_some_and(|time| !time.is_finite()) {
        return Err("`time` is not finite; it takes seconds".to_owned());
    }
    if let Some(speed) = asked.speed.filter(|speed| !(0.0..=100.0).contains(speed)) {
        return Err(format!("`speed` is {speed}; it can be 0 to 100"));
    }
    let playback = &mut state.playback;
    playback.speed = asked.speed.unwrap_or(playback.speed);
    playback.paused = asked.paused.unwrap_or(playback.paused);
    if asked.restart {
        playback.restart();
    }
    if let Some(time) = asked.time {
        playback.seek(time);
    }
    if asked.step {
        playback.step();
    }
    let is_animated = state.is_animated();
    let playback = &state.playback;
    Ok(
        json!({ "time": short(playback.time_s()), "paused": playback.paused, "speed": short(playback.speed), "is_animated": is_animated }),
    )
}

/// Returns the condition that a capture waits for: the screen, the window, or a render on a thread.
fn capture_of(capture: Capture) -> Result<Until, String> {
    let Capture { file, size, mode, frames, ui } = capture;
    if let Some(file) = &file {
        picture::check_path(file)?;
    }
    let is_exr = file.as_deref().is_some_and(picture::holds_light);
    if ui {
        let wrong = size.is_some() || mode.is_some() || frames.is_some() || is_exr;
        return match wrong {
            true => Err("a capture with `ui` has the window's size and mode, and is a PNG".to_owned()),
            false => Ok(Until::Window(file)),
        };
    }
    if size.is_none() && mode.is_none() && frames.is_none() && !is_exr {
        return Ok(Until::Screen(file));
    }
    Ok(Until::Picture(Job::Picture { file, size: size.map(Into::into), mode, frames: frames.unwrap_or(1) }))
}

/// The settings at a path, or all.
fn get(settings: &Settings, path: Option<&str>) -> Result<Value, String> {
    let all = short(settings);
    let Some(path) = path.filter(|path| !path.is_empty()) else { return Ok(all) };
    let at = |path: &str| {
        path.split('.').try_fold(&all, |value, key| match value {
            Value::Array(list) => key.parse::<usize>().ok().and_then(|index| list.get(index)),
            value => value.get(key),
        })
    };
    let found = at(path).or_else(|| at(&format!("shader.{path}")));
    found.cloned().ok_or_else(|| {
        let hint = did_you_mean(path, catalog().iter().map(|setting| setting.path.as_str()));
        format!("`{path}` has no value of its own.{hint} `settings` lists all; what is not set has its default")
    })
}

fn settings_json() -> Value {
    let setting = |setting: &Setting| {
        json!({ "path": setting.path, "takes": setting.takes, "default": setting.default.to_string(),
            "range": setting.entry.valid.text(), "unit": setting.entry.unit.name, "doc": setting.doc() })
    };
    catalog().iter().map(setting).collect()
}

/// A value for an answer. Floats have the fewest digits that name them: 0.3, not 0.30000001192092896.
pub(super) fn short(value: impl serde::Serialize) -> Value {
    serde_json::to_string(&value).and_then(|text| serde_json::from_str(&text)).unwrap_or_default()
}

/// A path for an answer: absolute.
pub(super) fn path_text(path: &std::path::Path) -> String {
    std::path::absolute(path).unwrap_or_else(|_| PathBuf::from(path)).display().to_string()
}
