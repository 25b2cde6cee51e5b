//! Errors in the lines of a toy that GLSL does not have, as `#iChannel0 "file"`. Each has the author's line, with the caret under
//! the word that is wrong.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

use super::adapt::{KEY_FUNCTIONS, uses};
use super::beside::{is_there, not_found};
use super::channel::{CHANNELS, Channel, Kind, OPTIONS, Sampler, channel, channels, samplers};
use crate::message::{did_you_mean, either};
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::{Line, find_word, is_same_code, is_word, lines};
use crate::shader::source::TreePath;

/// Shadertoy's entry point.
pub(super) const MAIN_IMAGE: &str = "void mainImage(out vec4 fragColor, in vec2 fragCoord)";
/// Shadertoy's entry points that Specula does not run.
const OTHER_ENTRIES: [(&str, &str); 3] = [
    ("mainCubemap", "Specula draws no cube maps; `#iChannel0 \"sky_{}.png\"` reads one from six files"),
    ("mainSound", "Specula plays no sound"),
    ("mainVR", "Specula draws no stereo pictures"),
];

const CHANNEL: &str = "#iChannel";
/// The directives of GLSL that begin with the same letter.
const DIRECTIVES: [&str; 4] = ["#if", "#ifdef", "#ifndef", "#include"];

/// An error in a line: the bytes for the caret, a message, and a help text that may be empty.
type Problem = (Range<usize>, String, String);

/// The errors of a text. `shown`: the path of its file, for messages; `folder`: what its names are relative to.
pub(super) fn problems(shown: &str, text: &str, folder: &Path) -> Vec<Diagnostic> {
    let own = shown.rsplit('/').next().unwrap_or_default();
    let known = Known { channels: channels(text), samplers: samplers(text), folder, own };
    let mut first: BTreeMap<usize, u32> = BTreeMap::new();
    let mut out = Vec::new();
    for line in lines(text).iter().filter(|line| line.code.trim_start().starts_with("#i")) {
        let start = line.code.len() - line.code.trim_start().len();
        let found = match line.raw[start..].starts_with(CHANNEL) {
            true => known.channel_line(line.raw, start),
            false => unknown_directive(line, start),
        };
        let error = |(bytes, message, help): Problem| {
            let error = Diagnostic::error(shown, message).on_line(line.number, Some(line.raw)).under(bytes);
            if help.is_empty() { error } else { error.with_help(help) }
        };
        out.extend(found.err().map(error));
        if let Some((number, _)) = channel(line.raw)
            && let Some(other) = first.insert(number, line.number)
        {
            let message = format!("line {other} has named the image of iChannel{number} already");
            let bytes = start..start + CHANNEL.len() + 1;
            out.push(error((bytes, message, "leave out one of the two lines".to_owned())));
        }
    }
    out
}

/// The error of a file that has no entry point.
pub(super) fn without_entry(shown: &str, text: &str) -> Diagnostic {
    let is_empty = if is_same_code(text, "") { "the file is empty: " } else { "" };
    let message = format!("{is_empty}expected `{MAIN_IMAGE}` or `void main()`");
    let error = Diagnostic::error(shown, message);
    match OTHER_ENTRIES.iter().find(|(name, _)| uses(text, name)) {
        Some((name, help)) => error.with_help(format!("this file has `{name}`: {help}")),
        None => error,
    }
}

/// The warning about a sampler that reads black.
pub(super) fn black(shown: &str, text: &str, name: &str) -> Diagnostic {
    let found = lines(text).into_iter().find_map(|line| Some((find_word(&line.code, name)?, line)));
    let warning = Diagnostic::warning(shown, format!("nothing gives the image `{name}`, so it is black"))
        .with_help(format!("name its file on a line of its own: `//@texture {name} \"image.png\"`"));
    match found {
        Some((bytes, line)) => warning.on_line(line.number, Some(line.raw)).under(bytes),
        None => warning,
    }
}

/// Channels and samplers that a text declares.
struct Known<'a> {
    channels: Vec<(usize, Channel)>,
    samplers: [Sampler; CHANNELS],
    folder: &'a Path,
    /// The name of the file.
    own: &'a str,
}

impl Known<'_> {
    /// Checks a line `#iChannel...` that begins at byte `start`.
    fn channel_line(&self, raw: &str, start: usize) -> Result<(), Problem> {
        let digits = start + CHANNEL.len();
        let end = digits + raw[digits..].find([':', '"', ' ', '\t']).unwrap_or(raw[digits..].trim_end().len());
        let number = raw[digits..end].parse().ok().filter(|number: &usize| *number < CHANNELS && end - digits == 1);
        let Some(number) = number else {
            let message =
                format!("there is no `{}`; a shader has iChannel0 to iChannel{}", &raw[start + 1..end], CHANNELS - 1);
            return Err((start + 1..end, message, String::new()));
        };
        if raw[end..].starts_with(':') {
            return self.option(raw, end, number);
        }
        let example = format!("write it as `#iChannel{number} \"bricks.png\"`");
        let name = quoted(raw, end, &raw[start..end], &example)?;
        self.name(number, raw, name)
    }

    /// Checks `::Type "CubeMap"`, which begins at byte `start`.
    fn option(&self, raw: &str, start: usize, number: usize) -> Result<(), Problem> {
        let begin = start + raw[start..].len() - raw[start..].trim_start_matches(':').len();
        let end = begin + raw[begin..].find(|c| !is_word(c)).unwrap_or(raw[begin..].len());
        let option = &raw[begin..end];
        let names = OPTIONS.map(|(name, _)| name);
        let Some((_, values)) = OPTIONS.iter().find(|(name, _)| *name == option).filter(|_| begin - start == 2) else {
            let hint = did_you_mean(option, names);
            let message = format!("expected `::` and {}, found `{}`.{hint}", either(&names), &raw[start..end]);
            return Err((start..end, message, String::new()));
        };
        let quotes: Vec<String> = values.iter().map(|name| format!("\"{name}\"")).collect();
        let either = either(&quotes);
        let bytes = quoted(raw, end, &format!("::{option}"), &format!("it is {either}"))?;
        let name = &raw[bytes.clone()];
        if !values.iter().any(|known| known.eq_ignore_ascii_case(name)) {
            let hint = did_you_mean(name, values.iter().copied());
            return Err((visible(&bytes), format!("expected {either}, found \"{name}\".{hint}"), String::new()));
        }
        let is_image = |(other, channel): &(usize, Channel)| *other == number && matches!(channel, Channel::Image(..));
        let is_several = option == "Type" && self.samplers[number].kind != Kind::Flat;
        if is_several && !self.channels.iter().any(is_image) {
            let message = format!("iChannel{number} names no image file, so it cannot be a {name}");
            let help = format!("name the files on a line of its own: `#iChannel{number} \"sky_{{}}.png\"`");
            return Err((bytes, message, help));
        }
        Ok(())
    }

    /// Checks the name of a channel's image.
    fn name(&self, number: usize, raw: &str, bytes: Range<usize>) -> Result<(), Problem> {
        let name = &raw[bytes.clone()];
        let refuse = |message: String, help: &str| Err((visible(&bytes), message, help.to_owned()));
        if name.trim().is_empty() {
            let message = "expected the name of an image or a shader file, \"self\" or \"keyboard\"";
            return refuse(message.to_owned(), "\"self\" is what this file drew one frame ago");
        }
        let file = match channel(raw) {
            Some((_, Channel::Drawing(file) | Channel::Image(file, _))) => file,
            _ => return Ok(()),
        };
        if file.contains("://") {
            let help = "save the image beside this file, and write its name here";
            return refuse("expected a file in the folder of this one, found an address".to_owned(), help);
        }
        if TreePath::parse(&file).is_none() {
            let help = "copy the file there; names are relative to the folder of this file";
            return refuse(format!("\"{name}\" lies outside the folder of this file"), help);
        }
        let several = file.matches("{}").count() + file.matches('*').count();
        let is_in_folder =
            several > 0 && !file.rsplit('/').next().is_some_and(|last| last.contains("{}") || last.contains('*'));
        if several > 1 || is_in_folder {
            let help = "the `{}` stands for the faces or slices; the name of a folder is written out";
            return refuse(format!("\"{name}\": expected one `{{}}`, in the name of the file"), help);
        }
        if several == 1 && self.samplers[number].kind == Kind::Flat {
            let message = "a `{}` stands for several files, but nothing says which kind of image they make";
            let help = format!(
                "add a line `#iChannel{number}::Type \"CubeMap\"` for six faces, or `#iChannel{number}::Type \"Volume\"` for slices"
            );
            return refuse(message.to_owned(), &help);
        }
        if self.folder.join(&file).is_dir() {
            return refuse(format!("\"{name}\" is a folder; expected an image or a shader file"), "");
        }
        if is_there(self.folder, &file.replacen("{}", "*", 1)) {
            return Ok(());
        }
        let (message, help) = not_found(self.folder, self.own, name, &file);
        refuse(message, &help)
    }
}

/// The bytes to mark for a name, which may be empty: then its quotes.
fn visible(name: &Range<usize>) -> Range<usize> {
    if name.is_empty() { name.start - 1..name.end + 1 } else { name.clone() }
}

/// The bytes between the quotes that come next. `after`: what comes before them, for messages.
fn quoted(raw: &str, at: usize, after: &str, help: &str) -> Result<Range<usize>, Problem> {
    let start = at + raw[at..].len() - raw[at..].trim_start().len();
    let line = raw.trim_end().len();
    let Some(rest) = raw[start..].strip_prefix('"') else {
        let end = start + raw[start..].find(char::is_whitespace).unwrap_or(raw.len() - start);
        let (bytes, found) = match raw.get(start..end).filter(|word| !word.is_empty()) {
            Some(word) => (start..end, format!("`{word}`")),
            None => (line..line, "the end of the line".to_owned()),
        };
        return Err((bytes, format!("expected a name in quotes after `{after}`, found {found}"), help.to_owned()));
    };
    let Some(length) = rest.find('"') else {
        return Err((start..line, "expected a closing quote".to_owned(), String::new()));
    };
    let bytes = start + 1..start + 1 + length;
    let more = raw[bytes.end + 1..].trim();
    if !(more.is_empty() || more.starts_with("//") || more.starts_with("/*")) {
        let from = line - more.len();
        return Err((
            from..line,
            format!("expected the end of the line after the name, found `{more}`"),
            String::new(),
        ));
    }
    Ok(bytes)
}

/// Refuses a directive that only some editors have, or that is misspelled.
fn unknown_directive(line: &Line<'_>, start: usize) -> Result<(), Problem> {
    let code = &line.code[start..];
    let end = 1 + code[1..].find(|c| !is_word(c)).unwrap_or(code.len() - 1);
    let word = &code[..end];
    if DIRECTIVES.contains(&word) || word == KEY_FUNCTIONS {
        return Ok(());
    }
    if word == "#iUniform" {
        let help = "write a uniform block instead, whose members have sliders:\n\
            uniform Sliders {\n    float speed;   //@ui \"Speed\" 0..1 = 0.5\n};";
        return Err((start..start + end, "Specula does not know `#iUniform`".to_owned(), help.to_owned()));
    }
    let hint = did_you_mean(word, [KEY_FUNCTIONS, "#iChannel0", "#include", "#ifdef", "#ifndef"]);
    Err((start..start + end, format!("unknown directive `{word}`.{hint}"), String::new()))
}

#[cfg(test)]
#[path = "problem_tests.rs"]
mod tests;
