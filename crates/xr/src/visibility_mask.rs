//! What the lenses hide.

use crate::error::{Called, XrError};
use crate::runtime::STEREO;
use crate::session::Session;
use openxr as xr;
use wheatstone_core::headset::HiddenArea;

/// Sorts what a runtime gives into triangles; none if it makes no sense.
fn hidden_area(mask: &xr::VisibilityMask) -> Option<HiddenArea> {
    let corners: Vec<_> = mask.vertices.iter().map(|vertex| [vertex.x, vertex.y]).collect();
    let (triangles, rest) = mask.indices.as_chunks::<3>();
    let makes_sense = rest.is_empty()
        && corners.as_flattened().iter().all(|tangent| tangent.is_finite())
        && mask.indices.iter().all(|&index| (index as usize) < corners.len());
    makes_sense.then(|| HiddenArea { corners, triangles: triangles.to_vec() })
}

impl Session {
    /// What the lens hides of an eye's picture (0 left, 1 right); none if the runtime does not tell, no triangles if nothing is hidden.
    /// It stays the same until [`SessionEvent::HiddenAreaChanged`](crate::SessionEvent::HiddenAreaChanged).
    ///
    /// # Errors
    /// A lost runtime.
    pub fn hidden_area(&self, eye: usize) -> Result<Option<HiddenArea>, XrError> {
        let Some(eye) = [0, 1].into_iter().nth(eye).filter(|_| self.has_visibility_masks()) else {
            return Ok(None);
        };
        let mask = self
            .handle
            .get_visibility_mask_khr(STEREO, eye, xr::VisibilityMaskTypeKHR::HIDDEN_TRIANGLE_MESH)
            .called("xrGetVisibilityMaskKHR")?;
        Ok(hidden_area(&mask))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mask(corners: &[[f32; 2]], indices: &[u32]) -> xr::VisibilityMask {
        let vertices = corners.iter().map(|&[x, y]| xr::Vector2f { x, y }).collect();
        xr::VisibilityMask { vertices, indices: indices.to_vec() }
    }

    #[test]
    fn triangles_are_three_corners_each() {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0], [2.0, 2.0]];
        let area = hidden_area(&mask(&corners, &[0, 1, 2, 1, 3, 2])).unwrap();
        assert_eq!(area.corners, corners);
        assert_eq!(area.triangles, [[0, 1, 2], [1, 3, 2]]);
        assert_eq!(hidden_area(&mask(&[], &[])), Some(HiddenArea::default()));
    }

    #[test]
    fn what_makes_no_sense_is_none() {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]];
        assert_eq!(hidden_area(&mask(&corners, &[0, 1])), None);
        assert_eq!(hidden_area(&mask(&corners, &[0, 1, 3])), None);
        assert_eq!(hidden_area(&mask(&[[f32::NAN, 0.0]; 3], &[0, 1, 2])), None);
    }
}
