//! `bench skip`: what leaping over empty space saves, by the protocol of DM §4.1.

use super::bench::{Device, Opened, open, test_view};
use crate::backend::{Engine, Shot, median, milliseconds, structure_name};
use crate::camera::Up;
use crate::failure::Failure;
use crate::output::{file_in, make_folder, print, print_json};
use crate::plot::{Labels, Line, even_chart, logarithmic_chart};
use crate::progress::Bar;
use crate::skipping::{GradientMapName, Skipping};
use crate::spec;
use crate::transfer_spec::{self, TransferSpec};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::gradient_map::GradientMap;
use wheatstone_core::reference::{Cast, Caster, HeldGradientMap};
use wheatstone_core::scene::{Placement, Settings};
use wheatstone_core::skip::{BlockSize, Skip, SkipRequest, Structure, voxel_occupancy};
use wheatstone_core::transfer::BenchmarkRamp;
use wheatstone_core::view::{View, world_from_patient};
use wheatstone_core::volume::{StorageKind, Volume};
use wheatstone_render::Gpu;

/// Turn from one frame to the next, degrees: 90 in 60 frames.
const TURN_DEG: f64 = 1.5;
/// The turn that fewer frames are spread over, degrees.
const ARC_DEG: f64 = 90.0;

/// Pictures that are compared with the oracle's, and how many times smaller than the frames they are.
const ORACLE_VIEWS: u32 = 4;
const ORACLE_SHRINK: u32 = 5;

const STRUCTURES: [Structure; 3] = [Structure::Occupancy, Structure::Distance, Structure::Anisotropic];

/// Frame and update times of every structure of empty-space skipping, by the protocol of Deakin and Knackstedt 2020.
///
/// The camera turns about the volume by 1.5 degrees per frame (fewer than 60 frames are spread over the same 90 degrees), at
/// the distance of the square root of 3 and with a field of view of 1 radian. There is no early termination: rays end when less than
/// 2⁻²⁴ passes them. Each frame is made with every structure and block size in turn; times are medians.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone bench skip\n  \
    wheatstone bench skip beetle:512 --size 768x768 --frames 12 --plot plots\n  \
    wheatstone bench skip bonsai.nii.gz snake:256 --up A --tf ramp:0.2..1 --json")]
pub(crate) struct SkipBenchArgs {
    /// Volume files, or phantoms with their size [default: present:256 beetle:256 snake:256].
    #[arg(value_name = "FILE|PHANTOM:N")]
    volumes: Vec<String>,

    /// Transfer function [default: each ramp of the benchmark volume of the name, else ramp:0..1].
    #[arg(long, value_name = "SPEC", value_parser = transfer_spec::parse)]
    tf: Option<TransferSpec>,

    /// Width and height of the picture, pixels.
    #[arg(long, value_name = "WxH", default_value = "1200x1200", value_parser = spec::picture_size)]
    size: [u32; 2],

    /// Frames that are timed.
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=10_000), allow_negative_numbers = true)]
    frames: u32,

    /// Sides of the blocks, voxels.
    #[arg(long, value_name = "SIZES", value_delimiter = ',', default_value = "2,3,4,5,6", value_parser = spec::block_size)]
    block_sizes: Vec<BlockSize>,

    /// Bits of the gradient magnitudes that two-dimensional transfer functions look up; none estimates them around each
    /// sample.
    #[arg(long, value_enum, default_value_t = GradientMapName::Auto)]
    gradient_map: GradientMapName,

    /// What casts the rays; gpu includes software Vulkan.
    #[arg(long, value_enum, default_value_t = Backend::Gpu)]
    backend: Backend,

    /// Which patient direction points up; A gives a plain array's +y.
    #[arg(long, value_enum, ignore_case = true, default_value_t = Up::S)]
    up: Up,

    /// Write charts to this folder: the speed-up and the update time over the block size.
    #[arg(long, value_name = "DIR")]
    plot: Option<PathBuf>,

    /// Print one JSON object on standard output instead of a table.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Backend {
    /// The best GPU, software included.
    Gpu,
    /// The CPU renderer.
    Cpu,
}

/// A volume with one transfer function.
struct Case<'a> {
    name: &'a str,
    transfer_name: String,
    parameters: CastParameters,
    /// The part of the voxels that can be seen.
    voxel_occupancy: f64,
}

/// What rays leap by in one row; nothing in the base.
#[derive(Clone, Copy)]
struct Variant {
    structure: Option<Structure>,
    block_size: Option<BlockSize>,
}

/// One line of the table.
struct Row {
    volume: String,
    transfer_name: String,
    variant: Variant,
    occupancy: f64,
    frame_ms: f64,
    ratio_to_base: f64,
    samples_per_ray: f64,
    reads_per_ray: f64,
    oracle_ratio: f64,
    update_ms: Option<f64>,
    update_ms_voxels: Option<f64>,
    bytes: u64,
}

/// Runs the command.
pub(crate) fn run(args: &SkipBenchArgs) -> Result<(), Failure> {
    if let Some(folder) = &args.plot {
        make_folder(folder)?;
    }
    let defaults = ["present:256", "beetle:256", "snake:256"].map(str::to_owned);
    let volumes = if args.volumes.is_empty() { &defaults[..] } else { &args.volumes };
    let (mut rows, mut device) = (Vec::new(), None);
    for volume in volumes {
        device = Some(args.measure_volume(volume, &mut rows)?);
    }
    if let Some(folder) = &args.plot {
        plot(folder, &rows)?;
    }
    if args.json {
        print_json(&args.to_json(device.as_ref(), &rows))
    } else {
        print(&to_table(device.as_ref(), &rows))
    }
}

impl SkipBenchArgs {
    fn measure_volume(&self, described: &str, rows: &mut Vec<Row>) -> Result<Device, Failure> {
        let Opened { volume, name, benchmark } = open(described)?;
        let transfers = match &self.tf {
            Some(tf) => vec![tf.clone()],
            None => {
                let ramps: Vec<_> =
                    BenchmarkRamp::of_volume(&benchmark).map(TransferSpec::Benchmark).collect();
                if ramps.is_empty() { vec![TransferSpec::Ramp([0.0, 1.0])] } else { ramps }
            }
        };
        let storage = StorageKind::lossless_for(&volume);
        let mut engine = match self.backend {
            Backend::Gpu => Engine::gpu(Gpu::open_best()?, &volume, storage)?,
            Backend::Cpu => Engine::cpu(&volume, storage),
        };
        let caster = Caster::with_storage(&volume, storage);
        for transfer in transfers {
            let case = self.case(&name, &volume, &transfer)?;
            let least = self.least_reads(&volume, storage, &caster, &case.parameters)?;
            rows.extend(self.measure(&case, &mut engine, least)?);
        }
        Ok(Device::of(&engine))
    }

    fn case<'a>(&self, name: &'a str, volume: &Volume, transfer: &TransferSpec) -> Result<Case<'a>, Failure> {
        let resolved = transfer.resolve(volume, None)?;
        let settings =
            Settings { early_termination: None, ..Settings::new(resolved.window, resolved.transfer) };
        let placement = Placement::new(volume, world_from_patient(volume.grid(), self.up.direction()));
        Ok(Case {
            name,
            transfer_name: transfer.name(),
            parameters: CastParameters::new(&settings, &placement),
            voxel_occupancy: voxel_occupancy(volume, settings.window, &settings.transfer, settings.gradient),
        })
    }

    /// Every row of a case: a structure that the device cannot hold has none.
    fn measure(&self, case: &Case<'_>, engine: &mut Engine<'_>, least: f64) -> Result<Vec<Row>, Failure> {
        let mut variants = self.variants();
        variants.retain(|variant| {
            engine.plan(self.skipping(variant).request).map(|plan| plan.structure) == variant.structure
        });
        let shots = variants
            .iter()
            .map(|variant| engine.prepare(&case.parameters, &self.skipping(variant)))
            .collect::<Result<Vec<_>, _>>()?;
        let frames = self.interleave(engine, &shots, case.name)?;
        let oracle_ratios = self.oracle_ratios(engine, &shots, least)?;
        let rays = self.size.iter().map(|&side| f64::from(side)).product::<f64>();
        let medians: Vec<f64> =
            frames.iter().map(|of_shot| median_of(of_shot, |frame| frame.frame_ms)).collect();
        let mut rows = Vec::new();
        for (i, variant) in variants.iter().enumerate() {
            let leaping = engine.leaping(shots[i]).clone();
            let [update_ms, update_ms_voxels] = self.update_times(case, engine, variant)?;
            rows.push(Row {
                volume: case.name.to_owned(),
                transfer_name: case.transfer_name.clone(),
                variant: *variant,
                occupancy: leaping.occupied_fraction.unwrap_or(case.voxel_occupancy),
                frame_ms: medians[i],
                ratio_to_base: medians[0] / medians[i].max(1e-3),
                samples_per_ray: median_of(&frames[i], |frame| frame.samples) / rays,
                reads_per_ray: median_of(&frames[i], |frame| frame.map_reads) / rays,
                oracle_ratio: oracle_ratios[i],
                update_ms,
                update_ms_voxels,
                bytes: leaping.bytes,
            });
        }
        Ok(rows)
    }

    /// The base, then each structure with each size of blocks, whether or not a device can hold it.
    fn variants(&self) -> Vec<Variant> {
        let with_sizes = |structure| {
            self.block_sizes
                .iter()
                .map(move |&block_size| Variant { structure: Some(structure), block_size: Some(block_size) })
        };
        let base = Variant { structure: None, block_size: None };
        std::iter::once(base).chain(STRUCTURES.into_iter().flat_map(with_sizes)).collect()
    }

    fn skipping(&self, variant: &Variant) -> Skipping {
        let skip = match variant.structure {
            None => Skip::None,
            Some(Structure::Occupancy) => Skip::Occupancy,
            Some(Structure::Distance) => Skip::Distance,
            Some(Structure::Anisotropic) => Skip::Anisotropic,
        };
        Skipping {
            request: SkipRequest { skip, block_size: variant.block_size },
            gradient_map: self.gradient_map,
        }
    }

    /// Every frame with every shot in turn, after one of each that does not count.
    fn interleave(
        &self,
        engine: &mut Engine<'_>,
        shots: &[Shot],
        name: &str,
    ) -> Result<Vec<Vec<Frame>>, Failure> {
        let mut frames = vec![Vec::new(); shots.len()];
        let bar = Bar::new(name.to_owned(), u64::from(self.frames + 1) * shots.len() as u64);
        for &shot in shots {
            engine.cast(shot, &[self.view(0)?])?;
            bar.advance();
        }
        for index in 0..self.frames {
            let view = self.view(index)?;
            for (&shot, frames) in shots.iter().zip(&mut frames) {
                let frame_ms = milliseconds(engine.cast(shot, &[view])?);
                let (samples, map_reads) = totals(&engine.read()?);
                frames.push(Frame { frame_ms, samples, map_reads });
                bar.advance();
            }
        }
        Ok(frames)
    }

    fn view(&self, index: u32) -> Result<View, Failure> {
        let turn_deg = TURN_DEG.max(ARC_DEG / f64::from(self.frames));
        test_view((turn_deg * f64::from(index)).to_radians(), self.size)
    }

    /// Views of the pictures that are compared with the oracle's.
    fn oracle_views(&self) -> Result<Vec<View>, Failure> {
        let size = self.size.map(|side| side.div_ceil(ORACLE_SHRINK));
        (0..ORACLE_VIEWS)
            .map(|i| test_view((ARC_DEG / f64::from(ORACLE_VIEWS) * f64::from(i)).to_radians(), size))
            .collect()
    }

    /// What rays must read in those pictures.
    fn least_reads(
        &self,
        volume: &Volume,
        storage: StorageKind,
        caster: &Caster,
        parameters: &CastParameters,
    ) -> Result<f64, Failure> {
        let gradient_map = self
            .skipping(&Variant { structure: None, block_size: None })
            .gradient_depth(parameters, storage)
            .map(|depth| GradientMap::new(volume, storage, parameters.gradient, depth))
            .map(|map| HeldGradientMap::new(&map));
        let views = self.oracle_views()?;
        let least: Vec<Cast> =
            views.iter().map(|view| caster.cast_by_oracle(parameters, gradient_map.as_ref(), view)).collect();
        Ok(all_reads(&least).max(1.0))
    }

    /// What the rays of each shot read, over what they must read.
    fn oracle_ratios(
        &self,
        engine: &mut Engine<'_>,
        shots: &[Shot],
        least: f64,
    ) -> Result<Vec<f64>, Failure> {
        let views = self.oracle_views()?;
        shots
            .iter()
            .map(|&shot| {
                engine.cast(shot, &views)?;
                Ok(all_reads(&engine.read()?) / least)
            })
            .collect()
    }

    fn update_times(
        &self,
        case: &Case<'_>,
        engine: &mut Engine<'_>,
        variant: &Variant,
    ) -> Result<[Option<f64>; 2], Failure> {
        let skipping = self.skipping(variant);
        let Some(plan) = engine.plan(skipping.request) else { return Ok([None, None]) };
        let update_ms = engine.update_ms(&case.parameters, &skipping, &plan)?;
        let update_ms_voxels = match plan.structure {
            Structure::Distance => {
                engine.update_ms_by_voxels(&case.parameters, &skipping, plan.block_size)?
            }
            Structure::Occupancy | Structure::Anisotropic => None,
        };
        Ok([Some(update_ms), update_ms_voxels])
    }

    fn to_json(&self, device: Option<&Device>, rows: &[Row]) -> Value {
        json!({
            "device": device.map(Device::to_json),
            "size": self.size,
            "frames": self.frames,
            "rows": rows.iter().map(Row::to_json).collect::<Vec<_>>(),
        })
    }
}

/// A frame's time and what its rays have read.
#[derive(Clone, Copy)]
struct Frame {
    frame_ms: f64,
    samples: f64,
    map_reads: f64,
}

/// Samples and map reads of some casts.
fn totals(casts: &[Cast]) -> (f64, f64) {
    let samples: u64 = casts.iter().map(|cast| cast.samples).sum();
    let map_reads: u64 = casts.iter().map(|cast| cast.map_reads).sum();
    (samples as f64, map_reads as f64)
}

/// Samples and map reads of some casts together.
fn all_reads(casts: &[Cast]) -> f64 {
    let (samples, map_reads) = totals(casts);
    samples + map_reads
}

fn median_of(frames: &[Frame], number: fn(&Frame) -> f64) -> f64 {
    median(&frames.iter().map(number).collect::<Vec<_>>())
}

impl Variant {
    fn name(self) -> &'static str {
        self.structure.map_or("none", structure_name)
    }

    fn side(self) -> Option<u32> {
        self.block_size.map(|block_size| block_size.sides()[0])
    }
}

impl Row {
    fn to_json(&self) -> Value {
        json!({
            "volume": self.volume,
            "tf": self.transfer_name,
            "skip": self.variant.name(),
            "block_size": self.variant.side(),
            "occupancy": self.occupancy,
            "frame_ms": self.frame_ms,
            "ratio_to_base": self.ratio_to_base,
            "samples_per_ray": self.samples_per_ray,
            "reads_per_ray": self.reads_per_ray,
            "oracle_ratio": self.oracle_ratio,
            "update_ms": self.update_ms,
            "update_ms_voxels": self.update_ms_voxels,
            "bytes": self.bytes,
        })
    }
}

fn to_table(device: Option<&Device>, rows: &[Row]) -> String {
    let mut lines = Vec::new();
    lines.extend(device.map(Device::to_string));
    lines.push(format!(
        "{:<12} {:<12} {:<11} {:>5} {:>9} {:>9} {:>7} {:>11} {:>9} {:>7} {:>9} {:>9} {:>9}",
        "volume",
        "tf",
        "skip",
        "block",
        "occupied",
        "frame ms",
        "× base",
        "samples/ray",
        "reads/ray",
        "oracle",
        "update",
        "by voxels",
        "KiB"
    ));
    let optional = |ms: Option<f64>| ms.map_or_else(|| "-".to_owned(), |ms| format!("{ms:.2}"));
    for row in rows {
        lines.push(format!(
            "{:<12} {:<12} {:<11} {:>5} {:>7.2} % {:>9.1} {:>7.2} {:>11.2} {:>9.2} {:>7.2} {:>9} {:>9} {:>9.0}",
            row.volume,
            row.transfer_name,
            row.variant.name(),
            row.variant.side().map_or_else(|| "-".to_owned(), |side| side.to_string()),
            100.0 * row.occupancy,
            row.frame_ms,
            row.ratio_to_base,
            row.samples_per_ray,
            row.reads_per_ray,
            row.oracle_ratio,
            optional(row.update_ms),
            optional(row.update_ms_voxels),
            row.bytes as f64 / 1024.0,
        ));
    }
    lines.join("\n")
}

/// The charts of DM Fig. 3 and Fig. 5 for each volume and transfer function.
fn plot(folder: &Path, rows: &[Row]) -> Result<(), Failure> {
    let same_case = |a: &Row, b: &Row| (&a.volume, &a.transfer_name) == (&b.volume, &b.transfer_name);
    for rows in rows.chunk_by(same_case) {
        let [Row { volume, transfer_name, .. }, ..] = rows else { continue };
        let of_structures =
            |y: fn(&Row) -> Option<f64>| STRUCTURES.map(|structure| line(rows, structure, "", y));
        let path = |what: &str| file_in(folder, &format!("{volume}-{transfer_name}-{what}.svg"));
        let x = "side of a block (voxels)";
        even_chart(
            &path("speed-up"),
            &Labels {
                title: &format!("{volume}, {transfer_name}"),
                x,
                y: "speed-up over taking every sample",
            },
            &of_structures(|row| Some(row.ratio_to_base)),
        )?;
        let mut updates = Vec::from(of_structures(|row| row.update_ms));
        updates.push(line(rows, Structure::Distance, " by voxels", |row| row.update_ms_voxels));
        updates.retain(|line| !line.points.is_empty());
        logarithmic_chart(
            &path("update"),
            &Labels { title: &format!("{volume}, {transfer_name}"), x, y: "time of an update (ms)" },
            &updates,
        )?;
    }
    Ok(())
}

/// A number over the block size, of the rows of a structure that have one.
fn line(rows: &[Row], structure: Structure, suffix: &str, y: fn(&Row) -> Option<f64>) -> Line {
    let of_structure = rows.iter().filter(|row| row.variant.structure == Some(structure));
    let mut points: Vec<(f64, f64)> =
        of_structure.filter_map(|row| Some((f64::from(row.variant.side()?), y(row)?))).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    Line { name: format!("{}{suffix}", structure_name(structure)), points }
}
