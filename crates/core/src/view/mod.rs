//! Views: where the eye is, what it looks through, and the rays of its pixels.

mod frustum;
mod mcop;
mod orbit;
mod pixel_rect;
mod placement;
mod ray_field;
mod rig;
mod viewpoint;

pub use frustum::{Frustum, FrustumError, OrthographicBox, Projection};
pub use mcop::Mcop;
pub use orbit::Orbit;
pub use pixel_rect::PixelRect;
pub(crate) use pixel_rect::whole_pixels;
pub use placement::{AnatomicalDirection, world_from_patient};
pub use ray_field::RayField;
pub use rig::Rig;
pub use viewpoint::Viewpoint;

use glam::DAffine3;

/// One picture to make: pose, projection and size in pixels. Off-axis is the normal case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// World (right-handed, +Y up, metres) to view space (eye at the origin, looking along −Z, metres).
    pub view_from_world: DAffine3,
    /// What lies within the picture.
    pub projection: Projection,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Where the picture is shaded from; `None` is its own eye. The views of a [`Rig`] share one viewpoint: surfaces and
    /// highlights that differ between the eyes would rival each other.
    pub shaded_from: Option<Viewpoint>,
}
