//! A volume on a GPU.

mod warping;

pub(crate) use warping::GpuWarping;

use super::{AnchorCast, GradientMapSize, Leaping, PairCast, Shot, Underived, median_ms};
use crate::failure::Failure;
use crate::pairing::Pairing;
use crate::progress::Bar;
use crate::skipping::Skipping;
use std::sync::Arc;
use std::time::{Duration, Instant};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::detail::{LevelOfDetail, Slab};
use wheatstone_core::gradient_map::GradientDepth;
use wheatstone_core::lightfield::anchors::AnchorPlan;
use wheatstone_core::reference::Cast;
use wheatstone_core::scene::{GradientMethod, Mode};
use wheatstone_core::skip::{BlockSize, SkipPlan, SkipRequest};
use wheatstone_core::stereo::Epipolar;
use wheatstone_core::view::View;
use wheatstone_core::volume::{StorageKind, Volume};
use wheatstone_render::live::{LiveError, LiveView};
use wheatstone_render::skip::{DmBaseline, GpuBlockRanges, GpuSkipMap, SkipBuilder, SkipKernels};
use wheatstone_render::{
    CastAnchors, Gpu, GpuError, GpuGradientMap, GpuVolume, Leap, PairError, Prepared, Renderer, Sources,
    Target, TexelFormat,
};

/// The GPU's side of [`super::Engine`].
pub(crate) struct GpuEngine {
    pub(super) gpu: Gpu,
    renderer: Renderer,
    /// The volume, and its coarser levels if there are any.
    levels: Vec<GpuVolume>,
    storage: StorageKind,
    kernels: Option<SkipKernels>,
    gradient_map: Option<((GradientMethod, GradientDepth), GpuGradientMap)>,
    scenes: Vec<Scene>,
    /// One for each view that was ever cast at a time; the last cast is in the first `cast_count`.
    targets: Vec<Target>,
    cast_count: usize,
    /// The anchors of the last views, and what casting them read.
    anchors: Option<CastAnchors>,
    /// What the last picture of [`GpuEngine::cast_after`] was cast to before.
    last: Option<Target>,
    pub(super) upload: Duration,
}

/// What is made once per change of the settings.
struct Scene {
    prepared: Arc<Prepared>,
    gradient_map: Option<GradientMapSize>,
    leaping: Leaping,
    detail: Option<Detail>,
}

/// What is far away.
struct Detail {
    level_of_detail: LevelOfDetail,
    levels: Vec<Level>,
}

/// Settings for a level of steps: as the nearest slab, and behind nearer ones.
struct Level {
    alone: Arc<Prepared>,
    behind: Prepared,
}

/// What rays leap over, on the device.
enum Structures {
    Nothing,
    Map(GpuSkipMap),
    Ranges(GpuBlockRanges),
}

/// Settings on a device, to be cast a few cells at a time.
pub(crate) struct LiveEngine<'e> {
    pub(crate) gpu: &'e Gpu,
    pub(crate) renderer: &'e mut Renderer,
    settings: Arc<Prepared>,
}

impl LiveEngine<'_> {
    /// A view at full quality.
    pub(crate) fn view(&self, view: View) -> Result<LiveView, LiveError> {
        LiveView::new(self.gpu, Arc::clone(&self.settings), &[view], None)
    }
}

impl GpuEngine {
    pub(super) fn new(gpu: Gpu, volume: &Volume, storage: StorageKind) -> Result<Self, GpuError> {
        let renderer = Renderer::new(&gpu)?;
        let format = TexelFormat::for_volume(volume, storage, &gpu);
        let bar = Bar::new("upload", 1);
        let start = Instant::now();
        let volume =
            GpuVolume::upload_as(&gpu, volume, format, &mut |done, all| bar.set(done as u64, all as u64))?;
        let upload = start.elapsed();
        Ok(Self {
            gpu,
            renderer,
            levels: vec![volume],
            storage,
            kernels: None,
            gradient_map: None,
            scenes: Vec::new(),
            targets: Vec::new(),
            cast_count: 0,
            anchors: None,
            last: None,
            upload,
        })
    }

    /// Uploads coarser levels of the volume.
    pub(super) fn add_levels(&mut self, coarser: &[Volume]) -> Result<(), GpuError> {
        for volume in coarser {
            let format = self.levels[0].format();
            self.levels.push(GpuVolume::upload_as(&self.gpu, volume, format, &mut |_, _| {})?);
        }
        Ok(())
    }

    /// Levels of the volume, itself included.
    pub(super) fn level_count(&self) -> usize {
        self.levels.len()
    }

    pub(super) fn prepare(
        &mut self,
        parameters: &CastParameters,
        skipping: &Skipping,
    ) -> Result<Shot, GpuError> {
        let scene = self.scene(0, parameters, skipping)?;
        self.scenes.push(scene);
        Ok(Shot(self.scenes.len() - 1))
    }

    pub(super) fn prepare_detail(
        &mut self,
        parameters: &CastParameters,
        skipping: &Skipping,
        level_of_detail: LevelOfDetail,
    ) -> Result<Shot, GpuError> {
        let mut levels = Vec::new();
        let scene = self.scene(0, parameters, skipping)?;
        for level in 0..level_of_detail.level_count(self.level_count()) {
            let sampled = level_of_detail.sampled(level);
            let alone = match level {
                0 => Arc::clone(&scene.prepared),
                _ => self.scene(sampled, &parameters.of_level(level), skipping)?.prepared,
            };
            let behind = self.renderer.behind(&self.gpu, &alone)?;
            levels.push(Level { alone, behind });
        }
        self.scenes.push(Scene { detail: Some(Detail { level_of_detail, levels }), ..scene });
        Ok(Shot(self.scenes.len() - 1))
    }

    pub(super) fn prepare_leaping(
        &mut self,
        parameters: &CastParameters,
        skipping: &Skipping,
    ) -> Result<Shot, GpuError> {
        let scene = self.scene(0, parameters, skipping)?;
        let prepared = Arc::new(self.renderer.leaping(&self.gpu, &scene.prepared)?);
        self.scenes.push(Scene { prepared, ..scene });
        Ok(Shot(self.scenes.len() - 1))
    }

    /// One level with some settings.
    fn scene(
        &mut self,
        level: usize,
        parameters: &CastParameters,
        skipping: &Skipping,
    ) -> Result<Scene, GpuError> {
        let gradient_map = self.gradient_map(parameters, skipping)?;
        let mut parameters = parameters.clone();
        let (structures, leaping) = match self.plan(level, skipping.request) {
            None => (Structures::Nothing, Leaping::NOTHING),
            Some(plan) if matches!(parameters.mode, Mode::Mip | Mode::MinIp) => {
                let kernels = self.kernels()?;
                let ranges =
                    GpuBlockRanges::of_values(&self.gpu, &kernels, &self.levels[level], plan.block_size)?;
                let leaping = Leaping::over_idle_blocks(&plan, ranges.byte_size());
                (Structures::Ranges(ranges), leaping)
            }
            Some(plan) => self.skip_map(level, &mut parameters, gradient_map.as_ref(), &plan)?,
        };
        let leap = match &structures {
            Structures::Nothing => Leap::Nothing,
            Structures::Map(map) => Leap::EmptyBlocks(map),
            Structures::Ranges(ranges) => Leap::IdleBlocks(ranges),
        };
        let sources = Sources { volume: &self.levels[level], gradient_map: gradient_map.as_ref(), leap };
        let prepared = self.renderer.prepare(&self.gpu, &sources, parameters)?;
        let gradient_map =
            gradient_map.as_ref().map(|map| GradientMapSize { depth: map.depth(), bytes: map.byte_size() });
        Ok(Scene { prepared: Arc::new(prepared), gradient_map, leaping, detail: None })
    }

    pub(super) fn plan(&self, level: usize, request: SkipRequest) -> Option<SkipPlan> {
        request.plan(self.levels[level].dims(), self.storage, self.gpu.capabilities().skip_host())
    }

    /// What rays leap over; the parameters get to know where the volume is occupied.
    fn skip_map(
        &mut self,
        level: usize,
        parameters: &mut CastParameters,
        gradient_map: Option<&GpuGradientMap>,
        plan: &SkipPlan,
    ) -> Result<(Structures, Leaping), GpuError> {
        let mut builder = self.builder(level, gradient_map, plan.block_size)?;
        let map = builder.map(&self.gpu, parameters, plan.structure)?;
        let distances = map.read(&self.gpu)?;
        let blocks = &distances[..map.grid().block_count()];
        let occupied = || (0..blocks.len()).filter(|&block| blocks[block] == 0);
        let occupied_fraction = occupied().count() as f64 / blocks.len() as f64;
        *parameters = parameters.clone().occupied_within(map.grid().bounds(occupied()));
        if !plan.pays(occupied_fraction) {
            return Ok((Structures::Nothing, Leaping::not_worth_it(occupied_fraction)));
        }
        let leaping = Leaping {
            ranges_bytes: builder.ranges_byte_size(),
            working_bytes: builder.working_byte_size(),
            ..Leaping::over_empty_blocks(plan, occupied_fraction, map.byte_size())
        };
        Ok((Structures::Map(map), leaping))
    }

    fn kernels(&mut self) -> Result<SkipKernels, GpuError> {
        if let Some(kernels) = &self.kernels {
            return Ok(kernels.clone());
        }
        let kernels = SkipKernels::new(&self.gpu)?;
        self.kernels = Some(kernels.clone());
        Ok(kernels)
    }

    /// The gradient map that the settings look gradients up in, if they do; the last one is kept.
    fn gradient_map(
        &mut self,
        parameters: &CastParameters,
        skipping: &Skipping,
    ) -> Result<Option<GpuGradientMap>, GpuError> {
        let Some(depth) = skipping.gradient_depth(parameters, self.storage) else { return Ok(None) };
        let kind = (parameters.gradient, depth);
        if let Some((kept, map)) = &self.gradient_map
            && *kept == kind
        {
            return Ok(Some(map.clone()));
        }
        let map = GpuGradientMap::new(&self.gpu, &self.levels[0], parameters.gradient, depth)?;
        self.gradient_map = Some((kind, map.clone()));
        Ok(Some(map))
    }

    fn builder(
        &mut self,
        level: usize,
        gradient_map: Option<&GpuGradientMap>,
        block_size: BlockSize,
    ) -> Result<SkipBuilder, GpuError> {
        let kernels = self.kernels()?;
        let volume = &self.levels[level];
        match gradient_map {
            Some(map) => SkipBuilder::with_gradients(&self.gpu, &kernels, volume, map, block_size),
            None => SkipBuilder::new(&self.gpu, &kernels, volume, block_size),
        }
    }

    pub(super) fn cast(&mut self, shot: Shot, views: &[View]) -> Result<Duration, GpuError> {
        self.fit_targets(views)?;
        let targets = &mut self.targets[..views.len()];
        let scene = &self.scenes[shot.0];
        let start = Instant::now();
        match &scene.detail {
            None => self.renderer.render(&self.gpu, &scene.prepared, views, targets)?,
            Some(detail) => {
                for (view, target) in views.iter().zip(targets) {
                    for (part, prepared) in detail.parts(view) {
                        let target = std::slice::from_mut(target);
                        self.renderer.render(&self.gpu, prepared, &[part], target)?;
                    }
                }
            }
        }
        Ok(start.elapsed())
    }

    pub(super) fn cast_after(&mut self, shot: Shot, last: &View, view: &View) -> Result<Duration, GpuError> {
        let shown = match self.last.take().filter(|target| target.size() == last.size) {
            Some(target) => target,
            None => Target::with_first_hits(&self.gpu, last.size)?,
        };
        let shown = std::slice::from_mut(self.last.insert(shown));
        let prepared = &self.scenes[shot.0].prepared;
        self.renderer.render(&self.gpu, prepared, &[*last], shown)?;
        self.fit_targets(&[*view])?;
        let prepared = &self.scenes[shot.0].prepared;
        let last = self.last.as_slice();
        let start = Instant::now();
        self.renderer.render_after(&self.gpu, prepared, &[*view], &mut self.targets[..1], last)?;
        Ok(start.elapsed())
    }

    pub(super) fn live(&mut self, shot: Shot) -> LiveEngine<'_> {
        let settings = Arc::clone(&self.scenes[shot.0].prepared);
        LiveEngine { gpu: &self.gpu, renderer: &mut self.renderer, settings }
    }

    pub(super) fn cast_pair(
        &mut self,
        shot: Shot,
        views: [View; 2],
        pairing: &Pairing,
    ) -> Result<PairCast, Underived> {
        let [reference, derived] = pairing.reference.and_other(views);
        let epipolar = Epipolar::new(&reference, &derived).map_err(PairError::from)?;
        self.fit_targets(&views).map_err(Underived::Gpu)?;
        let [left, right, ..] = &mut self.targets[..] else { unreachable!() };
        let targets = pairing.reference.and_other([left, right]);
        let prepared = &self.scenes[shot.0].prepared;
        check_depths(&epipolar, prepared)?;
        let start = Instant::now();
        let report = self.renderer.render_pair(&self.gpu, prepared, &epipolar, pairing.method(), targets)?;
        Ok(PairCast { time: start.elapsed(), report })
    }

    pub(super) fn cast_anchors(
        &mut self,
        shot: Shot,
        views: &[View],
        count: Option<u32>,
    ) -> Result<AnchorCast, Underived> {
        let prepared = &self.scenes[shot.0].prepared;
        let parameters = prepared.parameters();
        let corners = parameters.occupied_corners_world();
        let plan = match count {
            None => AnchorPlan::new(views, parameters.mode, &corners)?,
            Some(count) => AnchorPlan::with_count(views, parameters.mode, &corners, count)?,
        };
        let start = Instant::now();
        let anchors = self.renderer.cast_anchors(&self.gpu, prepared, &plan, self.anchors.take())?;
        let time = start.elapsed();
        let [samples, map_reads] = anchors.reads(&self.gpu)?;
        let bytes = anchors.byte_size();
        self.anchors = Some(anchors);
        let (count, slabs) = (plan.anchors.len(), plan.slabs.count);
        Ok(AnchorCast { count, slabs, time, bytes, samples, map_reads })
    }

    pub(super) fn derive(&mut self, view: usize) -> Result<Duration, Failure> {
        let anchors = self.anchors.take().ok_or_else(|| Failure::input("no anchors have been cast"))?;
        self.fit_targets(&[anchors.view(view)])?;
        let start = Instant::now();
        self.renderer.derive(&self.gpu, &anchors, view, &mut self.targets[0])?;
        let time = start.elapsed();
        self.anchors = Some(anchors);
        Ok(time)
    }

    /// Sees to it that the first targets have the sizes of the views.
    fn fit_targets(&mut self, views: &[View]) -> Result<(), GpuError> {
        for (i, view) in views.iter().enumerate() {
            if self.targets.get(i).is_none_or(|target| target.size() != view.size) {
                self.targets.truncate(i);
                self.targets.push(Target::with_first_hits(&self.gpu, view.size)?);
            }
        }
        self.cast_count = views.len();
        Ok(())
    }

    pub(super) fn read(&self) -> Result<Vec<Cast>, GpuError> {
        self.targets[..self.cast_count].iter().map(|target| target.read(&self.gpu)).collect()
    }

    pub(super) fn leaping(&self, shot: Shot) -> &Leaping {
        &self.scenes[shot.0].leaping
    }

    pub(super) fn gradient_map_size(&self, shot: Shot) -> Option<GradientMapSize> {
        self.scenes[shot.0].gradient_map
    }

    pub(super) fn update_ms(
        &mut self,
        parameters: &CastParameters,
        skipping: &Skipping,
        plan: &SkipPlan,
    ) -> Result<f64, GpuError> {
        let gradient_map = self.gradient_map(parameters, skipping)?;
        let mut builder = self.builder(0, gradient_map.as_ref(), plan.block_size)?;
        let map = builder.map(&self.gpu, parameters, plan.structure)?;
        median_ms(|| {
            builder.update(&self.gpu, parameters, &map)?;
            self.gpu.wait()
        })
    }

    pub(super) fn update_ms_by_voxels(
        &mut self,
        parameters: &CastParameters,
        skipping: &Skipping,
        block_size: BlockSize,
    ) -> Result<f64, GpuError> {
        let gradient_map = self.gradient_map(parameters, skipping)?;
        let kernels = self.kernels()?;
        let baseline =
            DmBaseline::new(&self.gpu, &kernels, &self.levels[0], gradient_map.as_ref(), block_size)?;
        median_ms(|| {
            baseline.map(&self.gpu, parameters)?;
            self.gpu.wait()
        })
    }
}

impl Detail {
    /// The parts of a view from near to far, and what each is cast with.
    fn parts(&self, view: &View) -> Vec<(View, &Prepared)> {
        let slabs = self.level_of_detail.slabs(view, self.levels[0].alone.parameters(), self.levels.len());
        let prepared = |(nearer, slab): (usize, &Slab)| {
            let Level { alone, behind } = &self.levels[slab.level];
            (slab.part_of(view), if nearer == 0 { &**alone } else { behind })
        };
        slabs.iter().enumerate().map(prepared).collect()
    }
}

/// Checks that no part of the volume is too near for a pair of one cast.
fn check_depths(epipolar: &Epipolar, prepared: &Prepared) -> Result<(), Underived> {
    let depths_m = epipolar.depths_m(&prepared.parameters().visible_corners_world());
    let least_m = epipolar.least_depth_m();
    match depths_m {
        Some(depths_m) if depths_m.start < least_m => Err(Underived::Refused(format!(
            "the volume is as near as {:.3} m, rays of both eyes are alike from {least_m:.3} m on",
            depths_m.start
        ))),
        _ => Ok(()),
    }
}
