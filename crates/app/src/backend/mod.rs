//! The two casters behind one face, and the choice between them.

mod cpu;
mod gpu;
mod resolved;
mod truth;

use crate::failure::Failure;
use crate::pairing::Pairing;
use crate::skipping::Skipping;
use clap::ValueEnum;
use cpu::CpuEngine;
use gpu::GpuEngine;
pub(crate) use gpu::{GpuWarping, LiveEngine};
pub(crate) use resolved::ResolvedShot;
use serde_json::{Value, json};
use std::time::{Duration, Instant};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::detail::LevelOfDetail;
use wheatstone_core::gradient_map::GradientDepth;
use wheatstone_core::lightfield::anchors::AnchorError;
use wheatstone_core::reference::Cast;
use wheatstone_core::skip::{BlockSize, SkipPlan, SkipRequest, Structure};
use wheatstone_core::view::View;
use wheatstone_core::volume::{StorageKind, Volume};
use wheatstone_render::{Gpu, GpuError, PairError, PairReport};

/// Which caster the user asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum BackendChoice {
    /// A real GPU if there is one, else the CPU renderer or software Vulkan, whichever is faster for the job.
    Auto,
    /// The best Vulkan, Metal or DirectX 12 device, software included.
    Gpu,
    /// The reference renderer on all cores.
    Cpu,
}

/// What the choice between the CPU renderer and software Vulkan looks at.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Job {
    /// Pixels of all views and frames together.
    pub(crate) rays: u64,
    /// Samples along a ray through the volume's longest side.
    pub(crate) samples_per_ray: f64,
    /// Whether something is asked for that only a GPU does.
    pub(crate) needs_gpu: bool,
}

/// Samples from which software Vulkan's speed pays for its start (device, upload, compiling the kernel).
///
/// Measured on 2 cores with Mesa 22.3.6: software Vulkan takes 0.3 s more to start and casts 1.2 to 1.5 times as fast;
/// the two meet at 512² pixels of a 256³ volume.
const SOFTWARE_VULKAN_FROM_SAMPLES: f64 = 1e8;

/// Whether software Vulkan is likely to finish a job before the CPU renderer does: it casts faster, but takes
/// longer to start. And whether it alone can do it.
pub(crate) fn prefers_software_vulkan(job: &Job) -> bool {
    job.needs_gpu || job.rays as f64 * job.samples_per_ray >= SOFTWARE_VULKAN_FROM_SAMPLES
}

/// A volume on a caster.
pub(crate) enum Engine<'v> {
    /// On a GPU.
    Gpu(Box<GpuEngine>),
    /// On the CPU.
    Cpu(Box<CpuEngine<'v>>),
}

/// Settings that an engine has prepared.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shot(usize);

/// A pair that one cast has made.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PairCast {
    /// Time of both pictures, without reading back.
    pub(crate) time: Duration,
    /// What it has taken.
    pub(crate) report: PairReport,
}

/// Anchors that views are derived from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AnchorCast {
    /// How many.
    pub(crate) count: usize,
    /// Slabs of depth that their rays are cut into.
    pub(crate) slabs: u32,
    /// Time of casting all of them.
    pub(crate) time: Duration,
    /// Bytes that they take beside their pictures.
    pub(crate) bytes: u64,
    /// Samples that their rays took.
    pub(crate) samples: u64,
    /// Reads of the skip map.
    pub(crate) map_reads: u64,
}

/// Why pictures have not been derived from others.
#[derive(Debug)]
pub(crate) enum Underived {
    /// What keeps them from being derived; casts of their own can make them.
    Refused(String),
    /// The device.
    Gpu(GpuError),
}

impl From<PairError> for Underived {
    fn from(error: PairError) -> Self {
        match error {
            PairError::Gpu(error) => error.into(),
            other => Self::Refused(other.to_string()),
        }
    }
}

impl From<AnchorError> for Underived {
    fn from(error: AnchorError) -> Self {
        Self::Refused(error.to_string())
    }
}

impl From<GpuError> for Underived {
    fn from(error: GpuError) -> Self {
        match error {
            GpuError::OutOfMemory { reason } | GpuError::Refused { reason } => Self::Refused(reason),
            other => Self::Gpu(other),
        }
    }
}

/// What rays leap over, as reports tell it.
#[derive(Debug, Clone)]
pub(crate) struct Leaping {
    /// `none`, `ranges` or the name of the structure.
    pub(crate) structure: &'static str,
    /// Size of the blocks, if there are any.
    pub(crate) block_size: Option<BlockSize>,
    /// The occupied part of the blocks, if that was found out.
    pub(crate) occupied_fraction: Option<f64>,
    /// Bytes of the structure.
    pub(crate) bytes: u64,
    /// Bytes of the ranges that the structure was made from, which are given back once it was.
    pub(crate) ranges_bytes: u64,
    /// Bytes, at most, that working it out took besides; given back, too.
    pub(crate) working_bytes: u64,
}

/// The gradient map that a shot looks magnitudes up in, as reports tell it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GradientMapSize {
    /// Its precision.
    pub(crate) depth: GradientDepth,
    /// Bytes that it takes: those of a second volume.
    pub(crate) bytes: u64,
}

impl GradientMapSize {
    /// One object of a report.
    pub(crate) fn to_json(self) -> Value {
        json!({ "bits": self.depth.bits(), "bytes": self.bytes })
    }
}

impl Leaping {
    /// Every sample is taken.
    const NOTHING: Self = Self {
        structure: "none",
        block_size: None,
        occupied_fraction: None,
        bytes: 0,
        ranges_bytes: 0,
        working_bytes: 0,
    };

    /// Over the blocks that a structure tells to be empty.
    fn over_empty_blocks(plan: &SkipPlan, occupied_fraction: f64, bytes: u64) -> Self {
        Self {
            structure: structure_name(plan.structure),
            block_size: Some(plan.block_size),
            occupied_fraction: Some(occupied_fraction),
            bytes,
            ..Self::NOTHING
        }
    }

    /// Over the blocks whose range of values tells that they do not change an extreme.
    fn over_idle_blocks(plan: &SkipPlan, bytes: u64) -> Self {
        Self { structure: "ranges", block_size: Some(plan.block_size), bytes, ..Self::NOTHING }
    }

    /// The report of a picture whose rays have read the structure so many times.
    pub(crate) fn to_json(&self, map_reads: u64) -> Value {
        json!({
            "structure": self.structure,
            "block_size": self.block_size.map(side),
            "occupied_fraction": self.occupied_fraction,
            "map_reads": map_reads,
            "bytes": self.bytes,
            "ranges_bytes": self.ranges_bytes,
            "working_bytes": self.working_bytes,
        })
    }

    /// The same in words.
    pub(crate) fn described(&self, map_reads: u64) -> String {
        match self.block_size.map(side) {
            None => "nothing skipped".to_owned(),
            Some(side) => {
                format!("{:.1} M reads of {} in blocks of {side}³", map_reads as f64 / 1e6, self.structure)
            }
        }
    }

    /// Over nothing, because too much is occupied.
    fn not_worth_it(occupied_fraction: f64) -> Self {
        Self { occupied_fraction: Some(occupied_fraction), ..Self::NOTHING }
    }
}

/// Voxels along each side of a cubic block.
fn side(block_size: BlockSize) -> u32 {
    block_size.sides()[0]
}

/// Name of a structure as on the command line.
pub(crate) fn structure_name(structure: Structure) -> &'static str {
    match structure {
        Structure::Occupancy => "occupancy",
        Structure::Distance => "distance",
        Structure::Anisotropic => "anisotropic",
    }
}

impl<'v> Engine<'v> {
    /// Opens the caster that the user chose, or that suits the job. Falls back to the CPU only for
    /// [`BackendChoice::Auto`], and says so on standard error.
    pub(crate) fn open(
        choice: BackendChoice,
        job: &Job,
        volume: &'v Volume,
        storage: StorageKind,
    ) -> Result<Self, Failure> {
        match choice {
            BackendChoice::Cpu => Ok(Self::cpu(volume, storage)),
            BackendChoice::Gpu => Ok(Self::gpu(Gpu::open_best()?, volume, storage)?),
            BackendChoice::Auto => {
                let opened = Gpu::open_best().and_then(|gpu| {
                    if gpu.description().is_software && !prefers_software_vulkan(job) {
                        return Ok(None);
                    }
                    Self::gpu(gpu, volume, storage).map(Some)
                });
                match opened {
                    Ok(Some(engine)) => Ok(engine),
                    Ok(None) => Ok(Self::cpu(volume, storage)),
                    Err(error) => {
                        note_fallback(&error);
                        Ok(Self::cpu(volume, storage))
                    }
                }
            }
        }
    }

    /// Uploads a volume to an open GPU.
    pub(crate) fn gpu(gpu: Gpu, volume: &Volume, storage: StorageKind) -> Result<Self, GpuError> {
        Ok(Self::Gpu(Box::new(GpuEngine::new(gpu, volume, storage)?)))
    }

    /// Holds a volume for the CPU renderer.
    pub(crate) fn cpu(volume: &'v Volume, storage: StorageKind) -> Self {
        Self::Cpu(Box::new(CpuEngine::new(volume, storage)))
    }

    /// What is made where something is asked for.
    pub(crate) fn plan(&self, request: SkipRequest) -> Option<SkipPlan> {
        match self {
            Self::Gpu(engine) => engine.plan(0, request),
            Self::Cpu(engine) => engine.plan(request),
        }
    }

    /// Settings on a GPU, to be cast a few cells at a time.
    pub(crate) fn live(&mut self, shot: Shot) -> Result<LiveEngine<'_>, Failure> {
        match self {
            Self::Gpu(engine) => Ok(engine.live(shot)),
            Self::Cpu(_) => Err(Failure::input("the CPU renderer does not cast live")),
        }
    }

    /// Makes what is made once per change of the settings.
    pub(crate) fn prepare(
        &mut self,
        parameters: &CastParameters,
        skipping: &Skipping,
    ) -> Result<Shot, GpuError> {
        match self {
            Self::Gpu(engine) => engine.prepare(parameters, skipping),
            Self::Cpu(engine) => Ok(engine.prepare(parameters, skipping)),
        }
    }

    /// Takes coarser levels of the volume ([`Volume::coarser_levels`]) for [`Engine::prepare_detail`].
    pub(crate) fn add_levels(&mut self, coarser: &'v [Volume]) -> Result<(), GpuError> {
        match self {
            Self::Gpu(engine) => engine.add_levels(coarser),
            Self::Cpu(engine) => {
                engine.add_levels(coarser);
                Ok(())
            }
        }
    }

    /// Levels of the volume, itself included.
    fn level_count(&self) -> usize {
        match self {
            Self::Gpu(engine) => engine.level_count(),
            Self::Cpu(engine) => engine.level_count(),
        }
    }

    /// As [`Engine::prepare`], for composites by value whose far parts are cast of coarser levels.
    pub(crate) fn prepare_detail(
        &mut self,
        parameters: &CastParameters,
        skipping: &Skipping,
        level_of_detail: LevelOfDetail,
    ) -> Result<Shot, GpuError> {
        match self {
            Self::Gpu(engine) => engine.prepare_detail(parameters, skipping, level_of_detail),
            Self::Cpu(engine) => Ok(engine.prepare_detail(parameters, skipping, level_of_detail)),
        }
    }

    /// As [`Engine::prepare`], for rays that leap to what the last picture saw first.
    pub(crate) fn prepare_leaping(
        &mut self,
        parameters: &CastParameters,
        skipping: &Skipping,
    ) -> Result<Shot, GpuError> {
        match self {
            Self::Gpu(engine) => engine.prepare_leaping(parameters, skipping),
            Self::Cpu(engine) => Ok(engine.prepare(parameters, skipping)),
        }
    }

    /// Casts a view of a leaping shot after another one; the time is that of the second.
    pub(crate) fn cast_after(&mut self, shot: Shot, last: &View, view: &View) -> Result<Duration, GpuError> {
        match self {
            Self::Gpu(engine) => engine.cast_after(shot, last, view),
            Self::Cpu(engine) => Ok(engine.cast_after(shot, last, view)),
        }
    }

    /// Casts every view; the time is that of the finished cast, without reading back.
    pub(crate) fn cast(&mut self, shot: Shot, views: &[View]) -> Result<Duration, GpuError> {
        match self {
            Self::Gpu(engine) => engine.cast(shot, views),
            Self::Cpu(engine) => Ok(engine.cast(shot, views)),
        }
    }

    /// Makes a pair, left view first, of one cast.
    pub(crate) fn cast_pair(
        &mut self,
        shot: Shot,
        views: [View; 2],
        pairing: &Pairing,
    ) -> Result<PairCast, Underived> {
        match self {
            Self::Gpu(engine) => engine.cast_pair(shot, views, pairing),
            Self::Cpu(_) => Err(Underived::Refused("the CPU renderer casts every eye".to_owned())),
        }
    }

    /// Casts as many anchors of views side by side as are asked for, or as it takes, for [`Engine::derive`].
    pub(crate) fn cast_anchors(
        &mut self,
        shot: Shot,
        views: &[View],
        count: Option<u32>,
    ) -> Result<AnchorCast, Underived> {
        match self {
            Self::Gpu(engine) => engine.cast_anchors(shot, views, count),
            Self::Cpu(_) => Err(Underived::Refused("the CPU renderer casts every view".to_owned())),
        }
    }

    /// Makes the picture of one of the views that anchors were cast for.
    pub(crate) fn derive(&mut self, view: usize) -> Result<Duration, Failure> {
        match self {
            Self::Gpu(engine) => engine.derive(view),
            Self::Cpu(_) => Err(Failure::input("the CPU renderer derives no views")),
        }
    }

    /// Pictures and sample counts of the last cast, one per view.
    pub(crate) fn read(&mut self) -> Result<Vec<Cast>, GpuError> {
        match self {
            Self::Gpu(engine) => engine.read(),
            Self::Cpu(engine) => Ok(engine.read()),
        }
    }

    /// What the rays of a shot leap over.
    pub(crate) fn leaping(&self, shot: Shot) -> &Leaping {
        match self {
            Self::Gpu(engine) => engine.leaping(shot),
            Self::Cpu(engine) => engine.leaping(shot),
        }
    }

    /// The gradient map that a shot looks magnitudes up in, if it does.
    pub(crate) fn gradient_map_size(&self, shot: Shot) -> Option<GradientMapSize> {
        match self {
            Self::Gpu(engine) => engine.gradient_map_size(shot),
            Self::Cpu(engine) => engine.gradient_map_size(shot),
        }
    }

    /// Time of working a structure out again after a change of the settings, ms; median of [`UPDATES`].
    pub(crate) fn update_ms(
        &mut self,
        parameters: &CastParameters,
        skipping: &Skipping,
        plan: &SkipPlan,
    ) -> Result<f64, GpuError> {
        match self {
            Self::Gpu(engine) => engine.update_ms(parameters, skipping, plan),
            Self::Cpu(engine) => Ok(engine.update_ms(parameters, skipping, plan)),
        }
    }

    /// The same for an isotropic distance map by classifying every voxel, as DM does; only on a GPU.
    pub(crate) fn update_ms_by_voxels(
        &mut self,
        parameters: &CastParameters,
        skipping: &Skipping,
        block_size: BlockSize,
    ) -> Result<Option<f64>, GpuError> {
        match self {
            Self::Gpu(engine) => engine.update_ms_by_voxels(parameters, skipping, block_size).map(Some),
            Self::Cpu(_) => Ok(None),
        }
    }

    /// Time that the volume took to get where it is sampled.
    pub(crate) fn upload_time(&self) -> Duration {
        match self {
            Self::Gpu(engine) => engine.upload,
            Self::Cpu(engine) => engine.upload,
        }
    }

    /// `gpu` or `cpu`.
    pub(crate) fn backend_name(&self) -> &'static str {
        match self {
            Self::Gpu(_) => "gpu",
            Self::Cpu(_) => "cpu",
        }
    }

    /// What the cast runs on.
    pub(crate) fn device_name(&self) -> String {
        match self {
            Self::Gpu(engine) => engine.gpu.description().name.clone(),
            Self::Cpu(_) => format!("{} CPU threads", rayon::current_num_threads()),
        }
    }

    /// The driver, or this program's version for the CPU.
    pub(crate) fn driver_name(&self) -> String {
        match self {
            Self::Gpu(engine) => engine.gpu.description().driver.clone(),
            Self::Cpu(_) => concat!("wheatstone ", env!("CARGO_PKG_VERSION")).to_owned(),
        }
    }
}

/// Times that something is done again for the median of its time.
const UPDATES: usize = 5;

/// Median time of doing something again, ms, after doing it once.
fn median_ms<E>(mut again: impl FnMut() -> Result<(), E>) -> Result<f64, E> {
    again()?;
    let times = (0..UPDATES).map(|_| {
        let start = Instant::now();
        again().map(|()| milliseconds(start.elapsed()))
    });
    Ok(median(&times.collect::<Result<Vec<_>, _>>()?))
}

/// Opens a renderer and makes something with it; if any may be chosen and the GPU fails meanwhile, all of it by the CPU.
pub(crate) fn make_on<'v, T>(
    choice: BackendChoice,
    open: impl Fn(BackendChoice) -> Result<Engine<'v>, Failure>,
    mut make: impl FnMut(&mut Engine<'v>) -> Result<T, Failure>,
) -> Result<(Engine<'v>, T), Failure> {
    let mut engine = open(choice)?;
    let made = match make(&mut engine) {
        Err(Failure::Gpu(error)) if choice == BackendChoice::Auto => {
            note_fallback(&error);
            engine = open(BackendChoice::Cpu)?;
            make(&mut engine)?
        }
        made => made?,
    };
    Ok((engine, made))
}

/// Says on standard error that the CPU renderer takes over.
pub(crate) fn note_fallback(error: &GpuError) {
    eprintln!("note: the GPU cannot be used ({error}): using the CPU renderer");
}

/// Milliseconds, to a microsecond.
pub(crate) fn milliseconds(time: Duration) -> f64 {
    (time.as_secs_f64() * 1e6).round() / 1e3
}

/// The middle value; the mean of the two middle ones of an even number; 0 of none.
pub(crate) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    match sorted.len() {
        0 => 0.0,
        n if n % 2 == 1 => sorted[n / 2],
        n => 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        assert_eq!(median(&[]), 0.0);
    }

    #[test]
    fn small_jobs_stay_on_the_cpu() {
        let small = Job { rays: 256 * 256, samples_per_ray: 256.0, needs_gpu: false };
        assert!(!prefers_software_vulkan(&small));
        assert!(prefers_software_vulkan(&Job { needs_gpu: true, ..small }));
        assert!(prefers_software_vulkan(&Job { rays: 3840 * 2160 * 2, samples_per_ray: 512.0, ..small }));
    }
}
