//! What comes out on the display.

use crate::inside::{Surroundings, inside_with};
use crate::monado::Compositor;
use crate::support::{begin, clear, until_running};
use glam::{DQuat, DVec3};
use wheatstone_core::head::Pose;
use wheatstone_xr::{Panel, SessionOptions};

/// Frames after which a picture counts as not shown.
const PATIENCE: usize = 200;

/// Premultiplied, 0 to 255.
type Color = [u8; 4];

const PANEL: Color = [250, 128, 5, 255];

fn part(color: Color) -> [f64; 4] {
    color.map(|byte| f64::from(byte) / 255.0)
}

/// Draws a colour to the upper half of pictures, nothing to the lower one.
fn upper_half(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
    height: u32,
    color: Color,
) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(
            "override r: f32; override g: f32; override b: f32; override a: f32; override middle: f32;
            @vertex fn cover(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
                return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
            }
            @fragment fn color(@builtin(position) at: vec4f) -> @location(0) vec4f {
                return select(vec4f(), vec4f(r, g, b, a), at.y < middle);
            }"
            .into(),
        ),
    });
    let [r, g, b, a] = part(color);
    let constants = [("r", r), ("g", g), ("b", b), ("a", a), ("middle", f64::from(height) / 2.0)];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("cover"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("color"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants,
                ..Default::default()
            },
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn draw(encoder: &mut wgpu::CommandEncoder, view: &wgpu::TextureView, pipeline: &wgpu::RenderPipeline) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations::default(),
        })],
        ..Default::default()
    });
    pass.set_pipeline(pipeline);
    pass.draw(0..3, 0..1);
}

#[test]
fn colours_come_out_on_the_display_where_and_as_they_are_written() {
    let on_a_screen = Surroundings { compositor: Compositor::Screen, ..Default::default() };
    inside_with(colours_come_out_on_the_display_where_and_as_they_are_written, on_a_screen, |monado| {
        let (graphics, mut session) =
            begin(SessionOptions { panel_px: Some([64, 64]), ..Default::default() });
        let (gpu, format, sizes) = (graphics.gpu(), session.image_format(), session.eye_sizes());
        // Opaque; then translucent over black, with a panel in front in the middle of the left eye's view.
        let pairs: [[Color; 2]; 2] =
            [[[200, 80, 40, 255], [30, 120, 220, 255]], [[60, 40, 20, 128], [10, 100, 64, 100]]];
        for (colors, has_panel) in pairs.into_iter().zip([false, true]) {
            let pipelines = [0, 1].map(|eye| upper_half(gpu.device(), format, sizes[eye][1], colors[eye]));
            let [left, right] = colors;
            let black = [0; 4];
            let middle = if has_panel { PANEL } else { left };
            let wanted = [
                ((0.05, 0.1), left),
                ((0.95, 0.1), right),
                ((0.05, 0.9), black),
                ((0.95, 0.9), black),
                ((0.25, 0.49), middle),
            ];
            let mut seen = Vec::new();
            for _ in 0..PATIENCE {
                until_running(&mut session);
                let mut frame = session.wait().unwrap();
                let mut panel = None;
                if let Some([eye, _]) = frame.tick().eyes {
                    let mut encoder =
                        gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
                    for (image, pipeline) in frame.acquire_eyes().unwrap().iter().zip(&pipelines) {
                        draw(&mut encoder, &image.color, pipeline);
                    }
                    let [r, g, b, a] = part(PANEL);
                    let panel_image = frame.acquire_panel().unwrap().unwrap();
                    clear(&mut encoder, &panel_image, wgpu::Color { r, g, b, a });
                    gpu.queue().submit([encoder.finish()]);
                    gpu.check().unwrap();
                    let ahead = eye.pose.orientation * DVec3::new(0.0, 0.0, -1.0);
                    let pose = Pose { position_m: eye.pose.position_m + ahead, orientation: DQuat::IDENTITY };
                    panel = has_panel.then_some(Panel { pose, size_m: [0.3, 0.3] });
                }
                frame.end(panel.as_ref()).unwrap();
                let screen = monado.screen();
                seen = wanted.iter().map(|((x, y), _)| screen.at(*x, *y)).collect();
                if is_as(&seen, &wanted) {
                    break;
                }
            }
            assert!(is_as(&seen, &wanted), "{wanted:?} seen {seen:?}");
        }
    });
}

/// Whether all pixels are as wanted but for the rounding of decoding and encoding.
fn is_as(seen: &[[u8; 3]], wanted: &[((f64, f64), Color)]) -> bool {
    seen.len() == wanted.len()
        && seen.iter().zip(wanted).all(|(seen, (_, wanted))| {
            seen.iter().zip(wanted).all(|(seen, wanted)| seen.abs_diff(*wanted) <= 1)
        })
}
