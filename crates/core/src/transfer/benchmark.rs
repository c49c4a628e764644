//! The ramps that benchmark volumes are measured with.

use super::{TransferError, TransferFunction};
use crate::volume::Window;

/// Voxels along the side of a volume that gradient bounds and opacities are given for.
const SIDE: f32 = 256.0;

/// A grey ramp (DM Eq. 16) that a benchmark volume is shown with, by name.
///
/// `present`, `beetle` and `snake` are phantoms, which stand in for DM's volumes; `-1d` and `-2d` are the rows of DM Table 2,
/// with the bounds at which the phantoms are as occupied. Surfaces of a finer phantom are as thick as before, so that
/// gradients per voxel are smaller: the bounds of gradients go with the size. `box` is SP's solid box, a homogeneous
/// translucent medium: a finer one is as opaque as a whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BenchmarkRamp {
    name: &'static str,
    values: [f32; 2],
    gradients_at_256: Option<[f32; 2]>,
    /// At the end of the ramp.
    opacity_at_256: f32,
    occupancy: Option<f64>,
}

impl BenchmarkRamp {
    /// Every ramp.
    pub const ALL: &[Self] = &[
        Self::of_phantom("present-1d", [0.071, 1.0], None, 0.0713),
        Self::of_phantom("present-2d", [0.071, 1.0], Some([0.06, 0.1]), 0.0185),
        Self::of_phantom("beetle-1d", [0.086, 1.0], None, 0.0397),
        Self::of_phantom("beetle-2d", [0.086, 1.0], Some([0.1, 0.3]), 0.0131),
        Self::of_phantom("snake-1d", [0.4, 0.8], None, 0.0067),
        Self::of_phantom("snake-2d", [0.3, 0.8], Some([0.06, 0.12]), 0.0055),
        Self { opacity_at_256: 0.02, ..Self::of_scan("box", 0.0) },
        Self::of_scan("bonsai", 0.15),
        Self::of_scan("engine", 0.3),
        Self::of_scan("heptane", 0.1),
    ];

    const fn of_phantom(
        name: &'static str,
        values: [f32; 2],
        gradients_at_256: Option<[f32; 2]>,
        occupancy: f64,
    ) -> Self {
        Self { name, values, gradients_at_256, opacity_at_256: 1.0, occupancy: Some(occupancy) }
    }

    const fn of_scan(name: &'static str, v0: f32) -> Self {
        Self { name, values: [v0, 1.0], gradients_at_256: None, opacity_at_256: 1.0, occupancy: None }
    }

    /// Name as written on the command line.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// The ramp of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        Self::ALL.iter().find(|ramp| ramp.name == name)
    }

    /// The ramps of a volume, by its name without size and extension.
    pub fn of_volume(volume: &str) -> impl Iterator<Item = &'static Self> {
        Self::ALL.iter().filter(move |ramp| ramp.volume() == volume)
    }

    fn volume(&self) -> &'static str {
        self.name.trim_end_matches("-1d").trim_end_matches("-2d")
    }

    /// Bounds of the values, normalised: the grey level rises from 0 to 1 between them, the opacity with it.
    pub fn values(&self) -> [f32; 2] {
        self.values
    }

    /// The part of the voxels of DM's volume that have an opacity above zero (DM Table 2).
    pub fn occupancy(&self) -> Option<f64> {
        self.occupancy
    }

    /// What the values are normalised by: all 8 bits for DM's phantoms (Eq. 15), whose brightest voxels are darker; `None`
    /// is the range of the volume.
    pub fn window(&self) -> Option<Window> {
        self.occupancy.and_then(|_| Window::new(0.0, 255.0).ok())
    }

    /// The transfer function for a volume of the given dimensions.
    ///
    /// # Errors
    /// None for the ramps as they are; [`TransferError`] stands for bounds that make no function.
    pub fn transfer(&self, dims: [usize; 3]) -> Result<TransferFunction, TransferError> {
        let [v0, v1] = self.values;
        let voxel_length_at_256 = SIDE / dims.into_iter().fold(1, usize::max) as f32;
        let mut transfer = match self.gradients_at_256 {
            None => TransferFunction::ramp(v0, v1),
            Some(gradients) => {
                let [g0, g1] = gradients.map(|gradient| gradient * voxel_length_at_256);
                TransferFunction::ramp_2d(v0, v1, g0, g1)
            }
        }?;
        let opacity = 1.0 - (1.0 - self.opacity_at_256).powf(voxel_length_at_256);
        transfer.opacity.iter_mut().for_each(|point| point.alpha *= opacity);
        Ok(transfer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramps_are_found_by_name_and_by_volume() {
        for ramp in BenchmarkRamp::ALL {
            assert_eq!(BenchmarkRamp::named(ramp.name()), Some(ramp));
            ramp.transfer([1; 3]).unwrap();
        }
        let of_beetle: Vec<&str> = BenchmarkRamp::of_volume("beetle").map(BenchmarkRamp::name).collect();
        assert_eq!(of_beetle, ["beetle-1d", "beetle-2d"]);
        assert_eq!(BenchmarkRamp::of_volume("teapot").count(), 0);
    }

    #[test]
    fn gradients_of_a_finer_phantom_are_smaller() {
        let ramp = BenchmarkRamp::named("beetle-2d").unwrap();
        let start = |dims| ramp.transfer(dims).unwrap().gradient_opacity_points()[0].at;
        assert_eq!(start([256; 3]), 0.1);
        assert_eq!(start([512, 512, 300]), 0.05);
    }

    #[test]
    fn a_finer_box_is_as_opaque() {
        let ramp = BenchmarkRamp::named("box").unwrap();
        let passes = |side: usize| {
            let alpha = ramp.transfer([side; 3]).unwrap().opacity_points()[1].alpha;
            (1.0 - alpha).powi(side as i32 / 2)
        };
        assert!((passes(256) - 0.98_f32.powi(128)).abs() < 1e-4);
        assert!((passes(512) - passes(256)).abs() < 1e-4 && (passes(64) - passes(256)).abs() < 1e-4);
    }
}
