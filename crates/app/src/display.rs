//! Which light-field display.

use crate::failure::Failure;
use crate::quilt_file::{check_name, is_named};
use crate::spec;
use crate::text_file::read_text_file;
use clap::Args;
use serde_json::{Map, Value, json};
use std::path::Path;
use wheatstone_core::lightfield::quilt::{Model, QuiltName};
use wheatstone_core::lightfield::{DisplayError, Lenticular, ProjectorArray, QuiltDisplay};

/// Flags that describe a display.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Display")]
pub(crate) struct DisplayArgs {
    /// portrait, go, 16, 32, 65, 16-landscape, 16-portrait, 32-landscape, 32-portrait (by Looking Glass), agus-2008
    /// (projectors) or a description; what follows replaces its numbers [default: portrait].
    #[arg(long, value_name = "NAME|FILE.json")]
    display: Option<String>,

    /// Views beside each other in a quilt.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024), allow_negative_numbers = true)]
    columns: Option<u32>,

    /// Views above each other in a quilt.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024), allow_negative_numbers = true)]
    rows: Option<u32>,

    /// Width and height of a quilt, pixels.
    #[arg(long, value_name = "WxH", value_parser = spec::display_picture_size)]
    quilt_size: Option<[u32; 2]>,

    /// Width of the screen over its height.
    #[arg(long, value_name = "RATIO", value_parser = spec::within(0.01..=100.0), allow_negative_numbers = true)]
    aspect: Option<f64>,

    /// Angle between the outermost directions in which there are views, degrees.
    #[arg(long, value_name = "DEG", value_parser = spec::within(0.1..=179.0), allow_negative_numbers = true)]
    view_cone: Option<f64>,

    /// Distance of the cameras from the screen, metres.
    #[arg(long, value_name = "M", value_parser = spec::within(0.001..=1000.0), allow_negative_numbers = true)]
    focal_distance: Option<f64>,

    /// Height of the screen, metres.
    #[arg(long, value_name = "M", value_parser = spec::within(0.001..=1000.0), allow_negative_numbers = true)]
    screen_height: Option<f64>,
}

/// The flag that names a display of projectors.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Display")]
pub(crate) struct ArrayArgs {
    /// agus-2008 (96 projectors of 320x240) or a description.
    #[arg(long, value_name = "NAME|FILE.json", default_value = OF_PAPER)]
    display: String,
}

/// A display of either kind.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Display {
    /// Behind lenses.
    Lenses(QuiltDisplay),
    /// Projectors behind a screen.
    Projectors(ProjectorArray),
}

/// Name of the display of projectors that LF describes.
const OF_PAPER: &str = "agus-2008";

/// Most bytes of a description: thousands of projectors take a few hundred each.
const MOST_BYTES: u64 = 1 << 22;

/// By how much of itself the aspect of a panel may differ from that of its display.
const ASPECT_TOLERANCE: f64 = 0.02;

impl DisplayArgs {
    /// The display. Behind lenses whose calibration is known, the view cone is theirs.
    pub(crate) fn resolve(&self, lenses: Option<&Lenticular>) -> Result<Display, Failure> {
        let name = self.display.as_deref().unwrap_or(Model::Portrait.name());
        match named(name)? {
            Display::Lenses(display) => self.changed(display, lenses).map(Display::Lenses),
            Display::Projectors(_) if self.changes_something() || lenses.is_some() => {
                Err(Failure::input(format!(
                    "{name} has projectors: columns, rows, sizes and calibrations are those of displays behind lenses"
                )))
            }
            projectors @ Display::Projectors(_) => Ok(projectors),
        }
    }

    /// The display behind lenses that a quilt is for, given what flags alone make of it: the name of its file tells columns, rows and
    /// aspect, and its size is that of the display's quilts, but for what flags say. A name that tells nothing leaves the display as it is.
    pub(crate) fn of_quilt(
        &self,
        display: QuiltDisplay,
        name: &str,
        quilt_size_px: [u32; 2],
    ) -> Result<QuiltDisplay, Failure> {
        let Ok(named) = name.parse::<QuiltName>() else { return Ok(display) };
        let base = if self.display.is_some() { display } else { laid_out_as(&named) };
        let display = self.changed(QuiltDisplay { quilt_size_px, ..base }, None)?;
        check_name(name, &display)?;
        Ok(display)
    }

    /// The description, if it is a file.
    pub(crate) fn file(&self) -> Option<&Path> {
        self.display.as_deref().filter(|name| is_file(name)).map(Path::new)
    }

    fn changes_something(&self) -> bool {
        let Self { columns, rows, quilt_size, aspect, view_cone, focal_distance, screen_height, .. } = self;
        let numbers = [aspect, view_cone, focal_distance, screen_height];
        columns.or(*rows).is_some() || quilt_size.is_some() || numbers.iter().any(|number| number.is_some())
    }

    fn changed(&self, base: QuiltDisplay, lenses: Option<&Lenticular>) -> Result<QuiltDisplay, Failure> {
        let cone_of_lenses = lenses.map(|lenses| lenses.view_cone_deg);
        let display = QuiltDisplay {
            columns: self.columns.unwrap_or(base.columns),
            rows: self.rows.unwrap_or(base.rows),
            quilt_size_px: self.quilt_size.unwrap_or(base.quilt_size_px),
            aspect: self.aspect.unwrap_or(base.aspect),
            view_cone_deg: self.view_cone.or(cone_of_lenses).unwrap_or(base.view_cone_deg),
            focal_distance_m: self.focal_distance.unwrap_or(base.focal_distance_m),
            screen_height_m: self.screen_height.unwrap_or(base.screen_height_m),
        };
        let display = display.checked().map_err(Failure::input)?;
        lenses.map_or(Ok(()), |lenses| check_panel(&display, lenses)).map_err(Failure::input)?;
        Ok(display)
    }
}

impl ArrayArgs {
    /// The display.
    pub(crate) fn resolve(&self) -> Result<ProjectorArray, Failure> {
        match named(&self.display)? {
            Display::Projectors(array) => Ok(array),
            Display::Lenses(_) => Err(Failure::input(format!(
                "{} is behind lenses: a display of projectors is needed, {OF_PAPER} or a description",
                self.display
            ))),
        }
    }

    /// The description, if it is a file.
    pub(crate) fn file(&self) -> Option<&Path> {
        is_file(&self.display).then(|| Path::new(&self.display))
    }
}

/// The first known display whose quilts are laid out as a name tells, or the portrait with such quilts.
fn laid_out_as(named: &QuiltName) -> QuiltDisplay {
    let known = Model::ALL.iter().map(|model| model.display()).find(|display| is_named(named, display));
    let QuiltName { columns, rows, aspect, .. } = *named;
    known.unwrap_or(QuiltDisplay { columns, rows, aspect, ..Model::Portrait.display() })
}

/// The names of known displays.
pub(crate) fn known_names() -> impl Iterator<Item = &'static str> {
    Model::ALL.iter().map(|model| model.name()).chain([OF_PAPER])
}

/// Whether the name of a display is that of a file.
pub(crate) fn is_file(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"))
}

/// A known display, or that of a file.
pub(crate) fn named(name: &str) -> Result<Display, Failure> {
    if name == OF_PAPER {
        return Ok(Display::Projectors(ProjectorArray::of_paper()));
    }
    if is_file(name) {
        return read_text_file(Path::new(name), MOST_BYTES, "a description of a display", from_json);
    }
    let model = name.parse::<Model>().map_err(|error| {
        Failure::input(format!("--display: {error}, {OF_PAPER}; descriptions end in .json"))
    })?;
    Ok(Display::Lenses(model.display()))
}

/// Refuses lenses on a panel of another shape than the display's screen.
pub(crate) fn check_panel(display: &QuiltDisplay, lenses: &Lenticular) -> Result<(), String> {
    let [width, height] = lenses.panel_px;
    let panel_aspect = f64::from(width) / f64::from(height);
    if (panel_aspect / display.aspect - 1.0).abs() <= ASPECT_TOLERANCE {
        return Ok(());
    }
    Err(format!(
        "the calibration is of a panel of {width}x{height} pixels, {panel_aspect:.4}: the display's aspect is {:.4}",
        display.aspect
    ))
}

impl Display {
    /// Its description.
    pub(crate) fn to_json(&self) -> Value {
        match self {
            Self::Lenses(display) => json!(display),
            Self::Projectors(array) => json!(array.description()),
        }
    }
}

/// Either kind of description.
pub(crate) fn from_json(text: &str) -> Result<Display, DisplayError> {
    let fields: Map<String, Value> = serde_json::from_str(text)?;
    if fields.contains_key("wheatstone_projector_array") {
        ProjectorArray::from_json(text).map(Display::Projectors)
    } else if fields.contains_key("columns") {
        QuiltDisplay::from_json(text).map(Display::Lenses)
    } else {
        Err(DisplayError::UnknownKind)
    }
}

/// Reads the calibration of a display's lenses.
pub(crate) fn read_calibration(path: &Path) -> Result<Lenticular, Failure> {
    read_text_file(path, MOST_BYTES, "a calibration", Lenticular::from_visual_json)
}
