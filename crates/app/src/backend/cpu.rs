//! A volume on the CPU.

use super::{GradientMapSize, Leaping, Shot, median_ms};
use crate::skipping::Skipping;
use std::convert::Infallible;
use std::rc::Rc;
use std::time::{Duration, Instant};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::detail::LevelOfDetail;
use wheatstone_core::gradient_map::{GradientDepth, GradientMap};
use wheatstone_core::reference::{Aids, Cast, Caster, HeldGradientMap, Leap};
use wheatstone_core::scene::GradientMethod;
use wheatstone_core::skip::{
    BlockExtremes, BlockRanges, BlockSize, Occupancy, SkipHost, SkipMap, SkipPlan, SkipRequest, Visibility,
};
use wheatstone_core::view::View;
use wheatstone_core::volume::{Encoding, StorageKind, Volume};

/// The CPU's side of [`super::Engine`].
pub(crate) struct CpuEngine<'v> {
    volume: &'v Volume,
    storage: StorageKind,
    caster: Caster,
    gradients: Option<Rc<Gradients>>,
    scenes: Vec<Scene>,
    casts: Vec<Cast>,
    /// Coarser levels of the volume.
    coarser: Vec<Self>,
    pub(super) upload: Duration,
}

/// What is made once per change of the settings.
struct Scene {
    parameters: CastParameters,
    gradients: Option<Rc<Gradients>>,
    structures: Structures,
    leaping: Leaping,
    detail: Option<Detail>,
}

/// What is far away.
struct Detail {
    level_of_detail: LevelOfDetail,
    /// Settings for each level of steps above 0, of the engine of the level that they sample.
    coarser: Vec<Shot>,
}

/// What rays leap over.
enum Structures {
    Nothing,
    Map(SkipMap),
    Extremes(BlockExtremes),
}

/// A gradient map, and the same as the caster reads it.
struct Gradients {
    method: GradientMethod,
    map: GradientMap,
    held: HeldGradientMap,
}

/// The ranges of the blocks of a volume, and those of its gradient map.
struct Ranges {
    values: BlockRanges,
    gradients: Option<BlockRanges>,
}

impl Ranges {
    fn byte_size(&self) -> usize {
        self.values.byte_size() + self.gradients.as_ref().map_or(0, BlockRanges::byte_size)
    }
}

impl<'v> CpuEngine<'v> {
    pub(super) fn new(volume: &'v Volume, storage: StorageKind) -> Self {
        let start = Instant::now();
        let caster = Caster::with_storage(volume, storage);
        let upload = start.elapsed();
        Self {
            volume,
            storage,
            caster,
            gradients: None,
            scenes: Vec::new(),
            casts: Vec::new(),
            coarser: Vec::new(),
            upload,
        }
    }

    /// Holds coarser levels of the volume.
    pub(super) fn add_levels(&mut self, coarser: &'v [Volume]) {
        let storage = self.storage;
        self.coarser.extend(coarser.iter().map(|volume| Self::new(volume, storage)));
    }

    /// Levels of the volume, itself included.
    pub(super) fn level_count(&self) -> usize {
        1 + self.coarser.len()
    }

    pub(super) fn prepare_detail(
        &mut self,
        parameters: &CastParameters,
        skipping: &Skipping,
        level_of_detail: LevelOfDetail,
    ) -> Shot {
        let coarser = (1..level_of_detail.level_count(self.level_count()))
            .map(|level| {
                let parameters = parameters.of_level(level);
                match level_of_detail.sampled(level) {
                    0 => self.prepare(&parameters, skipping),
                    sampled => self.coarser[sampled - 1].prepare(&parameters, skipping),
                }
            })
            .collect();
        let shot = self.prepare(parameters, skipping);
        self.scenes[shot.0].detail = Some(Detail { level_of_detail, coarser });
        shot
    }

    pub(super) fn prepare(&mut self, parameters: &CastParameters, skipping: &Skipping) -> Shot {
        let gradients = self.gradients(parameters, skipping);
        let (structures, leaping) = match self.plan(skipping.request) {
            None => (Structures::Nothing, Leaping::NOTHING),
            Some(plan) => self.structures(parameters, gradients.as_deref(), &plan),
        };
        let parameters = parameters.clone();
        self.scenes.push(Scene { parameters, gradients, structures, leaping, detail: None });
        Shot(self.scenes.len() - 1)
    }

    pub(super) fn plan(&self, request: SkipRequest) -> Option<SkipPlan> {
        request.plan(self.volume.grid().dims(), self.storage, SkipHost::Cpu)
    }

    /// The gradient map that the settings look gradients up in, if they do; the last one is kept.
    fn gradients(&mut self, parameters: &CastParameters, skipping: &Skipping) -> Option<Rc<Gradients>> {
        let depth = skipping.gradient_depth(parameters, self.storage)?;
        let method = parameters.gradient;
        if let Some(kept) = &self.gradients
            && (kept.method, kept.map.depth()) == (method, depth)
        {
            return Some(kept.clone());
        }
        let gradients = Rc::new(Gradients::new(self.volume, self.storage, method, depth));
        self.gradients = Some(gradients.clone());
        Some(gradients)
    }

    fn structures(
        &self,
        parameters: &CastParameters,
        gradients: Option<&Gradients>,
        plan: &SkipPlan,
    ) -> (Structures, Leaping) {
        let ranges = self.ranges(gradients, plan.block_size);
        let values = ranges.values.normalised(self.normalised_from_stored(parameters));
        if let Some(extremes) = BlockExtremes::new(values, parameters.mode) {
            let leaping = Leaping {
                ranges_bytes: ranges.byte_size() as u64,
                ..Leaping::over_idle_blocks(plan, extremes.byte_size() as u64)
            };
            return (Structures::Extremes(extremes), leaping);
        }
        let occupancy = self.occupancy(&ranges, parameters, gradients);
        let occupied_fraction = occupancy.fraction();
        if !plan.pays(occupied_fraction) {
            return (Structures::Nothing, Leaping::not_worth_it(occupied_fraction));
        }
        let map = SkipMap::new(&occupancy, plan.structure);
        let working_bytes = plan.working_byte_size(self.volume.grid().dims(), SkipHost::Cpu);
        let leaping = Leaping {
            ranges_bytes: ranges.byte_size() as u64,
            working_bytes: working_bytes as u64,
            ..Leaping::over_empty_blocks(plan, occupied_fraction, map.byte_size() as u64)
        };
        (Structures::Map(map), leaping)
    }

    /// Scale and offset from the stored numbers to normalised values.
    fn normalised_from_stored(&self, parameters: &CastParameters) -> (f64, f64) {
        Encoding::new(self.volume, self.storage).normalised_from_stored(parameters.window)
    }

    fn ranges(&self, gradients: Option<&Gradients>, block_size: BlockSize) -> Ranges {
        Ranges {
            values: BlockRanges::of_values(self.volume, self.storage, block_size),
            gradients: gradients.map(|gradients| BlockRanges::of_gradients(&gradients.map, block_size)),
        }
    }

    fn occupancy(
        &self,
        ranges: &Ranges,
        parameters: &CastParameters,
        gradients: Option<&Gradients>,
    ) -> Occupancy {
        let normalised_from_stored = self.normalised_from_stored(parameters);
        let values = ranges.values.normalised(normalised_from_stored);
        let of_gradients = ranges.gradients.as_ref().zip(gradients).map(|(ranges, gradients)| {
            ranges.normalised(gradients.map.normalised_from_code(normalised_from_stored.0))
        });
        Occupancy::new(values, of_gradients, &Visibility::new(parameters))
    }

    pub(super) fn cast(&mut self, shot: Shot, views: &[View]) -> Duration {
        let scene = &self.scenes[shot.0];
        let start = Instant::now();
        self.casts = match &scene.detail {
            None => self.caster.cast(&scene.parameters, &scene.aids(), views),
            Some(detail) => views.iter().map(|view| self.cast_detail(scene, detail, view)).collect(),
        };
        start.elapsed()
    }

    pub(super) fn cast_after(&mut self, shot: Shot, last: &View, view: &View) -> Duration {
        let Scene { parameters, .. } = &self.scenes[shot.0];
        let aids = self.scenes[shot.0].aids();
        let (_, seen) = self.caster.cast_leaping(parameters, &aids, last, None);
        let start = Instant::now();
        let (cast, _) = self.caster.cast_leaping(parameters, &aids, view, Some(&seen));
        let time = start.elapsed();
        self.casts = vec![cast];
        time
    }

    fn cast_detail(&self, scene: &Scene, detail: &Detail, view: &View) -> Cast {
        let slabs = detail.level_of_detail.slabs(view, &scene.parameters, 1 + detail.coarser.len());
        slabs.iter().fold(Cast::nothing(view.size), |front, slab| {
            let engine = match detail.level_of_detail.sampled(slab.level) {
                0 => self,
                sampled => &self.coarser[sampled - 1],
            };
            let scene = match slab.level {
                0 => scene,
                level => &engine.scenes[detail.coarser[level - 1].0],
            };
            engine.caster.cast_behind(&scene.parameters, &scene.aids(), &slab.part_of(view), front)
        })
    }

    pub(super) fn read(&mut self) -> Vec<Cast> {
        std::mem::take(&mut self.casts)
    }

    pub(super) fn leaping(&self, shot: Shot) -> &Leaping {
        &self.scenes[shot.0].leaping
    }

    pub(super) fn gradient_map_size(&self, shot: Shot) -> Option<GradientMapSize> {
        let map = &self.scenes[shot.0].gradients.as_ref()?.map;
        Some(GradientMapSize { depth: map.depth(), bytes: map.byte_size() as u64 })
    }

    pub(super) fn update_ms(
        &mut self,
        parameters: &CastParameters,
        skipping: &Skipping,
        plan: &SkipPlan,
    ) -> f64 {
        let gradients = self.gradients(parameters, skipping);
        let ranges = self.ranges(gradients.as_deref(), plan.block_size);
        let Ok(update_ms) = median_ms::<Infallible>(|| {
            let occupancy = self.occupancy(&ranges, parameters, gradients.as_deref());
            std::hint::black_box(SkipMap::new(&occupancy, plan.structure));
            Ok(())
        });
        update_ms
    }
}

impl Gradients {
    fn new(volume: &Volume, storage: StorageKind, method: GradientMethod, depth: GradientDepth) -> Self {
        let map = GradientMap::new(volume, storage, method, depth);
        let held = HeldGradientMap::new(&map);
        Self { method, map, held }
    }
}

impl Scene {
    fn aids(&self) -> Aids<'_> {
        Aids {
            gradient_map: self.gradients.as_deref().map(|gradients| &gradients.held),
            leap: match &self.structures {
                Structures::Nothing => Leap::Nothing,
                Structures::Map(map) => Leap::EmptyBlocks(map),
                Structures::Extremes(extremes) => Leap::IdleBlocks(extremes),
            },
        }
    }
}
