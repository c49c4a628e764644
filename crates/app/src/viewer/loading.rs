//! A volume on its way from a file to the device, in the background.

use super::facts::Facts;
use super::job::{Job, Progress, Waker};
use super::state::Look;
use crate::failure::Failure;
use crate::look::ModeName;
use crate::shipped;
use crate::volume_args::print_warnings;
use anyhow::Context as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use wheatstone_core::reference::Caster;
use wheatstone_core::skip::{Skip, SkipPlan, SkipRequest, Structure};
use wheatstone_core::volume::{StorageKind, Volume};
use wheatstone_io::{RawLayout, read_raw, read_volume};
use wheatstone_render::skip::{SkipBuilder, SkipKernels};
use wheatstone_render::{Gpu, GpuVolume, TexelFormat};

/// Which volume.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Source {
    /// The file; none is the volume that ships with the program.
    pub(crate) file: Option<PathBuf>,
    /// The layout of a raw file that does not tell it by its name.
    pub(crate) layout: Option<RawLayout>,
}

/// A volume in memory.
pub(crate) struct Read {
    volume: Volume,
    facts: Facts,
    held: Option<Caster>,
}

/// A volume on the device.
pub(crate) struct Arrived {
    pub(crate) facts: Facts,
    pub(crate) volume: GpuVolume,
    /// The voxels, for a headset.
    pub(crate) held: Option<Caster>,
    /// What skip maps are made with; none for a volume too small to skip any of.
    pub(crate) skipping: Option<Skipping>,
}

/// What tells casts of a volume what to leap over.
pub(crate) struct Skipping {
    pub(crate) builder: SkipBuilder,
    plan: SkipPlan,
}

impl Skipping {
    /// The skip map of settings that are being edited.
    pub(crate) fn while_edited(&self, look: &Look) -> Option<Structure> {
        leaps_by_map(look).then_some(self.plan.while_edited)
    }

    /// The skip map of settings that rest.
    pub(crate) fn at_rest(&self, look: &Look) -> Option<Structure> {
        leaps_by_map(look).then_some(self.plan.structure)
    }
}

/// Projections of extremes leap by the ranges of blocks.
fn leaps_by_map(look: &Look) -> bool {
    !matches!(look.mode, ModeName::Mip | ModeName::Minip)
}

/// Two jobs, one after the other: a file is read while the device is still being opened.
pub(crate) enum Loading {
    Reading(Job<Read>),
    Uploading(Job<Arrived>),
}

/// What a volume is loaded for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Destination {
    /// A window: the upload has a thread of its own.
    Window,
    /// A headset, the device of which takes work from one thread only: the one that goes on with the load uploads. Voxels are held on
    /// the host as well, for what hands point at.
    Headset,
}

/// How a load goes on.
pub(crate) enum Step {
    UnderWay(Loading),
    Done(Box<Arrived>),
}

impl Loading {
    /// Begins to read.
    pub(crate) fn begin(source: Source, wake: Waker, destination: Destination) -> Result<Self, Failure> {
        let job = Job::begin("reading", wake, move |teller| {
            let volume = read(&source)?;
            teller.tell("measuring", None);
            let facts = Facts::of(&volume, source.file.as_deref());
            let held = (destination == Destination::Headset).then(|| Caster::new(&volume));
            Ok(Read { volume, facts, held })
        });
        Ok(Self::Reading(job.context("cannot begin to read")?))
    }

    /// How far it is.
    pub(crate) fn progress(&self) -> Progress {
        match self {
            Self::Reading(job) => job.progress(),
            Self::Uploading(job) => job.progress(),
        }
    }

    /// Goes on as far as it can without waiting, but for an upload in turn.
    pub(crate) fn step(
        self,
        gpu: &Arc<Gpu>,
        wake: &Waker,
        destination: Destination,
    ) -> Result<Step, Failure> {
        Ok(match self {
            Self::Reading(mut job) => match (job.poll(), destination) {
                (None, _) => Step::UnderWay(Self::Reading(job)),
                (Some(read), Destination::Window) => Step::UnderWay(Self::upload(read?, gpu, wake)?),
                (Some(read), Destination::Headset) => Step::Done(Box::new(upload(gpu, read?, &|_| ())?)),
            },
            Self::Uploading(mut job) => match job.poll() {
                Some(arrived) => Step::Done(Box::new(arrived?)),
                None => Step::UnderWay(Self::Uploading(job)),
            },
        })
    }

    fn upload(read: Read, gpu: &Arc<Gpu>, wake: &Waker) -> Result<Self, Failure> {
        let gpu = Arc::clone(gpu);
        let job = Job::begin("uploading", Arc::clone(wake), move |teller| {
            upload(&gpu, read, &|done| teller.tell("uploading", Some(done)))
        });
        Ok(Self::Uploading(job.context("cannot begin to upload")?))
    }
}

fn read(source: &Source) -> Result<Volume, Failure> {
    let loaded = match (&source.file, &source.layout) {
        (None, _) => shipped::brain()?,
        (Some(file), Some(layout)) => read_raw(file, layout)?,
        (Some(file), None) => read_volume(file)?,
    };
    print_warnings(source.file.as_deref().unwrap_or(Path::new(shipped::BRAIN_PATH)), &loaded);
    Ok(loaded.volume)
}

fn upload(gpu: &Gpu, read: Read, tell: &dyn Fn(f32)) -> Result<Arrived, Failure> {
    let Read { volume, facts, held } = read;
    let storage = StorageKind::lossless_for(&volume);
    let format = TexelFormat::for_volume(&volume, storage, gpu);
    let on_device =
        GpuVolume::upload_as(gpu, &volume, format, &mut |done, all| tell(done as f32 / all as f32))?;
    let request = SkipRequest { skip: Skip::Auto, block_size: None };
    let plan = request.plan(on_device.dims(), storage, gpu.capabilities().skip_host());
    let skipping = match plan {
        Some(plan) => {
            let kernels = SkipKernels::new(gpu)?;
            Some(Skipping { builder: SkipBuilder::new(gpu, &kernels, &on_device, plan.block_size)?, plan })
        }
        None => None,
    };
    Ok(Arrived { facts, volume: on_device, held, skipping })
}
