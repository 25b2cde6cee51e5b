//! Directories that are removed, moved and written again.

use super::*;

/// A model at `assets/helmet/model.gltf` below a temporary directory.
fn model_in(directory: &TempDir) -> PathBuf {
    let folder = directory.path().join("assets/helmet");
    fs::create_dir_all(&folder).unwrap();
    let model = folder.join("model.gltf");
    fs::write(&model, "one").unwrap();
    model
}

#[test]
fn a_models_folder_is_removed_and_written_again() {
    let directory = tempfile::tempdir().unwrap();
    let model = model_in(&directory);
    let told = Told::new(None, std::slice::from_ref(&model));
    for text in ["two", "three"] {
        fs::remove_dir_all(model.parent().unwrap()).unwrap();
        told.expect(&[&model]);
        fs::create_dir(model.parent().unwrap()).unwrap();
        fs::write(&model, text).unwrap();
        told.expect(&[&model]);
        fs::write(&model, format!("{text} again")).unwrap();
        told.expect(&[&model]);
    }
}

#[test]
fn a_folder_is_replaced_between_two_looks() {
    let directory = tempfile::tempdir().unwrap();
    let model = model_in(&directory);
    let told = Told::new(None, std::slice::from_ref(&model));
    fs::remove_dir_all(model.parent().unwrap()).unwrap();
    fs::create_dir(model.parent().unwrap()).unwrap();
    fs::write(&model, "two").unwrap();
    told.expect(&[&model]);
    // Whether the first report came before the new content or after it, the content of this save must be reported.
    fs::write(&model, "a third text").unwrap();
    told.expect(&[&model]);
}

#[test]
fn every_directory_above_a_model_may_go() {
    let directory = tempfile::tempdir().unwrap();
    let model = model_in(&directory);
    let told = Told::new(None, std::slice::from_ref(&model));
    let (assets, away) = (directory.path().join("assets"), directory.path().join("away"));
    fs::rename(&assets, &away).unwrap();
    told.expect(&[&model]);
    fs::write(away.join("helmet/model.gltf"), "while away").unwrap();
    fs::rename(&away, &assets).unwrap();
    told.expect(&[&model]);
    fs::write(&model, "back").unwrap();
    told.expect(&[&model]);
    fs::remove_dir_all(&assets).unwrap();
    told.expect(&[&model]);
    model_in(&directory);
    told.expect(&[&model]);
    fs::write(&model, "two").unwrap();
    told.expect(&[&model]);
}

#[test]
fn a_file_whose_folder_does_not_exist_yet_is_waited_for() {
    let directory = tempfile::tempdir().unwrap();
    let model = directory.path().join("not/yet/model.gltf");
    let told = Told::new(None, std::slice::from_ref(&model));
    fs::create_dir_all(model.parent().unwrap()).unwrap();
    fs::write(&model, "one").unwrap();
    told.expect(&[&model]);
    fs::write(&model, "two").unwrap();
    told.expect(&[&model]);
}

#[test]
fn the_directory_above_the_tree_is_replaced() {
    let directory = tempfile::tempdir().unwrap();
    let write = |project: &str, text: &str| {
        let root = directory.path().join(project).join("shaders");
        fs::create_dir_all(&root).unwrap();
        fs::write(root.join("a.glsl"), text).unwrap();
        root.join("a.glsl")
    };
    let shader = write("project", "one");
    write("other", "another");
    let told = Told::new(shader.parent(), &[]);
    fs::rename(directory.path().join("project"), directory.path().join("old")).unwrap();
    told.expect(&[&shader]);
    fs::rename(directory.path().join("other"), directory.path().join("project")).unwrap();
    told.expect(&[&shader]);
    fs::write(&shader, "two").unwrap();
    told.expect(&[&shader]);
}

#[test]
fn a_directory_of_the_tree_is_replaced() {
    let tree = Tree::new();
    fs::create_dir(tree.path("brdf")).unwrap();
    fs::write(tree.path("brdf/d.glsl"), "one").unwrap();
    tree.expect(&["brdf/d.glsl"]);
    for text in ["two", "three"] {
        fs::remove_dir_all(tree.path("brdf")).unwrap();
        tree.expect(&["brdf/d.glsl"]);
        fs::create_dir(tree.path("brdf")).unwrap();
        fs::write(tree.path("brdf/d.glsl"), text).unwrap();
        tree.expect(&["brdf/d.glsl"]);
    }
}
