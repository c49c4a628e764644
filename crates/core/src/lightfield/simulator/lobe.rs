//! How light is spread over directions.

/// Half of the plateau, in distances between neighbouring beams.
const HALF_PLATEAU: f64 = 0.35;

/// Furthest from its middle that a beam is seen, in distances between neighbours; less than a thousandth is left there.
const FURTHEST: f64 = 0.85;

/// Brightness of a beam at an angle from its middle, in distances between neighbouring beams: a wide plateau with steep Gaussian
/// slopes that overlap with the neighbours' (LF §3), half as bright in the middle between two.
pub(super) fn lobe(distance: f64) -> f64 {
    let down_the_slope = (distance.abs() - HALF_PLATEAU).max(0.0) / (0.5 - HALF_PLATEAU);
    if distance.abs() < FURTHEST { (-down_the_slope * down_the_slope).exp2() } else { 0.0 }
}

/// Weighted mean of colours.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Blend {
    sum: [f64; 3],
    weight: [f64; 3],
}

/// Weight in all up to which there is no light.
pub const DARK: f64 = 1e-3;

impl Blend {
    pub(super) fn add(&mut self, rgb: [f32; 3], weight: f64) {
        (0..3).for_each(|channel| self.add_channel(channel, rgb[channel], weight));
    }

    pub(super) fn add_channel(&mut self, channel: usize, level: f32, weight: f64) {
        self.sum[channel] += weight * f64::from(level);
        self.weight[channel] += weight;
    }

    /// Black where no beam goes.
    pub(super) fn rgb(self) -> [f32; 3] {
        std::array::from_fn(
            |c| if self.weight[c] > DARK { (self.sum[c] / self.weight[c]) as f32 } else { 0.0 },
        )
    }
}
