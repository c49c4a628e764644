//! The reference ray caster.
