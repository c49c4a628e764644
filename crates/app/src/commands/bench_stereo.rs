//! `bench stereo`: what a pair from one cast saves and how far the derived eye is off, by the protocol of SP §5 (VR §6.1).

mod charts;
mod error_pictures;
mod eyes;
mod layers;
mod row;
mod turn;

use super::bench::{Device, Opened, default_transfer, open};
use crate::backend::Engine;
use crate::camera::Up;
use crate::failure::Failure;
use crate::output::{make_folder, print, print_json};
use crate::pairing::{Eye, FormName, Pairing, QualityName};
use crate::progress::Bar;
use crate::skipping::{SkipArgs, SkipName, Skipping};
use crate::spec;
use crate::transfer_spec::{self, TransferSpec};
use clap::{Args, ValueEnum};
use eyes::{Distance, Eyes};
use layers::{LayersRow, Sweep};
use row::Row;
use serde_json::json;
use std::path::PathBuf;
use turn::{Turn, measure};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::scene::{Placement, Settings, Shading};
use wheatstone_core::view::world_from_patient;
use wheatstone_core::volume::StorageKind;
use wheatstone_render::Gpu;

/// Samples per voxel length: a step is half a voxel.
const SAMPLING_FACTOR: f32 = 2.0;

/// Time and error of stereo pairs from one cast against two casts, by the protocol of Buchacher and Erdt 2017.
///
/// The eyes are 0.065 m apart, look in parallel, have a field of view of 110 degrees, and turn once about the volume's
/// vertical axis. Steps are half a voxel long; rays end at an opacity of 0.99. Each frame is made in every way in turn, in changing
/// order, three times in a row, of which the fastest counts. The left eye is cast, the right one derived. GPU only; that includes software Vulkan.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone bench stereo bonsai.nii.gz box:256 --up A\n  \
    wheatstone bench stereo box:128 --size 384x384 --frames 4 --shading-samples 0,16 --distance near --json\n  \
    wheatstone bench stereo engine.nii.gz --up A --plot plots --layers-sweep --error-pictures errors")]
pub(crate) struct StereoBenchArgs {
    /// Volume files, or phantoms with their size.
    #[arg(value_name = "FILE|PHANTOM:N", required = true)]
    volumes: Vec<String>,

    /// Transfer function [default: the (first) ramp of the benchmark volume of the name, else ramp:0..1].
    #[arg(long, value_name = "SPEC", value_parser = transfer_spec::parse)]
    tf: Option<TransferSpec>,

    /// Width and height of each eye's picture, pixels.
    #[arg(long, value_name = "WxH", default_value = "768x768", value_parser = spec::picture_size)]
    size: [u32; 2],

    /// Frames of the turn; one of each kind that is not timed comes first.
    #[arg(long, value_name = "N", default_value_t = 50, value_parser = clap::value_parser!(u32).range(1..=10_000), allow_negative_numbers = true)]
    frames: u32,

    /// Shadings by the samples that each takes: multiples of 4, 4 for each direction.
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',', default_value = "0,4,8,16,32,64", value_parser = spec::shading_of_samples)]
    shading_samples: Vec<Shading>,

    /// Shadings by name instead.
    #[arg(long, value_name = "SHADINGS", value_delimiter = ',', value_parser = spec::shading, conflicts_with = "shading_samples")]
    shadings: Vec<Shading>,

    /// Distances from the eyes to the sphere around a cube of 1 m, metres; near is where its picture takes --layers layers.
    #[arg(long, value_name = "DISTANCES", value_delimiter = ',', default_value = "near,1.2", value_parser = eyes::distance)]
    distance: Vec<Distance>,

    /// Layers of the near distance.
    #[arg(long, value_name = "N", default_value_t = 32, value_parser = clap::value_parser!(u32).range(1..=1024), allow_negative_numbers = true)]
    layers: u32,

    /// Ways to make a pair of one cast [default: all].
    #[arg(long, value_name = "METHODS", value_enum, value_delimiter = ',')]
    methods: Vec<FormName>,

    /// Qualities of the derived eye; only strips are repaired, and volumetric is fast alone [default: fast,repaired].
    #[arg(long, value_name = "QUALITIES", value_enum, value_delimiter = ',')]
    qualities: Vec<QualityName>,

    #[command(flatten)]
    skip: SkipArgs,

    /// Which patient direction points up; A gives a plain array's +y.
    #[arg(long, value_enum, ignore_case = true, default_value_t = Up::S)]
    up: Up,

    /// Measure clearing and compositing for 16 to 64 layers, too, at pictures of these sides.
    #[arg(long, value_name = "SIDES", value_delimiter = ',', num_args = 0..=1, require_equals = true, default_missing_value = "512,768,1024", value_parser = clap::value_parser!(u32).range(1..=8192))]
    layers_sweep: Vec<u32>,

    /// Write charts to this folder: the speed-up over the samples of shading, times over the number of layers.
    #[arg(long, value_name = "DIR")]
    plot: Option<PathBuf>,

    /// Write the worst frame of each row to this folder: the derived eye, its own cast, and where they differ.
    #[arg(long, value_name = "DIR")]
    error_pictures: Option<PathBuf>,

    /// Print one JSON object on standard output instead of a table.
    #[arg(long)]
    json: bool,
}

/// Everything that was measured.
#[derive(Default)]
struct Measured {
    device: Option<Device>,
    rows: Vec<Row>,
    layers: Vec<LayersRow>,
}

/// Runs the command.
pub(crate) fn run(args: &StereoBenchArgs) -> Result<(), Failure> {
    let skipping = args.skip.resolve(SkipName::Auto)?;
    [&args.plot, &args.error_pictures].into_iter().flatten().try_for_each(|folder| make_folder(folder))?;
    let pairings = args.pairings()?;
    let mut measured = Measured::default();
    for volume in &args.volumes {
        args.measure_volume(volume, &skipping, &pairings, &mut measured)?;
    }
    if let Some(folder) = &args.plot {
        charts::draw_speed_ups(folder, &measured.rows)?;
        charts::draw_layers(folder, &measured.layers)?;
    }
    if args.json {
        return print_json(&json!({
            "device": measured.device.as_ref().map(Device::to_json),
            "size": args.size,
            "frames": args.frames,
            "rows": measured.rows.iter().map(Row::to_json).collect::<Vec<_>>(),
            "layers": measured.layers.iter().map(LayersRow::to_json).collect::<Vec<_>>(),
        }));
    }
    let mut tables: Vec<String> = measured.device.iter().map(Device::to_string).collect();
    tables.push(row::to_table(&measured.rows));
    if !measured.layers.is_empty() {
        tables.push(layers::to_table(&measured.layers));
    }
    print(&tables.join("\n"))
}

impl StereoBenchArgs {
    fn measure_volume(
        &self,
        described: &str,
        skipping: &Skipping,
        pairings: &[Pairing],
        measured: &mut Measured,
    ) -> Result<(), Failure> {
        let Opened { volume, name, benchmark } = open(described)?;
        let transfer = self.tf.clone().unwrap_or_else(|| default_transfer(&benchmark));
        let resolved = transfer.resolve(&volume, None)?;
        let placement = Placement::new(&volume, world_from_patient(volume.grid(), self.up.direction()));
        let parameters = |shading| {
            let settings = Settings {
                shading,
                sampling_factor: SAMPLING_FACTOR,
                ..Settings::new(resolved.window, resolved.transfer.clone())
            };
            CastParameters::new(&settings, &placement)
        };
        let mut engine = Engine::gpu(Gpu::open_best()?, &volume, StorageKind::lossless_for(&volume))?;
        let eyes = Eyes { size: self.size };
        let shadings = if self.shadings.is_empty() { &self.shading_samples } else { &self.shadings };
        let bar = Bar::new(
            name.clone(),
            self.distance.len() as u64 * shadings.len() as u64 * self.frames_of_turn(),
        );
        for &distance in &self.distance {
            let distance_m = distance.metres(&eyes, self.layers)?;
            for &shading in shadings {
                let parameters = parameters(shading);
                let shot = engine.prepare(&parameters, skipping)?;
                let turn = Turn {
                    name: &format!("{name} at {distance_m:.2} m, {}", spec::shading_name(shading)),
                    eyes,
                    distance_m,
                    frames: self.frames,
                    keeps_worst: self.error_pictures.is_some(),
                };
                for tally in measure(&mut engine, shot, &turn, pairings, &bar)? {
                    let row = Row::new(&name, distance_m, &parameters, &tally);
                    if let (Some(folder), Some(worst)) = (&self.error_pictures, &tally.worst) {
                        error_pictures::write(folder, &row, worst)?;
                    }
                    measured.rows.push(row);
                }
            }
        }
        if !self.layers_sweep.is_empty() {
            let shot = engine.prepare(&parameters(Shading::None), skipping)?;
            let bar = Bar::new("layers", self.layers_sweep.len() as u64 * layers::counts().count() as u64);
            for &side in &self.layers_sweep {
                let sweep = Sweep { volume: &name, eyes: Eyes { size: [side; 2] }, frames: self.frames };
                measured.layers.extend(layers::measure(&mut engine, shot, &sweep, pairings, &bar)?);
            }
        }
        measured.device = Some(Device::of(&engine));
        Ok(())
    }

    /// Frames of a turn with the one that is not timed.
    fn frames_of_turn(&self) -> u64 {
        u64::from(self.frames) + 1
    }

    /// What is asked for and can be made, with a note of what is asked for by name and cannot.
    fn pairings(&self) -> Result<Vec<Pairing>, Failure> {
        let forms = if self.methods.is_empty() { FormName::value_variants() } else { &self.methods };
        let qualities = if self.qualities.is_empty() {
            &[QualityName::Fast, QualityName::Repaired][..]
        } else {
            &self.qualities
        };
        let of_form =
            |&form| qualities.iter().map(move |&quality| Pairing { form, quality, reference: Eye::Left });
        let can_be_made = |pairing: &Pairing| pairing.form.makes(pairing.quality);
        let (made, left_out): (Vec<_>, Vec<_>) = forms.iter().flat_map(of_form).partition(can_be_made);
        if let ([], [Pairing { quality, .. }, ..]) = (&made[..], &left_out[..]) {
            return Err(Failure::input(format!("--qualities {}: {}", quality.name(), quality.why_not())));
        }
        for quality in &self.qualities {
            let of_quality = left_out.iter().filter(|pairing| pairing.quality == *quality);
            let names: Vec<&str> = of_quality.map(|pairing| pairing.form.name()).collect();
            if !names.is_empty() {
                let names = names.join(", ");
                eprintln!("note: {}: {} {names} left out", quality.why_not(), quality.name());
            }
        }
        Ok(made)
    }
}
