//! Frames: images of many projectors in one picture, with a header that tells whose they are.

use super::super::error::check_size_px;
use super::projector::LAST_ID;
use super::{DisplayError, ProjectorArray};
use crate::image::RgbImage;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// How images are put into the frames that are sent to a display one after the other (LF §6).
///
/// The header is the top rows of a frame; below it are the places of images, row by row from the top left, as many as fit. The
/// header is cut into as many fields of equal width as there are places. The colour of field n, red first, is the id of the
/// projector whose image is in place n, in 8 bits each; white marks a free place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Packing {
    /// Width and height of a frame, pixels.
    pub frame_size_px: [u32; 2],
    /// Rows of the header, at least 1.
    pub header_rows: u32,
}

/// What cannot be packed or unpacked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum PackingError {
    /// Another number of images than of projectors.
    #[error("{found} images: the display has {expected} projectors")]
    Count {
        /// Images given.
        found: usize,
        /// Projectors of the display.
        expected: usize,
    },
    /// A picture of another size.
    #[error("{what} is of {}x{} pixels: must be of {}x{}", found[0], found[1], expected[0], expected[1])]
    Size {
        /// Which picture.
        what: &'static str,
        /// Its width and height, pixels.
        found: [u32; 2],
        /// What they must be, pixels.
        expected: [u32; 2],
    },
    /// An id in a header that no projector has.
    #[error("place {place} of the frame is for projector {id}: the display has none of that id")]
    UnknownId {
        /// Counted from 0.
        place: usize,
        /// As the header tells.
        id: u32,
    },
}

/// In a header, of a place without an image.
const FREE: u32 = LAST_ID + 1;

impl Packing {
    pub(super) fn check(&self, image: [u32; 2]) -> Result<(), DisplayError> {
        check_size_px("packing.frame_size_px", self.frame_size_px)?;
        let places = self.columns_and_rows(image).map(u64::from);
        let Self { frame_size_px: frame, header_rows } = *self;
        if header_rows == 0 || places.contains(&0) {
            return Err(DisplayError::FrameTooSmall { frame, header_rows, image });
        }
        let (columns, places) = (frame[0], places[0] * places[1]);
        if places > u64::from(columns) {
            return Err(DisplayError::HeaderTooNarrow { columns, places });
        }
        Ok(())
    }

    /// Columns and rows of the places for images of a size, pixels.
    pub fn columns_and_rows(&self, [width, height]: [u32; 2]) -> [u32; 2] {
        [self.frame_size_px[0] / width, self.frame_size_px[1].saturating_sub(self.header_rows) / height]
    }

    /// Top left pixel of each place.
    fn places(&self, image: [u32; 2]) -> Vec<[u32; 2]> {
        let [columns, rows] = self.columns_and_rows(image);
        let place = |n: u32| [n % columns * image[0], self.header_rows + n / columns * image[1]];
        (0..columns * rows).map(place).collect()
    }

    /// Columns of the frame that a field of the header covers.
    fn field(&self, n: usize, count: usize) -> std::ops::Range<usize> {
        let width = self.frame_size_px[0] as usize / count;
        n * width..(n + 1) * width
    }

    fn write_header(&self, frame: &mut RgbImage, ids: &[u32]) {
        let row_px = frame.width as usize;
        for (n, &id) in ids.iter().enumerate() {
            let [_, red, green, blue] = id.to_be_bytes();
            let color = [red, green, blue].map(|byte| f32::from(byte) / 255.0);
            for row in frame.rgb.chunks_mut(row_px).take(self.header_rows as usize) {
                row[self.field(n, ids.len())].fill(color);
            }
        }
    }

    /// The id in a field of the header, from the middle of the field, where a blurred connection changes it least.
    fn read_header(&self, frame: &RgbImage, n: usize, count: usize) -> u32 {
        let field = self.field(n, count);
        let column = field.start + (field.end - field.start) / 2;
        let at = self.header_rows as usize / 2 * frame.width as usize + column;
        let [red, green, blue] =
            frame.rgb[at].map(|channel| (channel * 255.0).round().clamp(0.0, 255.0) as u8);
        u32::from_be_bytes([0, red, green, blue])
    }
}

impl ProjectorArray {
    /// Projectors whose images make one frame each, by their index: neighbours together, so that a display that shows frame after
    /// frame has as few seams as there are frames (LF Fig. 6).
    pub fn batches(&self) -> Vec<std::ops::Range<usize>> {
        let [columns, rows] = self.description.packing.columns_and_rows(self.description.image_size_px);
        let per_frame = columns as usize * rows as usize;
        let count = self.projectors().len();
        (0..count).step_by(per_frame).map(|first| first..count.min(first + per_frame)).collect()
    }

    /// The frames of all projectors' images, in the order of the projectors.
    ///
    /// # Errors
    /// Another number of images than of projectors, images of another size.
    pub fn pack(&self, images: &[RgbImage]) -> Result<Vec<RgbImage>, PackingError> {
        self.check_images(images)?;
        self.batches().into_iter().map(|batch| self.pack_batch(batch.clone(), &images[batch])).collect()
    }

    /// One frame.
    ///
    /// # Errors
    /// Another number of images than of projectors of the batch, images of another size.
    pub fn pack_batch(
        &self,
        batch: std::ops::Range<usize>,
        images: &[RgbImage],
    ) -> Result<RgbImage, PackingError> {
        let (found, expected) = (images.len(), batch.len());
        if found != expected {
            return Err(PackingError::Count { found, expected });
        }
        let packing = self.description.packing;
        let image_size = self.description.image_size_px;
        let [width, height] = packing.frame_size_px;
        let mut frame = RgbImage { width, height, rgb: vec![[0.0; 3]; (width as usize) * height as usize] };
        let places = packing.places(image_size);
        let mut ids: Vec<u32> = self.projectors()[batch].iter().map(|projector| projector.id).collect();
        ids.resize(places.len(), FREE);
        packing.write_header(&mut frame, &ids);
        for (image, place) in images.iter().zip(places) {
            check_size("an image", image, image_size)?;
            frame.paste(image, place);
        }
        Ok(frame)
    }

    /// As many images as projectors, of their size.
    pub(crate) fn check_images(&self, images: &[RgbImage]) -> Result<(), PackingError> {
        let (found, expected) = (images.len(), self.projectors().len());
        if found != expected {
            return Err(PackingError::Count { found, expected });
        }
        images.iter().try_for_each(|image| check_size("an image", image, self.description.image_size_px))
    }

    /// The images of a frame, each with the index of its projector.
    ///
    /// # Errors
    /// A frame of another size, ids of no projector.
    pub fn unpack(&self, frame: &RgbImage) -> Result<Vec<(usize, RgbImage)>, PackingError> {
        let packing = self.description.packing;
        check_size("the frame", frame, packing.frame_size_px)?;
        let image_size = self.description.image_size_px;
        let places = packing.places(image_size);
        let count = places.len();
        let mut images = Vec::new();
        for (place, corner) in places.into_iter().enumerate() {
            let id = packing.read_header(frame, place, count);
            if id == FREE {
                continue;
            }
            let index = self.projectors().iter().position(|projector| projector.id == id);
            let index = index.ok_or(PackingError::UnknownId { place, id })?;
            images.push((index, frame.cut(corner, image_size)));
        }
        Ok(images)
    }
}

fn check_size(what: &'static str, image: &RgbImage, expected: [u32; 2]) -> Result<(), PackingError> {
    let found = [image.width, image.height];
    if found == expected { Ok(()) } else { Err(PackingError::Size { what, found, expected }) }
}
