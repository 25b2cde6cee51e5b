//! Applies the results of the threads to the viewer.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{FirstFrame, Viewer};
use crate::app::command::{Command, CompareWith, open_as};
use crate::app::dialog::Dialog;
use crate::app::state::arrangement::Preset;
use crate::app::state::inspection::Shown;
use crate::app::state::recent::Kind;
use crate::app::state::workspace::PanelRequest;
use crate::events::{CompletedEvent, Event, ReloadEvent, emit};
use crate::gpu::GpuError;
use crate::message::print_error;
use crate::pipeline::{Outcome, Reload};
use crate::render::{BakeError, wrong_values};
use crate::scene::environment;
use crate::settings::GROUND;
use crate::shader::{Diagnostic, Severity, ShaderSet, expression};
use crate::threads::BakeMessage;
use crate::threads::WorkerMessage;
use crate::threads::{Message, TaskKind};

impl Viewer {
    /// Shows the panels for a single file, which has no model, or those of before for a tree.
    fn arrange_for(&mut self, is_single_file: bool) {
        let was_single_file = std::mem::replace(&mut self.shader.is_single_file, is_single_file);
        match (was_single_file, is_single_file) {
            (false, true) => self.workspace.request(PanelRequest::ArrangeTemporarily(Preset::Toy)),
            (true, false) => self.workspace.request(PanelRequest::ArrangeAsBefore),
            _ => {}
        }
    }

    pub(in crate::app) fn on_message(&mut self, message: Message) {
        match message {
            Message::Worker(WorkerMessage::Built(Err(message))) => {
                self.fail_waiting(&message);
                self.say(message);
            }
            Message::Worker(WorkerMessage::Built(Ok(()))) => {
                self.threads.worker.built();
                self.stages_changed();
            }
            Message::Worker(WorkerMessage::DriverTold) => self.stages_changed(),
            // The message wakes the window, which draws the thumbnails.
            Message::Worker(WorkerMessage::ThumbnailsBuilt) => {}
            Message::Worker(WorkerMessage::Reloaded { reload, detect_ms, source, edits }) => {
                self.threads.worker.reloaded(edits);
                self.shader.compiling = false;
                self.shader.tree = source.name();
                self.shader.location = source.location().map(Into::into);
                self.arrange_for(source.is_toy());
                self.threads.follow_tree(&source);
                self.source = source;
                self.remember_tree(&reload.outcome);
                self.on_reload(&reload, detect_ms);
            }
            Message::Worker(WorkerMessage::Completed(reload)) => self.on_completed(&reload),
            Message::Loaded(loaded) => self.on_loaded(*loaded),
            Message::Bake(message) => self.on_bake(message),
            Message::EndlessLoop(words, diagnostic) => self.show_endless_loop(words, diagnostic.map(|found| *found)),
            Message::FilesChanged(paths) => self.on_files_changed(&paths),
            Message::Curves(measured) => self.on_curves(*measured),
            Message::NotFinite(number, found) => self.on_not_finite(number, *found),
            Message::Say(text) => self.say(text),
            Message::Tools(tools) => self.on_tools(tools),
            Message::Look(Ok(look)) => {
                let model = self.show_look(*look);
                if model.is_none() {
                    self.check_names();
                }
                self.look_read(Ok(model));
                self.watch_files();
            }
            Message::Written(written) => self.on_written(written),
            Message::Look(Err(message)) => {
                self.say(message.clone());
                self.look_read(Err(message));
            }
            Message::Asked(asked) => self.on_asked(*asked),
            // The screen has taken them.
            Message::Accessibility(_) | Message::Pictures(_) => {}
            Message::Captures(number, done, of) => self.controlled.captures.progress(number, done, of),
            Message::Captured(number) => self.controlled.captures.ended(number),
            Message::Compared(number, compared) => self.on_compared(number, compared),
            Message::PictureRead(number, read) => self.on_picture_read(number, read),
            Message::PictureFits(number, still) => self.on_picture_fits(number, still),
            Message::SecondTree(number, message) => self.on_second_tree(number, message),
            Message::VersionWritten(number, written) => self.on_version_written(number, &written),
            Message::Chosen(answer) => {
                let dialog = self.choosing.take();
                match answer {
                    Ok(path) => path.into_iter().for_each(|path| self.chosen(dialog, path)),
                    Err(message) => self.say(message),
                }
            }
            Message::NewTree(answer) => {
                self.choosing = None;
                match answer {
                    Ok(path) => path.into_iter().for_each(|path| self.execute(Command::OpenTree(path))),
                    Err(message) => self.say(message),
                }
            }
            Message::Prepared(exercise, prepared) => self.on_prepared(exercise, prepared),
            Message::Exercise(folder, exercise) => self.on_exercise(folder, exercise),
            Message::Checked(checked) => self.on_checked(checked),
            Message::Panicked(task, text) => self.on_panic(task, &text),
        }
    }

    /// Opens what the user has chosen in a dialog.
    fn chosen(&mut self, dialog: Option<Dialog>, path: PathBuf) {
        match dialog {
            Some(Dialog::Picture) => self.execute(Command::Compare(CompareWith::File(path))),
            Some(Dialog::SecondTree) => self.execute(Command::Compare(CompareWith::Tree(path))),
            _ => self.execute(open_as(path).unwrap_or_else(Command::Say)),
        }
    }

    /// Remembers the shader tree on disk, if it compiles.
    fn remember_tree(&mut self, outcome: &Outcome) {
        if let (Outcome::Ready(_), Some(tree)) = (outcome, self.source.location()) {
            self.recent.remember(Kind::Tree, tree);
        }
    }

    /// Accepts the stages of a reload that the picture did not need.
    fn on_completed(&mut self, reload: &Reload) {
        let generation = self.session.shaders.as_ref().map_or(0, |shaders| shaders.generation);
        self.shader.log.compiled(&reload.report, matches!(reload.outcome, Outcome::Ready(_)));
        self.stages_changed();
        match &reload.outcome {
            Outcome::Unchanged { .. } => return,
            Outcome::Failed(diagnostics) => {
                // The generation never settles, so the exercise is not measured.
                self.learning.checking = None;
                self.show_errors(diagnostics);
            }
            Outcome::Ready(set) => {
                self.set_diagnostics(set.shaders.warnings.clone());
                self.session.shaders = Some(set.shaders.clone());
                self.resources.set_pipelines(set);
                self.follow_edits(&set.shaders);
                self.versions.complete(&set.shaders);
                self.generations.complete(set);
                if !self.names_checked || self.session.mode().is_none() {
                    self.check_names();
                }
            }
        }
        let event = CompletedEvent::new(reload, generation);
        self.shader.log.completed(&event);
        emit(&self.events, &Event::Completed(event));
    }

    fn show_errors(&mut self, diagnostics: &[Diagnostic]) {
        for diagnostic in diagnostics {
            print_error(diagnostic.full());
            emit(&self.events, &Event::Diagnostic(diagnostic));
        }
        self.set_diagnostics(diagnostics.to_vec());
    }

    fn on_reload(&mut self, reload: &Reload, detect_ms: f64) {
        let generation = self.session.shaders.as_ref().map_or(0, |shaders| shaders.generation);
        let is_good = !matches!(reload.outcome, Outcome::Failed(_) | Outcome::Unchanged { cleared: false });
        self.shader.log.compiled(&reload.report, is_good);
        self.shader.told = None;
        self.stages_changed();
        match &reload.outcome {
            Outcome::Unchanged { cleared: false } => self.check_again(),
            Outcome::Unchanged { cleared: true } => {
                self.check_again();
                self.endless_loop = None;
                self.session.diagnostics.clear();
                self.report(ReloadEvent::new(reload, generation, detect_ms, 0.0));
            }
            Outcome::Failed(diagnostics) => {
                self.learning.checking = None;
                self.show_errors(diagnostics);
                self.report(ReloadEvent::new(reload, generation, detect_ms, 0.0));
            }
            Outcome::Ready(set) => {
                self.endless_loop = None;
                self.session.diagnostics.clone_from(&set.shaders.warnings);
                for warning in &self.session.diagnostics {
                    print_error(warning.full());
                    if warning.severity == Severity::Error {
                        emit(&self.events, &Event::Diagnostic(warning));
                    }
                }
                // The worker drops requests for older sets, so those of a comparison are sent again.
                self.threads.worker.built();
                let event = ReloadEvent::new(reload, set.shaders.generation, detect_ms, 0.0);
                self.first_frame = Some(FirstFrame { generation: set.shaders.generation, event });
                self.session.shaders = Some(set.shaders.clone());
                self.resources.set_pipelines(set);
                self.follow_edits(&set.shaders);
                self.check_names();
            }
        }
    }

    /// Shows the diagnostic of a loop that did not end, unless a newer picture has taken its place.
    fn show_endless_loop(&mut self, words: [u32; 2], diagnostic: Option<Diagnostic>) {
        let Some(endless) = self.endless_loop.as_mut().filter(|endless| endless.words == words) else { return };
        let Some(diagnostic) = diagnostic else { return };
        print_error(diagnostic.full());
        emit(&self.events, &Event::Diagnostic(&diagnostic));
        endless.diagnostic = Some(diagnostic);
        let others = std::mem::take(&mut self.session.diagnostics);
        self.set_diagnostics(others);
    }

    pub(super) fn report(&mut self, event: ReloadEvent) {
        emit(&self.events, &Event::Reload(event.clone()));
        self.shader.log.finished(&event);
        self.stages_changed();
        // No file has changed if only another expression is watched.
        let is_watch = event.changed.is_empty() && event.stages == [expression::STAGE];
        // Numbers that are dragged, and an older version in place of the newest, are no saves.
        if self.has_folder() && self.edits.draft.as_ref().is_none() && self.edits.restored.is_none() {
            self.hint.saved(&event);
        }
        let changed = if is_watch { vec![expression::MODE.to_owned()] } else { event.changed.clone() };
        self.shader.last = Some(ReloadEvent { changed, ..event });
    }

    /// Reports settings and modes that the shaders lack. The settings stay, because the next edit may declare them.
    /// Unknown names are reported once, when all stages have compiled: a stage that is pending may declare them.
    fn check_names(&mut self) {
        let is_complete = self.session.shaders.as_ref().is_some_and(|shaders| shaders.is_complete());
        // The window switches the ground on by itself, and a tree need not have one.
        let lacks = |shaders: &Arc<ShaderSet>| shaders.graph.pass(GROUND).is_none();
        if is_complete && !self.names_checked && self.session.shaders.as_ref().is_some_and(lacks) {
            self.session.settings.passes.remove(GROUND);
        }
        let mut problems = self.session.problems(is_complete && !self.names_checked);
        self.names_checked |= is_complete;
        if is_complete && self.session.mode().is_none() {
            let mode = &self.session.settings.mode;
            problems.push(format!(
                "there is no mode '{mode}', so the final picture is shown; `specula modes` lists all modes"
            ));
        }
        if !problems.is_empty() {
            self.say(problems.join("\n"));
        }
    }

    fn on_bake(&mut self, message: BakeMessage) {
        match message {
            BakeMessage::Progress(number, done, next) => self.threads.baker.set_progress(number, done, next),
            BakeMessage::Environment(number, result) => {
                let Some(key) = self.threads.baker.ended(number) else { return };
                match result {
                    // The shaders are others, and do the same.
                    Ok(environment) if Arc::ptr_eq(&environment, self.resources.environment()) => {
                        self.resources.set_environment(key, Some(environment));
                    }
                    Ok(environment) => {
                        self.warn_of(environment.wrong());
                        if !environment::BUILT_IN.contains(&key.name.as_str()) {
                            self.recent.remember(Kind::Environment, Path::new(&key.name));
                        }
                        emit(&self.events, &Event::Bake(&environment.report));
                        self.session.revisions.suns = environment.sun_count();
                        self.resources.set_environment(key, Some(environment));
                    }
                    Err(error) => {
                        if let BakeError::Gpu(GpuError::EndlessLoop(words)) = error {
                            self.on_endless_loop(words);
                        }
                        self.recent.forget(Kind::Environment, Path::new(&key.name));
                        self.resources.set_environment(key, None);
                        self.fail_waiting(&error.to_string());
                        self.say(format!("{error}\nThe previous environment stays."));
                    }
                }
            }
            BakeMessage::Tables(key, result) => {
                if self.threads.baker.has_tables(&key) {
                    if let Ok(tables) = &result {
                        self.warn_of(tables.wrong.iter().copied());
                    }
                    if let Err(GpuError::EndlessLoop(words)) = result {
                        self.on_endless_loop(words);
                    }
                    let result = result.map_err(|error| self.say(error.to_string()));
                    self.resources.set_tables(key, result.ok());
                }
            }
            BakeMessage::Measured(key, result) => {
                if self.threads.baker.has_read(&key) {
                    let result = result.map_err(|message| {
                        self.fail_waiting(&message);
                        self.say(message);
                    });
                    self.resources.set_measured(key, result.ok());
                }
            }
            BakeMessage::PathTracing(key, result) => {
                if self.threads.baker.has_path_tracing(&key) {
                    let result = result.map_err(|message| {
                        self.fail_waiting(&message);
                        self.say(message);
                    });
                    self.resources.set_path_tracing(key, result.ok());
                }
            }
        }
    }

    /// Warns of functions whose values a bake could not use.
    fn warn_of(&mut self, functions: impl IntoIterator<Item = &'static str>) {
        for function in functions {
            self.say(wrong_values(function));
        }
    }

    /// Reports that a thread has panicked, and treats its work as failed.
    fn on_panic(&mut self, task: TaskKind, text: &str) {
        let thread = match task {
            TaskKind::Worker => {
                self.threads.worker.panicked();
                self.shader.compiling = false;
                "worker"
            }
            TaskKind::Loader(number) => {
                self.model.loading &= !self.threads.loader.is_newest(number);
                "loader"
            }
            TaskKind::Baker(number) => {
                let failed = self.threads.baker.ended(number);
                failed.into_iter().for_each(|key| self.resources.set_environment(key, None));
                "baker"
            }
            TaskKind::Tables(key) => {
                if self.threads.baker.has_tables(&key) {
                    self.resources.set_tables(key, None);
                }
                "baker"
            }
            TaskKind::MeasuredBrdf(key) => {
                if self.threads.baker.has_read(&key) {
                    self.resources.set_measured(key, None);
                }
                "reader"
            }
            TaskKind::LoopDiagnosis(words) => {
                if self.endless_loop.as_ref().is_some_and(|endless| endless.words == words) {
                    self.endless_loop = None;
                }
                "explainer"
            }
            TaskKind::Checker => {
                self.learning.checking = None;
                "checking"
            }
            TaskKind::Measurer => {
                // The same question would panic again, so it stays asked until another one comes.
                let inspector = &mut self.inspection;
                if let Some(asked) = &inspector.asked {
                    let now = Err("the measurement failed".to_owned());
                    inspector.curves = Some(Shown { of: asked.material, now, before: None });
                }
                "measuring"
            }
            TaskKind::Finder => {
                self.inspection.fail_search();
                "finding"
            }
            TaskKind::Capture(number) => {
                self.controlled.captures.ended(number);
                "capturing"
            }
            TaskKind::ToolPipelines => "toolmaker",
            TaskKind::SecondTree(number) => {
                self.second_tree_failed(number);
                "second tree"
            }
            TaskKind::ImageScaling(number) => {
                self.on_picture_fits(number, Err("the picture could not be scaled".to_owned()));
                "scaling"
            }
            TaskKind::External => {
                (self.choosing, self.compare.measuring) = (None, None);
                "waiting"
            }
            TaskKind::PathTracing(key) => {
                if self.threads.baker.has_path_tracing(&key) {
                    self.resources.set_path_tracing(key, None);
                }
                "tracer"
            }
        };
        self.keep_saying(format!("Specula's {thread} thread failed ({text}). Please report this; your files are safe"));
    }
}
