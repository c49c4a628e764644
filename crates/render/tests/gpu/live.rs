//! Pictures that are cast a few cells per refresh are those that are cast at once, whatever changes in between.

use crate::device::on_device;
use crate::scene::*;
use glam::DVec3;
use std::sync::Arc;
use std::time::Duration;
use wheatstone_core::budget::{Quality, QualityControl};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::scene::{Mode, Settings, Shading};
use wheatstone_core::view::{Rig, View};
use wheatstone_core::volume::VoxelType;
use wheatstone_core::warp::LayerThresholds;
use wheatstone_render::live::{Activity, LiveError, LiveView};
use wheatstone_render::{AdapterDescription, Gpu, GpuError, GpuVolume, Prepared, Renderer, Sources, Target};

/// Too little for a cell: every refresh casts as little as possible.
const NOTHING: Duration = Duration::from_nanos(1);

/// Enough for a few cells.
const LITTLE: Duration = Duration::from_micros(400);

const PLENTY: Duration = Duration::from_secs(10);

fn prepared(gpu: &Gpu, renderer: &mut Renderer, settings: impl Fn(&mut Settings)) -> Arc<Prepared> {
    let volume = blob_volume([20, 22, 18], spacing([1.0; 3]), VoxelType::U8);
    let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
    let mut set = Settings::new(volume.full_window(), transfer(0.5));
    settings(&mut set);
    let parameters = CastParameters::new(&set, &placement(&volume));
    Arc::new(renderer.prepare(gpu, &Sources::volume(&uploaded), parameters).unwrap())
}

fn with_layers(gpu: &Gpu, renderer: &mut Renderer) -> Arc<Prepared> {
    let plain = prepared(gpu, renderer, |_| {});
    Arc::new(renderer.with_layers(gpu, &plain, &LayerThresholds::default()).unwrap())
}

fn view(size: [u32; 2], eye: DVec3) -> View {
    look(eye, DVec3::ZERO, perspective(0.9, size), size)
}

/// Refreshes until a picture is complete; how many that took.
fn complete(gpu: &Gpu, renderer: &mut Renderer, live: &mut LiveView, budget: Duration) -> usize {
    for refresh in 1..20_000 {
        let activity = live.refresh(gpu, renderer, budget).unwrap().activity;
        if activity == Activity::Resting || matches!(activity, Activity::Casting { completes_view: true, .. })
        {
            return refresh;
        }
        gpu.wait().unwrap();
    }
    panic!("never complete");
}

/// The front picture is what casting its views at once gives.
fn assert_whole(gpu: &Gpu, renderer: &mut Renderer, live: &LiveView) {
    let front = live.front().unwrap();
    for (target, view) in front.pictures() {
        let found = target.read(gpu).unwrap();
        let expected = renderer.render_to_host(gpu, front.prepared(), &[view]).unwrap().remove(0);
        assert_eq!(found.image, expected.image);
        assert_eq!(found.reads, expected.reads);
        assert_eq!(target.read_layers(gpu, &view).unwrap().is_some(), front.prepared().keeps_layers());
        if front.prepared().keeps_layers() {
            let mut at_once = [Target::with_layers(gpu, view.size).unwrap()];
            renderer.render(gpu, front.prepared(), &[view], &mut at_once).unwrap();
            let [found, expected] =
                [target, &at_once[0]].map(|target| target.read_layers(gpu, &view).unwrap());
            assert!(found == expected, "layers");
        }
    }
}

#[test]
fn a_picture_of_many_refreshes_is_the_one_cast_at_once() {
    on_device(|gpu, renderer| {
        let modes = [
            (Mode::Composite, Shading::None),
            (Mode::Mip, Shading::None),
            (Mode::Composite, Shading::Shadow),
        ];
        let mut most_refreshes = 0;
        for (mode, shading) in modes {
            let settings = prepared(gpu, renderer, |set| (set.mode, set.shading) = (mode, shading));
            let views = Rig::Stereo { eye_distance_m: 0.1, convergence_m: 1.5 }.views(&outside());
            let mut live = LiveView::new(gpu, settings, &views, None).unwrap();
            for budget in [NOTHING, LITTLE, PLENTY] {
                for views in [&views[..1], &views] {
                    live.aim(views).unwrap();
                    most_refreshes = most_refreshes.max(complete(gpu, renderer, &mut live, budget));
                    assert_whole(gpu, renderer, &live);
                    assert!(live.front().unwrap().pictures().map(|(_, view)| view).eq(views.iter().copied()));
                }
            }
            assert_eq!(live.refresh(gpu, renderer, PLENTY).unwrap().activity, Activity::Resting);
        }
        // How many a picture takes depends on what its cells take by the clock: on a busy machine it is few.
        assert!(most_refreshes > 1, "no picture took several refreshes");
    });
}

#[test]
fn whatever_changes_the_front_picture_is_whole_and_the_last_one_is_what_is_wanted() {
    on_device(|gpu, renderer| {
        let settings = [
            prepared(gpu, renderer, |_| {}),
            prepared(gpu, renderer, |set| set.shading = Shading::Shadow),
            prepared(gpu, renderer, |set| set.preintegrated = true),
            prepared(gpu, renderer, |set| set.mode = Mode::MinIp),
            with_layers(gpu, renderer),
        ];
        let mut random = fastrand::Rng::with_seed(5);
        let eye = |random: &mut fastrand::Rng| DVec3::new(2.0 * random.f64() - 1.0, random.f64(), 1.2);
        let first = [view([61, 47], DVec3::new(0.3, 0.2, 1.2))];
        let control = QualityControl::new(2.0, 0.02).unwrap();
        let mut live = LiveView::new(gpu, Arc::clone(&settings[0]), &first, Some(control)).unwrap();
        let (mut shown, mut wanted, mut wanted_settings) = (0, first.to_vec(), Arc::clone(&settings[0]));
        for _ in 0..120 {
            match random.u32(0..8) {
                at @ 0..2 => {
                    wanted_settings = Arc::clone(random.choice(&settings).unwrap());
                    let change = [LiveView::supersede, LiveView::replace][at as usize];
                    change(&mut live, Arc::clone(&wanted_settings));
                }
                2..4 => {
                    let size = *random.choice(&[[61, 47], [20, 90], [8, 8]]).unwrap();
                    let count = random.usize(1..3);
                    wanted = (0..count).map(|_| view(size, eye(&mut random))).collect();
                    live.aim(&wanted).unwrap();
                }
                _ => {}
            }
            let budget = *random.choice(&[NOTHING, LITTLE, PLENTY]).unwrap();
            let activity = live.refresh(gpu, renderer, budget).unwrap().activity;
            if matches!(activity, Activity::Casting { completes_view: true, .. }) {
                shown += 1;
            }
            if live.front().is_some() {
                assert_whole(gpu, renderer, &live);
            }
        }
        assert!(shown > 10, "{shown} pictures");
        while live.refresh(gpu, renderer, PLENTY).unwrap().activity != Activity::Resting {
            gpu.wait().unwrap();
        }
        let front = live.front().unwrap();
        assert_eq!(front.quality(), Quality::FULL);
        assert!(Arc::ptr_eq(front.settings(), &wanted_settings));
        assert!(front.pictures().map(|(_, view)| view).eq(wanted));
        assert_whole(gpu, renderer, &live);
    });
}

#[test]
fn impossible_views_are_refused_and_possible_ones_cast_after_them() {
    on_device(|gpu, renderer| {
        let settings = prepared(gpu, renderer, |_| {});
        let possible = view([30, 20], DVec3::Z);
        let resized = |size| View { size, ..possible };
        assert!(matches!(LiveView::new(gpu, Arc::clone(&settings), &[], None), Err(LiveError::Views(_))));
        let mut live = LiveView::new(gpu, settings, &[possible], None).unwrap();
        assert!(matches!(live.aim(&[possible, resized([20, 20])]), Err(LiveError::Views(_))));
        complete(gpu, renderer, &mut live, LITTLE);
        let allowed = gpu.capabilities().largest_2d_side;
        for size in [[0, 20], [allowed + 1, 1], [u32::MAX, u32::MAX]] {
            let refused = live.aim(&[resized(size)]);
            assert!(matches!(refused, Err(LiveError::Gpu(GpuError::PictureSize { .. }))), "{refused:?}");
        }
        let next = resized([40, 40]);
        live.aim(&[next]).unwrap();
        complete(gpu, renderer, &mut live, LITTLE);
        assert!(live.front().unwrap().pictures().all(|(_, view)| view == next));
        assert_whole(gpu, renderer, &live);
    });
}

#[test]
fn a_device_that_is_gone_is_lost_at_every_refresh() {
    on_device(|shared, _| {
        let is_same = |description: &AdapterDescription| description == shared.description();
        let gpu = Gpu::open(is_same).unwrap();
        let mut renderer = Renderer::new(&gpu).unwrap();
        let settings = prepared(&gpu, &mut renderer, |_| {});
        let mut live = LiveView::new(&gpu, settings, &[outside()], None).unwrap();
        complete(&gpu, &mut renderer, &mut live, PLENTY);
        live.aim(&[view([40, 40], DVec3::Z)]).unwrap();
        live.refresh(&gpu, &mut renderer, NOTHING).unwrap();
        gpu.device().destroy();
        let mut refresh = || live.refresh(&gpu, &mut renderer, LITTLE);
        let is_lost = |refresh: &Result<_, _>| matches!(refresh, Err(LiveError::Gpu(GpuError::Lost { .. })));
        let noticed = (0..1000).any(|_| {
            std::thread::sleep(Duration::from_millis(1));
            is_lost(&refresh())
        });
        assert!(noticed);
        assert!((0..3).all(|_| is_lost(&refresh())));
    });
}

#[test]
fn a_picture_that_may_be_faulty_gives_way_to_the_one_before() {
    on_device(|shared, _| {
        let is_same = |description: &AdapterDescription| description == shared.description();
        let gpu = Gpu::open(is_same).unwrap();
        let mut renderer = Renderer::new(&gpu).unwrap();
        let settings = prepared(&gpu, &mut renderer, |_| {});
        let [first, second] = [[30, 20], [40, 40]].map(|size| view(size, DVec3::Z));
        let mut live = LiveView::new(&gpu, settings, &[first], None).unwrap();
        let fail = |renderer: &mut Renderer, live: &mut LiveView| {
            let _invalid = gpu.device().create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: 4,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::MAP_WRITE,
                mapped_at_creation: false,
            });
            let refused = live.refresh(&gpu, renderer, PLENTY);
            assert!(matches!(refused, Err(LiveError::Gpu(GpuError::Refused { .. }))), "{refused:?}");
        };
        let shown =
            |live: &LiveView| live.front().and_then(|front| front.pictures().map(|(_, view)| view).next());
        complete(&gpu, &mut renderer, &mut live, PLENTY);
        fail(&mut renderer, &mut live);
        assert_eq!(shown(&live), None);
        complete(&gpu, &mut renderer, &mut live, PLENTY);
        live.refresh(&gpu, &mut renderer, PLENTY).unwrap();
        live.aim(&[second]).unwrap();
        complete(&gpu, &mut renderer, &mut live, PLENTY);
        assert_eq!(shown(&live), Some(second));
        fail(&mut renderer, &mut live);
        assert_eq!(shown(&live), Some(first));
        assert_whole(&gpu, &mut renderer, &live);
        complete(&gpu, &mut renderer, &mut live, PLENTY);
        assert_eq!(shown(&live), Some(second));
        assert_whole(&gpu, &mut renderer, &live);
    });
}
