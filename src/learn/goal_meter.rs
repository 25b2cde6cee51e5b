//! Measures whether a tree reaches the goals of an exercise, beside the tree of the solution.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::goal::Check;
use super::measured::{self, Verdict};
use super::{Exercise, Finding, Goal, shown};
use crate::gpu::{Gpu, GpuError};
use crate::headless::{Headless, HeadlessError, Sequence};
use crate::measure::BrdfMeter;
use crate::pipeline::Outcome;
use crate::render::Capture;
use crate::scene;
use crate::settings::Settings;
use crate::shader::{Change, Compiler, Diagnostic, ShaderSet, Source, TreePath};

/// Size of the pictures that are compared.
const SIZE: (u32, u32) = (192, 128);
/// Frames a second of pictures that move.
const FPS: f32 = 30.0;

/// Why a tree was not measured.
#[derive(Debug, thiserror::Error)]
pub enum LearnError {
    /// The tree does not compile.
    #[error("{}", .0.first().map(ToString::to_string).unwrap_or_default())]
    Shaders(Vec<Diagnostic>),
    /// The exercise itself is wrong.
    #[error("{0}")]
    Exercise(String),
    /// A device error, or an edit made a setting invalid.
    #[error(transparent)]
    Headless(HeadlessError),
    /// A newer edit has arrived.
    #[error("a newer edit has come")]
    Superseded,
}

impl From<HeadlessError> for LearnError {
    fn from(error: HeadlessError) -> Self {
        match error {
            HeadlessError::Shaders(diagnostics) => Self::Shaders(diagnostics),
            other => Self::Headless(other),
        }
    }
}

/// A BRDF meter, with its shaders and settings.
type Measuring = (Arc<ShaderSet>, Settings, BrdfMeter);

/// Measures goals on a device. It keeps what it has compiled, so the next measurement of the same exercise is faster.
pub struct GoalMeter {
    gpu: Arc<Gpu>,
    compiler: Arc<Compiler>,
    /// Name of the exercise that the other fields are of.
    exercise: String,
    own: Option<(Source, Headless)>,
    solved: Option<Headless>,
    own_bench: Option<Measuring>,
    solved_bench: Option<Measuring>,
    /// Pictures of the solution, by goal.
    pictures: BTreeMap<usize, Capture>,
}

impl GoalMeter {
    /// A goal meter on this device.
    pub fn new(gpu: &Arc<Gpu>, compiler: &Arc<Compiler>) -> Self {
        let (gpu, compiler) = (gpu.clone(), compiler.clone());
        let (exercise, pictures) = (String::new(), BTreeMap::new());
        Self { gpu, compiler, exercise, own: None, solved: None, own_bench: None, solved_bench: None, pictures }
    }

    /// Measures the tree of `source`, goal by goal. `superseded` returns whether the result is obsolete.
    ///
    /// # Errors
    /// Shaders that do not compile, a device error, or the end by `superseded`.
    pub fn check(
        &mut self,
        exercise: &Exercise,
        source: &Source,
        superseded: impl Fn() -> bool,
    ) -> Result<Vec<Finding>, LearnError> {
        if self.exercise != exercise.name {
            (self.own, self.solved) = (None, None);
            self.pictures.clear();
            self.exercise.clone_from(&exercise.name);
        }
        self.open(exercise, source)?;
        let mut findings = Vec::new();
        for (index, goal) in exercise.goals.iter().enumerate() {
            if superseded() {
                return Err(LearnError::Superseded);
            }
            let (passed, found) = self.verdict(exercise, index, goal)?;
            findings.push(Finding { goal: goal.says.clone(), passed, found });
        }
        Ok(findings)
    }

    /// Compiles the tree, or only what has changed since the last call.
    fn open(&mut self, exercise: &Exercise, source: &Source) -> Result<(), LearnError> {
        let is_same = |known: &Source| known.location().is_some() && known.location() == source.location();
        if let Some((_, headless)) = self.own.as_mut().filter(|(known, _)| is_same(known)) {
            // Files that were removed count as changed, too.
            let mut paths: BTreeSet<TreePath> = source.list().into_iter().collect();
            paths.extend(headless.reloader().library().dependencies());
            let reload = headless.update(Change::Paths(paths));
            return match reload.outcome {
                Outcome::Failed(diagnostics) => Err(LearnError::Shaders(diagnostics)),
                Outcome::Ready(_) | Outcome::Unchanged { .. } => Ok(()),
            };
        }
        self.own = None;
        let headless = self.headless(exercise, source.clone())?;
        self.own = Some((source.clone(), headless));
        Ok(())
    }

    fn headless(&self, exercise: &Exercise, source: Source) -> Result<Headless, LearnError> {
        let model = scene::built_in(&exercise.model);
        let model = model.ok_or_else(|| LearnError::Exercise(format!("there is no model {}", exercise.model)))?;
        let model = model.map_err(|error| LearnError::Exercise(error.to_string()))?;
        let settings = settings(exercise, None)?;
        let opened = Headless::measuring(&self.gpu, &self.compiler, source, model, settings, SIZE)?;
        Ok(opened)
    }

    /// The student's tree and that of the solution, which is compiled once.
    fn both(&mut self, exercise: &Exercise) -> Result<(&mut Headless, &mut Headless), LearnError> {
        if self.solved.is_none() {
            self.solved = Some(self.headless(exercise, exercise.solved_tree())?);
        }
        match (&mut self.own, &mut self.solved) {
            (Some((_, own)), Some(solved)) => Ok((own, solved)),
            _ => Err(LearnError::Exercise("no tree is open".into())),
        }
    }

    fn verdict(&mut self, exercise: &Exercise, index: usize, goal: &Goal) -> Result<Verdict, LearnError> {
        let settings = settings(exercise, Some(goal))?;
        Ok(match &goal.check {
            Check::Furnace { .. } | Check::Normalization { .. } | Check::Reciprocity { .. } => {
                self.measure(exercise, &goal.check, &settings)?
            }
            Check::Values { mode, name, within, scale } => {
                let settings = Settings { mode: mode.clone(), ..settings };
                let (own, _) = self.both(exercise)?;
                if !own.shaders().modes.iter().any(|known| known.slug == *mode) {
                    return Ok((false, format!("the tree has no mode `{mode}`")));
                }
                let (found, solved) = self.render(exercise, index, &settings, 1)?;
                shown::values(&found, &solved, name, *within, *scale)
            }
            Check::Picture { within, frames } => {
                let (found, solved) = self.render(exercise, index, &settings, *frames)?;
                shown::pictures(&found, &solved, *within)
            }
            Check::Finite => shown::finite(&draw(self.both(exercise)?.0, &settings, 1)?),
            Check::Mode { slug, components } => self.mode(exercise, slug, *components)?,
            Check::Parameter { name, range, default } => self.parameter(exercise, name, *range, *default)?,
            Check::Light { pass, at, factor, within } => {
                let (own, _) = self.both(exercise)?;
                let Some(note) = own.shaders().graph.pass(pass).map(|pass| pass.desc.on) else {
                    return Ok((false, format!("the tree has no pass `{pass}`")));
                };
                if !note {
                    return Ok((false, format!("the pass `{pass}` is off: its note says `off`")));
                }
                let mut without = settings.clone();
                without.passes.insert(pass.clone(), false);
                let (with, without) = (draw(own, &settings, 1)?, draw(own, &without, 1)?);
                shown::light(&with, &without, *at, *factor, *within)
            }
        })
    }

    fn measure(&mut self, exercise: &Exercise, check: &Check, settings: &Settings) -> Result<Verdict, LearnError> {
        let (own, solved) = self.both(exercise)?;
        let (own, solved) = (own.shaders(), solved.shaders());
        let Self { gpu, own_bench, solved_bench, .. } = self;
        let own = meter(own_bench, gpu, &own, settings).map_err(HeadlessError::from)?;
        let of_solution = |surface, grid| meter(solved_bench, gpu, &solved, settings)?.furnace(surface, grid);
        let verdict = measured::verdict(check, own, of_solution);
        let verdict = verdict.unwrap_or_else(|| Ok((false, "nothing was measured".to_owned())));
        verdict.map_err(|error| HeadlessError::from(error).into())
    }

    /// The picture of the student's tree, and that of the solution.
    fn render(
        &mut self,
        exercise: &Exercise,
        index: usize,
        settings: &Settings,
        frames: u32,
    ) -> Result<(Capture, Capture), LearnError> {
        let known = self.pictures.get(&index).cloned();
        let (own, solved) = self.both(exercise)?;
        let found = draw(own, settings, frames)?;
        let expected = match known {
            Some(known) => known,
            None => draw(solved, settings, frames)?,
        };
        self.pictures.insert(index, expected.clone());
        Ok((found, expected))
    }

    fn mode(&mut self, exercise: &Exercise, slug: &str, components: u8) -> Result<Verdict, LearnError> {
        let shaders = self.both(exercise)?.0.shaders();
        let Some(mode) = shaders.modes.iter().find(|mode| mode.slug == slug) else {
            return Ok((false, format!("the tree has no mode `{slug}`")));
        };
        let is_good = mode.components == components;
        let says = format!("the mode `{slug}` has {} components", mode.components);
        Ok((is_good, measured::with_expected(says, is_good, components.into())))
    }

    fn parameter(
        &mut self,
        exercise: &Exercise,
        name: &str,
        range: (f64, f64),
        default: f64,
    ) -> Result<Verdict, LearnError> {
        let shaders = self.both(exercise)?.0.shaders();
        let Some(parameter) = shaders.parameters.iter().find(|parameter| parameter.name == name) else {
            return Ok((false, format!("the tree has no parameter `{name}`")));
        };
        if parameter.range != Some(range) {
            return Ok((false, format!("the range of `{name}` is not {}..{}", range.0, range.1)));
        }
        let found = parameter.default.first().copied().unwrap_or(f64::NAN);
        let is_good = (found - default).abs() < 1e-6;
        let says = format!("`{name}` is {} at first", measured::number(found));
        Ok((is_good, measured::with_expected(says, is_good, default)))
    }
}

/// The BRDF meter of these shaders and settings, created again when they differ.
fn meter<'a>(
    made: &'a mut Option<Measuring>,
    gpu: &Arc<Gpu>,
    shaders: &Arc<ShaderSet>,
    settings: &Settings,
) -> Result<&'a BrdfMeter, GpuError> {
    let is_same = |(known, of, _): &Measuring| Arc::ptr_eq(known, shaders) && of == settings;
    let made = match made.take().filter(is_same) {
        Some(known) => made.insert(known),
        None => made.insert((shaders.clone(), settings.clone(), BrdfMeter::new(gpu, shaders, settings)?)),
    };
    Ok(&made.2)
}

/// Draws `frames` frames from the beginning, and reads the last one.
fn draw(headless: &mut Headless, settings: &Settings, frames: u32) -> Result<Capture, LearnError> {
    *headless.settings_mut() = settings.clone();
    headless.set_sequence(Sequence { frames, fps: FPS, ..Sequence::default() });
    Ok(headless.render()?)
}

/// The settings of a measurement: those of the exercise without an environment, whose bake takes longer than the rest, and without
/// antialiasing, then those of the goal.
fn settings(exercise: &Exercise, goal: Option<&Goal>) -> Result<Settings, LearnError> {
    let mut settings = Settings::default();
    let plain = ["environment.name=none", "view.msaa=1"].into_iter();
    let assigned = exercise.apply_settings(&mut settings).and_then(|()| {
        let mut rest = plain.chain(goal.iter().flat_map(|goal| goal.set.iter().map(String::as_str)));
        rest.try_for_each(|assignment| settings.assign(assignment))
    });
    assigned.map_err(LearnError::Exercise)?;
    Ok(settings)
}
