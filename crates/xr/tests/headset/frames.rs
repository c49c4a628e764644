//! Pictures.

use crate::monado::inside;
use crate::support::{begin, fill, until_running};
use wheatstone_xr::SessionOptions;

/// Exact in eight bits.
fn gray(eighth_bits: u8) -> wgpu::Color {
    let value = f64::from(eighth_bits) / 255.0;
    wgpu::Color { r: value, g: 1.0 - value, b: 0.0, a: 1.0 }
}

#[test]
fn what_is_drawn_is_in_the_headsets_images_bit_by_bit() {
    inside(what_is_drawn_is_in_the_headsets_images_bit_by_bit, |_| {
        let (graphics, mut session) =
            begin(SessionOptions { has_readable_images: true, ..Default::default() });
        let sizes = session.eye_sizes();
        let mut drawn = 0_u8;
        let mut ticks = Vec::new();
        while drawn < 60 {
            until_running(&mut session);
            let mut frame = session.wait().unwrap();
            let tick = *frame.tick();
            if tick.eyes.is_some() {
                let images = frame.acquire_eyes().unwrap();
                fill(graphics.gpu(), &images, [gray(drawn), gray(255 - drawn)]);
                for (image, (size, level)) in images.iter().zip(sizes.into_iter().zip([drawn, 255 - drawn])) {
                    let texture = image.color.texture();
                    assert_eq!([texture.width(), texture.height()], size);
                    let pixels: Vec<[u8; 4]> = graphics.gpu().read_texture(texture).unwrap();
                    assert!(
                        pixels.iter().all(|pixel| *pixel == [level, 255 - level, 0, 255]),
                        "{}",
                        pixels[0][0]
                    );
                }
                drawn += 1;
                ticks.push(tick);
            }
            frame.end(None).unwrap();
        }
        assert_eq!(session.image_format(), wgpu::TextureFormat::Rgba8Unorm);
        assert!(ticks.is_sorted_by(|a, b| a.display_time_s < b.display_time_s));
        assert!(ticks.iter().skip(1).all(|tick| tick.period_s > 0.001 && tick.period_s < 0.1));
        graphics.gpu().check().unwrap();
    });
}
