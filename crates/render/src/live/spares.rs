//! What is kept from picture to picture.

use crate::buffers::storage;
use crate::gpu::{Gpu, GpuError};
use crate::renderer::Prepared;
use crate::target::Target;
use crate::tile_pass::TileList;
use wgpu::BufferUsages;

/// Targets, tile lists and rays that are in no picture now: views in motion and at rest change between few sizes.
#[derive(Debug, Default)]
pub(super) struct Spares {
    /// The one given back last is the last.
    targets: Vec<Target>,
    lists: Vec<TileList>,
    states: Option<wgpu::Buffer>,
}

impl Spares {
    /// A target of a size, for what is cast with some settings.
    ///
    /// # Errors
    /// As [`Target::new`].
    pub(super) fn target(
        &mut self,
        gpu: &Gpu,
        prepared: &Prepared,
        size: [u32; 2],
    ) -> Result<Target, GpuError> {
        let is_like =
            |target: &Target| target.size() == size && target.layers.is_some() == prepared.keeps_layers();
        match self.targets.iter().position(is_like) {
            Some(at) => Ok(self.targets.remove(at)),
            None if prepared.keeps_layers() => Target::with_layers(gpu, size),
            None => Target::new(gpu, size),
        }
    }

    pub(super) fn list(&mut self) -> Option<TileList> {
        self.lists.pop()
    }

    /// Room for rays that are cast in parts.
    pub(super) fn states(&mut self, gpu: &Gpu, bytes: u64) -> wgpu::Buffer {
        let kept = self.states.take().filter(|states| states.size() >= bytes);
        let new = || storage(&gpu.device, "ray states", bytes, BufferUsages::empty());
        self.states.insert(kept.unwrap_or_else(new)).clone()
    }

    pub(super) fn give_back_target(&mut self, target: Target) {
        self.targets.push(target);
    }

    /// Lets go of the targets given back first until all have no more than a number of pixels together.
    pub(super) fn keep_within(&mut self, most_px: u64) {
        let mut px = 0;
        let mut is_within = |target: &Target| {
            px += target.size().map(u64::from).iter().product::<u64>();
            px <= most_px
        };
        let kept = self.targets.iter().rev().take_while(|target| is_within(target)).count();
        self.targets.drain(..self.targets.len() - kept);
    }

    pub(super) fn give_back_list(&mut self, list: TileList) {
        self.lists.push(list);
    }
}
