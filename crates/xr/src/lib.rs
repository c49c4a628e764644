//! Wheatstone in a headset: an `OpenXR` runtime's frames, eyes and hands, on a Vulkan device that `wgpu` shares with it.
//!
//! [`Runtime`] connects and opens the [`Graphics`]; a [`Session`] gives a [`Frame`] for each refresh, which tells where the eyes and hands
//! will be ([`Tick`](wheatstone_core::headset::Tick)) and takes the pictures:
//!
//! ```no_run
//! use wheatstone_core::headset::Eye;
//! use wheatstone_xr::{Phase, Runtime, Session, SessionOptions, XrError};
//!
//! fn show(draw: impl Fn(&wheatstone_render::Gpu, &Eye, &wgpu::TextureView)) -> Result<(), XrError> {
//!     let graphics = Runtime::connect("Wheatstone")?.open_gpu()?;
//!     let mut session = Session::begin(&graphics, SessionOptions::default())?;
//!     loop {
//!         match session.poll()? {
//!             Phase::Running => {
//!                 let mut frame = session.wait()?;
//!                 if let Some(eyes) = frame.tick().eyes {
//!                     for (eye, image) in eyes.iter().zip(frame.acquire_eyes()?) {
//!                         draw(graphics.gpu(), eye, &image.color);
//!                     }
//!                 }
//!                 frame.end(None)?;
//!             }
//!             Phase::Idle => std::thread::sleep(std::time::Duration::from_millis(10)),
//!             Phase::Ended(_) => return Ok(()),
//!         }
//!     }
//! }
//! ```
//!
//! # Ownership
//!
//! Whatever is dropped first, things end in the order that the runtime and Vulkan want: the textures of a swapchain's images keep the
//! swapchain, a swapchain keeps the session, the session keeps the device, the device keeps the Vulkan instance, and that keeps the runtime.
//!
//! # Threads
//!
//! The runtime and `wgpu` use one Vulkan queue, which Vulkan wants used by one thread at a time. A [`Session`] stays on its thread; all
//! submissions to the device of its [`Graphics`] have to come from there, too.

#![cfg(any(target_os = "linux", target_os = "windows"))]
#![expect(unsafe_code, reason = "Vulkan handles pass between the runtime and wgpu")]

mod actions;
mod bindings;
mod device;
mod error;
mod event;
mod eyes;
mod frame;
mod hand_tracking;
mod layers;
mod refresh_rate;
mod runtime;
mod session;
mod space;
mod state;
mod swapchain;
mod visibility_mask;

pub use device::Graphics;
pub use error::XrError;
pub use event::SessionEvent;
pub use frame::{EyeImage, Frame};
pub use layers::Panel;
pub use runtime::{Runtime, RuntimeDescription};
pub use session::{Phase, Session, SessionOptions};
pub use space::Floor;
pub use state::EndReason;
