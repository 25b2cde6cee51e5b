//! Changes the text of an opened file so that it compiles in a pass. Each line keeps its number.

use super::channel::{Channel, channel, channels, samplers};
use crate::shader::glsl::{TokenKind, code, find_word, includes, lines, tokens};

/// The file, beside a toy, that all its files share. Files that these include count as parts of it.
pub(super) const COMMON: &str = "common";

/// The line that declares functions about keys. The form is that of editors' Shadertoy extensions.
pub(super) const KEY_FUNCTIONS: &str = "#iKeyboard";

/// The uniforms of glslViewer and of the Book of Shaders, which toy.glsl defines.
const UNIFORMS: [&str; 6] = ["u_time", "u_delta", "u_frame", "u_date", "u_resolution", "u_mouse"];
/// Names that a shader of OpenGL uses, with names of the same length that toy.glsl defines.
const OPENGL: [(&str, &str); 2] = [("gl_FragCoord", "toyFragCoord"), ("gl_FragColor", "toyFragColor")];

/// Whether a text has Shadertoy's form.
pub(super) fn is_shadertoy(text: &str) -> bool {
    uses(text, "mainImage")
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

/// The names of the outputs that a text declares.
pub(super) fn outputs(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter(|line| is_replaced(line)).filter_map(|line| {
        let tokens = code(line);
        let declared = tokens.split(|token| token.text == ";").next()?;
        let is_output = declared.iter().any(|token| token.text == "out");
        declared.last().filter(|_| is_output).map(|name| name.text)
    })
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
    let is_shadertoy = is_shadertoy(text);
    let has_main = !is_shadertoy && uses(text, "main");
    let samplers = samplers(text);
    let mut out = String::with_capacity(text.len() + 64);
    for line in text.split_inclusive('\n') {
        match channel(line).map(|(number, channel)| (number, channel.with(samplers[number]))) {
            Some((number, Channel::Image(file, sampler))) => {
                let name = texture_name(pass, number);
                out += &format!("//@texture {name} \"{file}\" {}\n", sampler.options());
            }
            Some(_) => out += &format!("//{line}"),
            None if is_replaced(line) => out += &format!("//{line}"),
            None => out += &with_own_names(line, has_main),
        }
    }
    out
}

/// Whether the stage says this instead: a version, a uniform of toy.glsl, an input or output, or a channel's further line.
fn is_replaced(line: &str) -> bool {
    let words: Vec<&str> =
        tokens(line).filter(|token| token.kind != TokenKind::Comment).map(|token| token.text).collect();
    let is_global = || words.ends_with(&[";"]) && (words[0] == "layout" || !words.contains(&"("));
    match words.as_slice() {
        ["#", word, ..] => ["version", "iChannel", "iKeyboard"].iter().any(|known| word.starts_with(known)),
        ["uniform", ..] => words.iter().any(|word| UNIFORMS.contains(word)),
        ["varying", ..] => true,
        ["in" | "out", ..] => is_global(),
        ["layout", ..] => is_global() && words.contains(&"out"),
        _ => false,
    }
}

/// The line with names that toy.glsl gives to what Vulkan has not, or has otherwise. They are as long as those of the file.
fn with_own_names(line: &str, has_main: bool) -> String {
    let main = has_main.then_some(("main", "Main"));
    OPENGL.iter().copied().chain(main).fold(line.to_owned(), |line, (from, to)| {
        let mut line = line;
        while let Some(range) = find_word(&line, from) {
            line.replace_range(range, to);
        }
        line
    })
}

#[cfg(test)]
mod tests {
    use super::super::channel::Sampler;
    use super::*;

    #[test]
    fn lines_and_columns_stay() {
        let text = "#version 300 es\nprecision highp float;\nuniform vec2 u_resolution;\nout vec4 shown;\n\
                    void main() { shown = vec4(gl_FragCoord.xy, main_, 1.0); }\n";
        let found = adapted(text, "image");
        assert_eq!(found.lines().count(), text.lines().count());
        assert_eq!(found.lines().last(), Some("void Main() { shown = vec4(toyFragCoord.xy, main_, 1.0); }"));
        assert_eq!(found.lines().filter(|line| line.starts_with("//")).count(), 3);
        assert_eq!(outputs(text).collect::<Vec<_>>(), ["shown"]);
    }

    #[test]
    fn channels_name_files() {
        let text = "#iChannel0 \"file://./a.png\"\n#iChannel1 \"self\"\n  #iChannel2 \"blur.glsl\"\n\
                    #iChannel0::WrapMode \"Repeat\"\n#iChannel7 \"x.png\"\n#iChannel3 \"file://keyboard\"\n#iKeyboard\n";
        let expected = [
            (0, Channel::Image("a.png".into(), Sampler::Flat)),
            (1, Channel::This),
            (2, Channel::Drawing("blur.glsl".into())),
            (3, Channel::Keyboard),
        ];
        assert_eq!(channels(text), expected);
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
}
