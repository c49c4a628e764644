//! Picture files.

use crate::failure::Failure;
use crate::spec;
use clap::ValueEnum;
use image::codecs::gif::{GifEncoder, Repeat};
use image::codecs::png::PngEncoder;
use image::{
    Delay, DynamicImage, ExtendedColorType, Frame, ImageDecoder as _, ImageEncoder as _, ImageError,
    RgbImage as Rgb8,
};
use std::io;
use std::path::Path;
use wheatstone_core::image::RgbImage;
use wheatstone_core::metrics::{SsimMap, dssim};
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

/// How long each eye is seen in a wobbling picture, ms.
const WOBBLE_MS: u32 = 150;

/// What a file shows.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Picture {
    /// One picture: a PNG file.
    Still(RgbImage),
    /// The left eye's and the right eye's in turns, of one size: an animated GIF file.
    Wobble([RgbImage; 2]),
}

/// Of 1 (the best choice of 256 colours) to 30 (the fastest).
const GIF_SPEED: i32 = 10;

impl Picture {
    /// Width and height, pixels.
    pub(crate) fn size(&self) -> [u32; 2] {
        let (Self::Still(picture) | Self::Wobble([picture, _])) = self;
        [picture.width, picture.height]
    }

    /// Writes the file by way of a temporary one; `bits` are those of a PNG file.
    pub(crate) fn write(&self, path: &Path, bits: Bits) -> Result<(), Failure> {
        match self {
            Self::Still(picture) => write_png(path, picture, bits),
            Self::Wobble(eyes) => write_gif(path, eyes),
        }
    }
}

/// Writes pictures in endless turns by way of a temporary file.
fn write_gif(path: &Path, pictures: &[RgbImage]) -> Result<(), Failure> {
    let frame = |picture: &RgbImage| {
        let rgb = Rgb8::from_raw(picture.width, picture.height, picture.to_rgb8());
        let rgb = rgb.ok_or_else(|| io::Error::other("a picture without its pixels"))?;
        let delay = Delay::from_numer_denom_ms(WOBBLE_MS, 1);
        Ok::<_, io::Error>(Frame::from_parts(DynamicImage::from(rgb).into_rgba8(), 0, 0, delay))
    };
    write_atomically(path, |writer| {
        let mut encoder = GifEncoder::new_with_speed(writer, GIF_SPEED);
        encoder.set_repeat(Repeat::Infinite).map_err(io_error)?;
        for picture in pictures {
            encoder.encode_frame(frame(picture)?).map_err(io_error)?;
        }
        Ok(())
    })?;
    Ok(())
}

fn io_error(error: ImageError) -> io::Error {
    match error {
        ImageError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

/// Writes a picture by way of a temporary file.
pub(crate) fn write_png(path: &Path, picture: &RgbImage, bits: Bits) -> Result<(), Failure> {
    write_png_with_exif(path, picture, bits, Vec::new())
}

/// The same with Exif metadata: a TIFF structure, or nothing.
pub(crate) fn write_png_with_exif(
    path: &Path,
    picture: &RgbImage,
    bits: Bits,
    exif: Vec<u8>,
) -> Result<(), Failure> {
    let (bytes, color_type) = match bits {
        Bits::Eight => (picture.to_rgb8(), ExtendedColorType::Rgb8),
        Bits::Sixteen => {
            (picture.to_rgb16().into_iter().flat_map(u16::to_ne_bytes).collect(), ExtendedColorType::Rgb16)
        }
    };
    write_atomically(path, |writer| {
        let mut encoder = PngEncoder::new(writer);
        encoder.set_exif_metadata(exif).map_err(io::Error::other)?;
        encoder.write_image(&bytes, picture.width, picture.height, color_type).map_err(io_error)
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

/// The DSSIM of the window around each pixel of a picture: black is 0, white `white` or more.
pub(crate) fn dssim_picture(ssim: &SsimMap, picture: &RgbImage, white: f64) -> RgbImage {
    let grey = |ssim: f64| [(dssim(ssim) / white).clamp(0.0, 1.0) as f32; 3];
    RgbImage { rgb: ssim.around_pixels().into_iter().map(grey).collect(), ..*picture }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wobble_is_both_pictures_in_turns() {
        use image::AnimationDecoder as _;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("w.gif");
        let eye = |level| RgbImage { width: 3, height: 2, rgb: vec![[level; 3]; 6] };
        let wobble = Picture::Wobble([eye(0.2), eye(0.8)]);
        wobble.write(&path, Bits::Eight).unwrap();
        assert_eq!(wobble.size(), [3, 2]);
        let file = io::BufReader::new(std::fs::File::open(path).unwrap());
        let decoder = image::codecs::gif::GifDecoder::new(file).unwrap();
        let frames = decoder.into_frames().collect_frames().unwrap();
        let levels: Vec<u8> = frames.iter().map(|frame| frame.buffer().get_pixel(2, 1).0[0]).collect();
        assert_eq!(levels, [51, 204]);
        assert!(frames.iter().all(|frame| frame.delay().numer_denom_ms() == (WOBBLE_MS, 1)));
    }

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
