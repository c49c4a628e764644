//! A volume on its way from a file to the device, in the background.

use super::facts::Facts;
use super::job::{Job, Progress, Waker};
use super::state::Look;
use super::upload::Upload;
use crate::failure::Failure;
use crate::look::ModeName;
use crate::shipped;
use crate::volume_args::print_warnings;
use anyhow::Context as _;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use std::time::Duration;
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
    pub(super) volume: Volume,
    pub(super) facts: Facts,
    pub(super) held: Option<Caster>,
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
    pub(super) plan: SkipPlan,
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

/// What a volume is loaded for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Destination {
    /// A window: the upload has a thread of its own.
    Window,
    /// A headset, the device of which takes work from one thread only: the one that goes on with the load uploads, in small steps. Voxels
    /// are held on the host as well, for what hands point at.
    Headset,
}

/// What all loads of a session have in common.
pub(crate) struct Loader {
    wake: Waker,
    destination: Destination,
    /// They do not depend on the volume: the first makes them.
    kernels: Arc<OnceLock<SkipKernels>>,
}

/// A file is read first, while the device may still be being opened.
pub(crate) enum Loading {
    Reading(Job<Read>),
    Uploading(Job<Arrived>),
    InSteps(Box<Upload>),
}

/// How a load goes on.
pub(crate) enum Step {
    UnderWay(Loading),
    Done(Box<Arrived>),
}

impl Loader {
    pub(crate) fn new(wake: Waker, destination: Destination) -> Self {
        Self { wake, destination, kernels: Arc::default() }
    }

    /// Begins to read.
    pub(crate) fn begin(&self, source: Source) -> Result<Loading, Failure> {
        let destination = self.destination;
        let job = Job::begin("reading", Arc::clone(&self.wake), move |teller| {
            let volume = read(&source)?;
            teller.tell("measuring", None);
            let facts = Facts::of(&volume, source.file.as_deref());
            let held = (destination == Destination::Headset).then(|| Caster::new(&volume));
            Ok(Read { volume, facts, held })
        });
        Ok(Loading::Reading(job.context("cannot begin to read")?))
    }

    /// Goes on as far as it can without waiting, or by a step of an upload that takes no longer than a time, as far as is known.
    pub(crate) fn step(&self, loading: Loading, gpu: &Arc<Gpu>, time: Duration) -> Result<Step, Failure> {
        Ok(match loading {
            Loading::Reading(mut job) => Step::UnderWay(match (job.poll(), self.destination) {
                (None, _) => Loading::Reading(job),
                (Some(read), Destination::Window) => Loading::Uploading(self.upload(read?, gpu)?),
                (Some(read), Destination::Headset) => {
                    Loading::InSteps(Box::new(Upload::begin(gpu, read?, kept(&self.kernels, gpu)?)?))
                }
            }),
            Loading::Uploading(mut job) => match job.poll() {
                Some(arrived) => Step::Done(Box::new(arrived?)),
                None => Step::UnderWay(Loading::Uploading(job)),
            },
            Loading::InSteps(upload) => upload.step(gpu, time)?,
        })
    }

    /// Uploads a volume that is in memory, in one go.
    pub(crate) fn upload_at_once(&self, volume: Volume, gpu: &Gpu) -> Result<Arrived, Failure> {
        let facts = Facts::of(&volume, None);
        upload(gpu, Read { volume, facts, held: None }, &self.kernels, &|_| ())
    }

    fn upload(&self, read: Read, gpu: &Arc<Gpu>) -> Result<Job<Arrived>, Failure> {
        let (gpu, kernels) = (Arc::clone(gpu), Arc::clone(&self.kernels));
        let job = Job::begin("uploading", Arc::clone(&self.wake), move |teller| {
            upload(&gpu, read, &kernels, &|done| teller.tell("uploading", Some(done)))
        });
        Ok(job.context("cannot begin to upload")?)
    }
}

impl Loading {
    /// How far it is.
    pub(crate) fn progress(&self) -> Progress {
        match self {
            Self::Reading(job) => job.progress(),
            Self::Uploading(job) => job.progress(),
            Self::InSteps(upload) => upload.progress(),
        }
    }
}

/// The kernels of a device, made if they are not there yet.
fn kept(kernels: &OnceLock<SkipKernels>, gpu: &Gpu) -> Result<SkipKernels, Failure> {
    if let Some(kept) = kernels.get() {
        return Ok(kept.clone());
    }
    let made = SkipKernels::new(gpu)?;
    Ok(kernels.get_or_init(|| made).clone())
}

/// How a volume is held on a device, and cut into blocks if it is large enough to skip any.
pub(super) fn planned(gpu: &Gpu, volume: &Volume) -> (TexelFormat, Option<SkipPlan>) {
    let storage = StorageKind::lossless_for(volume);
    let request = SkipRequest { skip: Skip::Auto, block_size: None };
    let plan = request.plan(volume.grid().dims(), storage, gpu.capabilities().skip_host());
    (TexelFormat::for_volume(volume, storage, gpu), plan)
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

fn upload(
    gpu: &Gpu,
    read: Read,
    kernels: &OnceLock<SkipKernels>,
    tell: &dyn Fn(f32),
) -> Result<Arrived, Failure> {
    let Read { volume, facts, held } = read;
    let (format, plan) = planned(gpu, &volume);
    let volume = GpuVolume::upload_as(gpu, &volume, format, &mut |done, all| tell(done as f32 / all as f32))?;
    let skipping = match plan {
        Some(plan) => {
            let builder = SkipBuilder::new(gpu, &kept(kernels, gpu)?, &volume, plan.block_size)?;
            Some(Skipping { builder, plan })
        }
        None => None,
    };
    Ok(Arrived { facts, volume, held, skipping })
}
