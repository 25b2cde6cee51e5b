//! Functions that are folded to their first line.

use std::collections::BTreeSet;

use egui::{RichText, Ui};

use super::functions::Function;
use super::model::CodeModel;
use crate::app::state::trace::rows::Reach;
use crate::shader::TreePath;

/// The functions that are folded, by their files.
#[derive(Default)]
pub(super) struct Folds(BTreeSet<(TreePath, String)>);

impl Folds {
    /// The folded functions of a file.
    pub(super) fn of(&self, path: &TreePath) -> BTreeSet<String> {
        self.0.iter().filter(|(of, _)| of == path).map(|(_, name)| name.clone()).collect()
    }

    /// Folds a function, or opens it.
    pub(super) fn toggle(&mut self, path: &TreePath, name: &str) {
        let of = (path.clone(), name.to_owned());
        if !self.0.remove(&of) {
            self.0.insert(of);
        }
    }

    /// Opens the function that hides a line, by its index. Returns whether there is one.
    pub(super) fn open_at(&mut self, model: &CodeModel, line: usize) -> bool {
        let Some(path) = model.path() else { return false };
        let hides = |function: &&Function| function.lines.start < line && function.lines.contains(&line);
        let hiding = model.functions().iter().filter(hides);
        let names: Vec<(TreePath, String)> = hiding.map(|function| (path.clone(), function.name.clone())).collect();
        let count = self.0.len();
        names.iter().for_each(|name| drop(self.0.take(name)));
        self.0.len() < count
    }

    /// Folds exactly these functions of a file.
    fn set<'a>(&mut self, path: &TreePath, functions: impl Iterator<Item = &'a Function>) {
        self.0.retain(|(of, _)| of != path);
        self.0.extend(functions.map(|function| (path.clone(), function.name.clone())));
    }

    /// Shows the menu that folds several functions.
    pub(super) fn menu(&mut self, ui: &mut Ui, model: &CodeModel) {
        let Some(path) = model.path().filter(|_| !model.functions().is_empty()) else { return };
        let is_reached = |function: &&Function| {
            model.lines[function.lines.clone()].iter().any(|line| line.row.reach == Reach::Reached)
        };
        let has_trace = model.functions().iter().any(|function| is_reached(&function));
        let hint = "Fold functions to their first line. A click on the triangle beside a function does the same";
        let menu = ui.menu_button(RichText::new("Fold").small(), |ui| {
            if ui.button("All functions").clicked() {
                self.set(path, model.functions().iter());
            }
            let button = ui.add_enabled(has_trace, egui::Button::new("Functions that the pixel does not reach"));
            if button.on_disabled_hover_text("No function of this file is reached, or no pixel is pinned").clicked() {
                self.set(path, model.functions().iter().filter(|function| !is_reached(function)));
            }
            if ui.button("None").clicked() {
                self.set(path, std::iter::empty());
            }
        });
        menu.response.on_hover_text(hint);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folding_is_by_file() {
        let mut folds = Folds::default();
        folds.toggle(&"a.glsl".into(), "f 0");
        folds.toggle(&"b.glsl".into(), "g 0");
        assert_eq!(folds.of(&"a.glsl".into()), BTreeSet::from(["f 0".to_owned()]));
        folds.toggle(&"a.glsl".into(), "f 0");
        assert!(folds.of(&"a.glsl".into()).is_empty());
        assert_eq!(folds.of(&"b.glsl".into()).len(), 1);
    }
}
