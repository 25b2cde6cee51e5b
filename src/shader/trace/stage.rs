//! A stage that logs what it computes, in a set of shaders that is otherwise the same.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::conditions::line_of_condition;
use super::statement::{self, Site};
use crate::shader::contract::Texts;
use crate::shader::glsl::syntax::{Function, functions};
use crate::shader::glsl::{Code, code, color_of, main_of};
use crate::shader::library::Stage;
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::trace::{LogPoint, Logged, Place, Purpose, Traced, instances, trace};
use crate::shader::{Compiler, ShaderSet, Source, StageKind, specialize};

/// A text that is appended to a stage, and the values that it gets.
pub struct Listener {
    /// GLSL that is appended. `SPECULA_COLOR` is the name of the color that a fragment stage writes; its own `main` is `specula_main`.
    pub text: String,
    /// Lines that are put behind `#version`; may be empty.
    pub extensions: &'static str,
    /// The function of the text that gets the values.
    pub function: &'static str,
    /// Which values it gets.
    pub logged: Logged,
}

/// A stage, and the texts of its files.
struct StageTexts {
    shaders: Arc<ShaderSet>,
    stage: Arc<Stage>,
    source: Source,
}

impl StageTexts {
    fn snapshot(&self) -> Snapshot<'_> {
        let texts = self.shaders.texts.iter().map(|(path, text)| (path.clone(), Ok(text.clone()))).collect();
        Snapshot::holding(&self.source, texts)
    }

    /// The text of a file; empty if there is none.
    fn text(&self, file: &str) -> Arc<str> {
        let path = TreePath::from(file);
        let known = self.shaders.texts.get(&path).cloned();
        known.or_else(|| self.source.read(&path).ok().map(Arc::from)).unwrap_or_default()
    }

    /// The text of a file as its author wrote it, with the same lines.
    fn author_text(&self, file: &str) -> Arc<str> {
        let own = self.shaders.author_text(&TreePath::from(file)).cloned();
        own.unwrap_or_else(|| self.text(file))
    }
}

/// A stage that has compiled with a listener.
pub struct ListeningStage {
    texts: Arc<StageTexts>,
    words: Vec<u32>,
}

/// Compiles the stage at `path` of `shaders` once more, with an appended text. `source` gives files their names. Returns its snapshot and its
/// module, with lines.
///
/// # Errors
/// A message why it cannot be compiled so.
pub fn compile_listening<'a>(
    shaders: &ShaderSet,
    path: &TreePath,
    (compiler, source): (&Compiler, &'a Source),
    (text, extensions): (&str, &str),
) -> Result<(Snapshot<'a>, Vec<u32>), String> {
    let texts = shaders.texts.iter().map(|(path, text)| (path.clone(), Ok(text.clone()))).collect();
    let snapshot = Snapshot::holding(source, texts);
    let own = snapshot.read(path).map_err(|error| error.to_string())?;
    let both = listening(&own, text, extensions).map_err(|lack| format!("{path} {lack}"))?;
    let over = snapshot.over(BTreeMap::from([(path.clone(), Ok(both.into()))]));
    let words = compiler.compile_with_lines(&over, path);
    let words = words.ok_or_else(|| format!("{path} does not compile with the text that traces its values"))?;
    Ok((snapshot, words))
}

impl ListeningStage {
    /// Compiles the stage `stage` of `shaders` once more. `source` gives files their names.
    ///
    /// # Errors
    /// A message why the stage cannot be traced.
    pub fn new(
        shaders: &Arc<ShaderSet>,
        stage: &str,
        tools: (&Compiler, &Source),
        listener: &Listener,
    ) -> Result<Self, String> {
        let before = shaders.stages.get(stage).ok_or_else(|| format!("{stage} is no stage that has compiled"))?;
        let text = (listener.text.as_str(), listener.extensions);
        let (_, words) = compile_listening(shaders, &TreePath::from(stage), tools, text)?;
        let texts = StageTexts { shaders: shaders.clone(), stage: before.clone(), source: tools.1.clone() };
        Ok(Self { texts: Arc::new(texts), words })
    }

    /// Its module, instrumented, after `finish`, which also gets the number of its log points. `only`: the files whose statements are logged.
    ///
    /// # Errors
    /// A message why it cannot be traced.
    pub fn traced(
        &self,
        listener: &Listener,
        only: Option<&BTreeSet<String>>,
        finish: impl FnOnce(Vec<u32>, usize) -> Option<Vec<u32>>,
    ) -> Result<TracedStage, String> {
        let StageTexts { shaders, stage, .. } = &*self.texts;
        let lacks = || format!("the values of {} cannot be traced", stage.path);
        let mut traced = trace(&self.words, listener.function, listener.logged, only).ok_or_else(lacks)?;
        let words = finish(std::mem::take(&mut traced.words), traced.points.len()).ok_or_else(lacks)?;
        self.move_places(&mut traced.places);
        let mut shaders = ShaderSet::clone(shaders);
        shaders.stages.insert(stage.path.to_string(), Arc::new(stage.with_module(words)));
        Ok(TracedStage { shaders: Arc::new(shaders), texts: self.texts.clone(), traced })
    }

    /// Moves arguments to the headers of their functions, and constant conditions to their statements.
    fn move_places(&self, places: &mut [Place]) {
        let moves = |place: &Place| matches!(place.purpose, Purpose::Argument(_) | Purpose::Constant { .. });
        let files: BTreeSet<String> =
            places.iter().filter(|place| moves(place)).map(|place| place.file.clone()).collect();
        for file in files {
            let text = self.texts.text(&file);
            let code = Code::new(&text);
            let functions = functions(&code.tokens);
            let lines = |of: &Function| code.number_at(of.head.start)..=code.number_at(of.body.bytes.end);
            for place in places.iter_mut().filter(|place| place.file == file) {
                if let Purpose::Constant { between } = place.purpose {
                    // Without a statement, nobody could find the place.
                    place.line = line_of_condition(&functions, &code, place.line, between).unwrap_or(0);
                    place.purpose = Purpose::Condition;
                } else if matches!(place.purpose, Purpose::Argument(_)) {
                    let around = functions.iter().map(lines).find(|lines| lines.contains(&place.line));
                    place.line = around.map_or(place.line, |lines| *lines.start());
                }
            }
        }
    }
}

/// An instrumented stage and its set.
pub struct TracedStage {
    /// The set.
    pub shaders: Arc<ShaderSet>,
    texts: Arc<StageTexts>,
    traced: Traced,
}

impl TracedStage {
    /// The path of the stage.
    pub(super) fn path(&self) -> &str {
        self.texts.stage.path.as_str()
    }

    /// The kind of the stage.
    pub(super) fn kind(&self) -> StageKind {
        self.texts.stage.kind
    }

    /// The log point with a number that the module has given, from 1.
    pub fn point(&self, number: u32) -> Option<&LogPoint> {
        self.traced.points.get((number as usize).checked_sub(1)?)
    }

    /// How many log points there are.
    pub(super) fn point_count(&self) -> usize {
        self.traced.points.len()
    }

    /// The places that log values, in the order of the module.
    pub(super) fn places(&self) -> impl Iterator<Item = &Place> {
        self.traced.places.iter().filter(|place| place.line > 0)
    }

    /// How often the log points of each file stand in the module, specialized with these constants, once all calls are inlined.
    pub(super) fn instances(&self, function: &str, constants: &[(u32, u32)]) -> BTreeMap<String, usize> {
        let stage = self.shaders.stages.get(self.texts.stage.path.as_str());
        let words = stage.map(|stage| specialize(&stage.spirv, constants)).unwrap_or_default();
        instances(&words, function, &self.traced.places, &self.traced.points)
    }

    /// The place of a log point.
    pub fn place(&self, point: &LogPoint) -> &Place {
        &self.traced.places[point.place]
    }

    /// A line of a file of the tree, as its author wrote it, without the space around it; empty if there is none.
    pub(super) fn line(&self, file: &str, line: u32) -> String {
        let text = self.texts.author_text(file);
        let at = (line as usize).checked_sub(1);
        at.and_then(|at| text.lines().nth(at)).unwrap_or_default().trim().to_owned()
    }

    /// The statement of a log point, by its number.
    pub fn site_of(&self, number: u32) -> Option<Site> {
        let place = self.place(self.point(number)?);
        let (stage, snapshot) = (&self.texts.stage, self.texts.snapshot());
        let texts = Texts { snapshot: &snapshot, stage: &stage.path, dependencies: &stage.dependencies };
        Some(statement::site(place, &self.texts.author_text(&place.file), texts))
    }
}

/// The text of a stage that listens. No line moves. If an included file has its `main`, a macro renames it.
fn listening(text: &str, appended: &str, extensions: &str) -> Result<String, &'static str> {
    let appended = match appended.contains("SPECULA_COLOR") {
        true => appended.replace("SPECULA_COLOR", &color_of(text).ok_or("has no `out vec4` color")?),
        false => appended.to_owned(),
    };
    let (renamed, head, end) = match main_of(&code(text)) {
        Some(main) => (format!("{}specula_main{}", &text[..main.start], &text[main.end..]), "", ""),
        None => (text.to_owned(), "\n#define main specula_main", "#undef main\n"),
    };
    let head = format!("{extensions}{head}");
    let version = renamed.find("#version").and_then(|at| Some(at + renamed[at..].find('\n')?));
    let renamed = match version.filter(|_| !head.is_empty()) {
        None => renamed,
        Some(version) => {
            let next = renamed[..=version].lines().count() + 1;
            format!("{}{head}\n#line {next}\n{}", &renamed[..=version], &renamed[version + 1..])
        }
    };
    Ok(format!("{renamed}\n{end}{appended}"))
}
