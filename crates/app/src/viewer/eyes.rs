//! What each eye is shown: the newest whole picture, as it looks from where the eye is now.

use super::novel_views::NovelViews;
use super::state::WarpName;
use crate::failure::Failure;
use glam::DVec3;
use wheatstone_core::budget::Quality;
use wheatstone_core::view::{Projection, View};
use wheatstone_core::warp::{GridSettings, WarpError};
use wheatstone_render::Gpu;
use wheatstone_render::live::Front;
use wheatstone_render::warp::{Canvas, Shown, Warps};

/// Of warped pictures: what a display shows, and what is interpolated fastest.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Most steps of the search for surfaces that software Vulkan has time for in a refresh: 3 to 5 ns each on two cores.
const MOST_STEPS_ON_CPU: f64 = 4e6;

/// How many such steps a step through layers takes the time of.
const STEPS_OF_LAYERS: f64 = 8.0;

/// Nearest depth that counts for how far surfaces move, metres.
const NEAREST_M: f64 = 0.05;

/// Warps to the eyes of a rig.
pub(crate) struct Eyes {
    warps: Warps,
    /// Made when first asked for.
    novel_views: Option<NovelViews>,
    pictures: Vec<Canvas>,
    shown: Option<Wanted>,
}

/// What tells one pair of pictures from another.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Wanted {
    /// Counts the pictures that have been cast.
    pub(crate) picture: u64,
    /// What the eyes see, the left one first.
    pub(crate) views: Vec<View>,
    pub(crate) warp: WarpName,
}

/// How a picture is shown, and how finely.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Way {
    AsItIs,
    Quad(Quality),
    Grid(Quality),
    Volumetric(Quality),
}

impl Way {
    /// The way that is asked for, or what of it a refresh has time for: the grid is searched, and layers are passed, pixel by pixel
    /// along as many pixels as surfaces may have moved.
    fn choose(gpu: &Gpu, front: &Front, shown: &View, wanted: &View, warp: WarpName) -> Self {
        let quality = front.quality();
        let moved_m = (eye_m(shown) - eye_m(wanted)).length();
        match warp {
            WarpName::None => Self::AsItIs,
            WarpName::Quad => Self::Quad(quality),
            // From where it was cast a picture is the same by any warp.
            WarpName::Grid | WarpName::Volumetric if moved_m == 0.0 => Self::Quad(quality),
            WarpName::Grid | WarpName::Volumetric => {
                let corners = front.prepared().parameters().occupied_corners_world();
                let most_steps =
                    if gpu.description().is_software { MOST_STEPS_ON_CPU } else { f64::INFINITY };
                let (way, cost): (fn(Quality) -> Self, f64) =
                    if warp == WarpName::Volumetric && front.prepared().keeps_layers() {
                        (Self::Volumetric, STEPS_OF_LAYERS)
                    } else {
                        (Self::Grid, 1.0)
                    };
                let columns = columns_moved(shown, moved_m, &corners);
                let steps = |quality: &Quality| {
                    quality.size(wanted.size).map(f64::from).iter().product::<f64>() * columns.max(1.0) * cost
                };
                let coarser = (quality.level()..=Quality::COARSEST.level()).map(Quality::at);
                coarser.into_iter().find(|quality| steps(quality) <= most_steps).map_or(Self::AsItIs, way)
            }
        }
    }
}

fn eye_m(view: &View) -> DVec3 {
    view.view_from_world.inverse().translation
}

/// How far what is nearest moves at most when the eye does, pixels.
fn columns_moved(shown: &View, moved_m: f64, corners: &[DVec3]) -> f64 {
    let nearest_m = shown.depths_m(corners).0.max(NEAREST_M);
    match shown.projection {
        Projection::Perspective(lens) => {
            f64::from(shown.size[0]) / (lens.right - lens.left) * moved_m / nearest_m
        }
        Projection::Orthographic(_) => 0.0,
    }
}

impl Eyes {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, Failure> {
        let warps = Warps::new(gpu, FORMAT)?;
        Ok(Self { warps, novel_views: None, pictures: Vec::new(), shown: None })
    }

    /// The pictures of the left and the right eye (the same twice where there is one), as finely as the front picture is
    /// cast. Submits what draws them, unless they are what was wanted last.
    pub(crate) fn show(
        &mut self,
        gpu: &Gpu,
        front: &Front,
        wanted: Wanted,
    ) -> Result<Option<[wgpu::TextureView; 2]>, Failure> {
        if self.shown.as_ref() != Some(&wanted) {
            self.shown = None;
            if let Err(error) = self.draw(gpu, front, &wanted) {
                self.pictures.clear();
                return Err(error);
            }
            self.shown = Some(wanted);
        }
        let mut eyes = self.pictures.iter().map(Canvas::view);
        Ok(eyes.next().map(|left| [left.clone(), eyes.next().unwrap_or(left).clone()]))
    }

    fn draw(&mut self, gpu: &Gpu, front: &Front, wanted: &Wanted) -> Result<(), Failure> {
        let sources: Vec<_> = front.pictures().collect();
        let Some(last) = sources.len().checked_sub(1) else { return Ok(()) };
        let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.pictures.truncate(wanted.views.len());
        for (eye, &view) in wanted.views.iter().enumerate() {
            let source = eye.min(last);
            let (target, cast_from) = sources[source];
            let shown = Shown::new(target, cast_from, front.prepared());
            let way = Way::choose(gpu, front, &cast_from, &view, wanted.warp);
            let view = match way {
                Way::AsItIs => cast_from,
                Way::Quad(quality) | Way::Grid(quality) | Way::Volumetric(quality) => {
                    View { size: quality.size(view.size), ..view }
                }
            };
            let mut into = self.take_picture(gpu, eye, view.size)?;
            match way {
                Way::AsItIs | Way::Quad(_) => self.warps.quad(gpu, &mut encoder, &shown, &view, &mut into),
                Way::Grid(_) => {
                    self.warps.grid(gpu, &mut encoder, &shown, &view, GridSettings::default(), &mut into)
                }
                Way::Volumetric(_) => {
                    let novel_views = self.novel_views(gpu)?;
                    novel_views.follow(gpu, &mut encoder, front, wanted.picture)?;
                    novel_views.encode(gpu, &mut encoder, (source, &shown), &view, &mut into)
                }
            }
            .map_err(|error: WarpError| Failure::Internal(error.into()))?;
            self.pictures.insert(eye, into);
        }
        gpu.queue().submit([encoder.finish()]);
        Ok(gpu.check()?)
    }

    fn novel_views(&mut self, gpu: &Gpu) -> Result<&mut NovelViews, Failure> {
        match self.novel_views.take() {
            Some(novel_views) => Ok(self.novel_views.insert(novel_views)),
            None => Ok(self.novel_views.insert(NovelViews::new(gpu, FORMAT)?)),
        }
    }

    /// Room for an eye's picture: that of the last one if it has the size.
    fn take_picture(&mut self, gpu: &Gpu, eye: usize, size: [u32; 2]) -> Result<Canvas, Failure> {
        let kept = (eye < self.pictures.len()).then(|| self.pictures.remove(eye));
        if let Some(kept) = kept.filter(|kept| kept.size() == size) {
            return Ok(kept);
        }
        let [width, height] = size;
        let texture = gpu.device().create_texture(&wgpu::TextureDescriptor {
            label: Some("eye"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        gpu.check()?;
        Ok(Canvas::new(texture.create_view(&wgpu::TextureViewDescriptor::default())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::state::Camera;

    #[test]
    fn surfaces_move_by_as_much_as_the_nearest_does() {
        let view = Camera::default().view([400, 300]).unwrap();
        let world_from_view = view.view_from_world.inverse();
        let corners = [-2.0, -1.0].map(|z| world_from_view.transform_point3(DVec3::new(0.0, 0.0, z)));
        let Projection::Perspective(lens) = view.projection else { unreachable!() };
        let expected = 0.1 / (lens.right - lens.left) * 400.0;
        assert!((columns_moved(&view, 0.1, &corners) - expected).abs() < 1e-9);
        assert_eq!(columns_moved(&view, 0.0, &corners), 0.0);
    }
}
