//! What warps are drawn to.

use wheatstone_core::view::PixelRect;

/// A texture that warps are drawn to, which knows where the last one drew: the next empties no more than that.
///
/// What is encoded has to be submitted, in that order, and nothing else may draw there.
#[derive(Debug)]
pub struct Canvas {
    view: wgpu::TextureView,
    /// Pixels outside of which it is transparent; unknown before the first warp.
    drawn: Option<PixelRect>,
    /// That can be seen; all, if it is unknown.
    visible: Option<Vec<PixelRect>>,
}

impl Canvas {
    /// A texture with anything in it.
    pub fn new(view: wgpu::TextureView) -> Self {
        Self { view, drawn: None, visible: None }
    }

    /// From now on nothing but some pixels, each of them in one rectangle, can be seen: what the others show is not defined.
    pub fn show_only(&mut self, visible: &[PixelRect]) {
        self.visible = Some(visible.to_vec());
    }

    /// What passes sample.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// Pixels outside of which it is transparent once all that is encoded is done; unknown before the first warp.
    pub fn drawn(&self) -> Option<&PixelRect> {
        self.drawn.as_ref()
    }

    /// Width and height, pixels.
    pub fn size(&self) -> [u32; 2] {
        let size = self.view.texture().size();
        [size.width, size.height]
    }

    /// Notes that some pixels are drawn. Returns which have to be emptied before; all, if it is unknown.
    pub(super) fn draw(&mut self, covered: &PixelRect) -> Option<PixelRect> {
        self.drawn.replace(covered.clone())
    }

    /// Those of some pixels that can be seen.
    pub(super) fn seen(&self, pixels: &PixelRect) -> Vec<PixelRect> {
        match &self.visible {
            Some(visible) => visible.iter().map(|rect| rect.within(pixels)).collect(),
            None => vec![pixels.clone()],
        }
    }
}
