//! PNG files.

use crate::failure::Failure;
use crate::spec;
use clap::ValueEnum;
use image::{
    DynamicImage, ExtendedColorType, ImageDecoder as _, ImageEncoder as _, ImageError,
    codecs::png::PngEncoder,
};
use std::io;
use std::path::Path;
use wheatstone_core::image::RgbImage;
use wheatstone_io::write_atomically;

/// Bits per channel of a PNG file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Bits {
    /// 8 bits.
    #[value(name = "8")]
    Eight,
    /// 16 bits.
    #[value(name = "16")]
    Sixteen,
}

/// Writes a picture by way of a temporary file.
pub(crate) fn write_png(path: &Path, picture: &RgbImage, bits: Bits) -> Result<(), Failure> {
    let (bytes, color_type) = match bits {
        Bits::Eight => (picture.to_rgb8(), ExtendedColorType::Rgb8),
        Bits::Sixteen => {
            (picture.to_rgb16().into_iter().flat_map(u16::to_ne_bytes).collect(), ExtendedColorType::Rgb16)
        }
    };
    write_atomically(path, |writer| {
        PngEncoder::new(writer).write_image(&bytes, picture.width, picture.height, color_type).map_err(
            |error| match error {
                ImageError::IoError(error) => error,
                other => io::Error::other(other),
            },
        )
    })?;
    Ok(())
}

/// Most pixels of a picture that is read: both eyes' largest pictures side by side.
const MOST_PIXELS_READ: u64 = 2 * spec::MOST_PIXELS;

/// Reads a PNG file of 8 or 16 bits, grey or colour; transparency is put over black. Files are not trusted: what their
/// header tells of their size is checked before anything is decoded.
pub(crate) fn read_png(path: &Path) -> Result<RgbImage, Failure> {
    let bad = |error: &dyn std::fmt::Display| Failure::input(format!("{}: {error}", path.display()));
    // Opening a pipe may block, so what the path names is looked at first.
    if !std::fs::metadata(path).map_err(|error| bad(&error))?.is_file() {
        return Err(bad(&"not a file"));
    }
    let mut reader = image::ImageReader::open(path).map_err(|error| bad(&error))?;
    reader.set_format(image::ImageFormat::Png);
    let decoder = reader.into_decoder().map_err(|error| bad(&error))?;
    let (width, height) = decoder.dimensions();
    if u64::from(width) * u64::from(height) > MOST_PIXELS_READ {
        return Err(bad(&format!(
            "a picture of {width}×{height} pixels: at most {MOST_PIXELS_READ} pixels are read"
        )));
    }
    let decoded = DynamicImage::from_decoder(decoder).map_err(|error| bad(&error))?;
    Ok(over_black(decoded))
}

fn over_black(decoded: DynamicImage) -> RgbImage {
    let pixels = decoded.into_rgba32f();
    let rgb = pixels.pixels().map(|p| [0, 1, 2].map(|c| p.0[c] * p.0[3])).collect();
    RgbImage { width: pixels.width(), height: pixels.height(), rgb }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let picture = RgbImage { width: 2, height: 1, rgb: vec![[0.0, 0.25, 1.0], [0.5, 0.125, 0.75]] };
        for (bits, tolerance) in [(Bits::Eight, 0.5 / 255.0), (Bits::Sixteen, 0.5 / 65535.0)] {
            let path = folder.path().join("p.png");
            write_png(&path, &picture, bits).unwrap();
            let back = read_png(&path).unwrap();
            for (a, b) in picture.rgb.iter().flatten().zip(back.rgb.iter().flatten()) {
                assert!((a - b).abs() <= tolerance + 1e-6, "{a} {b}");
            }
        }
    }
}
