//! The JSON form of a transfer function; `docs/transfer-functions.md` describes it.

use super::{
    ColorPoint, Colormap, OpacityPoint, TransferError, TransferFile, TransferFunction, UnknownColormap,
};
use crate::volume::{Window, WindowError};
use serde::Deserialize;
use std::fmt::Write;
use thiserror::Error;

/// The version of the form that is read and written.
pub const JSON_VERSION: u64 = 1;

/// How many points a colour map that is given by name becomes.
const COLORMAP_POINTS: usize = 65;

/// Why a text is not a transfer function in Wheatstone's JSON form.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TransferJsonError {
    /// Not JSON, a field is missing or unknown, or a field has the wrong shape.
    #[error("not a transfer function in JSON: {0}")]
    Syntax(#[from] serde_json::Error),
    /// A later version of the form.
    #[error("version {found} of the transfer-function form; this program reads version {JSON_VERSION}")]
    Version {
        /// Version in the text.
        found: u64,
    },
    /// The colour is a name that is no colour map's.
    #[error(transparent)]
    Colormap(#[from] UnknownColormap),
    /// Points out of order or out of bounds.
    #[error(transparent)]
    Points(#[from] TransferError),
    /// The window's bounds are not finite or not in order.
    #[error(transparent)]
    Window(#[from] WindowError),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Form {
    wheatstone_transfer_function: u64,
    color: ColorForm,
    opacity: Vec<[f32; 2]>,
    #[serde(default)]
    gradient_opacity: Vec<[f32; 2]>,
    window: Option<[f64; 2]>,
}

#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "color must be the name of a colour map or a list of [value, red, green, blue]"
)]
enum ColorForm {
    Name(String),
    Points(Vec<[f32; 4]>),
}

impl TransferFile {
    /// Reads the JSON form.
    ///
    /// # Errors
    /// [`TransferJsonError`] for anything that is not a complete and valid transfer function of version
    /// [`JSON_VERSION`]; unknown fields are refused.
    pub fn from_json(text: &str) -> Result<Self, TransferJsonError> {
        let form: Form = serde_json::from_str(text)?;
        if form.wheatstone_transfer_function != JSON_VERSION {
            return Err(TransferJsonError::Version { found: form.wheatstone_transfer_function });
        }
        let color = match form.color {
            ColorForm::Name(name) => name.parse::<Colormap>()?.color_points(COLORMAP_POINTS),
            ColorForm::Points(points) => {
                points.into_iter().map(|[at, r, g, b]| ColorPoint { at, rgb: [r, g, b] }).collect()
            }
        };
        let opacity_points = |points: Vec<[f32; 2]>| {
            points.into_iter().map(|[at, alpha]| OpacityPoint { at, alpha }).collect::<Vec<_>>()
        };
        let transfer = TransferFunction::new(color, opacity_points(form.opacity))?
            .with_gradient_opacity(opacity_points(form.gradient_opacity))?;
        let window = form.window.map(|[lo, hi]| Window::new(lo, hi)).transpose()?;
        Ok(Self { transfer, window })
    }

    /// Writes the JSON form, one point a line. Reading it back gives the same function, and the window to the last
    /// digit.
    pub fn to_json(&self) -> String {
        let color: Vec<String> = self
            .transfer
            .color_points()
            .iter()
            .map(|ColorPoint { at, rgb: [r, g, b] }| format!("[{at}, {r}, {g}, {b}]"))
            .collect();
        let opacity_lines = |points: &[OpacityPoint]| -> Vec<String> {
            points.iter().map(|OpacityPoint { at, alpha }| format!("[{at}, {alpha}]")).collect()
        };
        let mut json = format!("{{\n  \"wheatstone_transfer_function\": {JSON_VERSION}");
        let mut list = |name: &str, lines: &[String]| {
            // Writing to a string cannot fail.
            let _ = write!(json, ",\n  \"{name}\": [\n    {}\n  ]", lines.join(",\n    "));
        };
        list("color", &color);
        list("opacity", &opacity_lines(self.transfer.opacity_points()));
        if self.transfer.is_2d() {
            list("gradient_opacity", &opacity_lines(self.transfer.gradient_opacity_points()));
        }
        if let Some(window) = self.window {
            let _ = write!(json, ",\n  \"window\": [{}, {}]", window.lo(), window.hi());
        }
        json.push_str("\n}\n");
        json
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn parse(fields: &str) -> Result<TransferFile, TransferJsonError> {
        TransferFile::from_json(&format!(r#"{{"wheatstone_transfer_function": 1, {fields}}}"#))
    }

    #[test]
    fn the_documented_examples_are_read() {
        let document = include_str!("../../../../docs/transfer-functions.md");
        let examples: Vec<&str> =
            document.split("```json\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
        assert!(examples.len() >= 2, "the document shows the form");
        let files: Vec<TransferFile> =
            examples.iter().map(|text| TransferFile::from_json(text).unwrap()).collect();
        assert!(files.iter().any(|file| file.transfer.is_2d()));
        assert!(files.iter().any(|file| file.window.is_some()));
    }

    #[test]
    fn errors_say_what_is_wrong() {
        let message = |fields: &str| parse(fields).unwrap_err().to_string();
        let opacity = r#""opacity": [[0, 0], [1, 1]]"#;
        assert!(message(r#""color": "gray""#).contains("missing field `opacity`"));
        assert!(message(&format!(r#""color": "gray", {opacity}, "opactiy": []"#)).contains("`opactiy`"));
        assert!(message(&format!(r#""color": "jet", {opacity}"#)).contains("viridis"));
        assert!(
            message(&format!(r#""color": [[0, 1, 1]], {opacity}"#)).contains("[value, red, green, blue]")
        );
        assert!(message(&format!(r#""color": [], {opacity}"#)).contains("at least one color point"));
        assert!(message(&format!(r#""color": "gray", {opacity}, "window": [1, 1]"#)).contains("window 1..1"));
        assert!(message(r#""color": "gray", "opacity": [[0.5, 0], [0.4, 1]]"#).contains("opacity point 1"));
        assert!(message(r#""color": "gray", "opacity": [[0.5, 1.5]]"#).contains("1.5"));
        let later = r#"{"wheatstone_transfer_function": 2, "color": "gray", "opacity": [[0, 1]]}"#;
        assert!(matches!(TransferFile::from_json(later), Err(TransferJsonError::Version { found: 2 })));
    }

    fn opacity_points() -> impl Strategy<Value = Vec<OpacityPoint>> {
        prop::collection::vec((-0.5_f32..1.5, 0.0_f32..=1.0), 1..6).prop_map(|mut points| {
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            points.into_iter().map(|(at, alpha)| OpacityPoint { at, alpha }).collect()
        })
    }

    proptest! {
        #[test]
        fn what_is_written_is_read_back(
            opacity in opacity_points(),
            gradient in prop::option::of(opacity_points()),
            rgb in prop::array::uniform3(0.0_f32..=1.0),
            window in prop::option::of((-1e6..1e6_f64, 1e-3..1e6_f64)),
        ) {
            let color = vec![ColorPoint { at: 0.0, rgb }, ColorPoint { at: 0.7, rgb: [0.1, 0.2, 0.3] }];
            let transfer = TransferFunction::new(color, opacity)
                .and_then(|transfer| transfer.with_gradient_opacity(gradient.unwrap_or_default()))
                .unwrap();
            let file = TransferFile {
                transfer,
                window: window.map(|(lo, width)| Window::new(lo, lo + width).unwrap()),
            };
            let read = TransferFile::from_json(&file.to_json()).unwrap();
            prop_assert_eq!(read.transfer, file.transfer);
            prop_assert_eq!(read.window.is_some(), file.window.is_some());
            if let (Some(read), Some(written)) = (read.window, file.window) {
                prop_assert!((read.lo() - written.lo()).abs() <= 1e-14 * written.lo().abs());
                prop_assert!((read.hi() - written.hi()).abs() <= 1e-14 * written.hi().abs());
            }
        }

        #[test]
        fn arbitrary_text_never_panics(text in ".*") {
            let _ = TransferFile::from_json(&text);
        }
    }
}
