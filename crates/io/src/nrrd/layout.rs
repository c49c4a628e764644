//! Which axes of a file are the volume's, and how its voxels lie among components and frames.

use super::fields::Fields;
use crate::{ReadError, Warning, voxel_data::Layout};
use glam::DVec3;

/// The axes of a file.
#[derive(Debug)]
pub(super) struct Axes {
    sizes: Vec<u64>,
    /// Up to three axes that are the volume's, in the file's order.
    pub(super) spatial: Vec<usize>,
    /// Vectors of the spatial axes in the file's space, if it has one.
    pub(super) directions: Option<Vec<DVec3>>,
}

impl Axes {
    /// Tells spatial axes from others: by `space directions` if the file has them, else by `kinds`.
    pub(super) fn classify(fields: &Fields, sizes: &[u64]) -> Result<Self, ReadError> {
        let directions = fields.directions(sizes.len())?;
        let mut spatial: Vec<usize> = match (&directions, fields.optional("kinds")) {
            (Some(directions), _) => (0..sizes.len()).filter(|&axis| directions[axis].is_some()).collect(),
            (None, Some(kinds)) => {
                let kinds: Vec<&str> = kinds.split_whitespace().collect();
                if kinds.len() != sizes.len() {
                    let text = kinds.join(" ");
                    return Err(ReadError::bad_field("kinds", &text, "one word for each axis"));
                }
                (0..sizes.len()).filter(|&axis| is_spatial(kinds[axis])).collect()
            }
            (None, None) => (0..sizes.len()).collect(),
        };
        spatial.truncate(3);
        if spatial.is_empty() {
            return Err(ReadError::MissingField { field: "kinds", expected: "at least one axis in space" });
        }
        let directions =
            directions.map(|vectors| spatial.iter().filter_map(|&axis| vectors[axis]).collect::<Vec<_>>());
        Ok(Self { sizes: sizes.to_owned(), spatial, directions })
    }

    pub(super) fn count(&self) -> usize {
        self.sizes.len()
    }

    /// Sizes of the volume's axes; 1 where the file has fewer than three.
    pub(super) fn dims(&self) -> [u64; 3] {
        std::array::from_fn(|i| self.spatial.get(i).map_or(1, |&axis| self.sizes[axis]))
    }

    /// Places the first frame and component in the file's scalars.
    pub(super) fn layout(&self, dense: Layout, warnings: &mut Vec<Warning>) -> Result<Layout, ReadError> {
        let all: Vec<usize> = (0..self.count()).collect();
        let last_spatial = self.spatial.last().copied().unwrap_or(0);
        let product = |axes: &[usize]| {
            axes.iter().try_fold(1_u64, |product, &axis| product.checked_mul(self.sizes[axis]))
        };
        let frames = product(&all[last_spatial + 1..]).unwrap_or(u64::MAX);
        if frames > 1 {
            warnings.push(Warning::FirstFrameOnly { frames });
        }
        let mut layout = dense;
        layout.ends_stream = frames == 1;
        let inner: Vec<usize> =
            (0..last_spatial).filter(|axis| !self.spatial.contains(axis) && self.sizes[*axis] > 1).collect();
        let (Some(&first), Some(&last)) = (inner.first(), inner.last()) else { return Ok(layout) };
        let is_one_group =
            !self.spatial.iter().any(|&axis| axis > first && axis < last && self.sizes[axis] > 1);
        let run = product(&all[..first]).and_then(|run| usize::try_from(run).ok());
        let components = product(&inner);
        let (true, Some(run), Some(components)) = (is_one_group, run, components) else {
            return Err(ReadError::Unsupported {
                what: "an order of axes with components on both sides of a spatial axis".to_owned(),
                expected: "the components together",
            });
        };
        warnings.push(Warning::FirstComponentOnly { components });
        layout.run = run;
        let period = usize::try_from(components).ok().and_then(|components| run.checked_mul(components));
        layout.period = period.ok_or(ReadError::TooLarge {
            dims: self.dims(),
            bytes_per_voxel: components.saturating_mul(dense.scalar.byte_size() as u64),
            limit_bytes: crate::MAX_VOXEL_BYTES,
        })?;
        Ok(layout)
    }
}

fn is_spatial(kind: &str) -> bool {
    matches!(kind.to_ascii_lowercase().as_str(), "domain" | "space" | "none" | "???")
}
