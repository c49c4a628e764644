//! The two casters behind one face, and the choice between them.

use crate::failure::Failure;
use crate::progress::Bar;
use clap::ValueEnum;
use std::time::{Duration, Instant};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::reference::{Cast, Caster};
use wheatstone_core::view::View;
use wheatstone_core::volume::{StorageKind, Volume};
use wheatstone_render::{Gpu, GpuError, GpuVolume, Prepared, Renderer, Sources, Target, TexelFormat};

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
}

/// Samples from which software Vulkan's speed pays for its start (device, upload, compiling the kernel).
///
/// Measured on 2 cores with Mesa 22.3.6: software Vulkan takes 0.3 s more to start and casts 1.2 to 1.5 times as fast;
/// the two meet at 512² pixels of a 256³ volume.
const SOFTWARE_VULKAN_FROM_SAMPLES: f64 = 1e8;

/// Whether software Vulkan is likely to finish a job before the CPU renderer does: it casts faster, but takes
/// longer to start.
pub(crate) fn prefers_software_vulkan(job: &Job) -> bool {
    job.rays as f64 * job.samples_per_ray >= SOFTWARE_VULKAN_FROM_SAMPLES
}

/// A volume with its settings on a caster, ready for views.
pub(crate) enum Engine {
    /// On a GPU.
    Gpu(Box<GpuEngine>),
    /// On the CPU.
    Cpu(Box<CpuEngine>),
}

/// The GPU's side of [`Engine`].
pub(crate) struct GpuEngine {
    gpu: Gpu,
    renderer: Renderer,
    volume: GpuVolume,
    prepared: Prepared,
    targets: Vec<Target>,
    upload: Duration,
}

/// The CPU's side of [`Engine`].
pub(crate) struct CpuEngine {
    caster: Caster,
    parameters: CastParameters,
    casts: Vec<Cast>,
    upload: Duration,
}

impl Engine {
    /// Opens the caster that the user chose, or that suits the job. Falls back to the CPU only for
    /// [`BackendChoice::Auto`], and says so on standard error.
    pub(crate) fn open(
        choice: BackendChoice,
        job: &Job,
        volume: &Volume,
        storage: StorageKind,
        parameters: &CastParameters,
    ) -> Result<Self, Failure> {
        match choice {
            BackendChoice::Cpu => Ok(Self::cpu(volume, storage, parameters.clone())),
            BackendChoice::Gpu => Ok(Self::gpu(Gpu::open_best()?, volume, storage, parameters.clone())?),
            BackendChoice::Auto => {
                let opened = Gpu::open_best().and_then(|gpu| {
                    if gpu.description().is_software && !prefers_software_vulkan(job) {
                        return Ok(None);
                    }
                    Self::gpu(gpu, volume, storage, parameters.clone()).map(Some)
                });
                match opened {
                    Ok(Some(engine)) => Ok(engine),
                    Ok(None) => Ok(Self::cpu(volume, storage, parameters.clone())),
                    Err(error) => {
                        note_fallback(&error);
                        Ok(Self::cpu(volume, storage, parameters.clone()))
                    }
                }
            }
        }
    }

    /// Uploads a volume to an open GPU.
    pub(crate) fn gpu(
        gpu: Gpu,
        volume: &Volume,
        storage: StorageKind,
        parameters: CastParameters,
    ) -> Result<Self, GpuError> {
        let mut renderer = Renderer::new(&gpu)?;
        let format = TexelFormat::for_volume(volume, storage, &gpu);
        let bar = Bar::new("upload", 1);
        let start = Instant::now();
        let volume =
            GpuVolume::upload_as(&gpu, volume, format, &mut |done, all| bar.set(done as u64, all as u64))?;
        let upload = start.elapsed();
        let prepared = renderer.prepare(&gpu, &Sources::volume(&volume), parameters)?;
        Ok(Self::Gpu(Box::new(GpuEngine { gpu, renderer, volume, prepared, targets: Vec::new(), upload })))
    }

    /// Holds a volume for the CPU renderer.
    pub(crate) fn cpu(volume: &Volume, storage: StorageKind, parameters: CastParameters) -> Self {
        let start = Instant::now();
        let caster = Caster::with_storage(volume, storage);
        Self::Cpu(Box::new(CpuEngine { caster, parameters, casts: Vec::new(), upload: start.elapsed() }))
    }

    /// Changes the settings.
    pub(crate) fn set(&mut self, parameters: CastParameters) -> Result<(), GpuError> {
        match self {
            Self::Gpu(engine) => {
                engine.prepared =
                    engine.renderer.prepare(&engine.gpu, &Sources::volume(&engine.volume), parameters)?;
            }
            Self::Cpu(engine) => engine.parameters = parameters,
        }
        Ok(())
    }

    /// Casts every view; the time is that of the finished cast, without reading back.
    pub(crate) fn cast(&mut self, views: &[View]) -> Result<Duration, GpuError> {
        match self {
            Self::Gpu(engine) => engine.cast(views),
            Self::Cpu(engine) => {
                let start = Instant::now();
                engine.casts = engine.caster.cast(&engine.parameters, None, views);
                Ok(start.elapsed())
            }
        }
    }

    /// Pictures and sample counts of the last cast, one per view.
    pub(crate) fn read(&mut self) -> Result<Vec<Cast>, GpuError> {
        match self {
            Self::Gpu(engine) => engine.targets.iter().map(|target| target.read(&engine.gpu)).collect(),
            Self::Cpu(engine) => Ok(std::mem::take(&mut engine.casts)),
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

impl GpuEngine {
    fn cast(&mut self, views: &[View]) -> Result<Duration, GpuError> {
        let fits = self.targets.len() == views.len()
            && self.targets.iter().zip(views).all(|(target, view)| target.size() == view.size);
        if !fits {
            self.targets = views.iter().map(|v| Target::new(&self.gpu, v.size)).collect::<Result<_, _>>()?;
        }
        let start = Instant::now();
        self.renderer.render(&self.gpu, &self.prepared, views, &self.targets)?;
        Ok(start.elapsed())
    }
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
        assert!(!prefers_software_vulkan(&Job { rays: 256 * 256, samples_per_ray: 256.0 }));
        assert!(prefers_software_vulkan(&Job { rays: 3840 * 2160 * 2, samples_per_ray: 512.0 }));
    }
}
