//! What each eye is shown: the newest whole picture.

use wheatstone_render::live::Front;

/// The textures of the left and the right eye; the same twice where there is one.
pub(crate) fn pictures(front: &Front) -> Option<[wgpu::TextureView; 2]> {
    let mut views = front.pictures().map(|(target, _)| target.color().create_view(&Default::default()));
    let left = views.next()?;
    let right = views.next().unwrap_or_else(|| left.clone());
    Some([left, right])
}
