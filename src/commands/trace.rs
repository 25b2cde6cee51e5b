//! `specula trace`: what every statement computes at a pixel.

use serde_json::json;
use specula::headless::Headless;
use specula::shader::trace::{Assertion, LineOfTrace, Trace};

use super::common::frames::Frames;
use super::common::parse::pixel;
use super::common::{Common, Models, check_mode, check_validation, compiler, warn_unmeasured};
use super::progress::Progress;
use super::{Failure, print_json};

/// Options of `trace`.
#[derive(clap::Args)]
#[command(
    after_help = "Each line that was reached is printed with what its statements did: `a = 0.25` stored a value or got an argument, `return 2`, \
    `? true` decided about a branch or a loop, `discard`. \u{d7}3: three times, with the different values.\n\
    The stage that draws the mode is drawn once more with a log, and its color is compared with the picture's, bit by bit. \
    Passes after the model are left out, and what lies behind transmissive surfaces is black.\n\
    Of a place, the first and last 16 values are kept. In JSON each has the calls that led to it, as `shade > add_light [2]`: the second call \
    of `add_light` by `shade`.\n\
    --assert fails with exit code 1 if a value does not fulfill it, or none was computed. All numbers of a vector count, unless NAME ends in \
    a component, as n.x. NAME can be `return` or `condition`."
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
    /// Trace the statements of this file alone, or show one line of it; a single file takes a fraction of the time
    #[arg(long, value_name = "FILE[:LINE]")]
    line: Option<String>,
    /// Check values, as 'brdf/ndf.glsl:24 spread > 0'; may be repeated
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
    let (width, height) = args.common.size();
    if x >= width || y >= height {
        return Err(Failure::Usage(format!(
            "--at {x},{y} is outside of the picture ({width}x{height}); it can be 0,0 to {},{}",
            width - 1,
            height - 1
        )));
    }
    let sequence = args.frames.sequence()?;
    let mut settings = args.common.settings()?;
    settings.view.msaa = 1;
    if args.common.mode.len() > 1 {
        return Err(Failure::Usage("--mode takes one mode here: the statements of one stage are traced".into()));
    }
    warn_unmeasured(&settings.mode, &settings);
    let source = args.common.source()?;
    let gpu = args.common.gpu()?;
    let model = args.common.model(args.models.model.as_deref())?;
    args.common.fit(&model, &mut settings)?;
    let progress = Progress::new(!args.common.emits());
    progress.say("compiling the shaders");
    let slug = settings.mode.clone();
    let (mut headless, _) = Headless::new(&gpu, &compiler()?, source, model, settings, args.common.size())?;
    headless.set_sequence(sequence);
    let shaders = headless.shaders();
    check_mode(&shaders, &slug)?;
    let mode = shaders.modes.iter().find(|mode| mode.slug == slug).cloned();
    let mode = mode.ok_or_else(|| Failure::Usage(format!("the shaders have no mode {slug}")))?;
    progress.say("tracing the pixel");
    let trace = headless.trace(args.at, &mode, &|file| is_wanted(&args, file))?;
    drop(progress);
    let fragment = chosen(&trace, args.fragment)?;
    let lines = fragment.map(|fragment| trace.lines(fragment)).unwrap_or_default();
    let failed: Vec<String> = args.assert.iter().filter_map(|assertion| assertion.check(&lines).err()).collect();
    if args.json {
        let mut value = trace.json(fragment);
        (value["pixel"], value["mode"]) = (json!([x, y]), json!(slug));
        if !args.assert.is_empty() {
            value["failed"] = json!(failed);
        }
        print_json(&value);
    } else {
        print(&args, &trace, (fragment, &lines))?;
    }
    // The validation layers also report errors when objects are destroyed.
    drop(headless);
    check_validation(&gpu)?;
    match failed.is_empty() {
        true => Ok(()),
        false => Err(Failure::Input(failed.join("\n"))),
    }
}

/// Whether the statements of a file are traced: all are, unless `--line` or assertions name some.
fn is_wanted(args: &Args, file: &str) -> bool {
    let named = args.line.iter().map(|line| parts(line).0).chain(args.assert.iter().map(Assertion::file));
    let mut named = named.peekable();
    named.peek().is_none() || named.any(|of| of == file)
}

/// The file and the line of `FILE[:LINE]`.
fn parts(text: &str) -> (&str, Option<u32>) {
    let numbered = text.rsplit_once(':').and_then(|(file, line)| Some((file, Some(line.parse::<u32>().ok()?))));
    numbered.unwrap_or((text, None))
}

/// The fragment whose statements are shown; `None` where nothing was drawn.
fn chosen(trace: &Trace, wanted: Option<usize>) -> Result<Option<usize>, Failure> {
    let count = trace.fragments.len();
    match wanted {
        Some(wanted) if wanted >= count => {
            Err(Failure::Usage(format!("--fragment {wanted}: the pixel has {count} fragments; the first is 0")))
        }
        Some(wanted) => Ok(Some(wanted)),
        None => Ok(trace.visible()),
    }
}

fn print(args: &Args, trace: &Trace, (fragment, lines): (Option<usize>, &[LineOfTrace])) -> Result<(), Failure> {
    let (x, y) = args.at;
    let Some(fragment) = fragment else {
        out!("pixel {x} {y}: no fragment of the model is seen there");
        return Ok(());
    };
    let count = trace.fragments.len() + trace.left_out as usize;
    out!("pixel {x} {y}, fragment {fragment} of {count}: {}", trace.proof_text(fragment));
    let shown = shown(args.line.as_deref(), lines)?;
    let width = shown.iter().map(|line| line.line.to_string().len()).max().unwrap_or(0);
    let mut file = "";
    for line in shown {
        if line.file != file {
            out!("\n{}", line.file);
            file = &line.file;
        }
        out!("  {:>width$}  {:<60}  {}", line.line, line.code, line.text());
    }
    match trace.fragments[fragment].left_out {
        0 => {}
        more => out!("\n{more} more values were left out at the end"),
    }
    Ok(())
}

/// The lines of the file that `wanted` names, or one of them.
fn shown<'a>(wanted: Option<&str>, lines: &'a [LineOfTrace]) -> Result<Vec<&'a LineOfTrace>, Failure> {
    let Some(wanted) = wanted else { return Ok(lines.iter().collect()) };
    let (file, number) = parts(wanted);
    let is_shown = |line: &&LineOfTrace| line.file == file && number.is_none_or(|number| line.line == number);
    let shown: Vec<&LineOfTrace> = lines.iter().filter(is_shown).collect();
    if shown.is_empty() {
        let mut files: Vec<&str> = lines.iter().map(|line| line.file.as_str()).collect();
        files.dedup();
        let list = files.join(", ");
        return Err(Failure::Input(format!(
            "no statement of {wanted} was reached at this pixel; these files have some: {list}"
        )));
    }
    Ok(shown)
}
