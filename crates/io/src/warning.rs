//! What a reader had to assume or leave out.

use thiserror::Error;

/// What the axes of a file without an orientation are taken as, where its format's own positions are RAS.
pub(crate) const RAS_AXES: &str = "right, anterior, superior";
/// The same where they are LPS.
pub(crate) const LPS_AXES: &str = "left, posterior, superior";

/// Something about a file that its reader coped with but that the user should know.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Warning {
    /// The file is a series; later frames were left out.
    #[error("the file holds {frames} frames: only the first is shown")]
    FirstFrameOnly {
        /// Frames in the file.
        frames: u64,
    },
    /// Each voxel has several components; the others were left out.
    #[error("each voxel has {components} components: only the first is shown")]
    FirstComponentOnly {
        /// Components per voxel.
        components: u64,
    },
    /// 64-bit integers became f64: whole numbers beyond 2⁵³ are rounded.
    #[error("{from} voxels were converted to float64: whole numbers beyond 2^53 are rounded")]
    ConvertedToFloat64 {
        /// Name of the type in the file.
        from: &'static str,
    },
    /// Voxels that are NaN or infinite.
    #[error("{count} voxels are NaN or infinite: they count as the window's low end")]
    NonFiniteVoxels {
        /// How many.
        count: usize,
    },
    /// The content is of another format than the extension says; it was read as what it is.
    #[error("the file is {format} although its name says otherwise")]
    ExtensionMismatch {
        /// The format of the content.
        format: crate::Format,
    },
    /// The file does not say how the patient lies.
    #[error("the file gives no orientation: its axes are taken as {axes}")]
    OrientationUnknown {
        /// The directions that the axes are taken to point to.
        axes: &'static str,
    },
    /// The named space is not an anatomical one.
    #[error("space `{space}` is not anatomical: its axes are taken as right, anterior, superior")]
    SpaceAssumedRas {
        /// Name of the space in the file.
        space: String,
    },
    /// A spacing that is missing, zero or NaN became 1 mm.
    #[error("the spacing along axis {axis} is missing or zero: 1 mm is assumed")]
    SpacingAssumed {
        /// The axis, from 1.
        axis: usize,
    },
    /// Spacings or sizes so different that steps of the smallest spacing would never come to an end.
    #[error(
        "the volume is {size_mm}: rays take steps of {step_mm:.3e} mm instead of the smallest spacing, {spacing_mm:.3e} mm"
    )]
    StepsLengthened {
        /// Edge lengths of the volume, in words.
        size_mm: String,
        /// The unit of length of steps.
        step_mm: f64,
        /// The smallest spacing.
        spacing_mm: f64,
    },
    /// The header does not tell the byte order of voxels that have more than one byte.
    #[error("the file does not tell its byte order: little-endian is assumed")]
    ByteOrderAssumed,
    /// Slope or intercept is NaN or infinite.
    #[error("slope {slope} and intercept {intercept} cannot be applied: the stored values are shown")]
    ScalingIgnored {
        /// Slope in the file.
        slope: f64,
        /// Intercept in the file.
        intercept: f64,
    },
    /// Bytes follow the last voxel.
    #[error("more data follows the last voxel: the sizes in the header may be wrong")]
    ExtraData,
    /// All voxels arrived, but the end of the compressed stream is missing or its checksum differs.
    #[error("the end of the compressed data is damaged ({detail}): the voxels may be too")]
    Unverified {
        /// The decoder's answer.
        detail: String,
    },
}
