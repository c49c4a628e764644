//! A picture in layers of emission and absorption.

use super::Medium;
use crate::scene::Mode;
use glam::DVec4;
use thiserror::Error;

/// Most layers per pixel.
pub const MOST_LAYERS: usize = 8;

/// Thickness below which thresholds do not divide a layer, widths of a pixel at its end.
///
/// Neighbouring pixels take a thin surface's samples apart differently, and layers are warped each for itself; that costs more than
/// keeping together what parallax hardly moves apart: half a pixel when the eye has moved by a thirtieth of the distance.
pub const DIVIDED_PX: f64 = 16.0;

/// Most layers of a picture: 6 GiB of them.
const MOST_LAYERS_OF_PICTURE: u64 = 1 << 28;

/// Why a picture cannot be cast in layers.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum LayerError {
    /// A mode whose samples are not composited.
    #[error("mode {name}: only composites have layers", name = .0.name())]
    Mode(Mode),
    /// No layers, or too many.
    #[error("{0} layers per pixel: must be 1 to {MOST_LAYERS}")]
    Count(usize),
    /// Thresholds that do not ascend within (0, 1].
    #[error("opacity threshold {threshold} after {previous}: must ascend, above 0 and up to 1")]
    Threshold {
        /// The threshold before; 0 for the first.
        previous: f32,
        /// The threshold.
        threshold: f32,
    },
    /// A picture without pixels, or with too many layers.
    #[error("picture of {}×{} pixels in {layer_count} layers: needs 1 to {MOST_LAYERS_OF_PICTURE} in all", size[0], size[1])]
    Size {
        /// Width and height, pixels.
        size: [u32; 2],
        /// Layers per pixel.
        layer_count: usize,
    },
    /// There is not enough memory.
    #[error("not enough memory for {bytes} bytes of layers")]
    Memory {
        /// Bytes asked for.
        bytes: usize,
    },
}

/// Accumulated opacities y₁ … `y_k` at which the layers of a pixel end at the latest (VR Alg. 7).
///
/// The last layer takes also what lies behind its threshold, or is all that there is without reaching it: as printed, Alg. 7
/// loses that rest.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerThresholds(Vec<f32>);

impl LayerThresholds {
    /// Thresholds that ascend within (0, 1].
    ///
    /// # Errors
    /// None, more than [`MOST_LAYERS`], or others.
    pub fn new(opacities: &[f32]) -> Result<Self, LayerError> {
        if !(1..=MOST_LAYERS).contains(&opacities.len()) {
            return Err(LayerError::Count(opacities.len()));
        }
        let mut previous = 0.0;
        for &threshold in opacities {
            if !(previous < threshold && threshold <= 1.0) {
                return Err(LayerError::Threshold { previous, threshold });
            }
            previous = threshold;
        }
        Ok(Self(opacities.to_vec()))
    }

    /// One per layer, from the front.
    pub fn opacities(&self) -> &[f32] {
        &self.0
    }
}

impl Default for LayerThresholds {
    /// The four of VR §5.3.3.
    fn default() -> Self {
        Self(vec![0.001, 0.05, 0.5, 1.0])
    }
}

/// A stretch of a pixel's ray and what it passes through.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Layer {
    /// Depth along view −Z at which it begins, metres.
    pub start_m: f32,
    /// Depth at which it ends, metres.
    pub end_m: f32,
    /// What is between, clear for a layer without any.
    pub medium: Medium,
}

impl Layer {
    /// Its premultiplied colour along a ray that is so many metres long per metre of depth.
    pub fn color(&self, metres_per_depth: f64) -> DVec4 {
        self.medium.color((f64::from(self.end_m) - f64::from(self.start_m)) * metres_per_depth)
    }

    /// Whether nothing is in it.
    pub fn is_clear(&self) -> bool {
        self.medium.absorption_per_m <= 0.0
    }
}

/// A view in k layers per pixel, front to back, each a [`Medium`] between two depths: what a volumetric warp reads (VR Alg. 7,
/// after Lochmann et al.).
///
/// A layer begins at the first visible sample behind the one before and ends at its threshold, once it is as thick as [`DIVIDED_PX`],
/// or, if another is left, before a gap that is longer than it is: what is empty between layers stays empty.
#[derive(Debug, Clone, PartialEq)]
pub struct EmissionAbsorption {
    size: [u32; 2],
    layer_count: usize,
    layers: Vec<Layer>,
}

impl EmissionAbsorption {
    /// Clear layers.
    ///
    /// # Errors
    /// A picture without pixels, no or too many layers, too little memory.
    pub fn clear(size: [u32; 2], layer_count: usize) -> Result<Self, LayerError> {
        if !(1..=MOST_LAYERS).contains(&layer_count) {
            return Err(LayerError::Count(layer_count));
        }
        let total = (u64::from(size[0]) * u64::from(size[1])).saturating_mul(layer_count as u64);
        let total = usize::try_from(total)
            .ok()
            .filter(|_| (1..=MOST_LAYERS_OF_PICTURE).contains(&total))
            .ok_or(LayerError::Size { size, layer_count })?;
        let mut layers = Vec::new();
        let bytes = total * size_of::<Layer>();
        layers.try_reserve_exact(total).map_err(|_| LayerError::Memory { bytes })?;
        layers.resize(total, Layer::default());
        Ok(Self { size, layer_count, layers })
    }

    /// Width and height, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Layers per pixel.
    pub fn layer_count(&self) -> usize {
        self.layer_count
    }

    /// Bytes that the layers take.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(&self.layers[..])
    }

    /// All layers: of each pixel from the front, pixels row by row from the top left.
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// The same, to be filled.
    pub fn layers_mut(&mut self) -> &mut [Layer] {
        &mut self.layers
    }

    /// The layers of a pixel, from the front.
    pub(super) fn of_pixel(&self, pixel: usize) -> &[Layer] {
        &self.layers[pixel * self.layer_count..][..self.layer_count]
    }
}
