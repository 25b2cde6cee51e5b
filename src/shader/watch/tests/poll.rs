//! Watching without notifications.

use super::*;

/// As [`Told::new`], on a system without notifications.
fn told(root: Option<&Path>, files: &[PathBuf]) -> Told {
    let (sender, batches) = unbounded();
    let on_batch = move |batch| sender.send(batch).unwrap();
    let watcher = Watcher::start(root, files, Some("a test".to_owned()), on_batch).unwrap();
    Told { batches, watcher }
}

#[test]
fn changes_are_found_by_looking() {
    let directory = tempfile::tempdir().unwrap();
    let root = directory.path().join("tree");
    let (shader, new, model) = (root.join("a.glsl"), root.join("x/new.glsl"), directory.path().join("model.glb"));
    fs::create_dir(&root).unwrap();
    fs::write(&shader, "one").unwrap();
    let told = told(Some(&root), std::slice::from_ref(&model));
    fs::write(&shader, "two").unwrap();
    told.expect(&[&shader]);
    // The same length and time: only the content tells the difference.
    let time = fs::metadata(&shader).unwrap().modified().unwrap();
    fs::write(&shader, "owt").unwrap();
    fs::File::options().write(true).open(&shader).unwrap().set_modified(time).unwrap();
    told.expect(&[&shader]);
    fs::create_dir(root.join("x")).unwrap();
    fs::write(&new, "new").unwrap();
    told.expect(&[&new]);
    fs::write(&model, "model").unwrap();
    told.expect(&[&model]);
    fs::remove_dir_all(&root).unwrap();
    told.expect(&[&shader, &new]);
    fs::create_dir(&root).unwrap();
    fs::write(&shader, "again").unwrap();
    told.expect(&[&shader]);
    told.watcher.set_files(&[]);
}
