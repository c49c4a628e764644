//! A volume on its way to a device that takes work from one thread only, one that has other things to do: small step by small step.

use super::facts::Facts;
use super::job::Progress;
use super::loading::{Arrived, Loading, Read, Skipping, Step, Turn, planned};
use crate::failure::Failure;
use anyhow::{Context as _, anyhow};
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::thread;
use std::time::Duration;
use wheatstone_core::reference::Caster;
use wheatstone_core::skip::SkipPlan;
use wheatstone_render::skip::{RangeSearch, SkipBuilder, SkipKernels};
use wheatstone_render::{Gpu, GpuVolume, Slab, VolumeUpload};

/// Slabs that wait to be written while the next one is converted.
const WAITING: usize = 1;

/// What there is of a volume.
pub(crate) struct Upload {
    facts: Facts,
    held: Option<Caster>,
    kernels: SkipKernels,
    plan: Option<SkipPlan>,
    stage: Stage,
}

/// What is on its way.
enum Stage {
    /// Voxels, out of a thread that makes texels of them.
    Texels(Box<VolumeUpload>, Receiver<Slab>),
    /// What the blocks of a volume hold.
    Blocks(GpuVolume, Box<RangeSearch>, SkipPlan),
    /// Room for skip maps.
    Maps(GpuVolume, Box<Skipping>),
}

impl Upload {
    /// Makes room on the device, and begins to convert.
    pub(super) fn begin(gpu: &Gpu, read: Read, turn: Turn, kernels: SkipKernels) -> Result<Self, Failure> {
        let Read { volume, facts, held } = read;
        let (format, plan) = planned(gpu, &volume);
        let upload = VolumeUpload::begin(gpu, &volume, format)?;
        let (sender, slabs) = sync_channel(WAITING);
        let convert = move || {
            let _turn = turn;
            let is_heard = |slab| sender.send(slab).is_ok();
            // An upload that was given up hears nothing any more.
            let _ = Slab::all_of(&volume, format).all(is_heard);
        };
        thread::Builder::new()
            .name("converting".to_owned())
            .spawn(convert)
            .context("cannot begin to convert")?;
        Ok(Self { facts, held, kernels, plan, stage: Stage::Texels(Box::new(upload), slabs) })
    }

    /// Writes some texels, looks through some blocks, or makes room for skip maps, if there is anything to go on with: of what can be
    /// divided no more than takes a time, as far as is known.
    pub(super) fn step(mut self: Box<Self>, gpu: &Gpu, time: Duration) -> Result<Step, Failure> {
        self.stage = match self.stage {
            Stage::Texels(mut upload, slabs) => {
                if upload.wants_slab() {
                    match slabs.try_recv() {
                        Ok(slab) => upload.take(slab),
                        Err(TryRecvError::Empty) => {}
                        Err(TryRecvError::Disconnected) => {
                            return Err(Failure::Internal(anyhow!("converting ended without a result")));
                        }
                    }
                }
                upload.step(gpu, time)?;
                match (upload.is_whole(), self.plan) {
                    (false, _) => Stage::Texels(upload, slabs),
                    (true, Some(plan)) => {
                        let volume = upload.finish();
                        let search = RangeSearch::of_values(gpu, &self.kernels, &volume, plan.block_size)?;
                        Stage::Blocks(volume, Box::new(search), plan)
                    }
                    (true, None) => {
                        let Self { facts, held, .. } = *self;
                        let volume = upload.finish();
                        return Ok(Step::Done(Box::new(Arrived { facts, volume, held, skipping: None })));
                    }
                }
            }
            Stage::Blocks(volume, mut search, plan) => {
                search.step(gpu, time)?;
                if search.is_whole() {
                    let builder = SkipBuilder::of_values(&self.kernels, &volume, search.finish());
                    Stage::Maps(volume, Box::new(Skipping { builder, plan }))
                } else {
                    Stage::Blocks(volume, search, plan)
                }
            }
            Stage::Maps(volume, mut skipping) => {
                skipping.builder.make_room(gpu, skipping.plan.structure)?;
                let Self { facts, held, .. } = *self;
                let skipping = Some(*skipping);
                return Ok(Step::Done(Box::new(Arrived { facts, volume, held, skipping })));
            }
        };
        Ok(Step::UnderWay(Loading::InSteps(self)))
    }

    /// How far it is.
    pub(super) fn progress(&self) -> Progress {
        let (what, (done, all)) = match &self.stage {
            Stage::Texels(upload, _) => ("uploading", upload.slices()),
            Stage::Blocks(_, search, _) => ("looking for empty space", search.rows()),
            Stage::Maps(..) => ("looking for empty space", (1, 1)),
        };
        Progress { what, done: Some(done as f32 / all as f32) }
    }
}
