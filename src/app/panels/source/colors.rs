//! The colors of code.

use std::ops::Range;

use egui::Color32;
use egui::text::{LayoutJob, TextFormat};

use crate::app::widgets::theme::{
    ACCENT, CODE_COMMENT, CODE_DIRECTIVE, CODE_FUNCTION, CODE_KEYWORD, CODE_NUMBER, CODE_TYPE, TEXT, small_mono_font,
};
use crate::shader::Highlight;

/// Height of a row, in points.
pub(super) const ROW: f32 = 17.0;

/// A text with the colors of its parts, with this opacity. `line_height`: that of its lines, if it has several.
pub(super) fn colored(
    text: &str,
    parts: &[(Range<usize>, Highlight)],
    opacity: f32,
    line_height: Option<f32>,
) -> LayoutJob {
    let mut job = LayoutJob::default();
    job.wrap.max_width = f32::INFINITY;
    let mut add = |text: &str, color: Color32| {
        let font_id = small_mono_font();
        let color = color.gamma_multiply(opacity);
        job.append(text, 0.0, TextFormat { font_id, color, line_height, ..TextFormat::default() });
    };
    let mut at = 0;
    for (bytes, highlight) in parts {
        add(&text[at..bytes.start], TEXT.color());
        add(&text[bytes.clone()], color(*highlight));
        at = bytes.end;
    }
    add(&text[at..], TEXT.color());
    job
}

fn color(highlight: Highlight) -> Color32 {
    match highlight {
        Highlight::Keyword => CODE_KEYWORD,
        Highlight::Type => CODE_TYPE,
        Highlight::Function => CODE_FUNCTION,
        Highlight::Number | Highlight::Constant => CODE_NUMBER,
        Highlight::Text => ACCENT,
        Highlight::Directive | Highlight::Annotation => CODE_DIRECTIVE,
        Highlight::Comment => CODE_COMMENT,
    }
    .color()
}
