//! The vertices that joints and morph targets have moved: runs `deform.comp` of the shader tree once for each pose.

use std::sync::Arc;

use crate::frame::stages::DEFORM;
use crate::gpu::{Buffer, ComputePipeline, DescriptorSet, Encoder, Gpu, GpuError, Memory, SetLayouts, SetWriter, vk};
use crate::interface::{BINDING_DEFORMATIONS, BINDING_PARAMS, Deformation, SET_TASK};
use crate::render::bound_frame::BoundFrame;
use crate::render::compute::write_addressed;
use crate::render::scene::Deformables;
use crate::scene::Pose;

/// Workgroups that every device can start along an axis.
const MOST_GROUPS: u32 = 65_535;

/// The moved vertices of a view.
pub(super) struct MovedVertices {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    slots: Vec<Slot>,
    /// The vertices of the last pose.
    last: Option<(Source, Arc<Buffer>)>,
    /// Those of the pose before it.
    before: Option<Arc<Buffer>>,
}

/// The inputs of a dispatch in one frame slot.
#[derive(Clone, Default)]
struct Slot {
    /// Joints and weights of the pose.
    pose: Option<Arc<Buffer>>,
    /// The instances, and the set that points to them.
    records: Option<(Arc<Buffer>, Arc<DescriptorSet>)>,
}

/// Everything that moved vertices depend on.
struct Source {
    deformables: Arc<Deformables>,
    pose: Arc<Pose>,
    pipeline: Arc<ComputePipeline>,
    /// The author's parameters, if the stage reads them.
    params: Vec<u8>,
}

impl Source {
    /// `None` if no vertices move.
    fn new(frame: &BoundFrame) -> Option<Self> {
        let pose = frame.state.scene.as_ref()?.pose();
        let deformables = frame.scene.as_ref()?.deformables.as_ref().filter(|deformables| deformables.fits(pose))?;
        let pipeline = frame.pipelines.compute(DEFORM)?;
        let reads_params = pipeline.usage.frame_bindings.contains(&BINDING_PARAMS);
        let params = if reads_params { frame.state.params().to_vec() } else { Vec::new() };
        Some(Self { deformables: deformables.clone(), pose: pose.clone(), pipeline: pipeline.clone(), params })
    }

    fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.deformables, &other.deformables)
            && (Arc::ptr_eq(&self.pose, &other.pose)
                || (&self.pose.joints, &self.pose.weights) == (&other.pose.joints, &other.pose.weights))
            && Arc::ptr_eq(&self.pipeline, &other.pipeline)
            && self.params == other.params
    }
}

impl MovedVertices {
    pub(super) fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, slots: usize) -> Self {
        let slots = vec![Slot::default(); slots];
        Self { gpu: gpu.clone(), layouts: layouts.clone(), slots, last: None, before: None }
    }

    /// The moved vertices of the frame's pose; `None` if none move. Records the dispatch that moves them, unless nothing has changed
    /// since the last frame. SYNC: after the slot's fence.
    pub(super) fn of(
        &mut self,
        encoder: &mut Encoder,
        slot: usize,
        frame: &BoundFrame,
        frame_set: &Arc<DescriptorSet>,
    ) -> Result<Option<Arc<Buffer>>, GpuError> {
        let Some(source) = Source::new(frame) else {
            self.forget();
            return Ok(None);
        };
        let last = match self.last.take() {
            Some((last, vertices)) if last.is_same(&source) => {
                self.last = Some((last, vertices.clone()));
                return Ok(Some(vertices));
            }
            Some((last, vertices)) if Arc::ptr_eq(&last.deformables, &source.deformables) => Some(vertices),
            _ => {
                self.before = None;
                None
            }
        };
        let vertices = match self.before.take() {
            Some(vertices) => vertices,
            None => {
                let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
                Buffer::new(&self.gpu, "moved vertices", source.deformables.bytes(), usage, Memory::Device)?
            }
        };
        self.before = last;
        let task = self.task(slot, &source, &vertices)?;
        let group = frame.state.shaders.stages.get(DEFORM).map_or(1, |stage| stage.reflection.local_size[0].max(1));
        let (instances, most_vertices) = source.deformables.size();
        let along_y = instances.min(MOST_GROUPS);
        let groups = [most_vertices.div_ceil(group), along_y, instances.div_ceil(along_y)];
        encoder.keep(&vertices);
        encoder.pass("deform", |encoder| {
            encoder.buffers_done();
            encoder.dispatch(&source.pipeline, &[frame_set, &task], groups);
            encoder.buffers_done();
        });
        self.last = Some((source, vertices.clone()));
        Ok(Some(vertices))
    }

    /// Writes the inputs of a dispatch. Returns the set that points to them.
    fn task(&mut self, slot: usize, source: &Source, vertices: &Arc<Buffer>) -> Result<Arc<DescriptorSet>, GpuError> {
        let Slot { pose, records } = &mut self.slots[slot];
        let joints: &[u8] = bytemuck::cast_slice(&source.pose.joints);
        let bytes = [joints, bytemuck::cast_slice(&source.pose.weights)].concat();
        let pose = write_addressed(&self.gpu, "pose", pose, &bytes)?;
        let at = pose.address();
        let content = source.deformables.records([vertices.address(), at, at + joints.len() as u64]);
        let bytes: &[u8] = bytemuck::cast_slice::<Deformation, u8>(&content);
        // The length of the array in the stage is that of the buffer.
        let (buffer, set) = match records.take().filter(|(buffer, _)| buffer.size() == bytes.len() as u64) {
            Some(fits) => fits,
            None => {
                let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
                let buffer = Buffer::new(&self.gpu, "moved instances", bytes.len() as u64, usage, Memory::Upload)?;
                let writer = SetWriter::default().named("moved instances").buffer(BINDING_DEFORMATIONS, &buffer);
                let set = DescriptorSet::new(&self.layouts, SET_TASK, writer)?;
                (buffer, set)
            }
        };
        buffer.write(0, bytes);
        *records = Some((buffer, set.clone()));
        Ok(set)
    }

    /// Makes the next frame move all vertices again.
    pub(super) fn forget(&mut self) {
        (self.last, self.before) = (None, None);
    }
}
