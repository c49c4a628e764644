//! How far a picture may be from the truth, and why not less.

/// Transmittance of a homogeneous slab. The caster's own error is f32 rounding over some hundred samples; the project
/// promises 1e-3.
pub(crate) const TRANSMITTANCE: f64 = 1e-3;

/// Depth of a surface, voxel lengths: trilinear interpolation flattens a sphere of 19 voxels radius by up to 0.02 and
/// 8-bit voxels move it by 0.01; the project promises 0.1.
pub(crate) const SURFACE_DEPTH_VOXELS: f64 = 0.1;

/// A projected value: half an entry of the 4096-entry table, and f32 rounding of a sum of some hundred values.
pub(crate) const PROJECTED_VALUE: f64 = 0.5 / 4095.0 + 5e-5;

/// DSSIM of pictures taken with one and with two samples per voxel: the project's promise that opacity does not depend
/// on the step.
pub(crate) const STEP_DSSIM: f64 = 0.01;

/// Channel difference that early termination may make: what is left behind the threshold of 0.99, and rounding.
pub(crate) const EARLY_TERMINATION: f64 = 0.011;

/// Channel difference that ending saturated rays may make: 2⁻²⁴ of the light, twice for rounding.
pub(crate) const SATURATION: f64 = 1.2e-7;

/// Colour of a lit sample by the Phong formula: rounding of the gradient, raised to the power of 20.
pub(crate) const LIT_COLOR: f64 = 1e-3;

/// DSSIM of pictures of one object whose voxels are stored in another order. Only rounding differs, but it can move a
/// sample across a voxel boundary of the sharp phantom.
pub(crate) const STORAGE_ORDER_DSSIM: f64 = 1e-5;

/// Disparity of a block match, pixels: a parabola through three sums finds the minimum to about a tenth of a pixel.
pub(crate) const DISPARITY_PIXELS: f64 = 0.15;

/// Opacity of a pre-integrated ray through a ramp: the ends of the table's segments are whole entries of a finer one, so
/// segments are off by up to an 8192th of the value range. As little as the project promises for a slab.
pub(crate) const PREINTEGRATED_OPACITY: f64 = 1e-3;

/// Channel difference of f32 lanes and the f64 lane: rounding over some hundred samples.
pub(crate) const LANES_COLOR: f64 = 2e-3;

/// DSSIM of pictures by f32 lanes and the f64 lane.
pub(crate) const LANES_DSSIM: f64 = 1e-4;

/// Share of the pixels by f32 lanes that may be other ones: rays that graze a surface or an edge of the volume, equal
/// extremes.
pub(crate) const LANES_OTHER_PIXELS: f64 = 0.01;

/// Difference of two depths that are the same hit, metres: a tenth of a voxel.
pub(crate) const LANES_DEPTH_M: f64 = 1e-3;

/// DSSIM of pictures by interpolated gradient magnitudes and by magnitudes of gradients estimated at each sample, where
/// magnitudes are smooth but for the middle of each ball.
pub(crate) const GRADIENT_MAP_DSSIM: f64 = 0.01;

/// DSSIM of pictures by magnitudes of 8 and of 16 bits: half a 255th of the largest magnitude.
pub(crate) const GRADIENT_CODES_DSSIM: f64 = 1e-3;

/// DSSIM of a derived picture and its own cast: half a pixel's shift of each sample; the project's promise.
pub(crate) const DERIVED_DSSIM: f64 = 0.002;

/// DSSIM of a small picture derived with the eye in the volume, where samples are dozens of columns wide.
pub(crate) const INSIDE_DSSIM: f64 = 0.03;

/// Error of the derived colour of an opaque face, which hides what is under it but for its first samples.
pub(crate) const DERIVED_COLOR: f32 = 0.02;

/// Mean error of a box's derived opacity: half a pixel's shift at its edges, most of all.
pub(crate) const DERIVED_MEAN_OPACITY: f64 = 0.006;

/// Error of a box's derived opacity where it changes little from column to column: the samples of rays that diverge from
/// the derived ones by a few degrees are a little longer or shorter.
pub(crate) const DERIVED_OPACITY: f64 = 0.01;

/// The same if each sample is in one slab as a whole: about one sample more or less.
pub(crate) const DERIVED_OPACITY_OF_WHOLE_SAMPLES: f64 = 0.04;

/// DSSIM of a sphere with level of detail against means of many rays in each pixel: a voxel of up to √2 pixels at its rim.
pub(crate) const DETAIL_DSSIM: f64 = 0.015;

/// DSSIM of surfaces with sheets thinner than a voxel, cast over ten frames by leaping to the first hits of the last one.
pub(crate) const LEAPING_DSSIM: f64 = 1e-3;

/// Colour of a styled surface, against the map at its exact normal: 8-bit voxels turn normals by up to a hundredth, and bands and
/// outlines change by up to four times as much.
pub(crate) const STYLED_COLOR: f64 = 0.06;

/// Channel difference of styled pictures by f32 lanes and the f64 lane: gradients that are hardly any, whose direction is rounded.
pub(crate) const STYLED_LANES: f64 = 0.01;
