//! Colors, fonts and spacing of the window.

use egui::{Color32, FontId, TextStyle};

/// Background of the panels.
pub(in crate::app) const PANEL: Color32 = Color32::from_rgb(24, 25, 28);
/// Between the panels, and behind their tabs.
pub(in crate::app) const EDGE: Color32 = Color32::from_rgb(15, 16, 18);
/// Links, and what the user has set.
pub(in crate::app) const ACCENT: Color32 = Color32::from_rgb(94, 182, 255);
/// Behind what is chosen.
const SELECTED: Color32 = Color32::from_rgb(35, 86, 134);
/// Around what is selected in the picture. Orange stands out from skies, metals and the accent.
pub(in crate::app) const SELECTION: Color32 = Color32::from_rgb(255, 160, 48);
/// Errors.
pub(in crate::app) const ERROR: Color32 = Color32::from_rgb(255, 110, 100);
/// Warnings.
pub(in crate::app) const WARNING: Color32 = Color32::from_rgb(255, 196, 92);
/// All is well.
pub(in crate::app) const GOOD: Color32 = Color32::from_rgb(112, 201, 130);
/// Explanations. 6.5:1 on a panel.
pub(in crate::app) const QUIET: Color32 = Color32::from_rgb(150, 154, 162);

/// Sets colors, fonts and spacing.
pub(in crate::app) fn apply(egui: &egui::Context) {
    egui.set_theme(egui::Theme::Dark);
    egui.all_styles_mut(|style| {
        style.visuals.panel_fill = PANEL;
        style.visuals.window_fill = PANEL;
        style.visuals.extreme_bg_color = EDGE;
        style.visuals.selection.bg_fill = SELECTED;
        style.visuals.hyperlink_color = ACCENT;
        style.text_styles.insert(TextStyle::Body, FontId::proportional(13.0));
        style.text_styles.insert(TextStyle::Button, FontId::proportional(13.0));
        style.text_styles.insert(TextStyle::Monospace, FontId::monospace(12.5));
        style.text_styles.insert(TextStyle::Small, FontId::proportional(11.0));
        style.spacing.item_spacing = egui::vec2(6.0, 4.0);
        // Keeps the bar beside the content even while it is wide, under the mouse.
        let scroll = &mut style.spacing.scroll;
        scroll.floating_allocated_width = scroll.bar_width + scroll.bar_inner_margin;
    });
}
