//! The draws of the picture: those that the camera sees, in the order that blending and depth require.
//!
//! In a scene of few draws, opaque ones are sorted front to back one by one. In a scene of many, those that share all state
//! stay together, so that one command draws them, and are sorted front to back among themselves, roughly. Blended and
//! transmissive ones are always sorted exactly.

use std::sync::{Arc, PoisonError};

use glam::Vec3;

use super::GpuScene;
use super::draw_list::Run;
use super::frustum::Frustum;
use super::placed::PlacedScene;
use super::scratch::Scratch;
use crate::frame::MaterialVariant;
use crate::gpu::{Buffer, DrawCommand, DrawRun};

/// When the draws of a material are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Layer {
    /// Opaque and masked, front to back, so that the depth test rejects hidden fragments.
    Opaque,
    /// Transmissive, back to front.
    Transmissive,
    /// Alpha-blended, back to front.
    Blended,
}

/// Draws in the order that blending and depth require.
#[derive(Default)]
pub(crate) struct SortedDraws {
    pub(crate) commands: Vec<DrawCommand>,
    /// The commands for the device, if it reads them.
    pub(crate) buffer: Option<Arc<Buffer>>,
    pub(crate) opaque: Vec<Run>,
    pub(crate) transmissive: Vec<Run>,
    pub(crate) blended: Vec<Run>,
}

/// Steps of the distance from the eye by which the draws of a run are sorted.
const DEPTHS: usize = 255;
const BEYOND: u8 = 255;

impl GpuScene {
    /// Lets the next frame use the memory of sorted draws.
    pub(crate) fn take_back(&self, sorted: SortedDraws) {
        self.scratch.lock().unwrap_or_else(PoisonError::into_inner).commands = sorted.commands;
    }
}

impl PlacedScene {
    /// The draws that may be in the frustum, seen from `eye`, each with so many instances. Without a frustum these are all.
    pub(crate) fn sorted(
        &self,
        eye: Vec3,
        frustum: Option<&Frustum>,
        instances: u32,
        layer: impl Fn(MaterialVariant) -> Layer,
    ) -> SortedDraws {
        let mut scratch = std::mem::take(&mut *self.scene.scratch.lock().unwrap_or_else(PoisonError::into_inner));
        let spheres = self.spheres();
        scratch.distances.clear();
        let coordinates = spheres.x.iter().zip(&spheres.y).zip(&spheres.z);
        scratch.distances.extend(coordinates.map(|((x, y), z)| {
            let (x, y, z) = (x - eye.x, y - eye.y, z - eye.z);
            x * x + y * y + z * z
        }));
        match frustum {
            Some(frustum) => spheres.beyond(frustum, &mut scratch.beyond),
            None => {
                scratch.beyond.clear();
                scratch.beyond.resize(scratch.distances.len(), false);
            }
        }
        scratch.beyond.iter_mut().zip(&self.lists().hidden).for_each(|(beyond, is_hidden)| *beyond |= is_hidden);
        let commands = std::mem::take(&mut scratch.commands);
        let mut sorted = SortedDraws { commands, ..SortedDraws::default() };
        sorted.commands.clear();
        match self.scene.buffers.is_some() {
            true => self.sort_runs(&mut scratch, layer, &mut sorted),
            false => self.sort_draws(&scratch, layer, &mut sorted),
        }
        if instances != 1 {
            sorted.commands.iter_mut().for_each(|draw| draw.instance_count = instances);
        }
        // Without memory, the draws are recorded one by one.
        let content = bytemuck::cast_slice(&sorted.commands);
        sorted.buffer = self.scene.buffers.as_ref().and_then(|buffers| buffers.filled(content).ok());
        *self.scene.scratch.lock().unwrap_or_else(PoisonError::into_inner) = scratch;
        sorted
    }

    /// Sorts all draws one by one.
    fn sort_draws(&self, scratch: &Scratch, layer: impl Fn(MaterialVariant) -> Layer, sorted: &mut SortedDraws) {
        let distances = &scratch.distances;
        let mut order = self.order();
        order.sort_by(|a, b| distances[*a as usize].total_cmp(&distances[*b as usize]).then(a.cmp(b)));
        let (mut transmissive, mut blended) = (Vec::new(), Vec::new());
        for number in order.iter().copied().filter(|number| !scratch.beyond[*number as usize]) {
            match layer(self.scene.draws[number as usize].variant) {
                Layer::Opaque => self.add(number, &mut sorted.commands, &mut sorted.opaque),
                Layer::Transmissive => transmissive.push(number),
                Layer::Blended => blended.push(number),
            }
        }
        transmissive.iter().rev().for_each(|number| self.add(*number, &mut sorted.commands, &mut sorted.transmissive));
        blended.iter().rev().for_each(|number| self.add(*number, &mut sorted.commands, &mut sorted.blended));
    }

    fn add(&self, number: u32, commands: &mut Vec<DrawCommand>, runs: &mut Vec<Run>) {
        let draw = &self.scene.draws[number as usize];
        let shares = |other: u32| self.lists().share(&self.scene.draws, [other, number]);
        Run::add(runs, number, draw.index_count, commands.len() as u32, shares);
        commands.push(draw.command(number, 1));
    }

    /// Sorts the opaque draws within each run, and the others one by one.
    fn sort_runs(&self, scratch: &mut Scratch, layer: impl Fn(MaterialVariant) -> Layer, sorted: &mut SortedDraws) {
        let list = self.lists().grouped(&self.scene.draws);
        set_depths(scratch);
        let (mut transmissive, mut blended) = (Vec::new(), Vec::new());
        for run in &list.runs {
            let single = match layer(self.scene.draws[run.draw as usize].variant) {
                Layer::Opaque => {
                    let first = sorted.commands.len() as u32;
                    let indices = add_run(list.of(run), &scratch.depths, &mut sorted.commands);
                    let count = sorted.commands.len() as u32 - first;
                    if count > 0 {
                        sorted.opaque.push(Run { draw: run.draw, commands: DrawRun { first, count, indices } });
                    }
                    continue;
                }
                Layer::Transmissive => &mut transmissive,
                Layer::Blended => &mut blended,
            };
            let seen = list.of(run).iter().map(|draw| draw.first_instance);
            single.extend(seen.filter(|number| !scratch.beyond[*number as usize]));
        }
        for (numbers, runs) in [(transmissive, &mut sorted.transmissive), (blended, &mut sorted.blended)] {
            for number in back_to_front(numbers, &scratch.distances) {
                self.add(number, &mut sorted.commands, runs);
            }
        }
    }
}

/// Writes the depth of each draw that the camera sees.
fn set_depths(Scratch { distances, beyond, depths, .. }: &mut Scratch) {
    depths.clear();
    // An infinite or undefined distance is the farthest.
    let farthest = distances.iter().filter(|d| d.is_finite()).fold(f32::MIN_POSITIVE, |a, b| a.max(*b)).sqrt();
    let step = (DEPTHS - 1) as f32 / farthest;
    let depth = |(distance, beyond): (&f32, &bool)| {
        // Conversion saturates, and makes 0 of NaN.
        let depth = ((distance.sqrt() * step) as u8).min(DEPTHS as u8 - 1);
        if *beyond { BEYOND } else { depth }
    };
    depths.extend(distances.iter().zip(&*beyond).map(depth));
}

/// Appends the commands of a run that the camera sees, front to back. Returns the number of their indices.
fn add_run(run: &[DrawCommand], depths: &[u8], out: &mut Vec<DrawCommand>) -> u64 {
    let depth_of = |draw: &DrawCommand| depths[draw.first_instance as usize];
    let first = out.len();
    if run.len() < DEPTHS {
        out.extend(run.iter().filter(|draw| depth_of(draw) != BEYOND));
        out[first..].sort_by_key(depth_of);
    } else {
        let mut places = [0_usize; DEPTHS + 1];
        run.iter().for_each(|draw| places[usize::from(depth_of(draw))] += 1);
        let seen: usize = places[..DEPTHS].iter().sum();
        let mut next = first;
        places.iter_mut().for_each(|place| next += std::mem::replace(place, next));
        out.resize(first + seen, DrawCommand::default());
        for draw in run {
            let depth = depth_of(draw);
            if depth != BEYOND {
                let place = &mut places[usize::from(depth)];
                out[*place] = *draw;
                *place += 1;
            }
        }
    }
    out[first..].iter().map(|draw| u64::from(draw.index_count)).sum()
}

/// Sorts draws by their distances, the farthest first, in time that grows as their number. Of draws at equal distances, the last of the
/// scene comes first.
fn back_to_front(mut numbers: Vec<u32>, distances: &[f32]) -> impl Iterator<Item = u32> {
    const BITS: u32 = 11;
    numbers.sort_unstable();
    // The bits of positive numbers have their order.
    let mut keyed: Vec<(u32, u32)> = numbers.iter().map(|n| (distances[*n as usize].to_bits(), *n)).collect();
    let mut next = vec![(0, 0); keyed.len()];
    for shift in [0, BITS, 2 * BITS] {
        let digit = |key: u32| (key >> shift) as usize & ((1 << BITS) - 1);
        let mut places = vec![0_usize; 1 << BITS];
        keyed.iter().for_each(|(key, _)| places[digit(*key)] += 1);
        let mut place = 0;
        places.iter_mut().for_each(|count| place += std::mem::replace(count, place));
        for entry in &keyed {
            let place = &mut places[digit(entry.0)];
            next[*place] = *entry;
            *place += 1;
        }
        std::mem::swap(&mut keyed, &mut next);
    }
    keyed.into_iter().rev().map(|(_, number)| number)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draw(number: u32) -> DrawCommand {
        DrawCommand { index_count: 3, first_instance: number, ..DrawCommand::default() }
    }

    #[test]
    fn blended_draws_come_back_to_front() {
        let distances = [3.0, 1.0, 1e9, 3.0, 0.0, 1e-20];
        let order: Vec<u32> = back_to_front(vec![4, 3, 2, 1, 0, 5], &distances).collect();
        assert_eq!(order, [2, 3, 0, 1, 5, 4]);
        assert_eq!(back_to_front(Vec::new(), &distances).count(), 0);
    }

    #[test]
    fn long_and_short_runs_are_sorted_alike() {
        for count in [5, 1000_u32] {
            let (distances, beyond) = ((0..count).rev().map(|d| (d * d) as f32), (0..count).map(|n| n % 5 == 0));
            let mut scratch =
                Scratch { distances: distances.collect(), beyond: beyond.collect(), ..Scratch::default() };
            set_depths(&mut scratch);
            let run: Vec<DrawCommand> = (0..count).map(draw).collect();
            let mut out = vec![draw(7)];
            let indices = add_run(&run, &scratch.depths, &mut out);
            let seen = count as usize / 5 * 4;
            assert_eq!((out.len(), indices), (1 + seen, 3 * seen as u64));
            let numbers = out[1..].iter().map(|draw| draw.first_instance);
            assert!(numbers.clone().all(|number| number % 5 != 0));
            let depths: Vec<u8> = numbers.map(|number| scratch.depths[number as usize]).collect();
            assert!(depths.is_sorted(), "{depths:?}");
        }
    }
}
