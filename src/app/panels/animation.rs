//! The rows of the panel Model for a model that moves: its clips, which mix, and the weights of its morph targets.

use egui::{ScrollArea, Ui};

use super::clock;
use crate::app::command::playback::{PLAYBACK, PlaybackFields};
use crate::app::command::spec::Command;
use crate::app::numbers::Scale;
use crate::app::state::playback::Playback;
use crate::app::widgets::rows::{self, Row, check, edit_number, heading};
use crate::scene::{Model, held_entry};
use crate::settings::{AnimationSettings, Curve, Settings};

/// Height of a list of clips or targets, in points. A face has some fifty targets.
const TALLEST: f32 = 260.0;

/// Shows the rows. Returns what the user changes of the clock.
pub(super) fn show(ui: &mut Ui, settings: &mut Settings, model: &Model, playback: &Playback) -> Option<Command> {
    let mut asked = None;
    if !model.motion.clips.is_empty() {
        heading(ui, "Animation");
        if let Some((time_s, length_s)) = time_in_clip(&settings.animation, model, playback.time_s()) {
            let length = format!("{length_s:.1}");
            asked = clock::buttons(ui, playback, &format!("{time_s:>width$.1} of {length} s", width = length.len()));
            let chosen = clock::scrub(ui, time_s, length_s);
            let stop = chosen.and_then(|time_s| clock_at(&settings.animation, time_s, length_s));
            let stop = stop.map(|time| PlaybackFields { time: Some(time), paused: Some(true), ..Default::default() });
            asked = stop.or(asked);
        }
        list(ui, "clips", |ui| clips(ui, settings, model));
        rows::group(ui, settings, "animation", |_, _, path| matches!(path, "animation.clips" | "animation.weights"));
    }
    let targets = model.target_keys();
    if !targets.is_empty() {
        heading(ui, "Morph targets");
        list(ui, "targets", |ui| weights(ui, settings, model, &targets));
    }
    asked.map(|asked| PLAYBACK.with(asked))
}

/// The time in the longest clip that plays, and its length, seconds. `None` if no clip takes time.
fn time_in_clip(settings: &AnimationSettings, model: &Model, clock_s: f32) -> Option<(f32, f32)> {
    let playing = model.playing(settings, clock_s).into_iter();
    let times = playing.map(|playing| (playing.time_s as f32, model.motion.clips[playing.clip].duration_s));
    times.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, length_s)| *length_s > 0.0)
}

/// The time of the clock at which a clip is at `time_s`; `None` for clips that stand still.
fn clock_at(settings: &AnimationSettings, time_s: f32, length_s: f32) -> Option<f32> {
    let clock_s = (time_s - settings.time) / settings.speed;
    let clock_s = if settings.looped { clock_s.rem_euclid(length_s / settings.speed.abs()) } else { clock_s };
    clock_s.is_finite().then_some(clock_s)
}

fn list(ui: &mut Ui, id: &str, rows: impl FnOnce(&mut Ui)) {
    ScrollArea::vertical().id_salt(id).max_height(TALLEST).auto_shrink([false, true]).show(ui, rows);
}

/// A row for each clip: whether it plays, and how much of it the later ones leave.
fn clips(ui: &mut Ui, settings: &mut Settings, model: &Model) {
    let playing = model.playing(&settings.animation, 0.0);
    let mut weights: Vec<Option<f32>> = vec![None; model.motion.clips.len()];
    playing.iter().for_each(|playing| weights[playing.clip] = Some(playing.weight));
    let mut changed = false;
    for (index, weight) in weights.iter_mut().enumerate() {
        let key = model.clip_key(index);
        // A clip without a name has its number as key.
        let name = if key.parse::<usize>() == Ok(index) { format!("Clip {key}") } else { key.clone() };
        let row = Row {
            name: &name,
            doc: "Whether the clip plays. It replaces the pose of those above it, or a part of it by its weight",
            option: rows::set_option("animation.clips", &key),
            is_changed: false,
            is_indented: false,
        };
        row.show(ui, |ui| {
            let mut plays = weight.is_some();
            let mut response = check(ui, &mut plays);
            if plays != weight.is_some() {
                (*weight, changed) = (plays.then_some(1.0), true);
            }
            if let Some(weight) = weight {
                let mut number = f64::from(*weight);
                let edit = edit_number(ui, &key, &mut number, &scale((0.0, 1.0)));
                changed |= edit.changed();
                *weight = number as f32;
                response = response.union(edit);
            }
            response
        });
    }
    if changed {
        let entry = |(index, weight): (usize, f32)| match weight {
            1.0 => model.clip_key(index),
            weight => held_entry(&model.clip_key(index), weight),
        };
        let chosen = weights.into_iter().enumerate().filter_map(|(index, weight)| Some(entry((index, weight?))));
        settings.animation.clips = chosen.collect();
        if settings.animation.clips.is_empty() {
            settings.animation.clips.push("none".to_owned());
        }
    }
}

/// A row for each morph target, with its weight at the moment. A weight that is set is held until its name is double-clicked.
fn weights(ui: &mut Ui, settings: &mut Settings, model: &Model, targets: &[String]) {
    for key in targets {
        if rows::skips(ui) {
            continue;
        }
        let index =
            settings.animation.weights.iter().position(|entry| entry.rsplit_once(':').is_some_and(|of| of.0 == key));
        let weight = model.weight_of(key);
        let mut number = f64::from(weight);
        let row = Row {
            name: key,
            doc: "The weight of the morph target, in place of that of the file and its clips",
            option: rows::set_option("animation.weights", &held_entry(key, weight)),
            is_changed: index.is_some(),
            is_indented: false,
        };
        let mut changed = false;
        let resets = row.show(ui, |ui| {
            let response = edit_number(ui, key, &mut number, &scale((-1000.0, 1000.0)));
            changed = response.changed();
            response
        });
        let held = &mut settings.animation.weights;
        match index {
            Some(index) if resets => drop(held.remove(index)),
            Some(index) if changed => held[index] = held_entry(key, number as f32),
            None if changed => held.push(held_entry(key, number as f32)),
            _ => {}
        }
    }
}

fn scale(limits: (f64, f64)) -> Scale {
    let suffix = String::new();
    Scale { slider: Some((0.0, 1.0)), limits, suffix, decimals: 2, curve: Curve::Linear, is_signed: false }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::scene::{Clip, Motion};

    #[test]
    fn the_time_is_that_of_the_clip_and_leads_back_to_it() {
        let clip = |duration_s| Clip { duration_s, ..Clip::default() };
        let motion = Arc::new(Motion { clips: vec![clip(4.0), clip(12.0)], ..Motion::default() });
        let model = Model { motion, ..Model::default() };
        let all = AnimationSettings { clips: vec!["all".to_owned()], ..AnimationSettings::default() };
        for (time, speed, looped, clock_s, expected) in [
            (0.0, 1.0, true, 11.5, 11.5),
            (0.0, 1.0, true, 13.0, 1.0),
            (0.0, 1.0, false, 13.0, 12.0),
            (2.0, 2.0, true, 3.0, 8.0),
            (0.0, -1.0, true, 3.0, 9.0),
        ] {
            let settings = AnimationSettings { time, speed, looped, ..all.clone() };
            let at = time_in_clip(&settings, &model, clock_s);
            assert_eq!(at, Some((expected, 12.0)), "{clock_s} s");
            let again =
                clock_at(&settings, expected, 12.0).and_then(|clock_s| time_in_clip(&settings, &model, clock_s));
            assert_eq!(again, at, "{clock_s} s");
        }
        assert_eq!(clock_at(&AnimationSettings { speed: 0.0, ..all.clone() }, 3.0, 12.0), None);
        assert_eq!(time_in_clip(&AnimationSettings { clips: vec!["none".to_owned()], ..all }, &model, 1.0), None);
    }
}
