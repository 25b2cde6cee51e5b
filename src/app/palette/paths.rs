//! Entries for a typed path: the files and folders that it may be, and the folder itself. A thread reads the folder.

use std::path::{Path, PathBuf};

use super::entry::{Action, Entry};
use crate::app::command::file::{LIST_FOLDER, chosen};
use crate::app::command::spec::Command;
use crate::app::state::dialog::Dialog;
use crate::app::state::listing::Listing;
use crate::file_kind::{FileKind, Listed};

/// Extensions of pictures.
const PICTURES: [&str; 5] = ["png", "jpg", "jpeg", "hdr", "exr"];

/// A typed path: its folder as typed, and the beginning of a name in it.
struct Typed<'a> {
    folder: &'a str,
    name: &'a str,
}

impl<'a> Typed<'a> {
    /// The path that a query is. An expression also has a slash, before the colon of its line.
    fn of(query: &'a str) -> Option<Self> {
        let query = query.trim_start();
        let end = query.rfind(std::path::is_separator)?;
        let (folder, name) = query.split_at(end + 1);
        (!query.contains(':') || Path::new(query).is_absolute()).then_some(Self { folder, name })
    }

    /// The folder, absolute.
    fn path(&self) -> Option<PathBuf> {
        match self.folder.strip_prefix("~/") {
            Some(rest) => Some(PathBuf::from(std::env::var_os("HOME")?).join(rest)),
            None => std::path::absolute(self.folder).ok(),
        }
    }
}

/// The entries for the path that a query is, for what `dialog` chooses. Asks for the folder if it has not been read.
pub(super) fn entries(
    listing: &Listing,
    query: &str,
    dialog: Option<Dialog>,
    commands: &mut Vec<Command>,
) -> Option<Vec<Entry>> {
    let typed = Typed::of(query)?;
    let folder = typed.path()?;
    if !listing.is_of(&folder) {
        commands.push(LIST_FOLDER.with(folder.clone()));
    }
    let files: &[Listed] = match listing.of(&folder) {
        // Words with a slash are no path where there is no such folder.
        Some(Err(_)) => return None,
        files => files.and_then(|files| files.as_deref().ok()).unwrap_or_default(),
    };
    let begins = |name: &str| name.to_lowercase().starts_with(&typed.name.to_lowercase());
    let is_hidden = |name: &str| name.starts_with('.') && !typed.name.starts_with('.');
    let shown = files.iter().filter(|file| begins(&file.name) && !is_hidden(&file.name) && is_for(dialog, file));
    let mut entries: Vec<Entry> = Vec::new();
    if typed.name.is_empty() && is_for_folder(dialog, files) {
        let name = folder.file_name().unwrap_or(folder.as_os_str()).to_string_lossy();
        entries.push(Entry::new("Folder", format!("Open {name}"), chosen(dialog, folder.clone())));
    }
    entries.extend(shown.map(|Listed { name, kind }| {
        let path = format!("{}{name}", typed.folder);
        match kind.is_folder() {
            true => Entry::of(group(*kind), format!("{name}/"), Action::Complete(format!("{path}/"))),
            false => Entry::new(group(*kind), name.clone(), chosen(dialog, folder.join(name))),
        }
    }));
    Some(entries)
}

/// Whether a dialog lists a file.
fn is_for(dialog: Option<Dialog>, file: &Listed) -> bool {
    let extension = Path::new(&file.name).extension().unwrap_or_default().to_string_lossy().to_lowercase();
    file.kind.is_folder()
        || match dialog {
            None | Some(Dialog::File) => file.kind != FileKind::Other,
            Some(Dialog::Beside) => file.kind == FileKind::Model,
            Some(Dialog::Look) => file.kind == FileKind::Look,
            Some(Dialog::Tree | Dialog::SecondTree) => file.kind == FileKind::Shader,
            Some(Dialog::Picture) => PICTURES.contains(&&*extension),
            Some(Dialog::New) => false,
        }
}

/// Whether a dialog can choose the folder with these files itself.
fn is_for_folder(dialog: Option<Dialog>, files: &[Listed]) -> bool {
    let has = |name: &str| files.iter().any(|file| file.name == name);
    match dialog {
        None | Some(Dialog::File) => {
            has("interface.glsl") || files.iter().filter(|file| file.kind == FileKind::Model).count() == 1
        }
        Some(Dialog::Beside) => files.iter().filter(|file| file.kind == FileKind::Model).count() == 1,
        Some(Dialog::Tree | Dialog::SecondTree) => has("interface.glsl"),
        Some(Dialog::New) => true,
        Some(Dialog::Picture | Dialog::Look) => false,
    }
}

fn group(kind: FileKind) -> &'static str {
    match kind {
        FileKind::Model => "Model",
        FileKind::Environment => "Environment",
        FileKind::Measured => "Measured",
        FileKind::Look => "Look",
        FileKind::Shader | FileKind::ShaderTree => "Shaders",
        FileKind::Folder => "Folder",
        FileKind::Other => "File",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::command::file::may_be;
    use crate::file_kind::list;
    use crate::scene::MeasuredKind;

    #[test]
    fn a_path_lists_what_can_be_opened() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a.glb", "b.hdr", "notes.txt", ".hidden.hdr", "photo.jpg", "photo.png", "scene.bin"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        std::fs::write(folder.path().join("look.toml"), "mode = \"d\"\n").unwrap();
        std::fs::write(folder.path().join("package.toml"), "[package]\n").unwrap();
        let measured = std::fs::File::create(folder.path().join("wool.bin")).unwrap();
        measured.set_len(MeasuredKind::Utia.file_bytes() as u64).unwrap();
        std::fs::create_dir(folder.path().join("tree")).unwrap();
        let (mut listing, mut commands) = (Listing::default(), Vec::new());
        let typed = format!("{}/", folder.path().display());
        assert_eq!(entries(&listing, &typed, None, &mut commands).unwrap().len(), 0);
        let absolute = std::path::absolute(&typed).unwrap();
        assert_eq!(commands, [LIST_FOLDER.with(absolute.clone())]);
        listing.ask(absolute.clone());
        listing.take(&absolute, list(&absolute, may_be));
        let titles = |query: &str, dialog| -> Vec<String> {
            let found = entries(&listing, query, dialog, &mut Vec::new()).unwrap();
            found.into_iter().map(|entry| entry.title).collect()
        };
        let own = format!("Open {}", folder.path().file_name().unwrap().to_string_lossy());
        assert_eq!(titles(&typed, None)[1..], ["tree/", "a.glb", "b.hdr", "look.toml", "wool.bin"]);
        assert_eq!(titles(&typed, None)[0], own);
        assert_eq!(titles(&format!("{typed}B"), None), ["b.hdr"]);
        assert_eq!(titles(&format!("{typed}."), None), [".hidden.hdr"]);
        assert_eq!(titles(&typed, Some(Dialog::Picture)), ["tree/", "b.hdr", "photo.jpg", "photo.png"]);
        assert_eq!(titles(&typed, Some(Dialog::Look)), ["tree/", "look.toml"]);
        assert_eq!(titles(&typed, Some(Dialog::New)), [own.as_str(), "tree/"]);
        let completed = entries(&listing, &format!("{typed}t"), None, &mut Vec::new()).unwrap().remove(0);
        assert!(matches!(completed.action, Action::Complete(path) if path == format!("{typed}tree/")));
        for query in ["lighting/shade.glsl:89 n_dot_l", "exposure 1.5", ""] {
            assert!(entries(&listing, query, None, &mut Vec::new()).is_none(), "{query}");
        }
    }
}
