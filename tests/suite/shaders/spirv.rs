//! SPIRV-Tools accepts every module that a driver gets: each stage with every mode and choice, each example, modes in one stage.
//! `SPECULA_LONG=1` validates also specializations before they are finished.
//! Modules of edited functions are validated in `shader::incremental`, and those of random programs in `random_programs`.

use std::collections::HashSet;
use std::sync::Arc;

use rayon::prelude::*;
use specula::interface::{SPEC_FEATURES, SPEC_MODE};
use specula::shader::embedded::Example;
use specula::shader::spirv::loops::Bounds;
use specula::shader::spirv::{behavior_hash, finish, specialize, specialize_several, validate};
use specula::shader::{Change, Library, ShaderSet, Source, Stage, StageKind, Update};

use crate::support::{Tree, compiler, is_long, lines};

/// How many modes share a stage (thumbnails).
const SEVERAL: usize = 8;

fn set(source: Source) -> Arc<ShaderSet> {
    let stages: Vec<String> =
        source.list().iter().filter(|path| StageKind::of(path).is_some()).map(ToString::to_string).collect();
    let names: Vec<&str> = stages.iter().map(String::as_str).collect();
    match Library::new(source, compiler().clone(), &names).update(&Change::All) {
        Update::Ready(set, _) => set,
        Update::Failed(errors, _) => panic!("{}", lines(&errors).join("\n")),
        Update::Unchanged { .. } => panic!("an empty tree"),
    }
}

#[track_caller]
fn assert_valid(words: &[u32], what: &str) {
    if let Err(error) = validate(words) {
        panic!("{what}: {error}");
    }
}

/// Fails unless a specialization of a stage is valid as a driver gets it.
#[track_caller]
fn assert_finished(stage: &Stage, words: Vec<u32>, what: &str) {
    let what = format!("{} with {what}", stage.path);
    let mark = (stage.kind == StageKind::Fragment).then_some([1.0, 0.0, 1.0, 257.0]);
    let bounds = Bounds { rounds: 1 << 18, rounds_after: 256, report: Some((0, 20)), mark };
    if is_long() {
        assert_valid(&words, &what);
        let finished = finish(words.clone(), &stage.spirv, &Bounds { report: None, ..bounds }, false);
        assert_valid(&finished.words, &format!("{what}, without a report"));
    }
    let finished = finish(words, &stage.spirv, &bounds, stage.can_index_draws());
    assert_valid(&finished.words, &format!("{what}, finished"));
}

/// Values of a stage's constants: the defaults, and each other value of one of them.
fn specializations(set: &ShaderSet, stage: &Stage) -> Vec<Vec<(u32, u32)>> {
    let mut all = vec![Vec::new()];
    for constant in &stage.reflection.constants {
        let choices = set.constants.iter().find(|known| known.id == constant.id).map(|known| &known.choices);
        let values: Vec<u32> = match constant.id {
            SPEC_MODE => set.modes.iter().map(|mode| mode.id).collect(),
            SPEC_FEATURES => (0..32).map(|bit| 1 << bit).chain([0, u32::MAX]).collect(),
            _ => match choices.filter(|choices| !choices.is_empty()) {
                Some(choices) => choices.iter().map(|(_, value)| *value as u32).collect(),
                None => vec![0, 1, 2],
            },
        };
        all.extend(
            values.into_iter().filter(|value| *value != constant.default).map(|value| vec![(constant.id, value)]),
        );
    }
    all
}

#[test]
fn stages_are_valid_with_every_mode_and_choice() {
    let set = set(Source::embedded());
    assert!(set.modes.len() > 100 && set.stages.len() > 40, "{} modes, {} stages", set.modes.len(), set.stages.len());
    let tried = set.stages.par_iter().map(|(_, stage)| {
        // Most stages do not depend on most constants.
        let mut seen = HashSet::new();
        for values in specializations(&set, stage) {
            let words = specialize(&stage.spirv, &values);
            if seen.insert(behavior_hash(&words)) {
                assert_finished(stage, words, &format!("{values:?}"));
            }
        }
        seen.len()
    });
    let tried: usize = tried.sum();
    assert!(tried > set.modes.len() + set.stages.len(), "{tried} specializations");
}

#[test]
fn several_modes_in_one_stage_are_valid() {
    let set = set(Source::embedded());
    let modes: Vec<u32> = set.modes.iter().map(|mode| mode.id).collect();
    let made = set.stages.par_iter().map(|(_, stage)| {
        let mut seen = HashSet::new();
        for modes in modes.chunks(SEVERAL) {
            let words = specialize_several(&stage.spirv, &[], SPEC_MODE, modes);
            if let Some(words) = words.filter(|words| seen.insert(behavior_hash(words))) {
                assert_finished(stage, words, &format!("the modes {modes:?}"));
            }
        }
        seen.len()
    });
    assert!(made.sum::<usize>() > 10);
}

#[test]
fn stages_of_examples_are_valid() {
    let shipped = set(Source::embedded());
    for name in Example::names() {
        let set = set(Source::example(Example::named(name)));
        let is_own =
            |(path, stage): &(&String, &Arc<Stage>)| shipped.stages.get(*path).is_none_or(|s| s.spirv != stage.spirv);
        let own: Vec<_> = set.stages.iter().filter(is_own).map(|(_, stage)| stage).collect();
        assert!(!own.is_empty(), "{name}");
        own.par_iter().for_each(|stage| assert_finished(stage, specialize(&stage.spirv, &[]), name));
    }
}

/// Without checks, assertions and prints leave no word in what a driver gets of any stage.
#[test]
fn assertions_that_are_off_cost_nothing() {
    const HOOK: &str = "void user_surface(inout Surface s, Fragment f, vec3 v) {";
    let bounds = Bounds { rounds: 1 << 18, rounds_after: 256, report: None, mark: None };
    let of_driver = |stage: &Stage| finish(specialize(&stage.spirv, &[]), &stage.spirv, &bounds, false).words;
    let stages = |more: &str| {
        let tree = Tree::new();
        tree.write("user.glsl", &tree.edited("user.glsl", HOOK, &format!("{HOOK}\n{more}")));
        set(Source::disk(tree.root()))
    };
    let plain = stages("");
    let checked = stages(
        "    assert(s.roughness >= 0.0 && s.metallic <= 1.0, \"a material\");\n    assert(s.roughness < 2.0);\n    \
         print(\"roughness\", s.roughness);",
    );
    let differs = |(path, stage): &(&String, &Arc<Stage>)| checked.stages[*path].spirv != stage.spirv;
    let differing: Vec<_> = plain.stages.iter().filter(differs).collect();
    assert!(differing.iter().any(|(path, _)| *path == "pbr.frag"), "checks have nothing to find");
    differing.into_par_iter().for_each(|(path, stage)| {
        let [without, with] = [stage, &checked.stages[path]].map(|stage| of_driver(stage).len());
        assert_eq!(with, without, "words of {path} with assertions and without");
    });
    let other = of_driver(&stages("    s.roughness += 0.001 * s.metallic;").stages["pbr.frag"]).len();
    assert_ne!(other, of_driver(&plain.stages["pbr.frag"]).len(), "a statement would be seen");
}
