//! Colors in annotations: the default of `//@ui color`, linear RGB, and the `colors=` of a mode, sRGB.

use std::ops::Range;

use lsp_types::{Color, ColorInformation, ColorPresentation, Range as Span, TextEdit};

use super::source_file::SourceFile;
use crate::shader::glsl::{Line, lines};

/// The colors of a file.
pub fn colors(file: &SourceFile) -> Vec<ColorInformation> {
    if file.is_too_long() {
        return Vec::new();
    }
    let all = lines(file.text());
    let found = all.iter().flat_map(|line| {
        of_line(line).into_iter().map(|(bytes, color)| (line.start + bytes.start..line.start + bytes.end, color))
    });
    found.map(|(bytes, color)| ColorInformation { range: file.source.span(bytes), color }).collect()
}

/// The colors in the annotation of a line, with their bytes in it.
fn of_line(line: &Line<'_>) -> Vec<(Range<usize>, Color)> {
    let Some(start) = line.annotation else { return Vec::new() };
    let text = &line.raw[start..];
    if text.starts_with("//@mode") {
        let hexes = text.match_indices('#').filter_map(|(at, _)| {
            let digits = text.get(at + 1..at + 7)?;
            let [_, r, g, b] = u32::from_str_radix(digits, 16).ok()?.to_be_bytes();
            let [red, green, blue] = [r, g, b].map(|part| f32::from(part) / 255.0);
            Some((start + at..start + at + 7, Color { red, green, blue, alpha: 1.0 }))
        });
        return hexes.collect();
    }
    let is_color = text.starts_with("//@ui") && text.split_whitespace().any(|word| word == "color");
    let default = text.rfind(" = ").filter(|_| is_color).map(|at| at + 3);
    let of_default = default.and_then(|at| {
        let values = text[at..].trim_end();
        let numbers: Vec<f32> = values.split_whitespace().map_while(|word| word.parse().ok()).collect();
        let (red, green, blue, alpha) = match numbers[..] {
            [r, g, b] => (r, g, b, 1.0),
            [r, g, b, a] => (r, g, b, a),
            _ => return None,
        };
        let from = start + at + text[at..].len() - text[at..].trim_start().len();
        let color = Color { red: to_srgb(red), green: to_srgb(green), blue: to_srgb(blue), alpha };
        Some((from..start + at + values.len(), color))
    });
    of_default.into_iter().collect()
}

/// How a color is written in place of the one at a span.
pub fn presentation(file: &SourceFile, color: Color, span: Span) -> Vec<ColorPresentation> {
    let bytes = file.source.bytes(span);
    let old = file.text().get(bytes).unwrap_or_default();
    let parts = [color.red, color.green, color.blue];
    let text = if old.starts_with('#') {
        let [r, g, b] = parts.map(|part| (part.clamp(0.0, 1.0) * 255.0).round() as u8);
        format!("#{r:02x}{g:02x}{b:02x}")
    } else {
        let mut numbers: Vec<String> = parts.map(|part| short(to_linear(part))).to_vec();
        numbers.extend((old.split_whitespace().count() == 4).then(|| short(color.alpha)));
        numbers.join(" ")
    };
    vec![ColorPresentation {
        label: text.clone(),
        text_edit: Some(TextEdit::new(span, text)),
        additional_text_edits: None,
    }]
}

fn short(number: f32) -> String {
    let text = format!("{number:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn to_srgb(linear: f32) -> f32 {
    let linear = linear.clamp(0.0, 1.0);
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

fn to_linear(srgb: f32) -> f32 {
    let srgb = srgb.clamp(0.0, 1.0);
    if srgb <= 0.040_45 { srgb / 12.92 } else { ((srgb + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lsp::source_text::SourceText;

    #[test]
    fn a_color_is_read_and_written_as_it_is_declared() {
        let text = "vec3 a; //@ui \"A = 1\" color = 1 0.5 0\n//@mode m \"M\" numbers=\"a|b\" colors=\"#3fbc59|-\"\nvec3 b; //@ui 0..1 = 1 2 3\n";
        let uri = crate::lsp::uri::uri_of(std::path::Path::new("/a.glsl")).unwrap();
        let file = SourceFile::new(uri, SourceText::new(text));
        let found = colors(&file);
        let texts: Vec<&str> = found.iter().map(|color| &text[file.source.bytes(color.range)]).collect();
        assert_eq!(texts, ["1 0.5 0", "#3fbc59"]);
        for color in found {
            let written = &presentation(&file, color.color, color.range)[0].label;
            assert_eq!(written, &text[file.source.bytes(color.range)]);
        }
    }
}
