//! `bench cast`: frame times of every mode on both casters, interleaved in one run.

use super::bench::{default_transfer, load, name_of, test_view};
use crate::backend::{Engine, median, milliseconds};
use crate::camera::Up;
use crate::failure::Failure;
use crate::look::ModeName;
use crate::output::{print, print_json};
use crate::progress::Bar;
use crate::skipping::{SkipArgs, SkipName, Skipping};
use crate::spec;
use crate::transfer_spec::{self, TransferSpec};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::scene::{Placement, Settings, Shading};
use wheatstone_core::view::{View, world_from_patient};
use wheatstone_core::volume::{StorageKind, Volume};
use wheatstone_render::{Gpu, GpuError, GpuVolume, TexelFormat};

/// Uploads that the upload time is the median of.
const UPLOADS: usize = 3;

/// Frame times of every mode on both casters, interleaved frame by frame; medians.
///
/// The camera turns once about the volume at the DM test distance. Rays end when less than 2⁻²⁴ passes them
/// unless --ert is given, and the window is the values' range.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone bench cast bonsai.nii.gz engine.nii.gz --up A\n  \
    wheatstone bench cast head.nii.gz --size 512x512 --frames 4 --modes dvr,iso --shadings none,phong --json\n  \
    wheatstone bench cast head.nii.gz --tf ramp:0.2..0.8 --backends cpu")]
pub(crate) struct CastArgs {
    /// Volume files.
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,

    /// Width and height of the picture, pixels.
    #[arg(long, value_name = "WxH", default_value = "768x768", value_parser = spec::picture_size)]
    size: [u32; 2],

    /// Frames of the turn; each caster makes each of them once, after two warm-up frames.
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=10_000), allow_negative_numbers = true)]
    frames: u32,

    /// Modes to measure [default: all].
    #[arg(long, value_name = "MODES", value_enum, value_delimiter = ',')]
    modes: Vec<ModeName>,

    /// Shadings of dvr and iso [default: none,phong for dvr, phong for iso].
    #[arg(long, value_name = "SHADINGS", value_delimiter = ',', value_parser = spec::shading)]
    shadings: Vec<Shading>,

    /// Transfer function [default: the ramp of the benchmark volume that the file is named after, else ramp:0..1].
    #[arg(long, value_name = "SPEC", value_parser = transfer_spec::parse)]
    tf: Option<TransferSpec>,

    /// Value of the isosurface [default: V0 of the ramp, else 0.3].
    #[arg(long, value_name = "V", value_parser = spec::within(0.0..=1.0), allow_negative_numbers = true)]
    iso: Option<f64>,

    /// Opacity at which a ray ends; 0 follows every ray to its end.
    #[arg(long, value_name = "T", default_value = "0", value_parser = spec::within(0.0..=1.0), allow_negative_numbers = true)]
    ert: f64,

    /// Samples per voxel length.
    #[arg(long, value_name = "F", default_value = "1", value_parser = spec::within(0.01..=32.0), allow_negative_numbers = true)]
    sampling_factor: f64,

    /// Casters to measure.
    #[arg(long, value_name = "BACKENDS", value_enum, value_delimiter = ',', default_value = "gpu,cpu")]
    backends: Vec<BackendName>,

    #[command(flatten)]
    skip: SkipArgs,

    /// Which patient direction points up; A gives a plain array's +y.
    #[arg(long, value_enum, ignore_case = true, default_value_t = Up::S)]
    up: Up,

    /// Print one JSON object on standard output instead of a table.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum BackendName {
    /// The best GPU, software included.
    Gpu,
    /// The CPU renderer.
    Cpu,
}

/// One line of the table.
struct Row {
    volume: String,
    mode: &'static str,
    shading: String,
    backend: &'static str,
    frame_ms: f64,
    samples: f64,
    msamples_per_s: f64,
}

#[derive(Default)]
struct Measured {
    rows: Vec<Row>,
    uploads: Vec<(String, f64)>,
    gpu: Option<[String; 2]>,
}

/// Runs the command.
pub(crate) fn run(args: &CastArgs) -> Result<(), Failure> {
    let skipping = args.skip.resolve(SkipName::None)?;
    let mut measured = Measured::default();
    for file in &args.files {
        args.measure(file, &skipping, &mut measured)?;
    }
    if args.json { print_json(&measured.to_json()) } else { print(&measured.to_table()) }
}

impl CastArgs {
    fn measure(&self, file: &Path, skipping: &Skipping, measured: &mut Measured) -> Result<(), Failure> {
        let loaded = load(file)?;
        let volume = &loaded.volume;
        let name = name_of(file);
        let transfer = self.tf.clone().unwrap_or_else(|| default_transfer(&name));
        let isovalue = self.iso.map_or_else(|| default_isovalue(&transfer), |iso| iso as f32);
        let resolved = transfer.resolve(volume, Some(volume.full_window()))?;
        let base = Settings {
            sampling_factor: self.sampling_factor as f32,
            early_termination: (self.ert > 0.0).then_some(self.ert as f32),
            ..Settings::new(resolved.window, resolved.transfer)
        };
        let placement = Placement::new(volume, world_from_patient(volume.grid(), self.up.direction()));
        let mut engines = self.engines(volume, &name, measured)?;
        let looks = self.looks();
        let bar = Bar::new("frames", looks.len() as u64 * u64::from(self.frames) * engines.len() as u64);
        for (mode, shading) in looks {
            let settings = Settings { mode: mode.with_isovalue(isovalue), shading, ..base.clone() };
            let parameters = CastParameters::new(&settings, &placement);
            self.interleave(&mut engines, &parameters, skipping, &bar)?.into_iter().for_each(|timed| {
                measured.rows.push(Row {
                    volume: name.clone(),
                    mode: mode.name(),
                    shading: spec::shading_name(shading),
                    ..timed
                });
            });
        }
        Ok(())
    }

    /// The casters that are there, with the volume on each.
    fn engines<'v>(
        &self,
        volume: &'v Volume,
        name: &str,
        measured: &mut Measured,
    ) -> Result<Vec<Engine<'v>>, Failure> {
        let storage = StorageKind::lossless_for(volume);
        let mut engines = Vec::new();
        if self.backends.contains(&BackendName::Gpu) {
            match Gpu::open_best() {
                Ok(gpu) => {
                    let upload_ms = upload_ms(&gpu, volume, storage)?;
                    measured.uploads.push((name.to_owned(), upload_ms));
                    let engine = Engine::gpu(gpu, volume, storage)?;
                    measured.gpu = Some([engine.device_name(), engine.driver_name()]);
                    engines.push(engine);
                }
                Err(error) if self.backends.len() == 1 => return Err(error.into()),
                Err(error) => eprintln!("note: {error}: measuring the CPU renderer only"),
            }
        }
        if self.backends.contains(&BackendName::Cpu) {
            engines.push(Engine::cpu(volume, storage));
        }
        Ok(engines)
    }

    fn looks(&self) -> Vec<(ModeName, Shading)> {
        let modes = if self.modes.is_empty() { &ModeName::ALL[..] } else { &self.modes };
        let shadings_of = |mode: ModeName| match mode {
            _ if !mode.is_lit() => vec![Shading::None],
            _ if !self.shadings.is_empty() => self.shadings.clone(),
            ModeName::Iso => vec![Shading::Phong],
            _ => vec![Shading::None, Shading::Phong],
        };
        modes.iter().flat_map(|&mode| shadings_of(mode).into_iter().map(move |s| (mode, s))).collect()
    }

    /// Every frame of the turn on every caster in turn.
    fn interleave(
        &self,
        engines: &mut [Engine<'_>],
        parameters: &CastParameters,
        skipping: &Skipping,
        bar: &Bar,
    ) -> Result<Vec<Row>, Failure> {
        let mut timings: Vec<Vec<(f64, f64)>> = vec![Vec::new(); engines.len()];
        let mut shots = Vec::new();
        for engine in engines.iter_mut() {
            let shot = engine.prepare(parameters, skipping)?;
            for index in 0..2 {
                engine.cast(shot, &[self.view(index)?])?;
            }
            shots.push(shot);
        }
        for index in 0..self.frames {
            let view = self.view(index)?;
            for ((engine, &shot), timings) in engines.iter_mut().zip(&shots).zip(&mut timings) {
                let frame_ms = milliseconds(engine.cast(shot, &[view])?);
                let samples: u64 = engine.read()?.iter().map(|cast| cast.samples).sum();
                timings.push((frame_ms, samples as f64));
                bar.advance();
            }
        }
        Ok(engines.iter().zip(&timings).map(|(engine, timings)| row(engine, timings)).collect())
    }

    fn view(&self, index: u32) -> Result<View, Failure> {
        test_view(std::f64::consts::TAU * f64::from(index) / f64::from(self.frames), self.size)
    }
}

fn row(engine: &Engine<'_>, timings: &[(f64, f64)]) -> Row {
    let median_of = |f: fn(&(f64, f64)) -> f64| median(&timings.iter().map(f).collect::<Vec<_>>());
    Row {
        volume: String::new(),
        mode: "",
        shading: String::new(),
        backend: engine.backend_name(),
        frame_ms: median_of(|t| t.0),
        samples: median_of(|t| t.1),
        msamples_per_s: median_of(|t| t.1 / 1e3 / t.0.max(1e-3)),
    }
}

fn default_isovalue(transfer: &TransferSpec) -> f32 {
    let v0 = match transfer {
        TransferSpec::Ramp([v0, _]) | TransferSpec::Ramp2d([v0, ..]) => *v0,
        TransferSpec::Benchmark(ramp) => ramp.values()[0],
        _ => 0.0,
    };
    if v0 > 0.0 { v0 } else { 0.3 }
}

fn upload_ms(gpu: &Gpu, volume: &Volume, storage: StorageKind) -> Result<f64, GpuError> {
    let format = TexelFormat::for_volume(volume, storage, gpu);
    let times: Vec<f64> = (0..UPLOADS)
        .map(|_| {
            let start = std::time::Instant::now();
            GpuVolume::upload_as(gpu, volume, format, &mut |_, _| ()).map(|_| milliseconds(start.elapsed()))
        })
        .collect::<Result<_, _>>()?;
    Ok(median(&times))
}

impl Measured {
    fn to_json(&self) -> Value {
        let [gpu, driver] = match &self.gpu {
            Some([gpu, driver]) => [json!(gpu), json!(driver)],
            None => [Value::Null, Value::Null],
        };
        let rows: Vec<Value> = self
            .rows
            .iter()
            .map(|row| {
                json!({
                    "volume": row.volume, "mode": row.mode, "shading": row.shading, "backend": row.backend,
                    "frame_ms": row.frame_ms, "samples": row.samples, "msamples_per_s": row.msamples_per_s,
                })
            })
            .collect();
        let upload: Vec<Value> =
            self.uploads.iter().map(|(volume, ms)| json!({ "volume": volume, "upload_ms": ms })).collect();
        json!({
            "device": { "gpu": gpu, "driver": driver, "cpu_threads": rayon::current_num_threads() },
            "rows": rows,
            "upload": upload,
        })
    }

    fn to_table(&self) -> String {
        let mut lines = Vec::new();
        if let Some([gpu, driver]) = &self.gpu {
            lines.push(format!("gpu: {gpu} ({driver})"));
        }
        lines.push(format!("cpu: {} threads", rayon::current_num_threads()));
        lines.extend(self.uploads.iter().map(|(volume, ms)| format!("upload of {volume}: {ms:.1} ms")));
        lines.push(format!(
            "{:<16} {:<6} {:<14} {:<4} {:>10} {:>12} {:>8}",
            "volume", "mode", "shading", "on", "frame ms", "M samples/s", "cpu/this"
        ));
        for row in &self.rows {
            let is_same = |r: &&Row| (&r.volume, r.mode, &r.shading) == (&row.volume, row.mode, &row.shading);
            let cpu = self.rows.iter().filter(is_same).find(|r| r.backend == "cpu");
            let ratio =
                cpu.map_or_else(|| "-".to_owned(), |cpu| format!("{:.2}", cpu.frame_ms / row.frame_ms));
            lines.push(format!(
                "{:<16} {:<6} {:<14} {:<4} {:>10.1} {:>12.1} {:>8}",
                row.volume, row.mode, row.shading, row.backend, row.frame_ms, row.msamples_per_s, ratio
            ));
        }
        lines.join("\n")
    }
}
