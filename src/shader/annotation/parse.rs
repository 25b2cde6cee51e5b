//! Parses `//@` comments. An error has a column and says what was expected.

use super::cursor::Cursor;
use super::mode::{Mode, mode};
use super::parse_pass::pass;
use super::pass::PassDesc;
use super::place::AnnotationPlace;
use super::texture::{self, TextureDesc};
use super::ui::{Ui, ui};
use crate::message::did_you_mean;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::{Line, lines};

/// A parsed annotation.
#[derive(Debug)]
pub enum Annotation {
    /// `//@mode`, where it stands, and where its number stands.
    Mode(Mode, [AnnotationPlace; 2]),
    /// `//@ui`
    Ui(Ui),
    /// `//@pass`
    Pass(PassDesc),
    /// `//@texture`
    Texture(TextureDesc),
}

/// Reads all annotations of a file.
pub fn parse_file(file: &str, text: &str) -> (Vec<Annotation>, Vec<Diagnostic>) {
    if !text.contains("//@") {
        return (Vec::new(), Vec::new());
    }
    let lines = lines(text);
    let (mut found, mut errors) = (Vec::new(), Vec::new());
    for (index, line) in lines.iter().enumerate() {
        let Some(start) = line.annotation else { continue };
        let end = line.raw.trim_end().len();
        let place =
            AnnotationPlace { file: file.to_owned(), line: line.number, raw: line.raw.to_owned(), bytes: start..end };
        let own = (!line.is_blank()).then_some(line);
        let declaration = own.or_else(|| lines[index + 1..].iter().find(|line| !line.is_blank()));
        match parse(place, start, declaration) {
            Ok(one) => found.push(one),
            Err(error) => errors.push(*error),
        }
    }
    (found, errors)
}

fn parse(place: AnnotationPlace, start: usize, declaration: Option<&Line<'_>>) -> Result<Annotation, Box<Diagnostic>> {
    let raw = place.raw.clone();
    let mut cursor = Cursor::new(&place, &raw, start + "//@".len());
    let (bytes, kind) = cursor.word();
    match kind {
        "mode" => {
            let (mode, number) = mode(&mut cursor, declaration)?;
            Ok(Annotation::Mode(mode, [place, number]))
        }
        "ui" => {
            let ui = ui(&mut cursor, declaration)?;
            Ok(Annotation::Ui(Ui { place, ..ui }))
        }
        "pass" => pass(&mut cursor).map(Annotation::Pass),
        "texture" => texture::texture(&mut cursor).map(Annotation::Texture),
        _ => {
            let hint = did_you_mean(kind, ["mode", "ui", "pass", "texture"]);
            let hint = hint.replace("mean `", "mean `//@");
            let message = format!("expected `//@mode`, `//@ui`, `//@pass` or `//@texture`, found `//@{kind}`.{hint}");
            let error = *cursor.error(start..bytes.end, message);
            Err(Box::new(match kind {
                "buffer" => error.with_help("a buffer needs no annotation: `buffer Particles { vec4 at[1024]; };`"),
                _ => error,
            }))
        }
    }
}
