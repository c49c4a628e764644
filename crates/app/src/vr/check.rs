//! How far what was shown is from what the eyes should have seen.

use super::headset::EyeImage;
use super::stage::{ColoredLine, Scenery, Stage};
use crate::failure::Failure;
use crate::output::{file_in, make_folder};
use crate::picture::{Bits, write_png};
use crate::viewer::canvas;
use crate::viewer::casting::Casting;
use crate::viewer::state::State;
use half::f16;
use std::path::PathBuf;
use wgpu::util::DeviceExt as _;
use wheatstone_core::headset::{Eye, Side};
use wheatstone_core::image::Image;
use wheatstone_core::metrics::{SsimMap, dssim};
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
    /// Of the whole image.
    pub(crate) dssim: f64,
    /// Of the windows that touch the volume; none where it is not to be seen.
    pub(crate) dssim_covered: Option<f64>,
    /// Whether what was shown was cast from elsewhere.
    pub(crate) moves: bool,
    /// Pixels along a side of the picture that was warped, as a part of full resolution.
    pub(crate) resolution: f64,
}

/// Images that eyes were shown at some refreshes, kept on the device until the session is over.
pub(crate) struct Checks {
    checking: Checking,
    refresh: u64,
    kept: Vec<Kept>,
}

struct Kept {
    refresh: u64,
    side: Side,
    image: wgpu::Texture,
    seen: Seen,
    moves: bool,
    state: State,
}

/// What an eye that is being shown something should see.
pub(crate) struct Seen {
    pub(crate) eye: Eye,
    /// Of the volume, in its space.
    pub(crate) wanted: View,
    /// From which the front picture was cast.
    pub(crate) cast_from: View,
    /// Pixels along a side of the front picture, as a part of full resolution.
    pub(crate) resolution: f64,
    /// The pixels that can be seen.
    pub(crate) visible: Vec<PixelRect>,
    pub(crate) background: Option<[f32; 3]>,
    pub(crate) behind: Vec<ColoredLine>,
    pub(crate) in_front: Vec<ColoredLine>,
}

impl Checks {
    /// With a folder that can be written to, if there is to be one.
    pub(crate) fn new(checking: Checking) -> Result<Self, Failure> {
        checking.pictures.as_deref().map(make_folder).transpose()?;
        Ok(Self { checking, refresh: 0, kept: Vec::new() })
    }

    /// Whether the next refresh is to be kept.
    pub(crate) fn is_due(&mut self) -> bool {
        self.refresh += 1;
        self.refresh.is_multiple_of(self.checking.every) && self.kept.len() < 2 * self.checking.most
    }

    /// Encodes keeping the image that an eye is shown.
    pub(crate) fn keep(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        state: &State,
        side: Side,
        shown: &EyeImage,
        seen: Seen,
    ) -> Result<(), Failure> {
        let drawn = shown.color.texture();
        let size = [drawn.width(), drawn.height()];
        let usage = wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::COPY_SRC;
        let image = canvas::texture_for(gpu, "kept", size, drawn.format().remove_srgb_suffix(), usage)?;
        encoder.copy_texture_to_texture(drawn.as_image_copy(), image.as_image_copy(), drawn.size());
        let [wanted_to, cast_from] = [&seen.wanted, &seen.cast_from].map(|view| view.view_from_world);
        let turned = !wanted_to.matrix3.abs_diff_eq(cast_from.matrix3, STILL);
        let [eye_m, cast_m] = [wanted_to, cast_from].map(|view| view.inverse().translation);
        let moves = turned || eye_m.distance(cast_m) > STILL;
        self.kept.push(Kept { refresh: self.refresh, side, image, seen, moves, state: state.clone() });
        Ok(())
    }

    /// Another volume is shown from now on: what was kept of the one before cannot be compared any more.
    pub(crate) fn forget(&mut self) {
        self.kept.clear();
    }

    /// Draws what should have been seen, and writes what was.
    pub(crate) fn finish(self, gpu: &Gpu, casting: &mut Casting) -> Result<Vec<Checked>, Failure> {
        let Some(first) = self.kept.first() else { return Ok(Vec::new()) };
        let stage = Stage::new(gpu.device(), first.image.format(), None);
        let compare_one = |Kept { refresh, side, image, seen, moves, state }: Kept| {
            let truth = casting.render(gpu, &state, seen.wanted)?;
            let should = canvas::read_texture(gpu, &draw(gpu, &stage, image.format(), &seen, &truth)?)?;
            let shown = canvas::read_texture(gpu, &image)?;
            if let Some(folder) = &self.checking.pictures {
                let name = format!("refresh_{refresh:05}_{}.png", name(side));
                write_png(&file_in(folder, &name), &shown, Bits::Eight)?;
            }
            let map = SsimMap::new(&shown, &should).map_err(Failure::input)?;
            let covered = covered(&truth, &seen.visible);
            let dssim_covered = match covered.contains(&true) {
                true => Some(dssim(map.mean_where(&covered).map_err(Failure::input)?)),
                false => None,
            };
            let (dssim, resolution) = (dssim(map.mean()), seen.resolution);
            Ok(Checked { refresh, side, dssim, dssim_covered, moves, resolution })
        };
        self.kept.into_iter().map(compare_one).collect()
    }
}

/// The image that an eye should have been shown: as it was drawn, of a picture that was cast from its place.
fn draw(
    gpu: &Gpu,
    stage: &Stage,
    format: wgpu::TextureFormat,
    seen: &Seen,
    truth: &Image,
) -> Result<wgpu::Texture, Failure> {
    let texel = |&[r, g, b, a]: &[f32; 4]| [r, g, b, a].map(f16::from_f32);
    let texels: Vec<[f16; 4]> = truth.color.iter().map(texel).collect();
    let picture = gpu.device().create_texture_with_data(
        gpu.queue(),
        &wgpu::TextureDescriptor {
            label: Some("truth"),
            size: wgpu::Extent3d { width: truth.width, height: truth.height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba16Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        bytemuck::cast_slice(&texels),
    );
    let picture = picture.create_view(&wgpu::TextureViewDescriptor::default());
    let image = canvas::texture(gpu, seen.wanted.size, format)?;
    let color = image.create_view(&wgpu::TextureViewDescriptor::default());
    let scenery = Scenery {
        behind: &seen.behind,
        picture: Some(&picture),
        depths: None,
        visible: &seen.visible,
        in_front: &seen.in_front,
    };
    let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let target = EyeImage { color, depth: None };
    stage.draw(gpu, &mut encoder, &target, &seen.eye, seen.background, &scenery);
    gpu.queue().submit([encoder.finish()]);
    Ok(image)
}

/// Pixels in which something of a picture can be seen.
fn covered(picture: &Image, visible: &[PixelRect]) -> Vec<bool> {
    let width = picture.width as usize;
    let is_covered = |(index, color): (usize, &[f32; 4])| {
        let [x, y] = [index % width, index / width].map(|at| at as u32);
        color[3] > 0.0 && visible.iter().any(|rect| rect.columns.contains(&x) && rect.rows.contains(&y))
    };
    picture.color.iter().enumerate().map(is_covered).collect()
}

/// An eye's name, in files and reports.
pub(crate) fn name(side: Side) -> &'static str {
    match side {
        Side::Left => "left",
        Side::Right => "right",
    }
}
