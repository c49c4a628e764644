//! How often the display refreshes, where it can be chosen.

use crate::error::{Called, XrError};
use crate::session::Session;

impl Session {
    /// The refresh rates to choose from, per second, lowest first; none where they cannot be chosen.
    ///
    /// # Errors
    /// A lost runtime.
    pub fn refresh_rates_hz(&self) -> Result<Vec<f32>, XrError> {
        if !self.has_refresh_rates() {
            return Ok(Vec::new());
        }
        self.handle.enumerate_display_refresh_rates().called("xrEnumerateDisplayRefreshRatesFB")
    }

    /// How often the display refreshes, per second; none where that is told by [`Tick::period_s`](wheatstone_core::headset::Tick) alone.
    ///
    /// # Errors
    /// A lost runtime.
    pub fn refresh_rate_hz(&self) -> Result<Option<f32>, XrError> {
        if !self.has_refresh_rates() {
            return Ok(None);
        }
        let hz = self.handle.get_display_refresh_rate().called("xrGetDisplayRefreshRateFB")?;
        // 0 stands for not known.
        Ok((hz > 0.0).then_some(hz))
    }

    /// Asks for one of [`Session::refresh_rates_hz`]. [`SessionEvent::RefreshRateChanged`](crate::SessionEvent::RefreshRateChanged) tells
    /// when it is in force.
    ///
    /// # Errors
    /// [`XrError::Refused`] for a rate that is not offered, a lost runtime.
    pub fn request_refresh_rate(&self, hz: f32) -> Result<(), XrError> {
        let call = "xrRequestDisplayRefreshRateFB";
        if !self.has_refresh_rates() {
            let reason = "the runtime does not let it be chosen".to_owned();
            return Err(XrError::Refused { call, reason });
        }
        self.handle.request_display_refresh_rate(hz).called(call)
    }
}
