//! Leaping over empty blocks.

use super::extreme_value::Better;
use super::lanes::{Lanes, Mask};
use super::ray::Ray;
use super::vector::Vec3;
use crate::cast::Classifier;
use crate::skip::{BlockExtremes, BlockGrid, SkipMap, Structure, margin_blocks};
use glam::Vec3A;
use std::marker::PhantomData;

/// Steps shorter than this along an axis never leave a block along it; in block units.
const PARALLEL: f32 = 1e-20;

/// How far before the edge of what is empty a leap ends at the latest, in block units: more than positions are off by
/// rounding.
const EDGE: f32 = 1.0 / 1024.0;

/// What tells how far blocks are from those that may contribute.
pub(super) trait BlockMap: Copy {
    /// The blocks.
    fn grid(&self) -> &BlockGrid;

    /// The octants that rays with a given step go to, if the map tells them apart; else 0.
    fn octant<L: Lanes>(&self, token: L::Token, step: Vec3<L>) -> L;

    /// Blocks from a block to the nearest one that may contribute to rays of an octant that hold `scalar`; 0 or less if
    /// this one may.
    fn empty_distance<L: Lanes>(&self, token: L::Token, block: Vec3<L>, octant: L, scalar: L) -> L;
}

/// Blocks by their distance from those that may contribute.
#[derive(Debug, Clone, Copy)]
pub(super) struct Distances<'a> {
    map: &'a SkipMap,
    /// Distance, in blocks, up to which a block counts as occupied: samples read that much further than their own block.
    margin: f32,
}

impl BlockMap for Distances<'_> {
    #[inline(always)]
    fn grid(&self) -> &BlockGrid {
        self.map.grid()
    }

    #[inline(always)]
    fn octant<L: Lanes>(&self, token: L::Token, step: Vec3<L>) -> L {
        let zero = L::splat(token, 0.0);
        match self.map.structure() {
            Structure::Occupancy | Structure::Distance => zero,
            Structure::Anisotropic => {
                let bit = |along: L, bit: f32| L::select(along.lt(zero), L::splat(token, bit), zero);
                bit(step.x, 1.0) + bit(step.y, 2.0) + bit(step.z, 4.0)
            }
        }
    }

    #[inline(always)]
    fn empty_distance<L: Lanes>(&self, token: L::Token, block: Vec3<L>, octant: L, _: L) -> L {
        let [columns, rows, slices] = self.map.grid().dims();
        let in_octants = octant.mul_add(L::splat(token, slices as f32), block.z);
        let at = L::to_array_index([block.x, block.y, in_octants], columns, columns * rows);
        L::bytes(token, self.map.distances(), at) - self.margin
    }
}

/// Blocks by whether their best value betters the one that a ray holds.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extremes<'a, B> {
    extremes: &'a BlockExtremes,
    better: PhantomData<B>,
}

impl<B: Better> BlockMap for Extremes<'_, B> {
    #[inline(always)]
    fn grid(&self) -> &BlockGrid {
        self.extremes.grid()
    }

    #[inline(always)]
    fn octant<L: Lanes>(&self, token: L::Token, _: Vec3<L>) -> L {
        L::splat(token, 0.0)
    }

    #[inline(always)]
    fn empty_distance<L: Lanes>(&self, token: L::Token, block: Vec3<L>, _: L, best: L) -> L {
        let [columns, rows, _] = self.extremes.grid().dims();
        let at = L::to_array_index([block.x, block.y, block.z], columns, columns * rows);
        let of_block = L::numbers(token, self.extremes.values(), at);
        L::select(B::is_better(of_block, best), L::splat(token, 0.0), L::splat(token, 1.0))
    }
}

/// A map of blocks as rays in voxel space read it.
#[derive(Debug, Clone, Copy)]
pub(super) struct SkipSampler<M> {
    map: M,
    blocks_from_voxel: Vec3A,
    last_block: Vec3A,
    /// Whether the first sample in an empty block must be taken as well, as it reads what is behind it.
    reads_behind: bool,
}

impl<'a> SkipSampler<Distances<'a>> {
    /// Reads a map for rays with the given length of a step, in voxel lengths.
    pub(super) fn over_empty_blocks(map: &'a SkipMap, classifier: Classifier, step_voxels: f32) -> Self {
        let margin = margin_blocks(classifier, f64::from(step_voxels), map.grid().block_size());
        let reads_behind = classifier == Classifier::Isovalue || margin > 0;
        Self::new(Distances { map, margin: margin as f32 }, reads_behind)
    }
}

impl<'a, B: Better> SkipSampler<Extremes<'a, B>> {
    /// Reads the best values of blocks.
    pub(super) fn over_idle_blocks(extremes: &'a BlockExtremes) -> Self {
        Self::new(Extremes { extremes, better: PhantomData }, false)
    }
}

impl<M: BlockMap> SkipSampler<M> {
    fn new(map: M, reads_behind: bool) -> Self {
        let sides = map.grid().block_size().sides().map(|side| side as f32);
        let last_block = map.grid().dims().map(|n| (n - 1) as f32);
        Self {
            map,
            blocks_from_voxel: Vec3A::from(sides).recip(),
            last_block: last_block.into(),
            reads_behind,
        }
    }

    /// Along rays by their first position and step in voxel space.
    #[inline(always)]
    pub(super) fn along<L: Lanes>(self, token: L::Token, first: Vec3<L>, step: Vec3<L>) -> Blocks<M, L> {
        let scale = Vec3::splat(token, self.blocks_from_voxel);
        let step = step.scaled(scale);
        Blocks {
            sampler: self,
            first: first.scaled(scale),
            step,
            exits: [Exit::new(token, step.x), Exit::new(token, step.y), Exit::new(token, step.z)],
            octant: self.map.octant(token, step),
        }
    }
}

/// When rays leave blocks along an axis.
#[derive(Debug, Clone, Copy)]
struct Exit<L> {
    /// Steps per block, signed; 0 for rays that never leave along this axis.
    steps_per_block: L,
    /// Steps per block in the direction of the ray.
    steps_forward: L,
}

impl<L: Lanes> Exit<L> {
    #[inline(always)]
    fn new(token: L::Token, step: L) -> Self {
        let is_parallel = step.abs().lt(L::splat(token, PARALLEL));
        let steps = L::splat(token, 1.0) / L::select(is_parallel, L::splat(token, PARALLEL), step);
        Self {
            steps_per_block: L::select(is_parallel, L::splat(token, 0.0), steps),
            steps_forward: steps.abs(),
        }
    }

    /// Steps to the edge that is `reach` blocks from the middle of a block.
    #[inline(always)]
    fn steps(&self, block: L, position: L, reach: L) -> L {
        (block + 0.5 - position).mul_add(self.steps_per_block, reach * self.steps_forward)
    }
}

/// Rays through the blocks of a map.
#[derive(Debug, Clone, Copy)]
pub(super) struct Blocks<M, L> {
    sampler: SkipSampler<M>,
    /// Position of sample 0, block units.
    first: Vec3<L>,
    /// From one sample to the next, block units.
    step: Vec3<L>,
    exits: [Exit<L>; 3],
    /// The octant that the rays go to.
    octant: L,
}

/// What a map says of the blocks that samples are in.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look<L: Lanes> {
    pub(super) is_empty: L::Mask,
    /// Steps to the first sample that may be outside the empty blocks, or outside the occupied block; at least 1.
    pub(super) steps: L,
}

impl<M: BlockMap, L: Lanes> Blocks<M, L> {
    /// Looks the blocks of samples up, for rays that hold `scalar` (DM Eq. 14; Eq. 7 for occupied ones).
    #[inline(always)]
    pub(super) fn look(&self, token: L::Token, index: L, scalar: L) -> Look<L> {
        let SkipSampler { map, last_block, .. } = self.sampler;
        let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
        let position = self.step.mul_add(index, self.first);
        let block = position.floor().max(Vec3::splat(token, Vec3A::ZERO)).min(Vec3::splat(token, last_block));
        let distance = map.empty_distance(token, block, self.octant, scalar);
        let reach = distance.max(one) - (0.5 + EDGE);
        let [x, y, z] = &self.exits;
        let steps = x
            .steps(block.x, position.x, reach)
            .min(y.steps(block.y, position.y, reach))
            .min(z.steps(block.z, position.z, reach));
        Look { is_empty: zero.lt(distance), steps: (-(-steps).floor()).max(one) }
    }
}

/// Where the rays of a packet are; each goes at its own pace.
#[derive(Debug, Clone, Copy)]
pub(super) struct Walk<M, L: Lanes> {
    /// The next sample.
    pub(super) index: L,
    /// Which rays go on.
    pub(super) is_active: L::Mask,
    /// Which rays that go on have leapt since their last sample.
    pub(super) has_leapt: L::Mask,
    /// The first sample that may be outside the occupied block.
    leave: L,
    /// For which rays the sample before was in an occupied block, or in one that was not looked up.
    comes_from_occupied: L::Mask,
    end: L,
    blocks: Option<Blocks<M, L>>,
    /// Reads of the map.
    pub(super) map_reads: L,
}

impl<M: BlockMap, L: Lanes> Walk<M, L> {
    /// From sample `first` up to `end`, which is left out.
    #[inline(always)]
    pub(super) fn new(token: L::Token, first: L, end: L, blocks: Option<Blocks<M, L>>) -> Self {
        let is_active = first.lt(end);
        Self {
            index: first,
            is_active,
            has_leapt: is_active & !is_active,
            leave: first,
            comes_from_occupied: is_active,
            end,
            blocks,
            map_reads: L::splat(token, 0.0),
        }
    }

    /// Over all samples of rays from the first that is taken.
    #[inline(always)]
    pub(super) fn along(token: L::Token, ray: &Ray<L>, skip: Option<SkipSampler<M>>) -> Self {
        let blocks = skip.map(
            #[inline(always)]
            |skip| ray.blocks(token, skip),
        );
        Self::new(token, ray.first_sample, ray.sample_count, blocks)
    }

    /// Moves rays that have left their block, of those that may leap, to the next sample that may contribute to what they
    /// hold, `scalar`.
    #[inline(always)]
    pub(super) fn leap(&mut self, token: L::Token, may_leap: L::Mask, scalar: L) {
        let Some(blocks) = &self.blocks else { return };
        let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
        let has_left = self.leave.le(self.index);
        let mut looks = self.is_active & may_leap & has_left;
        self.comes_from_occupied = self.comes_from_occupied | (has_left & !looks);
        self.has_leapt = looks & !looks;
        while looks.any() {
            let look = blocks.look(token, self.index, scalar);
            self.map_reads += L::select(looks, one, zero);
            let next = self.index + look.steps;
            let mut leaps = looks & look.is_empty;
            self.leave = L::select(looks, next, self.leave);
            if blocks.sampler.reads_behind {
                let stays = leaps & self.comes_from_occupied;
                self.leave = L::select(stays, self.index + 1.0, self.leave);
                self.comes_from_occupied = (self.comes_from_occupied | looks) & !(looks & look.is_empty);
                leaps = leaps & !stays;
            }
            self.index = L::select(leaps, next, self.index);
            self.is_active = self.is_active & self.index.lt(self.end);
            looks = leaps & self.is_active;
            self.has_leapt = self.has_leapt | looks;
        }
    }

    /// Goes on to the next sample.
    #[inline(always)]
    pub(super) fn advance(&mut self) {
        self.index = L::select(self.is_active, self.index + 1.0, self.index);
        self.is_active = self.is_active & self.index.lt(self.end);
    }
}
