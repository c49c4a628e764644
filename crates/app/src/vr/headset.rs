//! What has eyes and hands, and shows pictures at its refreshes.

use crate::failure::Failure;
use std::sync::Arc;
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{HiddenArea, Side, Tick};
use wheatstone_render::Gpu;

/// A headset, there or not.
pub(crate) trait Headset {
    /// The device that its pictures are drawn on.
    fn gpu(&self) -> &Arc<Gpu>;

    /// What it is, for people.
    fn name(&self) -> String;

    /// The format of what is drawn to.
    fn image_format(&self) -> wgpu::TextureFormat;

    /// The format of the depths that are kept beside the eyes' pictures, if they are.
    fn depth_format(&self) -> Option<wgpu::TextureFormat>;

    /// Width and height of the eyes' pictures, pixels.
    fn eye_sizes(&self) -> [[u32; 2]; 2];

    /// What lenses hide of the left and the right eye's pictures.
    fn hidden_areas(&self) -> &[HiddenArea; 2];

    /// Whether eyes see the room where pictures are transparent.
    fn sees_through(&self) -> bool;

    /// The floor's height in the world, metres, where it is known.
    fn floor_y_m(&self) -> Option<f64>;

    /// Whether refreshes wait for what is cast between them, as if no time passed meanwhile.
    fn is_patient(&self) -> bool;

    /// Waits for the next refresh, lets its pictures be drawn, and shows them. An error of what draws comes back as it is.
    fn refresh(
        &mut self,
        draw: &mut dyn FnMut(&mut dyn Sight) -> Result<(), Failure>,
    ) -> Result<Moment, Failure>;

    /// Lets a hand feel that it has taken hold of something.
    fn pulse(&mut self, side: Side) -> Result<(), Failure>;

    /// What people should know of what has happened since this was last asked.
    fn told(&mut self) -> Vec<String>;

    /// Asks it to end; it does so within some refreshes.
    fn close(&mut self) -> Result<(), Failure>;
}

/// A refresh that is being drawn for.
pub(crate) trait Sight {
    /// When it is, where the eyes will be then, and what the hands do.
    fn tick(&self) -> &Tick;

    /// What the eyes' pictures are drawn to; all of their pixels are.
    fn eye_images(&mut self) -> Result<[EyeImage; 2], Failure>;

    /// Where the panel is to be; nowhere unless this is called.
    fn place_panel(&mut self, pose: Pose);

    /// What the panel is drawn to when it is drawn anew; none if there is no panel.
    fn panel_image(&mut self) -> Result<Option<wgpu::TextureView>, Failure>;
}

/// What an eye's picture is drawn to.
#[derive(Debug, Clone)]
pub(crate) struct EyeImage {
    pub(crate) color: wgpu::TextureView,
    /// Near over depth, of the eye's frustum, if depths are kept.
    pub(crate) depth: Option<wgpu::TextureView>,
}

/// Whether depths are kept beside the eyes' pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DepthLayer {
    Without,
    /// If the runtime takes them.
    With,
}

/// What the eyes' pictures are to be like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct OfPictures {
    pub(crate) depth_layer: DepthLayer,
    /// Their width and height, as parts of what the runtime recommends; none for as much as the device has time for.
    pub(crate) image_scale: Option<f64>,
    /// Whether they are read after they are drawn.
    pub(crate) is_read: bool,
}

/// What a headset was up to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Moment {
    /// It wanted no pictures; what it wants is looked after again soon.
    #[cfg_attr(
        not(any(target_os = "linux", target_os = "windows")),
        expect(dead_code, reason = "only runtimes idle")
    )]
    Idle,
    /// A refresh has got its pictures.
    Shown,
    /// It will want no more, for a reason.
    Ended(String),
}
