//! Measures how much the picture differs from the one that it is compared with. Both are read back once they rest, and compared on
//! a thread.

use super::Screen;
use super::measured::{Copied, ErrorMap, Pair};
use super::reference_view::ReferenceView;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::gpu::{GpuError, Use};
use crate::render::{BoundFrame, Output, Redraw};
use crate::threads::Side;

impl Screen {
    /// Copies the picture and the reference if both are unchanged since the last frame and have not been measured. Returns
    /// whether another frame is needed.
    pub(super) fn measure_error(
        &mut self,
        state: &mut State,
        engine: &mut Engine,
        live: Option<&BoundFrame>,
    ) -> Result<bool, GpuError> {
        let wanted = state.compare.is_on() && !state.compare.is_held;
        let Some((reference, live)) = self.reference.as_ref().filter(|_| wanted).zip(live) else {
            self.error_map = ErrorMap { number: self.error_map.number, ..ErrorMap::default() };
            state.compare.measuring = None;
            return Ok(false);
        };
        let numbers = [reference.view.picture(), reference.still_number(), self.view.picture()];
        let states = [reference.frame.state.clone(), live.state.clone()];
        let same_size = states[0].size == states[1].size;
        let pair = Pair { numbers, states };
        let is = |other: &Option<Pair>| other.as_ref().is_some_and(|other| other.is_same(&pair));
        let (rests, is_known) = (is(&self.error_map.last), is(&self.error_map.measured));
        if !is_known {
            // The last measurement belongs to other pictures.
            (state.compare.difference, state.compare.measuring) = (None, None);
            self.error_map.copied = None;
        }
        if is_known || !same_size {
            self.error_map.last = Some(pair);
            return Ok(false);
        }
        if rests {
            self.copy_pictures(state, engine, live)?;
            self.error_map.number += 1;
            state.compare.measuring = self.error_map.copied.is_some().then_some(self.error_map.number);
            self.error_map.measured = Some(pair);
        } else {
            self.error_map.last = Some(pair);
        }
        Ok(true)
    }

    /// Draws both pictures as they are displayed, and copies them to CPU memory.
    fn copy_pictures(&mut self, state: &mut State, engine: &mut Engine, live: &BoundFrame) -> Result<(), GpuError> {
        let image = self.view.output_image(live.state.size)?;
        let mut encoder = self.frames.begin()?;
        self.check_loops(state, engine);
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

    /// Sends copies whose frame has finished to the thread that compares them.
    pub(super) fn take_copies(&mut self, engine: &mut Engine) {
        let is_finished = |copied: &mut Copied| self.frames.is_finished(copied.slot);
        if let Some(Copied { pictures, part, .. }) = self.error_map.copied.take_if(is_finished) {
            engine.threads.compare(self.error_map.number, pictures, part);
        }
    }
}
