//! What to show and how: the settings that both casters take.

use crate::lit_sphere::Style;
use crate::transfer::TransferFunction;
use crate::volume::{Grid, Volume, Window};
use glam::{DAffine3, DMat3, DVec3, Vec3};

/// How samples along a ray become a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mode {
    /// Front-to-back emission and absorption through the transfer function.
    Composite,
    /// Maximum intensity projection, coloured by the transfer function.
    Mip,
    /// Minimum intensity projection, coloured by the transfer function.
    MinIp,
    /// Mean of the normalised values along the ray, coloured by the transfer function.
    Mean,
    /// Sum of the normalised values times step length, over the volume's longest side: an ideal radiograph.
    XRay,
    /// First crossing of a normalised value.
    Isosurface {
        /// Normalised value of the surface.
        isovalue: f32,
    },
}

impl Mode {
    /// Its usual short name: `dvr` (direct volume rendering) for composites.
    pub fn name(self) -> &'static str {
        match self {
            Self::Composite => "dvr",
            Self::Mip => "mip",
            Self::MinIp => "minip",
            Self::Mean => "mean",
            Self::XRay => "xray",
            Self::Isosurface { .. } => "iso",
        }
    }
}

/// How a visible sample is lit. Applies to [`Mode::Composite`] and [`Mode::Isosurface`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shading {
    /// Colour as it is.
    None,
    /// Ambient, diffuse and specular by the gradient, on both sides of a surface.
    Phong,
    /// Transmittance of 24 samples towards the light.
    Shadow,
    /// Mean transmittance of 14 samples on a sphere.
    Ambient,
    /// Light from d directions, each traced for 4 steps: the papers' shading-complexity dial.
    Directional {
        /// Number of directions, at most [`MAX_DIRECTIONS`]; 0 takes no extra samples.
        directions: u32,
    },
    /// By the direction that a surface faces in eye space, in the style of its value: a style transfer function.
    LitSphere {
        /// The style of value 0.
        low: Style,
        /// The style of value 1; in between looks are interpolated.
        high: Style,
    },
}

/// How much denser samples of a composite are where the value changes: by inside + gain · |∇v|ᵉ, |∇v| being the change of the
/// normalised value per voxel length, at most 1 (Ebert and Rheingans, "Volume illustration: non-photorealistic rendering of volume
/// models", 2000). Shading rays go by the transfer function alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundaryEnhancement {
    /// Factor where the value does not change; 0 leaves boundaries alone.
    pub inside: f32,
    /// What is added where it changes by 1 per voxel length.
    pub gain: f32,
    /// The exponent e, at least 1.
    pub exponent: u32,
}

/// Most directions that [`Shading::Directional`] takes.
pub const MAX_DIRECTIONS: u32 = 64;

/// How gradients are estimated from samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GradientMethod {
    /// Six samples, one voxel to each side.
    #[default]
    CentralDifferences,
    /// Four samples on a tetrahedron (DM Algorithm 1).
    Tetrahedron,
}

impl GradientMethod {
    /// Samples that an estimate takes.
    pub fn samples(self) -> u32 {
        match self {
            Self::CentralDifferences => 6,
            Self::Tetrahedron => 4,
        }
    }
}

/// Where light comes from.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Light {
    /// Phong from the [viewpoint](crate::view::View::viewpoint); shadows from [`Light::DEFAULT_DIRECTION`].
    #[default]
    Headlight,
    /// Parallel light; the vector points towards the light, in world space.
    Directional(Vec3),
}

impl Light {
    /// Towards the light that casts shadows by default: above, to the left, in front.
    pub const DEFAULT_DIRECTION: Vec3 = Vec3::new(-0.5, 0.8, 0.6);

    /// Unit vector towards the light that casts shadows, world space.
    pub fn shadow_direction(self) -> Vec3 {
        match self {
            Self::Headlight => Self::DEFAULT_DIRECTION,
            Self::Directional(to_light) => to_light,
        }
        .try_normalize()
        .unwrap_or(Vec3::Y)
    }
}

/// A plane that cuts the volume: points with `normal · p ≥ offset_m` stay. World space, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClipPlane {
    /// Points towards what stays; need not have unit length.
    pub normal: DVec3,
    /// Distance of the plane from the origin along the normal, times its length.
    pub offset_m: f64,
}

/// What part of the volume is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clip {
    /// Low corner of the visible box in texture space.
    pub box_lo: DVec3,
    /// High corner of the visible box in texture space.
    pub box_hi: DVec3,
    /// An optional cutting plane.
    pub plane: Option<ClipPlane>,
}

impl Default for Clip {
    /// Everything is shown.
    fn default() -> Self {
        Self { box_lo: DVec3::ZERO, box_hi: DVec3::ONE, plane: None }
    }
}

impl Clip {
    /// Thinnest that moving a face leaves the visible box, as a part of the volume's side.
    pub const THINNEST: f64 = 0.01;

    /// Where a face of the visible box is along its axis, texture space. Faces 0 to 2 are the low ones of x, y and z, 3 to 5 the
    /// high ones.
    ///
    /// # Panics
    /// If there is no such face.
    pub fn face(&self, face: usize) -> f64 {
        if face < 3 { self.box_lo[face] } else { self.box_hi[face - 3] }
    }

    /// Moves a face of the visible box as far as the volume and the opposite face allow, texture space.
    ///
    /// # Panics
    /// If there is no such face.
    pub fn move_face(&mut self, face: usize, to: f64) {
        if face < 3 {
            self.box_lo[face] = to.min(self.box_hi[face] - Self::THINNEST).max(0.0);
        } else {
            self.box_hi[face - 3] = to.max(self.box_lo[face - 3] + Self::THINNEST).min(1.0);
        }
    }
}

/// Everything about a picture but the volume and the view.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// How samples become a pixel.
    pub mode: Mode,
    /// Values that are normalised to [0, 1].
    pub window: Window,
    /// Colour and opacity of normalised values.
    pub transfer: TransferFunction,
    /// Whether composites integrate the (one-dimensional) transfer function over the value interval of each
    /// step instead of sampling it once per step.
    pub preintegrated: bool,
    /// How visible samples are lit.
    pub shading: Shading,
    /// How much denser composites are where the value changes; `None` leaves densities as they are.
    pub boundaries: Option<BoundaryEnhancement>,
    /// Display-referred colour of an isosurface; `None` is a light grey.
    pub surface_rgb: Option<[f32; 3]>,
    /// How gradients are estimated.
    pub gradient: GradientMethod,
    /// Samples per voxel length (f of DM Eq. 2).
    pub sampling_factor: f32,
    /// Accumulated opacity at which a ray ends; `None` follows every ray to its end.
    pub early_termination: Option<f32>,
    /// What part of the volume is shown.
    pub clip: Clip,
    /// Where light comes from.
    pub light: Light,
}

/// Accumulated opacity at which rays end by default.
pub const EARLY_TERMINATION: f32 = 0.99;

impl Settings {
    /// An unlit composite with one sample per voxel length and everything else at its default.
    pub fn new(window: Window, transfer: TransferFunction) -> Self {
        Self {
            mode: Mode::Composite,
            window,
            transfer,
            preintegrated: false,
            shading: Shading::None,
            boundaries: None,
            surface_rgb: None,
            gradient: GradientMethod::default(),
            sampling_factor: 1.0,
            early_termination: Some(EARLY_TERMINATION),
            clip: Clip::default(),
            light: Light::default(),
        }
    }
}

/// A volume's place in the world, and the spaces that follow from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    world_from_texture: DAffine3,
    voxel_length_m: f64,
}

impl Placement {
    /// Places a volume by a rigid or uniformly scaled map from patient space (mm) to the world (m).
    pub fn new(volume: &Volume, world_from_patient: DAffine3) -> Self {
        Self::of_grid(volume.grid(), world_from_patient)
    }

    /// The same of a volume whose grid alone is at hand.
    pub fn of_grid(grid: &Grid, world_from_patient: DAffine3) -> Self {
        let metres_per_mm = world_from_patient.matrix3.determinant().abs().cbrt();
        Self {
            world_from_texture: world_from_patient * grid.patient_from_texture(),
            voxel_length_m: grid.voxel_length_mm() * metres_per_mm,
        }
    }

    /// Texture space to world space.
    pub fn world_from_texture(&self) -> DAffine3 {
        self.world_from_texture
    }

    /// World space to texture space.
    pub fn texture_from_world(&self) -> DAffine3 {
        self.world_from_texture.inverse()
    }

    /// The unit of length of steps and opacities, [`Grid::voxel_length_mm`] in world metres.
    pub fn voxel_length_m(&self) -> f64 {
        self.voxel_length_m
    }

    /// Vectors in texture space to **metric** space: the world's axes, in voxel lengths.
    pub fn metric_from_texture(&self) -> DMat3 {
        self.world_from_texture.matrix3 * (1.0 / self.voxel_length_m)
    }
}
