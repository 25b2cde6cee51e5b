//! Opens files in the user's editor, at a line.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Editors with windows of their own, and how each takes a position. Those of a terminal have no place to open in.
const EDITORS: [(&str, &str); 15] = [
    ("code", "-g {file}:{line}:{column}"),
    ("codium", "-g {file}:{line}:{column}"),
    ("cursor", "-g {file}:{line}:{column}"),
    ("zed", "{file}:{line}:{column}"),
    ("zeditor", "{file}:{line}:{column}"),
    ("subl", "{file}:{line}:{column}"),
    ("idea", "--line {line} --column {column} {file}"),
    ("clion", "--line {line} --column {column} {file}"),
    ("rustrover", "--line {line} --column {column} {file}"),
    ("kate", "-l {line} -c {column} {file}"),
    ("gvim", "+{line} {file}"),
    ("emacsclient", "-n +{line}:{column} {file}"),
    ("gedit", "+{line}:{column} {file}"),
    ("mate", "-l {line}:{column} {file}"),
    ("geany", "--line={line} --column={column} {file}"),
];

/// A place in a file. Line and column count from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) file: PathBuf,
    pub(super) line: Option<u32>,
    pub(super) column: Option<u32>,
}

/// Opens a place in the editor of `$SPECULA_EDITOR`, `$VISUAL` or `$EDITOR`, or in the first known one that is installed. Does not
/// wait for the editor.
///
/// # Errors
/// A message, if there is no editor with a window of its own, or if it does not start.
pub(super) fn open(place: &Place) -> Result<(), String> {
    let of = |name: &str| std::env::var(name).ok().filter(|value| !value.trim().is_empty());
    let is_installed = |program: &str| {
        let folders = std::env::var_os("PATH").unwrap_or_default();
        std::env::split_paths(&folders).any(|folder| folder.join(program).is_file())
    };
    let choice = [of("VISUAL"), of("EDITOR")];
    // A name that begins with `-` or `+` would be an option.
    let file = std::path::absolute(&place.file).unwrap_or_else(|_| place.file.clone());
    let place = &Place { file, ..place.clone() };
    let Some(words) = command(of("SPECULA_EDITOR"), choice, is_installed, place) else {
        return Err("found no editor with a window of its own. Set SPECULA_EDITOR, for example to \
                    `code -g {file}:{line}:{column}`"
            .into());
    };
    let (program, arguments) = words.split_first().ok_or("SPECULA_EDITOR is empty")?;
    let mut command = Command::new(program);
    // Ctrl+C in the terminal ends Specula and leaves the editor.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut editor = command.spawn().map_err(|error| format!("the editor `{program}` did not start: {error}"))?;
    std::thread::spawn(move || editor.wait());
    Ok(())
}

/// Program and arguments. `own`: a command with or without places for the position. `choices`: what the user prefers elsewhere.
fn command(
    own: Option<String>,
    choices: [Option<String>; 2],
    is_installed: impl Fn(&str) -> bool,
    place: &Place,
) -> Option<Vec<String>> {
    if let Some(own) = own {
        let known = template(&own).filter(|_| !own.contains("{file}"));
        let rest = known.unwrap_or(if own.contains("{file}") { "" } else { "{file}" });
        return Some(filled(&format!("{own} {rest}"), place));
    }
    let preferred = choices.into_iter().flatten().find_map(|choice| Some((template(&choice)?, choice)));
    if let Some((template, choice)) = preferred {
        return Some(filled(&format!("{choice} {template}"), place));
    }
    let (program, template) = EDITORS.into_iter().find(|(program, _)| is_installed(program))?;
    Some(filled(&format!("{program} {template}"), place))
}

/// How the editor of a command takes a position, if it is known.
fn template(command: &str) -> Option<&'static str> {
    let program = Path::new(command.split_whitespace().next()?).file_stem()?.to_str()?;
    EDITORS.into_iter().find(|(name, _)| *name == program).map(|(_, template)| template)
}

/// The words of a command with the place filled in. Without a line, what names only a line goes.
fn filled(template: &str, place: &Place) -> Vec<String> {
    let file = place.file.display().to_string();
    let (line, column) = (place.line.unwrap_or(1).to_string(), place.column.unwrap_or(1).to_string());
    let mut words: Vec<&str> = template.split_whitespace().collect();
    if place.line.is_none()
        && let Some(program) = words.first().copied()
    {
        // A folder or a whole file: editors take it as their only argument.
        words.retain(|word| *word == program || word.contains("{file}"));
        words.iter_mut().filter(|word| word.contains("{file}")).for_each(|word| *word = "{file}");
    }
    let fill = |word: &str| word.replace("{line}", &line).replace("{column}", &column).replace("{file}", &file);
    words.into_iter().map(fill).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(line: Option<u32>) -> Place {
        Place { file: "my shaders/ndf.glsl".into(), line, column: line.map(|_| 7) }
    }

    fn words(own: Option<&str>, choices: [Option<&str>; 2], installed: &str, line: Option<u32>) -> Option<Vec<String>> {
        let choices = choices.map(|choice| choice.map(str::to_owned));
        command(own.map(str::to_owned), choices, |program| program == installed, &place(line))
    }

    #[test]
    fn the_position_is_given_as_each_editor_takes_it() {
        let at = |words: Option<Vec<String>>| words.map(|words| words.join("|"));
        let none = [None, None];
        assert_eq!(at(words(None, none, "code", Some(20))).unwrap(), "code|-g|my shaders/ndf.glsl:20:7");
        assert_eq!(at(words(None, none, "gvim", Some(20))).unwrap(), "gvim|+20|my shaders/ndf.glsl");
        assert_eq!(at(words(None, none, "code", None)).unwrap(), "code|my shaders/ndf.glsl");
        assert_eq!(at(words(None, none, "nano", Some(20))), None);
        // What the user prefers comes first, if it has a window of its own.
        let prefers = [Some("/usr/bin/subl -w"), Some("vim")];
        assert_eq!(at(words(None, prefers, "code", Some(20))).unwrap(), "/usr/bin/subl|-w|my shaders/ndf.glsl:20:7");
        let terminal = [Some("vim"), Some("nano")];
        assert_eq!(at(words(None, terminal, "kate", Some(20))).unwrap(), "kate|-l|20|-c|7|my shaders/ndf.glsl");
        // A command of the user's own is taken as it is.
        assert_eq!(
            at(words(Some("ed {line} {file}"), prefers, "code", Some(20))).unwrap(),
            "ed|20|my shaders/ndf.glsl"
        );
        assert_eq!(at(words(Some("ed"), prefers, "code", Some(20))).unwrap(), "ed|my shaders/ndf.glsl");
        assert_eq!(at(words(Some("zed -n"), none, "code", Some(20))).unwrap(), "zed|-n|my shaders/ndf.glsl:20:7");
    }
}
