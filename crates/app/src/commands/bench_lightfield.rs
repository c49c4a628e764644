//! `bench lightfield`: what deriving views of light-field displays from a few casts saves and how far they are off, what the
//! display of projectors of LF takes with and without regard to what it resolves, and what eyes before it see.

mod charts;
mod eyes;
mod full_frame;
mod row;
mod views;

use super::bench::{Device, Opened, open};
use crate::backend::Engine;
use crate::camera::AimArgs;
use crate::failure::Failure;
use crate::output::{make_folder, print, print_json};
use crate::skipping::{SkipArgs, SkipName, Skipping};
use crate::spec;
use crate::transfer_spec::{self, Resolved, TransferSpec};
use clap::Args;
use full_frame::FullFrame;
use glam::{DAffine3, DVec3};
use row::Row;
use serde_json::json;
use std::path::PathBuf;
use views::Measurement;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::lightfield::projectors::{Description, Packing};
use wheatstone_core::lightfield::quilt::Model;
use wheatstone_core::lightfield::{ProjectorArray, QuiltDisplay};
use wheatstone_core::scene::{Settings, Shading};
use wheatstone_core::transfer::BenchmarkRamp;
use wheatstone_core::volume::{StorageKind, Volume};
use wheatstone_render::Gpu;

/// Time and error of the views of a quilt from anchors against a cast for each, and of a full frame of projectors.
///
/// Views are those of a Looking Glass Portrait, as many as are asked for over its whole view cone, of a volume that fills the screen.
/// Both methods make all views in turn, in changing order; times are medians. Before that, untimed, each view is made by both, for the
/// error: DSSIM over the views. Then the display of Agus et al. 2008 is cast, at full resolution and at its own: its time, and
/// what eyes at and around the place that it is made for see, against a perspective view from there. GPU only; that includes
/// software Vulkan.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone bench lightfield bonsai.nii.gz --up A --json\n  \
    wheatstone bench lightfield bonsai.nii.gz mni152_t1_1mm.nii.gz --views 48 --shadings none,phong --plot plots\n  \
    wheatstone bench lightfield beetle:128 --views 1,8,48,100 --scale 4 --projector-scale 4")]
pub(crate) struct LightfieldArgs {
    /// Volume files, or phantoms with their size.
    #[arg(value_name = "FILE|PHANTOM:N", required = true)]
    volumes: Vec<String>,

    /// Transfer function [default: the (first) ramp of the benchmark volume of the name, else auto].
    #[arg(long, value_name = "SPEC", value_parser = transfer_spec::parse)]
    tf: Option<TransferSpec>,

    /// Numbers of views.
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',', default_value = "1,8,24,48,100", value_parser = clap::value_parser!(u32).range(1..=1024))]
    views: Vec<u32>,

    /// How many times smaller the sides of a view are than 420x560 pixels.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=32), allow_negative_numbers = true)]
    scale: u32,

    /// Shadings.
    #[arg(long, value_name = "SHADINGS", value_delimiter = ',', default_value = "none,phong", value_parser = spec::shading)]
    shadings: Vec<Shading>,

    /// How many views are cast [default: as many as it takes].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024), allow_negative_numbers = true)]
    anchors: Option<u32>,

    /// How often everything is timed.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000), allow_negative_numbers = true)]
    rounds: u32,

    /// How many times smaller the sides of the projectors' pictures are than 320x240 pixels; 0 leaves the projectors out.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(0..=32), allow_negative_numbers = true)]
    projector_scale: u32,

    #[command(flatten)]
    aim: AimArgs,

    #[command(flatten)]
    skip: SkipArgs,

    /// Write charts to this folder: speed-up over the number of views, error over the views, and over the place of an eye before the
    /// projectors.
    #[arg(long, value_name = "DIR")]
    plot: Option<PathBuf>,

    /// Print one JSON object on standard output instead of a table.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(crate) fn run(args: &LightfieldArgs) -> Result<(), Failure> {
    let skipping = args.skip.resolve(SkipName::Auto)?;
    args.plot.iter().try_for_each(|folder| make_folder(folder))?;
    let (mut rows, mut full_frames, mut device) = (Vec::new(), Vec::new(), None);
    for volume in &args.volumes {
        device = Some(args.measure_volume(volume, &skipping, &mut rows, &mut full_frames)?);
    }
    if let Some(folder) = &args.plot {
        charts::draw_speed_ups(folder, &rows)?;
        charts::draw_errors(folder, &rows)?;
        charts::draw_eyes(folder, &full_frames)?;
    }
    if args.json {
        return print_json(&json!({
            "device": device.as_ref().map(Device::to_json),
            "view_size": args.display(1).tile_size_px(),
            "rounds": args.rounds,
            "rows": rows.iter().map(Row::to_json).collect::<Vec<_>>(),
            "full_frames": full_frames.iter().map(FullFrame::to_json).collect::<Vec<_>>(),
        }));
    }
    let mut tables: Vec<String> = device.iter().map(Device::to_string).collect();
    tables.push(row::to_table(&rows));
    if !full_frames.is_empty() {
        tables.push(full_frame::to_table(&full_frames));
        tables.push(eyes::to_table(&full_frames));
    }
    print(&tables.join("\n\n"))
}

impl LightfieldArgs {
    /// A portrait display of so many views.
    fn display(&self, views: u32) -> QuiltDisplay {
        let portrait = Model::Portrait.display();
        let [width, height] = portrait.tile_size_px().map(|side| (side / self.scale).max(1));
        QuiltDisplay { columns: views, rows: 1, quilt_size_px: [views * width, height], ..portrait }
    }

    /// The projectors of LF with pixels that are so many times as wide: those resolve as much less on the screen.
    fn projectors(&self) -> Result<ProjectorArray, Failure> {
        let full = ProjectorArray::of_paper();
        let description = full.description();
        let [width, height] = description.image_size_px.map(|side| (side / self.projector_scale).max(1));
        let header_rows = 1;
        ProjectorArray::new(Description {
            pixel_size_m: description.pixel_size_m * f64::from(self.projector_scale),
            image_size_px: [width, height],
            // Nothing is packed: a frame for each.
            packing: Packing { frame_size_px: [width, height + header_rows], header_rows },
            ..description.clone()
        })
        .map_err(Failure::input)
    }

    fn measure_volume(
        &self,
        described: &str,
        skipping: &Skipping,
        rows: &mut Vec<Row>,
        full_frames: &mut Vec<FullFrame>,
    ) -> Result<Device, Failure> {
        let Opened { mut volume, name, benchmark } = open(described)?;
        let transfer = self.tf.clone().unwrap_or_else(|| {
            BenchmarkRamp::of_volume(&benchmark)
                .next()
                .map_or(TransferSpec::Automatic, TransferSpec::Benchmark)
        });
        let resolved = transfer.resolve(&volume, None)?;
        volume.fill_non_finite(resolved.window.lo());
        let placement = self.aim.placement(&volume);
        let mut engine = Engine::gpu(Gpu::open_best()?, &volume, StorageKind::lossless_for(&volume))?;
        for &shading in &self.shadings {
            let settings = Settings { shading, ..Settings::new(resolved.window, resolved.transfer.clone()) };
            let parameters = CastParameters::new(&settings, &placement);
            let shot = engine.prepare(&parameters, skipping)?;
            for &count in &self.views {
                let display = self.display(count);
                let turned = self.aim.orbit(0.0, 0.0).view_from_world();
                let corners =
                    parameters.visible_corners_world().map(|corner| turned.transform_point3(corner));
                let fitting = display.largest_scale(corners, 0.0);
                let display_from_world = DAffine3::from_scale(DVec3::splat(fitting)) * turned;
                let measurement = Measurement {
                    volume: &name,
                    shading: spec::shading_name(shading),
                    display,
                    display_from_world,
                    anchors: self.anchors,
                    rounds: self.rounds,
                };
                rows.extend(measurement.rows(&mut engine, shot)?);
            }
        }
        let device = Device::of(&engine);
        drop(engine);
        if self.projector_scale > 0 {
            full_frames.extend(self.measure_full_frame(&name, &volume, &resolved, skipping)?);
        }
        Ok(device)
    }

    fn measure_full_frame(
        &self,
        name: &str,
        volume: &Volume,
        resolved: &Resolved,
        skipping: &Skipping,
    ) -> Result<Vec<FullFrame>, Failure> {
        let has_levels = !resolved.transfer.is_2d();
        if !has_levels {
            eprintln!(
                "note: {name} at full resolution only: levels have transfer functions of one dimension"
            );
        }
        let settings = Settings::new(resolved.window, resolved.transfer.clone());
        let parameters = CastParameters::new(&settings, &self.aim.placement(volume));
        let turned = self.aim.orbit(0.0, 0.0).view_from_world();
        full_frame::measure(&full_frame::Stage {
            volume,
            name,
            parameters: &parameters,
            skipping,
            turned,
            array: &self.projectors()?,
            has_levels,
            rounds: self.rounds,
        })
    }
}
