//! A fragment stage that tells what it computes, in a set of shaders that is otherwise the same.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::statement::{self, Site};
use crate::shader::contract::Texts;
use crate::shader::glsl::{code, color_of, main_of};
use crate::shader::library::Stage;
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::trace::{Place, Telling, Told, Traced, trace};
use crate::shader::{Compiler, ShaderSet, Source, StageKind};

/// The text that a stage gets, and what it is told.
pub struct Listener {
    /// GLSL that is appended. `SPECULA_COLOR` is the name of the color that the stage writes; its own `main` is `specula_main`.
    pub text: String,
    /// A line that is put before the text of the stage, behind `#version`; may be empty.
    pub extension: &'static str,
    /// The function of the text that gets the values.
    pub function: &'static str,
    /// Which values it gets.
    pub told: Told,
}

/// A fragment stage that has compiled with a text that listens.
pub struct ListeningStage<'a> {
    shaders: &'a ShaderSet,
    stage: Arc<Stage>,
    snapshot: Snapshot<'a>,
    words: Vec<u32>,
}

impl<'a> ListeningStage<'a> {
    /// Compiles the fragment stage `stage` of `shaders` once more. `source` gives files their names.
    ///
    /// # Errors
    /// A message why the stage cannot be traced.
    pub fn new(
        shaders: &'a ShaderSet,
        stage: &str,
        (compiler, source): (&Compiler, &'a Source),
        listener: &Listener,
    ) -> Result<Self, String> {
        let path = TreePath::from(stage);
        let before = shaders.stages.get(stage).filter(|before| before.kind == StageKind::Fragment);
        let before = before.ok_or_else(|| format!("{stage} is no fragment stage that has compiled"))?;
        let texts = shaders.texts.iter().map(|(path, text)| (path.clone(), Ok(text.clone()))).collect();
        let snapshot = Snapshot::holding(source, texts);
        let text = snapshot.read(&path).map_err(|error| error.to_string())?;
        let text = listening(&text, listener).map_err(|lack| format!("{stage} {lack}"))?;
        let over = snapshot.over(BTreeMap::from([(path.clone(), Ok(text.into()))]));
        let words = compiler.compile_with_lines(&over, &path);
        let words = words.ok_or_else(|| format!("{stage} does not compile with the text that traces its values"))?;
        Ok(Self { shaders, stage: before.clone(), snapshot, words })
    }

    /// Its module, instrumented. `only`: the file whose places alone tell.
    ///
    /// # Errors
    /// A message why it cannot be traced.
    pub fn traced(
        &self,
        listener: &Listener,
        only: Option<&str>,
        finish: impl FnOnce(Vec<u32>) -> Option<Vec<u32>>,
    ) -> Result<TracedStage<'_>, String> {
        let lacks = || format!("the values of {} cannot be traced", self.stage.path);
        let mut traced = trace(&self.words, listener.function, listener.told, only).ok_or_else(lacks)?;
        let words = finish(std::mem::take(&mut traced.words)).ok_or_else(lacks)?;
        let mut shaders = self.shaders.clone();
        shaders.stages.insert(self.stage.path.to_string(), Arc::new(self.stage.with_module(words)));
        Ok(TracedStage { shaders: Arc::new(shaders), of: self, traced })
    }
}

/// An instrumented stage and its set.
pub struct TracedStage<'a> {
    /// The set.
    pub shaders: Arc<ShaderSet>,
    of: &'a ListeningStage<'a>,
    traced: Traced,
}

impl TracedStage<'_> {
    /// The telling with a number that the module has given, from 1.
    pub fn telling(&self, number: u32) -> Option<&Telling> {
        self.traced.tellings.get((number as usize).checked_sub(1)?)
    }

    /// The files with places that tell, in the order of the module.
    pub(super) fn files(&self) -> Vec<String> {
        let mut files: Vec<String> = Vec::new();
        for place in self.traced.places.iter().filter(|place| place.line > 0) {
            if !files.contains(&place.file) {
                files.push(place.file.clone());
            }
        }
        files
    }

    /// The place of a telling.
    pub fn place(&self, telling: &Telling) -> &Place {
        &self.traced.places[telling.place]
    }

    /// A line of a file of the tree, without the space around it; empty if there is none.
    pub(super) fn line(&self, file: &str, line: u32) -> String {
        let text = self.of.snapshot.read(&TreePath::from(file)).unwrap_or_default();
        let at = (line as usize).checked_sub(1);
        at.and_then(|at| text.lines().nth(at)).unwrap_or_default().trim().to_owned()
    }

    /// The statement of a telling, by its number.
    pub fn site_of(&self, number: u32) -> Option<Site> {
        let place = self.place(self.telling(number)?);
        let ListeningStage { stage, snapshot, .. } = self.of;
        Some(statement::site(place, Texts { snapshot, stage: &stage.path, dependencies: &stage.dependencies }))
    }
}

/// The text of a stage that listens. No line moves.
fn listening(text: &str, listener: &Listener) -> Result<String, &'static str> {
    let main = main_of(&code(text)).ok_or("has no main()")?;
    let color = color_of(text).ok_or("has no `out vec4` color")?;
    let (before, after) = (&text[..main.start], &text[main.end..]);
    let before = match (listener.extension, before.find("#version").and_then(|at| Some(at + before[at..].find('\n')?)))
    {
        ("", _) | (_, None) => before.to_owned(),
        (extension, Some(end)) => {
            let next = before[..=end].lines().count() + 1;
            format!("{}{extension}\n#line {next}\n{}", &before[..=end], &before[end + 1..])
        }
    };
    Ok(format!("{before}specula_main{after}\n{}", listener.text.replace("SPECULA_COLOR", &color)))
}
