//! The pinhole emitter that measured beams agree with best.

use crate::lightfield::projectors::{ImageRect, Projector};
use glam::{DVec2, DVec3};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{Dyn, OMatrix, OVector, U7};
use thiserror::Error;

/// A pixel, and a place in front of, on or behind the screen that its beam passes, as measured without the diffuser.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Correspondence {
    /// Position in the projector's image, pixels from the top left; the first pixel's middle is at ½.
    pub pixel: DVec2,
    /// Place in display space, metres.
    pub place_m: DVec3,
}

/// A projector as fitted, and how far its beams miss what was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// Emitter and image; the id is that of the first guess. What is seen in a mirror comes out as it is seen.
    pub projector: Projector,
    /// Root of the mean square distance of the beams from the measured places, across z, metres.
    pub rms_m: f64,
    /// Largest such distance, metres.
    pub worst_m: f64,
}

/// Why there is no fit.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum FitError {
    /// Fewer measurements than unknown numbers need.
    #[error("{found} correspondences: at least {LEAST} are needed")]
    TooFew {
        /// Measurements given.
        found: usize,
    },
    /// A number that is not finite.
    #[error("correspondence {0} has a number that is not finite")]
    NotFinite(usize),
    /// Measurements that leave the emitter or the image open.
    #[error("the places do not tell where the {0}: they must differ {1}")]
    Degenerate(&'static str, &'static str),
    /// A search that did not end at a minimum, or at no projector.
    #[error("no emitter behind the screen agrees with the correspondences: {0}")]
    NotFound(String),
}

/// Least number of correspondences: two numbers each, for seven unknown ones.
const LEAST: usize = 4;

/// Least difference between depths of the places, metres.
const LEAST_DEPTH_M: f64 = 1e-4;

/// Least difference between positions in the image, pixels.
const LEAST_PX: f64 = 0.5;

/// Unknown numbers: the emitter's place, then the left, right, bottom and top edges of the image.
type Unknowns = OVector<f64, U7>;

struct Problem<'a> {
    correspondences: &'a [Correspondence],
    image_size_px: DVec2,
    unknowns: Unknowns,
}

impl Problem<'_> {
    /// Place on the screen of a correspondence's pixel, and by how much of the way from the emitter its beam has gone.
    fn beam(&self, c: &Correspondence) -> (DVec2, DVec2, f64) {
        let share = c.pixel / self.image_size_px;
        let u = &self.unknowns;
        let screen_m = DVec2::new(u[3] + (u[4] - u[3]) * share.x, u[6] + (u[5] - u[6]) * share.y);
        (share, screen_m, (c.place_m.z - u[2]) / -u[2])
    }

    /// From the measured place to where the beam passes its plane, metres.
    fn miss_m(&self, c: &Correspondence) -> DVec2 {
        let (_, screen_m, way) = self.beam(c);
        let emitter = DVec2::new(self.unknowns[0], self.unknowns[1]);
        emitter + (screen_m - emitter) * way - c.place_m.truncate()
    }
}

impl LeastSquaresProblem<f64, Dyn, U7> for Problem<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, U7>;
    type ParameterStorage = Owned<f64, U7>;

    fn set_params(&mut self, unknowns: &Unknowns) {
        self.unknowns.copy_from(unknowns);
    }

    fn params(&self) -> Unknowns {
        self.unknowns
    }

    fn residuals(&self) -> Option<OVector<f64, Dyn>> {
        let misses = self.correspondences.iter().flat_map(|c| self.miss_m(c).to_array());
        let residuals = OVector::<f64, Dyn>::from_iterator(2 * self.correspondences.len(), misses);
        residuals.iter().all(|miss| miss.is_finite()).then_some(residuals)
    }

    fn jacobian(&self) -> Option<OMatrix<f64, Dyn, U7>> {
        let mut jacobian = OMatrix::<f64, Dyn, U7>::zeros(2 * self.correspondences.len());
        for (i, c) in self.correspondences.iter().enumerate() {
            let (share, screen_m, way) = self.beam(c);
            let emitter = DVec2::new(self.unknowns[0], self.unknowns[1]);
            // The way, 1 − z/E_z, changes with E_z by z/E_z².
            let along = (screen_m - emitter) * (c.place_m.z / (self.unknowns[2] * self.unknowns[2]));
            let (x, y) = (2 * i, 2 * i + 1);
            (jacobian[(x, 0)], jacobian[(y, 1)]) = (1.0 - way, 1.0 - way);
            (jacobian[(x, 2)], jacobian[(y, 2)]) = (along.x, along.y);
            (jacobian[(x, 3)], jacobian[(x, 4)]) = (way * (1.0 - share.x), way * share.x);
            (jacobian[(y, 5)], jacobian[(y, 6)]) = (way * share.y, way * (1.0 - share.y));
        }
        jacobian.iter().all(|slope| slope.is_finite()).then_some(jacobian)
    }
}

impl Fit {
    /// Fits a projector to correspondences by least squares (Levenberg and Marquardt), from a first guess such as its place by design.
    ///
    /// # Errors
    /// Too few or degenerate correspondences: their places must be at two depths at least, their pixels in two columns and two rows; a
    /// search that does not end behind the screen.
    pub fn of(
        guess: &Projector,
        image_size_px: [u32; 2],
        measured: &[Correspondence],
    ) -> Result<Self, FitError> {
        check(measured)?;
        let ImageRect { left_m, right_m, down_m, up_m } = guess.image;
        let [x_m, y_m, z_m] = guess.emitter_m;
        let problem = Problem {
            correspondences: measured,
            image_size_px: image_size_px.map(f64::from).into(),
            unknowns: Unknowns::from_column_slice(&[x_m, y_m, z_m, left_m, right_m, down_m, up_m]),
        };
        let (fitted, report) = LevenbergMarquardt::new().minimize(problem);
        if !report.termination.was_successful() {
            return Err(FitError::NotFound(format!("{:?}", report.termination)));
        }
        let [x_m, y_m, z_m, left_m, right_m, down_m, up_m] = fitted.unknowns.into();
        if z_m >= 0.0 || !fitted.unknowns.iter().all(|number: &f64| number.is_finite()) {
            return Err(FitError::NotFound(format!("the best is at z = {z_m} m")));
        }
        let image = ImageRect { left_m, right_m, down_m, up_m };
        let misses_m = || measured.iter().map(|c| fitted.miss_m(c).length());
        Ok(Self {
            projector: Projector { id: guess.id, emitter_m: [x_m, y_m, z_m], image },
            rms_m: (misses_m().map(|miss| miss * miss).sum::<f64>() / measured.len() as f64).sqrt(),
            worst_m: misses_m().fold(0.0, f64::max),
        })
    }
}

fn check(measured: &[Correspondence]) -> Result<(), FitError> {
    if measured.len() < LEAST {
        return Err(FitError::TooFew { found: measured.len() });
    }
    if let Some(index) = measured.iter().position(|c| !(c.pixel.is_finite() && c.place_m.is_finite())) {
        return Err(FitError::NotFinite(index));
    }
    let spread = |of: fn(&Correspondence) -> f64| {
        let (low, high) = measured
            .iter()
            .map(of)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        high - low
    };
    if spread(|c| c.place_m.z) < LEAST_DEPTH_M {
        return Err(FitError::Degenerate("emitter is", "in z"));
    }
    if spread(|c| c.pixel.x) < LEAST_PX {
        return Err(FitError::Degenerate("image's left and right edges are", "in their pixels' columns"));
    }
    if spread(|c| c.pixel.y) < LEAST_PX {
        return Err(FitError::Degenerate("image's top and bottom edges are", "in their pixels' rows"));
    }
    Ok(())
}
