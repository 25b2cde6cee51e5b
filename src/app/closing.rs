//! Closing the window does not lose typed text without a word: the first time it is refused.

use std::path::Path;

use super::state::State;
use crate::recovery::TypedText;

/// The texts with which closing was refused last.
#[derive(Default)]
pub(super) struct Closing {
    refused: Vec<TypedText>,
}

impl Closing {
    /// Whether the window may close with these texts. If not, the user is told why, and the next call with the same texts says yes.
    pub(super) fn may_close(&mut self, state: &mut State, unsaved: Vec<TypedText>) -> bool {
        if unsaved.is_empty() || unsaved == self.refused {
            return true;
        }
        state.say(reason(&unsaved, state.source.folder_of_files()));
        self.refused = unsaved;
        false
    }
}

/// Why the window stays open. `root`: the folder of the open tree.
fn reason(unsaved: &[TypedText], root: Option<&Path>) -> String {
    let name = |TypedText { root: of, file, .. }: &TypedText| match root == Some(of) {
        true => file.to_string(),
        false => of.join(file.as_str()).display().to_string(),
    };
    let names: Vec<String> = unsaved.iter().map(name).collect();
    let (are, saves) = match names.len() {
        1 => ("is", "saves it"),
        _ => ("are", "saves the one in sight"),
    };
    format!("{} {are} not saved: Ctrl+S {saves}; close again to drop the changes", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;
    use crate::shader::Source;

    #[test]
    fn closing_is_refused_once_for_the_same_text() {
        let mut state = State::new(Settings::of_window(), Source::disk("trees/a"));
        let mut closing = Closing::default();
        let last = |state: &State| state.notices.past().next().map(|notice| notice.text.clone());
        assert!(closing.may_close(&mut state, Vec::new()));
        assert_eq!(last(&state), None);
        let typed = |root: &str, file: &str, text: &str| TypedText {
            root: root.into(),
            file: file.into(),
            path: file.into(),
            base: String::new(),
            text: text.to_owned(),
        };
        let unsaved = vec![typed("trees/a", "brdf/ndf.glsl", "one")];
        assert!(!closing.may_close(&mut state, unsaved.clone()));
        let told = "brdf/ndf.glsl is not saved: Ctrl+S saves it; close again to drop the changes";
        assert_eq!(last(&state).as_deref(), Some(told));
        assert!(closing.may_close(&mut state, unsaved.clone()));
        // More was typed since, and into a file of another tree, too.
        let unsaved = vec![typed("trees/a", "brdf/ndf.glsl", "two"), typed("trees/b", "a.glsl", "three")];
        assert!(!closing.may_close(&mut state, unsaved.clone()));
        let told = last(&state).unwrap();
        assert!(told.starts_with("brdf/ndf.glsl, trees/b") && told.contains("are not saved"), "{told}");
        assert!(closing.may_close(&mut state, unsaved));
    }
}
