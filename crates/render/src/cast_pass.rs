//! The cast pass: which files make up its kernel, and its pipelines.

use crate::gpu::{Gpu, GpuError};
use crate::groups::{Bindings, GroupLayouts, LAYERED_RAY_BYTES, RAY_STATE_BYTES};
use crate::leap::Leap;
use crate::pipeline::{KernelFiles, build};
use crate::renderer::Sources;
use crate::stamps::Stamps;
use crate::volume::TexelFormat;
use std::collections::HashMap;
use wheatstone_core::cast::{AMBIENT_SAMPLES, CastParameters, Classifier, SHADOW_SAMPLES};
use wheatstone_core::scene::{GradientMethod, Mode, Shading};

/// Which pixels a cast visits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tiles {
    /// All of a piece.
    All,
    /// Those of tiles that another pass listed.
    Listed,
}

impl Tiles {
    fn file(self) -> &'static str {
        match self {
            Self::All => TILES_ALL,
            Self::Listed => TILES_LISTED,
        }
    }
}

/// Which files make up a kernel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Variant {
    accumulator: &'static str,
    classifier: &'static str,
    shading: &'static str,
    boundaries: &'static str,
    gradient: &'static str,
    volume: &'static str,
    skip: &'static str,
    blocks: &'static str,
    magnitude: &'static str,
    resume: &'static str,
    tiles: &'static str,
    record: &'static str,
    front: &'static str,
    start: &'static str,
}

impl Variant {
    /// The kernel for some parameters.
    pub(crate) fn of(parameters: &CastParameters, sources: &Sources<'_>, tiles: Tiles) -> Self {
        let (accumulator, is_shaded) = match parameters.mode {
            Mode::Composite => (COMPOSITE, true),
            Mode::Mip => ("lib/accumulate_mip", false),
            Mode::MinIp => ("lib/accumulate_minip", false),
            Mode::Mean => ("lib/accumulate_mean", false),
            Mode::XRay => (XRAY, false),
            Mode::Isosurface { .. } => (FIRST_HIT, true),
        };
        let is_quads = sources.volume.format() == TexelFormat::Rgba8UnormQuads;
        Self {
            accumulator,
            classifier: match parameters.classifier {
                Classifier::Value => "lib/classify_value",
                Classifier::ValueGradient => "lib/classify_value_gradient",
                Classifier::PreIntegrated => "lib/classify_preintegrated",
                Classifier::Isovalue => "lib/classify_isovalue",
            },
            shading: match parameters.shading {
                _ if !is_shaded => "lib/shade_none",
                Shading::None => "lib/shade_none",
                Shading::Phong => "lib/shade_phong",
                Shading::Shadow => "lib/shade_shadow",
                Shading::Ambient => "lib/shade_ambient",
                Shading::Directional { .. } => "lib/shade_directional",
                Shading::LitSphere { .. } => "lib/shade_lit_sphere",
            },
            boundaries: if parameters.boundaries.is_some() { BOUNDARIES_ENHANCED } else { BOUNDARIES_PLAIN },
            gradient: match parameters.gradient {
                GradientMethod::CentralDifferences if is_quads => "lib/gradient_central_quads",
                GradientMethod::CentralDifferences => "lib/gradient_central",
                GradientMethod::Tetrahedron => "lib/gradient_tetrahedron",
            },
            volume: if is_quads { VOLUME_QUADS } else { VOLUME_FILTERED },
            skip: if matches!(sources.leap, Leap::Nothing) { SKIP_NONE } else { SKIP_BLOCKS },
            blocks: match (sources.leap, parameters.mode) {
                (Leap::IdleBlocks(_), Mode::MinIp) => "lib/blocks_by_minimum",
                (Leap::IdleBlocks(_), _) => "lib/blocks_by_maximum",
                (Leap::Nothing | Leap::EmptyBlocks(_), _) => "lib/blocks_by_distance",
            },
            magnitude: if sources.gradient_map.is_some() { MAGNITUDE_MAP } else { MAGNITUDE_ESTIMATED },
            resume: RESUME_WHOLE,
            tiles: tiles.file(),
            record: RECORD_NONE,
            front: FRONT_NONE,
            start: START_AT_ONCE,
        }
    }

    /// The kernel of a composite that goes on behind what its target holds: it leaves pixels as they are whose rays miss.
    pub(crate) fn behind(self) -> Self {
        Self { front: FRONT_PICTURE, tiles: TILES_ALL, record: RECORD_NONE, start: START_AT_ONCE, ..self }
    }

    pub(crate) fn is_behind(self) -> bool {
        self.front == FRONT_PICTURE
    }

    /// The kernel that keeps layers of emission and absorption beside the picture.
    pub(crate) fn with_layers(self) -> Self {
        Self { record: RECORD_LAYERS, start: START_AT_ONCE, ..self }
    }

    pub(crate) fn keeps_layers(self) -> bool {
        self.record == RECORD_LAYERS
    }

    /// The kernel that leaves what rays pass in slabs of depth beside the picture.
    pub(crate) fn with_slabs(self) -> Self {
        Self { record: RECORD_SLABS, start: START_AT_ONCE, ..self }
    }

    /// The kernel whose rays start by what the last picture saw first, and that notes what this one does.
    pub(crate) fn leaping(self, tiles: Tiles) -> Self {
        Self { record: RECORD_NEAREST, start: START_BY_TILE, tiles: tiles.file(), ..self }
    }

    pub(crate) fn leaps(&self) -> bool {
        self.start == START_BY_TILE
    }

    /// The kernel that casts rays in several dispatches.
    pub(crate) fn in_parts(self) -> Self {
        let resume = if self.keeps_layers() { "lib/resume_layered_parts" } else { "lib/resume_parts" };
        Self { resume, ..self }
    }

    /// Bytes of a ray between dispatches.
    pub(crate) fn state_bytes(&self) -> u64 {
        if self.keeps_layers() { LAYERED_RAY_BYTES } else { RAY_STATE_BYTES }
    }

    /// The kernel that casts listed tiles.
    pub(crate) fn of_listed_tiles(self) -> Self {
        Self { tiles: TILES_LISTED, ..self }
    }

    /// Every kernel that parameters can ask for. What enhances boundaries has to do with shading only where that takes a gradient as
    /// well: one that does and one that does not stand for all.
    #[cfg(test)]
    fn all() -> Vec<Self> {
        let gradients = ["lib/gradient_central", "lib/gradient_tetrahedron"];
        let classifiers = ["lib/classify_value", "lib/classify_value_gradient", "lib/classify_preintegrated"];
        let shadings = [
            "lib/shade_none",
            "lib/shade_phong",
            "lib/shade_shadow",
            "lib/shade_ambient",
            "lib/shade_directional",
            "lib/shade_lit_sphere",
        ];
        let by_distance = "lib/blocks_by_distance";
        let skips = [(SKIP_NONE, by_distance), (SKIP_BLOCKS, by_distance)];
        let projections = [
            ("lib/accumulate_mip", [(SKIP_NONE, by_distance), (SKIP_BLOCKS, "lib/blocks_by_maximum")]),
            ("lib/accumulate_minip", [(SKIP_NONE, by_distance), (SKIP_BLOCKS, "lib/blocks_by_minimum")]),
            ("lib/accumulate_mean", skips),
            (XRAY, skips),
        ];
        let (volume, magnitude, resume) = (VOLUME_FILTERED, MAGNITUDE_ESTIMATED, RESUME_WHOLE);
        let tiles = TILES_ALL;
        let mut all = Vec::new();
        for (skip, blocks) in skips {
            for gradient in gradients {
                for shading in shadings {
                    for classifier in classifiers {
                        all.push(Self {
                            accumulator: COMPOSITE,
                            classifier,
                            shading,
                            boundaries: BOUNDARIES_PLAIN,
                            gradient,
                            volume,
                            skip,
                            blocks,
                            magnitude,
                            resume,
                            tiles,
                            record: RECORD_NONE,
                            front: FRONT_NONE,
                            start: START_AT_ONCE,
                        });
                    }
                    let (accumulator, classifier) = (FIRST_HIT, "lib/classify_isovalue");
                    all.push(Self {
                        accumulator,
                        classifier,
                        shading,
                        boundaries: BOUNDARIES_PLAIN,
                        gradient,
                        volume,
                        skip,
                        blocks,
                        magnitude,
                        resume,
                        tiles,
                        record: RECORD_NONE,
                        front: FRONT_NONE,
                        start: START_AT_ONCE,
                    });
                }
            }
        }
        for (accumulator, skips) in projections {
            for (skip, blocks) in skips {
                let (classifier, shading) = ("lib/classify_value", "lib/shade_none");
                all.push(Self {
                    accumulator,
                    classifier,
                    shading,
                    boundaries: BOUNDARIES_PLAIN,
                    gradient: gradients[0],
                    volume,
                    skip,
                    blocks,
                    magnitude,
                    resume,
                    tiles,
                    record: RECORD_NONE,
                    front: FRONT_NONE,
                    start: START_AT_ONCE,
                });
            }
        }
        let with_map = |variant: &&Self| variant.classifier == "lib/classify_value_gradient";
        let with_map: Vec<Self> = all
            .iter()
            .filter(with_map)
            .map(|variant| Self { magnitude: MAGNITUDE_MAP, ..*variant })
            .collect();
        all.extend(with_map);
        let is_composite = |variant: &&Self| variant.accumulator == COMPOSITE;
        let is_enhanced = |variant: &&Self| {
            is_composite(variant) && ["lib/shade_none", "lib/shade_lit_sphere"].contains(&variant.shading)
        };
        let enhanced: Vec<Self> = all
            .iter()
            .filter(is_enhanced)
            .map(|variant| Self { boundaries: BOUNDARIES_ENHANCED, ..*variant })
            .collect();
        all.extend(enhanced);
        let on_quads = |variant: &Self| Self {
            volume: VOLUME_QUADS,
            tiles: TILES_LISTED,
            gradient: if variant.gradient == gradients[0] {
                "lib/gradient_central_quads"
            } else {
                variant.gradient
            },
            ..*variant
        };
        let on_quads: Vec<Self> = all.iter().map(on_quads).collect();
        all.extend(on_quads);
        let is_leaping = |variant: &&Self| {
            [COMPOSITE, FIRST_HIT].contains(&variant.accumulator) && variant.gradient == gradients[0]
        };
        let leaping: Vec<Self> =
            all.iter().filter(is_leaping).map(|variant| variant.leaping(Tiles::Listed)).collect();
        let is_listed_composite = |variant: &&Self| {
            is_composite(variant) && variant.gradient != gradients[1] && variant.tiles == TILES_LISTED
        };
        let composites: Vec<Self> = all.iter().filter(is_listed_composite).copied().collect();
        all.extend(composites.iter().map(|variant| variant.with_layers()));
        all.extend(composites.iter().map(|variant| variant.with_slabs()));
        all.extend(composites.iter().map(|variant| variant.behind()));
        all.extend(leaping);
        let in_parts: Vec<Self> = all.iter().map(|variant| variant.in_parts()).collect();
        all.extend(in_parts);
        all
    }

    fn choices(&self) -> [(&'static str, &'static str); 16] {
        let (cast_segments, join) = match self.accumulator {
            XRAY => ("lib/cast_integrals", "lib/join_sum"),
            _ => ("lib/cast_segments", "lib/join_over"),
        };
        [
            ("lib/accumulate", self.accumulator),
            ("lib/classify", self.classifier),
            ("lib/shade", self.shading),
            ("lib/boundaries", self.boundaries),
            ("lib/gradient", self.gradient),
            ("lib/volume", self.volume),
            ("lib/skip", self.skip),
            ("lib/blocks", self.blocks),
            ("lib/magnitude", self.magnitude),
            ("lib/resume", self.resume),
            ("lib/tiles", self.tiles),
            ("lib/record", self.record),
            ("lib/front", self.front),
            ("lib/start", self.start),
            ("lib/cast_segments", cast_segments),
            ("lib/join", join),
        ]
    }
}

const BOUNDARIES_PLAIN: &str = "lib/boundaries_plain";
const BOUNDARIES_ENHANCED: &str = "lib/boundaries_enhanced";
const VOLUME_FILTERED: &str = "lib/volume_filtered";
const VOLUME_QUADS: &str = "lib/volume_quads";
const MAGNITUDE_MAP: &str = "lib/magnitude_map";
const MAGNITUDE_ESTIMATED: &str = "lib/magnitude_estimated";
const RESUME_WHOLE: &str = "lib/resume_whole";
const TILES_ALL: &str = "lib/tiles_all";
const TILES_LISTED: &str = "lib/tiles_listed";
const RECORD_NONE: &str = "lib/record_none";
const RECORD_LAYERS: &str = "lib/record_layers";
const RECORD_SLABS: &str = "lib/record_slabs";
const RECORD_NEAREST: &str = "lib/record_nearest";
const START_AT_ONCE: &str = "lib/start_at_once";
const START_BY_TILE: &str = "lib/start_by_tile";
const FRONT_NONE: &str = "lib/front_none";
const FRONT_PICTURE: &str = "lib/front_picture";
const SKIP_NONE: &str = "lib/skip_none";
const SKIP_BLOCKS: &str = "lib/skip_blocks";
const COMPOSITE: &str = "lib/accumulate_composite";
const FIRST_HIT: &str = "lib/accumulate_first_hit";
const XRAY: &str = "lib/accumulate_xray";

/// Loop iterations that a step along a ray costs at most where each of a group of eight rays in lockstep waits while the
/// others search or leap in turn, and those that end the loops.
const LOCKSTEP_ITERATIONS: u32 = 11;

/// Loop iterations that keeping layers adds to a sample.
pub(crate) const ITERATIONS_OF_RECORDING: u32 = 2;

/// Loop iterations that a sample costs at most. A loop of n counts n + 1: drivers count the one that ends it.
pub(crate) fn iterations_per_sample(parameters: &CastParameters, leap: &Leap<'_>) -> u32 {
    let leaps = !matches!(leap, Leap::Nothing);
    match parameters.mode {
        Mode::Composite if leaps => 2 * LOCKSTEP_ITERATIONS + iterations_of_shading(parameters, leap),
        Mode::Composite => LOCKSTEP_ITERATIONS + iterations_of_shading(parameters, leap),
        _ if leaps => LOCKSTEP_ITERATIONS,
        _ => 1,
    }
}

/// Loop iterations that shading a sample costs at most.
pub(crate) fn iterations_of_shading(parameters: &CastParameters, leap: &Leap<'_>) -> u32 {
    let leaps = !matches!(leap, Leap::Nothing);
    let along_shading_ray = |samples: u32| {
        if leaps { LOCKSTEP_ITERATIONS * samples + 2 } else { samples + 4 }
    };
    match parameters.shading {
        Shading::None | Shading::Phong | Shading::LitSphere { .. } => 0,
        Shading::Shadow => along_shading_ray(SHADOW_SAMPLES),
        Shading::Ambient => AMBIENT_SAMPLES + 1,
        Shading::Directional { .. } => parameters.directions.len() as u32 + 1,
    }
}

/// Reads of the volume that a visible sample costs at most.
pub(crate) fn reads_per_sample(parameters: &CastParameters) -> u32 {
    let classifier_reads =
        if parameters.classifier == Classifier::ValueGradient { parameters.gradient.samples() } else { 0 };
    let boundary_reads = parameters.boundaries.map_or(0, |_| parameters.gradient.samples());
    1 + classifier_reads + boundary_reads + parameters.shading_samples() * (1 + classifier_reads)
}

/// Pipelines of a kernel's variants, built when first asked for.
#[derive(Debug)]
pub(crate) struct VariantPipelines {
    layout: wgpu::PipelineLayout,
    root: &'static str,
    entry_point: &'static str,
    /// The files of slots that no variant chooses.
    fixed: Vec<(&'static str, &'static str)>,
    built: HashMap<Variant, wgpu::ComputePipeline>,
}

impl VariantPipelines {
    /// None yet, of the kernel that casts views.
    pub(crate) fn of_views(device: &wgpu::Device, groups: &GroupLayouts) -> Self {
        Self::new(groups.pipeline_layout(device, "cast", None), "cast", "cast_rays", &[])
    }

    /// None yet.
    pub(crate) fn new(
        layout: wgpu::PipelineLayout,
        root: &'static str,
        entry_point: &'static str,
        fixed: &[(&'static str, &'static str)],
    ) -> Self {
        let fixed = fixed.to_vec();
        Self { layout, root, entry_point, fixed, built: HashMap::new() }
    }

    /// The pipeline of a variant.
    ///
    /// # Errors
    /// [`GpuError::Refused`] if the driver does not take the kernel.
    pub(crate) fn pipeline(
        &mut self,
        gpu: &Gpu,
        variant: Variant,
    ) -> Result<wgpu::ComputePipeline, GpuError> {
        if let Some(pipeline) = self.built.get(&variant) {
            return Ok(pipeline.clone());
        }
        let pipeline = self.build(&gpu.device, variant)?;
        gpu.check()?;
        self.built.insert(variant, pipeline.clone());
        Ok(pipeline)
    }

    /// Builds every variant that pairs are made with.
    #[cfg(test)]
    pub(crate) fn build_all_of_pairs(&self, device: &wgpu::Device) {
        let is_of_pairs = |variant: &Variant| {
            [COMPOSITE, XRAY].contains(&variant.accumulator) && variant.resume == RESUME_WHOLE
        };
        for variant in Variant::all().into_iter().filter(is_of_pairs) {
            self.build(device, variant).unwrap();
        }
    }

    fn build(&self, device: &wgpu::Device, variant: Variant) -> Result<wgpu::ComputePipeline, GpuError> {
        let choices = [&variant.choices()[..], &self.fixed].concat();
        let files = KernelFiles { root: self.root, choices: &choices, entry_point: self.entry_point };
        build(device, Some(&self.layout), &files)
    }
}

/// Encodes the cast of a piece of whole tiles.
pub(crate) fn dispatch(
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::ComputePipeline,
    bindings: &Bindings<'_>,
    workgroups: Workgroups<'_>,
    stamps: Stamps<'_>,
) {
    let mut pass = bindings.begin_timed_pass(encoder, pipeline, None, stamps);
    match workgroups {
        Workgroups::Counted([x, y]) => pass.dispatch_workgroups(x, y, 1),
        Workgroups::Listed(groups) => pass.dispatch_workgroups_indirect(groups, 0),
    }
}

/// Workgroups of a cast.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Workgroups<'a> {
    /// So many along x and y.
    Counted([u32; 2]),
    /// As many as a buffer says.
    Listed(&'a wgpu::Buffer),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noop_device::build_on_noop_device;
    use crate::shader::compose;

    #[test]
    fn every_kernel_is_valid_wgsl() {
        let mut validator = naga::valid::Validator::new(
            naga::valid::ValidationFlags::all(),
            naga::valid::Capabilities::default() | naga::valid::Capabilities::SHADER_FLOAT16_IN_FLOAT32,
        );
        let variants = Variant::all();
        let failures: Vec<String> = variants
            .iter()
            .filter_map(|variant| {
                let source = compose("cast", &variant.choices()).unwrap();
                let module = match naga::front::wgsl::parse_str(&source.text) {
                    Ok(module) => module,
                    Err(error) => {
                        let line = error.location(&source.text).map_or(0, |l| l.line_number as usize);
                        return Some(format!(
                            "{variant:?} {:?}: {}",
                            source.origin(line),
                            error.emit_to_string(&source.text)
                        ));
                    }
                };
                validator.validate(&module).err().map(|error| format!("{variant:?}: {error:?}"))
            })
            .collect();
        assert!(failures.is_empty(), "{}", failures.join("\n"));
        assert_eq!(variants.len(), 1176);
    }

    #[test]
    fn every_pipeline_builds_on_the_noop_device() {
        build_on_noop_device(|device| {
            let pipelines = VariantPipelines::of_views(device, &GroupLayouts::new(device));
            for variant in Variant::all() {
                pipelines.build(device, variant).unwrap();
            }
        });
    }

    #[test]
    fn constants_are_those_of_the_reference() {
        use wheatstone_core::cast;
        use wheatstone_core::lit_sphere::LIT_SPHERE_SIDE;
        use wheatstone_core::transfer::OPAQUE_LOG2;
        let expected = [
            ("lib/shade_phong", "AMBIENT", cast::PHONG[0]),
            ("lib/shade_phong", "DIFFUSE", cast::PHONG[1]),
            ("lib/shade_phong", "SPECULAR", cast::PHONG[2]),
            ("lib/shade_phong", "SPECULAR_EXPONENT", cast::PHONG[3]),
            ("lib/shade_phong", "FLAT_SQUARED", cast::FLAT_SQUARED),
            ("lib/shade_shadow", "SHADOW_SAMPLES", SHADOW_SAMPLES as f32),
            ("lib/shade_shadow", "SHADING_STEP", cast::SHADING_STEP),
            ("lib/shade_lit_sphere", "LIT_SPHERE_SIDE", LIT_SPHERE_SIDE as f32),
            ("lib/shade_ambient", "AMBIENT_RADIUS", cast::AMBIENT_RADIUS),
            ("lib/record_layers", "DIVIDED_PX", wheatstone_core::warp::DIVIDED_PX as f32),
            ("lib/accumulate_composite", "FIRST_HIT_ALPHA", cast::FIRST_HIT_ALPHA),
            (FIRST_HIT, "BISECTIONS", cast::BISECTIONS as f32),
            (FIRST_HIT, "SURFACE_LIFT", cast::SURFACE_LIFT),
            ("lib/classify_isovalue", "OPAQUE_LOG2", OPAQUE_LOG2),
        ];
        for (file, name, value) in expected {
            let has_file = |variant: &Variant| variant.choices().iter().any(|(_, chosen)| *chosen == file);
            let choices = Variant::all().into_iter().find(has_file).expect(file).choices();
            let module = naga::front::wgsl::parse_str(&compose("cast", &choices).unwrap().text).unwrap();
            let (_, constant) =
                module.constants.iter().find(|(_, c)| c.name.as_deref() == Some(name)).expect(name);
            let found = match module.global_expressions[constant.init] {
                naga::Expression::Literal(naga::Literal::F32(x)) => x,
                naga::Expression::Literal(naga::Literal::U32(x)) => x as f32,
                ref other => panic!("{name}: {other:?}"),
            };
            assert_eq!(found, value, "{name} in {file}");
        }
    }
}
