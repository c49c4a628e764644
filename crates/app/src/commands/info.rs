//! `info`: what a volume file holds.

use crate::failure::Failure;
use crate::output::{print, print_json};
use crate::skipping::{StructureBytes, described, gradient_map_bytes, structures};
use crate::volume_args::VolumeArgs;
use clap::Args;
use serde_json::{Map, Value, json};
use wheatstone_core::volume::{Statistics, StorageKind, Volume};
use wheatstone_io::Loaded;

/// Percentiles that are listed.
const PERCENTILES: [f64; 9] = [0.1, 1.0, 5.0, 25.0, 50.0, 75.0, 95.0, 99.0, 99.9];

/// Show what a volume file holds: size, type, orientation and distribution of values.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone info head.nii.gz\n  \
    wheatstone info ct.nrrd --json\n  \
    wheatstone info scan.raw --raw-size 64x64x32 --raw-type int16 --raw-spacing 0.5,0.5,2")]
pub(crate) struct InfoArgs {
    /// Print one JSON object on standard output.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    volume: VolumeArgs,
}

/// Runs the command.
pub(crate) fn run(args: &InfoArgs) -> Result<(), Failure> {
    let loaded = args.volume.load()?;
    let statistics = loaded.volume.statistics();
    if args.json {
        print_json(&as_json(args, &loaded, &statistics))
    } else {
        print(&as_text(&loaded, &statistics))
    }
}

fn as_json(args: &InfoArgs, loaded: &Loaded, statistics: &Statistics) -> Value {
    let volume = &loaded.volume;
    let grid = volume.grid();
    let percentiles: Map<String, Value> =
        PERCENTILES.iter().map(|&p| (p.to_string(), json!(statistics.percentile(p)))).collect();
    let robust = statistics.robust_window();
    let warnings: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
    json!({
        "file": args.volume.file.display().to_string(),
        "format": loaded.format.to_string(),
        "dims": grid.dims(),
        "type": volume.voxels().voxel_type().name(),
        "spacing_mm": grid.spacing_mm().to_array(),
        "size_mm": grid.size_mm().to_array(),
        "orientation": grid.orientation_letters(),
        "range": [volume.range().0, volume.range().1],
        "mean": statistics.mean(),
        "percentiles": percentiles,
        "robust_window": [robust.lo(), robust.hi()],
        "non_finite_voxels": volume.non_finite_count(),
        "structures": structures(grid.dims(), StorageKind::lossless_for(volume)).into_iter().map(StructureBytes::to_json).collect::<Vec<_>>(),
        "gradient_map_bytes": gradient_map_bytes(grid.dims(), StorageKind::lossless_for(volume)),
        "warnings": warnings,
    })
}

fn as_text(loaded: &Loaded, statistics: &Statistics) -> String {
    let volume: &Volume = &loaded.volume;
    let grid = volume.grid();
    let [width, height, depth] = grid.dims();
    let mebibytes = volume.voxels().as_bytes().len() as f64 / f64::from(1 << 20);
    let [sx, sy, sz] = grid.spacing_mm().to_array().map(short);
    let [mx, my, mz] = grid.size_mm().to_array().map(short);
    let robust = statistics.robust_window();
    let storage = StorageKind::lossless_for(volume);
    let percentiles: Vec<String> =
        PERCENTILES.iter().map(|&p| format!("{p} %: {}", short(statistics.percentile(p)))).collect();
    [
        format!("format         {}", loaded.format),
        format!("dims           {width} × {height} × {depth}"),
        format!("type           {} ({mebibytes:.1} MiB)", volume.voxels().voxel_type()),
        format!("spacing        {sx} × {sy} × {sz} mm"),
        format!("size           {mx} × {my} × {mz} mm"),
        format!("orientation    {}", grid.orientation_letters()),
        format!("range          {} .. {}", short(volume.range().0), short(volume.range().1)),
        format!("mean           {}", short(statistics.mean())),
        format!("percentiles    {}", percentiles.join(", ")),
        format!("robust window  {} .. {}", short(robust.lo()), short(robust.hi())),
        format!("empty space    {}", described(&structures(grid.dims(), storage))),
        format!(
            "gradient map   {} KiB, for 2D transfer functions",
            gradient_map_bytes(grid.dims(), storage) / 1024
        ),
    ]
    .join("\n")
}

/// A number to six significant digits, without trailing zeros.
fn short(x: f64) -> String {
    let magnitude = x.abs();
    if magnitude != 0.0 && !(1e-4..1e9).contains(&magnitude) {
        return format!("{x:.5e}");
    }
    let decimals = if magnitude >= 1.0 { 5 - magnitude.log10().floor().clamp(0.0, 5.0) as usize } else { 6 };
    let text = format!("{x:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn numbers_are_short() {
        for (x, text) in [
            (0.0, "0"),
            (1.0, "1"),
            (-1024.0, "-1024"),
            (0.9375, "0.9375"),
            (123.456789, "123.457"),
            (100_000.0, "100000"),
            (1e-7, "1.00000e-7"),
            (1e30, "1.00000e30"),
        ] {
            assert_eq!(short(x), text);
        }
    }
}
