//! The exercises as data. `tests/learn.rs` measures them.

use super::*;
use crate::settings::Settings;

#[test]
fn every_exercise_is_read() {
    let folders: Vec<_> = EXERCISES.dirs().collect();
    for folder in &folders {
        Exercise::read(folder).unwrap();
    }
    let numbers: Vec<usize> = exercises().iter().map(|exercise| exercise.number).collect();
    assert_eq!(numbers, (1..=12).collect::<Vec<_>>());
    assert_eq!(folders.len(), 12);
}

#[test]
fn every_exercise_is_whole() {
    let mut levels: Vec<u32> = Vec::new();
    for exercise in exercises() {
        let name = &exercise.name;
        assert_eq!(exercise.hints.len(), 3, "{name}");
        assert!(!exercise.goals.is_empty() && exercise.text.len() > 400, "{name}");
        assert!(exercise.source.contains(char::is_numeric), "{name}: a source has a year");
        let mut settings = Settings::of_window();
        exercise.apply_settings(&mut settings).unwrap();
        settings.check().unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(crate::scene::built_in(&exercise.model).is_some(), "{name}");
        assert!(exercise.solution().next().is_some(), "{name}: the solution changes nothing");
        let path = crate::shader::TreePath::from(exercise.open.file.as_str());
        let text = exercise.text_at_start(&path).unwrap_or_else(|| panic!("{name} has no {path}"));
        assert!(exercise.line_to_open(&text).is_some(), "{name}: no line with `{}`", exercise.open.at);
        levels.push(exercise.level as u32);
    }
    assert!(levels.is_sorted(), "from easy to hard");
}

#[test]
fn names_and_numbers_find_an_exercise() {
    assert_eq!(find("3").unwrap().name, "03-fresnel");
    assert_eq!(find("fresnel").unwrap().number, 3);
    assert_eq!(find("03-fresnel").unwrap().number, 3);
    let error = find("frensel").unwrap_err();
    assert!(error.contains("fresnel") && error.contains("1 to 12"), "{error}");
    assert!(find("13").is_err() && find("0").is_err());
}

#[test]
fn a_folder_is_written_once_and_known_again() {
    let parent = tempfile::tempdir().unwrap();
    let exercise = find("1").unwrap();
    let folder = prepare(parent.path(), exercise).unwrap();
    assert_eq!(exercise_of(&folder).unwrap().name, exercise.name);
    let file = folder.join("brdf/ndf.glsl");
    assert!(std::fs::read_to_string(&file).unwrap().contains("float a2 = alpha;"));
    std::fs::write(&file, "mine").unwrap();
    assert_eq!(prepare(parent.path(), exercise).unwrap(), folder);
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "mine", "the student's work is overwritten");
    std::fs::create_dir_all(parent.path().join("02-lambert")).unwrap();
    std::fs::write(parent.path().join("02-lambert/notes.txt"), "").unwrap();
    let error = prepare(parent.path(), find("2").unwrap()).unwrap_err();
    assert!(error.contains("--dir"), "{error}");
    assert!(exercise_of(parent.path()).is_none());
}
