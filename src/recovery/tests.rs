//! Records of a session, and the next process's start from them.

use super::*;
use crate::settings::ShaderValue;

const CAUSE: &str = "the graphics device was lost";

fn hash(text: &str) -> u64 {
    text_hash(&Ok(text.to_owned()))
}

/// A session in the folder `tree`, whose last good texts are "old".
fn session() -> (RecoveryState, GoodTexts) {
    let work = SessionState { tree: Some("tree".into()), ..SessionState::default() };
    let texts = ["a.glsl", "b.glsl"].map(|path| (path.to_owned(), "old".to_owned()));
    let good = GoodTexts { tree: work.tree.clone(), texts: texts.into() };
    (RecoveryState { work: Some(work.clone()), good: Some(work), ..RecoveryState::default() }, good)
}

#[test]
fn a_new_text_is_refused_and_the_settings_stay() {
    let (mut state, good) = session();
    state.suspects = [("a.glsl".to_owned(), hash("new")), ("b.glsl".to_owned(), hash("old"))].into();
    let work = state.work.as_mut().unwrap();
    Arc::make_mut(&mut work.settings).mode = "normal".into();
    let work = work.clone();
    let next = state.after_loss(CAUSE, &good);
    assert_eq!(next.quarantined, [("a.glsl".to_owned(), hash("new"))].into());
    assert_eq!(next.work, Some(work));
    assert_eq!(next.losses, 1);
    assert!(next.suspects.is_empty());
    // The same happens again with a second text: both are quarantined.
    let again = RecoveryState { suspects: [("c.glsl".to_owned(), hash("new"))].into(), ..next };
    let again = again.after_loss(CAUSE, &good);
    assert_eq!((again.quarantined.len(), again.losses), (2, 2));
}

#[test]
fn without_a_new_text_the_settings_are_set_back_but_not_the_camera() {
    let (mut state, good) = session();
    let work = state.work.as_mut().unwrap();
    Arc::make_mut(&mut work.settings).camera.eye = Some([1.0, 2.0, 3.0]);
    let moved = work.clone();
    let next = state.clone().after_loss(CAUSE, &good);
    assert_eq!(next.work.as_ref(), Some(&moved), "a camera is never suspected");
    assert_eq!(next.loss.unwrap().reset, [""; 0]);

    let work = state.work.as_mut().unwrap();
    let settings = Arc::make_mut(&mut work.settings);
    settings.shader.insert("rate".into(), ShaderValue::Float(0.0));
    settings.view.msaa = 1;
    work.model = Some("huge.glb".into());
    let next = state.after_loss(CAUSE, &good);
    assert_eq!(next.loss.unwrap().reset, ["shader.rate", "view.msaa", "the model"]);
    assert_eq!(next.work, Some(SessionState { settings: moved.settings, ..session().0.work.unwrap() }));
    assert!(next.quarantined.is_empty());
}

#[test]
fn one_panic_changes_nothing_and_a_second_one_suspects_new_texts() {
    let (mut state, good) = session();
    let suspects: BTreeMap<_, _> = [("a.glsl".to_owned(), hash("new"))].into();
    Arc::make_mut(&mut state.work.as_mut().unwrap().settings).mode = "normal".into();
    let work = state.work.clone();
    let next = RecoveryState { suspects: suspects.clone(), ..state }.after_panic("Specula failed");
    assert_eq!((next.losses, &next.work, next.loss.as_ref().unwrap().reset.len()), (1, &work, 0));
    assert!(next.quarantined.is_empty() && next.suspects.is_empty());
    let again = RecoveryState { suspects: suspects.clone(), ..next }.after_loss("Specula failed", &good);
    assert_eq!((again.losses, again.quarantined), (2, suspects));
}

#[test]
fn texts_of_another_tree_are_left_together_with_it() {
    let (mut state, good) = session();
    state.work.as_mut().unwrap().tree = Some("other".into());
    state.suspects = [("a.glsl".to_owned(), hash("new"))].into();
    let next = state.after_loss(CAUSE, &good);
    assert_eq!(next.loss.unwrap().reset, ["the shader tree"]);
    assert!(next.quarantined.is_empty());
}

#[test]
fn records_are_read_by_the_next_process() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(RecoveryState::read(folder.path()), RecoveryState::default());
    let (state, good) = session();
    let recorder = Recorder::new(Some(folder.path().to_owned()), RecoveryState::default(), GoodTexts::default());
    let before = recorder.try_texts([(TreePath::from("a.glsl"), hash("new"))].into(), BTreeMap::new());
    assert!(before.is_empty());
    let window = Geometry { size: (640, 480), at: Some((3, -4)) };
    let attempt = recorder.begin(state.work.as_ref().unwrap(), || window);
    let read = RecoveryState::read(folder.path());
    assert_eq!((read.work, read.good, read.window), (state.work.clone(), None, Some(window)));
    assert_eq!(read.suspects.len(), 1);
    recorder.drawn(attempt);
    assert_eq!(RecoveryState::read(folder.path()).good, state.work);
    recorder.take_back(before);
    assert!(RecoveryState::read(folder.path()).suspects.is_empty());

    good.write(folder.path()).unwrap();
    assert_eq!(GoodTexts::read(folder.path(), None), good);
    remove_folder(folder.path());
    assert!(!folder.path().exists());
}

/// Folders of old archives have names in other encodings.
#[cfg(unix)]
#[test]
fn paths_that_are_not_utf_8_are_recorded() {
    use std::os::unix::ffi::OsStringExt as _;
    let folder = tempfile::tempdir().unwrap();
    let odd = || Some(PathBuf::from(std::ffi::OsString::from_vec(b"/tmp/\xe9t\xe9".to_vec())));
    let work = SessionState { model: odd(), tree: odd(), ..SessionState::default() };
    let recorder = Recorder::new(Some(folder.path().to_owned()), RecoveryState::default(), GoodTexts::default());
    recorder.begin(&work, || Geometry { size: (640, 480), at: None });
    assert_eq!(RecoveryState::read(folder.path()).work, Some(work));
    let good = GoodTexts { tree: odd(), ..GoodTexts::default() };
    good.write(folder.path()).unwrap();
    assert_eq!(GoodTexts::read(folder.path(), None), good);
    let typed = TypedText {
        root: odd().unwrap(),
        file: "a.glsl".into(),
        path: "a.glsl".into(),
        base: String::new(),
        text: "text".to_owned(),
    };
    typed::write(folder.path(), std::slice::from_ref(&typed)).unwrap();
    assert_eq!(typed::read(folder.path()), [typed]);
}

#[test]
fn typed_texts_are_kept_beside_those_of_before() {
    let (folder, state) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let kept = state.path().join("unsaved");
    assert!(typed::copy(folder.path(), &kept).is_empty() && !kept.exists());
    let typed = |text: &str| TypedText {
        root: "tree".into(),
        file: "brdf/ndf.glsl".into(),
        path: "brdf/ndf.glsl".into(),
        base: String::new(),
        text: text.to_owned(),
    };
    for (text, name) in [("one", "brdf-ndf.glsl"), ("two", "2-brdf-ndf.glsl")] {
        typed::write(folder.path(), &[typed(text)]).unwrap();
        assert_eq!(typed::copy(folder.path(), &kept), [kept.join(name)]);
        assert_eq!(fs::read_to_string(kept.join(name)).unwrap(), text);
    }
}

#[cfg(unix)]
#[test]
fn nobody_waits_while_the_texts_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let (state, good) = session();
    let recorder = Recorder::new(Some(folder.path().to_owned()), RecoveryState::default(), GoodTexts::default());
    let work = state.work.unwrap();
    let geometry = || Geometry { size: (640, 480), at: None };
    recorder.begin(&work, geometry);
    // Writing to a pipe waits for its reader.
    let pipe = unfinished(folder.path(), GOOD);
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let texts = good.texts.iter().map(|(path, text)| (TreePath::from(path.as_str()), text.as_str().into())).collect();
    let (draws, drawn) = std::sync::mpsc::channel();
    let window = recorder.clone();
    std::thread::spawn(move || {
        window.drawn_all(1, &texts);
        let attempt = window.begin(&work, geometry);
        window.drawn(attempt);
        draws.send(())
    });
    // Only a failure takes so long.
    drawn.recv_timeout(std::time::Duration::from_secs(20)).expect("the window waits for the file");
    let written: GoodTexts = serde_json::from_slice(&fs::read(&pipe).unwrap()).unwrap();
    recorder.finish();
    assert_eq!(written.texts, good.texts);
    assert_eq!(RecoveryState::read(folder.path()).losses, 0);
}

#[test]
fn the_last_turn_of_a_camera_is_recorded_once_the_window_rests() {
    let folder = tempfile::tempdir().unwrap();
    let work = session().0.work.unwrap();
    let recorder = Recorder::new(Some(folder.path().to_owned()), RecoveryState::default(), GoodTexts::default());
    let geometry = || Geometry { size: (640, 480), at: None };
    recorder.begin(&work, geometry);
    assert_eq!(recorder.rest(), None, "all is recorded");
    let mut turned = work;
    Arc::make_mut(&mut turned.settings).camera.eye = Some([1.0, 2.0, 3.0]);
    recorder.begin(&turned, geometry);
    // The same frame again has nothing new to record, but the turn may not be recorded yet.
    recorder.begin(&turned, geometry);
    while let Some(wait) = recorder.rest() {
        std::thread::sleep(wait);
    }
    assert_eq!(RecoveryState::read(folder.path()).work, Some(turned));
}
