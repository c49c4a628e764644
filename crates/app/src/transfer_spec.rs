//! `--tf`: a ramp, a name or a file.

use crate::failure::Failure;
use crate::spec;
use anyhow::Context as _;
use std::path::{Path, PathBuf};
use wheatstone_core::transfer::{
    AUTOMATIC_BINS, BenchmarkRamp, Preset, TransferFile, TransferFunction, automatic,
};
use wheatstone_core::volume::{Statistics, Volume, Window};
use wheatstone_io::transfer::read_transfer;

/// A transfer function as the user asks for it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum TransferSpec {
    /// From the histogram.
    Automatic,
    /// The grey ramp of DM Eq. 16.
    Ramp([f32; 2]),
    /// The grey ramp over value and gradient magnitude.
    Ramp2d([f32; 4]),
    /// A preset or colour map.
    Preset(Preset),
    /// The ramp of a benchmark volume.
    Benchmark(&'static BenchmarkRamp),
    /// A file.
    File(PathBuf),
}

/// A transfer function and the window it is for.
#[derive(Debug, Clone)]
pub(crate) struct Resolved {
    /// Colour and opacity of normalised values.
    pub(crate) transfer: TransferFunction,
    /// What normalises the values.
    pub(crate) window: Window,
}

/// Parses `auto`, `ramp:V0..V1`, `ramp:V0..V1,G0..G1`, the name of a preset, a colour map or a benchmark's ramp, or a path.
pub(crate) fn parse(text: &str) -> Result<TransferSpec, String> {
    if text == "auto" {
        return Ok(TransferSpec::Automatic);
    }
    if let Some(bounds) = text.strip_prefix("ramp:") {
        return ramp(bounds).ok_or_else(|| {
            "a ramp must be ramp:V0..V1 or ramp:V0..V1,G0..G1 with 0 <= V0 <= V1 <= 1 and 0 <= G0 <= G1 <= 1"
                .to_owned()
        });
    }
    if let Some(ramp) = BenchmarkRamp::named(text) {
        return Ok(TransferSpec::Benchmark(ramp));
    }
    match text.parse::<Preset>() {
        Ok(preset) => Ok(TransferSpec::Preset(preset)),
        Err(_) if looks_like_a_path(text) => Ok(TransferSpec::File(PathBuf::from(text))),
        Err(error) => {
            let ramps = BenchmarkRamp::ALL.iter().map(BenchmarkRamp::name).collect::<Vec<_>>().join(", ");
            Err(format!("{error}, {ramps}, auto, ramp:V0..V1 and paths of files"))
        }
    }
}

fn looks_like_a_path(text: &str) -> bool {
    let path = Path::new(text);
    path.extension().is_some() || path.components().count() > 1 || path.exists()
}

fn ramp(bounds: &str) -> Option<TransferSpec> {
    let within = |[lo, hi]: [f64; 2]| (0.0 <= lo && lo <= hi && hi <= 1.0).then_some([lo as f32, hi as f32]);
    match bounds.split_once(',') {
        None => Some(TransferSpec::Ramp(within(spec::interval(bounds)?)?)),
        Some((values, gradients)) => {
            let ([v0, v1], [g0, g1]) =
                (within(spec::interval(values)?)?, within(spec::interval(gradients)?)?);
            Some(TransferSpec::Ramp2d([v0, v1, g0, g1]))
        }
    }
}

impl TransferSpec {
    /// The text that [`parse`] takes.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Automatic => "auto".to_owned(),
            Self::Ramp([v0, v1]) => format!("ramp:{v0}..{v1}"),
            Self::Ramp2d([v0, v1, g0, g1]) => format!("ramp:{v0}..{v1},{g0}..{g1}"),
            Self::Preset(preset) => preset.name().to_owned(),
            Self::Benchmark(ramp) => ramp.name().to_owned(),
            Self::File(path) => path.display().to_string(),
        }
    }

    /// The transfer function for a volume. Without a window of the user's, a file's own window counts, then a
    /// preset's, then the robust one for an automatic function; else the range of the values.
    pub(crate) fn resolve(&self, volume: &Volume, chosen: Option<Window>) -> Result<Resolved, Failure> {
        self.resolve_for(volume.grid().dims(), volume.full_window(), || volume.statistics(), chosen)
    }

    /// The same for a volume of which size, range and statistics are known.
    pub(crate) fn resolve_for(
        &self,
        dims: [usize; 3],
        full: Window,
        statistics: impl Fn() -> Statistics,
        chosen: Option<Window>,
    ) -> Result<Resolved, Failure> {
        let ramp = |transfer| Resolved { transfer, window: chosen.unwrap_or(full) };
        Ok(match self {
            Self::Automatic => {
                let statistics = statistics();
                let window = chosen.unwrap_or_else(|| statistics.robust_window());
                automatic_in(dims, &statistics, window)?
            }
            Self::Ramp([v0, v1]) => ramp(TransferFunction::ramp(*v0, *v1).context("--tf")?),
            Self::Ramp2d([v0, v1, g0, g1]) => {
                ramp(TransferFunction::ramp_2d(*v0, *v1, *g0, *g1).context("--tf")?)
            }
            Self::Preset(preset) => {
                let recommended = || preset.recommended_window(&statistics());
                let window = chosen.or_else(recommended).unwrap_or(full);
                Resolved { transfer: preset.transfer(window).context("--tf")?, window }
            }
            Self::Benchmark(benchmark) => Resolved {
                transfer: benchmark.transfer(dims).context("--tf")?,
                window: chosen.or(benchmark.window()).unwrap_or(full),
            },
            Self::File(path) => {
                let file = read_file(path)?;
                Resolved { transfer: file.transfer, window: chosen.or(file.window).unwrap_or(full) }
            }
        })
    }
}

fn automatic_in(dims: [usize; 3], statistics: &Statistics, window: Window) -> Result<Resolved, Failure> {
    let histogram = statistics.histogram(window, AUTOMATIC_BINS);
    let transfer = automatic(&histogram, dims).context("automatic transfer function")?;
    Ok(Resolved { transfer, window })
}

fn read_file(path: &Path) -> Result<TransferFile, Failure> {
    let bad = |error: &dyn std::fmt::Display| Failure::input(format!("{}: {error}", path.display()));
    read_transfer(path).map_err(|error| bad(&error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use wheatstone_core::phantom::Phantom;

    #[test]
    fn ramps_of_phantoms_are_for_all_eight_bits() {
        let volume = Phantom::Present.volume([8; 3]).unwrap();
        let window = |name: &str| parse(name).unwrap().resolve(&volume, None).unwrap().window;
        assert_eq!(window("present-1d"), Window::new(0.0, 255.0).unwrap());
        assert_eq!(window("bonsai"), volume.full_window());
    }

    #[test]
    fn specs_come_back() {
        for text in [
            "auto",
            "ramp:0.1..1",
            "ramp:0.1..1,0..0.25",
            "ct-bone",
            "viridis",
            "snake-2d",
            "a/b.json",
            "tf.vp",
        ] {
            assert_eq!(parse(text).unwrap().name(), text);
        }
    }

    #[test]
    fn bad_specs_are_refused() {
        for bad in ["ramp:1..0", "ramp:0..2", "ramp:0..nan", "ramp:", "ramp:0..1,0", "no-such-preset", ""] {
            assert!(parse(bad).is_err(), "{bad}");
        }
        assert!(parse("ct-bones").unwrap_err().contains("ct-bone"));
    }
}
