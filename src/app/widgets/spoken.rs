//! Names that a screen reader reads aloud for controls that show a symbol or a picture instead.

use egui::{Response, WidgetInfo, WidgetType};

/// Gives a clickable, hand-drawn element its accessibility label.
pub(in crate::app) fn button(response: &Response, name: &str) {
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, response.enabled(), name));
}

/// Gives an egui control without text, or with a symbol, its accessibility label.
pub(in crate::app) fn named(response: Response, name: &str) -> Response {
    response.ctx.accesskit_node_builder(response.id, |node| node.set_label(name));
    response
}
