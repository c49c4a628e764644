//! Draws what an eye sees of the room.

use super::headset::EyeImage;
use glam::{DMat4, DVec3, DVec4};
use wgpu::util::DeviceExt as _;
use wheatstone_core::headset::Eye;
use wheatstone_core::view::{Frustum, PixelRect};
use wheatstone_render::Gpu;

/// Width of lines, as a part of the picture's.
const LINE_WIDTH: f32 = 1.0 / 600.0;

/// A coloured line; mirror of the attributes in `stage.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct ColoredLine {
    /// Its ends in the room, metres, each with its opacity.
    pub(crate) ends: [[f32; 4]; 2],
    /// Display-referred.
    pub(crate) rgb: [f32; 3],
}

impl ColoredLine {
    /// Between two points in the room, metres.
    pub(crate) fn new(ends_m: [DVec3; 2], alphas: [f32; 2], rgb: [f32; 3]) -> Self {
        let end = |end: usize| ends_m[end].as_vec3().extend(alphas[end]).to_array();
        Self { ends: [end(0), end(1)], rgb }
    }
}

/// Mirror of `Stage` in `stage.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct StageUniform {
    clip_from_room: [[f32; 4]; 4],
    size_px: [f32; 2],
    line_px: f32,
    near_m: f32,
}

/// What of a draw is kept. Depths are 1 at the nearest and 0 infinitely far away.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Keeps {
    Colors,
    /// Those that are nearer than what there is.
    Depths,
    Both,
}

/// What is seen besides the background.
#[derive(Debug, Default)]
pub(crate) struct Scenery<'a> {
    pub(crate) behind: &'a [ColoredLine],
    /// Of the volume, premultiplied; none as long as there is none.
    pub(crate) picture: Option<&'a wgpu::TextureView>,
    /// Of the volume, near over depth; none as long as there is none, or where depths are not kept.
    pub(crate) depths: Option<&'a wgpu::TextureView>,
    /// The pixels in which it is drawn, each of them in one rectangle.
    pub(crate) visible: &'a [PixelRect],
    pub(crate) in_front: &'a [ColoredLine],
}

/// Pipelines for images of a format.
pub(crate) struct Stage {
    layout: wgpu::BindGroupLayout,
    picture: wgpu::RenderPipeline,
    /// Where depths are kept.
    depth: Option<wgpu::RenderPipeline>,
    line: wgpu::RenderPipeline,
    sampler: wgpu::Sampler,
    /// In the place of a picture.
    nothing: wgpu::TextureView,
}

impl Stage {
    /// For colours of a format, and depths if they have one.
    pub(crate) fn new(
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        depth_format: Option<wgpu::TextureFormat>,
    ) -> Self {
        let module = device.create_shader_module(wgpu::include_wgsl!("stage.wgsl"));
        let entry =
            |binding, visibility, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let texture = |filterable| wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("stage"),
            entries: &[
                entry(0, wgpu::ShaderStages::VERTEX_FRAGMENT, uniform),
                entry(1, wgpu::ShaderStages::FRAGMENT, texture(true)),
                entry(2, wgpu::ShaderStages::FRAGMENT, sampler),
                entry(3, wgpu::ShaderStages::FRAGMENT, texture(false)),
            ],
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("stage"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = |[vertex, fragment]: [&'static str; 2],
                        buffers: &[Option<wgpu::VertexBufferLayout<'_>>],
                        keeps: Keeps| {
            let depth_stencil = depth_format.map(|format| wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(keeps != Keeps::Colors),
                depth_compare: Some(if keeps == Keeps::Depths {
                    wgpu::CompareFunction::Greater
                } else {
                    wgpu::CompareFunction::Always
                }),
                stencil: Default::default(),
                bias: Default::default(),
            });
            let write_mask =
                if keeps == Keeps::Depths { wgpu::ColorWrites::empty() } else { wgpu::ColorWrites::ALL };
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(fragment),
                layout: Some(&pipeline_layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some(vertex),
                    compilation_options: Default::default(),
                    buffers,
                },
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(fragment),
                    compilation_options: Default::default(),
                    targets: &[Some(wgpu::ColorTargetState {
                        format,
                        blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                        write_mask,
                    })],
                }),
                primitive: Default::default(),
                depth_stencil,
                multisample: Default::default(),
                multiview_mask: None,
                cache: None,
            })
        };
        let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x3];
        let lines = wgpu::VertexBufferLayout {
            array_stride: size_of::<ColoredLine>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &attributes,
        };
        let nothing = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("no picture"),
            size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        Self {
            picture: pipeline(["everywhere", "show_picture"], &[], Keeps::Colors),
            depth: depth_format.map(|_| pipeline(["everywhere", "keep_depth"], &[], Keeps::Depths)),
            line: pipeline(["line_corner", "line"], &[Some(lines)], Keeps::Both),
            layout,
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("interpolated"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
            nothing: nothing.create_view(&wgpu::TextureViewDescriptor::default()),
        }
    }

    /// Encodes all pixels of an eye's image; without a background it is transparent.
    pub(crate) fn draw(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        EyeImage { color: image, depth }: &EyeImage,
        eye: &Eye,
        background: Option<[f32; 3]>,
        scenery: &Scenery<'_>,
    ) {
        let device = gpu.device();
        let size = image.texture().size();
        let size_px = [size.width, size.height].map(|side| side as f32);
        let uniform = StageUniform {
            clip_from_room: clip_from_room(eye).as_mat4().to_cols_array_2d(),
            size_px,
            line_px: (LINE_WIDTH * size_px[0]).max(1.0),
            near_m: eye.frustum.near_m as f32,
        };
        let buffer = |contents, usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("stage"),
                contents,
                usage,
            })
        };
        let uniform = buffer(bytemuck::bytes_of(&uniform), wgpu::BufferUsages::UNIFORM);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("stage"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::TextureView(scenery.picture.unwrap_or(&self.nothing)),
                },
                wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(&self.sampler) },
                wgpu::BindGroupEntry {
                    binding: 3,
                    resource: wgpu::BindingResource::TextureView(scenery.depths.unwrap_or(&self.nothing)),
                },
            ],
        });
        let lines = [scenery.behind, scenery.in_front]
            .map(|lines| buffer(bytemuck::cast_slice(lines), wgpu::BufferUsages::VERTEX));
        let clear = background.map_or(wgpu::Color::TRANSPARENT, |rgb| {
            let [r, g, b] = rgb.map(f64::from);
            wgpu::Color { r, g, b, a: 1.0 }
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("stage"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: image,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: depth.as_ref().map(|view| wgpu::RenderPassDepthStencilAttachment {
                view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(0, &group, &[]);
        let draw_lines = |pass: &mut wgpu::RenderPass<'_>, buffer: &wgpu::Buffer, lines: &[ColoredLine]| {
            if !lines.is_empty() {
                pass.set_pipeline(&self.line);
                pass.set_vertex_buffer(0, buffer.slice(..));
                pass.draw(0..6, 0..lines.len() as u32);
            }
        };
        draw_lines(&mut pass, &lines[0], scenery.behind);
        let picture = scenery.picture.map(|_| &self.picture);
        let depth = self.depth.as_ref().filter(|_| scenery.depths.is_some());
        for pipeline in [picture, depth].into_iter().flatten() {
            pass.set_pipeline(pipeline);
            for PixelRect { columns, rows } in scenery.visible.iter().filter(|rect| !rect.is_empty()) {
                pass.set_scissor_rect(columns.start, rows.start, columns.len() as u32, rows.len() as u32);
                pass.draw(0..3, 0..1);
            }
        }
        pass.set_scissor_rect(0, 0, size.width, size.height);
        draw_lines(&mut pass, &lines[1], scenery.in_front);
    }
}

/// The projection of an eye but for depths.
fn clip_from_room(eye: &Eye) -> DMat4 {
    let Frustum { left, right, down, up, .. } = eye.frustum;
    let (width, height) = (right - left, up - down);
    let clip_from_eye = DMat4::from_cols(
        DVec4::new(2.0 / width, 0.0, 0.0, 0.0),
        DVec4::new(0.0, 2.0 / height, 0.0, 0.0),
        DVec4::new((right + left) / width, (up + down) / height, 0.0, -1.0),
        DVec4::ZERO,
    );
    clip_from_eye * DMat4::from(eye.pose.world_from_own().inverse())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::canvas;
    use glam::DQuat;
    use wheatstone_core::head::Pose;
    use wheatstone_core::headset::HiddenArea;
    use wheatstone_render::warp::GridDepths;

    #[test]
    fn the_pipelines_build_on_the_noop_device() {
        let (device, _) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        for depth in [None, Some(wgpu::TextureFormat::Depth32Float)] {
            Stage::new(&device, wgpu::TextureFormat::Rgba8Unorm, depth);
        }
        assert_eq!(pollster::block_on(scope.pop()).map(|error| error.to_string()), None);
    }

    #[test]
    fn lines_land_where_rays_of_the_view_pass() {
        let pose = Pose { position_m: DVec3::new(0.1, 1.6, 0.2), orientation: DQuat::from_rotation_y(0.3) };
        let frustum =
            Frustum { left: -1.2, right: 0.9, down: -1.0, up: 1.1, near_m: 0.05, far_m: f64::INFINITY };
        let eye = Eye { pose, frustum };
        let point = DVec3::new(-0.2, 1.4, -0.8);
        let clip = clip_from_room(&eye) * point.extend(1.0);
        let at = eye.view([200, 100]).pixel_position(point).unwrap();
        let pixel = [100.0 * (1.0 + clip.x / clip.w), 50.0 * (1.0 - clip.y / clip.w)];
        assert!((pixel[0] - at.x).abs() < 1e-9 && (pixel[1] - at.y).abs() < 1e-9, "{pixel:?} {at}");
    }

    const EYE: Eye = Eye {
        pose: Pose { position_m: DVec3::ZERO, orientation: DQuat::IDENTITY },
        frustum: Frustum { left: -1.0, right: 1.0, down: -1.0, up: 1.0, near_m: 0.001, far_m: f64::INFINITY },
    };

    /// Runs a test on a device, unless that is to be skipped.
    fn on_device(test: impl FnOnce(&Gpu)) {
        if std::env::var("WHEATSTONE_SKIP_GPU_TESTS").is_ok_and(|value| value == "1") {
            return;
        }
        let gpu = Gpu::open_software().or_else(|_| Gpu::open_best());
        test(&gpu.unwrap_or_else(|error| panic!("{error}; WHEATSTONE_SKIP_GPU_TESTS=1 skips this")));
    }

    const BLUE: Option<[f32; 3]> = Some([0.0, 0.0, 1.0]);

    /// What an eye sees of some scenery before a background.
    fn seen(gpu: &Gpu, size: [u32; 2], background: Option<[f32; 3]>, scenery: &Scenery<'_>) -> Vec<[u8; 4]> {
        let stage = Stage::new(gpu.device(), wgpu::TextureFormat::Rgba8Unorm, None);
        let image = canvas::texture(gpu, size, wgpu::TextureFormat::Rgba8Unorm).unwrap();
        let color = image.create_view(&wgpu::TextureViewDescriptor::default());
        let target = EyeImage { color, depth: None };
        let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        stage.draw(gpu, &mut encoder, &target, &EYE, background, scenery);
        gpu.queue().submit([encoder.finish()]);
        gpu.read_texture(&image).unwrap()
    }

    /// A picture that is opaque and red all over.
    fn red(gpu: &Gpu, size: [u32; 2]) -> wgpu::TextureView {
        let texels = [255, 0, 0, 255].repeat((size[0] * size[1]) as usize);
        filled(gpu, size, wgpu::TextureFormat::Rgba8Unorm, &texels)
    }

    #[test]
    fn what_lenses_hide_is_not_drawn() {
        on_device(|gpu| {
            let size = [64, 48];
            let picture = red(gpu, size);
            // All that is above the diagonal from the lower left to the upper right.
            let hidden = HiddenArea {
                corners: vec![[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]],
                triangles: vec![[0, 1, 2]],
            };
            let visible = hidden.visible(&EYE.frustum, size);
            let line = [ColoredLine::new(
                [DVec3::new(-0.9, 0.8, -1.0), DVec3::new(-0.5, 0.8, -1.0)],
                [1.0; 2],
                [0.0, 1.0, 0.0],
            )];
            let scenery =
                Scenery { picture: Some(&picture), visible: &visible, in_front: &line, ..Scenery::default() };
            let texels = seen(gpu, size, BLUE, &scenery);
            let mut drawn = 0;
            for (index, texel) in texels.iter().enumerate() {
                let [x, y] = [index as u32 % size[0], index as u32 / size[0]];
                let is_drawn = visible.iter().any(|rect| rect.columns.contains(&x) && rect.rows.contains(&y));
                if [255, 0, 0, 255] == *texel {
                    assert!(is_drawn, "{x} {y}");
                    drawn += 1;
                }
                // Below the diagonal by a pixel.
                if 48 * (x + 1) > 64 * (48 - y) {
                    assert!([255, 0, 0, 255] == *texel, "{x} {y} {texel:?}");
                }
            }
            assert!(drawn < 64 * 48 * 3 / 4, "{drawn}");
            assert!(texels.contains(&[0, 255, 0, 255]), "lines are drawn wherever they are");
        });
    }

    #[test]
    fn without_a_background_the_room_is_seen_where_nothing_is() {
        on_device(|gpu| {
            let size = [16, 8];
            // Half of what is behind passes.
            let texels = [128, 0, 0, 128].repeat((size[0] * size[1]) as usize);
            let picture = filled(gpu, size, wgpu::TextureFormat::Rgba8Unorm, &texels);
            let left = [PixelRect { columns: 0..8, rows: 0..8 }];
            let scenery = Scenery { picture: Some(&picture), visible: &left, ..Scenery::default() };
            for (background, on_left, on_right) in
                [(None, [128, 0, 0, 128], [0; 4]), (BLUE, [128, 0, 127, 255], [0, 0, 255, 255])]
            {
                let texels = seen(gpu, size, background, &scenery);
                assert_eq!([texels[0], texels[15]], [on_left, on_right], "{background:?}");
            }
        });
    }

    /// A texture of a format with some texels.
    fn filled(
        gpu: &Gpu,
        [width, height]: [u32; 2],
        format: wgpu::TextureFormat,
        texels: &[u8],
    ) -> wgpu::TextureView {
        let description = wgpu::TextureDescriptor {
            label: Some("filled"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        };
        let order = wgpu::util::TextureDataOrder::LayerMajor;
        let texture = gpu.device().create_texture_with_data(gpu.queue(), &description, order, texels);
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }

    #[test]
    fn depths_are_those_of_the_nearest_of_picture_and_lines() {
        on_device(|gpu| {
            let size = [64, 48];
            let picture = red(gpu, size);
            // The left half is 4 m away, the right half nowhere; at half the picture's width and height.
            let near_m = EYE.frustum.near_m as f32;
            let texels: Vec<f32> =
                (0..32 * 24).map(|index| if index % 32 < 16 { near_m / 4.0 } else { 0.0 }).collect();
            let depths = filled(gpu, [32, 24], GridDepths::FORMAT, bytemuck::cast_slice(&texels));
            // Across the picture, through the middles of rows: below its middle behind the left half, above it in front.
            let line = |y: f64, depth_m: f64| {
                let end = |x: f64| depth_m * DVec3::new(x, y, -1.0);
                ColoredLine::new([end(-0.9), end(0.9)], [1.0; 2], [0.0, 1.0, 0.0])
            };
            let (behind, in_front) = ([line(-12.5 / 24.0, 8.0)], [line(11.5 / 24.0, 2.0)]);
            let texture = |format, usage| {
                gpu.device().create_texture(&wgpu::TextureDescriptor {
                    label: Some("stage"),
                    size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                    mip_level_count: 1,
                    sample_count: 1,
                    dimension: wgpu::TextureDimension::D2,
                    format,
                    usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                    view_formats: &[],
                })
            };
            let color = texture(wgpu::TextureFormat::Rgba8Unorm, wgpu::TextureUsages::COPY_SRC);
            let depth = texture(wgpu::TextureFormat::Depth32Float, wgpu::TextureUsages::COPY_SRC);
            let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
            let target = EyeImage { color: view(&color), depth: Some(view(&depth)) };
            let visible = [PixelRect { columns: 0..size[0], rows: 0..size[1] }];
            let scenery = Scenery {
                behind: &behind,
                picture: Some(&picture),
                depths: Some(&depths),
                visible: &visible,
                in_front: &in_front,
            };
            let stage = Stage::new(gpu.device(), color.format(), Some(depth.format()));
            let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            stage.draw(gpu, &mut encoder, &target, &EYE, Some([0.0; 3]), &scenery);
            gpu.queue().submit([encoder.finish()]);
            let found: Vec<f32> = gpu.read_texture(&depth).unwrap();
            let depth_at = |x: usize, y: usize| near_m / found[y * size[0] as usize + x];
            for (x, y, depth_m) in [
                (16, 24, 4.0),
                (48, 24, f32::INFINITY),
                (16, 36, 4.0),
                (48, 36, 8.0),
                (16, 12, 2.0),
                (48, 12, 2.0),
                (16, 2, 4.0),
            ] {
                let found_m = depth_at(x, y);
                assert!(
                    found_m == depth_m || (found_m - depth_m).abs() < 1e-3 * depth_m,
                    "{x} {y}: {found_m} m"
                );
            }
        });
    }
}
