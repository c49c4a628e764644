//! What each eye is shown: the newest whole picture, as it looks from where the eye is now.

mod finer;
mod way;

use super::canvas;
use super::lens::Lens;
use super::novel_views::NovelViews;
use super::state::WarpName;
use crate::failure::Failure;
use finer::{Finer, Part, parts};
use std::ops::Range;
use way::{Means, Way, as_it_is, most_steps};
use wheatstone_core::headset::HiddenArea;
use wheatstone_core::view::{PixelRect, Projection, View};
use wheatstone_core::warp::{GridSettings, VolumetricSettings, WarpError};
use wheatstone_render::live::Front;
use wheatstone_render::warp::{Canvas, Shown, Warps};
use wheatstone_render::{Gpu, GpuError, Target};

/// Of warped pictures: what a display shows, and what is interpolated fastest.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Warps to the eyes of a rig.
pub(crate) struct Eyes {
    warps: Warps,
    /// Made when first asked for.
    novel_views: Option<NovelViews>,
    pictures: Vec<Canvas>,
    lenses: [Lens; 2],
    shown: Option<Wanted>,
    /// How the shown pictures are drawn, and how they would be if there were time.
    ways: Vec<Ways>,
    finer: Option<Finer>,
    beyond_reach: BeyondReach,
    /// How rays step through layers.
    stepping: VolumetricSettings,
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

/// How an eye's picture is drawn.
#[derive(Debug, Clone, Copy)]
struct Ways {
    now: Way,
    at_rest: Way,
    /// Whether it is wanted from where it was cast.
    is_unmoved: bool,
}

/// What is shown for as long as no picture is from near enough for a warp to show much of what is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BeyondReach {
    /// The picture as it is: of a window.
    AsItIs,
    /// What there is of it where it belongs: of a headset, where anything else would go with the head.
    Warped,
}

impl Eyes {
    /// Eyes that never see a picture as it is, unless that is asked for.
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, Failure> {
        let warps = Warps::new(gpu, FORMAT)?;
        let beyond_reach = BeyondReach::Warped;
        Ok(Self {
            warps,
            novel_views: None,
            pictures: Vec::new(),
            lenses: Default::default(),
            shown: None,
            ways: Vec::new(),
            finer: None,
            beyond_reach,
            stepping: VolumetricSettings::default(),
        })
    }

    /// From now on rays step so through layers.
    pub(crate) fn step_by(&mut self, stepping: VolumetricSettings) {
        if self.stepping != stepping {
            (self.stepping, self.shown) = (stepping, None);
        }
    }

    /// From now on lenses hide something of what the left and the right eye are shown: it is left out.
    pub(crate) fn hide(&mut self, hidden: &[HiddenArea; 2]) {
        for (lens, hidden) in self.lenses.iter_mut().zip(hidden) {
            if lens.hide(hidden) {
                self.shown = None;
            }
        }
    }

    /// The same with something else beyond the reach of warps.
    pub(crate) fn beyond_reach(self, beyond_reach: BeyondReach) -> Self {
        Self { beyond_reach, ..self }
    }

    /// The pictures of the left and the right eye (the same twice where there is one), as finely as the front picture is
    /// cast, as far as there is time for that. Submits what draws them, unless they are what was wanted last.
    pub(crate) fn show(
        &mut self,
        gpu: &Gpu,
        front: &Front,
        wanted: Wanted,
    ) -> Result<Option<[wgpu::TextureView; 2]>, Failure> {
        if !self.shows(&wanted) {
            (self.shown, self.finer) = (None, None);
            if let Err(error) = self.draw(gpu, front, &wanted) {
                self.pictures.clear();
                self.ways.clear();
                return Err(error);
            }
            self.shown = Some(wanted);
        }
        Ok(self.views())
    }

    /// The same pictures, when nothing moves and no finer picture is being cast: goes on with finer ones, a few rows of them, and
    /// shows these once they are whole.
    pub(crate) fn refine(
        &mut self,
        gpu: &Gpu,
        front: &Front,
    ) -> Result<Option<[wgpu::TextureView; 2]>, Failure> {
        if self.can_refine()
            && let Some(wanted) = self.shown.take()
        {
            let drawn = self.draw_finer(gpu, front, &wanted);
            self.shown = Some(wanted);
            if let Err(error) = drawn {
                // What cannot be drawn is not tried again.
                self.finer = None;
                self.ways.iter_mut().for_each(|ways| ways.at_rest = ways.now);
                return Err(error);
            }
        }
        Ok(self.views())
    }

    /// Whether this is what was wanted last.
    pub(crate) fn shows(&self, wanted: &Wanted) -> bool {
        self.shown.as_ref() == Some(wanted)
    }

    /// Whether what is shown becomes finer at rest.
    pub(crate) fn can_refine(&self) -> bool {
        self.shown.is_some() && self.ways.iter().any(|ways| ways.now != ways.at_rest)
    }

    /// How the picture is shown, in words.
    pub(crate) fn described(&self) -> String {
        match self.ways.iter().find(|ways| !ways.is_unmoved) {
            Some(ways) => format!("shown by {}", ways.now.described()),
            None => "shown as it is cast".to_owned(),
        }
    }

    fn views(&self) -> Option<[wgpu::TextureView; 2]> {
        let mut eyes = self.pictures.iter().map(Canvas::view);
        let left = eyes.next()?;
        Some([left.clone(), eyes.next().unwrap_or(left).clone()])
    }

    /// The pixels of an eye's picture outside of which it is empty, if it were of a size.
    pub(crate) fn drawn(&self, eye: usize, size: [u32; 2]) -> PixelRect {
        let canvas = self.pictures.get(eye).or(self.pictures.last());
        let drawn = canvas.and_then(|canvas| Some(canvas.drawn()?.stretched(canvas.size(), size)));
        drawn.unwrap_or(PixelRect { columns: 0..size[0], rows: 0..size[1] })
    }

    fn draw(&mut self, gpu: &Gpu, front: &Front, wanted: &Wanted) -> Result<(), Failure> {
        let means = Means::of(gpu, front, self.stepping, self.beyond_reach).shared(wanted.views.len());
        let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.pictures.truncate(wanted.views.len());
        self.ways.clear();
        for (eye, view) in wanted.views.iter().enumerate() {
            let Some((_, (_, cast_from))) = source(front, eye) else { return Ok(()) };
            let now = means.way(&cast_from, view, wanted.warp);
            let at_rest = means.at_rest().way(&cast_from, view, wanted.warp);
            let is_unmoved = View { size: cast_from.size, ..*view } == cast_from;
            self.ways.push(Ways { now, at_rest, is_unmoved });
            let size = drawn_view(now, &cast_from, view, &means).size;
            let mut into = self.take_picture(gpu, eye, size)?;
            self.draw_rows(gpu, &mut encoder, front, (wanted, eye, now), (&means, 0..size[1]), &mut into)?;
            self.pictures.insert(eye, into);
        }
        gpu.queue().submit([encoder.finish()]);
        Ok(gpu.check()?)
    }

    /// Draws as many rows of finer pictures as a refresh has time for.
    fn draw_finer(&mut self, gpu: &Gpu, front: &Front, wanted: &Wanted) -> Result<(), Failure> {
        let means = Means::of(gpu, front, self.stepping, self.beyond_reach).at_rest();
        let mut finer = match self.finer.take() {
            Some(finer) => finer,
            None => self.begin_finer(gpu, front, wanted, &means)?,
        };
        let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for Part { eye, rows, .. } in finer.take(most_steps(gpu)) {
            let what = (wanted, eye, self.ways[eye].at_rest);
            self.draw_rows(gpu, &mut encoder, front, what, (&means, rows), &mut finer.pictures[eye])?;
        }
        gpu.queue().submit([encoder.finish()]);
        gpu.check()?;
        if finer.is_whole() {
            self.pictures = finer.pictures;
            self.ways.iter_mut().for_each(|ways| ways.now = ways.at_rest);
        } else {
            self.finer = Some(finer);
        }
        Ok(())
    }

    fn begin_finer(
        &self,
        gpu: &Gpu,
        front: &Front,
        wanted: &Wanted,
        means: &Means,
    ) -> Result<Finer, Failure> {
        let (mut pictures, mut all) = (Vec::new(), Vec::new());
        for (eye, (view, ways)) in wanted.views.iter().zip(&self.ways).enumerate() {
            let Some((_, (_, cast_from))) = source(front, eye) else { break };
            let drawn = drawn_view(ways.at_rest, &cast_from, view, means);
            pictures.push(room(gpu, drawn.size, FORMAT)?);
            all.extend(parts(means, (eye, ways.at_rest), &cast_from, &drawn, most_steps(gpu)));
        }
        Ok(Finer::new(pictures, all))
    }

    /// Encodes some rows of what an eye is shown in some way.
    fn draw_rows(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        front: &Front,
        (wanted, eye, way): (&Wanted, usize, Way),
        (means, rows): (&Means, Range<u32>),
        into: &mut Canvas,
    ) -> Result<(), Failure> {
        let Some((source, (target, cast_from))) = source(front, eye) else { return Ok(()) };
        let shown = Shown::new(target, cast_from, front.prepared());
        let view = drawn_view(way, &cast_from, &wanted.views[eye], means);
        let rows = PixelRect { columns: 0..view.size[0], rows };
        match (self.lenses.get_mut(eye), view.projection) {
            (Some(lens), Projection::Perspective(frustum)) => {
                let visible = lens.visible(&frustum, view.size);
                into.show_only(&visible.iter().map(|rect| rect.within(&rows)).collect::<Vec<_>>());
            }
            _ => into.show_only(&[rows]),
        }
        match way {
            Way::AsItIs | Way::Quad(_) => self.warps.quad(gpu, encoder, &shown, &view, into),
            Way::Grid(_) => self.warps.grid(gpu, encoder, &shown, &view, GridSettings::default(), into),
            Way::Volumetric(_) => {
                let stepping = self.stepping;
                let novel_views = self.novel_views(gpu)?;
                novel_views.follow(gpu, encoder, front, wanted.picture)?;
                novel_views.encode(gpu, encoder, (source, &shown), &view, &stepping, into)
            }
        }
        .map_err(|error: WarpError| Failure::Internal(error.into()))
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
        Ok(room(gpu, size, FORMAT)?)
    }
}

/// The picture that an eye's is made of, and which it is.
fn source(front: &Front, eye: usize) -> Option<(usize, (&Target, View))> {
    front.pictures().enumerate().take(eye + 1).last()
}

/// The view of an eye's picture as it is drawn in some way.
fn drawn_view(way: Way, cast_from: &View, wanted: &View, means: &Means) -> View {
    match way {
        Way::AsItIs => as_it_is(cast_from, wanted, means.quality),
        Way::Quad(quality) | Way::Grid(quality) | Way::Volumetric(quality) => {
            View { size: quality.size(wanted.size), ..*wanted }
        }
    }
}

/// Something that warps are drawn to and passes sample.
pub(crate) fn room(gpu: &Gpu, size: [u32; 2], format: wgpu::TextureFormat) -> Result<Canvas, GpuError> {
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
    let texture = canvas::texture_for(gpu, "warped", size, format, usage)?;
    Ok(Canvas::new(texture.create_view(&wgpu::TextureViewDescriptor::default())))
}
