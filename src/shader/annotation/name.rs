//! Names of passes, textures and images.

use super::cursor::Cursor;
use crate::message::did_you_mean;
use crate::shader::diagnostic::Diagnostic;

/// Names that no pass or texture can have, since they name images that Specula gives to passes.
const RESERVED: [&str; 3] = ["picture", "depth", "behind"];

/// Parses the name after `//@pass` or `//@texture`: a GLSL identifier.
pub(super) fn name(cursor: &mut Cursor<'_>, what: &str) -> Result<String, Box<Diagnostic>> {
    let (bytes, name) = cursor.word();
    check_name(name, what).map_err(|message| cursor.error(bytes, message))?;
    Ok(name.to_owned())
}

/// Checks the name of a pass, a texture or an image.
pub(super) fn check_name(name: &str, what: &str) -> Result<(), String> {
    if !is_name(name) {
        let plain: String = name.chars().map(|c| if c == '-' { '_' } else { c.to_ascii_lowercase() }).collect();
        let hint = did_you_mean(&plain, is_name(&plain).then_some(plain.as_str()));
        let found = if name.is_empty() { "the end of the line".to_owned() } else { format!("`{name}`.{hint}") };
        return Err(format!("expected the {what}'s name, a letter a-z and then a-z, 0-9 or _; found {found}"));
    }
    if RESERVED.contains(&name) || name.starts_with("before_") {
        return Err(format!("`{name}` names what Specula draws; choose another name for the {what}"));
    }
    Ok(())
}

fn is_name(name: &str) -> bool {
    let is_part = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    name.starts_with(|c: char| c.is_ascii_lowercase()) && name.chars().all(is_part) && !name.starts_with("gl_")
}
