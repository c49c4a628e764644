//! How far GPU and reference may be apart, and why.

use wheatstone_render::TexelFormat;

/// DSSIM of pictures sampled from 8-bit texels, which software Vulkan filters in 8-bit arithmetic: values are off by up to
/// 0.004, which moves surfaces and colours a little everywhere.
const DSSIM_8_BIT: f64 = 0.002;

/// DSSIM of pictures sampled from wider texels: rounding alone, which moves samples of a few rays across an edge of the
/// transfer function.
const DSSIM_WIDE: f64 = 0.0005;

/// Most DSSIM that a texel format may cost: what the project promises.
pub(crate) fn dssim(format: TexelFormat) -> f64 {
    if format == TexelFormat::R8Unorm { DSSIM_8_BIT } else { DSSIM_WIDE }
}

/// Relative difference of the samples taken. Rounding can put a ray's length on the other side of a whole number and stop
/// an early-terminated ray one sample sooner or later; 8-bit filtering moves every surface a little.
pub(crate) fn samples(format: TexelFormat) -> f64 {
    if format == TexelFormat::R8Unorm { 0.003 } else { 0.001 }
}

/// Samples by which even a tiny picture may differ: one for each of a few rays.
pub(crate) const SAMPLES_OF_TINY_PICTURE: u64 = 3;

/// Share of the pixels whose first hit may be a different one: rays that graze a surface or just reach the visible
/// opacity, and equal extremes.
pub(crate) fn share_of_other_hits(format: TexelFormat) -> f64 {
    if format == TexelFormat::R8Unorm { 0.03 } else { 0.01 }
}

/// Difference of two depths that are the same hit, steps: the sample before or after.
pub(crate) const DEPTH_STEPS: f64 = 1.05;

/// Difference of channels of one cast in one go and in pieces: the state between pieces is kept in full.
pub(crate) const PIECES: f64 = 1e-6;

/// Difference of channels of composites over tens of thousands of samples per ray: the transmittance of a step is off by
/// up to 2⁻²⁴, which over 150,000 steps adds up to 0.009 at worst.
pub(crate) const MANY_SAMPLES: f64 = 0.009;

/// Difference of channels of projections, whose sums and extremes do not lose what small steps do.
pub(crate) const PROJECTIONS: f64 = 0.001;
