//! Counts what a submission draws.

use ash::vk;
use serde::Serialize;

/// Draw counts of a submission, without the user interface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct DrawCounts {
    /// Draws.
    pub draws: u64,
    /// Triangles in them, all instances counted, before any stage that amplifies them.
    pub triangles: u64,
}

/// Counts while commands are recorded.
#[derive(Default)]
pub(in crate::gpu) struct Counter {
    pub(in crate::gpu) counts: DrawCounts,
    topology: Option<vk::PrimitiveTopology>,
}

impl Counter {
    /// Sets the topology of later indexed draws.
    pub(super) fn set_topology(&mut self, topology: vk::PrimitiveTopology) {
        self.topology = Some(topology);
    }

    /// Counts a non-indexed draw, which is always of triangles.
    pub(super) fn draw(&mut self, vertices: u32) {
        self.counts.draws += 1;
        self.counts.triangles += u64::from(vertices / 3);
    }

    /// Counts this many draws, which have `indices` together.
    pub(super) fn draw_run(&mut self, draws: u32, indices: u64, instances: u32) {
        use vk::PrimitiveTopology as T;
        let triangles = match self.topology.unwrap_or(T::TRIANGLE_LIST) {
            T::TRIANGLE_LIST | T::PATCH_LIST => indices / 3,
            T::TRIANGLE_STRIP | T::TRIANGLE_FAN => indices.saturating_sub(2 * u64::from(draws)),
            _ => 0,
        };
        self.counts.draws += u64::from(draws);
        self.counts.triangles += triangles * u64::from(instances);
    }

    /// Counts a draw with indices.
    pub(super) fn draw_indexed(&mut self, indices: u32, instances: u32) {
        self.draw_run(1, indices.into(), instances);
    }

    /// Counts a draw of a mesh pipeline.
    pub(super) fn draw_mesh(&mut self, triangles: u32, instances: u32) {
        self.counts.draws += 1;
        self.counts.triangles += u64::from(triangles) * u64::from(instances);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_instances_count_by_their_triangles() {
        let mut counter = Counter::default();
        counter.draw(3);
        counter.set_topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        counter.draw_indexed(30, 2);
        counter.set_topology(vk::PrimitiveTopology::TRIANGLE_STRIP);
        counter.draw_indexed(10, 1);
        counter.set_topology(vk::PrimitiveTopology::LINE_LIST);
        counter.draw_indexed(10, 1);
        assert_eq!(counter.counts, DrawCounts { draws: 4, triangles: 1 + 20 + 8 });
        counter.set_topology(vk::PrimitiveTopology::TRIANGLE_STRIP);
        counter.draw_run(3, 15, 2);
        assert_eq!(counter.counts, DrawCounts { draws: 7, triangles: 29 + 18 });
    }
}
