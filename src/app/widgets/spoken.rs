//! Names that a screen reader reads aloud for controls that show a symbol or a picture instead.

use egui::{Response, WidgetInfo, WidgetType};

/// Names something that is drawn by hand and can be clicked.
pub(in crate::app) fn button(response: &Response, name: &str) {
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, response.enabled(), name));
}

/// Names a control of egui's that has no text, or a symbol in it.
pub(in crate::app) fn named(response: Response, name: &str) -> Response {
    response.ctx.accesskit_node_builder(response.id, |node| node.set_label(name));
    response
}
