//! How far what was shown is from what the eyes should have seen.

use super::headset::EyeImage;
use super::stage::{Scenery, Stage};
use crate::failure::Failure;
use crate::output::{file_in, make_folder};
use crate::picture::{Bits, write_png};
use crate::viewer::canvas;
use crate::viewer::casting::Casting;
use crate::viewer::state::State;
use std::path::PathBuf;
use wheatstone_core::headset::{Eye, Side};
use wheatstone_core::image::RgbImage;
use wheatstone_core::metrics::compare;
use wheatstone_core::view::{PixelRect, View};
use wheatstone_render::Gpu;

/// How far the shown picture's eye may be from the eye for a refresh to count as still, metres of the volume's longest side.
const STILL: f64 = 1e-6;

/// Which refreshes are compared.
#[derive(Debug, Clone)]
pub(crate) struct Checking {
    /// One of so many.
    pub(crate) every: u64,
    /// So many at most.
    pub(crate) most: usize,
    /// The folder that what was shown is written to.
    pub(crate) pictures: Option<PathBuf>,
}

/// One eye at one refresh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Checked {
    /// Counted from 1, from the first that showed the volume.
    pub(crate) refresh: u64,
    pub(crate) side: Side,
    pub(crate) dssim: f64,
    /// Whether what was shown was cast from elsewhere.
    pub(crate) moves: bool,
}

/// What was shown at some refreshes, kept on the device until the session is over.
pub(crate) struct Checks {
    stage: Stage,
    checking: Checking,
    refresh: u64,
    kept: Vec<Kept>,
}

struct Kept {
    refresh: u64,
    side: Side,
    image: wgpu::Texture,
    wanted: View,
    visible: Vec<PixelRect>,
    moves: bool,
    state: State,
}

/// An eye that is being shown something.
pub(crate) struct Seen<'a> {
    pub(crate) eye: &'a Eye,
    /// Of the volume, in its space.
    pub(crate) wanted: View,
    /// From which the front picture was cast.
    pub(crate) cast_from: View,
    pub(crate) picture: &'a wgpu::TextureView,
    /// The pixels that can be seen.
    pub(crate) visible: &'a [PixelRect],
}

impl Checks {
    /// With a folder that can be written to, if there is to be one.
    pub(crate) fn new(gpu: &Gpu, checking: Checking) -> Result<Self, Failure> {
        checking.pictures.as_deref().map(make_folder).transpose()?;
        let stage = Stage::new(gpu.device(), wgpu::TextureFormat::Rgba8Unorm, None);
        Ok(Self { stage, checking, refresh: 0, kept: Vec::new() })
    }

    /// Encodes keeping what the eyes are shown, if it is time to.
    pub(crate) fn keep(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        state: &State,
        seen: [Seen<'_>; 2],
    ) -> Result<(), Failure> {
        self.refresh += 1;
        let is_enough = self.kept.len() >= 2 * self.checking.most;
        if !self.refresh.is_multiple_of(self.checking.every) || is_enough {
            return Ok(());
        }
        for (side, Seen { eye, wanted, cast_from, picture, visible }) in Side::BOTH.into_iter().zip(seen) {
            let image = canvas::texture(gpu, wanted.size, wgpu::TextureFormat::Rgba8Unorm)?;
            let color = image.create_view(&wgpu::TextureViewDescriptor::default());
            let target = EyeImage { color, depth: None };
            let scenery = Scenery { picture: Some(picture), visible, ..Scenery::default() };
            self.stage.draw(gpu, encoder, &target, eye, [0.0; 3], &scenery);
            let eye_m = |view: &View| view.view_from_world.inverse().translation;
            let turned =
                !wanted.view_from_world.matrix3.abs_diff_eq(cast_from.view_from_world.matrix3, STILL);
            let moves = turned || eye_m(&wanted).distance(eye_m(&cast_from)) > STILL;
            let (refresh, visible, state) = (self.refresh, visible.to_vec(), state.clone());
            self.kept.push(Kept { refresh, side, image, wanted, visible, moves, state });
        }
        Ok(())
    }

    /// Casts what should have been seen, and writes what was.
    pub(crate) fn finish(self, gpu: &Gpu, casting: &mut Casting) -> Result<Vec<Checked>, Failure> {
        let compare_one = |Kept { refresh, side, image, wanted, visible, moves, state }: Kept| {
            let truth = casting.render(gpu, &state, wanted)?.over_background([0.0; 3]);
            let truth = seen_through(truth, &visible);
            let texels: Vec<[u8; 4]> = gpu.read_texture(&image)?;
            let rgb = texels.iter().map(|&[r, g, b, _]| [r, g, b].map(|value| f32::from(value) / 255.0));
            let [width, height] = wanted.size;
            let shown = RgbImage { width, height, rgb: rgb.collect() };
            if let Some(folder) = &self.checking.pictures {
                let name = format!("refresh_{refresh:05}_{}.png", name(side));
                write_png(&file_in(folder, &name), &shown, Bits::Eight)?;
            }
            let dssim = compare(&shown, &truth).map_err(Failure::input)?.dssim();
            Ok(Checked { refresh, side, dssim, moves })
        };
        self.kept.into_iter().map(compare_one).collect()
    }
}

/// The same picture, black where it cannot be seen.
fn seen_through(mut picture: RgbImage, visible: &[PixelRect]) -> RgbImage {
    let width = picture.width as usize;
    for (index, rgb) in picture.rgb.iter_mut().enumerate() {
        let [x, y] = [index % width, index / width].map(|at| at as u32);
        if !visible.iter().any(|rect| rect.columns.contains(&x) && rect.rows.contains(&y)) {
            *rgb = [0.0; 3];
        }
    }
    picture
}

/// An eye's name, in files and reports.
pub(crate) fn name(side: Side) -> &'static str {
    match side {
        Side::Left => "left",
        Side::Right => "right",
    }
}
