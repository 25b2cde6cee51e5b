//! Where the settings put a model, or each of several that are shown together.

use crate::scene::members::{Member, Places};
use crate::scene::model::Model;
use crate::settings::{AddedModel, ModelSettings};

impl Model {
    /// Where the settings put this model, or each of its members. An entry of `added` counts if it names the file of its member.
    pub fn places(&self, first: &ModelSettings, added: &[AddedModel]) -> Places {
        if self.members.is_empty() {
            return first.transform().into();
        }
        let place = |(index, member): (usize, &Member)| {
            let place = match index.checked_sub(1) {
                None => first,
                Some(index) => &added.get(index).filter(|added| added.file == member.file)?.place,
            };
            (*place != ModelSettings::default()).then(|| (member.root, member.transform(place)))
        };
        Places { whole: None, roots: self.members.iter().enumerate().filter_map(place).collect() }
    }
}
