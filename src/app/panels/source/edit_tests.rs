//! Typing into files in the panel, without a device.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::colors::ROW;
use super::tests::{TEXT, Window, events, window};
use crate::app::command::source::{SAVE_FILE, Typed};
use crate::app::panels::panel_ui::PanelUi as _;
use crate::app::state::trace::saved::WrittenText;
use crate::app::state::workspace::PanelRequest;
use crate::recovery::TypedText;
use crate::shader::{Diagnostic, ShaderSet, Source, TreePath};
use crate::write_back::TreeFile;

/// While the user types, a mark stays with its line, and goes once the line is another.
#[test]
fn errors_move_with_their_lines_while_the_user_types() {
    let mut harness = window(TEXT, events(2.0), &[2, 3]);
    open(&mut harness, Path::new("tree"));
    let state = &mut harness.state_mut().state;
    let file = state.source.display_path(&"a.glsl".into());
    state.session.diagnostics = vec![Diagnostic::error(file, "'q' : undeclared").on_line(2, None)];
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, "Edit").click();
    harness.run_steps(3);
    let top = |harness: &Harness<'_, Window>| harness.get_by_label("'q' : undeclared").rect().top();
    let before = top(&harness);
    harness.get_by_label("Text of the file").type_text("// new");
    harness.run_steps(1);
    harness.key_press(Key::Enter);
    harness.run_steps(2);
    let moved = top(&harness) - before;
    assert!((moved - ROW).abs() < 0.5, "the mark moved by {moved} points, not by a row");
    // The cursor stands in the line after the new one, and the wrong line is below.
    harness.key_press(Key::ArrowDown);
    harness.run_steps(1);
    harness.get_by_label("Text of the file").type_text("x");
    harness.run_steps(2);
    assert!(harness.query_by_label("'q' : undeclared").is_none(), "the line was typed over");
}

/// The wrong word of a long line was under the message about it.
#[test]
fn a_message_covers_no_code_that_is_typed() {
    let long = "x".repeat(140);
    let top = |below: &str| {
        let mut harness = window(&format!("// {long}\n{below}\n"), events(2.0), &[2]);
        open(&mut harness, Path::new("tree"));
        let state = &mut harness.state_mut().state;
        let file = state.source.display_path(&"a.glsl".into());
        state.session.diagnostics = vec![Diagnostic::error(file, "'q' : undeclared").on_line(1, None)];
        harness.run_steps(2);
        harness.get_by_role_and_label(Role::Button, "Edit").click();
        harness.run_steps(3);
        let field = harness.get_by_label("Text of the file").rect().top();
        harness.query_by_label("'q' : undeclared").map(|message| message.rect().top() - field)
    };
    let below = top("}").expect("there is room in the row below");
    assert!((ROW - 4.0..2.0 * ROW).contains(&below), "the message stands {below} points below the text's upper edge");
    assert_eq!(top(&format!("// {long}")), None, "both lines are long");
}

/// Opens a tree whose shaders are in use.
fn open(harness: &mut Harness<'_, Window>, root: &Path) {
    let state = &mut harness.state_mut().state;
    (state.source, state.shader.in_use) = (Source::disk(root.to_owned()), Some(root.to_owned()));
}

#[test]
fn a_file_is_typed_and_saved() {
    let folder = tempfile::tempdir().unwrap();
    crate::shader::embedded::write_to(&folder.path().join("tree"), None).unwrap();
    let mut harness = window(TEXT, events(2.0), &[2, 3]);
    let root = folder.path().join("tree");
    open(&mut harness, &root);
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, "Edit").click();
    harness.run_steps(3);
    let field = harness.get_by_label("Text of the file");
    assert_eq!(field.accesskit_node().value().unwrap(), TEXT);
    field.type_text("// new");
    harness.run_steps(1);
    harness.key_press(Key::Enter);
    harness.run_steps(2);
    harness.get_by_label("not saved");
    // The values go with their lines.
    harness.get_by_label("a = 2");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.run_steps(2);
    let (file, base) = (TreeFile { root, path: "a.glsl".into() }, Arc::<str>::from(TEXT));
    let text: Arc<str> = format!("// new\n{TEXT}").into();
    assert_eq!(harness.state().asked, [SAVE_FILE.with(Typed { file: file.clone(), base, text: text.clone() })]);
    // Another program has added a line, which the merged text has.
    let merged: Arc<str> = format!("{text}// theirs\n").into();
    let written = WrittenText { file, typed: text, text: Some(merged.clone()), theirs: None };
    harness.state_mut().state.traces.written = Some(written);
    harness.run_steps(2);
    assert!(harness.query_by_label("not saved").is_none());
    assert_eq!(harness.get_by_label("Text of the file").accesskit_node().value().unwrap(), *merged);
    harness.get_by_role_and_label(Role::Button, "Done").click();
    harness.run_steps(2);
    assert!(harness.query_by_label("Text of the file").is_none());
}

/// A file of another playground is compiled with some words changed. It is shown and typed as its author wrote it.
#[test]
fn a_single_file_is_typed_as_its_author_wrote_it() {
    const OWN: &str = "void main() {\n    float a;\n}\n";
    let mut harness = window(TEXT, events(2.0), &[2, 3]);
    let file = Path::new("toys/wave.frag");
    let opened = TreePath::from("opened/wave.frag");
    let state = &mut harness.state_mut().state;
    (state.source, state.shader.in_use) = (Source::open(file.to_owned()), Some(file.to_owned()));
    state.traces.file = Some(opened.clone());
    let texts = BTreeMap::from([(opened.clone(), "void Main() {\n    float a = 0.0;\n}\n".into())]);
    let author_texts = BTreeMap::from([(opened, OWN.into())]);
    state.session.shaders = Some(Arc::new(ShaderSet { generation: 2, texts, author_texts, ..ShaderSet::default() }));
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, "Edit").click();
    harness.run_steps(3);
    let field = harness.get_by_label("Text of the file");
    assert_eq!(field.accesskit_node().value().unwrap(), OWN);
    field.type_text("// new ");
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.run_steps(2);
    let file = TreeFile { root: "toys".into(), path: "wave.frag".into() };
    let text = format!("// new {OWN}").into();
    assert_eq!(harness.state().asked, [SAVE_FILE.with(Typed { file, base: OWN.into(), text })]);
}

#[test]
fn what_was_typed_is_taken_back() {
    let mut harness = window(TEXT, events(2.0), &[2, 3]);
    open(&mut harness, Path::new("tree"));
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, "Edit").click();
    harness.run_steps(3);
    let typed = |harness: &Harness<'_, Window>| {
        harness.get_by_label("Text of the file").accesskit_node().value().unwrap().clone()
    };
    harness.get_by_label("Text of the file").type_text("// new");
    harness.run_steps(2);
    let with_it = format!("// new{TEXT}");
    assert_eq!(typed(&harness), with_it);
    for (modifiers, key, text) in [
        (Modifiers::COMMAND, Key::Z, TEXT),
        (Modifiers::COMMAND | Modifiers::SHIFT, Key::Z, &with_it),
        (Modifiers::COMMAND, Key::Z, TEXT),
    ] {
        harness.key_press_modifiers(modifiers, key);
        harness.run_steps(2);
        assert_eq!(typed(&harness), text);
        assert_eq!(harness.query_by_label("not saved").is_some(), text != TEXT);
    }
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.run_steps(2);
    assert!(harness.state().asked.is_empty(), "there is nothing to save");
}

#[test]
fn typed_text_stays_in_its_tree() {
    let mut harness = window(TEXT, events(2.0), &[2, 3]);
    let [a, b] = ["trees/a", "trees/b"].map(Path::new);
    open(&mut harness, a);
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, "Edit").click();
    harness.run_steps(3);
    harness.get_by_label("Text of the file").type_text("// of a");
    harness.run_steps(2);
    harness.get_by_label("not saved");
    let file = TreeFile { root: a.to_owned(), path: "a.glsl".into() };
    let (root, file, path, base) = (file.root, file.path.clone(), file.path, TEXT.to_owned());
    let unsaved = vec![TypedText { root, file, path, base, text: format!("// of a{TEXT}") }];
    assert_eq!(harness.state().panel.unsaved(), unsaved);
    // Another tree is opened. Until its shaders are in use, the file in sight is of neither.
    harness.state_mut().state.source = Source::disk(b.to_owned());
    harness.run_steps(2);
    assert!(harness.query_by_label("Text of the file").is_none(), "text of another tree");
    harness.get_by_role_and_label(Role::Button, "Edit").click();
    harness.run_steps(2);
    assert!(harness.query_by_label("Text of the file").is_none(), "a file that cannot be written yet");
    open(&mut harness, b);
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, "Edit").click();
    harness.run_steps(3);
    assert_eq!(harness.get_by_label("Text of the file").accesskit_node().value().unwrap(), TEXT);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.run_steps(2);
    assert!(harness.state().asked.is_empty(), "nothing was typed in this tree");
    assert_eq!(harness.state().panel.unsaved(), unsaved, "closing would still lose it");
    // The first tree has its text still, and saves it there. After a failure, it can be saved again.
    open(&mut harness, a);
    harness.run_steps(2);
    let text: Arc<str> = format!("// of a{TEXT}").into();
    assert_eq!(harness.get_by_label("Text of the file").accesskit_node().value().unwrap(), *text);
    let file = TreeFile { root: a.to_owned(), path: "a.glsl".into() };
    for saves in 1..=2 {
        harness.state_mut().state.traces.written = None;
        harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
        harness.run_steps(2);
        let save = SAVE_FILE.with(Typed { file: file.clone(), base: TEXT.into(), text: text.clone() });
        assert_eq!(harness.state().asked, vec![save; saves]);
        let written = WrittenText { file: file.clone(), typed: text.clone(), text: None, theirs: None };
        harness.state_mut().state.traces.written = Some(written);
        harness.run_steps(2);
    }
    harness.get_by_label("not saved");
}

/// The lines of both are shown, and neither is lost without a click.
#[test]
fn lines_that_another_program_has_changed_too_are_the_users_choice() {
    let mut harness = window(TEXT, events(2.0), &[2, 3]);
    let folder = tempfile::tempdir().unwrap();
    crate::shader::embedded::write_to(&folder.path().join("tree"), None).unwrap();
    let root = folder.path().join("tree");
    open(&mut harness, &root);
    harness.run_steps(2);
    let file = TreeFile { root: root.clone(), path: "a.glsl".into() };
    let (mine, theirs): (Arc<str>, Arc<str>) = (format!("// mine\n{TEXT}").into(), format!("// theirs\n{TEXT}").into());
    let typed =
        TypedText { root, file: "a.glsl".into(), path: "a.glsl".into(), base: TEXT.to_owned(), text: mine.to_string() };
    harness.state_mut().panel.on_request(&PanelRequest::RestoreTyped(vec![typed]));
    harness.run_steps(2);
    let text = |harness: &Harness<'_, Window>| harness.get_by_label("Text of the file").accesskit_node().value();
    let refuse = |harness: &mut Harness<'_, Window>| {
        let refused = WrittenText { file: file.clone(), typed: mine.clone(), text: None, theirs: Some(theirs.clone()) };
        harness.state_mut().state.traces.written = Some(refused);
        harness.run_steps(2);
        harness.get_by_label("not saved: another program has changed the same lines");
    };
    let save = |base: &str| SAVE_FILE.with(Typed { file: file.clone(), base: base.into(), text: mine.clone() });
    harness.get_by_role_and_label(Role::Button, "Save").click();
    harness.run_steps(2);
    refuse(&mut harness);
    assert_eq!(text(&harness).as_deref(), Some(&*mine));
    harness.get_by_role_and_label(Role::Button, "Save mine").click();
    harness.run_steps(2);
    assert_eq!(harness.state().asked, [save(TEXT), save(&theirs)]);
    // The other program has written once more.
    refuse(&mut harness);
    harness.get_by_role_and_label(Role::Button, "Take theirs").click();
    harness.run_steps(2);
    assert_eq!(text(&harness).as_deref(), Some(&*theirs));
    assert!(harness.query_by_label("not saved").is_none());
}
