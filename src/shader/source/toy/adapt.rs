//! Changes the text of an opened file so that it compiles in a pass. Each line keeps its number.
//!
//! Directives and declarations that the stage replaces become comments or blanks. Names that toy.glsl gives to what Vulkan lacks, and
//! names that are words of GLSL 4.60, are replaced by names of the same length. Only initial values and arguments that an author may
//! leave out in WebGL make a line longer.

use super::channel::{Channel, channel, channels, samplers};
use super::declared::{Storage, declarations, has_texture, is_built_in};
use super::initial::{Edit, apply, blank, initial_values};
use super::plain::{renamed, with_plain_names, with_word};
use crate::shader::glsl::{Token, TokenKind, code, find_word, includes, lines, tokens};

/// The file, beside a toy, that all its files share. Files that these include count as parts of it.
pub(super) const COMMON: &str = "common";

/// The line that declares functions about keys. The form is that of editors' Shadertoy extensions.
pub(super) const KEY_FUNCTIONS: &str = "#iKeyboard";

/// Names that a shader of WebGL uses, with names of the same length that toy.glsl defines.
const WEBGL: [(&str, &str); 5] = [
    ("gl_FragCoord", "toyFragCoord"),
    ("gl_FragColor", "toyFragColor"),
    ("gl_FrontFacing", "toyFrontFacing"),
    ("GL_ES", "toyES"),
    ("__VERSION__", "toy_VERSION"),
];

/// Words of Vulkan's GLSL 4.60 that are names in GLSL ES 1.00 or 3.00. Its types of images without a sampler have the names of functions of
/// GLSL ES 1.00.
pub(super) const NAMES_OF_ES: [&str; 31] = [
    "active",
    "buffer",
    "centroid",
    "coherent",
    "common",
    "filter",
    "image1D",
    "image2D",
    "image3D",
    "noperspective",
    "partition",
    "patch",
    "precise",
    "readonly",
    "resource",
    "restrict",
    "sample",
    "sampler",
    "shared",
    "smooth",
    "subpassInput",
    "subroutine",
    "texture1D",
    "texture2D",
    "texture2DArray",
    "texture2DRect",
    "texture3D",
    "textureBuffer",
    "textureCube",
    "textureCubeArray",
    "writeonly",
];

/// Extensions of WebGL, whose features GLSL 4.60 has.
const EXTENSIONS: [&str; 4] = ["GL_OES_", "GL_EXT_shader_texture_lod", "GL_EXT_frag_depth", "GL_EXT_draw_buffers"];

/// An object-like macro of toy.glsl that stands for nothing.
const NOTHING: &str = "toy_nothing";

/// Whether a text has Shadertoy's form, and no entry point of its own.
pub(super) fn is_shadertoy(text: &str) -> bool {
    uses(text, "mainImage") && !has_main(text)
}

/// Whether a text defines `main`, which a macro may do for it.
pub(super) fn has_main(text: &str) -> bool {
    let all = || tokens(text).filter(|token| token.kind != TokenKind::Comment).collect::<Vec<_>>();
    text.contains("main") && all().windows(3).any(|t| (t[0].text, t[1].text, t[2].text) == ("void", "main", "("))
}

/// The version of GLSL that a text is written in.
pub(super) fn version(text: &str) -> u32 {
    let all: Vec<Token<'_>> = tokens(text).filter(|token| token.kind != TokenKind::Comment).take(3).collect();
    match all.as_slice() {
        [sign, word, number] if sign.kind == TokenKind::Directive && word.text == "version" => number.text.parse().ok(),
        _ => None,
    }
    .unwrap_or(if is_shadertoy(text) { 300 } else { 100 })
}

/// Whether the code of a text has this word.
pub(super) fn uses(text: &str, word: &str) -> bool {
    text.contains(word) && lines(text).iter().any(|line| find_word(&line.code, word).is_some())
}

/// Whether a text reads keys by functions: it has a line `#iKeyboard`.
pub(super) fn has_key_functions(text: &str) -> bool {
    text.lines().any(|line| line.trim().starts_with(KEY_FUNCTIONS))
}

/// Whether a text reads the image with the state of the keys.
pub(super) fn reads_keyboard(text: &str) -> bool {
    has_key_functions(text) || channels(text).iter().any(|(_, channel)| *channel == Channel::Keyboard)
}

/// The files that a text names in its channels and includes. A name may have a `*`.
pub(super) fn named_files(text: &str) -> Vec<String> {
    let of_channel = |(_, channel)| match channel {
        Channel::This | Channel::Keyboard => None,
        Channel::Drawing(file) | Channel::Image(file, _) => Some(file),
    };
    let included = includes(text).map(|include| include.name.to_owned());
    channels(text).into_iter().filter_map(of_channel).chain(included).collect()
}

/// The name of the texture of a channel.
pub(super) fn texture_name(pass: &str, channel: usize) -> String {
    format!("{pass}_channel{channel}")
}

/// The text as a pass compiles it.
pub(super) fn adapted(text: &str, pass: &str) -> String {
    let all: Vec<Token<'_>> = tokens(text).filter(|token| token.kind != TokenKind::Comment).collect();
    let code = code(text);
    let mut edits = directives(text, pass);
    edits.extend(never_compiled(text, &all));
    edits.extend(words(&all, has_main(text)));
    edits.extend(first_output(&all));
    edits.extend(empty_arguments(&all));
    edits.extend(replaced_declarations(text, &code));
    edits.extend(initial_values(&code));
    apply(text, edits)
}

/// The message with the names that the author has written.
pub(super) fn with_names(message: &str) -> String {
    let names = NAMES_OF_ES.iter().map(|name| (*name, renamed(name)));
    let webgl = WEBGL.iter().map(|(name, own)| (*name, (*own).to_owned()));
    let message = with_plain_names(message).replace("'Main'", "'main'");
    names.chain(webgl).fold(message, |message, (name, own)| with_word(&message, &own, name))
}

/// Lines that name channels and keys, versions, and extensions of WebGL.
fn directives(text: &str, pass: &str) -> Vec<Edit> {
    let samplers = samplers(text);
    let mut start = 0;
    let edit = |with_break: &str| {
        let line = with_break.trim_end_matches(['\n', '\r']);
        let bytes = start..start + line.len();
        start += with_break.len();
        let words: Vec<&str> = tokens(line).map(|token| token.text).take(3).collect();
        let is_replaced = match words.as_slice() {
            ["#", "extension", name] => EXTENSIONS.iter().any(|known| name.starts_with(known)),
            ["#", word, ..] => ["version", "iChannel", "iKeyboard"].iter().any(|known| word.starts_with(known)),
            _ => false,
        };
        match channel(line).map(|(number, channel)| (number, channel.with(&samplers[number]))) {
            Some((number, Channel::Image(file, sampler))) => {
                let name = texture_name(pass, number);
                Some((bytes, format!("//@texture {name} \"{file}\" {}", sampler.options())))
            }
            Some(_) => Some((bytes, format!("//{line}"))),
            None => is_replaced.then(|| (bytes, format!("//{line}"))),
        }
    };
    text.split_inclusive('\n').filter_map(edit).collect()
}

/// Blanks after `#if 0`: the compiler refuses some words that WebGL skips there, as `3d` and a single quote.
fn never_compiled(text: &str, all: &[Token<'_>]) -> Vec<Edit> {
    let directives: Vec<usize> = (0..all.len()).filter(|at| all[*at].kind == TokenKind::Directive).collect();
    let word = |at: usize, after: usize| all.get(at + after).map_or("", |token| token.text);
    let ends = |at: usize| all.get(at + 3).is_none_or(|next| !next.in_directive || next.kind == TokenKind::Directive);
    let mut edits = Vec::new();
    for (place, at) in directives.iter().enumerate() {
        if word(*at, 1) != "if" || word(*at, 2) != "0" || !ends(*at) {
            continue;
        }
        let mut depth = 0;
        let end = directives[place + 1..].iter().find(|other| {
            let is_end = depth == 0 && matches!(word(**other, 1), "else" | "elif" | "endif");
            match word(**other, 1) {
                "if" | "ifdef" | "ifndef" => depth += 1,
                "endif" => depth -= 1,
                _ => {}
            }
            is_end
        });
        edits.extend(end.map(|end| blank(text, all[at + 2].bytes.end..all[*end].bytes.start)));
    }
    edits
}

/// Names that toy.glsl or GLSL 4.60 uses otherwise.
fn words(all: &[Token<'_>], has_main: bool) -> Vec<Edit> {
    let own = |(at, token): (usize, &Token<'_>)| {
        let is_macro = || at > 0 && ["define", "undef", "ifdef", "ifndef"].contains(&all[at - 1].text);
        let ends = |next: &Token<'_>| next.kind != TokenKind::Word || token.in_directive && !next.in_directive;
        let is_name = || is_macro() || all.get(at + 1).is_none_or(ends);
        match token.text {
            "main" => has_main.then(|| "Main".to_owned()),
            // A qualifier or a type comes before another word.
            word if NAMES_OF_ES.contains(&word) => is_name().then(|| renamed(word)),
            word => WEBGL.iter().find(|(name, _)| *name == word).map(|(_, own)| (*own).to_owned()),
        }
        .map(|own| (token.bytes.clone(), own))
    };
    all.iter().enumerate().filter_map(own).collect()
}

/// `gl_FragData[0]`, which is `gl_FragColor` under another name.
fn first_output(all: &[Token<'_>]) -> Vec<Edit> {
    let is = |at: usize| (0..4).all(|part| all[at + part].text == ["gl_FragData", "[", "0", "]"][part]);
    let edit = |at: usize| (all[at].bytes.start..all[at + 3].bytes.end, "toyFragColor  ".to_owned());
    (0..all.len().saturating_sub(3)).filter(|at| is(*at)).map(edit).collect()
}

/// An argument for calls `F()` of macros `F(x)`: glslang counts none there, and C one that is empty.
fn empty_arguments(all: &[Token<'_>]) -> Vec<Edit> {
    let is = |at: usize, text: &str| all.get(at).is_some_and(|token| token.text == text);
    let with_one_parameter = |at: usize| {
        let touches = || all[at + 2].bytes.end == all[at + 3].bytes.start;
        all[at].kind == TokenKind::Directive && is(at + 1, "define") && is(at + 3, "(") && is(at + 5, ")") && touches()
    };
    let macros: Vec<&str> = (0..all.len()).filter(|at| with_one_parameter(*at)).map(|at| all[at + 2].text).collect();
    let is_empty = |at: &usize| macros.contains(&all[*at].text) && is(at + 1, "(") && is(at + 2, ")");
    let edit = |at: usize| (all[at + 2].bytes.start..all[at + 2].bytes.start, NOTHING.to_owned());
    if macros.is_empty() { Vec::new() } else { (0..all.len()).filter(is_empty).map(edit).collect() }
}

/// Declarations that the stage replaces, and default precisions, which WebGL needs and Vulkan ignores.
fn replaced_declarations(text: &str, code: &[Token<'_>]) -> Vec<Edit> {
    let mut edits = Vec::new();
    for (at, _) in code.iter().enumerate().filter(|(_, token)| token.text == "precision") {
        if let Some(end) = code[at..].iter().find(|token| token.text == ";") {
            edits.push(blank(text, code[at].bytes.start..end.bytes.end));
        }
    }
    for declaration in declarations(code) {
        let is_replaced = |name: &str| is_built_in(name) && !has_texture(text, name);
        let mut names = declaration.names.iter().map(|name| name.text);
        let is_gone = declaration.storage == Storage::Output || names.all(is_replaced);
        if is_gone || declaration.is_moved() {
            edits.push(blank(text, declaration.bytes.clone()));
        } else if !declaration.is_opaque() {
            // It becomes a variable.
            edits.push(blank(text, declaration.qualifiers.clone()));
        }
        // Its slider is declared elsewhere.
        let note = declaration.note(text).map(|note| note.start - "//@ui".len());
        edits.extend(note.map(|start| (start..start + "//@".len(), "// ".to_owned())));
    }
    edits
}

#[cfg(test)]
mod tests {
    use super::super::declared::outputs;
    use super::*;

    #[test]
    fn lines_and_columns_stay() {
        let text = "#version 300 es\nprecision highp float;\nuniform vec2 u_resolution;\nout vec4 shown;\n\
                    void main() { shown = vec4(gl_FragCoord.xy, main_, 1.0); }\n";
        let found = adapted(text, "image");
        assert_eq!(found.lines().count(), text.lines().count());
        assert_eq!(found.lines().last(), Some("void Main() { shown = vec4(toyFragCoord.xy, main_, 1.0); }"));
        let is_code = |line: &&str| !line.trim().is_empty() && !line.starts_with("//");
        assert_eq!(found.lines().filter(is_code).count(), 1, "{found}");
        assert_eq!(outputs(&code(text)), ["shown"]);
    }

    #[test]
    fn channels_name_files() {
        let text = "#iChannel0 \"file://./a.png\"\n#iChannel1 \"self\"\n  #iChannel2 \"blur.glsl\"\n\
                    #iChannel0::WrapMode \"Repeat\"\n#iChannel7 \"x.png\"\n#iChannel3 \"file://keyboard\"\n#iKeyboard\n";
        let found: Vec<(usize, Channel)> = channels(text);
        let expected = [
            (0, Channel::Image("a.png".into(), samplers(text)[0].clone())),
            (1, Channel::This),
            (2, Channel::Drawing("blur.glsl".into())),
            (3, Channel::Keyboard),
        ];
        assert_eq!(found, expected);
        assert_eq!(named_files(text), ["a.png", "blur.glsl"]);
        let found = adapted(text, "image");
        assert!(found.starts_with("//@texture image_channel0 \"a.png\" linear mips flip\n"), "{found}");
        assert!(found.lines().take(7).all(|line| line.starts_with("//")), "{found}");
    }

    #[test]
    fn channels_are_cube_maps_and_volumes() {
        let text = "#iChannel0 \"file://sky/day_{}.png\"\n#iChannel0::Type \"CubeMap\"\n\
                    #iChannel1::Type \"Volume\"\n#iChannel1 \"noise.png\"\n";
        let found = adapted(text, "image");
        let lines: Vec<&str> = found.lines().collect();
        assert_eq!(lines[0], "//@texture image_channel0 \"sky/day_*.png\" linear mips clamp");
        assert_eq!(lines[3], "//@texture image_channel1 \"noise.png\" linear mips");
        assert!(lines[1].starts_with("//#") && lines[2].starts_with("//#"), "{found}");
        assert_eq!(named_files(text), ["sky/day_*.png", "noise.png"]);
    }

    #[test]
    fn channels_have_filters_and_wrap_modes() {
        let options =
            |more: &str| adapted(&format!("#iChannel0 \"a.png\"\n{more}"), "p").lines().next().unwrap().to_owned();
        let line = |options: &str| format!("//@texture p_channel0 \"a.png\" linear {options}flip");
        for (more, expected) in [
            ("#iChannel0::WrapMode \"Clamp\"", "mips clamp "),
            ("#iChannel0::WrapMode \"Mirror\"", "mips mirror "),
            ("#iChannel0::MinFilter \"Linear\"", ""),
            ("#iChannel0::MinFilter \"NearestMipMapLinear\"", "mips min=nearest "),
            ("#iChannel0::MinFilter \"Nearest\"\n#iChannel0::MagFilter \"Nearest\"", "min=nearest mag=nearest "),
        ] {
            assert_eq!(options(more), line(expected), "{more}");
        }
    }

    #[test]
    fn names_of_es_stay_names() {
        let text = "struct S { float sample; };\nfloat buffer(float filter, sampler2D sampler) { return filter; }\n\
                    void f() { S s; s.sample = buffer(1.0, x) ; }\n";
        let found = adapted(text, "image");
        assert_eq!(found.len(), text.len());
        for word in ["sample", "buffer", "filter", "sampler"] {
            assert!(find_word(&found, word).is_none(), "{word}: {found}");
        }
        let macros = "#ifndef texture2D\n#define texture2D texture\n#endif\n#define T texture2D\nvec4 x = T(a, b);\n";
        let found = adapted(macros, "image");
        assert_eq!(found, macros.replace("texture2D", "texture2_"));
        assert_eq!(with_names("'sampl_' : no such field"), "'sample' : no such field");
        let qualifiers = "shared float x;\nprecise float y;\nbuffer B { float z; };\n";
        assert_eq!(adapted(qualifiers, "image"), qualifiers);
    }

    #[test]
    fn text_that_is_never_compiled_is_blank() {
        let text = "#if 0\n3d \"\n#if A\nb\n#else\n#endif\n#else // c\nfloat d;\n#endif\n#if 0 + 1\ne\n#endif\n";
        let found = adapted(text, "image");
        let lines: Vec<&str> = found.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
        assert_eq!(lines, ["#if 0", "#else // c", "float d;", "#endif", "#if 0 + 1", "e", "#endif"]);
        assert_eq!(found.len(), text.len());
        let versions = [("void main() {}", 100), ("// a\n#version 330 core\n", 330), ("void mainImage(", 300)];
        versions.iter().for_each(|(text, expected)| assert_eq!(version(text), *expected, "{text}"));
    }

    #[test]
    fn a_macro_may_be_called_with_an_empty_argument() {
        let text = "#define F(x) 1.0 x\n#define G() 2.0\n#define H (1.0)\nfloat a = F() + F(+ 1.0) + G();\n";
        assert_eq!(adapted(text, "image").lines().last(), Some("float a = F(toy_nothing) + F(+ 1.0) + G();"));
    }

    #[test]
    fn uniforms_and_varyings_become_variables() {
        let text = "uniform float speed; //@ui \"Speed\" 0..2 = 1\nlayout(location = 1) uniform highp vec2 mouse, other[2];\n\
                    varying vec2 vUv;\nuniform float iTime;\nuniform sampler2D picture;\nuniform Sliders { float x; };\n";
        let found = adapted(text, "image");
        let lines: Vec<&str> = found.lines().map(str::trim).collect();
        assert_eq!(lines[..4], ["// ui \"Speed\" 0..2 = 1", "highp vec2 mouse, other[2];", "", ""]);
        assert_eq!(lines[4..], ["uniform sampler2D picture;", "uniform Sliders { float x; };"]);
    }
}
