//! `specula help`: a command's help, or the list of all settings; and the answer to a command that does not exist.

mod documents;

use std::path::{Path, PathBuf};

use clap::{Command, ValueEnum as _};
use clap_complete::Shell;
use specula::app::{Described, described};
use specula::message::{nearest, print_output};
use specula::scene::BUILT_IN;
use specula::settings::{Factor, Setting, catalog, factor_path};
use specula::shader::annotation::ParameterType;
use specula::shader::spirv::reflect::Scalar;
use specula::shader::{Change, Library, ShaderSet, Update};

use super::Failure;
use super::common::names::is_word;
use super::common::{compiler, source};

/// Topics that are not commands.
const SETTINGS: &str = "set";
const CONTROL: &str = "commands";
const MAN: &str = "man";
const COMPLETIONS: &str = "completions";
/// Width of the last column of the list of settings.
const MEANING: usize = 60;

/// Options of `help`.
#[derive(clap::Args)]
pub struct Args {
    /// A command, as `render` or `brdf plot`; `set`, for the list of all settings; `commands`, for what a window or `specula serve` takes on
    /// stdin and on a socket; `man`, or `man render`, for a man page; or `completions bash` (elvish, fish, powershell, zsh) for a shell's script
    topic: Vec<String>,
    /// For `set`: also list the settings of the shader tree in this folder [default: ./shaders if it is one]
    #[arg(long, value_name = "DIR|FILE")]
    shaders: Option<PathBuf>,
    /// For `man`: write the pages of all commands to this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Runs the command. `command` is that of the program.
pub fn run(args: &Args, command: Command) -> Result<(), Failure> {
    let topic: Vec<&str> = args.topic.iter().map(String::as_str).collect();
    if args.out.is_some() && topic != [MAN] {
        return Err(Failure::Usage("--out takes the man pages of all commands: `specula help man --out DIR`".into()));
    }
    match topic[..] {
        [SETTINGS] => print_settings(args.shaders.as_deref())?,
        [CONTROL] => print_commands(),
        [MAN, ..] => match &args.out {
            Some(folder) => documents::write_man_pages(command, folder)?,
            None => documents::print_man_page(find(command, &topic[1..])?)?,
        },
        [COMPLETIONS, ref rest @ ..] => documents::print_completions(command, shell(rest)?),
        _ => print_output(find(command, &topic)?.render_long_help().to_string().trim_end()),
    }
    Ok(())
}

/// The command that these words name. No word names the program.
fn find(mut command: Command, words: &[&str]) -> Result<Command, Failure> {
    command.build();
    for name in words {
        let topics = [SETTINGS, CONTROL, MAN, COMPLETIONS].map(str::to_owned);
        let names: Vec<String> = names(&command).chain(topics).collect();
        command = command.find_subcommand(name).cloned().ok_or_else(|| {
            let known = names.iter().map(String::as_str);
            let hint = nearest(name, known).map(|name| format!(" Did you mean '{name}'?")).unwrap_or_default();
            Failure::Usage(format!("there is no help about '{name}'.{hint} Topics: {}", names.join(", ")))
        })?;
    }
    Ok(command)
}

/// The shell that is named as the only word.
fn shell(words: &[&str]) -> Result<Shell, Failure> {
    let named = match words {
        [name] => Shell::from_str(name, true).ok(),
        _ => None,
    };
    named.ok_or_else(|| {
        let known: Vec<String> = Shell::value_variants().iter().map(ToString::to_string).collect();
        Failure::Usage(format!("`specula help completions` takes the name of a shell: {}", known.join(", ")))
    })
}

/// Fails when a word is no command, no file and no built-in model.
pub fn check_command(word: &Path, program: &Command) -> Result<(), Failure> {
    let text = word.to_string_lossy();
    if !is_word(&text) || word.exists() || BUILT_IN.contains(&&*text) || names(program).any(|name| name == text) {
        return Ok(());
    }
    let commands: Vec<String> = names(program).collect();
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

fn print_settings(tree: Option<&Path>) -> Result<(), Failure> {
    out!("Settings, for --set PATH=VALUE and for look files (--look FILE.toml).");
    out!("Several numbers are joined by commas, as --set lights.ambient_color=1,0.8,0.6.");
    out!("In a look file, view.ev is the line `ev = 1` below `[view]`.\n");
    print_rows(catalog().iter().map(of_setting).collect());
    out!("\nFactors of one material of the model, as --set materials.NAME.FACTOR=VALUE\n");
    print_rows(Factor::ALL.iter().map(of_factor).collect());
    let source = source(tree)?;
    let name = source.name();
    match Library::new(source, compiler()?, &specula::frame::stages::stages()).update(&Change::All) {
        Update::Ready(shaders, _) => {
            out!("\nSettings of the shader tree {name}\n");
            print_rows(of_tree(&shaders));
        }
        _ => out!("\nThe shader tree {name} does not compile, so its own settings are unknown: see `specula check`."),
    }
    Ok(())
}

fn print_commands() {
    out!(
        "Commands to a session: one JSON object a line, on stdin (`specula serve`, `specula view --events json`) or on a local socket (--socket NAME)."
    );
    out!(
        "Each is answered by a line: {{\"event\": \"done\", \"id\", \"command\", \"result\"}} or \"error\" with a \"message\". `id` is whatever you send."
    );
    out!("A field with a ? may be left out.\n");
    for Described { command, takes, doc, needs_window } in described() {
        let doc = if needs_window { format!("{doc}. Only with a window") } else { doc.to_owned() };
        let fields = if takes.is_empty() { String::new() } else { format!(", {takes}") };
        out!("{{\"command\": \"{command}\"{fields}}}\n    {doc}");
    }
}

/// Path, kind of value, default, range, unit and meaning.
type SettingRow = [String; 6];

fn of_setting(setting: &Setting) -> SettingRow {
    let Setting { path, entry, takes, default, .. } = setting;
    let [takes, unit] = [*takes, entry.unit.name].map(str::to_owned);
    [path.clone(), takes, default.to_string(), entry.valid.text(), unit, setting.doc()]
}

fn of_factor(factor: &Factor) -> SettingRow {
    let (takes, entry) = (if factor.is_color() { "3 numbers" } else { "number" }, factor.entry());
    let [takes, default, unit, doc] = [takes, "", entry.unit.name, entry.doc()].map(str::to_owned);
    [factor_path("NAME", *factor), takes, default, entry.valid.text(), unit, doc]
}

/// The constants, parameters and passes of a tree.
fn of_tree(shaders: &ShaderSet) -> Vec<SettingRow> {
    let range = |range: Option<(f64, f64)>| range.map(|(low, high)| format!("{low} to {high}")).unwrap_or_default();
    let setting = |path: &str, takes: &str, default: String, range: String, doc: String| {
        [path.to_owned(), takes.to_owned(), default, range, String::new(), doc]
    };
    let with_names = |label: &str, choices: &[(String, i64)], doc: &str| {
        let names: Vec<&str> = choices.iter().map(|(name, _)| name.as_str()).collect();
        let label = if names.is_empty() { label.to_owned() } else { format!("{label}: {}", names.join(", ")) };
        if doc.is_empty() { label } else { format!("{label}. {doc}") }
    };
    let named = |choices: &[(String, i64)], value: i64| {
        choices.iter().find(|(_, known)| *known == value).map(|(name, _)| name.clone())
    };
    let constants = shaders.constants.iter().map(|constant| {
        let (takes, default) = match constant.scalar {
            Scalar::Bool => ("true or false", (constant.default != 0).to_string()),
            Scalar::Float => ("number", f32::from_bits(constant.default).to_string()),
            Scalar::Int => ("whole number", constant.default.cast_signed().to_string()),
            Scalar::Uint => ("whole number", constant.default.to_string()),
        };
        let chosen = named(&constant.choices, constant.default.into());
        let takes = if constant.choices.is_empty() { takes } else { "name" };
        let doc = with_names(&constant.label, &constant.choices, &constant.doc);
        setting(&constant.name, takes, chosen.unwrap_or(default), range(constant.range), doc)
    });
    let parameters = shaders.parameters.iter().map(|parameter| {
        let is_bool = parameter.kind == ParameterType::Bool;
        let takes = match parameter.kind {
            _ if !parameter.choices.is_empty() => "name",
            ParameterType::Float => "number",
            ParameterType::Int | ParameterType::Uint => "whole number",
            ParameterType::Bool => "true or false",
            ParameterType::Vec2 => "2 numbers",
            ParameterType::Vec3 => "3 numbers",
            ParameterType::Vec4 => "4 numbers",
        };
        let number = |value: &f64| if is_bool { (*value != 0.0).to_string() } else { value.to_string() };
        let numbers: Vec<String> = parameter.default.iter().map(number).collect();
        let chosen = parameter.default.first().and_then(|value| named(&parameter.choices, *value as i64));
        let doc = with_names(&parameter.label, &parameter.choices, &parameter.doc);
        setting(&parameter.name, takes, chosen.unwrap_or(numbers.join(",")), range(parameter.range), doc)
    });
    let passes = shaders.graph.passes.iter().filter(|pass| pass.has_switch()).map(|pass| {
        let doc = if pass.desc.doc.is_empty() { &pass.desc.label } else { &pass.desc.doc };
        let path = format!("passes.{}", pass.name());
        setting(&path, "true or false", pass.desc.on.to_string(), String::new(), doc.clone())
    });
    constants.chain(parameters).chain(passes).collect()
}

fn print_rows(rows: Vec<SettingRow>) {
    let heading = ["Setting", "Value", "Default", "Range", "Unit", "Meaning"].map(str::to_owned);
    let rows: Vec<SettingRow> = std::iter::once(heading).chain(rows).collect();
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
}
