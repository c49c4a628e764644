//! Flag values: each parser names what is allowed, and nothing else passes.

use glam::DVec3;
use std::num::NonZeroU32;
use std::ops::RangeInclusive;
use wheatstone_core::cast::DIRECTIONAL_STEPS;
use wheatstone_core::lightfield;
use wheatstone_core::lit_sphere::Style;
use wheatstone_core::scene::{BoundaryEnhancement, ClipPlane, MAX_DIRECTIONS, Shading};
use wheatstone_core::skip::BlockSize;
use wheatstone_core::volume::VoxelType;

/// Largest side of a picture, pixels.
pub(crate) const MOST_PICTURE_SIDE: u32 = 16_384;
/// Most pixels of a picture.
pub(crate) const MOST_PIXELS: u64 = 1 << 26;

/// Widest field of view, radians.
const MOST_FOV_RAD: f64 = 3.1;

/// A parser of finite numbers in a closed range.
pub(crate) fn within(
    range: RangeInclusive<f64>,
) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    move |text| {
        finite(text)
            .filter(|x| range.contains(x))
            .ok_or_else(|| format!("must be a number from {} to {}", range.start(), range.end()))
    }
}

/// A field of view in radians, inside (0, π).
pub(crate) fn fov(text: &str) -> Result<f64, String> {
    finite(text)
        .filter(|&x| (0.001..=MOST_FOV_RAD).contains(&x))
        .ok_or_else(|| format!("must be a number of radians from 0.001 to {MOST_FOV_RAD} (below pi)"))
}

/// Metres from 0.01 up, or `inf`.
pub(crate) fn convergence(text: &str) -> Result<f64, String> {
    if text == "inf" {
        return Ok(f64::INFINITY);
    }
    finite(text)
        .filter(|x| (0.01..=1e6).contains(x))
        .ok_or_else(|| "must be inf or a number of metres from 0.01 to 1000000".to_owned())
}

/// `WIDTHxHEIGHT` in pixels.
pub(crate) fn picture_size(text: &str) -> Result<[u32; 2], String> {
    size_within(text, MOST_PICTURE_SIDE, MOST_PIXELS)
}

/// `WIDTHxHEIGHT` in pixels of what a light-field display is sent or shows, as its description may have them.
pub(crate) fn display_picture_size(text: &str) -> Result<[u32; 2], String> {
    size_within(text, lightfield::LONGEST_SIDE_PX, lightfield::MOST_PIXELS)
}

fn size_within(text: &str, most_side: u32, most_pixels: u64) -> Result<[u32; 2], String> {
    separated(text, &['x', 'X'])
        .filter(|sides: &[u32; 2]| {
            sides.iter().all(|side| (1..=most_side).contains(side))
                && u64::from(sides[0]) * u64::from(sides[1]) <= most_pixels
        })
        .ok_or_else(|| {
            format!("must be WIDTHxHEIGHT, each from 1 to {most_side}, with at most {most_pixels} pixels")
        })
}

/// Sides of a window, points.
const WINDOW_SIDES: RangeInclusive<u32> = 64..=4096;

/// `WIDTHxHEIGHT` of a window in points.
pub(crate) fn window_size(text: &str) -> Result<[u32; 2], String> {
    separated(text, &['x', 'X'])
        .filter(|sides: &[u32; 2]| sides.iter().all(|side| WINDOW_SIDES.contains(side)))
        .ok_or_else(|| {
            format!("must be WIDTHxHEIGHT, each from {} to {}", WINDOW_SIDES.start(), WINDOW_SIDES.end())
        })
}

/// The nearest side that a window may have.
pub(crate) fn clamped_side(side: u32) -> u32 {
    side.clamp(*WINDOW_SIDES.start(), *WINDOW_SIDES.end())
}

/// `XxYxZ` in voxels; the reader checks the product.
pub(crate) fn voxel_dims(text: &str) -> Result<[u64; 3], String> {
    separated(text, &['x', 'X'])
        .filter(|dims: &[u64; 3]| dims.iter().all(|&side| side > 0))
        .ok_or_else(|| "must be WIDTHxHEIGHTxDEPTH in voxels, each at least 1".to_owned())
}

/// `N` or `XxYxZ`, each 1 to 2048.
pub(crate) fn phantom_dims(text: &str) -> Result<[usize; 3], String> {
    text.parse()
        .map(|side: usize| [side; 3])
        .ok()
        .or_else(|| separated(text, &['x', 'X']))
        .filter(|dims| dims.iter().all(|side| (1..=2048).contains(side)))
        .ok_or_else(|| "must be N or WIDTHxHEIGHTxDEPTH, each from 1 to 2048".to_owned())
}

/// Voxels along each side of a block.
pub(crate) fn block_size(text: &str) -> Result<BlockSize, String> {
    text.parse().ok().and_then(|side| BlockSize::cube(side).ok()).ok_or_else(|| {
        format!("must be a number of voxels from {} to {}", BlockSize::SMALLEST, BlockSize::LARGEST)
    })
}

/// `SX,SY,SZ` in millimetres.
pub(crate) fn spacing(text: &str) -> Result<[f64; 3], String> {
    numbers(text)
        .filter(|spacing: &[f64; 3]| spacing.iter().all(|s| (1e-6..=1e6).contains(s)))
        .ok_or_else(|| "must be SX,SY,SZ in millimetres, each from 0.000001 to 1000000".to_owned())
}

/// The name of a voxel type.
pub(crate) fn voxel_type(text: &str) -> Result<VoxelType, String> {
    VoxelType::ALL.iter().copied().find(|t| t.name().eq_ignore_ascii_case(text)).ok_or_else(|| {
        format!("must be one of {}", VoxelType::ALL.iter().map(|t| t.name()).collect::<Vec<_>>().join(", "))
    })
}

/// `RRGGBB` in hexadecimal digits, with or without `#`.
pub(crate) fn color(text: &str) -> Result<[f32; 3], String> {
    let digits = text.strip_prefix('#').unwrap_or(text);
    let valid = digits.len() == 6 && digits.bytes().all(|b| b.is_ascii_hexdigit());
    let rgb = valid.then(|| u32::from_str_radix(digits, 16).ok()).flatten();
    let rgb = rgb.ok_or_else(|| "must be RRGGBB in hexadecimal digits, such as 202028".to_owned())?;
    Ok([16, 8, 0].map(|shift| ((rgb >> shift) & 255) as f32 / 255.0))
}

/// `none`, `phong`, `shadow`, `ambient`, `directional:D` or `style:LOW:HIGH`.
pub(crate) fn shading(text: &str) -> Result<Shading, String> {
    match text {
        "none" => Ok(Shading::None),
        "phong" => Ok(Shading::Phong),
        "shadow" => Ok(Shading::Shadow),
        "ambient" => Ok(Shading::Ambient),
        _ if text.starts_with("style:") => styles(text),
        _ => text
            .strip_prefix("directional:")
            .and_then(|count| count.parse().ok())
            .filter(|&directions| directions <= MAX_DIRECTIONS)
            .map(|directions| Shading::Directional { directions })
            .ok_or_else(|| {
                format!(
                    "must be none, phong, shadow, ambient, directional:D with D from 0 to {MAX_DIRECTIONS} or style:LOW:HIGH"
                )
            }),
    }
}

/// `style:LOW:HIGH`, the styles of low and of high values, or `style:BOTH`.
fn styles(text: &str) -> Result<Shading, String> {
    let names = text.strip_prefix("style:").unwrap_or(text);
    let (low, high) = names.split_once(':').unwrap_or((names, names));
    match (Style::named(low), Style::named(high)) {
        (Some(low), Some(high)) => Ok(Shading::LitSphere { low, high }),
        _ => {
            let all: Vec<&str> = Style::ALL.iter().map(|style| style.name()).collect();
            Err(format!("must be style:LOW:HIGH of {}", all.join(", ")))
        }
    }
}

/// Largest factor and gain of boundaries, and their largest exponent.
const MOST_BOUNDARIES: [f64; 3] = [1000.0, 1e6, 16.0];

/// `INSIDE,GAIN,EXPONENT`.
pub(crate) fn boundaries(text: &str) -> Result<BoundaryEnhancement, String> {
    let [most_inside, most_gain, most_exponent] = MOST_BOUNDARIES;
    numbers(text)
        .filter(|&[inside, gain, exponent]: &[f64; 3]| {
            (0.0..=most_inside).contains(&inside)
                && (0.0..=most_gain).contains(&gain)
                && (1.0..=most_exponent).contains(&exponent)
                && exponent.fract() == 0.0
        })
        .map(|[inside, gain, exponent]| BoundaryEnhancement {
            inside: inside as f32,
            gain: gain as f32,
            exponent: exponent as u32,
        })
        .ok_or_else(|| {
            format!(
                "must be INSIDE,GAIN,EXPONENT: from 0 to {most_inside}, from 0 to {most_gain}, a whole number from 1 to {most_exponent}"
            )
        })
}

/// Directional shading by its samples, four for each direction; 0 is none.
pub(crate) fn shading_of_samples(text: &str) -> Result<Shading, String> {
    match text.parse() {
        Ok(0) => Ok(Shading::None),
        Ok(samples) if samples % DIRECTIONAL_STEPS == 0 && samples / DIRECTIONAL_STEPS <= MAX_DIRECTIONS => {
            Ok(Shading::Directional { directions: samples / DIRECTIONAL_STEPS })
        }
        _ => Err(format!(
            "must be a multiple of {DIRECTIONAL_STEPS} from 0 to {}",
            DIRECTIONAL_STEPS * MAX_DIRECTIONS
        )),
    }
}

/// What a picture shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Show {
    /// The volume.
    Picture,
    /// How much each ray has read: white is so many samples and map reads, or the most of any ray.
    Samples(Option<NonZeroU32>),
}

/// `picture`, `samples` or `samples:N`.
pub(crate) fn show(text: &str) -> Result<Show, String> {
    match text.split_once(':') {
        None if text == "picture" => Some(Show::Picture),
        None if text == "samples" => Some(Show::Samples(None)),
        Some(("samples", white)) => white.parse().ok().map(|white| Show::Samples(Some(white))),
        _ => None,
    }
    .ok_or_else(|| "must be picture, samples or samples:N with a whole number N above 0".to_owned())
}

/// The text that [`shading`] parses.
pub(crate) fn shading_name(shading: Shading) -> String {
    match shading {
        Shading::None => "none".to_owned(),
        Shading::Phong => "phong".to_owned(),
        Shading::Shadow => "shadow".to_owned(),
        Shading::Ambient => "ambient".to_owned(),
        Shading::Directional { directions } => format!("directional:{directions}"),
        Shading::LitSphere { low, high } => format!("style:{}:{}", low.name(), high.name()),
    }
}

/// How values are normalised, as the user asks for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum WindowSpec {
    /// The range of the values.
    Full,
    /// The robust window.
    Auto,
    /// Given bounds.
    Bounds(f64, f64),
}

/// `full`, `auto` or `LO..HI`.
pub(crate) fn window(text: &str) -> Result<WindowSpec, String> {
    match text {
        "full" => Ok(WindowSpec::Full),
        "auto" => Ok(WindowSpec::Auto),
        _ => interval(text)
            .filter(|[lo, hi]| lo < hi && (hi - lo).is_finite())
            .map(|[lo, hi]| WindowSpec::Bounds(lo, hi))
            .ok_or_else(|| "must be full, auto or LO..HI with LO below HI".to_owned()),
    }
}

/// `x0..x1,y0..y1,z0..z1`, each within [0, 1].
pub(crate) fn clip_box(text: &str) -> Result<[DVec3; 2], String> {
    let error = || "must be x0..x1,y0..y1,z0..z1 with 0 <= x0 < x1 <= 1 and so on".to_owned();
    let axes: Option<Vec<[f64; 2]>> = text.split(',').map(interval).collect();
    let axes: [[f64; 2]; 3] = axes.and_then(|axes| axes.try_into().ok()).ok_or_else(error)?;
    if axes.iter().all(|[lo, hi]| 0.0 <= *lo && lo < hi && *hi <= 1.0) {
        Ok([0, 1].map(|end| DVec3::from_array(axes.map(|axis| axis[end]))))
    } else {
        Err(error())
    }
}

/// `nx,ny,nz,d`: world points with `n · p ≥ d` stay.
pub(crate) fn clip_plane(text: &str) -> Result<ClipPlane, String> {
    numbers(text)
        .filter(|[x, y, z, d]| {
            let length = DVec3::new(*x, *y, *z).length();
            (1e-6..=1e6).contains(&length) && d.abs() <= 1e6
        })
        .map(|[x, y, z, d]| ClipPlane { normal: DVec3::new(x, y, z), offset_m: d })
        .ok_or_else(|| "must be nx,ny,nz,d with a normal that is not zero and d in metres".to_owned())
}

/// Furthest place from a display along each axis, metres.
const FURTHEST_M: f64 = 1000.0;

/// `X,Y,Z` in front of a display: metres from the middle of its screen, to the right, up and towards the viewers.
pub(crate) fn eye(text: &str) -> Result<DVec3, String> {
    numbers(text)
        .filter(|[x, y, z]: &[f64; 3]| {
            x.abs() <= FURTHEST_M && y.abs() <= FURTHEST_M && (0.001..=FURTHEST_M).contains(z)
        })
        .map(DVec3::from_array)
        .ok_or_else(|| {
            "must be X,Y,Z in metres, X and Y from -1000 to 1000 and Z from 0.001 to 1000".to_owned()
        })
}

/// `A..B`, both finite.
pub(crate) fn interval(text: &str) -> Option<[f64; 2]> {
    let (lo, hi) = text.split_once("..")?;
    Some([finite(lo)?, finite(hi)?])
}

fn finite(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|x: &f64| x.is_finite())
}

fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let values: Option<Vec<f64>> = text.split(',').map(finite).collect();
    values?.try_into().ok()
}

fn separated<T: std::str::FromStr, const N: usize>(text: &str, separators: &[char]) -> Option<[T; N]> {
    let values: Option<Vec<T>> = text.split(separators).map(|part| part.parse().ok()).collect();
    values?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(picture_size("640x480"), Ok([640, 480]));
        for bad in ["0x5", "100000x100000", "16384x16384", "640", "640x480x3", "-1x5", "axb", ""] {
            assert!(picture_size(bad).is_err(), "{bad}");
        }
        assert_eq!(display_picture_size("32768x4096"), Ok([32_768, 4096]));
        for bad in ["32769x1", "32768x4097", "0x5", ""] {
            let error = display_picture_size(bad).unwrap_err();
            assert!(error.contains("32768") && error.contains("134217728"), "{bad}: {error}");
        }
        assert_eq!(window_size("1280x800"), Ok([1280, 800]));
        assert!(window_size("1280x4097").is_err() && window_size("0x0").is_err());
        assert_eq!(phantom_dims("64"), Ok([64; 3]));
        assert_eq!(phantom_dims("4x5x6"), Ok([4, 5, 6]));
        assert!(phantom_dims("4x5").is_err() && phantom_dims("0").is_err());
        assert_eq!(block_size("3").unwrap().sides(), [3; 3]);
        for bad in ["1", "17", "-4", "4x4", ""] {
            assert!(block_size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn numbers_are_finite_and_in_range() {
        let parse = within(0.0..=1.0);
        assert_eq!(parse("0.5"), Ok(0.5));
        for bad in ["nan", "inf", "-0.1", "1.1", "x"] {
            assert!(parse(bad).is_err(), "{bad}");
        }
        assert!(fov("3.1416").is_err() && fov("0").is_err() && fov("1").is_ok());
        assert_eq!(convergence("inf"), Ok(f64::INFINITY));
        assert!(convergence("0").is_err());
    }

    #[test]
    fn windows_boxes_and_planes() {
        assert_eq!(window("-100..300.5"), Ok(WindowSpec::Bounds(-100.0, 300.5)));
        assert!(window("3..3").is_err() && window("4..3").is_err() && window("nan..3").is_err());
        let [lo, hi] = clip_box("0..1,0.25..0.5,0..1").unwrap();
        assert_eq!((lo.y, hi.y), (0.25, 0.5));
        assert!(clip_box("0..1,0.5..0.5,0..1").is_err() && clip_box("0..1,0..1").is_err());
        assert!(clip_box("0..1,0..2,0..1").is_err());
        assert_eq!(clip_plane("0,0,-1,0.1").unwrap().offset_m, 0.1);
        assert!(clip_plane("0,0,0,1").is_err());
        assert_eq!(eye("-0.1,0,0.5"), Ok(DVec3::new(-0.1, 0.0, 0.5)));
        assert!(eye("0,0,0").is_err() && eye("0,0").is_err() && eye("0,0,inf").is_err());
    }

    #[test]
    fn names_and_colors() {
        for text in ["none", "phong", "shadow", "ambient", "directional:64", "style:clay:glass"] {
            assert_eq!(shading_name(shading(text).unwrap()), text);
        }
        assert_eq!(shading_of_samples("0"), Ok(Shading::None));
        assert_eq!(shading_of_samples("16"), Ok(Shading::Directional { directions: 4 }));
        assert!(shading_of_samples("6").is_err() && shading_of_samples("260").is_err());
        assert!(shading("directional:65").is_err() && shading("gouraud").is_err());
        let enhanced = boundaries("0.2,40,2").unwrap();
        assert_eq!((enhanced.inside, enhanced.gain, enhanced.exponent), (0.2, 40.0, 2));
        for bad in ["", "1,1", "-1,1,1", "1,1,0", "1,1,1.5", "1,nan,1", "1,1,17"] {
            assert!(boundaries(bad).is_err(), "{bad}");
        }
        assert!(shading("style:").is_err() && shading("style:clay:wool").is_err());
        assert_eq!(color("#ff0000"), Ok([1.0, 0.0, 0.0]));
        assert!(color("ff00").is_err() && color("+f0000").is_err());
        assert_eq!(voxel_type("uint16"), Ok(VoxelType::U16));
    }
}
