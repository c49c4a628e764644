//! One device for all tests of this binary.

use std::sync::{Mutex, OnceLock, PoisonError};
use wheatstone_render::{Gpu, Renderer};

static DEVICE: OnceLock<(Gpu, Mutex<Renderer>)> = OnceLock::new();

/// Runs a test on the shared device and renderer, one test at a time.
pub(crate) fn on_device(test: impl FnOnce(&Gpu, &mut Renderer)) {
    if std::env::var("WHEATSTONE_SKIP_GPU_TESTS").is_ok_and(|value| value == "1") {
        eprintln!("skipped: WHEATSTONE_SKIP_GPU_TESTS=1");
        return;
    }
    let (gpu, renderer) = DEVICE.get_or_init(|| {
        let gpu = Gpu::open_software().or_else(|_| Gpu::open_best()).unwrap_or_else(|error| {
            panic!("{error}; WHEATSTONE_SKIP_GPU_TESTS=1 skips the tests that need one")
        });
        eprintln!("{} ({})", gpu.description().name, gpu.description().driver);
        let renderer = Mutex::new(Renderer::new(&gpu).unwrap());
        (gpu, renderer)
    });
    // A failed test says nothing about the renderer.
    test(gpu, &mut renderer.lock().unwrap_or_else(PoisonError::into_inner));
}
