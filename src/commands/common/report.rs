//! `--report`: a page of HTML about the result.

use std::path::Path;

use specula::message;
use specula::picture;
use specula::report::Report;

use crate::commands::Failure;

/// Fails before any work when no page can be written to `path`.
pub fn check_report(path: &Path) -> Result<(), Failure> {
    let is_page =
        path.extension().is_some_and(|ending| ["html", "htm"].iter().any(|of| ending.eq_ignore_ascii_case(of)));
    if !is_page {
        return Err(Failure::Usage(format!("cannot write {}: a report must end in .html", path.display())));
    }
    picture::check_place(path).map_err(Failure::Input)
}

/// Writes the page of a report.
pub fn write_report(path: &Path, report: &Report) -> Result<(), Failure> {
    write_page(path, &report.html())
}

/// Writes a page, and says where it is.
pub fn write_page(path: &Path, html: &str) -> Result<(), Failure> {
    let cannot = |error: std::io::Error| Failure::Input(format!("cannot write {}: {error}", path.display()));
    picture::replace_file(path, html.as_bytes()).map_err(cannot)?;
    message::tell(format_args!("wrote {}", path.display()));
    Ok(())
}
