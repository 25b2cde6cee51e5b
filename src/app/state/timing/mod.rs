//! The times of the last drawn frames, and what the last edit has changed about them. A window that rests draws no frames, so this is a
//! history of frames and not of time.

mod cost;
mod sample;

use std::collections::VecDeque;

use crate::events::Summary;
use crate::gpu::{DrawCounts, PassTime};
pub(in crate::app) use cost::Cost;
pub(in crate::app) use sample::{CpuTimes, Sample, Shown};

/// Number of frames in the history.
pub(in crate::app) const FRAMES: usize = 240;
/// Number of frames whose times are kept for [`Timing::summary`].
const SUMMARIZED: usize = 4096;
/// Frames between two summaries for the panel.
const SUMMARIZED_EVERY: u64 = 60;
/// Frames that are drawn only to measure a picture.
const EXTRA: usize = 4;

/// Device times of a finished frame.
pub(in crate::app) struct DeviceTimes<'a> {
    /// Serial number of the frame.
    pub(in crate::app) serial: u64,
    pub(in crate::app) ms: f64,
    pub(in crate::app) passes: &'a [PassTime],
    pub(in crate::app) counts: DrawCounts,
    /// Whether the device compiles in the first frame of new shaders, as a software device does.
    pub(in crate::app) compiles_in_frame: bool,
}

/// The history.
#[derive(Default)]
pub(in crate::app) struct Timing {
    /// Frames that the device has not finished: serial number, what they show, and the CPU's times.
    submitted: VecDeque<(u64, Shown, CpuTimes)>,
    /// Frames that have drawn the picture.
    pictures: VecDeque<Sample>,
    /// The CPU's times of all frames.
    frames: VecDeque<CpuTimes>,
    /// CPU time of panels, of the frames that have run them.
    ui_ms: VecDeque<f64>,
    /// CPU time of the window's thread for whole frames.
    cpu_ms: VecDeque<f64>,
    drawn: u64,
    /// The last [`Timing::recent_summary`].
    summarized: (u64, [Summary; 2]),
    cost: cost::Tracker,
    /// The shaders whose picture is being measured, and how many frames have been drawn for that.
    extra: Option<(Shown, usize)>,
}

impl Timing {
    /// Records a submitted frame.
    pub(in crate::app) fn submitted(&mut self, serial: u64, shown: Shown, cpu: CpuTimes) {
        self.submitted.push_back((serial, shown, cpu));
        if self.submitted.len() > 8 {
            self.submitted.pop_front();
        }
        push(&mut self.frames, cpu, FRAMES);
        if cpu.ui_ms > 0.0 {
            push(&mut self.ui_ms, cpu.ui_ms, SUMMARIZED);
        }
        self.drawn += 1;
        if self.drawn % SUMMARIZED_EVERY == 1 {
            self.summarized = self.summary();
        }
    }

    /// Notes the CPU time of the window's thread for a whole frame.
    pub(in crate::app) fn used(&mut self, cpu_ms: f64) {
        push(&mut self.cpu_ms, cpu_ms, SUMMARIZED);
    }

    /// Collects the times of a finished frame, once.
    pub(in crate::app) fn finished(&mut self, times: &DeviceTimes<'_>) {
        let Some(at) = self.submitted.iter().position(|(serial, ..)| *serial == times.serial) else { return };
        let Some((_, shown, cpu)) = self.submitted.drain(..=at).next_back() else { return };
        let DeviceTimes { ms, passes, counts, .. } = *times;
        let sample = Sample { shown, cpu, device_ms: ms, passes: passes.to_vec(), counts };
        self.cost.compiles_in_frame = times.compiles_in_frame;
        if sample.is_of_picture() {
            self.cost.take(&sample, &self.pictures);
            push(&mut self.pictures, sample, FRAMES);
        }
    }

    /// Frames that have drawn the picture, the oldest first.
    pub(in crate::app) fn pictures(&self) -> &VecDeque<Sample> {
        &self.pictures
    }

    /// The CPU's times of the last frames, the oldest first.
    pub(in crate::app) fn frames(&self) -> &VecDeque<CpuTimes> {
        &self.frames
    }

    /// Device time of the last frame that drew the picture, milliseconds.
    pub(in crate::app) fn frame_ms(&self) -> Option<f64> {
        self.pictures.back().map(|sample| sample.device_ms)
    }

    /// Cost of the last edit; `None` before the first edit.
    pub(in crate::app) fn cost(&self) -> Option<Cost> {
        self.cost.cost()
    }

    /// Number of frames so far, and the CPU's time of panels and of the whole frame in the last of them.
    pub(in crate::app) fn summary(&self) -> (u64, [Summary; 2]) {
        (self.drawn, [&self.ui_ms, &self.cpu_ms].map(|list| Summary::of(list.iter().copied())))
    }

    /// [`Timing::summary`] as it was some frames ago: sorting the times of all frames would be a part of each frame's time.
    pub(in crate::app) fn recent_summary(&self) -> (u64, [Summary; 2]) {
        self.summarized
    }

    /// CPU time of the window's thread for the last whole frame.
    pub(in crate::app) fn cpu_ms(&self) -> Option<f64> {
        self.cpu_ms.back().copied()
    }

    /// Whether to draw the model again although nothing has changed, because too few frames measure new shaders. Each call counts
    /// as a frame.
    pub(in crate::app) fn wants_frame(&mut self, shown: &Shown) -> bool {
        if self.extra.as_ref().is_none_or(|(of, _)| of != shown) {
            self.extra = Some((shown.clone(), 0));
        }
        let Some((_, drawn)) = &mut self.extra else { return false };
        *drawn += 1;
        *drawn <= EXTRA
    }
}

fn push<T>(list: &mut VecDeque<T>, item: T, most: usize) {
    if list.len() >= most {
        list.pop_front();
    }
    list.push_back(item);
}

#[cfg(test)]
pub(in crate::app) mod tests {
    use super::*;

    pub(in crate::app) fn shown(generation: u64) -> Shown {
        Shown { tree: 0, generation, mode: "final".into(), size: (640, 480), model: "ball".into() }
    }

    pub(in crate::app) fn passes(times: &[(&str, f64)]) -> Vec<PassTime> {
        times.iter().map(|(name, ms)| PassTime { name: (*name).to_owned(), ms: *ms, kept: false }).collect()
    }

    /// A frame that goes to the device and is finished.
    pub(in crate::app) fn draw(timing: &mut Timing, shown: &Shown, times: &[(&str, f64)]) {
        draw_on(timing, false, shown, times);
    }

    /// Such a frame on a device that compiles in the first frame, or does not.
    pub(in crate::app) fn draw_on(timing: &mut Timing, compiles_in_frame: bool, shown: &Shown, times: &[(&str, f64)]) {
        let serial = timing.drawn + 1;
        let cpu = CpuTimes { ui_ms: serial as f64, record_ms: 1.0 };
        timing.submitted(serial, shown.clone(), cpu);
        let ms = times.iter().map(|(_, ms)| ms).sum();
        let passes = passes(times);
        let counts = DrawCounts::default();
        let times = DeviceTimes { serial, ms, passes: &passes, counts, compiles_in_frame };
        timing.finished(&times);
        // The next frame asks again before a newer one has finished.
        timing.finished(&times);
    }

    #[test]
    fn a_frame_of_the_panels_alone_is_no_time_of_the_picture() {
        let mut timing = Timing::default();
        draw(&mut timing, &shown(1), &[("tone map", 0.5), ("ui", 0.5)]);
        assert_eq!(timing.frame_ms(), None);
        draw(&mut timing, &shown(1), &[("model", 6.0), ("tone map", 1.0), ("ui", 1.0)]);
        draw(&mut timing, &shown(1), &[("tone map", 0.5), ("ui", 0.5)]);
        assert_eq!((timing.frame_ms(), timing.pictures().len(), timing.frames().len()), (Some(8.0), 1, 3));
        // A pass that is off is absent, and one that covers the model draws a picture as well.
        draw(&mut timing, &shown(1), &[("image", 4.0), ("ui", 1.0)]);
        let last = timing.pictures().back().unwrap();
        assert_eq!((last.device_ms, last.pass_ms("image"), last.pass_ms("model")), (5.0, Some(4.0), None));
        // A frame that also draws an older picture measures neither.
        draw(&mut timing, &shown(1), &[("model", 4.0), ("compare", 4.0), ("ui", 1.0)]);
        assert_eq!(timing.frame_ms(), Some(5.0));
    }

    #[test]
    fn the_history_is_bounded_and_summarized() {
        let mut timing = Timing::default();
        (0..500).for_each(|_| draw(&mut timing, &shown(1), &[("model", 1.0)]));
        assert_eq!((timing.pictures().len(), timing.frames().len()), (FRAMES, FRAMES));
        let (frames, [summary, _]) = timing.summary();
        assert_eq!((frames, summary.max), (500, 500.0));
        assert!((summary.median - 250.0).abs() <= 1.0 && (summary.p95 - 475.0).abs() <= 1.0, "{summary:?}");
    }

    #[test]
    fn new_shaders_get_a_few_frames_more_and_no_endless_row() {
        let mut timing = Timing::default();
        let asked =
            |timing: &mut Timing, generation| (0..20).filter(|_| timing.wants_frame(&shown(generation))).count();
        assert_eq!((asked(&mut timing, 1), asked(&mut timing, 1), asked(&mut timing, 2)), (EXTRA, 0, EXTRA));
    }
}
