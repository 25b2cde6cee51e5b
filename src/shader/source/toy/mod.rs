//! A single shader file of another playground as a tree: Shadertoy's `mainImage`, or glslViewer's `main` with `u_time`.
//!
//! The file, the buffers beside it and what they include appear below `opened/`. Each of them that draws an image has a stage
//! in `passes/`, which is written here and includes it. Everything else is the tree in the binary.
//!
//! Lines that Vulkan does not compile are changed, each in its place. Lines that GLSL does not have (`#iChannel0
//! "file"`) are checked before anything compiles (`problems.rs`), and every other diagnostic gets the author's line,
//! names and words (`Source::explained`). The stage in `passes/` maps `iChannel0` to a name that the graph knows.
//! `shaders/toy.glsl` includes nothing, so that an author may use any name, and gets time and size from the block
//! `Pass`. A file that reads the keyboard adds the pass `toy_keyboard`, which draws the keys of the block `Frame` to an
//! image. A displayed picture that does not read the previous one covers it: neither the model nor the passes below it
//! are drawn (`GraphPass::covers`).

mod adapt;
mod beside;
mod channel;
mod declared;
mod drawing;
mod explain;
mod files;
mod initial;
mod noise;
mod own;
mod plain;
mod problems;

use std::path::{Component, Path, PathBuf};

use super::error::{MAX_FILE_BYTES, MAX_IMAGE_BYTES};
use super::read::{check_text, names_in, read_anywhere, read_bytes, read_file};
use super::{SourceError, TreePath, embedded};
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::code;
use adapt::{COMMON, adapted, has_key_functions, is_shadertoy, uses, version};
use channel::{Channel, channels};
use declared::{add_standard, assignments, globals, outputs, sliders, variables_of};
use drawing::{BLACK, BUFFERS, Drawing, KEYBOARD, NOISE, declarations, keeps_image, parts, without_image};
use own::OwnNames;
use plain::{plain, with_plain_names};

/// The folder of the opened files in the tree.
pub(super) const OPENED: &str = "opened";
/// The folder of the stages.
const STAGES: &str = "passes";
/// The pass of the opened file itself.
const IMAGE: &str = "image";
/// The library with the sliders for uniforms.
const SLIDERS: &str = "toy/sliders.glsl";
/// The pass that shows the image of a file that reads its own image of the previous frame.
const SHOWN: &str = "toy_shown";

/// An opened file.
#[derive(Clone, Debug)]
pub struct Toy {
    /// Absolute.
    file: PathBuf,
}

impl Toy {
    /// Opens a file, whether it exists or not.
    pub fn new(file: PathBuf) -> Self {
        Self { file }
    }

    /// Whether `path` can be opened: a shader outside of Specula trees.
    pub fn is_toy(path: &Path) -> bool {
        let is_shader = path.extension().and_then(|extension| extension.to_str());
        let in_tree = || path.ancestors().skip(1).any(super::is_specula_tree);
        is_shader.is_some_and(|extension| ["glsl", "frag", "fs"].contains(&extension)) && !in_tree()
    }

    /// The file.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// Its path in the tree.
    pub fn opened(&self) -> TreePath {
        opened_path(&self.name())
    }

    /// The folder of the file.
    pub fn folder(&self) -> &Path {
        self.file.parent().unwrap_or(Path::new("."))
    }

    /// The text of a file beside the toy, as [`plain`] leaves it.
    fn text(&self, file: &str) -> Result<String, SourceError> {
        self.own_text(file).map(|text| plain(&text))
    }

    /// The text of a file beside the toy. The toy itself, which the user has named, may be a link to anywhere.
    fn own_text(&self, file: &str) -> Result<String, SourceError> {
        if file == self.name() {
            return check_text(read_anywhere(&self.file, MAX_FILE_BYTES)?);
        }
        read_file(self.folder(), file)
    }

    /// The text of a file of the tree.
    pub fn read(&self, path: &TreePath) -> Result<String, SourceError> {
        if let Some(relative) = below(path.as_str(), OPENED) {
            let text = self.text(relative)?;
            let pass = self.drawings().into_iter().find(|drawing| drawing.file == relative).map(|drawing| drawing.pass);
            return Ok(adapted(&text, pass.as_deref().unwrap_or(COMMON)));
        }
        if path.as_str() == SLIDERS {
            return Ok(self.sliders(&self.drawings()));
        }
        if below(path.as_str(), STAGES).is_some() {
            let drawings = self.drawings();
            if let Some(index) = drawings.iter().position(|drawing| stage_path(&drawing.pass) == *path) {
                return Ok(self.stage(&drawings, index));
            }
            if *path == stage_path(KEYBOARD) && self.reads_keyboard(&drawings) {
                let annotation = format!("//@pass {KEYBOARD} \"Keyboard\" size=256x3 format=rgba8");
                return Ok(format!("{annotation}\n#version 460\n#include \"toy/keyboard.glsl\"\n"));
            }
            if *path == stage_path(SHOWN) && keeps_image(&drawings) {
                let annotation = format!("//@pass {SHOWN} \"{}\" to=picture after=tonemap", self.name());
                return Ok(format!("{annotation}\n#version 460\n#include \"toy/shown.glsl\"\n"));
            }
        }
        let bytes = embedded::read(None, path).ok_or(SourceError::Missing)?;
        check_text(bytes.to_vec())
    }

    /// The path of a file of the tree below [`Self::folder`], if it is one of those on disk.
    pub fn path_of_file(&self, path: &TreePath) -> Option<TreePath> {
        TreePath::parse(below(path.as_str(), OPENED)?)
    }

    /// The text of a file on disk, before lines that Vulkan does not compile are changed.
    pub fn author_text(&self, path: &TreePath) -> Option<String> {
        self.own_text(below(path.as_str(), OPENED)?).ok()
    }

    /// The bytes of an image.
    pub fn read_bytes(&self, path: &TreePath) -> Result<Vec<u8>, SourceError> {
        match below(path.as_str(), OPENED) {
            _ if path.as_str() == NOISE => noise::png().map_err(SourceError::Io),
            _ if path.as_str() == BLACK => noise::black().map_err(SourceError::Io),
            Some(relative) => read_bytes(self.folder(), relative, MAX_IMAGE_BYTES),
            None => Ok(embedded::read(None, path).ok_or(SourceError::Missing)?.to_vec()),
        }
    }

    /// The names of the files in a folder of the tree, without hidden files.
    pub fn names_in(&self, folder: &str) -> Vec<String> {
        match folder == OPENED {
            true => names_in(self.folder()),
            false => below(folder, OPENED).map(|relative| names_in(&self.folder().join(relative))).unwrap_or_default(),
        }
    }

    /// The files of the tree that a stage can be, or a library in the binary, sorted.
    pub fn list(&self) -> Vec<TreePath> {
        let drawings = self.drawings();
        let keyboard = self.reads_keyboard(&drawings).then(|| stage_path(KEYBOARD));
        let shown = keeps_image(&drawings).then(|| stage_path(SHOWN));
        let stages = drawings.iter().map(|drawing| stage_path(&drawing.pass)).chain(keyboard).chain(shown);
        let mut out: Vec<TreePath> = embedded::list(None).into_iter().chain(stages).collect();
        out.sort();
        out.dedup();
        out
    }

    /// The path for messages: that of the file on disk, if it exists.
    pub fn display_path(&self, path: &TreePath) -> String {
        match below(path.as_str(), OPENED) {
            Some(relative) => self.folder().join(relative).display().to_string(),
            None => format!("embedded:{path}"),
        }
    }

    /// The errors in lines of the opened files that GLSL does not have, and errors of files without an entry point.
    pub fn problems(&self) -> Vec<Diagnostic> {
        let mut out = Vec::new();
        for Drawing { file, text, .. } in self.drawings() {
            let path = self.folder().join(&file);
            let shown = path.display().to_string();
            match self.text(&file) {
                Ok(_) if !uses(&text, "mainImage") && !uses(&text, "main") => {
                    let first = text.lines().next().unwrap_or_default();
                    out.push(problems::without_entry(&shown, &text).on_line(1, Some(first)).under(0..first.len()));
                }
                // The line that names a file reports that it is missing.
                Err(SourceError::Missing) if file != self.name() => {}
                Ok(_) => {}
                Err(error) => {
                    let line = error.line();
                    let error = Diagnostic::error(shown.clone(), format!("{shown} {error}"));
                    out.push(line.map_or(error.clone(), |line| error.on_line(line, None)));
                }
            }
            out.extend(problems::problems(&shown, &text, self.folder()));
        }
        if let Some((file, text)) = self.common() {
            out.extend(problems::problems(&self.folder().join(file).display().to_string(), &text, self.folder()));
        }
        out
    }

    /// Warnings about samplers whose image no file names.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        let drawings = self.drawings();
        let unknown = without_image(&drawings);
        let warning = |(place, [_, name]): &(usize, [String; 2])| {
            let Drawing { file, text, .. } = &drawings[*place];
            let shown = self.folder().join(file).display().to_string();
            problems::black(&shown, self.own_text(file).as_ref().unwrap_or(text), &with_plain_names(name))
        };
        unknown.iter().map(warning).collect()
    }

    /// The paths of the tree that depend on `file` on disk. Stages depend on the files beside them, too.
    pub fn changed(&self, file: &Path) -> Vec<TreePath> {
        let Some(relative) = file.strip_prefix(self.folder()).ok().and_then(slashes) else { return Vec::new() };
        let stages = self.drawings().into_iter().map(|drawing| drawing.pass).chain(BUFFERS.map(str::to_owned));
        let stages = stages.chain([KEYBOARD.to_owned(), SHOWN.to_owned()]);
        [opened_path(&relative), TreePath::from(SLIDERS)]
            .into_iter()
            .chain(stages.map(|pass| stage_path(&pass)))
            .collect()
    }

    fn name(&self) -> String {
        self.file.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    fn stem(&self) -> String {
        self.file.file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// The files that draw images, in drawing order: Shadertoy's buffers, others after what they read, and the file itself last.
    fn drawings(&self) -> Vec<Drawing> {
        let mut out = Vec::new();
        for buffer in BUFFERS {
            if let Some((file, text)) = self.beside(buffer) {
                out.push(Drawing { pass: buffer.to_owned(), file, text, part: None });
            }
        }
        self.add(&self.name(), IMAGE, &mut Vec::new(), &mut out);
        out
    }

    /// Adds the file and, before it, the files that its channels name. `above`: the files that are being added.
    fn add(&self, file: &str, pass: &str, above: &mut Vec<String>, out: &mut Vec<Drawing>) {
        if above.iter().any(|other| other == file) || out.iter().any(|drawing| drawing.file == file) {
            return;
        }
        let text = self.text(file).unwrap_or_default();
        above.push(file.to_owned());
        for (_, channel) in channels(&text) {
            if let Channel::Drawing(other) = channel {
                self.add(&other, &buffer_name(&other), above, out);
            }
        }
        above.pop();
        out.extend(parts(file, &text).into_iter().filter(|_| pass == IMAGE));
        out.push(Drawing { pass: pass.to_owned(), file: file.to_owned(), text, part: None });
    }

    /// Whether a file reads the state of the keys.
    fn reads_keyboard(&self, drawings: &[Drawing]) -> bool {
        let common = self.common().map(|(_, text)| text);
        drawings.iter().map(|drawing| &drawing.text).chain(&common).any(|text| adapt::reads_keyboard(text))
    }

    /// The block with the sliders of all files. Those that have one share it.
    fn sliders(&self, drawings: &[Drawing]) -> String {
        let common = self.common();
        let own = drawings.iter().map(|drawing| (drawing.file.as_str(), drawing.text.as_str()));
        let common = common.iter().map(|(file, text)| (file.as_str(), text.as_str()));
        sliders(&variables_of(&self.texts(common.chain(own))))
    }

    /// The text of a stage.
    fn stage(&self, drawings: &[Drawing], index: usize) -> String {
        let Drawing { pass, file, text, part } = &drawings[index];
        let is_picture = index + 1 == drawings.len() && !keeps_image(drawings);
        let goes = if is_picture { "to=picture after=tonemap" } else { "keep format=rgba32f rows=up" };
        let mut out = format!("//@pass {pass} \"{file}\" {goes}\n#version 460\n#define TOY_FILE\n");
        out += &format!("#define toy_VERSION {}\n", version(text));
        if !is_picture {
            out += "#define TOY_BUFFER\n";
        }
        if !is_shadertoy(text) {
            out += "#define TOY_MAIN\n";
        }
        out.extend(part.iter().map(|part| format!("#define {part}\n")));
        let common = self.common();
        let shared = common.as_ref().map_or("", |(_, text)| text);
        let files = common.iter().map(|(file, text)| (file.as_str(), text.as_str()));
        let texts = self.texts(files.chain([(file.as_str(), text.as_str())]));
        let mut own = OwnNames::default();
        texts.iter().for_each(|text| own.add(text));
        let mut variables = variables_of(&texts);
        add_standard(&mut variables, &own.declared);
        out += "#include \"toy.glsl\"\n";
        // The sliders of other files alone would stand below the row of this one.
        if !sliders(&variables).is_empty() {
            out += &format!("#include \"{SLIDERS}\"\n");
        }
        out += &globals(&variables);
        out += &declarations(drawings, index, shared);
        out += &assignments(&variables);
        out += &own.removed_macros();
        if has_key_functions(text) || has_key_functions(shared) {
            out += "#include \"toy/keys.glsl\"\n";
        }
        for name in outputs(&code(text)) {
            out += &format!("#define {name} toyFragColor\n");
        }
        for file in common.iter().map(|(file, _)| file).chain([file]) {
            out += &format!("#include \"{OPENED}/{file}\"\n");
        }
        out
    }
}

/// The name of the pass of a file other than Shadertoy's buffers.
fn buffer_name(file: &str) -> String {
    let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
    let name: String =
        stem.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' }).collect();
    if BUFFERS.contains(&name.as_str()) { name } else { format!("buffer_{name}") }
}

fn stage_path(pass: &str) -> TreePath {
    TreePath::from(format!("{STAGES}/{pass}.frag").as_str())
}

fn opened_path(file: &str) -> TreePath {
    TreePath::from(format!("{OPENED}/{file}").as_str())
}

fn below<'a>(path: &'a str, folder: &str) -> Option<&'a str> {
    path.strip_prefix(folder)?.strip_prefix('/')
}

fn slashes(path: &Path) -> Option<String> {
    let names: Option<Vec<&str>> = path
        .components()
        .map(|part| match part {
            Component::Normal(name) => name.to_str(),
            _ => None,
        })
        .collect();
    Some(names?.join("/"))
}

#[cfg(test)]
mod tests;
