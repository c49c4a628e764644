//! What a frame shows.

use crate::error::{Called, XrError};
use crate::eyes::NEAR_M;
use crate::session::Session;
use crate::space::pose_to_xr;
use openxr as xr;
use wheatstone_core::head::Pose;

/// Where the panel is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Panel {
    /// Of its middle in the room; it faces +Z.
    pub pose: Pose,
    /// Width and height, metres.
    pub size_m: [f32; 2],
}

/// What is behind is seen through colours, which are premultiplied.
const TRANSLUCENT: xr::CompositionLayerFlags = xr::CompositionLayerFlags::BLEND_TEXTURE_SOURCE_ALPHA;

type ProjectionView<'a> = xr::CompositionLayerProjectionView<'a, xr::Vulkan>;

impl Session {
    /// Ends a frame with the eyes' pictures of these views, if there are any, and the panel in front of them.
    pub(crate) fn show(
        &mut self,
        time: xr::Time,
        views: Option<[xr::View; 2]>,
        panel: Option<&Panel>,
    ) -> Result<(), XrError> {
        let Self { stream, eye_images, panel_image, world, blend_mode, .. } = self;
        let depths =
            eye_images.each_ref().map(|eye| eye.depth.as_ref().map(|depth| depth_info(depth.sub_image())));
        let views = views.map(|views| {
            [0, 1].map(|eye| {
                let view = ProjectionView::new()
                    .pose(views[eye].pose)
                    .fov(views[eye].fov)
                    .sub_image(eye_images[eye].color.sub_image());
                match &depths[eye] {
                    Some(depth) => with_depth(view, depth),
                    None => view,
                }
            })
        });
        let eyes = views.as_ref().map(|views| {
            xr::CompositionLayerProjection::new().layer_flags(TRANSLUCENT).space(&world.space).views(views)
        });
        let panel_image = panel_image.as_ref().filter(|image| image.has_picture());
        let panel = panel.zip(panel_image).map(|(panel, image)| {
            let [width, height] = panel.size_m;
            xr::CompositionLayerQuad::new()
                .layer_flags(TRANSLUCENT)
                .space(&world.space)
                .eye_visibility(xr::EyeVisibility::BOTH)
                .pose(pose_to_xr(&panel.pose))
                .size(xr::Extent2Df { width, height })
                .sub_image(image.sub_image())
        });
        let layers: Vec<&xr::CompositionLayerBase<'_, xr::Vulkan>> =
            eyes.as_deref().into_iter().chain(panel.as_deref()).collect();
        stream.end(time, *blend_mode, &layers).called("xrEndFrame")
    }
}

/// Depths as [`EyeImage::depth`](crate::EyeImage::depth) has them: 1 at the nearest depth, 0 at infinity.
fn depth_info(image: xr::SwapchainSubImage<'_, xr::Vulkan>) -> xr::sys::CompositionLayerDepthInfoKHR {
    xr::sys::CompositionLayerDepthInfoKHR {
        ty: xr::sys::CompositionLayerDepthInfoKHR::TYPE,
        next: std::ptr::null(),
        sub_image: image.into_raw(),
        min_depth: 0.0,
        max_depth: 1.0,
        near_z: f32::INFINITY,
        far_z: NEAR_M as f32,
    }
}

fn with_depth<'a>(
    view: ProjectionView<'a>,
    depth: &'a xr::sys::CompositionLayerDepthInfoKHR,
) -> ProjectionView<'a> {
    let mut raw = view.into_raw();
    raw.next = std::ptr::from_ref(depth).cast();
    // SAFETY: what is chained outlives the view, by its lifetime.
    unsafe { ProjectionView::from_raw(raw) }
}
