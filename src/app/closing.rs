//! Closing the window does not lose typed text without a word: the first time it is refused.

use std::collections::BTreeMap;
use std::path::Path;

use super::state::State;
use crate::write_back::TreeFile;

/// The texts of files that were typed and not saved.
pub(super) type Unsaved = BTreeMap<TreeFile, String>;

/// The texts with which closing was refused last.
#[derive(Default)]
pub(super) struct Closing {
    refused: Unsaved,
}

impl Closing {
    /// Whether the window may close with these texts. If not, the user is told why, and the next call with the same texts says yes.
    pub(super) fn may_close(&mut self, state: &mut State, unsaved: Unsaved) -> bool {
        if unsaved.is_empty() || unsaved == self.refused {
            return true;
        }
        state.say(reason(&unsaved, state.source.folder_of_files()));
        self.refused = unsaved;
        false
    }
}

/// Why the window stays open. `root`: the folder of the open tree.
fn reason(unsaved: &Unsaved, root: Option<&Path>) -> String {
    let name = |TreeFile { root: of, path }: &TreeFile| match root == Some(of) {
        true => path.to_string(),
        false => of.join(path.as_str()).display().to_string(),
    };
    let names: Vec<String> = unsaved.keys().map(name).collect();
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
        assert!(closing.may_close(&mut state, Unsaved::new()));
        assert_eq!(last(&state), None);
        let file = |root: &str, path: &str| TreeFile { root: root.into(), path: path.into() };
        let mut unsaved = Unsaved::from([(file("trees/a", "brdf/ndf.glsl"), "one".to_owned())]);
        assert!(!closing.may_close(&mut state, unsaved.clone()));
        let told = "brdf/ndf.glsl is not saved: Ctrl+S saves it; close again to drop the changes";
        assert_eq!(last(&state).as_deref(), Some(told));
        assert!(closing.may_close(&mut state, unsaved.clone()));
        // More was typed since, and into a file of another tree, too.
        unsaved.insert(file("trees/a", "brdf/ndf.glsl"), "two".to_owned());
        unsaved.insert(file("trees/b", "a.glsl"), "three".to_owned());
        assert!(!closing.may_close(&mut state, unsaved.clone()));
        let told = last(&state).unwrap();
        assert!(told.starts_with("brdf/ndf.glsl, trees/b") && told.contains("are not saved"), "{told}");
        assert!(closing.may_close(&mut state, unsaved));
    }
}
