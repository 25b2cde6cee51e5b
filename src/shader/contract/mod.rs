//! Checks compiled stages against `interface.rs`, so that a live edit cannot misread memory. Every message names both
//! sides.
//!
//! `access.rs` walks the call graph of each module and refuses resources that are not bound for the stage at the line
//! that reads them; `pipeline/set.rs` refuses a module that slipped through before the driver sees it. A global `const
//! bool` that joins specialization constants by `&&` or `||` is refused with its line, since glslang leaves it without
//! a value and the driver would fail or crash.

pub mod access;
mod capability;

use std::collections::BTreeSet;
use std::ops::Range;

use crate::interface::{self, BindingKind, block};

use crate::shader::compile::{StageKind, declares_pass};
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::{find_word, lines};
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::reflect::{Block, Descriptor, Location, Reflection, Scalar};

/// The file in every tree that holds the contract.
pub const INTERFACE_FILE: &str = "interface.glsl";

/// The source text of a stage, to find the line that a message is about.
#[derive(Clone, Copy, Debug)]
pub struct Texts<'a> {
    /// The update's snapshot.
    pub snapshot: &'a Snapshot<'a>,
    /// The file with `main()`.
    pub stage: &'a TreePath,
    /// All files of the stage.
    pub dependencies: &'a BTreeSet<TreePath>,
}

impl Texts<'_> {
    /// An error at the first line of code that contains all `words`, with the caret under the first word. If there is
    /// no such line (a macro made the declaration), the error is about the stage's file.
    pub fn error(&self, words: &[&str], message: String) -> Diagnostic {
        let all = |code: &str| {
            let found: Option<Vec<_>> = words.iter().map(|word| find_word(code, word)).collect();
            found?.into_iter().next()
        };
        // The name may be on another line than its keywords.
        let name = |code: &str| find_word(code, words.first()?);
        self.error_at(all, &message).or_else(|| self.error_at(name, &message)).unwrap_or_else(|| self.on_file(message))
    }

    /// An error at the first line of code that contains any of `words`, or about the stage's file.
    fn error_at_any(&self, words: &[&str], message: String) -> Diagnostic {
        let any = |code: &str| words.iter().find_map(|word| find_word(code, word));
        self.error_at(any, &message).unwrap_or_else(|| self.on_file(message))
    }

    fn on_file(&self, message: String) -> Diagnostic {
        Diagnostic::error(self.snapshot.display_path(self.stage), message)
    }

    /// An error at the first line of code in which `find` finds something. Searches the stage's own file first.
    fn error_at(&self, find: impl Fn(&str) -> Option<Range<usize>>, message: &str) -> Option<Diagnostic> {
        let included = self.dependencies.iter().filter(|path| *path != self.stage);
        std::iter::once(self.stage).chain(included).find_map(|path| {
            let text = self.snapshot.read(path).ok()?;
            let (bytes, line) = lines(&text).into_iter().find_map(|line| Some((find(&line.code)?, line)))?;
            let error = Diagnostic::error(self.snapshot.display_path(path), message);
            Some(error.on_line(line.number, Some(line.raw)).under(bytes))
        })
    }
}

/// Checks one stage against the contract.
pub fn check(reflection: &Reflection, texts: Texts<'_>) -> Vec<Diagnostic> {
    let mut out = Vec::new();
    // `graph` checks what a stage declares by name.
    for descriptor in reflection.descriptors.iter().filter(|found| found.set != interface::SET_PASS) {
        out.extend(check_descriptor(descriptor, texts));
    }
    if let Some(block) = &reflection.push_constants {
        let limit = interface::PUSH_CONSTANT_SIZE;
        if block.size > limit {
            let (name, size) = (&block.name, block.size);
            let message =
                format!("shader says push constants `{name}` have {size} bytes, Specula says at most {limit}");
            out.push(texts.error(&[name.as_str(), "push_constant"], message));
        }
        out.extend(check_block(block, "Draw", texts));
    }
    // Structs behind arrays and buffer references, which no descriptor shows.
    let has_contract = texts.dependencies.iter().any(|path| path.as_str() == INTERFACE_FILE);
    let structs = interface::blocks().filter(|block| block.around[0].starts_with("struct "));
    for known in structs.filter(|_| has_contract) {
        let found = reflection.structs.get(known.name);
        out.extend(found.and_then(|found| check_block(found, known.name, texts)));
        let arrays = reflection.structs.values().flat_map(|block| &block.members);
        let element = format!("{}[]", known.name);
        for member in arrays.filter(|member| member.type_name == element && member.stride != known.size) {
            let message = format!(
                "shader says `{}` lie {} bytes apart in `{}`, Specula says {}; use scalar layout",
                known.name, member.stride, member.name, known.size
            );
            out.push(texts.error(&[member.name.as_str(), known.name], message));
        }
    }
    out.extend(check_constants(reflection, texts));
    out.extend(reflection.large_variables.iter().map(|(name, bytes)| too_large(name, *bytes, texts)));
    match StageKind::of(texts.stage) {
        Some(StageKind::Vertex) => out.extend(check_vertex_inputs(&reflection.inputs, texts)),
        // `graph` checks the outputs of passes, which depend on their annotations.
        Some(StageKind::Fragment) if !texts.snapshot.read(texts.stage).is_ok_and(|text| declares_pass(&text)) => {
            out.extend(check_fragment_outputs(&reflection.outputs, texts));
        }
        _ => {}
    }
    out.extend(check_capabilities(&reflection.capabilities, texts));
    out
}

fn check_vertex_inputs(inputs: &[Location], texts: Texts<'_>) -> Vec<Diagnostic> {
    let refuse = |Location { location, name, type_name }: &Location| {
        let message = format!(
            "shader reads `{type_name} {name}` at location {location}, Specula has no vertex buffers: \
             vertices are read by address"
        );
        let help = format!("read `draw.vertices.at[gl_VertexIndex]` of {INTERFACE_FILE}");
        texts.error(&[last_part(name), "in"], message).with_help(help)
    };
    inputs.iter().map(refuse).collect()
}

/// There is one color attachment. It needs all four components, since components that a shader does not write are
/// undefined.
pub fn check_fragment_outputs(outputs: &[Location], texts: Texts<'_>) -> Vec<Diagnostic> {
    const EXPECTED: &str = "`layout(location = 0) out vec4`";
    if outputs.is_empty() {
        let message = format!("shader writes no color, Specula draws to {EXPECTED}");
        return vec![texts.error(&["main", "void"], message)];
    }
    let mut is_first = true;
    let mut refuse = |Location { location, name, type_name }: &Location| {
        let is_color = *location == 0 && type_name == "vec4" && std::mem::take(&mut is_first);
        let message =
            format!("shader writes `{type_name} {name}` at location {location}, Specula has {EXPECTED} alone");
        let error = || texts.error(&[last_part(name), "out"], message.clone());
        let help = format!("write also={} in the //@pass of a pass that draws an image of its own", last_part(name));
        let is_further = *location > 0 && type_name == "vec4";
        (!is_color).then(|| if is_further { error().with_help(help) } else { error() })
    };
    outputs.iter().filter_map(&mut refuse).collect()
}

/// `b` of `Block.b`, as the declaration spells it.
fn last_part(name: &str) -> &str {
    name.rsplit('.').next().unwrap_or(name)
}

fn check_capabilities(capabilities: &[u32], texts: Texts<'_>) -> Vec<Diagnostic> {
    let refuse = |capability::Missing { name, glsl }: capability::Missing| {
        let message = format!("shader needs the device feature {name} (SPIR-V capability), Specula does not enable it");
        let error = texts.error_at_any(glsl, message);
        match glsl {
            [] => error,
            _ if name == "StorageImageExtendedFormats" => {
                error.with_note("a shader can write images of the formats rgba8, rgba16f, rgba32f and r32f".to_owned())
            }
            _ => error.with_note(format!("what needs it in GLSL: {}", glsl.join(", "))),
        }
    };
    capability::missing(capabilities).into_iter().map(refuse).collect()
}

fn check_descriptor(found: &Descriptor, texts: Texts<'_>) -> Option<Diagnostic> {
    let Descriptor { set, binding, glsl, name, .. } = found;
    let words = [name.as_str(), "layout"];
    let is_used = |known: &&interface::Binding| known.name != "BINDING_UNUSED";
    let place = (*set, *binding);
    let Some(known) = interface::BINDINGS.iter().filter(is_used).find(|known| (known.set, known.binding) == place)
    else {
        let message = format!("shader says set {set}, binding {binding} is {glsl} `{name}`, Specula has nothing there");
        let names: Vec<String> = interface::BINDINGS
            .iter()
            .filter(is_used)
            .filter(|known| known.set == *set)
            .map(|known| format!("{} = {} ({})", known.name, known.binding, known.kind.glsl()))
            .collect();
        let is_image = glsl.starts_with("sampler") || glsl.starts_with("image");
        let help = match names.as_slice() {
            _ if is_image => format!(
                "leave out the set and the binding: images of passes and textures are read by name, as `{name}`"
            ),
            [] => "the sets are SET_FRAME, SET_MATERIAL, SET_PASS and SET_TASK".to_owned(),
            names => format!("set {set} has {}", names.join(", ")),
        };
        return Some(texts.error(&words, message).with_help(help));
    };
    if found.kind != Some(known.kind) {
        let message = format!(
            "shader says set {set}, binding {binding} is {glsl} `{name}`, Specula says {} is {}",
            known.name,
            known.kind.glsl()
        );
        return Some(texts.error(&words, message));
    }
    let block = found.block.as_ref()?;
    let misplaced = match known.name {
        "BINDING_LIGHTS" | "BINDING_FEW_LIGHTS" => check_lights(block, known.kind, texts),
        "BINDING_FRAME" => check_block(block, "Frame", texts),
        "BINDING_MATERIAL" => check_block(block, "Material", texts),
        "BINDING_TASK" => check_block(block, "Task", texts),
        _ => None,
    };
    if misplaced.is_none() && block.size > known.size && known.kind == BindingKind::UniformBuffer {
        let message = format!(
            "shader says `{name}` has {} bytes, Specula says {} has at most {}",
            block.size, known.name, known.size
        );
        return Some(texts.error(&words, message));
    }
    misplaced
}

fn check_lights(block: &Block, kind: BindingKind, texts: Texts<'_>) -> Option<Diagnostic> {
    let size = u32::try_from(size_of::<interface::Light>()).ok()?;
    match block.members.as_slice() {
        [only] if only.offset == 0 && only.stride == size => None,
        _ => {
            let (array, word) = match kind {
                BindingKind::UniformBuffer => ("Light few_lights[FEW_LIGHTS + MAX_SUNS]", "uniform"),
                _ => ("Light lights[]", "buffer"),
            };
            let message = format!(
                "shader says `{}` is not an array of {size}-byte lights, Specula says it is `{array}` alone",
                block.name
            );
            Some(texts.error(&[block.name.as_str(), word], message))
        }
    }
}

/// Reports the first member whose offset is not the one that Rust writes to. A shader may leave out members at the end.
fn check_block(found: &Block, name: &str, texts: Texts<'_>) -> Option<Diagnostic> {
    let known = block(name)?;
    for (index, member) in found.members.iter().enumerate() {
        let found = format!("shader says `{name}.{}` is at byte {}", member.name, member.offset);
        let message = match known.members.iter().find(|known| known.name == member.name) {
            Some(known) if known.offset == member.offset => continue,
            Some(known) => format!("{found}, Specula says {}", known.offset),
            None => match known.members.get(index) {
                Some(known) => format!("{found}, Specula has `{}` at {} there", known.name, known.offset),
                None => format!("{found}, Specula says `{name}` ends at {}", known.size),
            },
        };
        let error = texts.error(&[member.name.as_str(), short_type(&member.type_name)], message);
        return Some(error.with_help(format!("restore `{name}` in {INTERFACE_FILE}: Rust writes this memory")));
    }
    None
}

/// `Light` of `Light[]`, as the declaration spells it.
fn short_type(type_name: &str) -> &str {
    type_name.split('[').next().unwrap_or(type_name)
}

/// A driver may take minutes to compile such a variable, or run out of its stack.
fn too_large(name: &str, bytes: u64, texts: Texts<'_>) -> Diagnostic {
    let (has, most) = (bytes.div_ceil(1024), interface::LARGEST_VARIABLE / 1024);
    let message = format!("`{name}` has {has} KiB in each invocation, at most {most} KiB fit");
    let help = "make the array shorter, or put it into a buffer that all invocations share";
    texts.error(&[name], message).with_help(help)
}

fn check_constants(reflection: &Reflection, texts: Texts<'_>) -> Vec<Diagnostic> {
    let mut out = Vec::new();
    // Report only the first: the same constant may lack a value in many places.
    if let Some(first) = reflection.without_value.first() {
        let named = reflection.without_value.iter().find(|name| !name.is_empty()).unwrap_or(first);
        let what = if named.is_empty() { "a global constant".into() } else { format!("`{named}`") };
        let message = format!("{what} gets no value: the compiler cannot join comparisons of constants by && or ||");
        let help =
            "give each comparison a name of its own (`const bool A = ...;`) and join the names, or make it a function";
        out.push(texts.error(&[named.as_str(), "const"], message).with_help(help));
    }
    for constant in reflection.constants.iter().filter(|constant| constant.id < interface::USER_CONSTANTS) {
        let words = [constant.name.as_str(), "constant_id"];
        let found = format!("shader says constant_id {} is `{}`", constant.id, constant.name);
        match interface::SPECIALIZATION.iter().find(|known| known.id == constant.id) {
            Some(known) if known.name == constant.name && constant.scalar == Scalar::Uint => {}
            Some(known) => {
                let message = format!("{found}, Specula says it is `const uint {}`: {}", known.name, known.doc);
                out.push(texts.error(&words, message));
            }
            None => {
                let message = format!("{found}, Specula keeps the ids below {} for itself", interface::USER_CONSTANTS);
                out.push(
                    texts.error(&words, message).with_help("number yours `constant_id = USER_CONSTANTS + 0` and up"),
                );
            }
        }
    }
    out
}

/// Checks that a fragment stage's inputs match its vertex stage's outputs.
pub fn check_pair(vertex: (&Reflection, Texts<'_>), fragment: (&Reflection, Texts<'_>)) -> Vec<Diagnostic> {
    let (vertex_texts, texts) = (vertex.1, fragment.1);
    let writer = vertex_texts.snapshot.display_path(vertex_texts.stage);
    let reader = texts.snapshot.display_path(texts.stage);
    let written: &[Location] = &vertex.0.outputs;
    let mut out = Vec::new();
    for input in &fragment.0.inputs {
        let Location { location, name, type_name } = input;
        let read = format!("{reader} reads `{type_name} {name}` at location {location}");
        let message = match written.iter().find(|output| output.location == *location) {
            Some(output) if output.type_name == *type_name => continue,
            Some(output) => format!("{read}, {writer} writes `{} {}` there", output.type_name, output.name),
            None => format!("{read}, {writer} writes nothing there"),
        };
        out.push(texts.error(&[last_part(name), "in"], message));
    }
    out
}

/// Compares a tree's `interface.glsl` with the one that this Specula prints. Returns `None` if they are equal or the
/// tree has none, an error if the version differs, and a warning if the text of the same version differs: whether
/// memory is still read correctly is for [`check`] to find.
pub fn interface_matches(snapshot: &Snapshot<'_>) -> Option<Diagnostic> {
    let path = TreePath::from(INTERFACE_FILE);
    let text = snapshot.read(&path).ok()?;
    let expected = interface::glsl();
    let different = text.lines().zip(expected.lines()).zip(1..).find(|((found, expected), _)| found != expected);
    if different.is_none() && text.lines().count() == expected.lines().count() {
        return None;
    }
    let file = snapshot.display_path(&path);
    let renew = "`specula new DIR` writes a current tree; move your edits there";
    let version = lines(&text).into_iter().find(|line| find_word(&line.code, "INTERFACE_VERSION").is_some());
    let found = version.as_ref().and_then(|line| {
        line.code.split_once('=')?.1.trim().trim_end_matches(';').trim_end_matches(['u', 'U']).parse::<u32>().ok()
    });
    let (Some(line), Some(found)) = (&version, found) else {
        let message = format!("no INTERFACE_VERSION in this tree, this Specula has version {}", interface::VERSION);
        return Some(Diagnostic::error(file, message).with_help(renew));
    };
    if found != interface::VERSION {
        let message = format!(
            "this tree was written for interface version {found}, this Specula has version {}",
            interface::VERSION
        );
        return Some(Diagnostic::error(file, message).on_line(line.number, Some(line.raw)).with_help(renew));
    }
    let message = format!("differs from what this Specula prints (interface version {found})");
    let diagnostic = Diagnostic::warning(file, message).with_help(renew);
    Some(match different {
        Some(((found, expected), number)) => {
            diagnostic.on_line(number, Some(found)).with_note(format!("Specula has `{}`", expected.trim()))
        }
        None => diagnostic,
    })
}

#[cfg(test)]
mod tests;
