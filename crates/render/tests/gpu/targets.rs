//! Targets that are drawn to more than once.

use crate::device::on_device;
use crate::pairs::{middle, pair, render_pair};
use crate::scene::*;
use glam::DVec3;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::reference::Cast;
use wheatstone_core::scene::Settings;
use wheatstone_core::stereo::Epipolar;
use wheatstone_core::view::View;
use wheatstone_core::volume::VoxelType;
use wheatstone_render::{Form, GpuVolume, PairMethod, Sources, Target};

const SIZE: [u32; 2] = [101, 75];

/// Near, further away, at the picture's edge, out of sight, and near once more.
fn views() -> [View; 5] {
    let edge = look(DVec3::new(0.0, 0.0, 2.0), DVec3::new(1.0, 0.6, 0.0), perspective(1.0, SIZE), SIZE);
    let away = look(DVec3::new(0.0, 0.0, 2.0), DVec3::new(0.0, 0.0, 4.0), perspective(1.0, SIZE), SIZE);
    let near = middle(SIZE, DVec3::new(0.2, 0.1, 1.1));
    [near, middle(SIZE, DVec3::new(0.5, 0.3, 2.5)), edge, away, near]
}

fn assert_same(kept: &Cast, fresh: &Cast, case: usize) {
    assert_eq!(kept.image, fresh.image, "{case}");
    assert_eq!(kept.reads, fresh.reads, "{case}");
}

#[test]
fn nothing_is_left_of_the_view_before() {
    let volume = blob_volume([24, 20, 22], spacing([1.0; 3]), VoxelType::U8);
    on_device(|gpu, renderer| {
        let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
        let settings = Settings::new(volume.full_window(), transfer(0.3));
        let parameters = CastParameters::new(&settings, &placement(&volume));
        let prepared = renderer.prepare(gpu, &Sources::volume(&uploaded), parameters).unwrap();
        let mut kept = [Target::new(gpu, SIZE).unwrap()];
        let mut kept_pair = [(); 2].map(|()| Target::new(gpu, SIZE).unwrap());
        for (case, view) in views().into_iter().enumerate() {
            renderer.render(gpu, &prepared, &[view], &mut kept).unwrap();
            let fresh = renderer.render_to_host(gpu, &prepared, &[view]).unwrap();
            assert_same(&kept[0].read(gpu).unwrap(), &fresh[0], case);

            let [left, right] = pair(&view, 0.065, f64::INFINITY);
            let epipolar = Epipolar::new(&left, &right).unwrap();
            for form in [Form::Strips, Form::Volumetric] {
                let method = PairMethod { form, ..PairMethod::default() };
                renderer.render_pair(gpu, &prepared, &epipolar, method, kept_pair.each_mut()).unwrap();
                let fresh = render_pair(gpu, renderer, &prepared, &epipolar, method).unwrap();
                for (kept, fresh) in kept_pair.iter().zip(&fresh) {
                    assert_same(&kept.read(gpu).unwrap(), fresh, case);
                }
            }
        }
    });
}
