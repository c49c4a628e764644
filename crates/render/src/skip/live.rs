//! The skip map of a transfer function that is being edited.

use super::{GpuSkipMap, SkipBuilder};
use crate::gpu::{Gpu, GpuError};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::skip::SkipPlan;

/// A skip map that follows the settings by a plan: one that is made quickly while they change, and the one that lets rays
/// leap furthest once they rest.
#[derive(Debug)]
pub struct LiveSkipMap {
    builder: SkipBuilder,
    plan: SkipPlan,
    quick: GpuSkipMap,
    settled: Option<GpuSkipMap>,
    is_settled: bool,
}

impl LiveSkipMap {
    /// Starts with the quick map of some settings. The builder's blocks are those of the plan.
    ///
    /// # Errors
    /// More blocks than the device can hold, no memory, a lost device.
    pub fn new(
        gpu: &Gpu,
        mut builder: SkipBuilder,
        plan: SkipPlan,
        parameters: &CastParameters,
    ) -> Result<Self, GpuError> {
        builder.reserve(gpu, plan.structure)?;
        let quick = builder.map(gpu, parameters, plan.while_edited)?;
        Ok(Self { builder, plan, quick, settled: None, is_settled: false })
    }

    /// Follows a change of the settings: O(blocks), nothing allocated.
    ///
    /// # Errors
    /// No memory, a lost device.
    pub fn edit(&mut self, gpu: &Gpu, parameters: &CastParameters) -> Result<(), GpuError> {
        self.is_settled = false;
        self.builder.update(gpu, parameters, &self.quick)
    }

    /// Makes the better map, if there is one, of settings that rest; the quick one stays for the next edit.
    ///
    /// # Errors
    /// No memory, a lost device.
    pub fn settle(&mut self, gpu: &Gpu, parameters: &CastParameters) -> Result<(), GpuError> {
        if self.plan.structure == self.plan.while_edited {
            return self.edit(gpu, parameters);
        }
        match &self.settled {
            Some(settled) => self.builder.update(gpu, parameters, settled)?,
            None => self.settled = Some(self.builder.map(gpu, parameters, self.plan.structure)?),
        }
        self.is_settled = true;
        Ok(())
    }

    /// The best map of the latest settings.
    pub fn map(&self) -> &GpuSkipMap {
        self.settled.as_ref().filter(|_| self.is_settled).unwrap_or(&self.quick)
    }

    /// Bytes on the device: both maps, the ranges, and the field that maps are worked out in.
    pub fn byte_size(&self) -> u64 {
        self.quick.byte_size()
            + self.settled.as_ref().map_or(0, GpuSkipMap::byte_size)
            + self.builder.ranges_byte_size()
            + self.builder.working_byte_size()
    }
}
