//! What is known of where a volume is occupied changes no picture.

use crate::device::on_device;
use crate::pairs::middle;
use crate::scene::*;
use crate::warp::warped;
use glam::{DAffine3, DVec3};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::scene::Settings;
use wheatstone_core::skip::{BlockRanges, BlockSize, Occupancy, Visibility};
use wheatstone_core::transfer::TransferFunction;
use wheatstone_core::view::View;
use wheatstone_core::volume::{Encoding, Grid, Volume, Voxels};
use wheatstone_core::warp::GridSettings;
use wheatstone_render::skip::{SkipBuilder, SkipKernels, Structure};
use wheatstone_render::warp::{Picture, Shown, Warps};
use wheatstone_render::{GpuVolume, Leap, Prepared, Sources, Target, TexelFormat};

const FORMAT: TexelFormat = TexelFormat::R16FloatOf8Bit;

/// A ball of values from 0 to 255 in a corner, the rest noise below what the transfer function shows.
fn corner_ball() -> Volume {
    let dims = [30, 26, 28];
    let value = |i: usize| {
        let at = DVec3::new((i % 30) as f64, (i / 30 % 26) as f64, (i / 780) as f64);
        let ball = 255.0 * (1.3 - at.distance(DVec3::new(9.0, 8.0, 18.0)) / 6.0).clamp(0.0, 1.0);
        ball.max((i * 7 % 40) as f64) as u8
    };
    let voxels = Voxels::U8((0..dims.iter().product()).map(value).collect());
    Volume::new(Grid::centred(dims, [1.0, 1.1, 0.9]).unwrap(), voxels).unwrap()
}

#[test]
fn pictures_and_warps_are_the_same_with_bounds() {
    let volume = corner_ball();
    let settings = Settings::new(volume.full_window(), TransferFunction::ramp(0.3, 0.8).unwrap());
    let parameters = CastParameters::new(&settings, &placement(&volume));
    let ranges = BlockRanges::of_values(&volume, storage_kind(FORMAT), BlockSize::cube(2).unwrap());
    let normalised = Encoding::new(&volume, storage_kind(FORMAT)).normalised_from_stored(parameters.window);
    let occupancy = Occupancy::new(ranges.normalised(normalised), None, &Visibility::new(&parameters));
    let bounded = parameters.clone().occupied_within(occupancy.bounds());
    let extent = |corners: [DVec3; 8]| corners[7] - corners[0];
    let share = extent(bounded.occupied_corners_world()) / extent(parameters.occupied_corners_world());
    assert!(share.max_element() < 0.7 && share.min_element() > 0.3, "{share}");
    on_device(|gpu, renderer| {
        let uploaded = GpuVolume::upload_as(gpu, &volume, FORMAT, &mut |_, _| {}).unwrap();
        let warps = Warps::new(gpu, Picture::FORMAT).unwrap();
        for eye in [DVec3::new(0.4, 0.3, 1.3), DVec3::new(-1.1, -0.2, 0.3), DVec3::new(-0.3, 0.1, 0.7)] {
            let view = middle([149, 131], eye);
            let aside = DAffine3::from_translation(DVec3::new(0.03, -0.01, 0.02)) * view.view_from_world;
            let wanted = View { view_from_world: aside, ..view };
            let mut pictures = |parameters: &CastParameters| {
                let sources = Sources::volume(&uploaded);
                let prepared: Prepared = renderer.prepare(gpu, &sources, parameters.clone()).unwrap();
                let mut targets = [Target::new(gpu, view.size).unwrap()];
                renderer.render(gpu, &prepared, &[view], &mut targets).unwrap();
                let shown = Shown::new(&targets[0], view, &prepared);
                let warped = warped(gpu, &wanted, |encoder, into| {
                    warps.grid(gpu, encoder, &shown, &wanted, GridSettings::default(), into)
                });
                (targets[0].read(gpu).unwrap().image, warped.unwrap())
            };
            let (whole, within) = (pictures(&parameters), pictures(&bounded));
            assert!(whole.0.color.iter().any(|color| color[3] > 0.5), "{eye}");
            assert!(whole == within, "{eye}");
        }
        let kernels = SkipKernels::new(gpu).unwrap();
        let mut builder = SkipBuilder::new(gpu, &kernels, &uploaded, BlockSize::cube(2).unwrap()).unwrap();
        let view = middle([149, 131], DVec3::new(0.4, 0.3, 1.3));
        for structure in [Structure::Distance, Structure::Anisotropic] {
            let map = builder.map(gpu, &parameters, structure).unwrap();
            let leap = Leap::EmptyBlocks(&map);
            let sources = Sources { leap, ..Sources::volume(&uploaded) };
            let prepared = renderer.prepare(gpu, &sources, parameters.clone()).unwrap();
            let mut cast = || {
                let mut targets = [Target::new(gpu, view.size).unwrap()];
                renderer.render(gpu, &prepared, &[view], &mut targets).unwrap();
                targets[0].read(gpu).unwrap().image
            };
            let before = cast();
            assert_eq!(prepared.occupied_corners_world(), parameters.occupied_corners_world());
            let reading = map.read_bounds(gpu).unwrap();
            gpu.wait().unwrap();
            let bounds = reading.poll().unwrap().unwrap();
            assert_eq!(bounds, occupancy.bounds(), "{structure:?}");
            prepared.know_occupied(bounds);
            assert_eq!(prepared.occupied_corners_world(), bounded.occupied_corners_world());
            assert!(cast() == before, "{structure:?}");
        }
    });
}
