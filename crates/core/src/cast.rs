//! The numbers of a cast: settings and placement turned into what a kernel reads, once, for both casters.

use crate::lit_sphere::LitSphere;
use crate::scene::{
    BoundaryEnhancement, GradientMethod, Light, MAX_DIRECTIONS, Mode, Placement, Settings, Shading,
};
use crate::transfer::Lut;
use crate::volume::{DIAGONALS, Window};
use glam::{BVec3, DAffine3, DVec3, Mat3, Vec3, Vec3A, Vec4};

/// Ambient, diffuse and specular weights and the specular exponent of Phong shading.
pub const PHONG: [f32; 4] = [0.2, 0.7, 0.2, 20.0];

/// Squared gradient below which a sample has no surface to light.
pub const FLAT_SQUARED: f32 = 1e-10;

/// Samples that a shadow ray takes.
pub const SHADOW_SAMPLES: u32 = 24;

/// Distance of neighbouring samples of shadow and directional rays, voxel lengths.
pub const SHADING_STEP: f32 = 2.0;

/// Steps per direction of directional shading.
pub const DIRECTIONAL_STEPS: u32 = 4;

/// Points of the sphere that ambient occlusion samples: the axes and the corners of a cube.
pub const AMBIENT_SAMPLES: u32 = 14;

/// Radius of the sphere that ambient occlusion samples, voxel lengths.
pub const AMBIENT_RADIUS: f32 = 4.0;

/// Accumulated opacity at which a composited ray has hit something: the first that an 8-bit picture shows.
pub const FIRST_HIT_ALPHA: f32 = 1.0 / 255.0;

/// Accumulated opacity at which a composited ray ends even without early termination: what lies behind changes a channel
/// by less than 2⁻²⁴.
pub const SATURATED_ALPHA: f32 = 1.0 - 1.0 / 16_777_216.0;

/// Halvings of the step in which an isosurface is found: to a thousandth of a voxel length.
pub const BISECTIONS: u32 = 10;

/// How far above an isosurface its shading rays start, voxel lengths.
pub const SURFACE_LIFT: f32 = 0.5;

/// Colour of an isosurface whose transfer function gives it none.
pub const SURFACE_RGB: [f32; 3] = [0.8; 3];

/// Which table a cast looks colours up in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Classifier {
    /// By value.
    Value,
    /// By value and gradient magnitude.
    ValueGradient,
    /// By the values at both ends of a step.
    PreIntegrated,
    /// Opaque from a value upwards.
    Isovalue,
}

/// Everything that a kernel reads besides the voxels and the view. Made once per change of the settings.
#[derive(Debug, Clone)]
pub struct CastParameters {
    /// How samples become a pixel.
    pub mode: Mode,
    /// How visible samples are lit.
    pub shading: Shading,
    /// How gradients are estimated.
    pub gradient: GradientMethod,
    /// Values that are normalised to [0, 1].
    pub window: Window,
    /// World space to texture space.
    pub texture_from_world: DAffine3,
    /// Which table is looked up.
    pub classifier: Classifier,
    /// The baked transfer function.
    pub lut: Lut,
    /// Samples per voxel length.
    pub sampling_factor: f32,
    /// Accumulated opacity at which a composited ray ends, at most [`SATURATED_ALPHA`].
    pub termination_alpha: f32,
    /// Normalised value of the isosurface.
    pub isovalue: f32,
    /// Colour of the isosurface.
    pub surface_rgb: Vec3A,
    /// Low corner of the visible box, texture space.
    pub box_lo: Vec3A,
    /// High corner of the visible box, texture space.
    pub box_hi: Vec3A,
    /// Low and high corner of a box outside of which nothing contributes to a picture, texture space: the whole volume, unless more is
    /// known ([`CastParameters::occupied_within`]).
    pub occupied: [Vec3A; 2],
    /// Visible half-space in texture space: `xyz · p + w ≥ 0`.
    pub plane: Vec4,
    /// Vectors in texture space to metric space (world axes, voxel lengths).
    pub metric_from_texture: Mat3,
    /// The inverse.
    pub texture_from_metric: Mat3,
    /// Unit vector towards the light of Phong shading, metric space; zero for a headlight.
    pub to_light: Vec3A,
    /// Step of a shadow ray, texture space.
    pub shadow_step: Vec3A,
    /// Value integral to grey level: one over the volume's longest side in voxel lengths.
    pub xray_scale: f32,
    /// How samples look in each direction that they may face, of value 0 and of value 1; none of other shadings.
    pub lit_spheres: Vec<LitSphere>,
    /// How much denser samples are where the value changes, of composites.
    pub boundaries: Option<BoundaryEnhancement>,
    /// Unit directions of directional shading, metric space; their absolute components are the light's colour.
    pub directions: Vec<Vec3A>,
}

impl CastParameters {
    /// Works the numbers out.
    pub fn new(settings: &Settings, placement: &Placement) -> Self {
        let metric_from_texture = placement.metric_from_texture();
        let texture_from_metric = metric_from_texture.inverse();
        let classifier = match settings.mode {
            Mode::Isosurface { .. } => Classifier::Isovalue,
            Mode::Composite if settings.preintegrated => Classifier::PreIntegrated,
            Mode::Composite if settings.transfer.is_2d() => Classifier::ValueGradient,
            _ => Classifier::Value,
        };
        let lut = match classifier {
            Classifier::PreIntegrated => Lut::bake_preintegrated(&settings.transfer),
            Classifier::ValueGradient => Lut::bake(&settings.transfer),
            Classifier::Value | Classifier::Isovalue => Lut::bake_by_value(&settings.transfer),
        };
        let isovalue = if let Mode::Isosurface { isovalue } = settings.mode { isovalue } else { 0.0 };
        let shadow_direction = settings.light.shadow_direction();
        let directions = match settings.shading {
            Shading::Directional { directions } => sphere_directions(directions.min(MAX_DIRECTIONS)),
            _ => Vec::new(),
        };
        let sides = [0, 1, 2].map(|axis| metric_from_texture.col(axis).length());
        Self {
            mode: settings.mode,
            shading: settings.shading,
            gradient: settings.gradient,
            window: settings.window,
            texture_from_world: placement.texture_from_world(),
            classifier,
            lut,
            sampling_factor: settings.sampling_factor,
            termination_alpha: settings.early_termination.unwrap_or(1.0).min(SATURATED_ALPHA),
            isovalue,
            surface_rgb: settings.surface_rgb.unwrap_or(SURFACE_RGB).into(),
            box_lo: settings.clip.box_lo.clamp(DVec3::ZERO, DVec3::ONE).as_vec3a(),
            // A box whose corners are the wrong way round is empty.
            box_hi: settings.clip.box_hi.max(settings.clip.box_lo).clamp(DVec3::ZERO, DVec3::ONE).as_vec3a(),
            occupied: [Vec3A::ZERO, Vec3A::ONE],
            plane: plane_in_texture(settings, placement),
            metric_from_texture: metric_from_texture.as_mat3(),
            texture_from_metric: texture_from_metric.as_mat3(),
            to_light: match settings.light {
                Light::Headlight => Vec3A::ZERO,
                Light::Directional(_) => shadow_direction.into(),
            },
            shadow_step: (texture_from_metric.as_mat3() * (shadow_direction * SHADING_STEP)).into(),
            xray_scale: (1.0 / sides.into_iter().fold(0.0, f64::max)) as f32,
            directions,
            lit_spheres: match settings.shading {
                Shading::LitSphere { low, high } => [low, high].map(LitSphere::of).to_vec(),
                _ => Vec::new(),
            },
            boundaries: settings.boundaries.filter(|_| settings.mode == Mode::Composite),
        }
    }

    /// Samples that shading one visible sample takes.
    pub fn shading_samples(&self) -> u32 {
        match self.shading {
            Shading::None => 0,
            Shading::Phong | Shading::LitSphere { .. } => self.gradient.samples(),
            Shading::Shadow => SHADOW_SAMPLES,
            Shading::Ambient => AMBIENT_SAMPLES,
            Shading::Directional { .. } => DIRECTIONAL_STEPS * self.directions.len() as u32,
        }
    }

    /// Most samples that any ray takes: those of the volume's diagonal.
    pub fn most_samples_per_ray(&self) -> u32 {
        let diagonal =
            DIAGONALS.map(|way| (self.metric_from_texture * way).length()).into_iter().fold(0.0, f32::max);
        ((diagonal * self.sampling_factor).ceil() as u32).saturating_add(1)
    }

    /// The same, where all occupied blocks are in a box, texture space. Only composites whose samples are looked up one by one take that
    /// into account; the others see further than their blocks.
    pub fn occupied_within(self, occupied: [Vec3; 2]) -> Self {
        let occupied = self.narrowed(occupied);
        Self { occupied, ..self }
    }

    /// What contributes, where all occupied blocks are in a box.
    fn narrowed(&self, occupied: [Vec3; 2]) -> [Vec3A; 2] {
        let is_by_sample = matches!(self.classifier, Classifier::Value | Classifier::ValueGradient);
        if self.mode == Mode::Composite && is_by_sample { occupied.map(Vec3A::from) } else { self.occupied }
    }

    /// The same for a coarser level of the volume: as many samples per voxel, which is 2ˡ times as long.
    #[must_use]
    pub fn of_level(&self, level: usize) -> Self {
        let sampling_factor = self.sampling_factor * (-(level as f32)).exp2();
        Self { sampling_factor, ..self.clone() }
    }

    /// Whether rays stop at, or fade behind, what they hit first, so that what is in front of it can be leapt over from frame to
    /// frame ([`first_hits`](crate::first_hits)).
    pub fn has_first_hits(&self) -> bool {
        matches!(self.mode, Mode::Composite | Mode::Isosurface { .. })
    }

    /// One voxel length, metres.
    pub fn voxel_length_m(&self) -> f64 {
        let world_from_texture = self.texture_from_world.inverse().matrix3;
        world_from_texture.x_axis.length() / f64::from(self.metric_from_texture.x_axis.length())
    }

    /// The corners of the visible box, world space, metres.
    pub fn visible_corners_world(&self) -> [DVec3; 8] {
        self.corners_world(self.box_lo, self.box_hi)
    }

    /// The corners of the part of the visible box that may be occupied, world space, metres.
    pub fn occupied_corners_world(&self) -> [DVec3; 8] {
        self.corners_world_within(self.occupied)
    }

    /// The same, where all occupied blocks are in a box, texture space.
    pub fn corners_world_of_occupied(&self, occupied: [Vec3; 2]) -> [DVec3; 8] {
        self.corners_world_within(self.narrowed(occupied))
    }

    fn corners_world_within(&self, occupied: [Vec3A; 2]) -> [DVec3; 8] {
        let [lo, hi] = occupied.map(|corner| corner.clamp(self.box_lo, self.box_hi));
        self.corners_world(lo, hi)
    }

    fn corners_world(&self, lo: Vec3A, hi: Vec3A) -> [DVec3; 8] {
        let world_from_texture = self.texture_from_world.inverse();
        let [lo, hi] = [lo, hi].map(|corner| corner.as_dvec3());
        std::array::from_fn(|i| {
            let is_high = BVec3::new(i & 1 != 0, i & 2 != 0, i & 4 != 0);
            world_from_texture.transform_point3(DVec3::select(is_high, hi, lo))
        })
    }
}

fn plane_in_texture(settings: &Settings, placement: &Placement) -> Vec4 {
    let Some(plane) = settings.clip.plane else { return Vec4::W };
    let world_from_texture = placement.world_from_texture();
    let normal = world_from_texture.matrix3.transpose() * plane.normal;
    let offset = plane.normal.dot(world_from_texture.translation) - plane.offset_m;
    normal.extend(offset).as_vec4()
}

/// Directions spread evenly over the sphere (Fibonacci lattice), the same for every sample: no noise, no flicker.
fn sphere_directions(count: u32) -> Vec<Vec3A> {
    let golden_angle = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
    (0..count)
        .map(|i| {
            let y = 1.0 - (2.0 * i as f32 + 1.0) / count as f32;
            let (sin, cos) = (golden_angle * (i as f32 + 0.5)).sin_cos();
            let radius = (1.0 - y * y).sqrt();
            Vec3A::new(radius * cos, y, radius * sin)
        })
        .collect()
}
