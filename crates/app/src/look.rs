//! How the volume is shown: mode, transfer function, window, shading, sampling.

use crate::failure::Failure;
use crate::spec::{self, WindowSpec};
use crate::transfer_spec::{self, Resolved, TransferSpec};
use clap::{Args, ValueEnum};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::path::Path;
use wheatstone_core::scene::{BoundaryEnhancement, Clip, ClipPlane, GradientMethod, Mode, Settings, Shading};
use wheatstone_core::volume::{StorageKind, Volume, Window};

/// Flags of the picture's content.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Look")]
pub(crate) struct LookArgs {
    /// How samples along a ray become a pixel [default: dvr, or iso if --iso is given].
    #[arg(long, value_enum)]
    pub(crate) mode: Option<ModeName>,

    /// Value of the isosurface, in the window's [0, 1] [default: the middle of the robust window].
    #[arg(long, value_name = "V", value_parser = spec::within(0.0..=1.0), allow_negative_numbers = true)]
    pub(crate) iso: Option<f64>,

    /// Transfer function: auto, ramp:V0..V1, ramp:V0..V1,G0..G1, a preset, a colour map, a benchmark's ramp or a file
    /// [default: auto for dvr, gray for projections, light grey for iso].
    #[arg(long, value_name = "SPEC", value_parser = transfer_spec::parse)]
    pub(crate) tf: Option<TransferSpec>,

    /// Values that become 0 and 1: full (their range), auto (robust) or LO..HI in the file's unit
    /// [default: what the transfer function was made for, else full].
    #[arg(long, value_name = "LO..HI", value_parser = spec::window, allow_hyphen_values = true)]
    pub(crate) window: Option<WindowSpec>,

    /// none, phong, shadow, ambient or directional:D; for dvr and iso [default: none for dvr, phong for iso].
    #[arg(long, value_name = "SHADING", value_parser = spec::shading)]
    pub(crate) shading: Option<Shading>,

    /// How much denser samples are where values change, |g| being the change per voxel length: by INSIDE + GAIN |g|^E (dvr).
    #[arg(long, value_name = "INSIDE,GAIN,E", value_parser = spec::boundaries)]
    pub(crate) boundaries: Option<BoundaryEnhancement>,

    /// Samples per voxel length.
    #[arg(long, value_name = "F", default_value = "1", value_parser = spec::within(0.01..=32.0), allow_negative_numbers = true)]
    pub(crate) sampling_factor: f64,

    /// Opacity at which a ray ends; 0 follows every ray until less than 2⁻²⁴ passes it.
    #[arg(long, value_name = "T", default_value = "0.99", value_parser = spec::within(0.0..=1.0), allow_negative_numbers = true)]
    pub(crate) ert: f64,

    /// Integrate the transfer function over each step (dvr, one-dimensional functions).
    #[arg(long)]
    pub(crate) preintegrated: bool,

    /// How gradients are estimated.
    #[arg(long, value_enum, default_value_t = GradientName::Central)]
    pub(crate) gradient: GradientName,

    /// Show only this box of the volume, in texture space: x0..x1,y0..y1,z0..z1 within [0, 1].
    #[arg(long, value_name = "BOX", value_parser = spec::clip_box, allow_hyphen_values = true)]
    pub(crate) clip_box: Option<[DVec3; 2]>,

    /// Show only where nx*x + ny*y + nz*z >= d, in world metres.
    #[arg(long, value_name = "NX,NY,NZ,D", value_parser = spec::clip_plane, allow_hyphen_values = true)]
    pub(crate) clip_plane: Option<ClipPlane>,

    /// Bits per voxel while sampling; auto loses nothing.
    #[arg(long, value_enum, default_value_t = StorageName::Auto)]
    pub(crate) storage: StorageName,
}

/// A mode by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ModeName {
    /// Direct volume rendering: emission and absorption.
    Dvr,
    /// Maximum intensity projection.
    Mip,
    /// Minimum intensity projection.
    Minip,
    /// Mean of the values.
    Mean,
    /// Sum of the values: an ideal radiograph.
    Xray,
    /// Isosurface.
    Iso,
}

impl ModeName {
    /// Every mode.
    pub(crate) const ALL: [Self; 6] = [Self::Dvr, Self::Mip, Self::Minip, Self::Mean, Self::Xray, Self::Iso];

    /// Name as on the command line.
    pub(crate) fn name(self) -> &'static str {
        self.with_isovalue(0.0).name()
    }

    /// Whether samples are lit in this mode.
    pub(crate) fn is_lit(self) -> bool {
        matches!(self, Self::Dvr | Self::Iso)
    }

    /// The mode, with the value of its isosurface.
    pub(crate) fn with_isovalue(self, isovalue: f32) -> Mode {
        match self {
            Self::Dvr => Mode::Composite,
            Self::Mip => Mode::Mip,
            Self::Minip => Mode::MinIp,
            Self::Mean => Mode::Mean,
            Self::Xray => Mode::XRay,
            Self::Iso => Mode::Isosurface { isovalue },
        }
    }
}

/// A gradient method by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum GradientName {
    /// Central differences: six samples.
    Central,
    /// Four samples on a tetrahedron.
    Tetrahedron,
}

/// Bits per voxel while sampling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum StorageName {
    /// As many as lose nothing.
    Auto,
    /// 8-bit.
    #[value(name = "8")]
    Eight,
    /// 16-bit.
    #[value(name = "16")]
    Sixteen,
    /// 32-bit float.
    #[value(name = "32")]
    Float,
}

impl StorageName {
    /// The kind for a volume.
    pub(crate) fn kind(self, volume: &Volume) -> StorageKind {
        match self {
            Self::Auto => StorageKind::lossless_for(volume),
            Self::Eight => StorageKind::U8,
            Self::Sixteen => StorageKind::U16,
            Self::Float => StorageKind::F32,
        }
    }
}

/// Settings, with the words that name them in reports.
#[derive(Debug, Clone)]
pub(crate) struct Look {
    /// What the casters take.
    pub(crate) settings: Settings,
    /// Name of the mode.
    pub(crate) mode: ModeName,
    /// Name of the transfer function.
    pub(crate) transfer_name: String,
}

impl LookArgs {
    /// Refuses combinations that contradict each other, before anything is read.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        let mode = self.mode_name();
        if self.iso.is_some() && mode != ModeName::Iso {
            return Err(Failure::input(format!("--iso needs --mode iso, not --mode {}", mode.name())));
        }
        if self.shading.is_some_and(|s| s != Shading::None) && !mode.is_lit() {
            return Err(Failure::input(format!(
                "--shading needs --mode dvr or iso, not --mode {}",
                mode.name()
            )));
        }
        if self.preintegrated && mode != ModeName::Dvr {
            return Err(Failure::input(format!(
                "--preintegrated needs --mode dvr, not --mode {}",
                mode.name()
            )));
        }
        if self.boundaries.is_some() && mode != ModeName::Dvr {
            return Err(Failure::input(format!("--boundaries needs --mode dvr, not --mode {}", mode.name())));
        }
        Ok(())
    }

    /// The file of the transfer function, if it comes from one.
    pub(crate) fn file(&self) -> Option<&Path> {
        match &self.tf {
            Some(TransferSpec::File(path)) => Some(path),
            _ => None,
        }
    }

    /// The mode, given or implied.
    pub(crate) fn mode_name(&self) -> ModeName {
        self.mode.unwrap_or(if self.iso.is_some() { ModeName::Iso } else { ModeName::Dvr })
    }

    /// Works the settings out for a volume.
    pub(crate) fn resolve(&self, volume: &Volume) -> Result<Look, Failure> {
        self.check()?;
        let mode = self.mode_name();
        let chosen = match self.window {
            None => (mode == ModeName::Iso).then(|| volume.full_window()),
            Some(WindowSpec::Full) => Some(volume.full_window()),
            Some(WindowSpec::Auto) => Some(volume.statistics().robust_window()),
            Some(WindowSpec::Bounds(lo, hi)) => Some(Window::new(lo, hi).map_err(Failure::input)?),
        };
        let (resolved, transfer_name) = match (&self.tf, mode) {
            (Some(spec), _) => (spec.resolve(volume, chosen)?, spec.name()),
            (None, ModeName::Dvr) => (TransferSpec::Automatic.resolve(volume, chosen)?, "auto".to_owned()),
            (None, _) => (gray(volume, chosen)?, "gray".to_owned()),
        };
        if self.preintegrated && resolved.transfer.is_2d() {
            return Err(Failure::input("--preintegrated needs a transfer function of one dimension"));
        }
        let isovalue = match self.iso {
            Some(isovalue) => isovalue as f32,
            None if mode == ModeName::Iso => middle(volume, resolved.window),
            None => 0.0,
        };
        let has_surface_color = mode == ModeName::Iso && self.tf.is_some();
        let default_shading = if mode == ModeName::Iso { Shading::Phong } else { Shading::None };
        let surface_rgb = has_surface_color.then(|| resolved.transfer.color_at(isovalue));
        let [box_lo, box_hi] = self.clip_box.unwrap_or([DVec3::ZERO, DVec3::ONE]);
        let settings = Settings {
            mode: mode.with_isovalue(isovalue),
            preintegrated: self.preintegrated,
            shading: self.shading.unwrap_or(default_shading),
            surface_rgb,
            boundaries: self.boundaries,
            gradient: match self.gradient {
                GradientName::Central => GradientMethod::CentralDifferences,
                GradientName::Tetrahedron => GradientMethod::Tetrahedron,
            },
            sampling_factor: self.sampling_factor as f32,
            early_termination: (self.ert > 0.0).then_some(self.ert as f32),
            clip: Clip { box_lo, box_hi, plane: self.clip_plane },
            ..Settings::new(resolved.window, resolved.transfer)
        };
        Ok(Look { settings, mode, transfer_name })
    }
}

fn gray(volume: &Volume, chosen: Option<Window>) -> Result<Resolved, Failure> {
    TransferSpec::Ramp([0.0, 1.0]).resolve(volume, chosen)
}

/// The middle of the robust window as a normalised value.
fn middle(volume: &Volume, window: Window) -> f32 {
    let robust = volume.statistics().robust_window();
    window.normalise(robust.denormalise(0.5)) as f32
}
