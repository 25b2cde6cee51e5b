//! The uniforms, inputs and outputs that a toy declares, and the values that the stage gives them.

use std::ops::Range;

use super::channel::channel_of;
use crate::shader::glsl::syntax::outside_brackets;
use crate::shader::glsl::{Token, TokenKind, code, tokens};

/// The variables that toy.glsl or the stage defines. A declaration of them is dropped.
const BUILT_IN: [&str; 18] = [
    "iResolution",
    "iTime",
    "iGlobalTime",
    "iTimeDelta",
    "iFrameRate",
    "iFrame",
    "iMouse",
    "iDate",
    "iChannelTime",
    "iChannelResolution",
    "iSampleRate",
    "u_time",
    "u_delta",
    "u_frame",
    "u_date",
    "u_resolution",
    "u_mouse",
    "v_texcoord",
];
/// The types that can be made of a 0.
pub(super) const TYPES: [&str; 19] = [
    "float", "int", "uint", "bool", "vec2", "vec3", "vec4", "ivec2", "ivec3", "ivec4", "uvec2", "uvec3", "uvec4",
    "bvec2", "bvec3", "bvec4", "mat2", "mat3", "mat4",
];
/// The image that the file drew one frame ago, on GLSL Sandbox and in glslViewer.
pub(super) const BEFORE: [&str; 3] = ["backbuffer", "u_backbuffer", "u_doubleBuffer"];

/// The images that glslViewer draws from parts of a file, before their numbers.
pub(super) const PARTS: [&str; 2] = ["u_buffer", "u_doubleBuffer"];

/// The kind of a variable that the stage replaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Storage {
    Uniform,
    /// `in`, `varying` or `attribute`
    Input,
    Output,
}

/// A name in a declaration.
pub(super) struct Name<'a> {
    pub(super) text: &'a str,
    /// Whether it is no array and has no initial value.
    is_plain: bool,
}

/// A declaration at file level.
pub(super) struct Declaration<'a> {
    pub(super) storage: Storage,
    pub(super) kind: &'a str,
    pub(super) names: Vec<Name<'a>>,
    /// All of its bytes, with its semicolon.
    pub(super) bytes: Range<usize>,
    /// The bytes before its type or precision.
    pub(super) qualifiers: Range<usize>,
}

impl Declaration<'_> {
    /// Whether it declares samplers or images, which can only be uniforms.
    pub(super) fn is_opaque(&self) -> bool {
        self.kind.contains("sampler") || self.kind.contains("image")
    }

    /// Whether the stage declares its variables: those of plain types. Others stay where they are, and are 0.
    pub(super) fn is_moved(&self) -> bool {
        TYPES.contains(&self.kind) && self.names.iter().all(|name| name.is_plain || is_built_in(name.text))
    }

    /// The bytes behind a `//@ui` on the line of the declaration.
    pub(super) fn note(&self, text: &str) -> Option<Range<usize>> {
        let rest = text[self.bytes.end..].lines().next()?;
        let note = tokens(rest).next().filter(|token| token.text.starts_with("//@ui"))?;
        Some(self.bytes.end + note.bytes.start + "//@ui".len()..self.bytes.end + rest.trim_end().len())
    }
}

/// Whether toy.glsl or the stage gives a variable or sampler of this name.
pub(super) fn is_built_in(name: &str) -> bool {
    let is_channel = name.strip_prefix("iChannel").is_some_and(|number| matches!(number, "0" | "1" | "2" | "3"));
    let number = PARTS.iter().find_map(|part| name.strip_prefix(part));
    let is_part = number.is_some_and(|number| number.len() == 1 && number.as_bytes()[0].is_ascii_digit());
    is_channel || is_part || channel_of(name).is_some() || BUILT_IN.contains(&name) || BEFORE.contains(&name)
}

/// Whether the author names the file of an image.
pub(super) fn has_texture(text: &str, name: &str) -> bool {
    text.contains("//@texture") && text.lines().any(|line| line.trim().starts_with(&format!("//@texture {name} ")))
}

/// The declarations of uniforms, inputs and outputs at file level. Blocks are left out.
pub(super) fn declarations<'a>(code: &[Token<'a>]) -> Vec<Declaration<'a>> {
    let (mut out, mut first, mut depth) = (Vec::new(), 0, 0_usize);
    for (at, token) in code.iter().enumerate() {
        match token.text {
            "{" => depth += 1,
            "}" => (depth, first) = (depth.saturating_sub(1), at + 1),
            ";" if depth == 0 => {
                out.extend(declaration(&code[first..=at]));
                first = at + 1;
            }
            _ => {}
        }
    }
    out
}

/// The names of the outputs that a text declares.
pub(super) fn outputs<'a>(code: &[Token<'a>]) -> Vec<&'a str> {
    let outputs = declarations(code).into_iter().filter(|declaration| declaration.storage == Storage::Output);
    outputs.flat_map(|declaration| declaration.names).map(|name| name.text).collect()
}

fn declaration<'a>(statement: &[Token<'a>]) -> Option<Declaration<'a>> {
    let mut storage = None;
    let mut words = outside_brackets(statement).map(|(at, token)| (at, token.text)).peekable();
    while let Some((_, word)) = words.peek() {
        match *word {
            "uniform" => storage = Some(Storage::Uniform),
            "in" | "varying" | "attribute" => storage = Some(Storage::Input),
            "out" => storage = Some(Storage::Output),
            "layout" | "flat" | "smooth" | "centroid" | "noperspective" | "invariant" => {}
            _ => break,
        }
        words.next();
    }
    let (from, _) = *words.peek()?;
    let (at, kind) = words.find(|(_, word)| !matches!(*word, "lowp" | "mediump" | "highp"))?;
    let is_word = |token: &Token<'_>| token.kind == TokenKind::Word;
    let names = statement[at + 1..].split(|token| matches!(token.text, "," | ";"));
    // A comma in brackets splits an initial value, whose parts are no names.
    let names = names.filter_map(|part| Some((part.first().filter(|first| is_word(first))?, part.len() == 1)));
    let names: Vec<Name<'a>> = names.map(|(name, is_plain)| Name { text: name.text, is_plain }).collect();
    let bytes = statement.first()?.bytes.start..statement.last()?.bytes.end;
    let qualifiers = bytes.start..statement[from].bytes.start;
    (!names.is_empty()).then_some(Declaration { storage: storage?, kind, names, bytes, qualifiers })
}

/// A variable that the stage declares, and sets before it runs the author's code.
pub(super) struct Variable {
    pub(super) name: String,
    kind: String,
    value: Value,
}

enum Value {
    /// In GLSL.
    Known(&'static str),
    /// The size of the image of a channel.
    SizeOf(usize),
    /// The rest of the `//@ui` of its slider.
    Slider(String),
    Zero,
}

/// The uniforms and inputs of a text that the stage declares.
pub(super) fn variables(text: &str) -> Vec<Variable> {
    let code = code(text);
    let declarations = declarations(&code).into_iter();
    let moved = declarations.filter(|declaration| declaration.storage != Storage::Output && declaration.is_moved());
    let of_declaration = |declaration: Declaration<'_>| {
        let note = declaration.note(text).map(|bytes| text[bytes].to_owned());
        let variable = |name: &Name<'_>| {
            let known = || known(name.text, declaration.kind);
            let slider = || slider(name.text, declaration.kind).filter(|_| declaration.storage == Storage::Uniform);
            let value = note.clone().map(Value::Slider).or_else(known).or_else(|| slider().map(Value::Slider));
            Variable {
                name: name.text.to_owned(),
                kind: declaration.kind.to_owned(),
                value: value.unwrap_or(Value::Zero),
            }
        };
        declaration.names.iter().filter(|name| !is_built_in(name.text)).map(variable).collect::<Vec<_>>()
    };
    moved.flat_map(of_declaration).collect()
}

/// The block of the sliders of some variables. Empty if there is none.
pub(super) fn sliders(variables: &[Variable]) -> String {
    let member = |variable: &Variable| match &variable.value {
        Value::Slider(note) => Some(format!("    {} {};   //@ui{note}\n", variable.kind, variable.name)),
        Value::Known(_) | Value::SizeOf(_) | Value::Zero => None,
    };
    let members: String = variables.iter().filter_map(member).collect();
    if members.is_empty() { members } else { format!("uniform ToySliders {{\n{members}}} toy_sliders;\n") }
}

/// Macros for variables of toy.glsl that the author declares with fewer components.
pub(super) fn narrowed(text: &str) -> String {
    let code = code(text);
    let is_narrow = |declaration: &Declaration<'_>| declaration.kind == "vec2";
    let names = declarations(&code).into_iter().filter(is_narrow).flat_map(|declaration| declaration.names);
    let names = names.filter(|name| matches!(name.text, "iResolution" | "iMouse"));
    names.map(|Name { text, .. }| format!("#define {text} ({text}.xy)\n")).collect()
}

/// The declarations of the variables.
pub(super) fn globals(variables: &[Variable]) -> String {
    variables.iter().map(|Variable { name, kind, .. }| format!("{kind} {name};\n")).collect()
}

/// The function that gives the variables their values.
pub(super) fn assignments(variables: &[Variable]) -> String {
    let line = |Variable { name, value, .. }: &Variable| match value {
        Value::Known(value) => format!("    {name} = {value};\n"),
        Value::SizeOf(channel) => format!("    {name} = iChannelResolution[{channel}].xy;\n"),
        Value::Slider(_) => format!("    {name} = toy_sliders.{name};\n"),
        Value::Zero => String::new(),
    };
    format!("void toy_variables() {{\n{}}}\n", variables.iter().map(line).collect::<String>())
}

/// The value of a uniform or input of another playground, by its name and type.
fn known(name: &str, kind: &str) -> Option<Value> {
    let plain = name.strip_prefix("u_").or(name.strip_prefix("v_")).unwrap_or(name);
    let plain =
        plain.strip_prefix(['u', 'i', 'v']).filter(|rest| rest.starts_with(char::is_uppercase)).unwrap_or(plain);
    let plain = plain.to_ascii_lowercase().replace('_', "");
    let value = match (plain.as_str(), kind) {
        ("time" | "globaltime" | "elapsedtime", "float") => "iTime",
        ("timedelta" | "deltatime" | "delta", "float") => "iTimeDelta",
        ("framerate" | "fps", "float") => "iFrameRate",
        ("frame" | "framecount", "int") => "iFrame",
        ("frame" | "framecount", "float") => "float(iFrame)",
        ("resolution" | "screensize" | "viewport", "vec2") => "iResolution.xy",
        ("resolution" | "screensize" | "viewport", "vec3") => "iResolution",
        // GLSL Sandbox has it from 0 to 1.
        ("mouse", "vec2") if name == "mouse" => "iMouse.xy / iResolution.xy",
        ("mouse", "vec2") => "iMouse.xy",
        ("mouse", "vec4") => "iMouse",
        ("date", "vec4") => "iDate",
        ("uv" | "texcoord" | "texcoords" | "texturecoord" | "texcoord0", "vec2") => "toyFragCoord.xy / iResolution.xy",
        ("surfaceposition", "vec2") => "(toyFragCoord.xy - 0.5 * iResolution.xy) / iResolution.y",
        (_, "vec2") => {
            return channel_of(name.strip_suffix("Resolution")?).map(Value::SizeOf);
        }
        _ => return None,
    };
    Some(Value::Known(value))
}

/// The rest of the `//@ui` of a uniform that nobody else sets.
fn slider(name: &str, kind: &str) -> Option<String> {
    let is_color = name.to_ascii_lowercase().contains("color");
    let range = match kind {
        "float" => "0..1 = 0",
        "int" | "uint" => "0..10 = 0",
        "bool" => "= false",
        "vec2" => "0..1 = 0 0",
        "vec3" if is_color => "color = 0 0 0",
        "vec4" if is_color => "color = 0 0 0 0",
        "vec3" => "0..1 = 0 0 0",
        "vec4" => "0..1 = 0 0 0 0",
        _ => return None,
    };
    Some(format!(" \"{name}\" {range}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_have_known_values_or_sliders() {
        let text = "uniform float time, speed, iTime; uniform vec2 mouse; uniform vec2 u_tex1Resolution;\n\
                    uniform vec3 tint_color; //@ui \"Tint\" color = 1 0 0\nuniform mat4 camera; uniform float weights[3];\n\
                    uniform float gain = 2.0; varying vec2 vUv; varying vec3 normal; uniform vec3 iResolution;\n\
                    uniform sampler2D iChannel0; uniform Block { float x; }; void f(in float time) { int uniform_; }\n";
        let found = variables(text);
        let lines = globals(&found) + &assignments(&found);
        for line in [
            "time = iTime;",
            "speed = toy_sliders.speed;",
            "mouse = iMouse.xy / iResolution.xy;",
            "u_tex1Resolution = iChannelResolution[1].xy;",
            "tint_color = toy_sliders.tint_color;",
            "vUv = toyFragCoord.xy / iResolution.xy;",
            "mat4 camera;",
            "vec3 normal;",
        ] {
            assert!(lines.contains(line), "{lines}");
        }
        assert_eq!(found.len(), 8, "{lines}");
        let block = "uniform ToySliders {\n    float speed;   //@ui \"speed\" 0..1 = 0\n    vec3 tint_color;   \
                     //@ui \"Tint\" color = 1 0 0\n} toy_sliders;\n";
        assert_eq!(sliders(&found), block);
    }
}
