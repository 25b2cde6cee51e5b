//! The uniforms, inputs and outputs that a toy declares, and the values that the stage gives them.

use std::collections::BTreeSet;
use std::ops::Range;

use super::channel::channel_of;
use crate::shader::glsl::syntax::outside_brackets;
use crate::shader::glsl::{Token, TokenKind, code, tokens};

/// The arrays and constants that the stage defines. A declaration of them is dropped.
const BUILT_IN: [&str; 3] = ["iChannelTime", "iChannelResolution", "iSampleRate"];
/// The variables that the stage declares even if the file does not, and their types.
const STANDARD: [(&str, &str); 17] = [
    ("iResolution", "vec3"),
    ("iTime", "float"),
    ("iGlobalTime", "float"),
    ("iTimeDelta", "float"),
    ("iFrameRate", "float"),
    ("iFrame", "int"),
    ("iMouse", "vec4"),
    ("iDate", "vec4"),
    ("iChannelTime", "float[4]"),
    ("iSampleRate", "float"),
    ("u_time", "float"),
    ("u_delta", "float"),
    ("u_frame", "int"),
    ("u_date", "vec4"),
    ("u_resolution", "vec2"),
    ("u_mouse", "vec2"),
    ("v_texcoord", "vec2"),
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
        TYPES.contains(&self.kind) && self.names.iter().all(|name| name.is_plain || is_given(name.text))
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

/// Whether the stage gives a name its value whatever the file declares.
fn is_given(name: &str) -> bool {
    is_built_in(name) || STANDARD.iter().any(|(known, _)| *known == name)
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

/// The images that a text declares: the type and the name of each.
pub(super) fn samplers<'a>(code: &[Token<'a>]) -> Vec<(&'a str, &'a str)> {
    let kinds = ["sampler2D", "samplerCube", "sampler3D", "sampler2DArray"];
    let images = declarations(code).into_iter().filter(|declaration| kinds.contains(&declaration.kind));
    let named = |declaration: Declaration<'a>| {
        let plain = declaration.names.into_iter().filter(|name| name.is_plain);
        plain.map(move |name| (declaration.kind, name.text)).collect::<Vec<_>>()
    };
    images.flat_map(named).collect()
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
    Known(String),
    /// The size of the image of a channel.
    SizeOf(usize),
    /// The rest of the `//@ui` of its slider.
    Slider(String),
    Zero,
}

/// The uniforms and inputs of a text that the stage declares.
fn variables(text: &str) -> Vec<Variable> {
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

/// The variables of texts, each name once.
pub(super) fn variables_of(texts: &[String]) -> Vec<Variable> {
    let mut out: Vec<Variable> = Vec::new();
    for variable in texts.iter().flat_map(|text| variables(text)) {
        if out.iter().all(|known| known.name != variable.name) {
            out.push(variable);
        }
    }
    out
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

/// Adds the variables that no file declares. `owned`: the names that the files declare as their own.
pub(super) fn add_standard(variables: &mut Vec<Variable>, owned: &BTreeSet<String>) {
    for (name, kind) in STANDARD {
        let value = known(name, kind).filter(|_| !owned.contains(name));
        if let Some(value) = value.filter(|_| variables.iter().all(|other| other.name != name)) {
            variables.push(Variable { name: name.to_owned(), kind: kind.to_owned(), value });
        }
    }
}

/// The declarations of the variables.
pub(super) fn globals(variables: &[Variable]) -> String {
    variables.iter().map(|Variable { name, kind, .. }| format!("{kind} {name};\n")).collect()
}

/// The function that gives the variables their values. It comes before the files, whose macros may have the same names.
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
    let scalar = match (plain.as_str(), kind) {
        ("time" | "globaltime" | "elapsedtime", "float") => "toy_iTime",
        ("timedelta" | "deltatime" | "delta", "float") => "toy_iTimeDelta",
        ("framerate" | "fps", "float") => "toy_iFrameRate",
        ("frame" | "framecount", "int") => "toy_iFrame",
        ("frame" | "framecount", "float") => "float(toy_iFrame)",
        _ if (name, kind) == ("iChannelTime", "float[4]") => "toy_iChannelTime",
        _ if (name, kind) == ("iSampleRate", "float") => "toy_iSampleRate",
        _ => "",
    };
    if !scalar.is_empty() {
        return Some(Value::Known(scalar.to_owned()));
    }
    let (vector, length) = match plain.as_str() {
        "viewport" if kind == "vec4" => return None,
        "resolution" | "screensize" | "viewport" => ("toy_iResolution", 3),
        "mouse" if kind == "vec4" || name == "iMouse" => ("toy_iMouse", 4),
        // GLSL Sandbox has it from 0 to 1.
        "mouse" if name == "mouse" => ("(toy_iMouse.xy / toy_iResolution.xy)", 2),
        "mouse" => ("toy_iMouse.xy", 2),
        "date" => ("toy_iDate", 4),
        "uv" | "texcoord" | "texcoords" | "texturecoord" | "texcoord0" => ("(toyFragCoord.xy / toy_iResolution.xy)", 2),
        "surfaceposition" => ("((toyFragCoord.xy - 0.5 * toy_iResolution.xy) / toy_iResolution.y)", 2),
        _ if kind == "vec2" => return channel_of(name.strip_suffix("Resolution")?).map(Value::SizeOf),
        _ => return None,
    };
    resized(vector, length, kind).map(Value::Known)
}

/// A vector of `length` components as one of another type, which ends with 0 if it is longer.
fn resized(vector: &str, length: usize, kind: &str) -> Option<String> {
    let wanted: usize = kind.strip_prefix("vec")?.parse().ok()?;
    Some(match wanted.checked_sub(length) {
        None => format!("{vector}.{}", &"xyz"[..wanted]),
        Some(0) => vector.to_owned(),
        Some(more) => format!("{kind}({vector}{})", ", 0.0".repeat(more)),
    })
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
            "    time = toy_iTime;",
            "speed = toy_sliders.speed;",
            "mouse = (toy_iMouse.xy / toy_iResolution.xy);",
            "u_tex1Resolution = iChannelResolution[1].xy;",
            "tint_color = toy_sliders.tint_color;",
            "vUv = (toyFragCoord.xy / toy_iResolution.xy);",
            "iTime = toy_iTime;",
            "iResolution = toy_iResolution;",
            "mat4 camera;",
            "vec3 normal;",
        ] {
            assert!(lines.contains(line), "{lines}");
        }
        assert_eq!(found.len(), 10, "{lines}");
        let block = "uniform ToySliders {\n    float speed;   //@ui \"speed\" 0..1 = 0\n    vec3 tint_color;   \
                     //@ui \"Tint\" color = 1 0 0\n} toy_sliders;\n";
        assert_eq!(sliders(&found), block);
    }

    #[test]
    fn known_values_have_the_declared_type() {
        for (text, expected) in [
            ("uniform vec3 u_mouse;", "u_mouse = vec3(toy_iMouse.xy, 0.0);"),
            ("uniform vec4 u_mouse;", "u_mouse = toy_iMouse;"),
            ("uniform vec2 iMouse;", "iMouse = toy_iMouse.xy;"),
            ("uniform vec2 iResolution;", "iResolution = toy_iResolution.xy;"),
            ("uniform vec3 u_resolution;", "u_resolution = toy_iResolution;"),
            ("uniform vec4 u_resolution;", "u_resolution = vec4(toy_iResolution, 0.0);"),
            ("varying vec3 vUv;", "vUv = vec3((toyFragCoord.xy / toy_iResolution.xy), 0.0);"),
            ("uniform float u_time = 1.0;", "u_time = toy_iTime;"),
            ("uniform vec4 viewport;", "viewport = toy_sliders.viewport;"),
        ] {
            let lines = assignments(&variables(text));
            assert!(lines.contains(expected), "{text} {lines}");
        }
    }

    #[test]
    fn a_file_may_have_names_of_other_playgrounds() {
        let names = |owned: &[&str]| {
            let mut found = variables("uniform vec2 u_mouse;");
            add_standard(&mut found, &owned.iter().map(|name| (*name).to_owned()).collect());
            globals(&found)
        };
        let all = names(&[]);
        for line in ["float iTime;\n", "float[4] iChannelTime;\n", "float iSampleRate;\n", "vec2 v_texcoord;\n"] {
            assert!(all.contains(line), "{all}");
        }
        assert_eq!(all.lines().count(), STANDARD.len());
        let own = names(&["iTime", "u_resolution"]);
        assert!(!own.contains(" iTime;") && !own.contains(" u_resolution;") && own.contains(" u_time;"), "{own}");
    }
}
