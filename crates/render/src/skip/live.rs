//! The skip map of a transfer function that is being edited.

use super::{GpuSkipMap, SkipBuilder, Structure};
use crate::gpu::{Gpu, GpuError};
use wheatstone_core::cast::CastParameters;

/// A skip map that follows the settings: the one that is made soonest while they change (isotropic distances), the one that
/// lets rays leap furthest (a map per octant) once they rest.
#[derive(Debug)]
pub struct LiveSkipMap {
    builder: SkipBuilder,
    quick: GpuSkipMap,
    settled: Option<GpuSkipMap>,
    is_settled: bool,
}

impl LiveSkipMap {
    /// Starts with the quick map of some settings.
    ///
    /// # Errors
    /// More blocks than the device can hold, no memory, a lost device.
    pub fn new(gpu: &Gpu, mut builder: SkipBuilder, parameters: &CastParameters) -> Result<Self, GpuError> {
        let quick = builder.map(gpu, parameters, Structure::Distance)?;
        Ok(Self { builder, quick, settled: None, is_settled: false })
    }

    /// Follows a change of the settings: O(blocks), nothing allocated.
    ///
    /// # Errors
    /// No memory, a lost device.
    pub fn edit(&mut self, gpu: &Gpu, parameters: &CastParameters) -> Result<(), GpuError> {
        self.is_settled = false;
        self.builder.update(gpu, parameters, &self.quick)
    }

    /// Makes the better map of settings that rest; the quick one stays for the next edit.
    ///
    /// # Errors
    /// No memory, a lost device.
    pub fn settle(&mut self, gpu: &Gpu, parameters: &CastParameters) -> Result<(), GpuError> {
        match &self.settled {
            Some(settled) => self.builder.update(gpu, parameters, settled)?,
            None => self.settled = Some(self.builder.map(gpu, parameters, Structure::Anisotropic)?),
        }
        self.is_settled = true;
        Ok(())
    }

    /// The best map of the latest settings.
    pub fn map(&self) -> &GpuSkipMap {
        self.settled.as_ref().filter(|_| self.is_settled).unwrap_or(&self.quick)
    }
}
