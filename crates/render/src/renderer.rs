//! The renderer: what is kept between frames, and the one loop over views.

use crate::anchors::{DerivePass, FillPass};
use crate::buffers::storage;
use crate::cast_pass::{self, Tiles, Variant, VariantPipelines};
use crate::first_hits::{GpuFirstHits, StartPass};
use crate::gpu::{Gpu, GpuError};
use crate::gradient_map::GpuGradientMap;
use crate::groups::{Bindings, GroupLayouts, RAY_STATE_BYTES, bind};
use crate::layers_error::LayersError;
use crate::leap::{self, Leap};
use crate::lit_spheres;
use crate::pacer::{BAND_ROWS, Pacer, band_samples, fitting_bands, sample_limit, spreading_stride};
use crate::piece::Picture;
use crate::squares::Squares;
use crate::stamps::Stamps;
use crate::stereo::{
    LayerFormat, LayerPass, NovelViewPass, PairTilePass, Quality, RepairPass, Repairs, StripPass,
};
use crate::target::{LAYERS, Target, target_texture};
use crate::tile_pass::{Listing, TileList, TilePass};
use crate::uniforms::{CastUniform, ViewUniform};
use crate::volume::GpuVolume;
use glam::{DVec3, Vec3};
use half::f16;
use std::collections::HashMap;
use std::sync::{Arc, OnceLock};
use std::time::Instant;
use wgpu::util::DeviceExt as _;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::reference::Cast;
use wheatstone_core::scene::Mode;
use wheatstone_core::skip::BlockSize;
use wheatstone_core::transfer::{LUT_1D_ENTRIES, LutEntry};
use wheatstone_core::view::View;
use wheatstone_core::warp::{LayerError, LayerThresholds};

/// Opacity at which rays of anchors end at the latest: what is behind that is not kept, for what a slab adds to the picture would be
/// rounded too much to tell what is in it.
const MOST_ANCHOR_ALPHA: f32 = 0.999;

/// Most bytes of ray states between dispatches.
pub(crate) const MOST_STATE_BYTES: u64 = 64 << 20;

/// Pipelines and pacing, made once per device.
#[derive(Debug)]
pub struct Renderer {
    groups: GroupLayouts,
    pub(crate) casts: VariantPipelines,
    pub(crate) tile_pass: TilePass,
    pub(crate) start_pass: StartPass,
    /// Scenes that have been prepared.
    scenes: u64,
    /// That of the last picture.
    tile_list: Option<TileList>,
    /// Rays of the last picture that was cast in parts.
    states: Option<wgpu::Buffer>,
    /// What targets are emptied with.
    pub(crate) zeros: wgpu::Buffer,
    strip_passes: HashMap<Quality, StripPass>,
    repair_pass: Option<RepairPass>,
    repairs: Option<Repairs>,
    pair_tile_passes: HashMap<Quality, PairTilePass>,
    layer_passes: HashMap<(LayerFormat, Quality), LayerPass>,
    pub(crate) novel_view_pass: Option<NovelViewPass>,
    pub(crate) derive_pass: Option<DerivePass>,
    /// What fills the hidden cells of anchors, once that has been asked for.
    pub(crate) fill_pass: Option<FillPass>,
    sampler: wgpu::Sampler,
    /// Stands where a cast without skipping has no map.
    no_map: wgpu::TextureView,
    /// Stands where a cast keeps no layers.
    no_layers: wgpu::Texture,
    /// Copy of the picture that the last cast went on behind.
    front: Target,
    /// Stand where a cast keeps no rays, lists no tiles and notes no first hits.
    pub(crate) unused: [wgpu::Buffer; 3],
    pacer: Pacer,
}

/// What a cast reads besides its parameters.
#[derive(Debug, Clone, Copy)]
pub struct Sources<'a> {
    /// The voxels.
    pub volume: &'a GpuVolume,
    /// Where two-dimensional transfer functions look gradient magnitudes up; without it they are estimated around each
    /// sample.
    pub gradient_map: Option<&'a GpuGradientMap>,
    /// What rays leap over.
    pub leap: Leap<'a>,
}

impl<'a> Sources<'a> {
    /// A volume alone: every sample is taken, every gradient estimated.
    pub fn volume(volume: &'a GpuVolume) -> Self {
        Self { volume, gradient_map: None, leap: Leap::Nothing }
    }
}

/// A volume with the settings that it is shown with, ready to be cast from any view. Made once per change of
/// either.
#[derive(Debug)]
pub struct Prepared {
    pub(crate) parameters: CastParameters,
    pub(crate) variant: Variant,
    /// By what tiles are listed, if they are.
    pub(crate) listing: Option<Listing>,
    /// What volume is shown with what settings: another number for each that is prepared.
    pub(crate) scene: u64,
    pub(crate) iterations_per_sample: u32,
    pub(crate) iterations_of_shading: u32,
    cast_uniform: CastUniform,
    /// Blocks of the map that is leapt by.
    skip_block: Option<BlockSize>,
    pub(crate) view_uniform: wgpu::Buffer,
    pub(crate) frame: wgpu::BindGroup,
    pub(crate) volume: wgpu::BindGroup,
    /// The box outside of which no block is occupied, texture space, once it is known: that of all that show the same.
    occupied: Arc<OnceLock<[Vec3; 2]>>,
}

impl Prepared {
    /// What is cast.
    pub fn parameters(&self) -> &CastParameters {
        &self.parameters
    }

    /// From now on it is known that all occupied blocks are in a box, texture space: fewer pixels are cast, and warps have less to search.
    /// No picture changes by that. What is known already stays.
    pub fn know_occupied(&self, occupied: [Vec3; 2]) {
        self.occupied.get_or_init(|| occupied);
    }

    /// The corners of the part of the visible box that may be occupied, as far as is known, world space, metres.
    pub fn occupied_corners_world(&self) -> [DVec3; 8] {
        match self.occupied.get() {
            Some(&occupied) => self.parameters.corners_world_of_occupied(occupied),
            None => self.parameters.occupied_corners_world(),
        }
    }

    /// The same with a kernel that records what rays pass.
    fn recording(self, variant: Variant) -> Self {
        let iterations_per_sample = self.iterations_per_sample + cast_pass::ITERATIONS_OF_RECORDING;
        Self { variant, iterations_per_sample, ..self }
    }

    /// Whether casts keep layers of emission and absorption beside the picture.
    pub fn keeps_layers(&self) -> bool {
        self.variant.keeps_layers()
    }
}

impl Renderer {
    /// Makes what is kept for a device.
    ///
    /// # Errors
    /// A device that refuses or is lost.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let groups = GroupLayouts::new(&gpu.device);
        let casts = VariantPipelines::of_views(&gpu.device, &groups);
        let tile_pass = TilePass::new(&gpu.device, &groups)?;
        let start_pass = StartPass::new(&gpu.device)?;
        let zeros = Target::zeros(gpu);
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("trilinear"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let no_map = gpu
            .device
            .create_texture(&wgpu::TextureDescriptor {
                label: Some("no skip map"),
                size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D3,
                format: wgpu::TextureFormat::R8Uint,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
            .create_view(&wgpu::TextureViewDescriptor::default());
        let no_layers = target_texture(gpu, "no layers", wgpu::TextureFormat::Rgba32Uint, [1, 1], 1);
        let front = Target::new(gpu, [1, 1])?;
        let unused =
            [(); 3].map(|()| storage(&gpu.device, "unused", RAY_STATE_BYTES, wgpu::BufferUsages::empty()));
        gpu.check()?;
        Ok(Self {
            groups,
            casts,
            tile_pass,
            start_pass,
            scenes: 0,
            tile_list: None,
            states: None,
            zeros,
            strip_passes: HashMap::new(),
            repair_pass: None,
            repairs: None,
            pair_tile_passes: HashMap::new(),
            layer_passes: HashMap::new(),
            novel_view_pass: None,
            derive_pass: None,
            fill_pass: None,
            sampler,
            unused,
            no_map,
            no_layers,
            front,
            pacer: Pacer::new(),
        })
    }

    /// Prepares a volume to be cast with some parameters.
    ///
    /// # Errors
    /// A kernel that the driver refuses, no memory, a lost device.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        sources: &Sources<'_>,
        parameters: CastParameters,
    ) -> Result<Prepared, GpuError> {
        let listing = Listing::for_cast(gpu, &parameters, &sources.leap);
        let tiles = if listing.is_some() { Tiles::Listed } else { Tiles::All };
        let variant = Variant::of(&parameters, sources, tiles);
        self.casts.pipeline(gpu, variant)?;
        let Sources { volume, gradient_map, leap } = sources;
        let iterations_per_sample = cast_pass::iterations_per_sample(&parameters, leap);
        let iterations_of_shading = cast_pass::iterations_of_shading(&parameters, leap);
        let stored = volume.encoding().normalised_from_stored(parameters.window);
        let magnitude_scale = gradient_map.map_or(0.0, |map| map.normalised_from_sampled(stored.0));
        let cast_uniform = CastUniform::new(
            &parameters,
            volume.dims,
            volume.normalised_from_sampled(parameters.window),
            &leap.uniform(&parameters, stored, shortest_run(gpu)),
            magnitude_scale as f32,
        );
        // One of the two table bindings holds the table, the other an empty one.
        let entries = parameters.lut.entries();
        let lut = &parameters.lut;
        let (lut_1d, lut_2d) = if lut.height() == 1 {
            (packed(entries), lut_texture(gpu, [1, 1], &[[0.0; 4]]))
        } else {
            (vec![[0; 4]; LUT_1D_ENTRIES], lut_texture(gpu, [lut.width(), lut.height()], entries))
        };
        let lut_1d = init_buffer(gpu, "lut", bytemuck::cast_slice(&lut_1d), wgpu::BufferUsages::UNIFORM);
        let (view_uniform, frame) = self.frame(gpu, &cast_uniform);
        let leap_texture = leap.texture();
        let styles = &parameters.lit_spheres;
        let lit_spheres = (!styles.is_empty()).then(|| lit_spheres::texture(gpu, styles));
        let volume = bind(
            &gpu.device,
            &self.groups.volume,
            &[
                wgpu::BindingResource::TextureView(&volume.texture),
                wgpu::BindingResource::Sampler(&self.sampler),
                wgpu::BindingResource::TextureView(&lut_2d),
                lut_1d.as_entire_binding(),
                wgpu::BindingResource::TextureView(leap_texture.as_ref().unwrap_or(&self.no_map)),
                wgpu::BindingResource::TextureView(gradient_map.map_or(&volume.texture, |map| &map.view)),
                wgpu::BindingResource::TextureView(lit_spheres.as_ref().unwrap_or(&volume.texture)),
            ],
        );
        gpu.check()?;
        self.scenes += 1;
        Ok(Prepared {
            parameters,
            variant,
            listing,
            scene: self.scenes,
            iterations_per_sample,
            iterations_of_shading,
            cast_uniform,
            skip_block: leap.skip_block(),
            view_uniform,
            frame,
            volume,
            occupied: Arc::default(),
        })
    }

    /// The same, cast with layers of emission and absorption beside the picture, four at most, into targets that have room for them:
    /// what volumetric warps read (`Caster::cast_emission_absorption`).
    ///
    /// # Errors
    /// Other modes than composites, more thresholds, a kernel that the driver refuses, no memory, a lost device.
    pub fn with_layers(
        &mut self,
        gpu: &Gpu,
        prepared: &Prepared,
        thresholds: &LayerThresholds,
    ) -> Result<Prepared, LayersError> {
        let mode = prepared.parameters.mode;
        if mode != Mode::Composite {
            return Err(LayersError::Layers(LayerError::Mode(mode)));
        }
        let opacities = thresholds.opacities();
        if opacities.len() > LAYERS as usize {
            return Err(LayersError::Count(opacities.len()));
        }
        let variant = prepared.variant.with_layers();
        self.casts.pipeline(gpu, variant)?;
        let cast_uniform = prepared.cast_uniform.with_layers(opacities);
        Ok(self.reframed(gpu, prepared, prepared.parameters.clone(), cast_uniform)?.recording(variant))
    }

    /// The same of a composite, whose rays leave what they pass in slabs of depth beside the picture, in targets that have room for that.
    ///
    /// # Errors
    /// A kernel that the driver refuses, no memory, a lost device.
    pub(crate) fn with_slabs(&mut self, gpu: &Gpu, prepared: &Prepared) -> Result<Prepared, GpuError> {
        let variant = prepared.variant.with_slabs();
        self.casts.pipeline(gpu, variant)?;
        let termination_alpha = prepared.parameters.termination_alpha.min(MOST_ANCHOR_ALPHA);
        let parameters = CastParameters { termination_alpha, ..prepared.parameters.clone() };
        let cast_uniform = CastUniform { termination_alpha, ..prepared.cast_uniform };
        Ok(self.reframed(gpu, prepared, parameters, cast_uniform)?.recording(variant))
    }

    /// The same of a composite, cast behind what targets hold: each ray goes on with what its pixel has gathered. For the slabs of
    /// a level of detail but the nearest (`Caster::cast_behind`).
    ///
    /// # Errors
    /// A kernel that the driver refuses, no memory, a lost device.
    ///
    /// # Panics
    /// If another mode than composites was prepared.
    pub fn behind(&mut self, gpu: &Gpu, prepared: &Prepared) -> Result<Prepared, GpuError> {
        assert_eq!(prepared.parameters.mode, Mode::Composite, "only composites are cast behind anything");
        let variant = prepared.variant.behind();
        self.casts.pipeline(gpu, variant)?;
        let same = self.reframed(gpu, prepared, prepared.parameters.clone(), prepared.cast_uniform)?;
        Ok(Prepared { variant, listing: None, ..same })
    }

    /// The same, cast with rays that leap to what the last picture saw first ([`Renderer::render_after`]) into targets that have room
    /// for that ([`Target::with_first_hits`]). Neither with layers nor behind anything; modes without first hits are cast as before.
    ///
    /// # Errors
    /// A kernel that the driver refuses, no memory, a lost device.
    pub fn leaping(&mut self, gpu: &Gpu, prepared: &Prepared) -> Result<Prepared, GpuError> {
        let has_first_hits = prepared.parameters.has_first_hits();
        let may_leap = has_first_hits && !prepared.variant.is_behind() && !prepared.variant.keeps_layers();
        let (variant, listing) = if may_leap {
            let listing = Listing::of_leaping(gpu, prepared.listing);
            let tiles = if listing.is_some() { Tiles::Listed } else { Tiles::All };
            (prepared.variant.leaping(tiles), listing)
        } else {
            (prepared.variant, prepared.listing)
        };
        self.casts.pipeline(gpu, variant)?;
        let same = self.reframed(gpu, prepared, prepared.parameters.clone(), prepared.cast_uniform)?;
        Ok(Prepared { variant, listing, ..same })
    }

    /// The same, cast with steps so many times as long.
    ///
    /// # Errors
    /// No memory, a lost device.
    pub(crate) fn with_longer_steps(
        &self,
        gpu: &Gpu,
        prepared: &Prepared,
        step_factor: f64,
    ) -> Result<Prepared, GpuError> {
        let sampling_factor = (f64::from(prepared.parameters.sampling_factor) / step_factor) as f32;
        let parameters = CastParameters { sampling_factor, ..prepared.parameters.clone() };
        let skip_margin = prepared.skip_block.map_or(0.0, |block| leap::skip_margin(&parameters, block));
        let cast_uniform = CastUniform { sampling_factor, skip_margin, ..prepared.cast_uniform };
        self.reframed(gpu, prepared, parameters, cast_uniform)
    }

    /// The same with other parameters and their uniform.
    fn reframed(
        &self,
        gpu: &Gpu,
        prepared: &Prepared,
        parameters: CastParameters,
        cast_uniform: CastUniform,
    ) -> Result<Prepared, GpuError> {
        let (view_uniform, frame) = self.frame(gpu, &cast_uniform);
        gpu.check()?;
        let (volume, occupied) = (prepared.volume.clone(), Arc::clone(&prepared.occupied));
        Ok(Prepared { parameters, cast_uniform, view_uniform, frame, volume, occupied, ..*prepared })
    }

    /// The buffer of a view and the group that it makes with some parameters.
    fn frame(&self, gpu: &Gpu, cast_uniform: &CastUniform) -> (wgpu::Buffer, wgpu::BindGroup) {
        let parameters = init_buffer(
            gpu,
            "cast parameters",
            bytemuck::bytes_of(cast_uniform),
            wgpu::BufferUsages::UNIFORM,
        );
        let view = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("view"),
            size: size_of::<ViewUniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let frame = bind(
            &gpu.device,
            &self.groups.frame,
            &[parameters.as_entire_binding(), view.as_entire_binding()],
        );
        (view, frame)
    }

    /// Casts each view into its target and waits until all are done.
    ///
    /// # Errors
    /// No memory, a lost or hung device.
    ///
    /// # Panics
    /// If there are not as many targets as views, or a target has another size than its view.
    pub fn render(
        &mut self,
        gpu: &Gpu,
        prepared: &Prepared,
        views: &[View],
        targets: &mut [Target],
    ) -> Result<(), GpuError> {
        self.render_after(gpu, prepared, views, targets, &[])
    }

    /// The same, with rays that leap to what the last pictures saw first, one for each view as far as there are any. They do if both
    /// were prepared for that as one scene, and cast into targets that have room for it.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    ///
    /// # Panics
    /// As [`Renderer::render`].
    pub fn render_after(
        &mut self,
        gpu: &Gpu,
        prepared: &Prepared,
        views: &[View],
        targets: &mut [Target],
        last: &[Target],
    ) -> Result<(), GpuError> {
        assert_eq!(views.len(), targets.len(), "one target per view");
        let last = last.iter().map(Some).chain(std::iter::repeat(None));
        for ((view, target), last) in views.iter().zip(targets).zip(last) {
            assert_eq!(view.size, target.size(), "a target has the size of its view");
            let last = last.and_then(|last| last.first_hits.as_ref());
            if let Some(hits) = &mut target.first_hits {
                self.find_starts(gpu, (prepared, view), hits, last);
            }
            self.cast(gpu, prepared, view, target)?;
            if let Some(hits) = &mut target.first_hits {
                hits.note(prepared, view);
            }
        }
        Ok(())
    }

    /// Finds where the rays of a view start that is cast next, if they are to leap.
    fn find_starts(
        &self,
        gpu: &Gpu,
        picture: (&Prepared, &View),
        hits: &mut GpuFirstHits,
        last: Option<&GpuFirstHits>,
    ) {
        hits.forget();
        if !picture.0.variant.leaps() {
            return;
        }
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.start_pass.encode(gpu, &mut encoder, picture, hits, last);
        gpu.queue.submit([encoder.finish()]);
    }

    /// Casts views into targets made for them, and reads the pictures back.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn render_to_host(
        &mut self,
        gpu: &Gpu,
        prepared: &Prepared,
        views: &[View],
    ) -> Result<Vec<Cast>, GpuError> {
        let mut targets: Vec<Target> =
            views.iter().map(|v| Target::new(gpu, v.size)).collect::<Result<_, _>>()?;
        self.render(gpu, prepared, views, &mut targets)?;
        targets.iter().map(|target| target.read(gpu)).collect()
    }

    /// Strips of a quality, made when first asked for.
    pub(crate) fn strips(&mut self, gpu: &Gpu, quality: Quality) -> &mut StripPass {
        self.strip_passes.entry(quality).or_insert_with(|| StripPass::new(&gpu.device, &self.groups, quality))
    }

    /// Room for the repairs of a picture: that of the last one if it is large enough.
    pub(crate) fn repairs(&mut self, gpu: &Gpu, size: [u32; 2]) -> Repairs {
        let kept = self.repairs.take().filter(|repairs| repairs.has_room(size));
        self.repairs.insert(kept.unwrap_or_else(|| Repairs::new(gpu, size))).clone()
    }

    /// The listing of repairs, made when first asked for.
    pub(crate) fn repair_pass(&mut self, gpu: &Gpu) -> Result<&RepairPass, GpuError> {
        match self.repair_pass.take() {
            Some(pass) => Ok(self.repair_pass.insert(pass)),
            None => Ok(self.repair_pass.insert(RepairPass::new(&gpu.device, &self.groups)?)),
        }
    }

    /// Room for rays that are cast in parts: that of the last picture if it is large enough.
    pub(crate) fn states(&mut self, gpu: &Gpu, bytes: u64) -> wgpu::Buffer {
        let kept = self.states.take().filter(|states| states.size() >= bytes);
        let new = || storage(&gpu.device, "ray states", bytes, wgpu::BufferUsages::empty());
        self.states.insert(kept.unwrap_or_else(new)).clone()
    }

    /// Tiles of pairs of a quality, made when first asked for.
    pub(crate) fn tiles(&mut self, gpu: &Gpu, quality: Quality) -> &mut PairTilePass {
        let make = || PairTilePass::new(&gpu.device, &self.groups, quality);
        self.pair_tile_passes.entry(quality).or_insert_with(make)
    }

    /// Layers of a format and quality, made when first asked for.
    pub(crate) fn layers(&mut self, gpu: &Gpu, format: LayerFormat, quality: Quality) -> &mut LayerPass {
        let make = || LayerPass::new(&gpu.device, &self.groups, format, quality);
        self.layer_passes.entry((format, quality)).or_insert_with(make)
    }

    /// The bindings of a target, of the rays that are kept, of the tiles that are listed, of what is in front and of first hits.
    pub(crate) fn target_group(
        &self,
        gpu: &Gpu,
        target: &Target,
        [states, tiles]: [&wgpu::Buffer; 2],
    ) -> wgpu::BindGroup {
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let layers = target.layers.as_ref().unwrap_or(&self.no_layers);
        let (starts, recorded) = match (&target.first_hits, &target.slabs) {
            (Some(hits), _) => (&hits.starts, &hits.nearness),
            (None, Some(slabs)) => (&self.front.depth, &slabs.cells),
            (None, None) => (&self.front.depth, &self.unused[2]),
        };
        bind(
            &gpu.device,
            &self.groups.target,
            &[
                wgpu::BindingResource::TextureView(&view(&target.color)),
                wgpu::BindingResource::TextureView(&view(&target.depth)),
                states.as_entire_binding(),
                tiles.as_entire_binding(),
                wgpu::BindingResource::TextureView(&layers.create_view(&wgpu::TextureViewDescriptor {
                    dimension: Some(wgpu::TextureViewDimension::D2Array),
                    ..Default::default()
                })),
                wgpu::BindingResource::TextureView(&view(&self.front.color)),
                wgpu::BindingResource::TextureView(&view(&self.front.depth)),
                wgpu::BindingResource::TextureView(&view(starts)),
                recorded.as_entire_binding(),
            ],
        )
    }

    /// Empties what a target holds, before squares of it are drawn.
    pub(crate) fn blank(&self, gpu: &Gpu, target: &mut Target, next: &Squares) {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        target.blank(&mut encoder, &self.zeros, next);
        gpu.queue.submit([encoder.finish()]);
    }

    /// Keeps what a target holds for a cast behind it, which draws over other squares as well.
    fn keep_front(&mut self, gpu: &Gpu, target: &mut Target, next: &Squares) -> Result<(), GpuError> {
        if self.front.size() != target.size() {
            self.front = Target::new(gpu, target.size())?;
        }
        target.drawn = target.drawn.around(next);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        target.copy_drawn(&mut encoder, &self.front);
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Casts one view piece by piece: rows, and for rays that are too long for one dispatch ranges of samples.
    pub(crate) fn cast(
        &mut self,
        gpu: &Gpu,
        prepared: &Prepared,
        view: &View,
        target: &mut Target,
    ) -> Result<(), GpuError> {
        let parameters = &prepared.parameters;
        let [width, height] = view.size;
        let state_row_bytes = u64::from(width) * prepared.variant.state_bytes();
        let state_rows =
            ((MOST_STATE_BYTES / state_row_bytes) as u32).clamp(BAND_ROWS, height.max(BAND_ROWS));
        let most_samples = parameters.most_samples_per_ray();
        let iterations = prepared.iterations_per_sample;
        let may_be_split = sample_limit(most_samples, iterations, 1.0) != u32::MAX;
        let kept_rows = if may_be_split { state_rows } else { BAND_ROWS };
        let covered = Squares::covered(view, &prepared.occupied_corners_world());
        if prepared.variant.is_behind() {
            self.keep_front(gpu, target, &covered)?;
        } else {
            self.blank(gpu, target, &covered);
        }
        let states = self.states(gpu, state_row_bytes * u64::from(kept_rows));
        let kept_list = self.tile_list.take();
        let list = prepared.listing.map(|_| self.tile_pass.list(&gpu.device, view.size, kept_list));
        let tiles = list.as_ref().map_or(&self.unused[1], |list| &list.tiles);
        let target_group = self.target_group(gpu, target, [&states, tiles]);
        let bindings = Bindings { frame: &prepared.frame, volume: &prepared.volume, target: &target_group };
        let tile_pass = self.tile_pass.clone();
        let listed = list.as_ref().zip(prepared.listing);
        let picture = Picture { bindings, list: listed.map(|(list, by)| (&tile_pass, list, by)) };

        let reads = cast_pass::reads_per_sample(parameters);
        let bands = band_samples(parameters, view);
        let bands_with_states = if may_be_split { state_rows / BAND_ROWS } else { u32::MAX };
        let mut piece = ViewUniform::of_squares(parameters, view, &covered);
        if let Some(slabs) = &target.slabs {
            piece.pair = slabs.uniform();
        }
        if let Some(list) = &list {
            let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            list.begin_picture(&mut encoder);
            gpu.queue.submit([encoder.finish()]);
        }
        let last_row = height.min(covered.bands.end * BAND_ROWS);
        while piece.first_row < last_row {
            let budget = self.pacer.budget(reads);
            let left = &bands[(piece.first_row / BAND_ROWS) as usize..covered.bands.end as usize];
            let left = &left[..left.len().min(bands_with_states as usize)];
            let (band_count, samples) = fitting_bands(left, budget);
            let share_of_ray = (budget / samples).min(1.0);
            piece.row_count = (band_count * BAND_ROWS).min(last_row - piece.first_row);
            piece.sample_limit = sample_limit(most_samples, iterations, share_of_ray);
            piece.band_stride = if gpu.description().is_software { spreading_stride(band_count) } else { 1 };
            piece.first_sample = 0;
            let pipeline = self.piece_pipeline(gpu, prepared, &piece)?;
            let squares = [covered.columns.len() as u32, band_count];
            while piece.first_sample < most_samples {
                gpu.queue.write_buffer(&prepared.view_uniform, 0, bytemuck::bytes_of(&piece));
                let mut encoder =
                    gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
                picture.encode_piece(&mut encoder, &pipeline, piece.first_sample, squares, Stamps::NONE);
                let start = Instant::now();
                gpu.queue.submit([encoder.finish()]);
                gpu.wait()?;
                let share = (f64::from(piece.sample_limit) / f64::from(most_samples)).min(1.0);
                self.pacer.learn(samples * share, start.elapsed());
                piece.first_sample = piece.first_sample.saturating_add(piece.sample_limit);
            }
            piece.first_row += piece.row_count;
        }
        self.tile_list = list;
        Ok(())
    }
}

/// A two-dimensional table as `lib/lut_2d.wgsl` reads it.
fn lut_texture(gpu: &Gpu, [width, height]: [usize; 2], entries: &[LutEntry]) -> wgpu::TextureView {
    let texels: Vec<f16> = entries.iter().flatten().map(|&channel| f16::from_f32(channel)).collect();
    let descriptor = wgpu::TextureDescriptor {
        label: Some("2D lut"),
        size: wgpu::Extent3d { width: width as u32, height: height as u32, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    gpu.device
        .create_texture_with_data(
            &gpu.queue,
            &descriptor,
            wgpu::util::TextureDataOrder::LayerMajor,
            bytemuck::cast_slice(&texels),
        )
        .create_view(&wgpu::TextureViewDescriptor::default())
}

/// A one-dimensional table as `lib/lut_1d.wgsl` reads it.
fn packed(entries: &[LutEntry]) -> Vec<[u32; 4]> {
    let color = |[r, g, b]: [f32; 3]| {
        let bits = |channel: f32, largest: f32| (channel.clamp(0.0, 1.0) * largest + 0.5) as u32;
        bits(r, 2047.0) | bits(g, 2047.0) << 11 | bits(b, 1023.0) << 22
    };
    let packed = |(&entry, &next): (&LutEntry, &LutEntry)| {
        let mean = [0, 1, 2].map(|c| 0.5 * (entry[c] + next[c]));
        [color(mean), entry[3].to_bits(), (next[3] - entry[3]).to_bits(), 0]
    };
    let last = &entries[entries.len() - 1..];
    entries.iter().zip(entries[1..].iter().chain(last)).map(packed).collect()
}

/// Samples that a run between leaps is long at least. Software Vulkan runs eight rays in lockstep and takes the same time
/// whether one of them or all need a sample; longer runs spare it searches (`docs/benchmarks/`).
fn shortest_run(gpu: &Gpu) -> f32 {
    if gpu.description().is_software { 12.0 } else { 1.0 }
}

fn init_buffer(gpu: &Gpu, label: &str, contents: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
    gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
}
