//! `--report` of `specula diff`.

use std::path::Path;

use specula::picture::read_look;
use specula::picture_difference::report::{ReportPair, Shown, page};
use specula::picture_difference::{Comparison, Limits, Picture};

use crate::commands::Failure;
use crate::commands::common::report::write_page;

/// The limits as options of the command line.
pub(super) fn options(limits: Limits) -> String {
    let channel = limits.max_channel.map(|most| format!(" --max-channel {most}"));
    format!("--max {}{}", limits.max, channel.unwrap_or_default())
}

/// A picture that is compared.
pub(super) struct Opened {
    pub(super) picture: Picture,
    file: String,
    /// The bytes of its file, for a report.
    bytes: Vec<u8>,
    /// The settings in its file.
    settings: Option<String>,
}

impl Opened {
    /// Reads a picture, and all that a report shows of it if there is one.
    pub(super) fn new(path: &Path, is_reported: bool) -> Result<Self, String> {
        let (picture, file) = (Picture::open(path)?, path.display().to_string());
        if !is_reported {
            return Ok(Self { picture, file, bytes: Vec::new(), settings: None });
        }
        let bytes = std::fs::read(path).map_err(|error| format!("cannot read {file}: {error}"))?;
        Ok(Self { picture, file, bytes, settings: settings_in(path) })
    }

    fn shown(&self) -> Shown<'_> {
        let Self { picture, file, bytes, settings } = self;
        Shown { file: file.clone(), bytes, picture, settings: settings.clone() }
    }
}

/// The settings in a PNG of Specula as TOML, with its model and its shader tree.
fn settings_in(path: &Path) -> Option<String> {
    let is_png = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
    let look = is_png.then(|| read_look(path).ok()).flatten()?;
    let line = |name: &str, path: &Path| {
        let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        format!("{name} = {}\n", toml::Value::from(path.display().to_string()))
    };
    let files = [("model_file", look.model), ("shader_tree", look.shaders)];
    let files: String = files.iter().filter_map(|(name, path)| Some(line(name, path.as_ref()?))).collect();
    Some(files + &look.settings.to_toml())
}

/// The part of the report about two pictures, of which one may be missing.
pub(super) fn reported(
    (name, compared): (&str, &Result<Comparison, String>),
    sides: [Option<&Opened>; 2],
    limits: Limits,
) -> Result<ReportPair, String> {
    let [a, b] = sides.map(|side| side.map(Opened::shown));
    match (compared, &a, &b) {
        (Ok(found), Some(a), Some(b)) => ReportPair::compared(name, [a, b], found, limits),
        (Ok(_), ..) => ReportPair::failed(name, [a.as_ref(), b.as_ref()], "a picture is missing".to_owned()),
        (Err(why), ..) => ReportPair::failed(name, [a.as_ref(), b.as_ref()], why.clone()),
    }
}

/// Writes the report.
pub(super) fn write_report(
    path: &Path,
    [a, b]: [&Path; 2],
    limits: Limits,
    pairs: Vec<ReportPair>,
) -> Result<(), Failure> {
    let title = format!("{} and {}", a.display(), b.display());
    write_page(path, &page(&title, &options(limits), pairs))
}
