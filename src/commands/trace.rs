//! `specula trace`: what every statement computes at a pixel.

use std::collections::BTreeMap;

use serde_json::json;
use specula::events::{Event, emit};
use specula::headless::TraceRequest;
use specula::message::did_you_mean;
use specula::shader::trace::{Assertion, Trace};
use specula::shader::{Severity, ShaderSet, StageKind, TreePath};

use super::common::asserts::Asserted;
use super::common::frames::Frames;
use super::common::opened::Opened;
use super::common::parse::{inside, pixel};
use super::common::{Common, Models, check_mode, check_validation, warn_unmeasured};
use super::{Failure, print_diagnostics, print_json};

/// Columns of source code in front of the values.
const CODE: usize = 60;

/// Options of `trace`.
#[derive(clap::Args)]
#[command(
    after_help = "Each line that the pixel reaches is printed with what its statements do there: `a = 0.25` stores a value or gets an argument, \
    `return 2`, `? true` decides about a branch or a loop, `discard`. \u{d7}3: three times, with the different values.\n\
    The stage that draws the mode is drawn again with a log, and its color is compared with the picture's, bit by bit: where fragments share the \
    samples of a pixel or are blended, that of all of them. --stage traces any other \
    stage of the picture: a pass, whose color is compared with its image; a vertex stage, for the corners of the triangle at the pixel; a \
    compute stage, for the invocation of the pixel or --invocation, which also names a quad of draw=quads. Stages of tessellation, geometry and meshes, \
    and those that bake light are not traced. A file of another stage than the picture's finds its stage by itself. \
    In a file of Shadertoy, --frames draws the frames before. The log leaves out large structs: their members are logged where they are stored.\n\
    Without --file, all files are traced, a few at a time, which takes a software device about a minute; of a single file opened with \
    --shaders, that one. FILE may be the end of a path, as ndf.glsl.\n\
    In JSON, the first and last 16 values of each variable have the calls that led to them, as `shade > add_light [light 2]`: the call about \
    the second of `lights`. `proof.equal` says whether the color is the picture's, and `proof.ulp` by how many floats it differs.\n\
    --assert fails with exit code 1 if a value does not fulfill it, or none was computed. All numbers of a vector count, unless NAME ends in \
    a component, as n.x. NAME can be `return` or `condition`. It traces its file alone.\n\
    If the shaders have assert() or print(), those of the whole picture are checked, too: a failed one is exit code 1, and so is a loop that does \
    not end at the pixel, whose first rounds are printed."
)]
pub struct Args {
    #[command(flatten)]
    models: Models,
    /// Pixel, counted from the upper left corner
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, value_parser = pixel)]
    at: (u32, u32),
    /// Stage of the picture, as tonemap.frag [default: the one that draws the pixel, or the first that has the files]
    #[arg(long, value_name = "STAGE")]
    stage: Option<String>,
    /// Invocation of a compute stage, by gl_GlobalInvocationID, or the number of a quad [default: that of the pixel; the first quad]
    #[arg(long, value_name = "X,Y,Z", value_parser = invocation)]
    invocation: Option<[u32; 3]>,
    /// Fragment of the pixel, from 0 for the nearest; of a vertex stage, the corner [default: the one that is seen]
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
    /// Add `around` to the JSON: the values of the statements of --file at the 8x8 pixels around the pixel
    #[arg(long, requires = "json", requires = "file")]
    around: bool,
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
    let settings = args.common.settings()?;
    warn_unmeasured(&settings.mode, &settings);
    let slug = settings.mode.clone();
    let Opened { gpu, mut headless, progress } = Opened::new(&args.common, &args.models, settings, sequence)?;
    let shaders = headless.shaders();
    check_mode(&shaders, &slug)?;
    let mode = shaders.modes.iter().find(|mode| mode.slug == slug).cloned();
    let mode = mode.ok_or_else(|| Failure::Usage(format!("the shaders have no mode {slug}")))?;
    progress.say("tracing the pixel");
    let opened = args.common.source()?.opened();
    let whole = |file: &str| whole_path(&shaders, opened.as_ref(), file);
    for assertion in &mut args.assert {
        assertion.file = whole(&assertion.file)?;
        let text = shaders.author_text(&TreePath::from(assertion.file.as_str()));
        if let Some(lacks) = text.and_then(|text| assertion.lacks_line(text)) {
            return Err(Failure::Usage(lacks));
        }
    }
    let mut named = args.file.iter().map(|file| whole(file)).collect::<Result<Vec<String>, _>>()?;
    if named.is_empty() && args.assert.is_empty() {
        // The stage around a single file is not what the user has written.
        let of_stage = |stage: &String| whole(shaders.name_of(shaders.stage_named(stage)?)).ok();
        let own = args.stage.as_ref().map_or_else(|| opened.as_ref().map(TreePath::to_string), of_stage);
        named.extend(own.filter(|_| opened.is_some()));
    }
    let asserted_files = args.assert.iter().map(|assertion| assertion.file.as_str());
    let files: Vec<&str> = named.iter().map(String::as_str).chain(asserted_files).collect();
    let stage = args.stage.as_deref();
    let request = TraceRequest {
        at: args.at,
        mode: &mode,
        stage,
        invocation: args.invocation,
        files: &files,
        is_interactive: false,
    };
    let trace = headless.trace(&request)?;
    let around = if args.around { Some(headless.trace_around(&request)?) } else { None };
    let cut = headless.endless_loop_of(&trace);
    let is_endless = cut.as_ref().is_some_and(|cut| cut.severity == Severity::Error);
    // Where a loop does not end, there is no picture to check.
    let asserted = if is_endless { Asserted::default() } else { Asserted::draw(&mut headless)? };
    drop(progress);
    let fragment = chosen(&trace, args.fragment)?;
    let failed: Vec<String> =
        args.assert.iter().filter_map(|assertion| assertion.check(&trace.fragments[fragment]).err()).collect();
    if args.json {
        let mut value = trace.json(fragment);
        (value["pixel"], value["mode"]) = (json!([x, y]), json!(slug));
        if let Some(around) = around {
            value["around"] = around.json();
        }
        if !args.assert.is_empty() {
            value["failed"] = json!(failed);
        }
        if let Some(checks) = asserted.json() {
            value["checks"] = checks;
        }
        print_json(&value);
    } else {
        print(args.at, &shaders, &trace, fragment);
    }
    // The validation layers also report errors when objects are destroyed.
    drop(headless);
    check_validation(&gpu)?;
    print_diagnostics(cut.as_slice());
    cut.iter().for_each(|cut| emit(args.common.emits(), &Event::Diagnostic(cut)));
    let told = asserted.tell(args.common.emits());
    match (failed.is_empty(), is_endless) {
        (false, _) => Err(Failure::Input(failed.join("\n"))),
        (true, true) => Err(Failure::Printed),
        (true, false) => told,
    }
}

/// The path of a file of the tree. `ndf.glsl` is enough if only one path ends so, or that of the single file that is opened.
///
/// # Errors
/// No stage has such a file.
fn whole_path(shaders: &ShaderSet, opened: Option<&TreePath>, file: &str) -> Result<String, Failure> {
    let ending = format!("/{file}");
    if let Some(opened) = opened.filter(|opened| opened.as_str().ends_with(&ending)) {
        return Ok(opened.to_string());
    }
    if shaders.texts.contains_key(&TreePath::from(file)) {
        return Ok(file.to_owned());
    }
    let paths = || shaders.texts.keys().map(TreePath::as_str);
    let found: Vec<&str> = paths().filter(|path| path.ends_with(&ending)).collect();
    match found.as_slice() {
        [one] => Ok((*one).to_owned()),
        [] => {
            // Of a name alone, the folder may be missing, too.
            let names =
                paths().map(|path| if file.contains('/') { path } else { path.rsplit('/').next().unwrap_or(path) });
            Err(Failure::Usage(format!("no stage has a file {file}.{}", did_you_mean(file, names))))
        }
        several => Err(Failure::Usage(format!("{file} can be {}: name one of them", several.join(" or ")))),
    }
}

/// Parses the place of a compute invocation, as `8,4,0` or, for the first ones of y and z, `8`.
fn invocation(text: &str) -> Result<[u32; 3], String> {
    let expected = || format!("expected X,Y,Z, as 8,4,0, but found {text}");
    let numbers = text.split(',').map(|number| number.trim().parse().map_err(|_| expected()));
    let mut place = [0; 3];
    for (at, number) in numbers.enumerate() {
        *place.get_mut(at).ok_or_else(expected)? = number?;
    }
    Ok(place)
}

/// The fragment whose statements are shown.
fn chosen(trace: &Trace, wanted: Option<usize>) -> Result<usize, Failure> {
    let count = trace.fragments.len();
    match wanted {
        Some(wanted) if wanted >= count => {
            let one = if trace.kind == StageKind::Fragment { "fragment" } else { "invocation" };
            let all = if count == 1 { format!("1 {one}") } else { format!("{count} {one}s") };
            Err(Failure::Usage(format!("--fragment {wanted}: the pixel has {all}; the first is 0")))
        }
        Some(wanted) => Ok(wanted),
        None => trace.visible().ok_or_else(|| {
            Failure::Input("every fragment is discarded at this pixel; choose one with --fragment".into())
        }),
    }
}

fn print((x, y): (u32, u32), shaders: &ShaderSet, trace: &Trace, fragment: usize) {
    let count = trace.fragments.len() + trace.left_out as usize;
    let (stage, proof) = (shaders.name_of(&trace.stage), trace.proof_text(fragment));
    match trace.kind {
        StageKind::Fragment => {
            out!("pixel {x} {y}, {stage}, fragment {fragment} of {count}: {proof}");
            let coverage = trace.coverage_text(fragment);
            if !coverage.is_empty() {
                out!("{coverage}");
            }
        }
        _ => out!("pixel {x} {y}, {stage}, {}, {fragment} of {count}: {proof}", trace.name_of(fragment).to_lowercase()),
    }
    let lines = trace.lines(fragment);
    let mut not_reached = trace.not_reached(fragment);
    let numbers = lines.iter().map(|line| line.line).chain(not_reached.values().flatten().copied());
    let width = numbers.max().unwrap_or(0).to_string().len();
    for of_file in lines.chunk_by(|a, b| a.file == b.file) {
        out!("\n{}", shaders.name_of(&of_file[0].file));
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
