//! How the GPU's pictures compare with the reference's: colours, depths and sample counts.

use crate::device::on_device;
use crate::scene::*;
use crate::tolerance;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::metrics::compare;
use wheatstone_core::reference::Cast;
use wheatstone_core::scene::Settings;
use wheatstone_core::view::View;
use wheatstone_core::volume::Volume;
use wheatstone_render::{Gpu, Renderer, TexelFormat};

/// A picture that both casters make.
pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) format: TexelFormat,
    pub(crate) settings: Settings,
    pub(crate) view: View,
}

/// The worst of a list of cases, and those that fail.
#[derive(Default)]
pub(crate) struct Report {
    cases: usize,
    dssim: (f64, String),
    max_abs: (f64, String),
    failures: Vec<String>,
}

impl Report {
    pub(crate) fn run(&mut self, gpu: &Gpu, renderer: &mut Renderer, volume: &Volume, case: &Case) {
        let parameters = CastParameters::new(&case.settings, &placement(volume));
        let views = std::slice::from_ref(&case.view);
        let cpu = cast_on_cpu(volume, case.format, &parameters, views).remove(0);
        let gpu = match cast_on_gpu(gpu, renderer, volume, case.format, &case.settings, views) {
            Ok(mut casts) => casts.remove(0),
            Err(error) => return self.failures.push(format!("{}: {error}", case.name)),
        };
        self.compare(volume, case, &cpu, &gpu);
    }

    pub(crate) fn compare(&mut self, volume: &Volume, case: &Case, cpu: &Cast, gpu: &Cast) {
        let name = &case.name;
        let black = |cast: &Cast| cast.image.over_background([0.0; 3]);
        let found = compare(&black(cpu), &black(gpu)).unwrap();
        self.cases += 1;
        for (worst, value) in [(&mut self.dssim, found.dssim()), (&mut self.max_abs, found.max_abs)] {
            if value > worst.0 {
                *worst = (value, name.clone());
            }
        }
        let dssim = found.dssim();
        if dssim.is_nan() || dssim > tolerance::dssim(case.format) {
            self.failures.push(format!("{name}: DSSIM {dssim:.6}, largest difference {:.4}", found.max_abs));
        }
        let slack = (tolerance::samples(case.format) * cpu.samples as f64) as u64
            + tolerance::SAMPLES_OF_TINY_PICTURE;
        if cpu.samples.abs_diff(gpu.samples) > slack {
            self.failures
                .push(format!("{name}: {} samples on the CPU, {} on the GPU", cpu.samples, gpu.samples));
        }
        let step_m = placement(volume).voxel_length_m() / f64::from(case.settings.sampling_factor);
        let is_other_hit = |&(a, b): &(f32, f32)| {
            a.is_finite() != b.is_finite()
                || (a.is_finite() && f64::from((a - b).abs()) > tolerance::DEPTH_STEPS * step_m)
        };
        let others = cpu
            .image
            .depth_m
            .iter()
            .copied()
            .zip(gpu.image.depth_m.iter().copied())
            .filter(is_other_hit)
            .count();
        let pixels = cpu.image.depth_m.len();
        if others as f64 > tolerance::share_of_other_hits(case.format) * pixels as f64 {
            self.failures.push(format!("{name}: {others} of {pixels} pixels hit something else"));
        }
    }

    pub(crate) fn finish(self, group: &str) {
        eprintln!(
            "{group}: {} cases, worst DSSIM {:.2e} ({}), largest difference {:.4} ({})",
            self.cases, self.dssim.0, self.dssim.1, self.max_abs.0, self.max_abs.1
        );
        assert!(self.cases > 0 && self.failures.is_empty(), "{group}:\n{}", self.failures.join("\n"));
    }
}

/// Checks a list of cases of one volume.
pub(crate) fn check(group: &str, volume: &Volume, cases: Vec<Case>) {
    on_device(|gpu, renderer| {
        let mut report = Report::default();
        for case in &cases {
            report.run(gpu, renderer, volume, case);
        }
        report.finish(group);
    });
}
