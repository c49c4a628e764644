//! What a tick must be like.

use crate::head::Pose;
use crate::headset::hand::FARTHEST_M;
use crate::headset::{Eye, Hand, Tick};
use crate::view::Frustum;
use thiserror::Error;

/// Why numbers are no tick.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum TickError {
    /// A number out of its bounds.
    #[error("{what} is {value}: must be from {lo} to {hi}")]
    Bounds {
        /// Which number.
        what: &'static str,
        /// As it is.
        value: f64,
        /// Least that is allowed.
        lo: f64,
        /// Most that is allowed.
        hi: f64,
    },
    /// A pose that is none.
    #[error("{0}: must have finite coordinates and a unit orientation")]
    Pose(&'static str),
    /// Tangents or depths that make no frustum.
    #[error("frustum: left must be below right, down below up, and 0 <= near < far")]
    Frustum,
    /// A tick that is not after the one before.
    #[error("tick at {time_s} s after one at {last_s} s: ticks must be in order of time")]
    Order {
        /// Of the tick, seconds.
        time_s: f64,
        /// Of the tick before, seconds.
        last_s: f64,
    },
    /// A tick that is too long after the one before.
    #[error("tick at {time_s} s after one at {last_s} s: ticks must be at most {most_s} s apart")]
    Gap {
        /// Of the tick, seconds.
        time_s: f64,
        /// Of the tick before, seconds.
        last_s: f64,
        /// Longest that is allowed, seconds.
        most_s: f64,
    },
    /// More than a recording holds.
    #[error("a recording has at most {most} ticks")]
    TooMany {
        /// How many it has at most.
        most: usize,
    },
}

/// Latest time, seconds: a century.
const LATEST_S: f64 = 3.2e9;

/// Longest time without a tick, seconds: a day, for which a headset may lie on a table.
const LONGEST_GAP_S: f64 = 86_400.0;

/// Periods of displays, seconds.
const PERIODS_S: [f64; 2] = [1e-4, 10.0];

/// A tick that is as it must be after another, its orientations of unit length.
pub(super) fn checked(tick: Tick, last: Option<&Tick>) -> Result<Tick, TickError> {
    let time_s = within("time_s", tick.display_time_s, [-LATEST_S, LATEST_S])?;
    if let Some(last) = last.filter(|last| last.display_time_s >= time_s) {
        return Err(TickError::Order { time_s, last_s: last.display_time_s });
    }
    if let Some(last) = last.filter(|last| time_s - last.display_time_s > LONGEST_GAP_S) {
        return Err(TickError::Gap { time_s, last_s: last.display_time_s, most_s: LONGEST_GAP_S });
    }
    within("period_s", tick.period_s, PERIODS_S)?;
    let eyes = match tick.eyes {
        Some([left, right]) => Some([checked_eye(left)?, checked_eye(right)?]),
        None => None,
    };
    let [left, right] = tick.hands;
    Ok(Tick { eyes, hands: [checked_hand(left)?, checked_hand(right)?], ..tick })
}

fn checked_eye(eye: Eye) -> Result<Eye, TickError> {
    let Frustum { left, right, down, up, near_m, far_m } = eye.frustum;
    let is_window = [left, right, down, up, near_m].iter().all(|number| number.is_finite());
    if !(is_window && left < right && down < up && 0.0 <= near_m && near_m < far_m) {
        return Err(TickError::Frustum);
    }
    let pose = eye.pose.normalized().ok_or(TickError::Pose("eye"))?;
    within("eye's distance in m", pose.position_m.abs().max_element(), [0.0, FARTHEST_M])?;
    Ok(Eye { pose, ..eye })
}

fn checked_hand(hand: Hand) -> Result<Hand, TickError> {
    let pose = |what, pose: Option<Pose>| {
        pose.map(|pose| pose.normalized().ok_or(TickError::Pose(what))).transpose()
    };
    let [right, up] = hand.stick;
    within("squeeze", hand.squeeze.into(), [0.0, 1.0])?;
    within("trigger", hand.trigger.into(), [0.0, 1.0])?;
    within("stick", right.into(), [-1.0, 1.0])?;
    within("stick", up.into(), [-1.0, 1.0])?;
    if let Some(pinch) = hand.pinch {
        within("pinch", pinch.closed.into(), [0.0, 1.0])?;
        if !pinch.position_m.is_finite() {
            return Err(TickError::Pose("pinch"));
        }
    }
    Ok(Hand { grip: pose("grip", hand.grip)?, aim: pose("aim", hand.aim)?, ..hand })
}

fn within(what: &'static str, value: f64, [lo, hi]: [f64; 2]) -> Result<f64, TickError> {
    if (lo..=hi).contains(&value) { Ok(value) } else { Err(TickError::Bounds { what, value, lo, hi }) }
}
