//! The pinhole emitter that measured beams agree with best.

use crate::lightfield::error::{DisplayError, LONGEST_SIDE_PX, check, check_place_m, written};
use crate::lightfield::projectors::{ImageRect, Projector};
use glam::{DVec2, DVec3};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::storage::Owned;
use nalgebra::{Dyn, OMatrix, OVector, SMatrix, SymmetricEigen, U7};
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
    /// Index of the correspondence that is missed by so much.
    pub worst: usize,
    /// Standard deviations of the emitter's x, y and z, as far as the misses tell, metres.
    pub emitter_deviation_m: [f64; 3],
    /// Largest standard deviation of an edge of the image, metres.
    pub image_deviation_m: f64,
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
    /// A number of a correspondence that is out of its bounds.
    #[error(transparent)]
    Number(#[from] DisplayError),
    /// Measurements with which several emitters or images agree equally well.
    #[error(
        "the correspondences do not determine the projector: pixels of different columns and of different rows at each of two depths do"
    )]
    Undetermined,
    /// Measurements that tell no more than that the emitter is somewhere behind the screen.
    #[error(
        "the emitter is at z = {} m with a standard deviation of {} m: more exact places are needed, or depths further apart",
        to_millimetres(*z_m), to_millimetres(*deviation_m)
    )]
    Uncertain {
        /// Best z, metres.
        z_m: f64,
        /// Its standard deviation, metres.
        deviation_m: f64,
    },
    /// A search that did not end at a minimum, or at no projector.
    #[error("no emitter behind the screen agrees with the correspondences: {0}")]
    NotFound(String),
}

/// Least number of correspondences: two numbers each, for the unknown ones.
const LEAST: usize = 4;

/// Unknown numbers of a projector.
const UNKNOWNS: usize = 7;

/// Least eigenvalue of the normal equations whose unknowns are scaled alike, over the largest: the square of how alike the effects of two
/// unknowns may be.
const LEAST_EIGENVALUE: f64 = 1e-12;

/// Largest standard deviation of the emitter's distance from the screen, over that distance: three deviations are the whole way.
const LARGEST_DEVIATION: f64 = 1.0 / 3.0;

/// Misses up to so many times their median count in full.
const TRUSTED_MEDIANS: f64 = 2.0;

/// Misses up to here always count in full, metres.
const EXACT_M: f64 = 1e-9;

/// Change of the sum of squares, as a part of it, at which a search ends.
const CONVERGED: f64 = 1e-12;

/// Most searches, each with the weights that the one before gave, and the change of weights at which they end.
const MOST_SEARCHES: usize = 50;
const SAME_WEIGHT: f64 = 1e-6;

/// Unknown numbers: the emitter's place, then the left, right, bottom and top edges of the image.
type Unknowns = OVector<f64, U7>;

struct Problem<'a> {
    correspondences: &'a [Correspondence],
    /// By how much the miss of each correspondence counts.
    weights: Vec<f64>,
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

    fn misses_m(&self) -> Vec<f64> {
        self.correspondences.iter().map(|c| self.miss_m(c).length()).collect()
    }

    /// Weights for the misses as they are (Huber 1964): from a few times their median on a miss pulls no more the larger it is.
    fn weights_of_misses(&self) -> Vec<f64> {
        let misses_m = self.misses_m();
        let mut sorted_m = misses_m.clone();
        sorted_m.sort_unstable_by(f64::total_cmp);
        let trusted_m = (TRUSTED_MEDIANS * sorted_m[sorted_m.len() / 2]).max(EXACT_M);
        misses_m.into_iter().map(|miss_m| (trusted_m / miss_m).min(1.0)).collect()
    }

    /// The best unknowns for the weights.
    fn searched(self) -> Result<Self, FitError> {
        let (found, report) = LevenbergMarquardt::new().with_ftol(CONVERGED).minimize(self);
        if report.termination.was_successful() {
            Ok(found)
        } else {
            Err(FitError::NotFound(in_words(&report.termination).to_owned()))
        }
    }

    /// Standard deviations of the unknowns, metres, from the misses and from how much each unknown changes them.
    fn deviations_m(&self) -> Result<Unknowns, FitError> {
        let jacobian = self.jacobian().ok_or(FitError::Undetermined)?;
        let normal: SMatrix<f64, 7, 7> = jacobian.tr_mul(&jacobian);
        let scale = normal.diagonal().map(|square: f64| square.sqrt().recip());
        let scaled = SMatrix::<f64, 7, 7>::from_fn(|i, j| normal[(i, j)] * scale[i] * scale[j]);
        if !scaled.iter().all(|entry| entry.is_finite()) {
            return Err(FitError::Undetermined);
        }
        let eigenvalues = SymmetricEigen::new(scaled).eigenvalues;
        if eigenvalues.min() < LEAST_EIGENVALUE * eigenvalues.max() {
            return Err(FitError::Undetermined);
        }
        let inverse = scaled.try_inverse().ok_or(FitError::Undetermined)?;
        let residuals = self.residuals().ok_or(FitError::Undetermined)?;
        let variance = residuals.norm_squared() / (residuals.len() - UNKNOWNS) as f64;
        Ok(Unknowns::from_fn(|i, _| (variance * inverse[(i, i)]).sqrt() * scale[i]))
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
        let weighted = |(c, weight): (&Correspondence, &f64)| (self.miss_m(c) * weight.sqrt()).to_array();
        let misses = self.correspondences.iter().zip(&self.weights).flat_map(weighted);
        let residuals = OVector::<f64, Dyn>::from_iterator(2 * self.correspondences.len(), misses);
        residuals.iter().all(|miss| miss.is_finite()).then_some(residuals)
    }

    fn jacobian(&self) -> Option<OMatrix<f64, Dyn, U7>> {
        let mut jacobian = OMatrix::<f64, Dyn, U7>::zeros(2 * self.correspondences.len());
        for (i, (c, weight)) in self.correspondences.iter().zip(&self.weights).enumerate() {
            let (share, screen_m, way) = self.beam(c);
            let emitter = DVec2::new(self.unknowns[0], self.unknowns[1]);
            // The way, 1 − z/E_z, changes with E_z by z/E_z².
            let along = (screen_m - emitter) * (c.place_m.z / (self.unknowns[2] * self.unknowns[2]));
            let (x, y) = (2 * i, 2 * i + 1);
            (jacobian[(x, 0)], jacobian[(y, 1)]) = (1.0 - way, 1.0 - way);
            (jacobian[(x, 2)], jacobian[(y, 2)]) = (along.x, along.y);
            (jacobian[(x, 3)], jacobian[(x, 4)]) = (way * (1.0 - share.x), way * share.x);
            (jacobian[(y, 5)], jacobian[(y, 6)]) = (way * share.y, way * (1.0 - share.y));
            let root = weight.sqrt();
            jacobian.rows_mut(x, 2).iter_mut().for_each(|slope| *slope *= root);
        }
        jacobian.iter().all(|slope| slope.is_finite()).then_some(jacobian)
    }
}

impl Fit {
    /// Fits a projector to correspondences from a first guess such as its place by design: least squares (Levenberg and Marquardt), in
    /// which what is far off all others hardly counts (iterated with the weights of Huber 1964).
    ///
    /// # Errors
    /// Too few correspondences, pixels and places out of their bounds, places that do not determine the projector (pixels of different columns and
    /// of different rows at each of two depths do) or are too inexact to, a search that does not end behind the screen.
    pub fn of(
        guess: &Projector,
        image_size_px: [u32; 2],
        measured: &[Correspondence],
    ) -> Result<Self, FitError> {
        check_all(measured)?;
        let ImageRect { left_m, right_m, down_m, up_m } = guess.image;
        let [x_m, y_m, z_m] = guess.emitter_m;
        let mut fitted = Problem {
            correspondences: measured,
            weights: vec![1.0; measured.len()],
            image_size_px: image_size_px.map(f64::from).into(),
            unknowns: Unknowns::from_column_slice(&[x_m, y_m, z_m, left_m, right_m, down_m, up_m]),
        }
        .searched()?;
        for _ in 1..MOST_SEARCHES {
            let weights = fitted.weights_of_misses();
            let change = weights.iter().zip(&fitted.weights).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            if change < SAME_WEIGHT {
                break;
            }
            fitted = Problem { weights, ..fitted }.searched()?;
        }
        let deviations_m = fitted.deviations_m()?;
        let [x_m, y_m, z_m, left_m, right_m, down_m, up_m] = fitted.unknowns.into();
        if z_m >= 0.0 || !fitted.unknowns.iter().all(|number: &f64| number.is_finite()) {
            return Err(FitError::NotFound(format!("the best is at z = {} m", written(z_m))));
        }
        let deviation_m = deviations_m[2];
        if deviation_m > LARGEST_DEVIATION * -z_m {
            return Err(FitError::Uncertain { z_m, deviation_m });
        }
        let image = ImageRect { left_m, right_m, down_m, up_m };
        let misses_m = fitted.misses_m();
        let worst = (0..misses_m.len()).max_by(|&a, &b| misses_m[a].total_cmp(&misses_m[b])).unwrap_or(0);
        Ok(Self {
            projector: Projector { id: guess.id, emitter_m: [x_m, y_m, z_m], image },
            rms_m: (misses_m.iter().map(|miss_m| miss_m * miss_m).sum::<f64>() / measured.len() as f64)
                .sqrt(),
            worst_m: misses_m[worst],
            worst,
            emitter_deviation_m: [deviations_m[0], deviations_m[1], deviation_m],
            image_deviation_m: deviations_m.rows(3, 4).max(),
        })
    }
}

/// Furthest that a pixel may be from the image's top left corner.
const FURTHEST_PX: f64 = LONGEST_SIDE_PX as f64;

fn check_all(measured: &[Correspondence]) -> Result<(), FitError> {
    if measured.len() < LEAST {
        return Err(FitError::TooFew { found: measured.len() });
    }
    for (index, correspondence) in measured.iter().enumerate() {
        let field = |name: &str, axis: usize| format!("correspondences[{index}].{name}[{axis}]");
        for (axis, place) in correspondence.pixel.to_array().into_iter().enumerate() {
            check(place.abs() <= FURTHEST_PX, field("pixel", axis), place, "from -32768 to 32768")?;
        }
        for (axis, place_m) in correspondence.place_m.to_array().into_iter().enumerate() {
            check_place_m(field("place_m", axis), place_m)?;
        }
    }
    Ok(())
}

/// Why a search found no minimum.
fn in_words(ended: &TerminationReason) -> &'static str {
    match ended {
        TerminationReason::LostPatience => "the search did not end",
        TerminationReason::User(_) | TerminationReason::Numerical(_) => {
            "the search came to numbers that are not finite"
        }
        _ => "the search came to no minimum",
    }
}

/// Metres, rounded to a millimetre.
fn to_millimetres(metres: f64) -> String {
    written((metres * 1e3).round() / 1e3)
}
