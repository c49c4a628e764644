//! How far reference rays go.

/// Where a composited reference ray ends. Pixels of either eye end at
/// [`termination_alpha`](crate::cast::CastParameters::termination_alpha) wherever the ray does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum RayEnd {
    /// Where it leaves the volume.
    Volume,
    /// Where its own pixel ends (SP): what the derived eye sees behind, at disocclusions, stays black.
    Reference,
    /// Where its own pixel and all derived ones that it would still meet have ended (DESIGN §5.3): the pictures of
    /// [`RayEnd::Volume`].
    #[default]
    Joint,
}
