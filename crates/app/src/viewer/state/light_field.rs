//! The light-field display that the volume is shown on.

use super::Camera;
use crate::display::{self, Display, check_panel};
use glam::{DAffine3, DVec3};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use wheatstone_core::lightfield::quilt::{Model, Sampling};
use wheatstone_core::lightfield::simulator::{Eye, SeenView};
use wheatstone_core::lightfield::{Lenticular, QuiltDisplay};
use wheatstone_core::view::View;

/// A display, and the eye before it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct LightField {
    pub(crate) display: ShownDisplay,
    /// How the display's lenses lie on its panel, if that is known.
    pub(crate) calibration: Option<Calibration>,
    /// Where the eye is in display space, metres; none is where the display is made for.
    pub(crate) eye_m: Option<DVec3>,
}

/// A display by its name or by its description.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Value", into = "Value")]
pub(crate) struct ShownDisplay {
    form: Value,
    display: Display,
}

/// A calibration as its maker writes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Value", into = "Value")]
pub(crate) struct Calibration {
    form: Value,
    lenses: Lenticular,
}

/// Most views of a display that is shown: layers of a texture that every device has.
const MOST_VIEWS: usize = 256;

/// Pixels of all views together at most, where they are not shown side by side: pictures of them take 32 bytes for each pixel.
const MOST_PIXELS: f64 = (1 << 21) as f64;

/// Nearest and furthest that the eye comes, metres.
const EYE_DISTANCES_M: [f64; 2] = [0.01, 100.0];

/// Views beside and above each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Grid {
    pub(crate) columns: u32,
    pub(crate) rows: u32,
    /// Whether the first row is the lowest.
    pub(crate) begins_below: bool,
}

impl Default for ShownDisplay {
    fn default() -> Self {
        let display = Display::Lenses(Model::Portrait.display());
        Self { form: Value::String(Model::Portrait.name().to_owned()), display }
    }
}

impl ShownDisplay {
    /// A known display, or that of a file, whose description is kept.
    pub(crate) fn named(name: &str) -> Result<Self, crate::failure::Failure> {
        let display = display::named(name)?;
        let form = if display::is_file(name) { display.to_json() } else { Value::String(name.to_owned()) };
        Ok(Self { form, display })
    }

    /// Every display that is known by a name.
    pub(crate) fn known() -> Vec<Self> {
        display::known_names().filter_map(|name| Self::named(name).ok()).collect()
    }

    /// Its name, if it has one.
    pub(crate) fn name(&self) -> Option<&str> {
        self.form.as_str()
    }
}

impl TryFrom<Value> for ShownDisplay {
    type Error = String;

    fn try_from(form: Value) -> Result<Self, String> {
        let display = match &form {
            // Files are read by flags alone: a saved view holds what it shows.
            Value::String(name) if display::is_file(name) => {
                return Err(format!(
                    "{name}: files of displays are read by --display alone; this must be the name of a display or its description"
                ));
            }
            Value::String(name) => display::named(name).map_err(|failure| failure.to_string())?,
            Value::Object(_) => display::from_json(&form.to_string()).map_err(|error| error.to_string())?,
            other => return Err(format!("{other}: must be the name of a display or its description")),
        };
        Ok(Self { form, display })
    }
}

impl From<ShownDisplay> for Value {
    fn from(shown: ShownDisplay) -> Self {
        shown.form
    }
}

impl TryFrom<Value> for Calibration {
    type Error = String;

    fn try_from(form: Value) -> Result<Self, String> {
        let lenses = Lenticular::from_visual_json(&form.to_string()).map_err(|error| error.to_string())?;
        Ok(Self { form, lenses })
    }
}

impl From<Calibration> for Value {
    fn from(calibration: Calibration) -> Self {
        calibration.form
    }
}

impl Calibration {
    /// Reads a `visual.json`.
    pub(crate) fn from_visual_json(text: &str) -> Result<Self, String> {
        let form: Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
        Self::try_from(form)
    }

    pub(crate) fn lenses(&self) -> &Lenticular {
        &self.lenses
    }
}

impl LightField {
    /// The display; behind lenses whose calibration is known, their view cone.
    pub(crate) fn display(&self) -> Display {
        match (&self.display.display, &self.calibration) {
            (Display::Lenses(display), Some(calibration)) => {
                Display::Lenses(QuiltDisplay { view_cone_deg: calibration.lenses.view_cone_deg, ..*display })
            }
            (display, _) => display.clone(),
        }
    }

    /// Width and height of the screen, metres.
    pub(crate) fn screen_size_m(&self) -> [f64; 2] {
        match &self.display.display {
            Display::Lenses(display) => display.screen_size_m(),
            Display::Projectors(array) => array.description().screen_size_m,
        }
    }

    /// Views of the display.
    pub(crate) fn view_count(&self) -> u32 {
        match &self.display.display {
            Display::Lenses(display) => display.view_count(),
            Display::Projectors(array) => array.projectors().len() as u32,
        }
    }

    /// How views are sent: as tiles of a quilt, or as many beside each other as in a frame.
    pub(crate) fn grid(&self) -> Grid {
        match &self.display.display {
            Display::Lenses(display) => {
                Grid { columns: display.columns, rows: display.rows, begins_below: true }
            }
            Display::Projectors(array) => {
                let description = array.description();
                let [columns, _] = description.packing.columns_and_rows(description.image_size_px);
                let columns = columns.min(self.view_count());
                Grid { columns, rows: self.view_count().div_ceil(columns), begins_below: false }
            }
        }
    }

    /// Width and height of each view side by side in an area, pixels: no larger than the display's, and of its shape.
    pub(crate) fn tile_size_beside(&self, [width, height]: [u32; 2]) -> [u32; 2] {
        let Grid { columns, rows, .. } = self.grid();
        let [full_width, full_height] = self.full_tile_size().map(f64::from);
        let share = (f64::from(width) / (f64::from(columns) * full_width))
            .min(f64::from(height) / (f64::from(rows) * full_height));
        self.tile_size(share)
    }

    /// Width and height of each view where all of them are for one picture, pixels.
    pub(crate) fn tile_size_behind(&self) -> [u32; 2] {
        let [width, height] = self.full_tile_size().map(f64::from);
        self.tile_size((MOST_PIXELS / (width * height * f64::from(self.view_count()))).sqrt())
    }

    fn tile_size(&self, share: f64) -> [u32; 2] {
        let share = share.min(1.0);
        self.full_tile_size().map(|side| ((f64::from(side) * share) as u32).max(1))
    }

    fn full_tile_size(&self) -> [u32; 2] {
        match &self.display.display {
            Display::Lenses(display) => display.tile_size_px(),
            Display::Projectors(array) => array.description().image_size_px,
        }
    }

    /// What each view shows, in order, of a size: on the screen a disc about what the camera looks at is as large as in its picture.
    pub(crate) fn views(&self, camera: &Camera, size: [u32; 2]) -> Result<Vec<View>, String> {
        let seen = camera.view(size).map_err(|error| error.to_string())?;
        let [width_m, height_m] = self.screen_size_m();
        let display_from_world = DAffine3::from_scale(DVec3::splat(width_m.min(height_m) / camera.shown_m()))
            * DAffine3::from_translation(DVec3::Z * camera.distance_m)
            * seen.view_from_world;
        let views = match self.display() {
            Display::Lenses(display) => display.views(Sampling::Middles, display_from_world),
            Display::Projectors(array) => array.views(display_from_world),
        };
        Ok(views.into_iter().map(|view| View { size, ..view }).collect())
    }

    /// Which views the eye sees in each column of a picture of a size, pixels.
    pub(crate) fn views_seen(&self, size: [u32; 2]) -> Result<Vec<Vec<SeenView>>, String> {
        let eye = Eye::new(self.eye_m(), size).map_err(|error| error.to_string())?;
        Ok(match self.display() {
            Display::Lenses(display) => display.views_seen_from(&eye),
            Display::Projectors(array) => array.views_seen_from(&eye),
        })
    }

    /// Where the eye is, metres.
    pub(crate) fn eye_m(&self) -> DVec3 {
        self.eye_m.unwrap_or_else(|| self.usual_eye_m())
    }

    /// Where the display is made for, metres.
    pub(crate) fn usual_eye_m(&self) -> DVec3 {
        match &self.display.display {
            Display::Lenses(display) => DVec3::Z * display.focal_distance_m,
            Display::Projectors(array) => array.virtual_viewer_m(),
        }
    }

    /// The lenses, if the display has some and they are known.
    pub(crate) fn lenses(&self) -> Option<&Lenticular> {
        match &self.display.display {
            Display::Lenses(_) => self.calibration.as_ref().map(Calibration::lenses),
            Display::Projectors(_) => None,
        }
    }

    pub(super) fn check(&self) -> Result<(), String> {
        let views = self.view_count() as usize;
        if views > MOST_VIEWS {
            return Err(format!("a display of {views} views: at most {MOST_VIEWS} are shown"));
        }
        if let Some(eye_m) = self.eye_m {
            let [nearest_m, furthest_m] = EYE_DISTANCES_M;
            let is_within = eye_m.truncate().abs().max_element() <= furthest_m
                && (nearest_m..=furthest_m).contains(&eye_m.z);
            if !is_within {
                return Err(format!(
                    "eye_m is {eye_m}: must be within {furthest_m} m and at least {nearest_m} m before the screen"
                ));
            }
        }
        match (&self.display.display, &self.calibration) {
            (Display::Lenses(display), Some(calibration)) => check_panel(display, &calibration.lenses),
            (Display::Projectors(_), Some(_)) => {
                Err("calibrations are of displays behind lenses: this one has projectors".to_owned())
            }
            (_, None) => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use wheatstone_core::view::Projection;

    fn of(value: Value) -> Result<LightField, String> {
        let light_field: LightField = serde_json::from_value(value).map_err(|error| error.to_string())?;
        light_field.check().map(|()| light_field)
    }

    #[test]
    fn names_and_descriptions_are_kept_as_they_are() {
        let description = json!({
            "columns": 3, "rows": 2, "quilt_size_px": [96, 64], "aspect": 1.0, "view_cone_deg": 40.0,
            "focal_distance_m": 0.5, "screen_height_m": 0.16,
        });
        for form in [json!("go"), json!("agus-2008"), description] {
            let light_field = of(json!({ "display": form })).unwrap();
            assert_eq!(serde_json::to_value(&light_field).unwrap()["display"], form);
        }
        assert!(of(json!({ "display": "tv" })).unwrap_err().contains("portrait"));
        for file in ["x.json", "folder/x.JSON"] {
            assert!(of(json!({ "display": file })).unwrap_err().contains("read by --display alone"));
        }
        assert!(of(json!({ "display": 5 })).unwrap_err().contains("must be the name"));
        assert!(of(json!({ "display": { "columns": 3 } })).unwrap_err().contains("rows"));
        assert!(of(json!({ "calibration": { "pitch": 1 } })).unwrap_err().contains("slope"));
        assert!(of(json!({ "eye_m": [0.0, 0.0, -1.0] })).unwrap_err().contains("before the screen"));
    }

    #[test]
    fn a_file_is_kept_as_its_description_whatever_the_capitals_of_its_name() {
        let folder = tempfile::tempdir().unwrap();
        let description = Display::Lenses(Model::Go.display()).to_json();
        for name in ["mine.json", "MINE.JSON"] {
            let path = folder.path().join(name);
            std::fs::write(&path, description.to_string()).unwrap();
            let shown = ShownDisplay::named(path.to_str().unwrap()).unwrap();
            assert_eq!(Value::from(shown), description);
        }
    }

    #[test]
    fn views_are_as_large_as_there_is_room() {
        let portrait = LightField::default();
        assert_eq!(portrait.tile_size_beside([10_000, 10_000]), [420, 560]);
        assert_eq!(portrait.tile_size_beside([420, 10_000]), [52, 70]);
        let [width, height] = portrait.tile_size_behind();
        assert!(width * height * 48 <= 1 << 21 && (width + 2) * (height + 2) * 48 > 1 << 21);
        let paper = of(json!({ "display": "agus-2008" })).unwrap();
        assert_eq!(paper.grid(), Grid { columns: 4, rows: 24, begins_below: false });
    }

    #[test]
    fn what_the_camera_looks_at_is_in_the_middle_of_the_screen() {
        let camera = Camera::default();
        for name in ["portrait", "16", "agus-2008"] {
            let light_field = of(json!({ "display": name })).unwrap();
            let views = light_field.views(&camera, [40, 30]).unwrap();
            assert_eq!(views.len(), light_field.view_count() as usize);
            let middle = &views[views.len() / 2];
            let target_m = middle.view_from_world.transform_point3(camera.target_m);
            let [x, y] = match middle.projection {
                Projection::Perspective(lens) => [
                    (target_m.x / -target_m.z - lens.left) / (lens.right - lens.left),
                    (target_m.y / -target_m.z - lens.down) / (lens.up - lens.down),
                ],
                Projection::Mcop(mcop) => {
                    let screen_m = mcop.screen_m(target_m).unwrap();
                    [
                        (screen_m.x - mcop.left_m) / (mcop.right_m - mcop.left_m),
                        (screen_m.y - mcop.down_m) / (mcop.up_m - mcop.down_m),
                    ]
                }
                Projection::Orthographic(_) => panic!("no display's"),
            };
            assert!((x - 0.5).abs() < 1e-9 && (y - 0.5).abs() < 1e-9, "{name}: {x} {y}");
        }
    }
}
