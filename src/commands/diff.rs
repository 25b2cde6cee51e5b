//! `specula diff A B`: measures how different pictures are.

mod report;

use std::cmp::Reverse;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use specula::picture;
use specula::picture_difference::report::ReportPair;
use specula::picture_difference::{Comparison, Limits, Measure, listed, listed_all};

use super::progress::Progress;
use super::{Failure, print_json};
use report::{Opened, options, reported, write_report};

/// Options of `diff`.
#[derive(clap::Args)]
#[command(
    after_help = "PNGs are compared as an eye sees them: the error is the mean of FLIP (Andersson et al. 2020), 0 to 1. \
    0.01 is hardly visible, 0.1 is obvious. EXRs are compared as numbers: the error is the RMSE, in their own unit.\n\
    FLIP is a mean, so it lets a difference of a few pixels through; --max-channel does not.\n\
    Exit codes: 0 when every error is at most --max, and no channel differs by more than --max-channel; 1 otherwise, or when a picture is on \
    one side only or does not load; 2 for a wrong command line.\n\n\
    In CI:  specula render --mode all --out now/ball.png && specula diff golden now --max 0.01 --report report.html"
)]
pub struct Args {
    /// Picture, .png or .exr, or a folder of them
    a: PathBuf,
    /// Picture of the same size, or folder with pictures of the same names
    b: PathBuf,
    /// Largest error that passes
    #[arg(long, value_name = "ERROR", default_value_t = 0.0, allow_negative_numbers = true)]
    max: f64,
    /// Largest difference of a channel that passes: 0 to 1 for PNGs, of which 0.004 is one step of 8 bits; for EXRs in their own unit
    #[arg(long, value_name = "DIFFERENCE", allow_negative_numbers = true)]
    max_channel: Option<f64>,
    /// Write a map of the differences: a file; or, for folders, a folder with a map of each picture whose error is larger than a limit
    #[arg(long, value_name = "FILE|DIR")]
    out: Option<PathBuf>,
    /// Write a page for a browser, which shows the pictures, the worst first, with their differences and settings
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    /// Print JSON; an infinite difference, as of NaN and a number, is null
    #[arg(long)]
    json: bool,
}

/// The comparison of two pictures, or the reason why they cannot be compared.
struct Pair {
    name: String,
    compared: Result<Comparison, String>,
    /// Its part of the report, if there is one.
    reported: Option<ReportPair>,
}

impl Pair {
    /// Compares two pictures, of which one may be missing.
    fn new(name: String, [a, b]: [Result<Opened, String>; 2], args: &Args) -> Result<Self, String> {
        let both = a.as_ref().and_then(|a| b.as_ref().map(|b| [a, b])).map_err(Clone::clone);
        let compared = both.and_then(|[a, b]| Comparison::new(&a.picture, &b.picture));
        let mut pair = Self { name, compared, reported: None };
        if args.report.is_some() {
            let sides = [a.as_ref().ok(), b.as_ref().ok()];
            pair.reported = Some(reported((&pair.name, &pair.compared), sides, args.limits())?);
        }
        Ok(pair)
    }

    fn passes(&self, limits: Limits) -> bool {
        self.compared.as_ref().is_ok_and(|found| found.passes(limits))
    }
}

impl Args {
    fn limits(&self) -> Limits {
        Limits { max: self.max, max_channel: self.max_channel }
    }
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let given = [("--max", Some(args.max)), ("--max-channel", args.max_channel)];
    if let Some((option, Some(wrong))) =
        given.into_iter().find(|(_, limit)| limit.is_some_and(|limit| limit.is_nan() || limit < 0.0))
    {
        return Err(Failure::Usage(format!("{option} {wrong}: expected 0 or more")));
    }
    if let Some(absent) = [&args.a, &args.b].into_iter().find(|path| !path.exists()) {
        return Err(Failure::Input(format!("{}: there is no such file or folder", absent.display())));
    }
    let folders = match (args.a.is_dir(), args.b.is_dir()) {
        (a, b) if a == b => a,
        _ => {
            let message = "a folder and a file cannot be compared: name two pictures or two folders";
            return Err(Failure::Usage(message.to_owned()));
        }
    };
    let same_place = |x: &Path, y: &Path| matches!((x.canonicalize(), y.canonicalize()), (Ok(x), Ok(y)) if x == y);
    let outputs = [("--out", &args.out), ("--report", &args.report)].into_iter();
    let mut outputs = outputs.filter_map(|(option, path)| Some((option, path.as_ref()?)));
    if let Some((option, out)) = outputs.find(|(_, out)| same_place(out, &args.a) || same_place(out, &args.b)) {
        let message =
            format!("{option} {} would overwrite a picture that is compared: name another place", out.display());
        return Err(Failure::Usage(message));
    }
    let limits = args.limits();
    let mut pairs = if folders { in_folders(args, &Progress::new(true))? } else { vec![pair_of_files(args)?] };
    if let Some(out) = &args.out {
        write_maps(&pairs, out, folders, limits)?;
    }
    if let Some(report) = &args.report {
        let all = pairs.iter_mut().filter_map(|pair| pair.reported.take()).collect();
        write_report(report, [&args.a, &args.b], limits, all)?;
    }
    if args.json {
        let pictures = pairs.iter().map(|pair| listed(&pair.name, &pair.compared, limits)).collect();
        print_json(&listed_all(pictures, limits));
    } else {
        print_all(&pairs, limits);
    }
    let failed = pairs.iter().filter(|pair| !pair.passes(limits)).count();
    match failed {
        0 => Ok(()),
        _ if args.json || pairs.len() == 1 => Err(Failure::Printed),
        _ => Err(Failure::Input(format!("{failed} of {} pictures fail at {}", pairs.len(), options(limits)))),
    }
}

fn pair_of_files(args: &Args) -> Result<Pair, Failure> {
    let open = |path: &Path| Opened::new(path, args.report.is_some()).map_err(Failure::Input);
    let (a, b) = (open(&args.a)?, open(&args.b)?);
    let pair = Pair::new(args.b.display().to_string(), [Ok(a), Ok(b)], args).map_err(Failure::Input)?;
    match (&pair.compared, &args.report) {
        (Err(why), None) => Err(Failure::Input(why.clone())),
        _ => Ok(pair),
    }
}

fn in_folders(args: &Args, progress: &Progress) -> Result<Vec<Pair>, Failure> {
    let (a, b) = (&args.a, &args.b);
    let (in_a, in_b) = (pictures_in(a)?, pictures_in(b)?);
    if in_a.is_empty() && in_b.is_empty() {
        let message = format!("no .png or .exr in {}, nor in {}", a.display(), b.display());
        return Err(Failure::Input(message));
    }
    let names: Vec<&String> = in_a.union(&in_b).collect();
    let pair = |(number, name): (usize, &&String)| {
        progress.begin("picture", (number, names.len()), name);
        let name = *name;
        let open = |folder: &Path, other: &Path, names: &BTreeSet<String>| match names.contains(name) {
            true => Opened::new(&folder.join(name), args.report.is_some()),
            false => Err(format!("only in {}", other.display())),
        };
        Pair::new(name.clone(), [open(a, b, &in_a), open(b, a, &in_b)], args).map_err(Failure::Input)
    };
    names.iter().enumerate().map(pair).collect()
}

/// Names of the pictures in a folder, without those of its subfolders.
fn pictures_in(folder: &Path) -> Result<BTreeSet<String>, Failure> {
    let error = |e: std::io::Error| Failure::Input(format!("cannot read {}: {e}", folder.display()));
    let mut names = BTreeSet::new();
    for entry in std::fs::read_dir(folder).map_err(error)? {
        let path = entry.map_err(error)?.path();
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        if let (Some(name), "png" | "exr") = (path.file_name(), ending.as_str()) {
            names.insert(name.to_string_lossy().into_owned());
        }
    }
    Ok(names)
}

/// Writes maps of the differences. The map of two EXRs is an EXR too, so the extension of the file must match.
fn write_maps(pairs: &[Pair], out: &Path, folders: bool, limits: Limits) -> Result<(), Failure> {
    if !folders {
        return pairs.iter().flat_map(|pair| &pair.compared).try_for_each(|found| {
            let ending = if found.measure == Measure::Flip { "png" } else { "exr" };
            if !out.extension().is_some_and(|own| own.eq_ignore_ascii_case(ending)) {
                let message = format!("cannot write {}: a map of these pictures ends in .{ending}", out.display());
                return Err(Failure::Usage(message));
            }
            picture::write_image(found.map(), out).map_err(Failure::Input)
        });
    }
    if out.is_file() {
        return Err(Failure::Usage(format!("--out {} is a file: to compare folders, name a folder", out.display())));
    }
    std::fs::create_dir_all(out).map_err(|e| Failure::Input(format!("cannot create {}: {e}", out.display())))?;
    for pair in pairs.iter().filter(|pair| !pair.passes(limits)) {
        if let Ok(found) = &pair.compared {
            picture::write_image(found.map(), &out.join(&pair.name)).map_err(Failure::Input)?;
        }
    }
    Ok(())
}

/// Prints the pairs that cannot be compared, then those that differ, the worst at these limits first, then the number of the others.
fn print_all(pairs: &[Pair], limits: Limits) {
    let badness = |pair: &Pair| pair.compared.as_ref().ok().map(|found| found.badness(limits));
    let is_same = |pair: &&Pair| pair.compared.as_ref().is_ok_and(|found| found.differing == 0);
    let (same, mut other): (Vec<&Pair>, Vec<&Pair>) = pairs.iter().partition(is_same);
    other.sort_by_key(|pair| Reverse((pair.compared.is_err(), badness(pair))));
    other.into_iter().for_each(print);
    match same.as_slice() {
        [] => {}
        [pair] => print(pair),
        all => out!("{:10} {} pictures", "same", all.len()),
    }
}

fn print(pair: &Pair) {
    let name = &pair.name;
    match &pair.compared {
        Err(why) => out!("{:10} {name}  {why}", "-"),
        Ok(found) if found.differing == 0 => out!("{:10} {name}", "same"),
        Ok(found) => {
            let measure = if found.measure == Measure::Flip { "FLIP" } else { "RMSE" };
            let (x, y) = found.largest_at;
            out!(
                "{:<10} {name}  {measure}; largest {} at {x},{y}; {} of {} pixels differ",
                number(found.error),
                number(found.largest),
                found.differing,
                found.pixels
            );
        }
    }
}

/// An error with four digits after the point; a large one, as of EXR files, with four in all.
fn number(error: f64) -> String {
    match error {
        error if error < 0.00005 => "< 0.0001".to_owned(),
        error if error < 1e6 => format!("{error:.4}"),
        error => format!("{error:.3e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_have_few_digits_at_any_size() {
        let cases =
            [(0.0, "< 0.0001"), (0.00005, "0.0001"), (0.25, "0.2500"), (65504.0, "65504.0000"), (1e25, "1.000e25")];
        for (error, text) in cases {
            assert_eq!(number(error), text);
        }
    }
}
