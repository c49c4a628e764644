//! What the process holds: memory, and objects on the device.

use serde::Serialize;

/// What is held at one time.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct Held {
    /// Bytes of the process in memory; none where the system does not tell.
    process_bytes: Option<u64>,
    /// Bytes that are reserved on the device; none where the backend does not tell.
    device_bytes: Option<u64>,
    /// Objects on the device.
    pipelines: isize,
    buffers: isize,
    bind_groups: isize,
}

impl Held {
    pub(crate) fn now(device: &wgpu::Device) -> Self {
        let objects = device.get_internal_counters().hal;
        Self {
            process_bytes: resident_bytes(),
            device_bytes: device.generate_allocator_report().map(|report| report.total_reserved_bytes),
            pipelines: objects.compute_pipelines.read() + objects.render_pipelines.read(),
            buffers: objects.buffers.read(),
            bind_groups: objects.bind_groups.read(),
        }
    }
}

fn resident_bytes() -> Option<u64> {
    const PAGE_BYTES: u64 = 4096;
    let text = std::fs::read_to_string("/proc/self/statm").ok()?;
    text.split_whitespace().nth(1)?.parse::<u64>().ok().map(|pages| pages * PAGE_BYTES)
}
