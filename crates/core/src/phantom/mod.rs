//! Analytic volumes.
