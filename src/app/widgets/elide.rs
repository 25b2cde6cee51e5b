//! Names that are cut in the middle where they do not fit, since it is often their ends that differ.

use egui::{Color32, FontId, Painter};

/// A name that is at most `width` points wide: the whole, or its beginning and its end around an ellipsis.
pub(in crate::app) fn middle(painter: &Painter, name: &str, font: &FontId, width: f32) -> String {
    let fits = |text: &str| painter.layout_no_wrap(text.to_owned(), font.clone(), Color32::WHITE).size().x <= width;
    if fits(name) {
        return name.to_owned();
    }
    let letters: Vec<char> = name.chars().collect();
    let cut = |kept: usize| -> String {
        let (begin, end) = (kept.div_ceil(2), letters.len() - kept / 2);
        letters[..begin].iter().chain(&['…']).chain(&letters[end..]).collect()
    };
    // The most letters that fit.
    let (mut low, mut high) = (0, letters.len());
    while low + 1 < high {
        let kept = usize::midpoint(low, high);
        *if fits(&cut(kept)) { &mut low } else { &mut high } = kept;
    }
    cut(low)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::theme;

    #[test]
    fn names_keep_their_ends() {
        let egui = egui::Context::default();
        theme::apply(&egui);
        let mut cut = Vec::new();
        let _ = egui.run_ui(egui::RawInput::default(), |ui| {
            let of = |name: &str, width| middle(ui.painter(), name, &theme::body_font(), width);
            cut = vec![
                of("Duck", 200.0),
                of("FlightHelmet_Material_01", 90.0),
                of("FlightHelmet_Material_02", 90.0),
                of("Duck", 1.0),
            ];
        });
        assert_eq!((cut[0].as_str(), cut[3].as_str()), ("Duck", "…"));
        assert!(cut[1].starts_with("Flight") && cut[1].ends_with("_01") && cut[1].contains('…'), "{cut:?}");
        assert_ne!(cut[1], cut[2]);
    }
}
