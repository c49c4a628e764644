//! The lines of the written form.

use super::error::LineError;
use crate::head::Pose;
use crate::headset::{Eye, Hand, Pinch, Tick};
use crate::view::Frustum;
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// The version of the form that is read and written.
pub(super) const VERSION: u64 = 1;

/// What numbers count.
pub(super) const UNITS: &str = "s, m, tangents, unit quaternions as x, y, z, w";

/// The first line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Header {
    wheatstone_recording: u64,
    units: String,
    period_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    frusta: Option<[FrustumForm; 2]>,
}

/// A further line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TickLine {
    time_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    period_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    frusta: Option<[FrustumForm; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    eyes: Option<[PoseForm; 2]>,
    hands: [HandForm; 2],
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FrustumForm {
    left: f64,
    right: f64,
    down: f64,
    up: f64,
    near_m: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    far_m: Option<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PoseForm {
    position_m: DVec3,
    orientation: DQuat,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct HandForm {
    #[serde(skip_serializing_if = "Option::is_none")]
    grip: Option<PoseForm>,
    #[serde(skip_serializing_if = "Option::is_none")]
    aim: Option<PoseForm>,
    squeeze: f32,
    trigger: f32,
    stick: [f32; 2],
    menu: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pinch: Option<PinchForm>,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PinchForm {
    position_m: DVec3,
    closed: f32,
}

impl Header {
    pub(super) fn of(tick: &Tick) -> Self {
        Self {
            wheatstone_recording: VERSION,
            units: UNITS.to_owned(),
            period_s: tick.period_s,
            frusta: frusta_of(tick),
        }
    }

    pub(super) fn parse(text: &[u8]) -> Result<Self, LineError> {
        let header: Self = serde_json::from_slice(text)?;
        if header.wheatstone_recording != VERSION {
            return Err(LineError::Version { found: header.wheatstone_recording });
        }
        if header.units != UNITS {
            return Err(LineError::Units { found: header.units });
        }
        Ok(header)
    }
}

impl TickLine {
    pub(super) fn of(tick: &Tick, header: &Header) -> Self {
        let frusta = frusta_of(tick);
        Self {
            time_s: tick.display_time_s,
            period_s: (tick.period_s != header.period_s).then_some(tick.period_s),
            frusta: frusta.filter(|_| frusta != header.frusta),
            eyes: tick.eyes.map(|eyes| eyes.map(|eye| eye.pose.into())),
            hands: tick.hands.map(HandForm::from),
        }
    }

    pub(super) fn parse(text: &[u8]) -> Result<Self, LineError> {
        Ok(serde_json::from_slice(text)?)
    }

    /// The tick as it is written; it may be none.
    pub(super) fn tick(self, header: &Header) -> Result<Tick, LineError> {
        let eyes = match self.eyes {
            None => None,
            Some(poses) => {
                let frusta = self.frusta.or(header.frusta).ok_or(LineError::NoFrusta)?;
                let eye = |side: usize| Eye { pose: poses[side].into(), frustum: frusta[side].into() };
                Some([eye(0), eye(1)])
            }
        };
        Ok(Tick {
            display_time_s: self.time_s,
            period_s: self.period_s.unwrap_or(header.period_s),
            eyes,
            hands: self.hands.map(Hand::from),
        })
    }
}

fn frusta_of(tick: &Tick) -> Option<[FrustumForm; 2]> {
    tick.eyes.map(|eyes| eyes.map(|eye| eye.frustum.into()))
}

impl From<Frustum> for FrustumForm {
    fn from(Frustum { left, right, down, up, near_m, far_m }: Frustum) -> Self {
        Self { left, right, down, up, near_m, far_m: far_m.is_finite().then_some(far_m) }
    }
}

impl From<FrustumForm> for Frustum {
    fn from(FrustumForm { left, right, down, up, near_m, far_m }: FrustumForm) -> Self {
        Self { left, right, down, up, near_m, far_m: far_m.unwrap_or(f64::INFINITY) }
    }
}

impl From<Pose> for PoseForm {
    fn from(Pose { position_m, orientation }: Pose) -> Self {
        Self { position_m, orientation }
    }
}

impl From<PoseForm> for Pose {
    fn from(PoseForm { position_m, orientation }: PoseForm) -> Self {
        Self { position_m, orientation }
    }
}

impl From<Hand> for HandForm {
    fn from(Hand { grip, aim, squeeze, trigger, stick, menu, pinch }: Hand) -> Self {
        let form = |pose: Option<Pose>| pose.map(PoseForm::from);
        let pinch = pinch.map(|Pinch { position_m, closed }| PinchForm { position_m, closed });
        Self { grip: form(grip), aim: form(aim), squeeze, trigger, stick, menu, pinch }
    }
}

impl From<HandForm> for Hand {
    fn from(HandForm { grip, aim, squeeze, trigger, stick, menu, pinch }: HandForm) -> Self {
        let pose = |form: Option<PoseForm>| form.map(Pose::from);
        let pinch = pinch.map(|PinchForm { position_m, closed }| Pinch { position_m, closed });
        Self { grip: pose(grip), aim: pose(aim), squeeze, trigger, stick, menu, pinch }
    }
}
