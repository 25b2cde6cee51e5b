//! Colors, fonts and spacing of the window, dark and light: one accent, three grays of text, two sizes of type ([`BODY`] and [`SMALL`]).
//!
//! The colors are resolved by a thread-local of the window's thread, the one global of the program.

use std::cell::Cell;

use egui::style::WidgetVisuals;
use egui::{
    Color32, CornerRadius, FontData, FontDefinitions, FontFamily, FontId, Id, LayerId, Popup, PopupAnchor, RichText,
    Stroke, TextStyle, Theme,
};

/// Size of text, in points.
const BODY: f32 = 13.0;
/// Size of notes, and of text that is drawn by hand in dense rows and over pictures, in points.
const SMALL: f32 = 11.0;
/// A press and a release within this time are a click, seconds.
const LONGEST_CLICK_S: f64 = 10.0;

/// A color of the window, which depends on the theme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::app) struct Tone {
    dark: Color32,
    light: Color32,
}

impl Tone {
    pub(in crate::app) const fn new(dark: u32, light: u32) -> Self {
        Self { dark: opaque(dark), light: opaque(light) }
    }

    /// The color in the present theme.
    pub(in crate::app) fn color(self) -> Color32 {
        self.of(if IS_LIGHT.get() { Theme::Light } else { Theme::Dark })
    }

    fn of(self, theme: Theme) -> Color32 {
        if theme == Theme::Light { self.light } else { self.dark }
    }
}

impl From<Tone> for Color32 {
    fn from(tone: Tone) -> Self {
        tone.color()
    }
}

thread_local! {
    /// The theme of the window that this thread draws, so that a color needs no context to be resolved.
    static IS_LIGHT: Cell<bool> = const { Cell::new(false) };
}

const fn opaque(hex: u32) -> Color32 {
    Color32::from_rgb((hex >> 16) as u8, (hex >> 8) as u8, hex as u8)
}

/// Background of the panels.
pub(in crate::app) const PANEL: Tone = Tone::new(0x181b1f, 0xf5f6f8);
/// Between the panels, and behind their tabs.
pub(in crate::app) const EDGE: Tone = Tone::new(0x121417, 0xdfe3e8);
/// The bars above and below the panels. egui's renderer blends the edges of shapes such that a light button on the light [`EDGE`]
/// gets a white rim.
pub(in crate::app) const BAR: Tone = Tone::new(0x121417, 0xf5f6f8);
/// Buttons, fields and what lies above a panel.
pub(in crate::app) const RAISED: Tone = Tone::new(0x282d33, 0xe3e7ec);
/// The same under the mouse.
const HOVERED: Tone = Tone::new(0x363d45, 0xd3d9e0);
/// Lines around fields and cards.
pub(in crate::app) const LINE: Tone = Tone::new(0x363c43, 0xc3cad2);
/// Behind text in cards over the picture.
pub(in crate::app) const CARD: Tone = Tone::new(0x15171a, 0xfbfcfd);
/// Titles and what is chosen.
pub(in crate::app) const STRONG: Tone = Tone::new(0xf4f5f7, 0x0e1012);
/// Text.
pub(in crate::app) const TEXT: Tone = Tone::new(0xd6dadf, 0x24282d);
/// Explanations.
pub(in crate::app) const QUIET: Tone = Tone::new(0x98a0aa, 0x565e68);
/// Links, what is chosen, and what the user has set.
pub(in crate::app) const ACCENT: Tone = Tone::new(0xf0a63c, 0x915400);
/// Behind what is chosen.
const SELECTED: Tone = Tone::new(0x5a411a, 0xf5d9ab);
/// Handles over the picture, in both themes.
pub(in crate::app) const PICTURE_ACCENT: Color32 = Color32::from_rgb(0xf0, 0xa6, 0x3c);
/// Around what is selected in the picture, in both themes.
pub(in crate::app) const SELECTION: Color32 = Color32::from_rgb(255, 160, 48);
/// Errors.
pub(in crate::app) const ERROR: Tone = Tone::new(0xff6e64, 0xb0221a);
/// Warnings.
pub(in crate::app) const WARNING: Tone = Tone::new(0xffc45c, 0x7a5a00);
/// All is well.
pub(in crate::app) const GOOD: Tone = Tone::new(0x70c982, 0x2a732c);

/// Code: keywords, types, functions, numbers, directives, comments, and the values beside it.
pub(in crate::app) const CODE_KEYWORD: Tone = Tone::new(0xc792ea, 0x7a2fa0);
pub(in crate::app) const CODE_TYPE: Tone = Tone::new(0x6cc5b8, 0x0b665c);
pub(in crate::app) const CODE_FUNCTION: Tone = Tone::new(0x8fb8f0, 0x1d4f91);
pub(in crate::app) const CODE_NUMBER: Tone = Tone::new(0xe8a27c, 0x8a3f12);
pub(in crate::app) const CODE_DIRECTIVE: Tone = Tone::new(0xb0a4c8, 0x5c4a80);
pub(in crate::app) const CODE_COMMENT: Tone = Tone::new(0x7f8a96, 0x5f6a75);
pub(in crate::app) const CODE_VALUE: Tone = Tone::new(0x5fd0ff, 0x00609c);

/// Icons of the Phosphor font.
pub(in crate::app) mod icon {
    pub(in crate::app) use egui_phosphor::regular::{
        ARROWS_LEFT_RIGHT, BELL, CHART_BAR, FOLDER_OPEN, GRID_FOUR, LAYOUT, LIST, MAGNIFYING_GLASS, MOON, QUESTION,
        SKIP_BACK, SQUARES_FOUR, SUN, X,
    };
}

/// Sets fonts and spacing, and the colors of both themes. The dark one is shown.
pub(in crate::app) fn apply(egui: &egui::Context) {
    let mut fonts = FontDefinitions::default();
    egui_phosphor::add_to_fonts(&mut fonts, egui_phosphor::Variant::Regular);
    // The π of the font for text reads as n.
    let pi = FontData::from_static(include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/fonts/pi.ttf")));
    fonts.font_data.insert("pi".to_owned(), pi.into());
    fonts.families.entry(FontFamily::Proportional).or_default().insert(0, "pi".to_owned());
    egui.set_fonts(fonts);
    for theme in [Theme::Dark, Theme::Light] {
        egui.style_mut_of(theme, |style| colors(style, theme));
    }
    egui.all_styles_mut(|style| {
        style.text_styles.insert(TextStyle::Heading, FontId::proportional(BODY));
        style.text_styles.insert(TextStyle::Body, FontId::proportional(BODY));
        style.text_styles.insert(TextStyle::Button, FontId::proportional(BODY));
        style.text_styles.insert(TextStyle::Monospace, FontId::monospace(BODY));
        style.text_styles.insert(TextStyle::Small, FontId::proportional(SMALL));
        style.spacing.item_spacing = egui::vec2(6.0, 4.0);
        // Keeps the bar beside the content even while it is wide, under the mouse.
        let scroll = &mut style.spacing.scroll;
        scroll.floating_allocated_width = scroll.bar_width + scroll.bar_inner_margin;
    });
    // egui takes the times of frames for those of presses, and a frame of a slow device may last a second.
    egui.options_mut(|options| options.input_options.max_click_duration = LONGEST_CLICK_S);
    choose(egui, false);
}

/// The font of text.
pub(in crate::app) const fn body_font() -> FontId {
    FontId::proportional(BODY)
}

/// The font of notes.
pub(in crate::app) const fn small_font() -> FontId {
    FontId::proportional(SMALL)
}

/// The small font whose characters have one width.
pub(in crate::app) const fn small_mono_font() -> FontId {
    FontId::monospace(SMALL)
}

/// Small text whose characters have one width.
pub(in crate::app) fn small_mono(text: impl Into<String>) -> RichText {
    RichText::new(text).font(small_mono_font())
}

/// Hides the hover texts of the panels in this frame, as an open menu does.
pub(in crate::app) fn hide_hover_texts(egui: &egui::Context) {
    // A popup that is never placed: it counts as open, and draws nothing.
    let id = Id::new("no hover texts");
    Popup::new(id, egui.clone(), PopupAnchor::PointerFixed, LayerId::background()).show(|_| ());
}

/// Shows the dark or the light theme.
pub(in crate::app) fn choose(egui: &egui::Context, is_light: bool) {
    IS_LIGHT.set(is_light);
    egui.set_theme(if is_light { Theme::Light } else { Theme::Dark });
}

fn colors(style: &mut egui::Style, theme: Theme) {
    let visuals = &mut style.visuals;
    let of = |tone: Tone| tone.of(theme);
    visuals.panel_fill = of(PANEL);
    visuals.window_fill = of(PANEL);
    visuals.window_stroke = Stroke::new(1.0, of(LINE));
    visuals.extreme_bg_color = of(EDGE);
    visuals.faint_bg_color = of(RAISED);
    visuals.code_bg_color = of(RAISED);
    visuals.selection.bg_fill = of(SELECTED);
    visuals.selection.stroke = Stroke::new(1.0, of(STRONG));
    visuals.hyperlink_color = of(ACCENT);
    visuals.error_fg_color = of(ERROR);
    visuals.warn_fg_color = of(WARNING);
    visuals.weak_text_color = Some(of(QUIET));
    // Shaders have linear colors.
    visuals.numeric_color_space = egui::style::NumericColorSpace::Linear;
    visuals.handle_shape = egui::style::HandleShape::Circle;
    let widget = |fill: Tone, line: Option<Tone>, text: Tone| WidgetVisuals {
        bg_fill: of(fill),
        weak_bg_fill: of(fill),
        bg_stroke: line.map_or(Stroke::NONE, |line| Stroke::new(1.0, of(line))),
        corner_radius: CornerRadius::same(4),
        fg_stroke: Stroke::new(1.0, of(text)),
        expansion: 0.0,
    };
    visuals.widgets.noninteractive = widget(PANEL, Some(LINE), TEXT);
    visuals.widgets.inactive = widget(RAISED, None, TEXT);
    if theme == Theme::Light {
        // Boxes and rails, which have no text of their own.
        visuals.widgets.inactive.bg_fill = of(LINE);
    }
    visuals.widgets.hovered = widget(HOVERED, Some(LINE), STRONG);
    visuals.widgets.active = widget(HOVERED, Some(ACCENT), STRONG);
    visuals.widgets.open = widget(HOVERED, Some(LINE), STRONG);
}

#[cfg(test)]
mod tests {
    use egui::{Event, Modifiers, PointerButton, Ui};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    use super::*;

    /// The contrast of two colors (WCAG 2.1).
    fn contrast(a: Color32, b: Color32) -> f32 {
        let luminance = |color: Color32| {
            let [r, g, b, _] = egui::Rgba::from(color).to_array();
            0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05
        };
        let (a, b) = (luminance(a), luminance(b));
        a.max(b) / a.min(b)
    }

    #[test]
    fn text_has_contrast_in_both_themes() {
        for theme in [Theme::Dark, Theme::Light] {
            for text in [STRONG, TEXT, QUIET, ACCENT, ERROR, WARNING, GOOD] {
                for back in [PANEL, EDGE, BAR, CARD] {
                    let ratio = contrast(text.of(theme), back.of(theme));
                    assert!(ratio >= 4.5, "{theme:?}: {text:?} on {back:?} {ratio}");
                }
            }
            for back in [RAISED, HOVERED, SELECTED] {
                assert!(contrast(STRONG.of(theme), back.of(theme)) >= 4.5, "{theme:?} {back:?}");
            }
        }
    }

    #[test]
    fn text_has_two_sizes() {
        let egui = egui::Context::default();
        apply(&egui);
        let sizes: Vec<f32> = egui.style_of(Theme::Dark).text_styles.values().map(|font| font.size).collect();
        assert!(sizes.iter().all(|size| [SMALL, BODY].contains(size)), "{sizes:?}");
    }

    #[test]
    fn a_color_follows_the_theme() {
        let egui = egui::Context::default();
        apply(&egui);
        assert_eq!(Color32::from(PANEL), PANEL.dark);
        choose(&egui, true);
        assert_eq!(Color32::from(PANEL), PANEL.light);
        assert_eq!(egui.style_of(Theme::Light).visuals.panel_fill, PANEL.light);
    }

    #[test]
    fn a_click_counts_although_frames_are_slow() {
        let show = |ui: &mut Ui, clicks: &mut u32| *clicks += u32::from(ui.button("Stop").clicked());
        let mut harness = Harness::builder().with_step_dt(1.5).build_ui_state(show, 0);
        apply(&harness.ctx);
        harness.step();
        let pos = harness.get_by_label("Stop").rect().center();
        harness.event(Event::PointerMoved(pos));
        harness.step();
        for pressed in [true, false] {
            harness.event(Event::PointerButton {
                pos,
                button: PointerButton::Primary,
                pressed,
                modifiers: Modifiers::default(),
            });
            harness.step();
        }
        assert_eq!(*harness.state(), 1);
    }
}
