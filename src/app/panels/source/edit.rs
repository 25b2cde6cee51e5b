//! The file as the user types it: text in colors, with the values beside it. Ctrl+S saves it.

use std::collections::BTreeMap;
use std::sync::Arc;

use egui::text::{CCursor, CCursorRange, LayoutJob};
use egui::text_edit::TextEditState;
use egui::{
    Event, Frame, Id, Key, Modifiers, Rect, ScrollArea, Sense, Shape, TextBuffer, TextEdit, Ui, UiBuilder, pos2, vec2,
};

use super::colors::{ROW, colored};
use super::find::Find;
use super::look::Look;
use super::model::CodeModel;
use super::row::{beside, message_beside};
use super::scroll::Scroll;
use crate::app::command::source::{SAVE_FILE, Typed};
use crate::app::commands::Commands;
use crate::app::state::State;
use crate::app::widgets::spoken::named;
use crate::app::widgets::theme::small_mono_font;
use crate::recovery::TypedText;
use crate::shader::{Source, TreePath, highlights};
use crate::write_back::TreeFile;

/// The spaces that Tab types.
const INDENT: &str = "    ";

/// A file that is typed.
struct Typing {
    /// Its path in the tree, which for a single file is not the one on disk.
    path: TreePath,
    /// The text with which the typing began, or that was saved last.
    base: Arc<str>,
    text: String,
    /// The text that is being written.
    sent: Option<Arc<str>>,
    /// The text that the tree had last.
    known: Arc<str>,
    /// The text of another program that has changed the same lines, so that the typed text was not saved.
    theirs: Option<Arc<str>>,
    /// Older texts of the file, which the tree may show until it has compiled the newest.
    older: Vec<Arc<str>>,
}

impl Typing {
    /// Takes a text of the tree. One that is older than what was saved is no change of another program.
    fn take(&mut self, now: &Arc<str>) {
        self.known = now.clone();
        if **now == *self.base {
            self.older.clear();
        } else if *self.base == *self.text && self.sent.is_none() && !self.older.contains(now) {
            (self.base, self.text) = (now.clone(), now.to_string());
        }
    }

    /// Takes the text that the file has since it was saved.
    fn saved(&mut self, text: Arc<str>) {
        let before = std::mem::replace(&mut self.base, text);
        self.older.retain(|older| *older != self.base);
        self.older.push(before);
    }
}

/// The files that are typed.
#[derive(Default)]
pub(super) struct Editor {
    files: BTreeMap<TreeFile, Typing>,
    /// The open tree, if the shown files are of it and can be written.
    source: Option<Source>,
    /// The character where the cursor goes, once the file is shown.
    cursor: Option<usize>,
    /// The last text in colors.
    colored: LayoutJob,
}

impl Editor {
    /// Begins to type into a file with this text, at the begin of a line, from 0.
    pub(super) fn begin(&mut self, path: &TreePath, text: &Arc<str>, line: usize) {
        let Some(file) = self.file(path) else { return };
        self.cursor = Some(text.split_inclusive('\n').take(line).map(|line| line.chars().count()).sum());
        let new = || {
            let (base, known) = (text.clone(), text.clone());
            Typing {
                path: path.clone(),
                base,
                text: text.to_string(),
                sent: None,
                known,
                theirs: None,
                older: Vec::new(),
            }
        };
        self.files.entry(file).or_insert_with(new);
    }

    /// Whether a file can be typed.
    pub(super) fn can_begin(&self, path: &TreePath) -> bool {
        self.file(path).is_some()
    }

    /// A file of the open tree.
    fn file(&self, path: &TreePath) -> Option<TreeFile> {
        let source = self.source.as_ref()?;
        Some(TreeFile { root: source.folder_of_files()?.to_owned(), path: source.path_of_file(path)? })
    }

    /// A file of the open tree as it is typed.
    fn typing(&self, path: &TreePath) -> Option<&Typing> {
        self.files.get(&self.file(path)?)
    }

    /// Ends the typing. Changes that were not saved are dropped.
    pub(super) fn end(&mut self, path: &TreePath) {
        self.file(path).and_then(|file| self.files.remove(&file));
    }

    /// Whether a file is typed.
    pub(super) fn has(&self, path: &TreePath) -> bool {
        self.typing(path).is_some()
    }

    /// Whether a file has changes that were not saved.
    pub(super) fn is_unsaved(&self, path: &TreePath) -> bool {
        self.typing(path).is_some_and(|file| *file.base != *file.text)
    }

    /// The texts that were not saved, those of other trees, too.
    pub(super) fn unsaved(&self) -> Vec<TypedText> {
        let unsaved = self.files.iter().filter(|(_, typing)| *typing.base != *typing.text);
        let typed =
            |(TreeFile { root, path: file }, Typing { path, base, text, .. }): (&TreeFile, &Typing)| TypedText {
                root: root.clone(),
                file: file.clone(),
                path: path.clone(),
                base: base.to_string(),
                text: text.clone(),
            };
        unsaved.map(typed).collect()
    }

    /// Goes on with texts that were typed in a window before this one.
    pub(super) fn restore(&mut self, typed: &[TypedText]) {
        for TypedText { root, file, path, base, text } in typed {
            let base: Arc<str> = base.as_str().into();
            let (path, text, known) = (path.clone(), text.clone(), base.clone());
            let file = TreeFile { root: root.clone(), path: file.clone() };
            let typing = Typing { path, base, text, sent: None, known, theirs: None, older: Vec::new() };
            self.files.entry(file).or_insert(typing);
        }
    }

    /// The text of another program that keeps the typed text from being saved.
    pub(super) fn conflict(&self, path: &TreePath) -> Option<Arc<str>> {
        self.typing(path)?.theirs.clone()
    }

    /// Ends a conflict: the text of the other program takes the place of the typed one, or is overwritten by it with the next save.
    pub(super) fn settle(&mut self, path: &TreePath, takes_theirs: bool) {
        let Some(typing) = self.file(path).and_then(|file| self.files.get_mut(&file)) else { return };
        let Some(theirs) = typing.theirs.take() else { return };
        if takes_theirs {
            typing.text = theirs.to_string();
        }
        typing.saved(theirs);
    }

    /// The typed text of a file.
    pub(super) fn text(&self, path: &TreePath) -> Option<Arc<str>> {
        self.typing(path).map(|file| file.text.as_str().into())
    }

    /// Follows what was written, and what other programs write to files that have no changes of the user.
    pub(super) fn update(&mut self, state: &State) {
        let Some(shaders) = &state.session.shaders else { return };
        self.source = state.is_tree_in_use().then(|| state.source.clone());
        if let Some(saved) = &state.traces.written
            && let Some(file) = self.files.get_mut(&saved.file)
            && let Some(sent) = file.sent.take_if(|sent| *sent == saved.typed)
        {
            match &saved.text {
                // With the changes of other programs, unless the user has gone on.
                Some(text) if *sent == *file.text => {
                    file.text = text.to_string();
                    file.saved(text.clone());
                }
                Some(_) => file.saved(sent),
                None => file.theirs.clone_from(&saved.theirs),
            }
        }
        let root = self.source.as_ref().and_then(|source| source.folder_of_files());
        for (_, file) in self.files.iter_mut().filter(|(of, _)| Some(&*of.root) == root) {
            let now = state.traces.saved.of(&file.path).or_else(|| shaders.author_text(&file.path));
            now.filter(|now| **now != file.known).into_iter().for_each(|now| file.take(now));
        }
    }

    /// The command that saves a file; `None` while it has no changes, or is being written.
    pub(super) fn save(&mut self, path: &TreePath) -> Option<Typed> {
        let file = self.file(path)?;
        let typing = self.files.get_mut(&file)?;
        if *typing.base == *typing.text || typing.sent.is_some() {
            return None;
        }
        let text: Arc<str> = typing.text.as_str().into();
        typing.sent = Some(text.clone());
        Some(Typed { file, base: typing.base.clone(), text })
    }

    /// Shows a file that is typed.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        state: &State,
        model: &CodeModel,
        (find, scroll): (&Find, &mut Scroll),
        commands: &mut Commands,
    ) {
        let Some(path) = model.path() else { return };
        if ui.input_mut(|input| input.consume_key(Modifiers::COMMAND, Key::S)) {
            self.save(path).into_iter().for_each(|typed| commands.push(SAVE_FILE.with(typed)));
        }
        let Some(of) = self.file(path) else { return };
        let Self { files, cursor, colored, .. } = self;
        let Some(file) = files.get_mut(&of) else { return };
        // Ctrl+Z takes back what was typed in this tree alone.
        let id = Id::new(("typed", &of.root, path.as_str()));
        // The click that begins to type is no click into the field, which would lose the keys.
        let is_clicked = ui.input(|input| input.pointer.any_down() || input.pointer.any_released());
        if cursor.is_some() && is_clicked {
            ui.ctx().request_repaint();
        }
        match cursor.take_if(|_| !is_clicked) {
            Some(at) => set_cursor(ui, id, at),
            None if ui.memory(|memory| memory.has_focus(id)) => take_keys(ui, id, &file.text),
            None => {}
        }
        let letter = ui.fonts_mut(|fonts| fonts.glyph_width(&small_mono_font(), '0'));
        let look = Look::new(letter, model.lines.len());
        let mut area = ScrollArea::both().id_salt("code").auto_shrink(false);
        if let Some(line) = scroll.take() {
            area = area.vertical_scroll_offset((ROW * line as f32 - ui.available_height() / 3.0).max(0.0));
        }
        if let Some(line) = scroll.take_top() {
            area = area.vertical_scroll_offset(ROW * line as f32);
        }
        let room = vec2(look.width(model.longest), ROW * (model.lines.len() + 2) as f32).max(ui.available_size());
        area.show_viewport(ui, |ui, viewport| {
            let whole = Rect::from_min_size(ui.max_rect().min, room);
            let left = whole.left() + look.gutter;
            ui.allocate_rect(whole, Sense::hover());
            let behind = ui.painter().add(Shape::Noop);
            // A line of text stands at the top of its row.
            let above = (ROW - ui.fonts_mut(|fonts| fonts.row_height(&small_mono_font()))) / 2.0;
            let field = Rect::from_min_max(pos2(left, whole.top() + above), whole.max);
            let top = -above + show_field(&mut ui.new_child(UiBuilder::new().max_rect(field)), file, id, colored);
            scroll.first = (viewport.top() / ROW) as usize;
            let count = (viewport.height() / ROW) as usize + 2;
            let columns = ui.clip_rect().x_range();
            let rows = model.lines.iter().enumerate().skip(scroll.first).take(count);
            let rows = rows.map(|(index, line)| {
                let y = top + ROW * index as f32;
                (Rect::from_x_y_ranges(columns, y..=y + ROW), line, model.lines.get(index + 1))
            });
            let of_row = |(sight, line, _)| beside(ui, (state, path), line, (sight, left), (&look, find), commands);
            let shapes: Vec<Shape> = rows.clone().map(of_row).collect();
            ui.painter().set(behind, Shape::Vec(shapes));
            // Over the values of the row below.
            rows.for_each(|(sight, line, below)| message_beside(ui, (line, below), (sight, left), &look));
        });
    }
}

/// Shows the text. Returns where it begins, points from the top of the window.
fn show_field(ui: &mut Ui, file: &mut Typing, id: Id, last: &mut LayoutJob) -> f32 {
    let mut layouter = |ui: &Ui, text: &dyn TextBuffer, _: f32| {
        if last.text != text.as_str() {
            *last = colored(text.as_str(), &highlights(text.as_str()), 1.0, Some(ROW));
        }
        ui.painter().layout_job(last.clone())
    };
    let field = TextEdit::multiline(&mut file.text).id(id).frame(Frame::NONE).margin(0.0).lock_focus(true);
    let output = field.desired_width(f32::INFINITY).desired_rows(1).layouter(&mut layouter).show(ui);
    named(output.response.response, "Text of the file");
    output.galley_pos.y
}

/// Gives the field the keys, with the cursor before a character.
fn set_cursor(ui: &Ui, id: Id, at: usize) {
    let mut state = TextEditState::load(ui.ctx(), id).unwrap_or_default();
    state.cursor.set_char_range(Some(CCursorRange::one(CCursor::new(at))));
    state.store(ui.ctx(), id);
    ui.memory_mut(|memory| memory.request_focus(id));
}

/// Tab types spaces, and Enter indents the next line like the last one.
fn take_keys(ui: &Ui, id: Id, text: &str) {
    let cursor = TextEditState::load(ui.ctx(), id).and_then(|state| state.cursor.char_range());
    let before = cursor.map_or(0, |range| range.as_sorted_char_range().start.0);
    let before: String = text.chars().take(before).collect();
    let line = before.rsplit('\n').next().unwrap_or_default();
    let indent: String = line.chars().take_while(|c| *c == ' ' || *c == '\t').collect();
    let deeper = if line.trim_end().ends_with('{') { INDENT } else { "" };
    let is_indented = !indent.is_empty() || !deeper.is_empty();
    ui.input_mut(|input| {
        for event in &mut input.events {
            let Event::Key { key, pressed: true, modifiers, .. } = event else { continue };
            let typed = match key {
                Key::Tab if !modifiers.any() => INDENT.to_owned(),
                Key::Enter if !modifiers.any() && is_indented => format!("\n{indent}{deeper}"),
                _ => continue,
            };
            *event = Event::Text(typed);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_older_text_of_the_tree_is_no_change_of_another_program() {
        let text = |text: &str| Arc::<str>::from(text);
        let mut file = Typing {
            path: "a.glsl".into(),
            base: text("a"),
            text: "b".to_owned(),
            sent: None,
            known: text("a"),
            theirs: None,
            older: Vec::new(),
        };
        file.saved(text("b"));
        file.text = "c".to_owned();
        file.saved(text("c"));
        // The compiles of both saves end one after the other.
        for now in ["a", "b", "c"] {
            file.take(&text(now));
            assert_eq!((&*file.base, file.text.as_str()), ("c", "c"), "{now}");
        }
        // Another program brings the first text back.
        file.take(&text("a"));
        assert_eq!((&*file.base, file.text.as_str()), ("a", "a"));
        file.text = "typed".to_owned();
        file.take(&text("d"));
        assert_eq!((&*file.base, file.text.as_str()), ("a", "typed"), "what is typed stays");
    }
}
