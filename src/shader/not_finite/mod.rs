//! Finds the statement that first makes NaN or infinity at a pixel.
//!
//! The stage that draws the pixel is compiled once more, with another text: every initializer, assignment and returned value passes
//! through a function that remembers the number of the first one that is not finite. The stage writes this number in place of the
//! color, so that one draw of one pixel finds the first statement in the order of execution, through functions and loops. Lines stay
//! where they are.
//!
//! The text of the stage is rewritten so that every initializer, assignment and returned value is the argument of a
//! function, `trace_finite(number, value)`, with an overload for each type and for each struct that is made in place.
//! The function keeps the first number whose value is not finite, and `main` writes that number as the color. So one
//! compilation and one draw of a pixel give the first statement in the order of execution. The types of names are
//! guessed from their declarations; where the compiler disagrees, the lines with errors are left out and the stage is
//! compiled again. The set of pipelines is that of the picture except for this stage (`PipelineSet::variant`), so light
//! and tables are the picture's.
//!
//! Limits: only the fragment stage of the mode is searched, not the stages before it, passes, bakes and path tracing.
//! Headers of loops, conditions, `++` and values of whole arrays are not traced, so the next statement is named there.
//! Infinity that a shader handles on purpose counts too.

mod report;
mod stage;
mod statement;
mod types;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::Serialize;

use super::compile::include::files_of;
use super::contract;
use super::expression::place::{Insertions, inserted};
use super::glsl::syntax::{Function, Statement, StatementKind, functions, within};
use super::glsl::{Code, Token, code, spelled};
use super::library::Stage;
use super::source::TreePath;
use super::source::snapshot::{Read, Snapshot};
use super::{Compiler, PixelValue, ShaderSet, Source, StageKind};
pub use report::{ELSEWHERE, NotFinite};
use stage::FUNCTION;
use statement::{Traced, TracedValue, of_return, of_simple};
use types::{Types, structs};

/// A place that makes a value which is traced.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Site {
    /// The file as its author knows it.
    pub file: String,
    /// From 1.
    pub line: u32,
    /// From 1, in bytes.
    pub column: u32,
    /// The statement on one line, or the declaration of what the stage before has written.
    pub code: String,
}

/// The first statements at a pixel whose values are not finite.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FirstNotFinite {
    /// The first statement with NaN or infinity.
    #[serde(flatten)]
    pub first: Site,
    /// `NaN` or `Inf`: what it made.
    pub value: &'static str,
    /// The first statement with NaN, if the first of all made infinity.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nan: Option<Site>,
}

/// Compilations of a stage, each without the statements that the one before could not compile.
const ATTEMPTS: usize = 6;

/// A stage that traces its values, in a set of shaders that is otherwise the same.
pub struct TracedShaders {
    /// The set.
    pub shaders: Arc<ShaderSet>,
    sites: Vec<Site>,
}

impl TracedShaders {
    /// Compiles the fragment stage `stage` of `shaders` with a text that traces its values. `source` gives files their names. This takes
    /// about twice as long as the stage itself.
    ///
    /// # Errors
    /// A message why the stage cannot be traced.
    pub fn new(shaders: &ShaderSet, stage: &str, compiler: &Compiler, source: &Source) -> Result<Self, String> {
        let path = TreePath::from(stage);
        let before = shaders.stages.get(stage).filter(|before| before.kind == StageKind::Fragment);
        let before = before.ok_or_else(|| format!("{stage} is no fragment stage that has compiled"))?;
        let texts = shaders.texts.iter().map(|(path, text)| (path.clone(), Ok(text.clone()))).collect();
        let snapshot = Snapshot::holding(source, texts);
        let mut without: BTreeSet<(String, u32)> = BTreeSet::new();
        let mut failure = String::new();
        for _ in 0..ATTEMPTS {
            let mut instrumented = Instrumented::new(&snapshot, &path, &without)?;
            let sites = std::mem::take(&mut instrumented.sites);
            let over: BTreeMap<TreePath, Read> =
                instrumented.texts.into_iter().map(|(path, text)| (path, Ok(text.into()))).collect();
            let snapshot = snapshot.over(over);
            match Stage::compile(compiler, &snapshot, &path, &before.dependencies) {
                Ok(traced) => {
                    let mut shaders = shaders.clone();
                    shaders.stages.insert(stage.to_owned(), Arc::new(traced));
                    return Ok(Self { shaders: Arc::new(shaders), sites });
                }
                Err(errors) => {
                    let places: Vec<_> =
                        errors.iter().filter_map(|error| Some((error.file.clone(), error.line?))).collect();
                    failure = errors.first().map(|error| error.one_line()).unwrap_or_default();
                    let known = without.len();
                    without.extend(places);
                    if without.len() == known {
                        break;
                    }
                }
            }
        }
        Err(format!("the values of {stage} cannot be traced: {failure}"))
    }

    /// Decodes a pixel that these shaders have drawn. `None` if every value was finite.
    pub fn found(&self, pixel: &PixelValue) -> Option<FirstNotFinite> {
        let [first, nan, mark, _] = pixel.value;
        let site = |number: f32| self.sites.get((number as usize).checked_sub(1)?).cloned();
        let first_site = site(first).filter(|_| mark == stage::MARK)?;
        let value = if first == nan { "NaN" } else { "Inf" };
        Some(FirstNotFinite { first: first_site, value, nan: site(nan).filter(|_| first != nan) })
    }
}

/// The texts of a stage that traces its values.
struct Instrumented {
    texts: BTreeMap<TreePath, String>,
    sites: Vec<Site>,
}

impl Instrumented {
    fn new(snapshot: &Snapshot<'_>, host: &TreePath, without: &BTreeSet<(String, u32)>) -> Result<Self, String> {
        let closure = files_of(snapshot, host);
        // The functions that trace follow this file, since extensions must stand before any code.
        let before = files_of(snapshot, &TreePath::from(contract::INTERFACE_FILE));
        let read = |path: &TreePath| snapshot.read(path).ok().map(|text| (path.clone(), text));
        let texts: Vec<(TreePath, Arc<str>)> = closure.iter().filter_map(read).collect();
        let mut types = Types::default();
        for (path, text) in &texts {
            types.learn(&structs(&code(text)), !before.contains(path));
        }
        for (_, text) in &texts {
            let tokens = code(text);
            let bodies = functions(&tokens);
            let is_outside = |token: &Token<'_>| {
                !bodies.iter().any(|of| (of.head.start..of.body.bytes.end).contains(&token.bytes.start))
            };
            let outside: Vec<Token<'_>> = tokens.iter().filter(|token| is_outside(token)).cloned().collect();
            let globals: Vec<String> = types.opaque(&outside).collect();
            types.globals.extend(globals);
        }
        let mut this = Self { texts: BTreeMap::new(), sites: Vec::new() };
        for (path, text) in texts.iter().filter(|(path, _)| !before.contains(path)) {
            let file = snapshot.display_path(path);
            let code = Code::new(text);
            let mut writer = Writer {
                text,
                code: &code,
                tokens: &code.tokens,
                types: &types,
                file,
                without,
                insertions: Vec::new(),
                sites: &mut this.sites,
            };
            writer.structs();
            let functions = functions(&code.tokens);
            functions.iter().for_each(|function| writer.function(function));
            if path == host {
                writer.inputs(&functions);
            }
            let insertions = writer.insertions;
            this.texts.insert(path.clone(), inserted(text, &insertions));
        }
        let host_text = this.texts.get(host).ok_or_else(|| format!("{host} cannot be read"))?;
        let (text, library) = stage::texts(host_text, host, snapshot)?;
        this.texts.insert(host.clone(), text);
        this.texts.insert(TreePath::from(stage::LIBRARY), library);
        Ok(this)
    }
}

/// Inserts the calls into one file.
struct Writer<'a, 'b> {
    text: &'a str,
    code: &'a Code<'a>,
    tokens: &'a [Token<'a>],
    types: &'a Types,
    file: String,
    /// Lines that are left as they are.
    without: &'b BTreeSet<(String, u32)>,
    insertions: Insertions,
    sites: &'b mut Vec<Site>,
}

impl Writer<'_, '_> {
    /// Inserts a function after each struct that traces its members.
    fn structs(&mut self) {
        let functions = structs(self.tokens).into_iter().map(|of| (of.end, self.types.tracer(&of, FUNCTION)));
        self.insertions.extend(functions);
    }

    fn function(&mut self, function: &Function) {
        let whole = function.head.start..function.body.bytes.end;
        let opaque: BTreeSet<String> = self.types.opaque(within(self.tokens, &whole)).collect();
        let head = within(self.tokens, &function.head);
        let name = head.iter().position(|token| token.text == "(").and_then(|open| open.checked_sub(2));
        let kind = name.and_then(|at| head.get(at)).map_or("", |token| token.text);
        self.statement(&function.body, kind, &opaque);
    }

    fn statement(&mut self, statement: &Statement, kind: &str, opaque: &BTreeSet<String>) {
        let tokens = within(self.tokens, &statement.bytes);
        let found = match statement.kind {
            StatementKind::Simple => of_simple(tokens, statement.is_in_block, self.types, opaque),
            StatementKind::Jump => of_return(tokens, kind, self.types),
            _ => Vec::new(),
        };
        for TracedValue { traced, shown } in found {
            let start = match &traced {
                Traced::Value(bytes) => bytes.start,
                Traced::After(_) => shown.start,
            };
            let Some(number) = self.site(start, &shown) else { continue };
            match traced {
                Traced::Value(bytes) => {
                    self.insertions.push((bytes.start, format!("{FUNCTION}({number}u, ")));
                    self.insertions.push((bytes.end, ")".to_owned()));
                }
                Traced::After(name) => self.insertions.push((shown.end, format!(" {FUNCTION}({number}u, {name});"))),
            }
        }
        statement.parts.iter().for_each(|part| self.statement(part, kind, opaque));
    }

    /// Traces what the stage before has written, at the start of `main`.
    fn inputs(&mut self, functions: &[Function]) {
        let main = functions.iter().find(|of| within(self.tokens, &of.head).iter().any(|token| token.text == "main"));
        let Some(start) = main.map(|main| main.body.bytes.start + 1) else { return };
        let is_outside = |at: usize| !functions.iter().any(|of| (of.head.start..of.body.bytes.end).contains(&at));
        let is_value = |kind: &str| types::FLOATS.contains(&kind) || self.types.structs.contains(kind);
        let inputs: Vec<(usize, &str)> = (self.tokens.windows(4))
            .filter(|four| four[0].text == "in" && is_value(four[1].text) && four[3].text == ";")
            .filter(|four| is_outside(four[0].bytes.start))
            .map(|four| (four[0].bytes.start, four[2].text))
            .collect();
        for (at, name) in inputs {
            let end = self.text[at..].find(';').map_or(self.text.len(), |end| at + end + 1);
            let Some(number) = self.site(at, &(at..end)) else { continue };
            self.insertions.push((start, format!(" {FUNCTION}({number}u, {name});")));
        }
    }

    /// The number of a new site, from 1; `None` for a line that is left as it is.
    fn site(&mut self, at: usize, shown: &std::ops::Range<usize>) -> Option<usize> {
        let line = self.code.number_at(at);
        let last = self.code.number_at(shown.end);
        let is_left = |line: u32| self.without.contains(&(self.file.clone(), line));
        if (line..=last).any(is_left) {
            return None;
        }
        let start = self.code.start(line);
        let code = spelled(within(self.tokens, shown));
        let column = u32::try_from(at - start + 1).unwrap_or(1);
        self.sites.push(Site { file: self.file.clone(), line, column, code });
        Some(self.sites.len())
    }
}

#[cfg(test)]
mod tests;
