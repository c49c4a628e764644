//! Anchors that are cast, and views out of them.

use super::GpuSlabs;
use super::derive_pass::DerivePass;
use super::fill_pass::FillPass;
use crate::gpu::{Gpu, GpuError};
use crate::renderer::{Prepared, Renderer};
use crate::squares::Squares;
use crate::target::Target;
use wheatstone_core::lightfield::anchors::{AnchorPlan, SlabPicture};
use wheatstone_core::reference::Cast;
use wheatstone_core::scene::Mode;
use wheatstone_core::view::View;

/// Anchors on the device.
#[derive(Debug)]
pub struct CastAnchors {
    plan: AnchorPlan,
    targets: Vec<Target>,
    /// What is occupied.
    corners_world: [glam::DVec3; 8],
}

impl CastAnchors {
    /// Bytes that the anchors take beside their pictures.
    pub fn byte_size(&self) -> u64 {
        self.targets.iter().filter_map(|target| target.slabs.as_ref()).map(|slabs| slabs.cells.size()).sum()
    }

    /// What casting all of them has read: samples along rays, and reads of the skip map.
    ///
    /// # Errors
    /// No memory, a lost or hung device.
    pub fn reads(&self, gpu: &Gpu) -> Result<[u64; 2], GpuError> {
        let casts = self.targets.iter().map(|target| target.read(gpu)).collect::<Result<Vec<_>, _>>()?;
        Ok([casts.iter().map(|cast| cast.samples).sum(), casts.iter().map(|cast| cast.map_reads).sum()])
    }

    /// One of the views that they are for.
    ///
    /// # Panics
    /// If there is no such view.
    pub fn view(&self, index: usize) -> View {
        self.plan.derived[index].view
    }

    /// Reads back what the rays of an anchor pass, with what fills the hidden cells, and its picture.
    ///
    /// # Errors
    /// No memory, a lost or hung device.
    ///
    /// # Panics
    /// If there is no such anchor.
    pub fn read(&self, gpu: &Gpu, anchor: usize) -> Result<(Cast, SlabPicture), GpuError> {
        let target = &self.targets[anchor];
        let slabs = target.slabs.as_ref().map(|slabs| slabs.read(gpu)).transpose()?;
        Ok((target.read(gpu)?, slabs.unwrap_or_else(|| SlabPicture::clear(target.size(), 0))))
    }
}

impl Renderer {
    /// Casts the anchors of a plan and waits until all are done; `last` are those of a picture before, whose room is taken where it fits.
    ///
    /// # Errors
    /// A kernel that the driver refuses, no memory, a lost or hung device.
    ///
    /// # Panics
    /// If another mode than composites was prepared.
    pub fn cast_anchors(
        &mut self,
        gpu: &Gpu,
        prepared: &Prepared,
        plan: &AnchorPlan,
        last: Option<CastAnchors>,
    ) -> Result<CastAnchors, GpuError> {
        assert_eq!(prepared.parameters.mode, Mode::Composite, "only composites have anchors");
        let with_slabs = self.with_slabs(gpu, prepared)?;
        let mut rooms = last.map_or_else(Vec::new, |last| last.targets).into_iter();
        let mut targets = Vec::new();
        for anchor in &plan.anchors {
            let size = anchor.view.size;
            let mut room = rooms.next();
            let slabs = match room.as_mut().and_then(|target| target.slabs.take()) {
                Some(slabs) => slabs.cleared(gpu, size, &plan.slabs)?,
                None => GpuSlabs::new(gpu, size, &plan.slabs)?,
            };
            let mut target = match room.filter(|target| target.size() == size) {
                Some(target) => target,
                None => Target::new(gpu, size)?,
            };
            target.slabs = Some(slabs);
            self.cast(gpu, &with_slabs, &anchor.view, &mut target)?;
            targets.push(target);
        }
        self.fill(gpu, plan, &targets)?;
        let corners_world = prepared.occupied_corners_world();
        Ok(CastAnchors { plan: plan.clone(), targets, corners_world })
    }

    /// Fills what anchors do not see.
    fn fill(&mut self, gpu: &Gpu, plan: &AnchorPlan, targets: &[Target]) -> Result<(), GpuError> {
        let pass = match self.fill_pass.take() {
            Some(pass) => self.fill_pass.insert(pass),
            None => self.fill_pass.insert(FillPass::new(gpu)?),
        };
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for (index, target) in targets.iter().enumerate() {
            let neighbours: Vec<_> = plan
                .neighbours(index)
                .into_iter()
                .filter_map(|source| Some((source, targets[source.anchor].slabs.as_ref()?)))
                .collect();
            if let Some(slabs) = &target.slabs {
                pass.encode(gpu, &mut encoder, slabs, &neighbours);
            }
        }
        gpu.queue.submit([encoder.finish()]);
        gpu.wait()
    }

    /// Makes the picture of a view of anchors, without depths, and waits until it is done. An anchor's own view is its cast.
    ///
    /// # Errors
    /// A kernel that the driver refuses, no memory, a lost or hung device.
    ///
    /// # Panics
    /// If there is no such view, or the target has another size.
    pub fn derive(
        &mut self,
        gpu: &Gpu,
        anchors: &CastAnchors,
        view: usize,
        target: &mut Target,
    ) -> Result<(), GpuError> {
        let derived = &anchors.plan.derived[view];
        assert_eq!(target.size(), derived.view.size, "a target has the size of its view");
        let covered = Squares::covered(&derived.view, &anchors.corners_world);
        self.blank(gpu, target, &covered);
        if covered.is_empty() {
            return gpu.wait();
        }
        let pass = match self.derive_pass.take() {
            Some(pass) => self.derive_pass.insert(pass),
            None => self.derive_pass.insert(DerivePass::new(gpu)?),
        };
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        match anchors.plan.anchors.iter().position(|anchor| anchor.index == view) {
            Some(own) => {
                let origin = wgpu::Origin3d { x: anchors.plan.anchors[own].left_px, y: 0, z: 0 };
                let [width, height] = target.size();
                encoder.copy_texture_to_texture(
                    wgpu::TexelCopyTextureInfo { origin, ..anchors.targets[own].color.as_image_copy() },
                    target.color.as_image_copy(),
                    wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                );
            }
            None => {
                if let Some(slabs) = &anchors.targets[derived.source.anchor].slabs {
                    pass.encode(gpu, &mut encoder, target, &covered, (&derived.source, slabs));
                }
            }
        }
        gpu.queue.submit([encoder.finish()]);
        gpu.wait()
    }
}
