//! One pair of pictures.

use super::{Form, PairError, PairMethod, Quality, Repairs, Splat};
use crate::gpu::{Gpu, GpuError};
use crate::groups::Bindings;
use crate::pacer::{ITERATION_LIMIT, LOCKSTEP_RAYS, spreading_stride};
use crate::renderer::{Prepared, Renderer};
use crate::squares::Squares;
use crate::target::Target;
use crate::uniforms::{PairUniform, ViewUniform};
use std::ops::Range;
use std::time::{Duration, Instant};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::scene::Mode;
use wheatstone_core::stereo::{Epipolar, SlabRange, Slabs};

/// What a pair has taken. What is sent off together is told apart by when the host learns of its ends, which may be late.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PairReport {
    /// Bytes that this pair needs on the device besides both pictures.
    pub bytes: u64,
    /// Time of emptying what the last pair has left.
    pub clear: Duration,
    /// Time of casting.
    pub cast: Duration,
    /// Time of making the derived picture of what the cast has left.
    pub composite: Duration,
    /// Time of casting what is not derived.
    pub repair: Duration,
}

/// What the forms need of a pair.
pub(crate) struct PairFrame<'a> {
    pub(crate) gpu: &'a Gpu,
    pub(crate) prepared: &'a Prepared,
    pub(crate) epipolar: &'a Epipolar,
    /// Slabs of depth whose segments go to the same columns.
    planes: Slabs,
    /// Slabs that segments are put into.
    pub(crate) slabs: SlabRange,
    /// Sweep columns of the rays that meet the volume and that either picture needs.
    pub(crate) columns: Range<i32>,
    /// Squares of pixels that the volume covers, in the reference picture and in the derived one.
    covered: [Squares; 2],
    targets: [wgpu::BindGroup; 2],
    /// What is found out about the derived picture's tiles, if any are to be repaired.
    pub(crate) repairs: Option<Repairs>,
}

/// Which picture of a pair.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Eye {
    Reference,
    Derived,
}

impl Renderer {
    /// Casts the reference view of a pair and derives the other from its rays (SP), into a target for each, and waits until
    /// both are done.
    ///
    /// # Errors
    /// What keeps the one view from being derived from the other; no memory, a lost or hung device.
    ///
    /// # Panics
    /// If a target has another size than the views.
    pub fn render_pair(
        &mut self,
        gpu: &Gpu,
        prepared: &Prepared,
        epipolar: &Epipolar,
        method: PairMethod,
        mut targets: [&mut Target; 2],
    ) -> Result<PairReport, PairError> {
        let size = epipolar.reference().size;
        assert!(targets.iter().all(|target| target.size() == size), "targets have the size of their views");
        if !matches!(prepared.parameters.mode, Mode::Composite | Mode::XRay) {
            return Err(PairError::Mode);
        }
        if method.quality == Quality::Repaired && method.form != Form::Strips {
            return Err(PairError::Unrepaired);
        }
        if method.form == Form::Volumetric && method.quality != Quality::Fast {
            return Err(PairError::Warped);
        }
        let repairs = (method.quality == Quality::Repaired).then(|| self.repairs(gpu, size));
        let frame = self.pair_frame(gpu, prepared, epipolar, repairs, method.quality, &mut targets);
        let Some(frame) = frame else { return Ok(PairReport::default()) };
        let repairs = frame.repairs.as_ref();
        let repair = repairs.map(|repairs| self.ready_repair(&frame, repairs, targets[1])).transpose()?;
        match method.form {
            Form::Strips => self.strips(gpu, method.quality).render(&frame, repair.as_ref()),
            Form::Tiles => self.tiles(gpu, method.quality).render(&frame),
            Form::Layers(format) => self.layers(gpu, format, method.quality).render(&frame),
            Form::Volumetric => self.render_novel_view(&frame, &mut targets),
        }
    }

    /// Empties both pictures and returns what the forms need; nothing if no ray meets the volume.
    fn pair_frame<'a>(
        &mut self,
        gpu: &'a Gpu,
        prepared: &'a Prepared,
        epipolar: &'a Epipolar,
        repairs: Option<Repairs>,
        quality: Quality,
        targets: &mut [&mut Target; 2],
    ) -> Option<PairFrame<'a>> {
        let parameters = &prepared.parameters;
        let size = epipolar.reference().size;
        let corners = parameters.visible_corners_world();
        // Rows correspond: nothing is derived where no ray of the reference eye is.
        let [reference, derived] =
            [epipolar.reference(), epipolar.derived()].map(|view| Squares::covered(view, &corners));
        let covered = [reference.clone(), Squares { bands: reference.bands, ..derived }];
        for (target, covered) in targets.iter_mut().zip(&covered) {
            self.blank(gpu, target, covered);
        }
        let depths_m = epipolar.depths_m(&corners)?;
        let splat = Splat::of(quality).in_mode(parameters.mode);
        let planes = splat.slabs(epipolar);
        let slabs = splat.reached(planes.between(depths_m.start, depths_m.end));
        let columns = epipolar.columns_of(&corners, &slabs.cast_columns(size[0]));
        if columns.is_empty() {
            return None;
        }
        let tiles = repairs.as_ref().map_or(&self.unused[1], |repairs| &repairs.tiles);
        let targets =
            targets.each_ref().map(|target| self.target_group(gpu, target, [&self.unused[0], tiles]));
        Some(PairFrame { gpu, prepared, epipolar, slabs, planes, columns, covered, targets, repairs })
    }
}

impl PairFrame<'_> {
    pub(crate) fn parameters(&self) -> &CastParameters {
        &self.prepared.parameters
    }

    /// Width and height of both pictures, pixels.
    pub(crate) fn size(&self) -> [u32; 2] {
        self.epipolar.reference().size
    }

    /// The pair in strips of so many columns.
    pub(crate) fn uniform(&self, width: u32) -> PairUniform {
        PairUniform::new(self.epipolar, &self.planes, self.slabs, &self.columns, width)
    }

    /// Checks that a driver takes the rays each in one dispatch.
    ///
    /// # Errors
    /// [`PairError::LongRays`] if not.
    pub(crate) fn check_whole_rays(&self) -> Result<(), PairError> {
        let samples = self.parameters().most_samples_per_ray();
        let iterations = samples
            .saturating_mul(self.prepared.iterations_per_sample)
            .saturating_add(LOCKSTEP_RAYS.saturating_mul(self.slabs.layers()));
        if iterations > ITERATION_LIMIT { Err(PairError::LongRays { samples }) } else { Ok(()) }
    }

    /// Squares of `BAND_ROWS` pixels, along x and y, that the volume covers in a picture.
    pub(crate) fn squares(&self, eye: Eye) -> [u32; 2] {
        self.covered[eye as usize].counts()
    }

    /// Makes a picture the one that the next dispatches are about, in the squares that the volume covers. Rays are those of
    /// the reference eye for either.
    pub(crate) fn bind(&self, eye: Eye, pair: &PairUniform) -> Bindings<'_> {
        let covered = &self.covered[eye as usize];
        let is_software = self.gpu.description().is_software;
        let piece = ViewUniform {
            band_stride: if is_software { spreading_stride(covered.bands.len() as u32) } else { 1 },
            pair: *pair,
            ..ViewUniform::of_squares(self.parameters(), self.epipolar.reference(), covered)
        };
        self.gpu.queue.write_buffer(&self.prepared.view_uniform, 0, bytemuck::bytes_of(&piece));
        Bindings {
            frame: &self.prepared.frame,
            volume: &self.prepared.volume,
            target: &self.targets[eye as usize],
        }
    }

    /// Encodes commands and sends them off.
    pub(crate) fn send(&self, encode: impl FnOnce(&mut wgpu::CommandEncoder)) -> wgpu::SubmissionIndex {
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encode(&mut encoder);
        self.gpu.queue.submit([encoder.finish()])
    }

    /// Encodes commands, sends them off, waits until they are done and returns the time that they took.
    pub(crate) fn run(&self, encode: impl FnOnce(&mut wgpu::CommandEncoder)) -> Result<Duration, GpuError> {
        let start = Instant::now();
        let sent = self.send(encode);
        self.gpu.wait_for(sent)?;
        Ok(start.elapsed())
    }
}
