//! How the two pictures of a stereo pair come about, as the user asks for it.

use crate::backend::Engine;
use crate::camera::Stereo;
use crate::failure::Failure;
use crate::pair_cost;
use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::view::View;
use wheatstone_render::{Form, LayerFormat, PairMethod, Quality};

/// Flags of stereo pairs.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Stereo pairs")]
pub(crate) struct PairArgs {
    /// How the pictures of two eyes are made: each by a cast, or one of them from the rays of the other [default: auto].
    #[arg(long, value_enum, value_name = "METHOD")]
    stereo_method: Option<MethodName>,

    /// How much is done for the eye that is not cast [default: repaired for strips and auto, else fast].
    #[arg(long, value_enum, value_name = "QUALITY")]
    stereo_quality: Option<QualityName>,

    /// The eye that is cast if only one is [default: left].
    #[arg(long, value_enum, value_name = "EYE")]
    reference_eye: Option<Eye>,
}

/// How the pictures of a pair are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MethodName {
    /// As is likely to be fastest.
    Auto,
    /// By two casts.
    TwoPass,
    /// By one cast.
    SinglePass(FormName),
}

impl ValueEnum for MethodName {
    fn value_variants<'a>() -> &'a [Self] {
        &[
            Self::Auto,
            Self::TwoPass,
            Self::SinglePass(FormName::Strips),
            Self::SinglePass(FormName::Tiles),
            Self::SinglePass(FormName::Layers),
            Self::SinglePass(FormName::Layers16),
            Self::SinglePass(FormName::Volumetric),
        ]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        match self {
            Self::Auto => Some(PossibleValue::new("auto").help("As is likely to be fastest")),
            Self::TwoPass => Some(PossibleValue::new("two-pass").help("By two casts")),
            Self::SinglePass(form) => form.to_possible_value(),
        }
    }
}

/// How one cast makes a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FormName {
    /// By one cast in strips of columns; only on a GPU.
    Strips,
    /// By one cast in tiles of columns; only on a GPU.
    Tiles,
    /// By one cast into layers of 8 bits per channel; only on a GPU.
    Layers,
    /// By one cast into layers of 16 bits per channel; only on a GPU.
    #[value(name = "layers-16")]
    Layers16,
    /// By one cast that keeps four layers of emission and absorption, warped to the other eye; only on a GPU.
    Volumetric,
}

impl FormName {
    /// Name as on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Strips => "strips",
            Self::Tiles => "tiles",
            Self::Layers => "layers",
            Self::Layers16 => "layers-16",
            Self::Volumetric => "volumetric",
        }
    }

    /// Whether its derived pictures can be repaired.
    pub(crate) fn is_repairable(self) -> bool {
        self == Self::Strips
    }

    /// Whether it makes pictures of a quality.
    pub(crate) fn makes(self, quality: QualityName) -> bool {
        match quality {
            QualityName::Nearest => self != Self::Volumetric,
            QualityName::Fast => true,
            QualityName::Repaired => self.is_repairable(),
        }
    }

    fn form(self) -> Form {
        match self {
            Self::Strips => Form::Strips,
            Self::Tiles => Form::Tiles,
            Self::Layers => Form::Layers(LayerFormat::Rgba8Unorm),
            Self::Layers16 => Form::Layers(LayerFormat::Rgba16Float),
            Self::Volumetric => Form::Volumetric,
        }
    }
}

/// How much is done for a derived picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum QualityName {
    /// Samples of the other eye's rays, each in the nearest column.
    Nearest,
    /// Samples of the other eye's rays, shared by the two columns that they are between.
    Fast,
    /// Where its error would show, the picture is cast; only of strips.
    Repaired,
}

impl QualityName {
    /// Name as on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Nearest => "nearest",
            Self::Fast => "fast",
            Self::Repaired => "repaired",
        }
    }

    /// Why a form does not make pictures of this quality.
    pub(crate) fn why_not(self) -> &'static str {
        match self {
            Self::Repaired => "only strips are repaired",
            Self::Nearest | Self::Fast => "a warp has one quality, fast",
        }
    }

    fn quality(self) -> Quality {
        match self {
            Self::Nearest => Quality::Nearest,
            Self::Fast => Quality::Fast,
            Self::Repaired => Quality::Repaired,
        }
    }
}

/// One of two eyes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Eye {
    /// The first of a pair of views.
    Left,
    /// The second.
    Right,
}

impl Eye {
    /// Name as on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }

    /// This one and the other of a pair, left first.
    pub(crate) fn and_other<T>(self, [left, right]: [T; 2]) -> [T; 2] {
        match self {
            Self::Left => [left, right],
            Self::Right => [right, left],
        }
    }
}

/// How one cast makes a pair, in full.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Pairing {
    /// How rays of the one eye get to the picture of the other.
    pub(crate) form: FormName,
    /// How much is done for that picture.
    pub(crate) quality: QualityName,
    /// The eye that is cast.
    pub(crate) reference: Eye,
}

impl Pairing {
    /// What the renderer takes.
    pub(crate) fn method(&self) -> PairMethod {
        PairMethod { form: self.form.form(), quality: self.quality.quality() }
    }
}

/// What is asked for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PairRequest {
    method: MethodName,
    quality: QualityName,
    reference: Eye,
}

impl PairArgs {
    /// What is asked for; nothing where there is one eye only.
    pub(crate) fn resolve(&self, stereo: Stereo) -> Result<Option<PairRequest>, Failure> {
        let given = [
            ("--stereo-method", self.stereo_method.is_some()),
            ("--stereo-quality", self.stereo_quality.is_some()),
            ("--reference-eye", self.reference_eye.is_some()),
        ];
        if stereo.has_both_eyes() {
            let method = self.stereo_method.unwrap_or(MethodName::Auto);
            return Ok(Some(PairRequest {
                method,
                quality: self.quality(method)?,
                reference: self.reference_eye.unwrap_or(Eye::Left),
            }));
        }
        match given.into_iter().find(|&(_, is_given)| is_given) {
            Some((flag, _)) => Err(Failure::input(format!(
                "{flag} needs --stereo side-by-side, top-bottom, anaglyph or wobble"
            ))),
            None => Ok(None),
        }
    }

    fn quality(&self, method: MethodName) -> Result<QualityName, Failure> {
        match (method, self.stereo_quality) {
            (MethodName::SinglePass(form), Some(quality)) if !form.makes(quality) => {
                let (form, quality, why) = (form.name(), quality.name(), quality.why_not());
                Err(Failure::input(format!("--stereo-method {form} --stereo-quality {quality}: {why}")))
            }
            (MethodName::SinglePass(form), None) if !form.is_repairable() => Ok(QualityName::Fast),
            (_, quality) => Ok(quality.unwrap_or(QualityName::Repaired)),
        }
    }
}

impl PairRequest {
    /// Whether one cast is asked for, which only a GPU makes a pair of.
    pub(crate) fn is_single_pass(&self) -> bool {
        matches!(self.method, MethodName::SinglePass(_))
    }

    /// How a caster is to make the pair; nothing for two casts.
    pub(crate) fn pairing(
        &self,
        engine: &Engine<'_>,
        parameters: &CastParameters,
        views: &[View],
    ) -> Option<Pairing> {
        let form = match (self.method, engine) {
            (MethodName::TwoPass, _) | (MethodName::Auto, Engine::Cpu(_)) => None,
            (MethodName::SinglePass(form), _) => Some(form),
            (MethodName::Auto, Engine::Gpu(_)) => pair_cost::cheapest(parameters, views),
        };
        form.map(|form| Pairing { form, quality: self.quality, reference: self.reference })
    }
}
