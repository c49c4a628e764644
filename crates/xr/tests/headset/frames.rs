//! Pictures.

use crate::inside::{Surroundings, inside, inside_with};
use crate::support::{begin, clear, fill, until, until_running};
use glam::{DQuat, DVec3};
use wheatstone_core::head::Pose;
use wheatstone_xr::{Graphics, Panel, Session, SessionOptions, XrError};

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

#[test]
fn panels_and_depths_go_along_with_pictures() {
    inside(panels_and_depths_go_along_with_pictures, |_| {
        let (graphics, mut session) = begin(everything());
        show_everything(&graphics, &mut session);
    });
}

#[test]
fn the_display_refreshes_as_asked() {
    inside(the_display_refreshes_as_asked, |_| {
        let (graphics, mut session) = begin(SessionOptions::default());
        let rates_hz = session.refresh_rates_hz().unwrap();
        assert!(!rates_hz.is_empty());
        let hz = *rates_hz.last().unwrap();
        session.request_refresh_rate(hz).unwrap();
        let ticks: Vec<_> = (0..3)
            .map(|_| until(&graphics, &mut session, "a picture", |_, tick| tick.eyes.is_some()))
            .collect();
        assert_eq!(session.refresh_rate_hz().unwrap(), Some(hz));
        assert!((ticks[2].period_s - 1.0 / f64::from(hz)).abs() < 1e-4, "{ticks:?}");
        let [earlier_s, later_s] = [(); 2].map(|()| session.now_s().unwrap());
        assert!(earlier_s <= later_s && earlier_s > ticks[0].display_time_s - 10.0);
        assert!(matches!(session.request_refresh_rate(-1.0), Err(XrError::Refused { .. })));
    });
}

#[test]
fn vulkans_validation_layer_has_nothing_to_say() {
    let environment = vec![
        ("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation".into()),
        ("VK_LOADER_DEBUG", "layer".into()),
    ];
    let validated = Surroundings { environment, ..Default::default() };
    let said = inside_with(vulkans_validation_layer_has_nothing_to_say, validated, |_| {
        let (graphics, mut session) = begin(everything());
        show_everything(&graphics, &mut session);
        drop(session);
        drop(graphics);
    });
    let Some(said) = said else { return };
    assert!(said.contains("Insert instance layer \"VK_LAYER_KHRONOS_validation\""), "{said}");
    assert!(
        !said.contains("Validation Error") && !said.contains("Validation Warning") && !said.contains("VUID"),
        "{said}"
    );
}

/// Some of a session that has all that it can have.
const FRAMES_OF_EVERYTHING: usize = 4;

/// All that a session can have.
fn everything() -> SessionOptions {
    SessionOptions {
        image_scale: 0.5,
        panel_px: Some([64, 32]),
        has_depth: true,
        has_readable_images: true,
        refresh_rate_hz: None,
    }
}

/// Frames with pictures, depths and a panel that is drawn once, in front of the head; all are read back.
fn show_everything(graphics: &Graphics, session: &mut Session) {
    let gpu = graphics.gpu();
    let pose = Pose { position_m: DVec3::new(0.0, 1.2, -0.5), orientation: DQuat::IDENTITY };
    let mut shown = 0;
    while shown < FRAMES_OF_EVERYTHING {
        until_running(session);
        let mut frame = session.wait().unwrap();
        if frame.tick().eyes.is_some() {
            let images = frame.acquire_eyes().unwrap();
            fill(gpu, &images, [gray(10), gray(20)]);
            let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let depths = images.each_ref().map(|image| image.depth.clone().unwrap());
            for depth in &depths {
                clear_depth(&mut encoder, depth, 0.002);
            }
            let panel_image = (shown == 0).then(|| frame.acquire_panel().unwrap().unwrap());
            if let Some(panel) = &panel_image {
                clear(&mut encoder, panel, gray(30));
            }
            gpu.queue().submit([encoder.finish()]);
            for depth in &depths {
                let depths: Vec<f32> = gpu.read_texture(depth.texture()).unwrap();
                assert!(depths.iter().all(|depth| *depth == 0.002));
            }
            if let Some(panel) = &panel_image {
                let pixels: Vec<[u8; 4]> = gpu.read_texture(panel.texture()).unwrap();
                assert_eq!(pixels.len(), 64 * 32);
                assert!(pixels.iter().all(|pixel| *pixel == [30, 225, 0, 255]));
            }
            shown += 1;
        }
        frame.end(Some(&Panel { pose, size_m: [0.2, 0.1] })).unwrap();
    }
    gpu.check().unwrap();
}

fn clear_depth(encoder: &mut wgpu::CommandEncoder, view: &wgpu::TextureView, depth: f32) {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(depth),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
}
