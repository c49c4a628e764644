//! What tests of a session share.

use std::time::Duration;
use wheatstone_core::headset::Tick;
use wheatstone_render::Gpu;
use wheatstone_xr::{EyeImage, Graphics, Phase, Runtime, Session, SessionOptions};

/// Refreshes after which what a test waits for counts as not coming.
const PATIENCE: usize = 200;

/// Connects and begins a session.
pub(crate) fn begin(options: SessionOptions) -> (Graphics, Session) {
    let graphics = Runtime::connect("Wheatstone's tests").unwrap().open_gpu().unwrap();
    let session = Session::begin(&graphics, options).unwrap();
    (graphics, session)
}

/// Polls until there are frames to make.
pub(crate) fn until_running(session: &mut Session) {
    for _ in 0..1000 {
        match session.poll().unwrap() {
            Phase::Running => return,
            Phase::Idle => std::thread::sleep(Duration::from_millis(10)),
            Phase::Ended(reason) => panic!("ended: {reason:?}"),
        }
    }
    panic!("the session never began");
}

/// Makes a frame with a colour for each eye, if there are eyes. Returns its tick.
pub(crate) fn make_frame(graphics: &Graphics, session: &mut Session, colors: [wgpu::Color; 2]) -> Tick {
    until_running(session);
    let mut frame = session.wait().unwrap();
    let tick = *frame.tick();
    if tick.eyes.is_some() {
        fill(graphics.gpu(), &frame.acquire_eyes().unwrap(), colors);
    }
    frame.end(None).unwrap();
    tick
}

/// Fills both eyes' images.
pub(crate) fn fill(gpu: &Gpu, images: &[EyeImage; 2], colors: [wgpu::Color; 2]) {
    let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    for (image, color) in images.iter().zip(colors) {
        clear(&mut encoder, &image.color, color);
    }
    gpu.queue().submit([encoder.finish()]);
    gpu.check().unwrap();
}

/// Encodes filling a picture.
pub(crate) fn clear(encoder: &mut wgpu::CommandEncoder, view: &wgpu::TextureView, color: wgpu::Color) {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(color), store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    });
}

/// Makes frames until one is as wanted.
pub(crate) fn until(
    graphics: &Graphics,
    session: &mut Session,
    what: &str,
    mut wanted: impl FnMut(&mut Session, &Tick) -> bool,
) -> Tick {
    let mut last = None;
    for _ in 0..PATIENCE {
        let tick = make_frame(graphics, session, [wgpu::Color::BLACK; 2]);
        if wanted(session, &tick) {
            return tick;
        }
        last = Some(tick);
    }
    panic!("{what} does not come; last: {last:#?}");
}
