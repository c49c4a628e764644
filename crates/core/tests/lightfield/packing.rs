//! Frames carry every projector's image once, under its id.

use crate::scene::display;
use wheatstone_core::image::RgbImage;

fn image(seed: u32, [width, height]: [u32; 2]) -> RgbImage {
    let level = |i: u32| ((i.wrapping_mul(2_654_435_761).wrapping_add(seed * 40_503)) % 256) as f32 / 255.0;
    RgbImage {
        width,
        height,
        rgb: (0..width * height).map(|i| [level(i), level(i + 7), level(i + 99)]).collect(),
    }
}

#[test]
fn what_is_packed_is_unpacked() {
    let size = [16, 12];
    let array = display(17, 2.0, size);
    let images: Vec<RgbImage> = (0..17).map(|i| image(i, size)).collect();
    let frames = array.pack(&images).unwrap();
    assert_eq!(frames.len(), 2, "12 images to a frame");
    let mut found = vec![None; 17];
    for frame in &frames {
        assert_eq!([frame.width, frame.height], array.description().packing.frame_size_px);
        // As it comes through a connection of 8 bits.
        let bytes = frame.to_rgb8();
        let rgb = bytes.chunks(3).map(|c| [0, 1, 2].map(|i| f32::from(c[i]) / 255.0)).collect();
        let sent = RgbImage { rgb, ..*frame };
        for (index, image) in array.unpack(&sent).unwrap() {
            assert!(found[index].replace(image).is_none(), "{index} comes twice");
        }
    }
    for (index, image) in images.iter().enumerate() {
        assert_eq!(found[index].as_ref(), Some(image));
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let array = display(8, 2.0, [16, 12]);
    let images: Vec<RgbImage> = (0..8).map(|i| image(i, [16, 12])).collect();
    let fault = array.pack(&images[1..]).unwrap_err().to_string();
    assert_eq!(fault, "7 images: the display has 8 projectors");
    let mut wrong = images.clone();
    wrong[3] = image(3, [12, 16]);
    assert_eq!(array.pack(&wrong).unwrap_err().to_string(), "an image is of 12x16 pixels: must be of 16x12");
    let mut frame = array.pack(&images).unwrap().remove(0);
    assert_eq!(
        array.unpack(&images[0]).unwrap_err().to_string(),
        "the frame is of 16x12 pixels: must be of 64x44"
    );
    frame.rgb.fill([0.5; 3]);
    assert!(
        array
            .unpack(&frame)
            .unwrap_err()
            .to_string()
            .starts_with("place 0 of the frame is for projector 8421504")
    );
}
