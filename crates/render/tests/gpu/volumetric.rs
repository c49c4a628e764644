//! Volumetric warps on the GPU against their twin, of the layers that the GPU has kept.

use crate::device::on_device;
use crate::scene::*;
use crate::warp::{differences, dssim, front, wanted, warped};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::image::Image;
use wheatstone_core::scene::Settings;
use wheatstone_core::view::View;
use wheatstone_core::volume::VoxelType;
use wheatstone_core::warp::{self, EmissionAbsorption, LayerThresholds, VolumetricSettings, WarpError};
use wheatstone_render::warp::{DepthPass, LayerDepths, Picture, Shown, VolumetricWarps};
use wheatstone_render::{Gpu, GpuVolume, Prepared, Renderer, Sources, Target};

struct Scene {
    prepared: Prepared,
    target: Target,
    depths: LayerDepths,
    image: Image,
    layers: EmissionAbsorption,
}

impl Scene {
    fn cast(gpu: &Gpu, renderer: &mut Renderer, view: View, alpha: f32) -> Self {
        let volume = blob_volume([24, 20, 22], spacing([1.0; 3]), VoxelType::U8);
        let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
        let settings = Settings::new(volume.full_window(), transfer(alpha));
        let parameters = CastParameters::new(&settings, &placement(&volume));
        let plain = renderer.prepare(gpu, &Sources::volume(&uploaded), parameters).unwrap();
        let prepared = renderer.with_layers(gpu, &plain, &LayerThresholds::default()).unwrap();
        let mut targets = [Target::with_layers(gpu, view.size).unwrap()];
        renderer.render(gpu, &prepared, &[view], &mut targets).unwrap();
        let [target] = targets;
        let depths = LayerDepths::new(gpu, view.size).unwrap();
        let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        DepthPass::new(gpu).unwrap().encode(gpu, &mut encoder, &target, &depths).unwrap();
        gpu.queue().submit([encoder.finish()]);
        let image = target.read(gpu).unwrap().image;
        let layers = target.read_layers(gpu, &view).unwrap().unwrap();
        Self { prepared, target, depths, image, layers }
    }

    fn warp(&self, gpu: &Gpu, shown: View, wanted: &View) -> Result<Image, WarpError> {
        let shown = Shown::new(&self.target, shown, &self.prepared);
        warped(gpu, wanted, |encoder, into| {
            let warps = VolumetricWarps::new(gpu, Picture::FORMAT).unwrap();
            warps.encode(gpu, encoder, &shown, &self.depths, wanted, &VolumetricSettings::default(), into)
        })
    }
}

#[test]
fn they_are_those_of_the_twin() {
    on_device(|gpu, renderer| {
        let mut random = fastrand::Rng::with_seed(5);
        for (case, alpha) in [0.1, 0.9, 0.3, 0.9, 0.1, 0.5].into_iter().enumerate() {
            let scene = Scene::cast(gpu, renderer, front(), alpha);
            let wanted = wanted(&mut random, &front());
            let settings = VolumetricSettings::default();
            let twin = warp::volumetric(&scene.layers, &front(), &wanted, &settings).unwrap();
            let found = scene.warp(gpu, front(), &wanted).unwrap();
            // Rounding changes how many steps a few rays take.
            let (largest, others) = differences(&found, &twin);
            eprintln!("volumetric {case}: {others:.5} of the pixels, {largest}, {:.6}", dssim(&found, &twin));
            assert!(others < 0.01 && dssim(&found, &twin) < 1e-4, "{case}: {others} {largest}");
        }
    });
}

#[test]
fn the_same_pose_returns_the_picture() {
    on_device(|gpu, renderer| {
        for alpha in [0.1, 0.9] {
            let scene = Scene::cast(gpu, renderer, front(), alpha);
            let found = scene.warp(gpu, front(), &front()).unwrap();
            let off = dssim(&found, &scene.image);
            assert!(off < 2e-3, "{off}");
        }
    });
}

#[test]
fn what_does_not_go_together_is_refused() {
    on_device(|gpu, renderer| {
        let mut scene = Scene::cast(gpu, renderer, front(), 0.5);
        let other = View { size: [9, 7], ..front() };
        assert!(matches!(scene.warp(gpu, other, &front()), Err(WarpError::Mismatch { .. })));
        let parallel = View { projection: orthographic(1.0, front().size), ..front() };
        assert!(matches!(scene.warp(gpu, front(), &parallel), Err(WarpError::Projection(_))));
        scene.target = Target::new(gpu, front().size).unwrap();
        assert_eq!(scene.warp(gpu, front(), &front()), Err(WarpError::NoLayers));
    });
}
