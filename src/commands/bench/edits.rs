//! `specula bench reload --edits FILE`: what compiling only edited functions saves between a save and the picture.
//!
//! Replays the edits of a file such as `tests/edits.toml`, each by turns with incremental compilation and with whole stages, and
//! reports both times of each edit and their medians. The picture is the one that a window shows first: other stages are compiled
//! after it, and the light is that baked before the edit. Incremental compilation has to save a fifth of this time on a GPU to be worth
//! its code; `shader::incremental` has the numbers.

use std::path::{Path, PathBuf};
use std::time::Instant;

use crossbeam_channel::Receiver;
use serde::Deserialize;
use serde_json::{Value, json};
use specula::headless::Headless;
use specula::pipeline::Outcome;
use specula::shader::{Batch, Change, Source};

use super::context::Bench;
use super::samples::{ms, round, summary};
use crate::commands::Failure;

#[derive(Deserialize)]
struct List {
    edit: Vec<Edit>,
}

/// An edit of a shader tree.
#[derive(Deserialize)]
struct Edit {
    /// A number, a body, a function and so on.
    kind: String,
    file: String,
    from: String,
    /// The text that replaces `from`. `{n}` stands for a number that differs in each replay.
    to: String,
    /// The debug mode on screen.
    #[serde(default = "final_mode")]
    mode: String,
}

fn final_mode() -> String {
    "final".to_owned()
}

/// A copy of the tree on disk, which is watched, and what draws it.
struct Replay {
    headless: Headless,
    root: PathBuf,
    batches: Receiver<Batch>,
}

impl Replay {
    /// Saves a file and waits for the watcher.
    fn save(&self, file: &str, text: &str) -> Result<Change, Failure> {
        std::fs::write(self.root.join(file), text).map_err(|e| Failure::Input(e.to_string()))?;
        let batch = self.batches.recv().map_err(|e| Failure::Input(e.to_string()))?;
        Ok(self.headless.reloader().library().change_of(&batch.paths))
    }

    /// Milliseconds from the save of an edit to its picture. The edit is reverted afterwards.
    fn time(&mut self, edit: &Edit, number: u32) -> Result<f64, Failure> {
        let original = std::fs::read_to_string(self.root.join(&edit.file))
            .map_err(|e| Failure::Input(format!("{}: {e}", edit.file)))?;
        if !original.contains(&edit.from) {
            return Err(Failure::Input(format!("{}: no `{}`", edit.file, edit.from)));
        }
        let text = original.replacen(&edit.from, &edit.to.replace("{n}", &number.to_string()), 1);
        let begin = Instant::now();
        let change = self.save(&edit.file, &text)?;
        check(self.headless.update_on_screen(change).outcome)?;
        self.headless.draw_on_screen()?;
        let total_ms = ms(begin);
        let change = self.save(&edit.file, &original)?;
        check(self.headless.update(change).outcome)?;
        self.headless.draw()?;
        Ok(total_ms)
    }
}

fn check(outcome: Outcome) -> Result<(), Failure> {
    match outcome {
        Outcome::Failed(diagnostics) => Err(Failure::Shaders(diagnostics)),
        Outcome::Ready(_) | Outcome::Unchanged { .. } => Ok(()),
    }
}

/// Replays the list `--samples` times.
pub(super) fn edits(bench: &Bench<'_>) -> Result<Value, Failure> {
    let args = bench.args;
    let list = read(args.edits.as_deref().unwrap_or(Path::new("")))?;
    let (folder, _watcher, batches) = bench.watched_copy()?;
    let (source, settings) = (Source::disk(folder.0.clone()), args.common.settings()?);
    let headless = bench.renderer(source, settings, bench.model()?)?;
    let mut replay = Replay { headless, root: folder.0.clone(), batches };
    // Each edit's times, with incremental compilation and without.
    let mut times: Vec<[Vec<f64>; 2]> = list.iter().map(|_| Default::default()).collect();
    let mut number = 100;
    for sample in 0..args.samples as usize {
        for (index, (edit, times)) in list.iter().zip(&mut times).enumerate() {
            bench.progress.begin("edit", (index, list.len()), &edit.file);
            replay.headless.settings_mut().mode.clone_from(&edit.mode);
            replay.headless.draw()?;
            // Whoever comes second may find warm caches.
            let first = (sample + index) % 2;
            for way in [first, 1 - first] {
                number += 1;
                replay.headless.compile_whole(way == 1);
                times[way].push(replay.time(edit, number)?);
            }
        }
    }
    let median = |list: &[f64]| summary(list.to_vec())["median"].as_f64().unwrap_or(f64::NAN);
    let medians: Vec<[f64; 2]> = times.iter().map(|both| both.each_ref().map(|list| median(list))).collect();
    let [with, without] = [0, 1].map(|way| medians.iter().map(|both| both[way]).collect::<Vec<f64>>());
    let row =
        |(edit, [with, without]): (&Edit, &[f64; 2])| json!([edit.kind, edit.file, round(*with), round(*without)]);
    let saved = 1.0 - median(&with) / median(&without);
    Ok(json!({
        "edits": list.iter().zip(&medians).map(row).collect::<Vec<_>>(),
        "incremental_ms": summary(with),
        "whole_ms": summary(without),
        "saved_percent": round(100.0 * saved),
    }))
}

fn read(path: &Path) -> Result<Vec<Edit>, Failure> {
    let text = std::fs::read_to_string(path).map_err(|e| Failure::Input(format!("{}: {e}", path.display())))?;
    let list: List = toml::from_str(&text).map_err(|e| Failure::Input(format!("{}: {e}", path.display())))?;
    Ok(list.edit)
}
