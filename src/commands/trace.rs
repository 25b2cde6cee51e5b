//! `specula trace`: what every statement computes at a pixel.

use std::collections::BTreeMap;

use serde_json::json;
use specula::shader::trace::{Assertion, Trace};

use super::common::frames::Frames;
use super::common::opened::Opened;
use super::common::parse::{inside, pixel};
use super::common::{Common, Models, check_mode, check_validation, warn_unmeasured};
use super::{Failure, print_json};

/// Columns of source code in front of the values.
const CODE: usize = 60;

/// Options of `trace`.
#[derive(clap::Args)]
#[command(
    after_help = "Each line that the pixel reaches is printed with what its statements do there: `a = 0.25` stores a value or gets an argument, \
    `return 2`, `? true` decides about a branch or a loop, `discard`. \u{d7}3: three times, with the different values.\n\
    The fragment stage that draws the mode is drawn again with a log, and its color is compared with the picture's, bit by bit. What passes, \
    random paths and files of Shadertoy compute is not traced. The log leaves out large structs: their members are logged where they are stored.\n\
    Without --file, all files are traced, a few at a time, which takes a software device about a minute.\n\
    In JSON, the first and last 16 values of each variable have the calls that led to them, as `shade > add_light [2]`: the second call of \
    `add_light` by `shade`. `proof.equal` says whether the color is the picture's, and `proof.ulp` by how many floats it differs.\n\
    --assert fails with exit code 1 if a value does not fulfill it, or none was computed. All numbers of a vector count, unless NAME ends in \
    a component, as n.x. NAME can be `return` or `condition`. It traces its file alone."
)]
pub struct Args {
    #[command(flatten)]
    models: Models,
    /// Pixel, counted from the upper left corner
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, value_parser = pixel)]
    at: (u32, u32),
    /// Fragment of the pixel, from 0 for the nearest [default: the one that is seen]
    #[arg(long, value_name = "N")]
    fragment: Option<usize>,
    /// Trace the statements of this file of the tree alone, as brdf/ndf.glsl; may be repeated
    #[arg(long, value_name = "FILE")]
    file: Vec<String>,
    /// Check values, as 'brdf/ndf.glsl:21 spread > 0'; may be repeated
    #[arg(long, value_name = "FILE:LINE NAME > NUMBER", value_parser = Assertion::parse)]
    assert: Vec<Assertion>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    frames: Frames,
    #[command(flatten)]
    common: Common,
}

/// Runs the command.
pub fn run(mut args: Args) -> Result<(), Failure> {
    args.common.take_files(&mut args.models)?;
    let (x, y) = args.at;
    inside(args.at, args.common.size())?;
    let sequence = args.frames.sequence()?;
    let mut settings = args.common.settings()?;
    settings.view.msaa = 1;
    warn_unmeasured(&settings.mode, &settings);
    let slug = settings.mode.clone();
    let Opened { gpu, mut headless, progress } = Opened::new(&args.common, &args.models, settings, sequence)?;
    let shaders = headless.shaders();
    check_mode(&shaders, &slug)?;
    let mode = shaders.modes.iter().find(|mode| mode.slug == slug).cloned();
    let mode = mode.ok_or_else(|| Failure::Usage(format!("the shaders have no mode {slug}")))?;
    progress.say("tracing the pixel");
    let files = args.file.iter().map(String::as_str).chain(args.assert.iter().map(Assertion::file));
    let trace = headless.trace(args.at, &mode, &files.collect::<Vec<_>>())?;
    drop(progress);
    let fragment = chosen(&trace, args.fragment)?;
    let failed: Vec<String> =
        args.assert.iter().filter_map(|assertion| assertion.check(&trace.fragments[fragment]).err()).collect();
    if args.json {
        let mut value = trace.json(fragment);
        (value["pixel"], value["mode"]) = (json!([x, y]), json!(slug));
        if !args.assert.is_empty() {
            value["failed"] = json!(failed);
        }
        print_json(&value);
    } else {
        print(args.at, &trace, fragment);
    }
    // The validation layers also report errors when objects are destroyed.
    drop(headless);
    check_validation(&gpu)?;
    match failed.is_empty() {
        true => Ok(()),
        false => Err(Failure::Input(failed.join("\n"))),
    }
}

/// The fragment whose statements are shown.
fn chosen(trace: &Trace, wanted: Option<usize>) -> Result<usize, Failure> {
    let count = trace.fragments.len();
    match wanted {
        Some(wanted) if wanted >= count => {
            let all = if count == 1 { "1 fragment".to_owned() } else { format!("{count} fragments") };
            Err(Failure::Usage(format!("--fragment {wanted}: the pixel has {all}; the first is 0")))
        }
        Some(wanted) => Ok(wanted),
        None => trace.visible().ok_or_else(|| {
            Failure::Input("every fragment of the model is discarded at this pixel; choose one with --fragment".into())
        }),
    }
}

fn print((x, y): (u32, u32), trace: &Trace, fragment: usize) {
    let count = trace.fragments.len() + trace.left_out as usize;
    out!("pixel {x} {y}, fragment {fragment} of {count}: {}", trace.proof_text(fragment));
    let lines = trace.lines(fragment);
    let mut not_reached = trace.not_reached(fragment);
    let numbers = lines.iter().map(|line| line.line).chain(not_reached.values().flatten().copied());
    let width = numbers.max().unwrap_or(0).to_string().len();
    for of_file in lines.chunk_by(|a, b| a.file == b.file) {
        out!("\n{}", of_file[0].file);
        for line in of_file {
            out!("  {:>width$}  {:<CODE$}  {}", line.line, line.code, line.text());
        }
        if let Some(lines) = not_reached.remove(of_file[0].file.as_str()) {
            out!("  {:>width$}  not reached: {}", "", ranges(&lines));
        }
    }
    print_not_reached(&not_reached);
}

/// Prints the files of which no statement was reached.
fn print_not_reached(files: &BTreeMap<&str, Vec<u32>>) {
    for file in files.keys() {
        out!("\n{file}\n  not reached");
    }
}

/// Ascending numbers, as `3, 5-7`: without the numbers between them.
fn ranges(numbers: &[u32]) -> String {
    let ranges = numbers.chunk_by(|a, b| a + 1 == *b).map(|run| match run {
        [first, .., last] => format!("{first}-{last}"),
        few => few.iter().map(u32::to_string).collect(),
    });
    ranges.collect::<Vec<_>>().join(", ")
}
