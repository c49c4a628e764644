//! What is done before the first refresh, while nobody waits for a picture: drivers compile kernels when they are first used.

use super::eyes::upright_views;
use super::headset::{EyeImage, Headset};
use super::panel;
use super::room::{Control, Room};
use super::stage::{ColoredLine, Scenery};
use crate::failure::Failure;
use crate::look::ModeName;
use crate::viewer::canvas;
use crate::viewer::command::Command;
use crate::viewer::eyes::Wanted;
use crate::viewer::loading::Arrived;
use crate::viewer::session::Showing;
use crate::viewer::state::{Edit, WarpName};
use glam::{DQuat, DVec3};
use std::sync::Arc;
use std::time::{Duration, Instant};
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Eye, Stand};
use wheatstone_core::scene::Shading;
use wheatstone_core::view::{Frustum, PixelRect, View};
use wheatstone_core::volume::{Grid, Volume, Voxels};

/// Most time that a first picture is waited for: kernels are compiled by then.
const FIRST_PICTURE: Duration = Duration::from_secs(10);

/// What a part of the first picture may take.
const PART: Duration = Duration::from_millis(20);

/// Width and height of what nobody sees, pixels.
const SMALL: [u32; 2] = [32, 32];

/// Sides of volumes that nobody sees, voxels: enough for the skip maps of larger ones, a power of two and none, for software Vulkan compiles
/// kernels for either.
const OPENED: [usize; 2] = [128, 130];

/// Between the eyes, metres.
const EYE_DISTANCE_M: f64 = 0.063;

/// How far eyes move, metres: enough to be shown another picture than was cast.
const STEP_M: f64 = 0.01;

/// Between the eyes before they move; the world has no place of its own yet.
const MIDDLE: Pose = Pose { position_m: DVec3::ZERO, orientation: DQuat::IDENTITY };

/// Of a display, seconds.
const PERIOD_S: f64 = 1.0 / 90.0;

/// What a window's panels switch to most.
const LOOKS: [(ModeName, Shading); 4] = [
    (ModeName::Dvr, Shading::None),
    (ModeName::Dvr, Shading::Phong),
    (ModeName::Mip, Shading::None),
    (ModeName::Iso, Shading::Phong),
];

impl Room {
    /// Shows the first volume as commands have it, casts a picture of it from where eyes are most likely to be, and draws by every way
    /// that a refresh may take; and casts a little as it may be shown soon: after an edit, or by the looks that are most common.
    pub(super) fn rehearse(
        &mut self,
        headset: &dyn Headset,
        (arrived, showing): (Box<Arrived>, Showing),
        commands: &[Command],
        control: Control,
    ) -> Result<(), Failure> {
        let up = showing.state.look.up.direction();
        let stand = Stand::before(&MIDDLE, &arrived.facts.grid, up, self.scale);
        let views = self.cast_views(showing.state.stereo.method, &eyes(0.0), &stand, headset.eye_sizes());
        self.show(arrived, showing, views.clone())?;
        commands.iter().try_for_each(|command| self.session.try_perform(command))?;
        let asked = self.session.state().pace.warp;
        // What refreshes begin with comes last.
        if asked == WarpName::Volumetric {
            self.rehearse_picture(WarpName::Grid, &views)?;
        }
        self.rehearse_picture(asked, &views)?;
        self.rehearse_refresh(headset, &stand)?;
        let [view, _] = upright_views(&eyes(0.0), &stand, [SMALL; 2]);
        let looks: &[_] = match control {
            Control::Hands => &[],
            Control::HandsAndWindow => &LOOKS,
        };
        let shown = self.session.state().look.mode_and_shading();
        for &(mode, shading) in std::iter::once(&shown).chain(looks) {
            let mut state = self.session.state().clone();
            for edit in [Edit::Mode(mode), Edit::Shading(shading)] {
                state.apply(&edit).map_err(Failure::input)?;
            }
            self.casting.rehearse(&self.gpu, &state, view)?;
            if state.pace.warp == WarpName::Volumetric {
                state.pace.warp = WarpName::Grid;
                self.casting.rehearse(&self.gpu, &state, view)?;
            }
        }
        if control == Control::HandsAndWindow {
            self.rehearse_opening(view)?;
        }
        Ok(self.gpu.wait()?)
    }

    /// Uploads and casts volumes of every precision, in each of which drivers compile kernels anew: a window opens other files.
    fn rehearse_opening(&mut self, view: View) -> Result<(), Failure> {
        let voxels: [fn(usize) -> Voxels; 3] = [
            |count| Voxels::U8((0..count).map(|index| index as u8).collect()),
            |count| Voxels::U16((0..count).map(|index| index as u16).collect()),
            |count| Voxels::F32((0..count).map(|index| index as f32).collect()),
        ];
        for (side, voxels) in OPENED.into_iter().flat_map(|side| voxels.map(|voxels| (side, voxels))) {
            let grid = Grid::centred([side; 3], [1.0; 3]).map_err(Failure::input)?;
            let volume = Volume::new(grid, voxels(side.pow(3))).map_err(Failure::input)?;
            let opened = self.session.loader.upload_at_once(volume, &self.gpu)?;
            self.casting.rehearse_with(&self.gpu, opened, self.session.state(), view)?;
        }
        Ok(())
    }

    /// Casts a picture as refreshes do that are warped so.
    fn rehearse_picture(&mut self, warp: WarpName, views: &[View]) -> Result<(), Failure> {
        let mut state = self.session.state().clone();
        state.pace.warp = warp;
        self.casting.follow(&self.gpu, &state, views.to_vec())?;
        let (begun, before) = (Instant::now(), self.casting.pictures());
        while self.casting.pictures() == before && begun.elapsed() < FIRST_PICTURE {
            self.casting.refresh(&self.gpu, PART)?;
            self.gpu.wait()?;
        }
        Ok(())
    }

    /// Draws a refresh that nobody sees, of eyes that have moved since the cast.
    fn rehearse_refresh(&mut self, headset: &dyn Headset, stand: &Stand) -> Result<(), Failure> {
        let eyes = eyes(STEP_M);
        let views = upright_views(&eyes, stand, [SMALL; 2]);
        let (mut pictures, mut depths) = (None, None);
        if let Some(front) = self.casting.front() {
            for warp in [WarpName::Quad, WarpName::Grid, WarpName::Volumetric] {
                let wanted = Wanted { picture: self.casting.pictures(), views: views.to_vec(), warp };
                pictures = self.eyes.show(&self.gpu, front, wanted)?;
            }
            if let Some(of_eyes) = &mut self.depths {
                depths = of_eyes.show(&self.gpu, front, &views)?;
            }
        }
        let gpu = Arc::clone(&self.gpu);
        let image = |size, format| {
            let texture = canvas::texture(&gpu, size, format)?;
            Ok::<_, Failure>(texture.create_view(&wgpu::TextureViewDescriptor::default()))
        };
        let depth = headset.depth_format().map(|format| image(SMALL, format)).transpose()?;
        let target = EyeImage { color: image(SMALL, headset.image_format())?, depth };
        let line = [ColoredLine::new([-DVec3::ONE, DVec3::NEG_Z], [1.0; 2], [1.0; 3])];
        let scenery = Scenery {
            behind: &line,
            picture: pictures.as_ref().map(|[left, _]| left),
            depths: depths.as_ref().map(|[left, _]| left),
            visible: &[PixelRect { columns: 0..SMALL[0], rows: 0..SMALL[1] }],
            in_front: &line,
        };
        let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.stage.draw(&gpu, &mut encoder, &target, &eyes[0], Some([0.0; 3]), &scenery);
        gpu.queue().submit([encoder.finish()]);
        let panel = image(panel::SIZE, headset.image_format())?;
        self.draw_panel(&panel, PERIOD_S, WarpName::None)?;
        Ok(gpu.wait()?)
    }
}

/// Where a head is somewhat to the right of where it was.
fn eyes(right_m: f64) -> [Eye; 2] {
    let frustum = Frustum { left: -1.0, right: 1.0, down: -1.0, up: 1.0, near_m: 0.01, far_m: f64::INFINITY };
    [-0.5, 0.5].map(|side| {
        let position_m = MIDDLE.position_m + (right_m + side * EYE_DISTANCE_M) * DVec3::X;
        Eye { pose: Pose { position_m, ..MIDDLE }, frustum }
    })
}
