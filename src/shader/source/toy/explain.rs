//! Turns a diagnostic about the text that is compiled into one about the author's file: with the author's line, names and words.

use std::ops::Range;
use std::path::Path;

use super::adapt::{COMMON, has_key_functions, uses, with_names};
use super::channel::{CHANNELS, Channel, Kind, Sampler, channel, channels, samplers};
use super::declared::outputs;
use super::problems::MAIN_IMAGE;
use super::{SLIDERS, STAGES, Toy, below, slashes};
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::{code, find_word, lines};

/// The functions that `#iKeyboard` declares, and the beginning of its keys' names, as the compiler quotes them.
const OF_KEYS: [&str; 4] = ["'isKeyDown'", "'isKeyPressed'", "'isKeyToggled'", "'Key_"];

/// The help for an error about a channel that a function takes as a cube map or a volume.
fn help_with_channel(diagnostic: &Diagnostic, text: &str) -> Option<String> {
    let is_call = diagnostic.message.ends_with("no matching overloaded function found");
    let line = diagnostic.excerpt.as_deref().filter(|_| is_call)?;
    let kinds = Kind::NAMES.iter().filter(|(_, kind)| *kind != Kind::Flat);
    let (name, kind) = kinds.into_iter().find(|(_, kind)| uses(text, kind.glsl()))?;
    let named = channels(text);
    let number = (0..CHANNELS).find(|number| {
        line.contains(&format!("iChannel{number}")) && named.iter().all(|(channel, _)| channel != number)
    })?;
    Some(format!(
        "nothing names iChannel{number}, so it is noise in a sampler2D; for a {} write `#iChannel{number} \"NAME_{{}}.png\"` and \
         `#iChannel{number}::Type \"{name}\"`",
        kind.glsl()
    ))
}

impl Toy {
    /// The diagnostic as the author of the file should see it. Those about other files stay as they are.
    pub fn explained(&self, diagnostic: Diagnostic) -> Diagnostic {
        if let Some(stage) = diagnostic.file.strip_prefix("embedded:").and_then(|path| below(path, STAGES)) {
            let drawings = self.drawings();
            let drawing = drawings.into_iter().find(|drawing| stage.strip_suffix(".frag") == Some(&drawing.pass));
            return drawing.map_or(diagnostic.clone(), |drawing| {
                let file = self.folder().join(&drawing.file).display().to_string();
                without_body(Diagnostic { file, line: None, column: None, excerpt: None, ..diagnostic }, &drawing.text)
            });
        }
        if diagnostic.file.strip_prefix("embedded:") == Some(SLIDERS) {
            return self.of_slider(&diagnostic).unwrap_or(diagnostic);
        }
        let Some(file) = Path::new(&diagnostic.file).strip_prefix(self.folder()).ok().and_then(slashes) else {
            return diagnostic;
        };
        let Ok(text) = self.own_text(&file) else { return diagnostic };
        let pass = self.drawings().into_iter().find(|drawing| drawing.file == file).map(|drawing| drawing.pass);
        let pass = pass.as_deref().unwrap_or(COMMON);
        self.with_help(without_body(with_words(quoted(diagnostic, &text, pass), &text), &text), &text)
    }

    /// A diagnostic about the `//@ui` of a slider at the line of the uniform that the author has written.
    fn of_slider(&self, diagnostic: &Diagnostic) -> Option<Diagnostic> {
        let written = diagnostic.excerpt.as_deref()?;
        let note = written.find("//@ui")?;
        let name = code(&written[..note]).get(1)?.text;
        let column = (diagnostic.column? as usize).checked_sub(1)?;
        let from = written.char_indices().nth(column).map_or(written.len(), |(at, _)| at);
        let length: usize = written[from..].chars().take(diagnostic.length as usize).map(char::len_utf8).sum();
        self.watched().into_iter().find_map(|path| {
            let text = self.own_text(&slashes(path.strip_prefix(self.folder()).ok()?)?).ok()?;
            let all = lines(&text);
            let is_it = |raw: &str| raw.find(&written[note..]).filter(|at| find_word(&raw[..*at], name).is_some());
            let (line, at) = all.iter().find_map(|line| Some((line, is_it(line.raw)?)))?;
            let moved = Diagnostic { file: path.display().to_string(), ..diagnostic.clone() };
            let begin = (at + from).checked_sub(note)?;
            Some(moved.on_line(line.number, Some(line.raw)).under(begin..begin + length))
        })
    }

    fn with_help(&self, diagnostic: Diagnostic, text: &str) -> Diagnostic {
        let message = &diagnostic.message;
        if OF_KEYS.iter().any(|word| message.contains(word)) {
            let has_keys = has_key_functions(text) || self.common().is_some_and(|(_, text)| has_key_functions(&text));
            let help = "write `#iKeyboard` on a line of its own: it declares isKeyDown, isKeyPressed and isKeyToggled, and the \
                        keys, as Key_A and Key_LeftArrow";
            return if has_keys { diagnostic } else { diagnostic.with_help(help) };
        }
        if message.starts_with("'gl_Position'") {
            return diagnostic
                .with_help("this is a vertex shader; Specula opens a fragment shader alone, without a tree");
        }
        let channel = message.strip_prefix("'iChannel").and_then(|rest| rest.split('\'').next()?.parse::<usize>().ok());
        if channel.is_some_and(|number| number >= CHANNELS) {
            return diagnostic.with_help("there are iChannel0 to iChannel3");
        }
        if let Some(help) = help_with_channel(&diagnostic, text) {
            return diagnostic.with_help(help);
        }
        // Hide built-in passes from messages about Shadertoy files.
        let unknown = message.strip_prefix("no pass or texture is named `").and_then(|rest| rest.split('`').next());
        if let Some(name) = unknown.map(str::to_owned) {
            let message = format!("nothing gives the image `{name}`");
            let help = format!("name its file on a line of its own: `//@texture {name} \"image.png\"`");
            return Diagnostic { message, ..diagnostic }.with_help(help);
        }
        diagnostic
    }
}

/// The diagnostic with the author's line.
fn quoted(diagnostic: Diagnostic, text: &str, pass: &str) -> Diagnostic {
    let line = diagnostic.line.and_then(|line| text.lines().nth((line as usize).checked_sub(1)?));
    let Some(line) = line.filter(|line| diagnostic.excerpt.as_deref() != Some(*line)) else { return diagnostic };
    let diagnostic = marked(diagnostic, line);
    let Some((number, Channel::Image(file, _))) = channel(line) else { return diagnostic };
    // The compiled line is an annotation, whose words the author has not written.
    let adapted = Channel::Image(file.clone(), Sampler::default()).with(&samplers(text)[number]);
    let Channel::Image(adapted, _) = adapted else { return diagnostic };
    let message = diagnostic.message.replace(&super::adapt::texture_name(pass, number), &format!("iChannel{number}"));
    let message = message.replace(&format!(" and embedded:{adapted}"), "");
    let message = if adapted == file { message } else { message.replace(&adapted, &file).replace("`*`", "`{}`") };
    let diagnostic = Diagnostic { message, ..diagnostic };
    match name_in(line) {
        Some(bytes) => diagnostic.under(bytes),
        None => diagnostic,
    }
}

/// The diagnostic about a compiled line at the author's `line`, with the caret under the same word. What was inserted moves it.
fn marked(diagnostic: Diagnostic, line: &str) -> Diagnostic {
    let compiled = diagnostic.excerpt.clone().unwrap_or_default();
    let at = Diagnostic { excerpt: Some(line.to_owned()), ..diagnostic };
    let Some(column) = at.column.filter(|_| compiled.chars().count() != line.chars().count()) else { return at };
    let word: String = compiled.chars().skip(column as usize - 1).take(at.length as usize).collect();
    match find_word(line, &with_names(&word)) {
        Some(bytes) => at.under(bytes),
        None => Diagnostic { column: None, length: 0, ..at },
    }
}

/// The bytes between the quotes of a line.
fn name_in(line: &str) -> Option<Range<usize>> {
    let start = line.find('"')? + 1;
    let length = line[start..].find('"').filter(|length| *length > 0)?;
    Some(start..start + length)
}

/// The message with the names that the author has written.
fn with_words(diagnostic: Diagnostic, text: &str) -> Diagnostic {
    let color = outputs(&code(text)).first().copied().unwrap_or("gl_FragColor");
    let message = with_names(&diagnostic.message.replace("toyFragColor", color));
    Diagnostic { message, ..diagnostic }
}

/// The linker's message about an entry point with other arguments, at the line of the entry point.
fn without_body(diagnostic: Diagnostic, text: &str) -> Diagnostic {
    let is_main = diagnostic.notes.iter().any(|note| note.starts_with("mainImage("));
    let found = lines(text).into_iter().find_map(|line| Some((find_word(&line.code, "mainImage")?, line)));
    let Some((bytes, line)) = found.filter(|_| is_main) else { return diagnostic };
    let diagnostic = Diagnostic { message: format!("expected `{MAIN_IMAGE}`"), notes: Vec::new(), ..diagnostic };
    diagnostic.on_line(line.number, Some(line.raw)).under(bytes)
}
