//! Lists of draws, in which those that share all state stand together. They are made when the scene changes, not for each frame.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::buffers::BufferPool;
use super::gpu_draw::GpuDraw;
use crate::frame::MaterialVariant;
use crate::gpu::{Buffer, DrawCommand, DrawRun};

/// Consecutive commands of draws that share pipeline, material, topology, facing and winding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    /// One of the draws.
    pub(crate) draw: u32,
    pub(crate) commands: DrawRun,
}

/// A command for each draw, whose base instance is the number of the draw.
pub(crate) struct Commands {
    pub(crate) list: Vec<DrawCommand>,
    /// The same for the device. `None` if the draws are recorded one by one.
    pub(crate) buffer: Option<Arc<Buffer>>,
}

/// Draws in the order of their commands.
pub(crate) struct DrawList {
    pub(crate) runs: Vec<Run>,
    list: Vec<DrawCommand>,
    buffers: Option<Arc<BufferPool>>,
    /// The commands for each number of instances that was asked for.
    commands: Mutex<Vec<(u32, Arc<Commands>)>>,
}

/// The lists of a scene. They depend on which draws a pose mirrors and hides, and on nothing else of it.
pub(crate) struct DrawLists {
    pub(super) mirrored: Vec<bool>,
    /// Whether each draw is left out; empty if none is.
    pub(super) hidden: Vec<bool>,
    /// For commands that the device reads.
    buffers: Option<Arc<BufferPool>>,
    grouped: OnceLock<DrawList>,
    ordered: OnceLock<DrawList>,
}

impl Run {
    /// Adds a draw to runs. `shares`: whether it shares all state with another.
    pub(super) fn add(runs: &mut Vec<Self>, draw: u32, indices: u32, first: u32, shares: impl Fn(u32) -> bool) {
        match runs.last_mut() {
            Some(last) if shares(last.draw) => {
                last.commands.count += 1;
                last.commands.indices += u64::from(indices);
            }
            _ => runs.push(Self { draw, commands: DrawRun { first, count: 1, indices: indices.into() } }),
        }
    }
}

impl DrawLists {
    pub(super) fn new(mirrored: Vec<bool>, hidden: Vec<bool>, buffers: Option<Arc<BufferPool>>) -> Self {
        Self { mirrored, hidden, buffers, grouped: OnceLock::new(), ordered: OnceLock::new() }
    }

    /// Whether two draws share all state.
    pub(super) fn share(&self, draws: &[GpuDraw], [a, b]: [u32; 2]) -> bool {
        let [a, b] = [a as usize, b as usize];
        self.mirrored[a] == self.mirrored[b] && draws[a].shares_state(&draws[b])
    }

    /// Whether a draw is left out.
    pub(super) fn hides(&self, draw: u32) -> bool {
        self.hidden.get(draw as usize) == Some(&true)
    }

    /// The draws in the order of the scene.
    pub(crate) fn ordered(&self, draws: &[GpuDraw]) -> &DrawList {
        self.ordered.get_or_init(|| DrawList::new(draws, self, 0..draws.len() as u32))
    }

    /// The draws, with all that share their state together; those that are drawn one by one in the order of the scene.
    pub(crate) fn grouped(&self, draws: &[GpuDraw]) -> &DrawList {
        if self.buffers.is_none() {
            return self.ordered(draws);
        }
        self.grouped.get_or_init(|| {
            // By the first draw with the same pipeline, then by the first with the same state.
            let mut variants: HashMap<MaterialVariant, usize> = HashMap::new();
            let mut states = HashMap::new();
            let group = |(number, draw): (usize, &GpuDraw)| {
                let variant = *variants.entry(draw.variant).or_insert(number);
                let topology = (draw.topology, draw.double_sided, self.mirrored[number]);
                let state = (draw.variant, Arc::as_ptr(&draw.material), topology);
                (variant, *states.entry(state).or_insert(number))
            };
            let groups: Vec<(usize, usize)> = draws.iter().enumerate().map(group).collect();
            let mut order: Vec<u32> = (0..draws.len() as u32).collect();
            order.sort_by_key(|number| groups[*number as usize]);
            DrawList::new(draws, self, order)
        })
    }
}

impl DrawList {
    fn new(draws: &[GpuDraw], lists: &DrawLists, order: impl IntoIterator<Item = u32>) -> Self {
        let (mut runs, mut list) = (Vec::new(), Vec::with_capacity(draws.len()));
        for number in order.into_iter().filter(|number| !lists.hides(*number)) {
            let draw = &draws[number as usize];
            let shares = |other: u32| lists.share(draws, [other, number]);
            Run::add(&mut runs, number, draw.index_count, list.len() as u32, shares);
            list.push(draw.command(number, 1));
        }
        Self { runs, list, buffers: lists.buffers.clone(), commands: Mutex::default() }
    }

    /// The commands of all draws, in the order of the runs.
    pub(super) fn of(&self, run: &Run) -> &[DrawCommand] {
        let DrawRun { first, count, .. } = run.commands;
        &self.list[first as usize..][..count as usize]
    }

    /// The commands for so many instances of each draw.
    pub(crate) fn commands(&self, instances: u32) -> Arc<Commands> {
        let mut known = self.commands.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, commands)) = known.iter().find(|(of, _)| *of == instances) {
            return commands.clone();
        }
        let list: Vec<DrawCommand> =
            self.list.iter().map(|draw| DrawCommand { instance_count: instances, ..*draw }).collect();
        // Without memory, the draws are recorded one by one.
        let buffer = self.buffers.as_ref().and_then(|buffers| buffers.filled(bytemuck::cast_slice(&list)).ok());
        let commands = Arc::new(Commands { list, buffer });
        known.push((instances, commands.clone()));
        commands
    }
}
