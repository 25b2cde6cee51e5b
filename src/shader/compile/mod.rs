//! Compiles a stage to SPIR-V with shaderc.

pub mod asserts;
mod balance;
mod hooks;
pub mod include;
pub mod log;
pub mod module_cache;
pub mod names;
mod own;
mod places;
mod types;
mod unbound;
mod uniform;

use std::collections::BTreeSet;

use serde::Serialize;
use shaderc::{CompileOptions, EnvVersion, OptimizationLevel, ResolvedInclude, ShaderKind, SpirvVersion, TargetEnv};

use crate::interface::{SET_PASS, VERTEX_BINDINGS};
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::{Line, is_same_code, lines, tokens};
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::bindings::assign_set;
use include::Includes;

/// The message about a file without code.
pub const EMPTY: &str = "the file is empty";

/// Kind of a stage, given by the file's extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum StageKind {
    /// `.vert`
    Vertex,
    /// `.tesc`
    TessellationControl,
    /// `.tese`
    TessellationEvaluation,
    /// `.geom`
    Geometry,
    /// `.task`
    Task,
    /// `.mesh`
    Mesh,
    /// `.frag`
    Fragment,
    /// `.comp`
    Compute,
}

impl StageKind {
    /// All kinds, each with the extension of its files, its name in messages, and the compiler's word for it.
    const ALL: [(Self, &'static str, &'static str, ShaderKind); 8] = [
        (Self::Vertex, "vert", "vertex", ShaderKind::Vertex),
        (Self::TessellationControl, "tesc", "tessellation control", ShaderKind::TessControl),
        (Self::TessellationEvaluation, "tese", "tessellation evaluation", ShaderKind::TessEvaluation),
        (Self::Geometry, "geom", "geometry", ShaderKind::Geometry),
        (Self::Task, "task", "task", ShaderKind::Task),
        (Self::Mesh, "mesh", "mesh", ShaderKind::Mesh),
        (Self::Fragment, "frag", "fragment", ShaderKind::Fragment),
        (Self::Compute, "comp", "compute", ShaderKind::Compute),
    ];

    /// The kind of a file, by its extension.
    pub fn of(path: &TreePath) -> Option<Self> {
        let extension = path.extension()?;
        Self::ALL.iter().find(|(_, known, ..)| *known == extension).map(|(kind, ..)| *kind)
    }

    /// The stages before the rasterizer, in the order in which they run. A pipeline has some of the first four, or some of the last
    /// two.
    pub const PRE_RASTERIZATION: [Self; 6] =
        [Self::Vertex, Self::TessellationControl, Self::TessellationEvaluation, Self::Geometry, Self::Task, Self::Mesh];

    /// The name in messages.
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].2
    }

    /// The extension of its files.
    pub fn extension(self) -> &'static str {
        Self::ALL[self as usize].1
    }

    /// Whether its output goes to the rasterizer or to another stage before it.
    pub fn is_pre_rasterization(self) -> bool {
        Self::PRE_RASTERIZATION.contains(&self)
    }

    /// Whether it is one of VK_EXT_mesh_shader.
    pub fn is_of_mesh_pipeline(self) -> bool {
        matches!(self, Self::Task | Self::Mesh)
    }

    /// The first binding of what the stage reads by name, so that the stages of a pipeline share a set.
    fn first_binding(self) -> u32 {
        (1..).zip(Self::PRE_RASTERIZATION).find(|(_, kind)| *kind == self).map_or(0, |(at, _)| at * VERTEX_BINDINGS)
    }

    fn shaderc(self) -> ShaderKind {
        Self::ALL[self as usize].3
    }
}

/// The result of compiling a file.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The unoptimized module with names, or the errors in the order of the log.
    pub result: Result<Vec<u32>, Vec<Diagnostic>>,
    /// Warnings, whether or not the file compiled.
    pub warnings: Vec<Diagnostic>,
    /// All paths that the result depends on, including paths where no include was found.
    pub dependencies: BTreeSet<TreePath>,
}

/// A shaderc compiler. Threads can share it.
pub struct Compiler {
    shaderc: shaderc::Compiler,
}

impl std::fmt::Debug for Compiler {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Compiler").finish_non_exhaustive()
    }
}

impl Compiler {
    /// # Errors
    /// shaderc's message if it cannot be set up (out of memory).
    pub fn new() -> Result<Self, String> {
        Ok(Self { shaderc: shaderc::Compiler::new().map_err(|error| error.to_string())? })
    }

    /// Compiles trivial stages, so that no edit waits for glslang to parse its built-in declarations. It does that at the first
    /// use of each stage kind, in 100 to 200 ms.
    pub fn warm(&self) {
        let trivial = "#version 460\nvoid main() {}\n";
        for kind in [StageKind::Fragment, StageKind::Vertex] {
            if let Ok(options) = options(kind) {
                let _ = self.shaderc.compile_into_spirv(trivial, kind.shaderc(), "warm", "main", Some(&options));
            }
        }
    }

    /// Compiles a text of the program's own, which includes nothing. `name` is for messages.
    ///
    /// # Errors
    /// The compiler's log.
    pub fn compile_alone(&self, name: &str, text: &str, kind: StageKind) -> Result<Vec<u32>, String> {
        let options = options(kind).map_err(|error| error.to_string())?;
        let compiled = self.shaderc.compile_into_spirv(text, kind.shaderc(), name, "main", Some(&options));
        compiled.map(|compiled| compiled.as_binary().to_vec()).map_err(|error| error.to_string())
    }

    /// Compiles a file with a `main()`. Its extension gives the kind of stage.
    pub fn compile(&self, snapshot: &Snapshot<'_>, stage: &TreePath) -> Compiled {
        let file = || snapshot.display_path(stage);
        let dependencies = BTreeSet::from([stage.clone()]);
        let failed = |diagnostic| Compiled { result: Err(vec![diagnostic]), warnings: Vec::new(), dependencies };
        let Some(kind) = StageKind::of(stage) else {
            let message =
                "not a shader stage: the extension must be .vert, .tesc, .tese, .geom, .task, .mesh, .frag or .comp";
            return failed(Diagnostic::error(file(), message));
        };
        match snapshot.read(stage) {
            Ok(text) if is_same_code(&text, "") => failed(
                Diagnostic::error(file(), EMPTY)
                    .on_line(1, None)
                    .with_help("a stage begins with `#version 460` and has a `void main()`"),
            ),
            Ok(text) => match unknown_version(&file(), &text, kind) {
                Some(error) => failed(error),
                None => self.compile_text(snapshot, stage, &text, kind),
            },
            Err(error) => failed(include::unreadable(snapshot, stage, &error)),
        }
    }

    /// Compiles a file as [`Compiler::compile`] does, with the lines of its instructions (`OpLine`). The instructions are the
    /// same. `None` if it does not compile.
    pub fn compile_with_lines(&self, snapshot: &Snapshot<'_>, stage: &TreePath) -> Option<Vec<u32>> {
        self.run_file(snapshot, stage, true).map(|(spirv, _)| spirv)
    }

    /// The module of a file; `None` if there is an error or a warning.
    pub fn compile_silently(&self, snapshot: &Snapshot<'_>, stage: &TreePath) -> Option<Vec<u32>> {
        let (spirv, warnings) = self.run_file(snapshot, stage, false)?;
        warnings.is_empty().then_some(spirv)
    }

    fn run_file(&self, snapshot: &Snapshot<'_>, stage: &TreePath, with_lines: bool) -> Option<(Vec<u32>, String)> {
        let text = snapshot.read(stage).ok()?;
        let includes = Includes::new(snapshot, stage.clone());
        let kind = StageKind::of(stage)?;
        let mut options = options(kind).ok()?;
        if with_lines {
            options.set_generate_debug_info();
        }
        self.run(options, &includes, stage, &text, kind).ok()
    }

    /// Compiles a library as if a stage of this kind included nothing else, so the library must include what it uses.
    pub fn compile_library(&self, snapshot: &Snapshot<'_>, library: &TreePath, kind: StageKind) -> Compiled {
        // The wrapper has no text of the user. `rename` below keeps its name out of messages.
        let wrapper = TreePath::from("(library)");
        // A library may be for passes, which declare uniforms by name.
        let layouts: String = library_layouts(snapshot, library, kind).collect();
        let head = "#version 460 //@pass\n#define LIBRARY_ALONE\n";
        let text = format!("{head}#include \"{library}\"\n{layouts}void main() {{}}\n");
        let mut compiled = self.compile_text(snapshot, &wrapper, &text, kind);
        compiled.dependencies.remove(&wrapper);
        // An error of the whole library is reported under the library's name.
        let file = snapshot.display_path(&wrapper);
        let rename = |diagnostic: &mut Diagnostic| {
            if diagnostic.file == file {
                diagnostic.file = snapshot.display_path(library);
                diagnostic.line = None;
            }
        };
        compiled.warnings.iter_mut().for_each(rename);
        if let Err(errors) = &mut compiled.result {
            errors.iter_mut().for_each(rename);
        }
        compiled
    }

    fn compile_text(&self, snapshot: &Snapshot<'_>, path: &TreePath, text: &str, kind: StageKind) -> Compiled {
        let includes = Includes::new(snapshot, path.clone());
        let outcome = options(kind).and_then(|options| self.run(options, &includes, path, text, kind));
        let unreadable = includes.take_unreadable();
        let dependencies = includes.into_dependencies();
        let (result, text) = match outcome {
            Ok((spirv, warnings)) => (Ok(spirv), warnings),
            Err(text) => (Err(()), text),
        };
        let (mut errors, warnings) = log::parse(&text, path, snapshot, &dependencies);
        // A stray `#else` can hide the rest of the file that includes it, and still compile.
        let causes = match unreadable.is_empty() {
            true => unbalanced(snapshot, &dependencies, result.is_ok()),
            false => unreadable,
        };
        let result = if causes.is_empty() { result } else { Err(()) };
        // An include that is missing explains all other errors.
        if errors.iter().any(log::is_missing_include) {
            errors.retain(log::is_missing_include);
        }
        if !causes.is_empty() {
            errors = causes;
        } else if errors.is_empty() {
            errors.push(Diagnostic::error(snapshot.display_path(path), text.trim()));
        }
        Compiled { result: result.map_err(|()| errors), warnings, dependencies }
    }

    /// Returns the module and the log of warnings, or the log of errors. File names in the log are tree paths.
    fn run<'a>(
        &self,
        options: CompileOptions<'a>,
        includes: &'a Includes<'_>,
        path: &TreePath,
        text: &str,
        kind: StageKind,
    ) -> Result<(Vec<u32>, String), String> {
        let mut again = options.clone();
        let mut log = match self.run_once(options, includes, path, text, kind) {
            Err(log) => log,
            good => return good,
        };
        let asserting = asserts::with_functions(text, &log);
        let text = asserting.as_deref().unwrap_or(text);
        if asserting.is_some() {
            log = match self.run_once(again.clone(), includes, path, text, kind) {
                Err(log) => log,
                good => return good,
            };
        }
        let names = own::refused(&log, includes.snapshot());
        if names.is_empty() {
            return Err(log);
        }
        names.iter().for_each(|name| again.add_macro_definition(name, Some(&own::renamed(name))));
        let result = self.run_once(again, includes, path, text, kind);
        let (mut words, warnings) = result.map_err(|log| own::named_again(&log, &names))?;
        own::restore(&mut words, &names);
        Ok((words, own::named_again(&warnings, &names)))
    }

    fn run_once<'a>(
        &self,
        mut options: CompileOptions<'a>,
        includes: &'a Includes<'_>,
        path: &TreePath,
        text: &str,
        kind: StageKind,
    ) -> Result<(Vec<u32>, String), String> {
        let text = includes.begin(text);
        options.set_include_callback(|name, _type, _including, depth| {
            let (path, content) = includes.resolve(name, depth)?;
            Ok(ResolvedInclude { resolved_name: path.to_string(), content })
        });
        match self.shaderc.compile_into_spirv(&text, kind.shaderc(), path.as_str(), "main", Some(&options)) {
            Ok(artifact) => {
                let mut words = artifact.as_binary().to_vec();
                assign_set(&mut words, SET_PASS, kind.first_binding(), &includes.unbound());
                Ok((words, artifact.get_warning_messages()))
            }
            Err(shaderc::Error::CompilationError(_, log)) => Err(log),
            Err(error) => Err(error.to_string()),
        }
    }
}

/// An error about a task or mesh stage in a version of GLSL that has no such stages. glslang would print its built-in declarations
/// to the standard output.
fn unknown_version(file: &str, text: &str, kind: StageKind) -> Option<Diagnostic> {
    if !kind.is_of_mesh_pipeline() {
        return None;
    }
    let lines = lines(text);
    let first = lines.iter().find(|line| !line.is_blank());
    let tokens = first.map(Line::tokens).unwrap_or_default();
    let words: Vec<&str> = tokens.iter().map(|token| token.text).collect();
    let is_known =
        matches!(words.as_slice(), ["#", "version", "450" | "460"] | ["#", "version", "450" | "460", "core"]);
    let error = || {
        let error = Diagnostic::error(file, format!("a {} stage begins with `#version 460`", kind.name()));
        first.map_or(error.clone(), |line| error.on_line(line.number, Some(line.raw)))
    };
    (!is_known).then(error)
}

/// Returns the declarations that a stage of this kind needs: the layouts of its primitives, and the extension of its kind. Leaves out
/// the layouts that a library declares itself.
fn library_layouts(snapshot: &Snapshot<'_>, library: &TreePath, kind: StageKind) -> impl Iterator<Item = String> {
    let needed: &[(&str, &str)] = match kind {
        StageKind::TessellationControl => &[("vertices = 3", "out")],
        StageKind::TessellationEvaluation => &[("triangles", "in")],
        StageKind::Geometry => &[("triangles", "in"), ("points, max_vertices = 1", "out")],
        StageKind::Mesh => &[("triangles, max_vertices = 3, max_primitives = 1", "out")],
        StageKind::Vertex | StageKind::Task | StageKind::Fragment | StageKind::Compute => &[],
    };
    let texts = include::files_of(snapshot, library).into_iter().filter_map(|path| snapshot.read(&path).ok());
    let texts: Vec<_> = texts.filter(|_| !needed.is_empty()).collect();
    let declares = move |direction: &str| {
        let is_layout = |code: &str| code.starts_with("layout") && code.ends_with(&format!(") {direction};"));
        texts.iter().any(|text| lines(text).iter().any(|line| is_layout(line.code.trim())))
    };
    let missing = needed.iter().filter(move |(_, direction)| !declares(direction));
    let layouts = missing.map(|(layout, direction)| format!("layout({layout}) {direction};\n"));
    let extension = "#extension GL_EXT_mesh_shader : require\n".to_owned();
    kind.is_of_mesh_pipeline().then_some(extension).into_iter().chain(layouts)
}

/// Reports the first unbalanced conditional of each file. It may be the cause of all other errors of the stage. A stage that
/// compiled gets a `quick` look.
fn unbalanced(snapshot: &Snapshot<'_>, files: &BTreeSet<TreePath>, quick: bool) -> Vec<Diagnostic> {
    let check = |path: &TreePath| {
        let text = snapshot.read(path).ok().filter(|text| !quick || !balance::looks_balanced(text))?;
        balance::unbalanced(&snapshot.display_path(path), &text)
    };
    files.iter().filter_map(check).collect()
}

/// Whether the text of a stage declares a pass.
pub fn declares_pass(text: &str) -> bool {
    text.contains("//@pass") && tokens(text).any(|token| token.text.starts_with("//@pass"))
}

/// The macro that compute shaders are compiled with, so that a file that they share with other stages can tell.
const COMPUTE_STAGE: &str = "COMPUTE_STAGE";

/// Compile options for a stage: unoptimized, which is five times faster and keeps the names that reflection needs. What a text
/// declares by name alone gets a binding, which [`assign_set`] replaces.
fn options<'a>(kind: StageKind) -> Result<CompileOptions<'a>, String> {
    let mut options = CompileOptions::new().map_err(|error| error.to_string())?;
    options.set_target_env(TargetEnv::Vulkan, EnvVersion::Vulkan1_3 as u32);
    options.set_target_spirv(SpirvVersion::V1_5);
    options.set_optimization_level(OptimizationLevel::Zero);
    if kind == StageKind::Compute {
        options.add_macro_definition(COMPUTE_STAGE, None);
    }
    options.set_auto_bind_uniforms(true);
    Ok(options)
}
