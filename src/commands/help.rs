//! `specula help`: a command's help, or the list of all settings; and the answer to a command that does not exist.

use std::path::Path;

use clap::{Command, CommandFactory as _};
use specula::message::nearest;
use specula::scene::BUILT_IN;
use specula::settings::{Setting, catalog};

use super::common::names::is_word;
use super::{Cli, Failure, print};

/// Topic that is not a command.
const SETTINGS: &str = "set";
/// Width of the last column of the list of settings.
const MEANING: usize = 60;

/// Options of `help`.
#[derive(clap::Args)]
pub struct Args {
    /// A command, as `render` or `brdf plot`; or `set`, for the list of all settings
    topic: Vec<String>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    if args.topic == [SETTINGS] {
        print_settings(&catalog());
        return Ok(());
    }
    let mut command = Cli::command();
    command.build();
    for name in &args.topic {
        let names: Vec<String> = names(&command).chain([SETTINGS.to_owned()]).collect();
        command = command.find_subcommand(name).cloned().ok_or_else(|| {
            let known = names.iter().map(String::as_str);
            let hint = nearest(name, known).map(|name| format!(" Did you mean '{name}'?")).unwrap_or_default();
            Failure::Usage(format!("there is no help about '{name}'.{hint} Topics: {}", names.join(", ")))
        })?;
    }
    print(command.render_long_help().to_string().trim_end());
    Ok(())
}

/// Fails when a word is no command, no file and no built-in model.
pub fn check_command(word: &Path) -> Result<(), Failure> {
    let text = word.to_string_lossy();
    if !is_word(&text) || word.exists() || BUILT_IN.contains(&&*text) || names(&Cli::command()).any(|name| name == text)
    {
        return Ok(());
    }
    let commands: Vec<String> = names(&Cli::command()).collect();
    let told = format!("there is neither a command nor a file '{text}'.");
    Err(Failure::Usage(match nearest(&text, commands.iter().map(String::as_str).chain(BUILT_IN)) {
        Some(near) => format!("{told} Did you mean '{near}'?"),
        None => format!("{told} `specula --help` lists the commands. Built-in models: {}", BUILT_IN.join(", ")),
    }))
}

fn names(command: &Command) -> impl Iterator<Item = String> + '_ {
    command.get_subcommands().map(|command| command.get_name().to_owned())
}

/// The words of a text in lines of at most [`MEANING`] characters.
fn wrapped(text: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut().filter(|line| line.len() + 1 + word.len() <= MEANING) {
            Some(line) => *line += &format!(" {word}"),
            None => lines.push(word.to_owned()),
        }
    }
    lines
}

fn print_settings(settings: &[Setting]) {
    out!("Settings, for --set PATH=VALUE and for look files (--look FILE.toml).");
    out!("Several numbers are joined by commas, as --set lights.ambient_color=1,0.8,0.6.");
    out!("In a look file, view.ev is the line `ev = 1` below `[view]`.\n");
    let heading = ["Setting", "Value", "Default", "Range", "Unit", "Meaning"].map(str::to_owned);
    let row = |setting: &Setting| {
        let Setting { path, takes, default, range, unit, doc } = setting.clone();
        [path, takes.to_owned(), default, range, unit.to_owned(), doc]
    };
    let rows: Vec<[String; 6]> = std::iter::once(heading).chain(settings.iter().map(row)).collect();
    let widths: [usize; 5] = std::array::from_fn(|i| rows.iter().map(|row| row[i].len()).max().unwrap_or(0));
    let mut group = String::new();
    for [path, takes, default, range, unit, doc] in &rows {
        let own = path.rsplit_once('.').map_or("", |(group, _)| group);
        if own != group {
            out!("");
            group = own.to_owned();
        }
        let [a, b, c, d, e] = widths;
        let indent = widths.iter().sum::<usize>() + 2 * widths.len();
        let doc = wrapped(doc).join(&format!("\n{:indent$}", ""));
        out!("{path:a$}  {takes:b$}  {default:c$}  {range:d$}  {unit:e$}  {doc}");
    }
    out!("\nThe constants and parameters of the shader tree are set by their names, as --set NDF=Beckmann.");
    out!("`specula modes` lists them. A pass of the tree is switched by its name, as --set passes.outline=true.");
}
