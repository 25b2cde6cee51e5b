//! Symbolic links: to files, to directories, and on the way to the root.

use std::os::unix::fs::symlink;

use super::*;

/// Makes `link` lead to `target` in one step, as `ln -sfn` does.
fn relink(target: &Path, link: &Path) {
    let new = link.with_extension("new");
    symlink(target, &new).unwrap();
    fs::rename(&new, link).unwrap();
}

#[test]
fn files_are_reported_under_the_name_given() {
    let directory = tempfile::tempdir().unwrap();
    let (real, link) = (directory.path().join("real"), directory.path().join("link"));
    fs::create_dir(&real).unwrap();
    symlink("real", &link).unwrap();
    let sky = link.join("sky.hdr");
    fs::write(&sky, "one").unwrap();
    let told = Told::new(None, std::slice::from_ref(&sky));
    fs::write(&sky, "two").unwrap();
    told.expect(&[&sky]);
    fs::write(real.join("sky.hdr"), "three").unwrap();
    told.expect(&[&sky]);
    // A file that is given under two names is reported under both.
    let both = [sky.clone(), real.join("sky.hdr")];
    let told = Told::new(None, &both);
    fs::write(&sky, "four").unwrap();
    told.expect(&[&both[0], &both[1]]);
}

#[test]
fn the_root_is_reported_as_given() {
    let directory = tempfile::tempdir().unwrap();
    let (real, link) = (directory.path().join("real"), directory.path().join("link"));
    fs::create_dir(&real).unwrap();
    fs::write(real.join("a.glsl"), "one").unwrap();
    symlink("real", &link).unwrap();
    let told = Told::new(Some(&link), &[]);
    fs::write(real.join("a.glsl"), "two").unwrap();
    told.expect(&[&link.join("a.glsl")]);
}

#[test]
fn a_link_to_another_tree_is_swapped() {
    let directory = tempfile::tempdir().unwrap();
    let link = directory.path().join("shaders");
    for tree in ["v1", "v2"] {
        fs::create_dir(directory.path().join(tree)).unwrap();
        fs::write(directory.path().join(tree).join("a.glsl"), tree).unwrap();
    }
    fs::write(directory.path().join("v2/new.glsl"), "new").unwrap();
    symlink("v1", &link).unwrap();
    let told = Told::new(Some(&link), &[]);
    let (shader, new) = (link.join("a.glsl"), link.join("new.glsl"));
    relink(Path::new("v2"), &link);
    told.expect(&[&shader, &new]);
    fs::write(directory.path().join("v2/a.glsl"), "edit").unwrap();
    told.expect(&[&shader]);
    // The old tree is no longer watched.
    fs::write(directory.path().join("v1/a.glsl"), "old").unwrap();
    fs::write(&new, "newer").unwrap();
    told.expect(&[&new]);
}

#[test]
fn a_link_above_the_tree_is_swapped() {
    let directory = tempfile::tempdir().unwrap();
    for version in ["v1", "v2"] {
        fs::create_dir_all(directory.path().join(version).join("shaders")).unwrap();
        fs::write(directory.path().join(version).join("shaders/a.glsl"), version).unwrap();
    }
    let current = directory.path().join("current");
    symlink("v1", &current).unwrap();
    let shader = current.join("shaders/a.glsl");
    let told = Told::new(shader.parent(), &[]);
    relink(Path::new("v2"), &current);
    told.expect(&[&shader]);
}

#[test]
fn the_target_of_a_link_is_saved_in_place() {
    let directory = tempfile::tempdir().unwrap();
    let elsewhere = tempfile::tempdir().unwrap();
    let root = directory.path().join("tree");
    fs::create_dir(&root).unwrap();
    fs::write(elsewhere.path().join("a.glsl"), "one").unwrap();
    fs::write(elsewhere.path().join("model.glb"), "one").unwrap();
    // A link to a link to the file.
    symlink(elsewhere.path().join("a.glsl"), elsewhere.path().join("between.glsl")).unwrap();
    symlink(elsewhere.path().join("between.glsl"), root.join("a.glsl")).unwrap();
    let model = directory.path().join("model.glb");
    symlink(elsewhere.path().join("model.glb"), &model).unwrap();
    let told = Told::new(Some(&root), std::slice::from_ref(&model));
    let shader = root.join("a.glsl");
    for text in ["two", "three"] {
        fs::write(elsewhere.path().join("a.glsl"), text).unwrap();
        told.expect(&[&shader]);
        fs::write(elsewhere.path().join("model.glb"), text).unwrap();
        told.expect(&[&model]);
    }
    fs::remove_file(elsewhere.path().join("a.glsl")).unwrap();
    told.expect(&[&shader]);
    fs::write(elsewhere.path().join("a.glsl"), "again").unwrap();
    told.expect(&[&shader]);
    // The link in the middle is changed to another file.
    fs::write(elsewhere.path().join("b.glsl"), "another").unwrap();
    relink(&elsewhere.path().join("b.glsl"), &elsewhere.path().join("between.glsl"));
    told.expect(&[&shader]);
    fs::write(elsewhere.path().join("b.glsl"), "another one").unwrap();
    told.expect(&[&shader]);
}

#[test]
fn the_target_of_a_link_comes_to_exist() {
    let tree = Tree::new();
    let elsewhere = tempfile::tempdir().unwrap();
    symlink(elsewhere.path().join("late/f.glsl"), tree.path("f.glsl")).unwrap();
    tree.expect_nothing();
    fs::create_dir(elsewhere.path().join("late")).unwrap();
    fs::write(elsewhere.path().join("late/f.glsl"), "late").unwrap();
    tree.expect(&["f.glsl"]);
}

#[test]
fn a_directory_of_the_tree_is_a_link() {
    let tree = Tree::new();
    for library in ["one", "two"] {
        fs::create_dir_all(tree.path(library).join("deep")).unwrap();
        fs::write(tree.path(library).join("deep/f.glsl"), library).unwrap();
    }
    tree.expect(&["one/deep/f.glsl", "two/deep/f.glsl"]);
    symlink("one", tree.path("library")).unwrap();
    tree.expect(&["library/deep/f.glsl"]);
    fs::write(tree.path("one/deep/f.glsl"), "edit").unwrap();
    tree.expect(&["library/deep/f.glsl", "one/deep/f.glsl"]);
    fs::write(tree.path("one/deep/g.glsl"), "new").unwrap();
    tree.expect(&["library/deep/g.glsl", "one/deep/g.glsl"]);
    relink(Path::new("two"), &tree.path("library"));
    tree.expect(&["library/deep/f.glsl", "library/deep/g.glsl"]);
    fs::write(tree.path("two/deep/f.glsl"), "another edit").unwrap();
    tree.expect(&["library/deep/f.glsl", "two/deep/f.glsl"]);
}
