//! Layers of emission and absorption back to the host.

use crate::gpu::{Gpu, GpuError};
use crate::readback::read_texture;
use crate::target::{LAYERS, Target};
use glam::{DAffine3, DVec4};
use half::f16;
use wheatstone_core::view::{RayField, View};
use wheatstone_core::warp::{EmissionAbsorption, Layer, Medium};

impl Target {
    /// Waits for the device and reads the layers back that a cast of a view has kept; none if it has no room for any.
    ///
    /// # Errors
    /// No memory, a lost or hung device.
    pub fn read_layers(&self, gpu: &Gpu, view: &View) -> Result<Option<EmissionAbsorption>, GpuError> {
        let Some(texture) = &self.layers else { return Ok(None) };
        let words: Vec<[u32; 4]> = read_texture(gpu, texture)?;
        let mut layers =
            EmissionAbsorption::clear(self.size(), LAYERS as usize).map_err(GpuError::refused)?;
        let rays = RayField::new(view, DAffine3::IDENTITY);
        let [width, height] = self.size().map(|side| side as usize);
        for (pixel, layers) in layers.layers_mut().chunks_mut(LAYERS as usize).enumerate() {
            let (x, y) = ((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
            let metres_per_depth = rays.at(x, y).1.length();
            let mut through = 1.0;
            for (slice, layer) in layers.iter_mut().enumerate() {
                let words = words[slice * width * height + pixel];
                let added = added(words);
                let [start_m, end_m] = [words[0], words[1]].map(f32::from_bits);
                let length_m = (f64::from(end_m) - f64::from(start_m)) * metres_per_depth;
                let medium = Medium::from_color(added / through, length_m);
                *layer = Layer { start_m, end_m, medium };
                through = (through - added.w).max(f64::MIN_POSITIVE);
            }
        }
        Ok(Some(layers))
    }
}

/// What a layer adds to the picture: `layer_color` of `lib/layer_words.wgsl`.
fn added([.., rg, ba]: [u32; 4]) -> DVec4 {
    let half = |bits: u32| f16::from_bits(bits as u16).to_f64();
    DVec4::new(half(rg), half(rg >> 16), half(ba), half(ba >> 16))
}
