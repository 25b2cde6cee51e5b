//! Cost of the last edit: device time of the frame and of each pass, before and after the edit.

use std::collections::VecDeque;

use super::sample::{Sample, Shown};

/// Newest frames of each side that count.
const FRAMES: usize = 16;
/// Changes smaller than this fraction of the previous time, and than these milliseconds, are noise.
const NOISE: f64 = 0.05;
const NOISE_MS: f64 = 0.02;

/// A pass before and after the edit, in milliseconds; `None` where there is no such pass.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::app) struct CostRow {
    pub(in crate::app) name: String,
    pub(in crate::app) before: Option<f64>,
    pub(in crate::app) after: Option<f64>,
}

impl CostRow {
    /// By how many milliseconds it became slower; negative if it became faster. `None` if the change is no more than noise, or if one side
    /// was not drawn.
    pub(in crate::app) fn change(&self) -> Option<f64> {
        let (before, after) = (self.before?, self.after?);
        let change = after - before;
        (change.abs() > NOISE_MS && change.abs() > before * NOISE).then_some(change)
    }
}

/// Change of device time by an edit.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::app) struct Cost {
    /// Generations of the shaders before and after.
    pub(in crate::app) generations: [u64; 2],
    /// The frame, then each pass.
    pub(in crate::app) rows: Vec<CostRow>,
    /// How many frames the medians are computed from.
    pub(in crate::app) frames: [usize; 2],
}

impl Cost {
    /// The pass that became slower by the most milliseconds.
    pub(in crate::app) fn slower(&self) -> Option<(&CostRow, f64)> {
        let passes = self.rows.iter().skip(1);
        let slower = passes.filter_map(|row| Some((row, row.change().filter(|change| *change > 0.0)?)));
        slower.max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// Collects the frames before and after an edit.
#[derive(Default)]
pub(in crate::app) struct Tracker {
    /// Whether the device compiles in the first frame of new shaders, so that its time does not characterize the shaders.
    pub(in crate::app) compiles_in_frame: bool,
    before: Vec<Sample>,
    after: VecDeque<Sample>,
}

impl Tracker {
    /// Records a frame that drew the model. `earlier`: the frames before it.
    pub(in crate::app) fn take(&mut self, sample: &Sample, earlier: &VecDeque<Sample>) {
        let newest = earlier.back().map(|last| &last.shown);
        if newest.is_some_and(|last| last.generation < sample.shown.generation) {
            // The frames before the edit with equal inputs.
            let is_before = |old: &&Sample| {
                Some(old.shown.generation) == newest.map(|last| last.generation) && old.shown.is_like(&sample.shown)
            };
            self.before = self.of_value(earlier.iter().rev().filter(is_before).take(FRAMES).cloned().collect());
            self.after.clear();
        }
        let is_like = |shown: &Shown| shown.is_like(&sample.shown) && shown.generation < sample.shown.generation;
        if self.before.first().is_some_and(|before| is_like(&before.shown)) {
            self.after.push_back(sample.clone());
            // The oldest are the nearest to the edit, and the first may be the slow one in which a driver compiles.
            self.after.truncate(FRAMES + 1);
        }
    }

    pub(in crate::app) fn cost(&self) -> Option<Cost> {
        let after = self.of_value(self.after.iter().rev().cloned().collect());
        let (before, first) = (self.before.first()?, after.first()?);
        let sides = [&self.before, &after];
        let of = |name: &str| {
            let median_of = |samples: &[Sample]| median(samples.iter().filter_map(|sample| drawn_ms(sample, name)));
            let [before, after] = sides.map(|samples| median_of(samples));
            CostRow { name: name.to_owned(), before, after }
        };
        // A frame that reuses images of passes takes less than one that draws them.
        let is_alike = |sample: &&Sample| kept(sample).eq(kept(first));
        let [before_ms, after_ms] =
            sides.map(|samples| median(samples.iter().filter(is_alike).map(|sample| sample.device_ms)));
        let frame = CostRow { name: "Whole frame".to_owned(), before: before_ms, after: after_ms };
        let mut names: Vec<&str> = Vec::new();
        for pass in first.passes.iter().chain(&before.passes) {
            if !names.contains(&pass.name.as_str()) {
                names.push(&pass.name);
            }
        }
        Some(Cost {
            generations: [before.shown.generation, first.shown.generation],
            rows: std::iter::once(frame).chain(names.into_iter().map(of)).collect(),
            frames: [self.before.len(), after.len()],
        })
    }

    /// The frames, the newest first, without the first frame of their shaders if there are others, or if the device compiles in it.
    fn of_value(&self, mut samples: Vec<Sample>) -> Vec<Sample> {
        if samples.len() > 1 || self.compiles_in_frame {
            samples.pop();
        }
        samples
    }
}

/// The time of a pass in a frame that draws it; `None` if the frame reuses its image.
fn drawn_ms(sample: &Sample, name: &str) -> Option<f64> {
    let is_kept = sample.passes.iter().any(|pass| pass.name == name && pass.kept);
    sample.pass_ms(name).filter(|_| !is_kept)
}

/// The names of the passes whose images a frame reuses.
fn kept(sample: &Sample) -> impl Iterator<Item = &str> {
    sample.passes.iter().filter(|pass| pass.kept).map(|pass| pass.name.as_str())
}

fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::super::Timing;
    use super::super::tests::{draw, draw_on, shown};
    use super::*;

    #[test]
    fn the_pass_that_an_edit_slows_down_is_named() {
        let mut timing = Timing::default();
        // The first frame compiles.
        draw(&mut timing, &shown(1), &[("model", 200.0), ("bloom", 1.0)]);
        (0..3).for_each(|_| draw(&mut timing, &shown(1), &[("model", 2.0), ("bloom", 1.0)]));
        assert_eq!(timing.cost(), None, "no edit yet");
        draw(&mut timing, &shown(2), &[("model", 300.0), ("bloom", 1.0), ("film", 0.5)]);
        (0..3).for_each(|_| draw(&mut timing, &shown(2), &[("model", 3.0), ("bloom", 1.001), ("film", 0.5)]));
        let cost = timing.cost().unwrap();
        assert_eq!((cost.generations, cost.frames), ([1, 2], [3, 3]));
        let row = |name: &str| cost.rows.iter().find(|row| row.name == name).unwrap();
        assert_eq!((row("model").before, row("model").after, row("model").change()), (Some(2.0), Some(3.0), Some(1.0)));
        assert_eq!(row("bloom").change(), None, "noise");
        assert_eq!((row("film").before, row("film").after, row("film").change()), (None, Some(0.5), None));
        assert_eq!(cost.slower().map(|(row, ms)| (row.name.as_str(), ms)), Some(("model", 1.0)));
        assert_eq!(cost.rows[0].before, Some(3.0));
    }

    #[test]
    fn kept_images_and_frames_that_compile_say_nothing() {
        let mut timing = Timing::default();
        draw_on(&mut timing, true, &shown(1), &[("model", 200.0)]);
        draw_on(&mut timing, true, &shown(2), &[("model", 300.0)]);
        draw_on(&mut timing, true, &shown(2), &[("model", 3.0)]);
        assert_eq!(timing.cost(), None, "the only frame before has compiled");
        draw_on(&mut timing, true, &shown(3), &[("model", 300.0)]);
        draw_on(&mut timing, true, &shown(3), &[("model", 2.0)]);
        assert_eq!(timing.cost().unwrap().rows[1].change(), Some(-1.0));

        let mut pass = super::super::tests::passes(&[("model", 2.0), ("ground", 1.0)]);
        let cpu = super::super::CpuTimes::default();
        let sample = |passes: &[crate::gpu::PassTime], generation| Sample {
            shown: shown(generation),
            cpu,
            device_ms: 3.0,
            passes: passes.to_vec(),
            counts: crate::gpu::DrawCounts::default(),
        };
        let drawn = sample(&pass, 1);
        pass[1].kept = true;
        let kept = sample(&pass, 2);
        let tracker = Tracker { before: vec![drawn], after: VecDeque::from([kept]), compiles_in_frame: false };
        let cost = tracker.cost().unwrap();
        assert!(cost.rows.iter().all(|row| row.change().is_none()), "{cost:?}");
    }

    #[test]
    fn only_frames_that_show_the_same_are_compared() {
        let mut timing = Timing::default();
        draw(&mut timing, &shown(1), &[("model", 2.0)]);
        let roughness = |generation| Shown { mode: "roughness".into(), ..shown(generation) };
        draw(&mut timing, &roughness(2), &[("model", 9.0)]);
        assert_eq!(timing.cost(), None);
        // Looking at another mode later keeps the cost of the edit.
        draw(&mut timing, &roughness(3), &[("model", 7.0)]);
        draw(&mut timing, &shown(3), &[("model", 1.0)]);
        let cost = timing.cost().unwrap();
        assert_eq!((cost.rows[0].before, cost.rows[0].after), (Some(9.0), Some(7.0)));
        // Another tree.
        draw(&mut timing, &Shown { tree: 1, ..shown(4) }, &[("model", 1.0)]);
        assert_eq!(timing.cost(), None);
    }
}
