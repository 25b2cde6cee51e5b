//! Tests on real directories. This file covers the ways in which editors and git write; `folders` covers directories that
//! go away and come back, `links` symbolic links, `poll` watching without notifications.

mod folders;
mod links;
mod poll;

use std::fs;

use tempfile::TempDir;

use super::*;

/// Long enough for a loaded machine; an event ends the wait.
const PATIENCE: Duration = Duration::from_secs(20);

/// A watcher whose batches a test receives, without a tree of its own.
struct Told {
    batches: Receiver<Batch>,
    watcher: Watcher,
}

impl Told {
    fn new(root: Option<&Path>, files: &[PathBuf]) -> Self {
        let (sender, batches) = unbounded();
        let watcher = Watcher::new(root, files, move |batch| sender.send(batch).unwrap()).unwrap();
        Self { batches, watcher }
    }

    /// Waits until the watcher has reported each of `paths`. It may report them in several batches, but nothing else.
    #[track_caller]
    fn expect(&self, paths: &[&Path]) {
        let mut wanted: BTreeSet<&Path> = paths.iter().copied().collect();
        while !wanted.is_empty() {
            let batch = self.batches.recv_timeout(PATIENCE);
            let batch = batch.unwrap_or_else(|_| panic!("the watcher never reported {wanted:?}"));
            for path in &batch.paths {
                assert!(paths.contains(&path.as_path()), "{} was reported, expected {paths:?}", path.display());
                wanted.remove(path.as_path());
            }
        }
    }
}

struct Tree {
    directory: TempDir,
    batches: Receiver<Batch>,
    watcher: Watcher,
}

impl Tree {
    fn new() -> Self {
        let directory = tempfile::tempdir().unwrap();
        let root = directory.path().join("tree");
        fs::create_dir(&root).unwrap();
        fs::write(root.join("a.glsl"), "first").unwrap();
        fs::write(root.join("b.glsl"), "other").unwrap();
        let (sender, batches) = unbounded();
        let watcher = Watcher::new(Some(&root), &[], move |batch| sender.send(batch).unwrap()).unwrap();
        Self { directory, batches, watcher }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join("tree").join(name)
    }

    /// Waits until all `names` were reported, and returns how many batches that took. Nothing else may be reported.
    #[track_caller]
    fn expect(&self, names: &[&str]) -> usize {
        let mut wanted: BTreeSet<PathBuf> = names.iter().map(|name| self.path(name)).collect();
        for count in 1.. {
            let batch = self.batches.recv_timeout(PATIENCE).expect("a batch");
            assert!(batch.first_event.elapsed() >= SETTLE_SAVE);
            // An editor's temporary file may be seen before it goes.
            for path in batch.paths.into_iter().filter(|path| !path.to_string_lossy().ends_with('~')) {
                assert!(wanted.remove(&path), "{} was told, but not expected", path.display());
            }
            if wanted.is_empty() {
                return count;
            }
        }
        unreachable!()
    }

    /// Checks that nothing was reported up to a change made now.
    #[track_caller]
    fn expect_nothing(&self) {
        fs::write(self.path("marker"), format!("{:?}", Instant::now())).unwrap();
        self.expect(&["marker"]);
    }
}

#[test]
fn truncate_and_write() {
    let tree = Tree::new();
    fs::write(tree.path("a.glsl"), "second").unwrap();
    tree.expect(&["a.glsl"]);
}

#[test]
fn rename_over() {
    let tree = Tree::new();
    for text in ["second", "third"] {
        let temporary = tree.directory.path().join("temporary");
        fs::write(&temporary, text).unwrap();
        fs::rename(&temporary, tree.path("a.glsl")).unwrap();
        tree.expect(&["a.glsl"]);
    }
    fs::write(tree.path("a.glsl~"), "fourth").unwrap();
    fs::rename(tree.path("a.glsl~"), tree.path("a.glsl")).unwrap();
    tree.expect(&["a.glsl"]);
}

#[test]
fn delete_and_create() {
    let tree = Tree::new();
    fs::remove_file(tree.path("a.glsl")).unwrap();
    tree.expect(&["a.glsl"]);
    fs::write(tree.path("a.glsl"), "first").unwrap();
    tree.expect(&["a.glsl"]);
}

#[test]
fn new_files_and_nested_directories() {
    let tree = Tree::new();
    fs::write(tree.path("new.glsl"), "new").unwrap();
    tree.expect(&["new.glsl"]);
    fs::create_dir_all(tree.path("x/y/z")).unwrap();
    fs::write(tree.path("x/y/z/deep.glsl"), "deep").unwrap();
    tree.expect(&["x/y/z/deep.glsl"]);
    fs::write(tree.path("x/y/z/deep.glsl"), "deeper").unwrap();
    tree.expect(&["x/y/z/deep.glsl"]);
    fs::remove_dir_all(tree.path("x")).unwrap();
    tree.expect(&["x/y/z/deep.glsl"]);
}

#[test]
fn links_are_complete_when_made() {
    let tree = Tree::new();
    std::os::unix::fs::symlink("a.glsl", tree.path("link.glsl")).unwrap();
    tree.expect(&["link.glsl"]);
    fs::hard_link(tree.path("b.glsl"), tree.path("hard.glsl")).unwrap();
    tree.expect(&["hard.glsl"]);
}

#[test]
fn the_root_moves_away_and_back() {
    let tree = Tree::new();
    let (root, away) = (tree.directory.path().join("tree"), tree.directory.path().join("away"));
    fs::rename(&root, &away).unwrap();
    tree.expect(&["a.glsl", "b.glsl"]);
    fs::write(away.join("a.glsl"), "while away").unwrap();
    fs::rename(&away, &root).unwrap();
    tree.expect(&["a.glsl", "b.glsl"]);
    fs::write(tree.path("a.glsl"), "back").unwrap();
    tree.expect(&["a.glsl"]);
    // Another directory replaces it.
    fs::rename(&root, &away).unwrap();
    tree.expect(&["a.glsl", "b.glsl"]);
    fs::create_dir(&root).unwrap();
    fs::write(root.join("a.glsl"), "another").unwrap();
    tree.expect(&["a.glsl"]);
    fs::write(root.join("a.glsl"), "another one").unwrap();
    tree.expect(&["a.glsl"]);
}

#[test]
fn many_files_make_few_batches() {
    let tree = Tree::new();
    let names: Vec<String> = (0..300).map(|i| format!("file{i}.glsl")).collect();
    for name in &names {
        fs::write(tree.path(name), name).unwrap();
    }
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let batches = tree.expect(&names);
    assert!(batches <= 20, "{batches} batches");
}

#[test]
fn touching_and_reading_is_no_change() {
    let tree = Tree::new();
    fs::read(tree.path("a.glsl")).unwrap();
    fs::write(tree.path("a.glsl"), "first").unwrap();
    fs::File::open(tree.path("b.glsl")).unwrap().set_modified(std::time::SystemTime::now()).unwrap();
    tree.expect_nothing();
}

#[test]
fn single_files_elsewhere() {
    let tree = Tree::new();
    let elsewhere = tempfile::tempdir().unwrap();
    let model = elsewhere.path().canonicalize().unwrap().join("model.gltf");
    fs::write(&model, "one").unwrap();
    tree.watcher.set_files(std::slice::from_ref(&model));
    // The command and the events share one queue, so a report of a change in the tree proves that the files are set.
    tree.expect_nothing();
    fs::write(elsewhere.path().join("unrelated"), "x").unwrap();
    fs::write(&model, "two").unwrap();
    let batch = tree.batches.recv_timeout(PATIENCE).unwrap();
    assert_eq!(batch.paths, BTreeSet::from([model.clone()]));
    tree.watcher.set_files(&[]);
    tree.expect_nothing();
    fs::write(&model, "three").unwrap();
    tree.expect_nothing();
}

#[test]
fn a_missing_root_is_an_error() {
    let directory = tempfile::tempdir().unwrap();
    let error = Watcher::new(Some(&directory.path().join("none")), &[], |_| {}).unwrap_err();
    assert!(error.to_string().contains("none: cannot watch"), "{error}");
}
