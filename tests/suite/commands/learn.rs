//! Every exercise fails at its start with a message that helps, is not passed by an edit of something else, and passes when it is
//! solved; and `specula learn` in a terminal.

use std::path::Path;

use crate::support::process::{Finished, finish, specula};
use crate::support::{assert_validated, compiler, gpu, is_long};
use specula::learn::{Finding, GoalMeter, exercise_of, exercises, find, prepare};
use specula::settings::Settings;
use specula::shader::{Source, TreePath};

fn write(folder: &Path, file: &str, text: &str) {
    std::fs::write(folder.join(file), text).unwrap();
}

/// What the checker says about an exercise at its start, after an edit of something else, and when it is solved.
fn three_times(name: &str) -> [Vec<Finding>; 3] {
    let parent = tempfile::tempdir().unwrap();
    let exercise = &*find(name).unwrap();
    let folder = prepare(parent.path(), exercise).unwrap();
    let mut meter = GoalMeter::new(gpu(), compiler());
    let mut check = || {
        let found = meter.check(exercise, &Source::disk(folder.clone()), || false);
        found.unwrap_or_else(|error| panic!("{name}: {error}"))
    };
    // The edits below change no value, so what fails after them fails at the start, too.
    let start = if is_long() || name == "roughness" { check() } else { Vec::new() };
    let path = folder.join(&exercise.open.file);
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, format!("{text}\n// I have read this.\n")).unwrap();
    let user = std::fs::read_to_string(folder.join("user.glsl")).unwrap();
    write(&folder, "user.glsl", &user.replace("s.roughness * roughness_scale", "roughness_scale * s.roughness"));
    let unrelated = check();
    write(&folder, "user.glsl", &user);
    for (path, text) in exercise.solution() {
        write(&folder, path.as_str(), text);
    }
    let solved = check();
    assert_validated();
    [start, unrelated, solved]
}

/// `messages`: what the first goals that fail say.
fn exercise(name: &str, messages: &[&str]) {
    let [start, unrelated, solved] = three_times(name);
    let told = |findings: &[Finding]| -> Vec<String> {
        findings.iter().map(|finding| format!("{} {}: {}", finding.passed, finding.goal, finding.found)).collect()
    };
    println!("{name}\n{:#?}\n{:#?}", told(&unrelated), told(&solved));
    assert!(!unrelated.is_empty());
    assert!(solved.iter().all(|finding| finding.passed), "{name} is solved, but: {:#?}", told(&solved));
    for findings in [&start, &unrelated].into_iter().filter(|findings| !findings.is_empty()) {
        let failed: Vec<&Finding> = findings.iter().filter(|finding| !finding.passed).collect();
        assert!(failed.len() >= messages.len() && !messages.is_empty(), "{name}: {:#?}", told(findings));
        for (finding, message) in failed.iter().zip(messages) {
            assert!(finding.found.contains(message), "{name}: `{message}` is not in {:#?}", told(findings));
        }
    }
}

#[test]
fn roughness() {
    exercise("roughness", &["D is "]);
}

#[test]
fn lambert() {
    exercise("lambert", &["a white surface that is no metal at roughness", "the diffuse lobe is"]);
}

#[test]
fn fresnel() {
    exercise("fresnel", &["F is ", "F is "]);
}

#[test]
fn srgb() {
    exercise("srgb", &[" of 255 ", " of 255 "]);
}

#[test]
fn slider() {
    exercise("slider", &["the tree has no parameter `saturation`", " of 255 "]);
}

#[test]
fn mode() {
    exercise("mode", &["the tree has no mode `glass`", "the tree has no mode `glass`"]);
}

#[test]
fn normals() {
    exercise("normals", &["the normal is "]);
}

#[test]
fn reciprocity() {
    exercise("reciprocity", &["they should be equal", "F is "]);
}

#[test]
fn nan() {
    exercise("nan", &["are NaN or infinite"]);
}

#[test]
fn lens() {
    exercise("lens", &["the corner of the picture keeps 1.00 of its light; 0.25 was expected", " of 255 "]);
}

#[test]
fn energy() {
    exercise("energy", &["white metal at roughness 1.0", "a colored metal"]);
}

#[test]
fn trail() {
    exercise("trail", &[" of 255 "]);
}

/// Other right answers than that of the solution.
#[test]
fn an_equal_formula_passes() {
    let parent = tempfile::tempdir().unwrap();
    let (exercise, mut meter) = (find("fresnel").unwrap(), GoalMeter::new(gpu(), compiler()));
    let folder = prepare(parent.path(), &exercise).unwrap();
    let text = std::fs::read_to_string(folder.join("brdf/fresnel.glsl")).unwrap();
    write(&folder, "brdf/fresnel.glsl", &text.replace("f0 + (f90 - f0) * pow5(c)", "mix(f0, f90, pow(1.0 - c, 5.0))"));
    let findings = meter.check(&exercise, &Source::disk(folder), || false).unwrap();
    assert!(findings.iter().all(|finding| finding.passed), "{findings:#?}");
}

#[test]
fn a_newer_edit_ends_a_measurement() {
    let mut meter = GoalMeter::new(gpu(), compiler());
    let exercise = &*find("roughness").unwrap();
    let error = meter.check(exercise, &exercise.start_tree(), || true).unwrap_err();
    assert!(error.to_string().contains("newer edit"), "{error}");
}

/// A folder that cannot be read is left out of the list.
#[test]
fn every_exercise_is_read() {
    let folders = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/learn")).unwrap().count();
    let numbers: Vec<usize> = exercises().iter().map(|exercise| exercise.number).collect();
    assert_eq!((numbers, folders), ((1..=12).collect(), 12));
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
        assert!(specula::scene::built_in(&exercise.model).is_some(), "{name}");
        assert!(exercise.solution().next().is_some(), "{name}: the solution changes nothing");
        let path = TreePath::from(exercise.open.file.as_str());
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
    let exercise = &*find("1").unwrap();
    let folder = prepare(parent.path(), exercise).unwrap();
    assert_eq!(exercise_of(&folder).unwrap().name, exercise.name);
    let file = folder.join("brdf/ndf.glsl");
    assert!(std::fs::read_to_string(&file).unwrap().contains("float a2 = alpha;"));
    std::fs::write(&file, "mine").unwrap();
    assert_eq!(prepare(parent.path(), exercise).unwrap(), folder);
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "mine", "the student's work is overwritten");
    std::fs::create_dir_all(parent.path().join("02-lambert")).unwrap();
    std::fs::write(parent.path().join("02-lambert/notes.txt"), "").unwrap();
    let error = prepare(parent.path(), &find("2").unwrap()).unwrap_err();
    assert!(error.contains("--dir"), "{error}");
    assert!(exercise_of(parent.path()).is_none());
}

/// `specula learn` in a folder, with its own state.
fn learn(folder: &Path, args: &[&str]) -> Finished {
    let mut command = specula(folder);
    finish(command.arg("learn").args(args).env("XDG_STATE_HOME", folder.join("state")))
}

#[test]
fn the_list_names_all_exercises() {
    let folder = tempfile::tempdir().unwrap();
    let list = learn(folder.path(), &["list"]);
    assert_eq!(list.code, Some(0), "{list:#?}");
    for exercise in exercises() {
        assert!(list.stdout.contains(&exercise.title) && list.stdout.contains(exercise.slug()), "{}", list.stdout);
    }
    assert!(list.stdout.contains("0 of 12 solved"), "{}", list.stdout);
    assert_eq!(learn(folder.path(), &["list", "--json"]).json().as_array().unwrap().len(), 12);
}

/// The folder appears in the directory at hand, perhaps in a repository: the program says where, and hides nothing in it.
#[test]
fn a_new_folder_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let open = || {
        let mut command = specula(folder.path());
        command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
        finish(command.args(["learn", "1"]).env("XDG_STATE_HOME", folder.path().join("state")))
    };
    let told = "exercise 1 is in ";
    open().expect(3, &[told, "specula-learn/01-roughness"]);
    assert!(!folder.path().join("specula-learn/.gitignore").exists());
    let again = open();
    assert!(!again.expect(3, &[]).stderr.contains(told), "{again:#?}");
}

#[test]
fn progress_survives_and_is_reset() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir_all(folder.path().join("state/specula")).unwrap();
    let records = r#"{"records": {"02-lambert": {"solved": true, "hints": 1}}, "folder": "/nowhere"}"#;
    write(folder.path(), "state/specula/learn.json", records);
    let list = learn(folder.path(), &["list", "--json"]).json();
    assert_eq!((&list[1]["solved"], &list[1]["hints"], &list[0]["solved"]), (&true.into(), &1.into(), &false.into()));
    learn(folder.path(), &["reset"]).expect(0, &[]);
    assert_eq!(learn(folder.path(), &["list", "--json"]).json()[1]["solved"], false);
}

#[test]
fn a_teacher_checks_in_a_terminal() {
    let parent = tempfile::tempdir().unwrap();
    let exercise = &*find("energy").unwrap();
    let folder = prepare(parent.path(), exercise).unwrap();
    let dir = parent.path().display().to_string();
    let check = |dir: &str| learn(parent.path(), &["check", "11", "--dir", dir]);
    let failed = check(&dir);
    failed.expect(1, &[]);
    assert!(failed.stdout.contains("FAIL") && failed.stdout.contains("1.00 was expected"), "{}", failed.stdout);
    for (path, text) in exercise.solution() {
        write(&folder, path.as_str(), text);
    }
    // The folder of the exercise will do as well.
    let passed = check(&folder.display().to_string());
    passed.expect(0, &[]);
    assert!(passed.stdout.contains("solved") && !passed.stdout.contains("FAIL"), "{}", passed.stdout);
    write(&folder, "brdf/energy/multiscatter.glsl", "wrong");
    check(&dir).expect(1, &["multiscatter.glsl"]);
    learn(parent.path(), &["check", "11", "--dir", "nowhere"]).expect(1, &["specula learn 11"]);
    learn(parent.path(), &["check"]).expect(2, &["learn check 3"]);
    learn(parent.path(), &["frensel"]).expect(2, &["fresnel"]);
    learn(parent.path(), &["3", "4"]).expect(2, &["one exercise at a time"]);
}

/// The exercise that the manual shows, the folders of two students, and the checks of a lecturer.
#[test]
fn an_own_exercise_is_a_folder_as_the_manual_describes_it() {
    let manual = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/manual/exercises.md");
    let manual = std::fs::read_to_string(manual).unwrap();
    let example = manual.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let own = folder.path().join("distance");
    std::fs::create_dir(&own).unwrap();
    write(&own, "exercise.toml", example);
    let exercise = &*find(own.to_str().unwrap()).unwrap();
    assert_eq!((exercise.number, &*exercise.name), (0, "distance"));
    let [anna, ben] =
        ["anna", "ben"].map(|name| prepare(&folder.path().join("students").join(name), exercise).unwrap());
    for (path, text) in exercise.solution() {
        write(&ben, path.as_str(), text);
    }
    // The folder knows its exercise.
    let check = |words: &[&str]| learn(folder.path(), &[&["check"], words].concat());
    let [of_anna, of_ben] = [&anna, &ben].map(|dir| dir.to_str().unwrap());
    let failed = check(&["--dir", of_anna]);
    failed.expect(1, &[]);
    assert!(failed.stdout.contains("FAIL") && failed.stdout.contains("the light is"), "{}", failed.stdout);
    assert!(check(&[of_ben]).expect(0, &[]).stdout.contains("Exercise distance, Light and distance: solved"));
    let all = |more: &[&str]| learn(folder.path(), &[&["check", "all", "--dir", "students"], more].concat());
    let table = all(&[]);
    table.expect(1, &[]);
    let rows: Vec<Vec<&str>> = table.stdout.lines().map(|line| line.split_whitespace().collect()).collect();
    assert_eq!(rows[0], ["anna/distance", "distance", "0", "of", "1", "goals"]);
    assert_eq!(rows[1], ["ben/distance", "distance", "solved"]);
    assert!(table.stdout.ends_with("1 of 2 solved\n"), "{}", table.stdout);
    write(&anna, "lighting/punctual.glsl", "wrong");
    let json = all(&["--json"]).json();
    assert_eq!((&json[1]["folder"], &json[1]["passed"]), (&"ben/distance".into(), &true.into()), "{json}");
    assert!(json[0]["error"].as_str().unwrap().contains("punctual.glsl"), "{json}");
    write(&own, "exercise.toml", "title = 7");
    learn(folder.path(), &["check", "distance"]).expect(2, &["exercise.toml", "title"]);
}
