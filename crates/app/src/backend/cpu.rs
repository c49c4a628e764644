//! A volume on the CPU.

use super::{Leaping, Shot, median_ms};
use crate::skipping::Skipping;
use std::convert::Infallible;
use std::time::{Duration, Instant};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::reference::{Cast, Caster};
use wheatstone_core::skip::{BlockRanges, Occupancy, Pace, SkipMap, SkipPlan, Visibility};
use wheatstone_core::view::View;
use wheatstone_core::volume::{Encoding, StorageKind, Volume};

/// The CPU's side of [`super::Engine`].
pub(crate) struct CpuEngine<'v> {
    volume: &'v Volume,
    storage: StorageKind,
    caster: Caster,
    scenes: Vec<Scene>,
    casts: Vec<Cast>,
    pub(super) upload: Duration,
}

/// What is made once per change of the settings.
struct Scene {
    parameters: CastParameters,
    map: Option<SkipMap>,
    leaping: Leaping,
}

impl<'v> CpuEngine<'v> {
    pub(super) fn new(volume: &'v Volume, storage: StorageKind) -> Self {
        let start = Instant::now();
        let caster = Caster::with_storage(volume, storage);
        let upload = start.elapsed();
        Self { volume, storage, caster, scenes: Vec::new(), casts: Vec::new(), upload }
    }

    pub(super) fn prepare(&mut self, parameters: &CastParameters, skipping: &Skipping) -> Shot {
        let (map, leaping) = match skipping.request.plan(self.storage, Pace::Idle) {
            None => (None, Leaping::NOTHING),
            Some(plan) => self.skip_map(parameters, &plan),
        };
        self.scenes.push(Scene { parameters: parameters.clone(), map, leaping });
        Shot(self.scenes.len() - 1)
    }

    fn skip_map(&self, parameters: &CastParameters, plan: &SkipPlan) -> (Option<SkipMap>, Leaping) {
        let occupancy = self.occupancy(&self.ranges(plan), parameters);
        let occupied_fraction = occupancy.fraction();
        if !plan.pays(occupied_fraction) {
            return (None, Leaping::not_worth_it(occupied_fraction));
        }
        let map = SkipMap::new(&occupancy, plan.structure);
        let leaping = Leaping::over_empty_blocks(plan, occupied_fraction, map.byte_size() as u64);
        (Some(map), leaping)
    }

    fn ranges(&self, plan: &SkipPlan) -> BlockRanges {
        BlockRanges::of_values(self.volume, self.storage, plan.block_size)
    }

    fn occupancy(&self, ranges: &BlockRanges, parameters: &CastParameters) -> Occupancy {
        let encoding = Encoding::new(self.volume, self.storage);
        let normalised = ranges.normalised(encoding.normalised_from_stored(parameters.window));
        Occupancy::new(normalised, None, &Visibility::new(parameters))
    }

    pub(super) fn cast(&mut self, shot: Shot, views: &[View]) -> Duration {
        let scene = &self.scenes[shot.0];
        let start = Instant::now();
        self.casts = self.caster.cast(&scene.parameters, scene.map.as_ref(), views);
        start.elapsed()
    }

    pub(super) fn read(&mut self) -> Vec<Cast> {
        std::mem::take(&mut self.casts)
    }

    pub(super) fn leaping(&self, shot: Shot) -> &Leaping {
        &self.scenes[shot.0].leaping
    }

    pub(super) fn update_ms(&self, parameters: &CastParameters, plan: &SkipPlan) -> f64 {
        let ranges = self.ranges(plan);
        let Ok(update_ms) = median_ms::<Infallible>(|| {
            std::hint::black_box(SkipMap::new(&self.occupancy(&ranges, parameters), plan.structure));
            Ok(())
        });
        update_ms
    }
}
