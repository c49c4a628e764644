//! `doctor`: adapters, what they can do, and what Wheatstone will use.

use crate::failure::Failure;
use crate::output::{print, print_json};
use crate::skipping::{StructureBytes, described, gradient_map_bytes, structures};
use clap::Args;
use serde_json::{Value, json};
use wheatstone_core::volume::StorageKind;
use wheatstone_render::gpu::adapters;
use wheatstone_render::{AdapterDescription, Gpu, GpuError};

/// Show GPU adapters, their features and limits, and what Wheatstone will use and why.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  wheatstone doctor\n  wheatstone doctor --json")]
pub(crate) struct DoctorArgs {
    /// Print one JSON object on standard output.
    #[arg(long)]
    json: bool,
}

/// The volume whose structures of empty-space skipping are told.
const EXAMPLE_DIMS: [usize; 3] = [512; 3];

/// What `--backend auto` comes to.
struct Choice {
    uses: &'static str,
    why: String,
}

/// Runs the command.
pub(crate) fn run(args: &DoctorArgs) -> Result<(), Failure> {
    let adapters = adapters();
    let choice = choose(Gpu::open_best().map(|gpu| gpu.description().clone()));
    let threads = rayon::current_num_threads();
    if args.json {
        return print_json(&json!({
            "version": env!("CARGO_PKG_VERSION"),
            "adapters": adapters.iter().map(adapter_json).collect::<Vec<_>>(),
            "cpu_threads": threads,
            "uses": choice.uses,
            "why": choice.why,
            "structures": structures(EXAMPLE_DIMS, StorageKind::U8).into_iter().map(StructureBytes::to_json).collect::<Vec<_>>(),
            "gradient_map_bytes": gradient_map_bytes(EXAMPLE_DIMS, StorageKind::U8),
        }));
    }
    let mut lines: Vec<String> = adapters.iter().map(adapter_text).collect();
    if adapters.is_empty() {
        lines.push("no GPU adapter found".to_owned());
    }
    lines.push(format!("CPU renderer: {threads} threads"));
    lines.push(format!("--backend auto uses {}: {}", choice.uses, choice.why));
    let [x, y, z] = EXAMPLE_DIMS;
    let structures = described(&structures(EXAMPLE_DIMS, StorageKind::U8));
    lines.push(format!("empty space in {x}×{y}×{z} 8-bit voxels: {structures}"));
    let mebibytes = gradient_map_bytes(EXAMPLE_DIMS, StorageKind::U8) >> 20;
    lines.push(format!("gradient map of it, for 2D transfer functions: {mebibytes} MiB"));
    print(&lines.join("\n"))
}

fn choose(opened: Result<AdapterDescription, GpuError>) -> Choice {
    match opened {
        Ok(adapter) if adapter.is_software => Choice {
            uses: "cpu or software gpu",
            why: format!(
                "{} runs on the CPU; it takes large jobs, the CPU renderer small ones, because it starts at once",
                adapter.name
            ),
        },
        Ok(adapter) => Choice { uses: "gpu", why: format!("{} is the best adapter", adapter.name) },
        Err(error) => Choice { uses: "cpu", why: error.to_string() },
    }
}

fn adapter_json(adapter: &AdapterDescription) -> Value {
    let can = &adapter.capabilities;
    json!({
        "name": adapter.name,
        "driver": adapter.driver,
        "api": adapter.backend,
        "is_software": adapter.is_software,
        "tier": can.tier().name(),
        "features": {
            "16bit_norm": can.has_16bit_norm,
            "f32_filtering": can.has_f32_filtering,
            "timestamps": can.has_timestamps,
        },
        "limits": {
            "largest_3d_side": can.largest_3d_side,
            "largest_2d_side": can.largest_2d_side,
            "largest_storage_binding": can.largest_storage_binding,
            "largest_texture": (can.largest_texture != u64::MAX).then_some(can.largest_texture),
        },
    })
}

fn adapter_text(adapter: &AdapterDescription) -> String {
    let can = &adapter.capabilities;
    let yes_no = |b: bool| if b { "yes" } else { "no" };
    let texture = match can.largest_texture {
        u64::MAX => "not reported".to_owned(),
        bytes => format!("{} MiB", bytes >> 20),
    };
    format!(
        "{} ({})\n  driver               {}\n  runs on              {}\n  tier                 {}\n  \
         16-bit textures      {}\n  f32 filtering        {}\n  timestamps           {}\n  \
         3D texture sides     up to {}\n  picture sides        up to {}\n  \
         storage binding      up to {} MiB\n  largest texture      {texture}",
        adapter.name,
        adapter.backend,
        adapter.driver,
        if adapter.is_software { "CPU (software)" } else { "GPU" },
        can.tier().name(),
        yes_no(can.has_16bit_norm),
        yes_no(can.has_f32_filtering),
        yes_no(can.has_timestamps),
        can.largest_3d_side,
        can.largest_2d_side,
        can.largest_storage_binding >> 20,
    )
}
