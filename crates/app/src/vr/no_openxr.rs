//! Where there is no OpenXR: nothing can be connected to.

use super::headset::{Headset, Moment, OfPictures, Sight};
use crate::failure::Failure;
use std::convert::Infallible;
use std::sync::Arc;
use wheatstone_core::headset::{HiddenArea, Side};
use wheatstone_render::Gpu;

/// A runtime that there is not.
pub(crate) struct Connected(Infallible);

/// A session that there is not.
pub(crate) struct OpenXr(Infallible);

impl Connected {
    /// Says what there is instead.
    pub(crate) fn connect() -> Result<Self, Failure> {
        Err(Failure::Internal(anyhow::anyhow!(
            "there is no OpenXR on this system, only on Linux and Windows; --headset none shows a recording or a demonstration"
        )))
    }

    pub(crate) fn gpu(&self) -> &Arc<Gpu> {
        match self.0 {}
    }

    pub(crate) fn instance(&self) -> &wgpu::Instance {
        match self.0 {}
    }
}

impl OpenXr {
    pub(crate) fn begin(Connected(nothing): Connected, _: OfPictures) -> Result<Self, Failure> {
        match nothing {}
    }
}

impl Headset for OpenXr {
    fn gpu(&self) -> &Arc<Gpu> {
        match self.0 {}
    }

    fn name(&self) -> String {
        match self.0 {}
    }

    fn image_format(&self) -> wgpu::TextureFormat {
        match self.0 {}
    }

    fn depth_format(&self) -> Option<wgpu::TextureFormat> {
        match self.0 {}
    }

    fn eye_sizes(&self) -> [[u32; 2]; 2] {
        match self.0 {}
    }

    fn hidden_areas(&self) -> &[HiddenArea; 2] {
        match self.0 {}
    }

    fn sees_through(&self) -> bool {
        match self.0 {}
    }

    fn floor_y_m(&self) -> Option<f64> {
        match self.0 {}
    }

    fn is_patient(&self) -> bool {
        match self.0 {}
    }

    fn refresh(
        &mut self,
        _: &mut dyn FnMut(&mut dyn Sight) -> Result<(), Failure>,
    ) -> Result<Moment, Failure> {
        match self.0 {}
    }

    fn pulse(&mut self, _: Side) -> Result<(), Failure> {
        match self.0 {}
    }

    fn told(&mut self) -> Vec<String> {
        match self.0 {}
    }

    fn close(&mut self) -> Result<(), Failure> {
        match self.0 {}
    }
}
