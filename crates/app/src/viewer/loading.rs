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
use wheatstone_io::{Cancel, RawLayout, ReadError, read_raw_unless, read_volume_unless};
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

/// What all loads of a session have in common. One of them is at work at a time: the next waits until one that was given up has ended.
pub(crate) struct Loader {
    wake: Waker,
    destination: Destination,
    /// Held once more by the thread of the load that is at work.
    busy: Arc<()>,
    /// They do not depend on the volume: the first makes them.
    kernels: Arc<OnceLock<SkipKernels>>,
}

/// The right to work. When it ends, whoever waits for it is woken.
pub(crate) struct Turn {
    held: Option<Arc<()>>,
    wake: Waker,
}

impl Drop for Turn {
    fn drop(&mut self) {
        self.held = None;
        (self.wake)();
    }
}

/// A file is read first, while the device may still be being opened.
pub(crate) enum Loading {
    Waiting(Source),
    Reading(Job<(Read, Turn)>),
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
        Self { wake, destination, busy: Arc::default(), kernels: Arc::default() }
    }

    /// Begins to read, or waits if what was given up has not ended.
    pub(crate) fn begin(&self, source: Source) -> Result<Loading, Failure> {
        let Some(turn) = self.turn() else { return Ok(Loading::Waiting(source)) };
        let destination = self.destination;
        let job = Job::begin("reading", Arc::clone(&self.wake), move |teller| {
            let (volume, warnings) = read(&source, teller.cancel())?;
            teller.tell("measuring", None);
            let facts = Facts::of(&volume, source.file.as_deref()).with_warnings(warnings);
            let held = (destination == Destination::Headset).then(|| Caster::new(&volume));
            Ok((Read { volume, facts, held }, turn))
        });
        Ok(Loading::Reading(job.context("cannot begin to read")?))
    }

    /// Goes on as far as it can without waiting, or by a step of an upload that takes no longer than a time, as far as is known.
    pub(crate) fn step(&self, loading: Loading, gpu: &Arc<Gpu>, time: Duration) -> Result<Step, Failure> {
        Ok(match loading {
            Loading::Waiting(source) => Step::UnderWay(self.begin(source)?),
            Loading::Reading(mut job) => Step::UnderWay(match (job.poll(), self.destination) {
                (None, _) => Loading::Reading(job),
                (Some(read), Destination::Window) => Loading::Uploading(self.upload(read?, gpu)?),
                (Some(read), Destination::Headset) => {
                    let (read, turn) = read?;
                    Loading::InSteps(Box::new(Upload::begin(gpu, read, turn, kept(&self.kernels, gpu)?)?))
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

    /// Threads that are at work, those of a load that was given up included.
    #[cfg(test)]
    pub(super) fn loads_at_work(&self) -> usize {
        Arc::strong_count(&self.busy) - 1
    }

    fn turn(&self) -> Option<Turn> {
        let is_free = Arc::strong_count(&self.busy) == 1;
        is_free.then(|| Turn { held: Some(Arc::clone(&self.busy)), wake: Arc::clone(&self.wake) })
    }

    fn upload(&self, (read, turn): (Read, Turn), gpu: &Arc<Gpu>) -> Result<Job<Arrived>, Failure> {
        let (gpu, kernels) = (Arc::clone(gpu), Arc::clone(&self.kernels));
        let job = Job::begin("uploading", Arc::clone(&self.wake), move |teller| {
            let _turn = turn;
            upload(&gpu, read, &kernels, &|done| teller.tell("uploading", Some(done)))
        });
        Ok(job.context("cannot begin to upload")?)
    }
}

impl Loading {
    /// How far it is.
    pub(crate) fn progress(&self) -> Progress {
        match self {
            Self::Waiting(_) => Progress { what: "waiting", done: None },
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

/// The volume, and what its reader assumed or left out.
fn read(source: &Source, cancel: &Cancel) -> Result<(Volume, Vec<String>), Failure> {
    let loaded = match (&source.file, &source.layout) {
        (None, _) => shipped::brain()?,
        (Some(file), Some(layout)) => read_raw_unless(file, layout, cancel)?,
        (Some(file), None) => read_volume_unless(file, cancel)?,
    };
    if cancel.is_cancelled() {
        return Err(ReadError::Cancelled.into());
    }
    print_warnings(source.file.as_deref().unwrap_or(Path::new(shipped::BRAIN_PATH)), &loaded);
    Ok((loaded.volume, loaded.warnings.iter().map(ToString::to_string).collect()))
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn one_load_is_at_work_at_a_time_and_the_next_is_woken_when_it_ends() {
        let wakes = Arc::new(AtomicUsize::new(0));
        let counted = Arc::clone(&wakes);
        let wake: Waker = Arc::new(move || {
            counted.fetch_add(1, Ordering::SeqCst);
        });
        let loader = Loader::new(wake, Destination::Window);
        let given_up = loader.turn().unwrap();
        let source = Source { file: Some("missing.nrrd".into()), layout: None };
        assert!(matches!(loader.begin(source.clone()).unwrap(), Loading::Waiting(next) if next == source));
        assert_eq!(wakes.load(Ordering::SeqCst), 0);
        drop(given_up);
        assert_eq!(wakes.load(Ordering::SeqCst), 1);
        assert!(matches!(loader.begin(source).unwrap(), Loading::Reading(_)));
    }

    #[test]
    fn what_is_given_up_is_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a_2x2x2_uint8.raw");
        std::fs::write(&file, [1; 8]).unwrap();
        let (named, shipped) =
            (Source { file: Some(file), layout: None }, Source { file: None, layout: None });
        let cancel = Cancel::default();
        assert!(read(&named, &cancel).is_ok());
        cancel.cancel();
        for source in [named, shipped] {
            assert!(read(&source, &cancel).unwrap_err().to_string().contains("given up"));
        }
    }
}
