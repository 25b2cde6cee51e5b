//! Opens files in the user's editor, at a line.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Editors with windows of their own, and how each takes a position. Terminal editors would have no terminal to run in.
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

/// An editor that ends with an error later than this has opened the file.
const OPENING: Duration = Duration::from_secs(10);

/// A started editor.
#[derive(Debug)]
pub(super) struct Editor {
    program: String,
    process: Child,
    start: Instant,
}

impl Editor {
    /// Waits until the editor ends. Returns a message if it failed to open the file.
    pub(super) fn failure(mut self) -> Option<String> {
        let status = self.process.wait().ok()?;
        let is_failure = !status.success() && self.start.elapsed() < OPENING;
        is_failure.then(|| {
            format!(
                "the editor `{}` ended with {status} and did not open the file. Set SPECULA_EDITOR to use another editor",
                self.program
            )
        })
    }
}

/// Opens a place in the editor of `$SPECULA_EDITOR`, `$VISUAL` or `$EDITOR`, or in the first known one that is installed. Does not
/// wait for the editor.
///
/// # Errors
/// A message, if there is no editor with a window of its own, or if it does not start.
pub(super) fn open(place: &Place) -> Result<Editor, String> {
    let of = |name: &str| std::env::var(name).ok().filter(|value| !value.trim().is_empty());
    let is_installed = |program: &str| {
        let folders = std::env::var_os("PATH").unwrap_or_default();
        std::env::split_paths(&folders).any(|folder| folder.join(program).is_file())
    };
    // A command may be a path with spaces and without quotes.
    let quoted = |command: String| if Path::new(&command).is_file() { format!("\"{command}\"") } else { command };
    let [own, visual, editor] = ["SPECULA_EDITOR", "VISUAL", "EDITOR"].map(|name| of(name).map(quoted));
    // A name that begins with `-` or `+` would be an option.
    let file = std::path::absolute(&place.file).unwrap_or_else(|_| place.file.clone());
    let place = &Place { file, ..place.clone() };
    let Some(words) = command(own, [visual, editor], is_installed, place) else {
        return Err("found no editor with a window of its own. Set SPECULA_EDITOR, for example to \
                    `code -g {file}:{line}:{column}`"
            .into());
    };
    start(&words)
}

fn start(words: &[String]) -> Result<Editor, String> {
    let (program, arguments) = words.split_first().ok_or("SPECULA_EDITOR is empty")?;
    let mut command = Command::new(program);
    // Ctrl+C in the terminal ends Specula, but not the editor.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let process = command.spawn().map_err(|error| format!("the editor `{program}` did not start: {error}"))?;
    Ok(Editor { program: program.clone(), process, start: Instant::now() })
}

/// Program and arguments. `own`: a command, with or without placeholders for the position. `choices`: the editors that the user
/// prefers elsewhere.
fn command(
    own: Option<String>,
    choices: [Option<String>; 2],
    is_installed: impl Fn(&str) -> bool,
    place: &Place,
) -> Option<Vec<String>> {
    // A folder or a whole file has no line, so every editor takes its plain path.
    let with = |command: &str, template: &str| {
        let rest = if place.line.is_some() { template } else { "{file}" };
        filled(&format!("{command} {rest}"), place)
    };
    if let Some(own) = own {
        return Some(match own.contains("{file}") {
            true => filled(&own, place),
            false => with(&own, template(&own).unwrap_or("{file}")),
        });
    }
    let preferred = choices.into_iter().flatten().find_map(|choice| Some((template(&choice)?, choice)));
    if let Some((template, choice)) = preferred {
        return Some(with(&choice, template));
    }
    let (program, template) = EDITORS.into_iter().find(|(program, _)| is_installed(program))?;
    Some(with(program, template))
}

/// How the editor of a command takes a position, if it is known.
fn template(command: &str) -> Option<&'static str> {
    let first = words(command).into_iter().next()?;
    let program = Path::new(&first).file_stem()?.to_str()?;
    EDITORS.into_iter().find(|(name, _)| *name == program).map(|(_, template)| template)
}

/// Splits a command into words and fills in the position. Without a line, the parts for it are left out.
fn filled(command: &str, place: &Place) -> Vec<String> {
    let file = place.file.display().to_string();
    let (line, column) = (place.line.unwrap_or(1).to_string(), place.column.unwrap_or(1).to_string());
    let fill = |word: &str| word.replace("{line}", &line).replace("{column}", &column).replace("{file}", &file);
    let fill = |word: String| fill(&word);
    if place.line.is_some() {
        return words(command).into_iter().map(fill).collect();
    }
    let command = command.replace(":{line}", "").replace(":{column}", "");
    let gives_line = |word: &String| word.contains("{line}") || word.contains("{column}");
    words(&command).into_iter().filter(|word| !gives_line(word)).map(fill).collect()
}

/// The words of a command. As in a shell, a word can contain spaces inside quotes, and on Unix after a backslash.
fn words(command: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let (mut quote, mut is_open) = (None, false);
    let mut letters = command.chars();
    while let Some(letter) = letters.next() {
        let letter = match (quote, letter) {
            (Some(end), letter) if letter == end => {
                quote = None;
                continue;
            }
            (None, space) if space.is_whitespace() => {
                is_open = false;
                continue;
            }
            (None, '\'' | '"') => {
                quote = Some(letter);
                None
            }
            (None | Some('"'), '\\') if cfg!(unix) => letters.next(),
            _ => Some(letter),
        };
        if !std::mem::replace(&mut is_open, true) {
            words.push(String::new());
        }
        words.last_mut().into_iter().for_each(|word| word.extend(letter));
    }
    words
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
        // The user's preferred editor comes first, if it has a window of its own.
        let prefers = [Some("/usr/bin/subl -w"), Some("vim")];
        assert_eq!(at(words(None, prefers, "code", Some(20))).unwrap(), "/usr/bin/subl|-w|my shaders/ndf.glsl:20:7");
        let terminal = [Some("vim"), Some("nano")];
        assert_eq!(at(words(None, terminal, "kate", Some(20))).unwrap(), "kate|-l|20|-c|7|my shaders/ndf.glsl");
        // The user's own command is used unchanged.
        assert_eq!(
            at(words(Some("ed {line} {file}"), prefers, "code", Some(20))).unwrap(),
            "ed|20|my shaders/ndf.glsl"
        );
        assert_eq!(
            at(words(Some("flatpak run ed {file}:{line}"), none, "code", None)).unwrap(),
            "flatpak|run|ed|my shaders/ndf.glsl"
        );
        assert_eq!(at(words(Some("zed -n"), none, "code", None)).unwrap(), "zed|-n|my shaders/ndf.glsl");
        assert_eq!(at(words(Some("ed"), prefers, "code", Some(20))).unwrap(), "ed|my shaders/ndf.glsl");
        assert_eq!(at(words(Some("zed -n"), none, "code", Some(20))).unwrap(), "zed|-n|my shaders/ndf.glsl:20:7");
        let quoted = [Some("\"/opt/my editors/subl\" -w"), None];
        assert_eq!(at(words(None, quoted, "", Some(20))).unwrap(), "/opt/my editors/subl|-w|my shaders/ndf.glsl:20:7");
    }

    #[cfg(unix)]
    #[test]
    fn an_editor_that_fails_is_told() {
        let failure = |program: &str| start(&[program.to_owned()]).unwrap().failure();
        assert_eq!(failure("true"), None);
        let message = failure("false").unwrap();
        assert!(message.contains("`false`") && message.contains("exit status: 1"), "{message}");
        assert!(start(&["no such editor".to_owned()]).unwrap_err().contains("did not start"));
    }

    #[test]
    fn commands_are_split_as_in_a_shell() {
        for (command, expected) in [
            ("  code  -w ", &["code", "-w"][..]),
            ("'/a b/code' \"c d\"", &["/a b/code", "c d"]),
            ("--title='it is' x''y \"\"", &["--title=it is", "xy", ""]),
            ("\"it's", &["it's"]),
            ("", &[]),
        ] {
            assert_eq!(super::words(command), expected, "{command}");
        }
        #[cfg(unix)]
        assert_eq!(super::words(r#"/a\ b/code "c\"d" 'e\f'"#), ["/a b/code", "c\"d", r"e\f"]);
    }
}
