//! Measures how much the picture differs from the one that it is compared with. Both are read back once they rest, and compared on
//! a thread.

use super::Screen;
use super::difference_pair::{Copied, ErrorMap, Pair};
use super::reference_view::ReferenceView;
use crate::gpu::{GpuError, Rect, Use};
use crate::render::{BoundFrame, Output, Redraw};
use crate::threads::Side;

/// Effect of a frame on the measured difference.
#[derive(Default)]
pub(in crate::app) struct Measurement {
    /// Whether the last difference belongs to other pictures.
    pub(in crate::app) is_outdated: bool,
    /// The number of the measurement that is under way, if that changes.
    pub(in crate::app) under_way: Option<Option<u64>>,
    /// Whether another frame is needed.
    pub(in crate::app) has_more: bool,
}

impl Screen {
    /// Copies the picture and the reference if both are unchanged since the last frame and have not been measured. A lack of memory is
    /// kept for the end of the frame.
    pub(in crate::app) fn measure_error(
        &mut self,
        wanted: bool,
        live: Option<&BoundFrame>,
    ) -> Result<Measurement, GpuError> {
        let Some((reference, live)) = self.reference.as_ref().filter(|_| wanted).zip(live) else {
            self.error_map = ErrorMap { number: self.error_map.number, ..ErrorMap::default() };
            return Ok(Measurement { under_way: Some(None), ..Measurement::default() });
        };
        let numbers = [reference.view.picture(), reference.still_number(), self.view.picture()];
        let states = [reference.frame.state.clone(), live.state.clone()];
        let same_size = states[0].size == states[1].size;
        let pair = Pair { numbers, states };
        let is = |other: &Option<Pair>| other.as_ref().is_some_and(|other| other.is_same(&pair));
        let (rests, is_known) = (is(&self.error_map.last), is(&self.error_map.measured));
        if is_known {
            self.error_map.last = Some(pair);
            return Ok(Measurement::default());
        }
        // The last measurement belongs to other pictures.
        let outdated = Measurement { is_outdated: true, under_way: Some(None), has_more: same_size };
        self.error_map.copied = None;
        if !rests || !same_size {
            self.error_map.last = Some(pair);
            return Ok(outdated);
        }
        let copied = self.copy_pictures(live);
        if self.survive(copied)?.is_none() {
            return Ok(Measurement { has_more: false, ..outdated });
        }
        self.error_map.number += 1;
        self.error_map.measured = Some(pair);
        let number = self.error_map.copied.is_some().then_some(self.error_map.number);
        Ok(Measurement { under_way: Some(number), ..outdated })
    }

    /// Draws both pictures as they are displayed, and copies them to CPU memory.
    fn copy_pictures(&mut self, live: &BoundFrame) -> Result<(), GpuError> {
        let image = self.view.output_image(live.state.size)?;
        let mut encoder = self.frames.begin()?;
        self.check_loops();
        let slot = self.frames.current();
        let output = Output { image: &image, before: Use::Undefined, at: (0, 0) };
        encoder.untimed(|encoder| self.view.draw(encoder, slot, live, &output, Redraw::IfChanged))?;
        let of_live = self.view.read_back(&mut encoder, &image)?;
        let of_reference = match &mut self.reference {
            Some(reference) => reference.copy(&mut encoder, slot)?,
            None => None,
        };
        let part = self.reference.as_ref().map(ReferenceView::covered).unwrap_or_default();
        self.frames.submit(encoder, Default::default())?;
        let copied = of_reference.zip(of_live.map(Side::Drawn));
        self.error_map.copied = copied.map(|(a, b)| Copied { slot, pictures: [a, b], part });
        Ok(())
    }

    /// Copies whose frame has finished: the number of the measurement, both pictures, and the part that is compared.
    pub(in crate::app) fn take_copies(&mut self) -> Option<(u64, [Side; 2], Rect)> {
        let is_finished = |copied: &mut Copied| self.frames.is_finished(copied.slot);
        let Copied { pictures, part, .. } = self.error_map.copied.take_if(is_finished)?;
        Some((self.error_map.number, pictures, part))
    }
}
