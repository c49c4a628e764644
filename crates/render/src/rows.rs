//! Rows of a 3D texture, part by part.

use std::ops::Range;

/// Rows that come next: whole layers, or some of one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Rows {
    /// Within each of the layers.
    pub(crate) rows: Range<usize>,
    pub(crate) layers: Range<usize>,
}

impl Rows {
    /// From a row on, counted through all layers, no more than so many, but at least one band of them: what is not a whole layer is a
    /// whole number of bands, as far as there are rows in the layer.
    pub(crate) fn next(height: usize, first: usize, most: usize, band: usize) -> Self {
        let (layer, row) = (first / height, first % height);
        if row == 0 && most >= height {
            Self { rows: 0..height, layers: layer..layer + most / height }
        } else {
            let rows = (most / band).max(1) * band;
            Self { rows: row..(row + rows).min(height), layers: layer..layer + 1 }
        }
    }

    /// How many.
    pub(crate) fn count(&self) -> usize {
        self.rows.len() * self.layers.len()
    }

    /// Where they begin.
    pub(crate) fn origin(&self) -> wgpu::Origin3d {
        wgpu::Origin3d { x: 0, y: self.rows.start as u32, z: self.layers.start as u32 }
    }

    /// What they cover of a texture of some width.
    pub(crate) fn extent(&self, width: usize) -> wgpu::Extent3d {
        wgpu::Extent3d {
            width: width as u32,
            height: self.rows.len() as u32,
            depth_or_array_layers: self.layers.len() as u32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_any_sizes_cover_every_row_once() {
        let (height, layers) = (5, 7);
        let sizes = [&[1][..], &[3], &[5], &[12], &[0, 4, 11, 2], &[35], &[7, 1]];
        for (sizes, band) in sizes.into_iter().flat_map(|sizes| [1, 2, 8].map(|band| (sizes, band))) {
            let mut seen = vec![0; height * layers];
            let mut first = 0;
            for &size in sizes.iter().cycle() {
                if first == seen.len() {
                    break;
                }
                let part = Rows::next(height, first, size.min(seen.len() - first), band);
                assert!(part.count() > 0 && part.count() <= size.max(band), "{part:?} of {size}");
                assert!(
                    part.rows.start.is_multiple_of(band)
                        && (part.rows.end.is_multiple_of(band) || part.rows.end == height)
                );
                for layer in part.layers.clone() {
                    part.rows.clone().for_each(|row| seen[layer * height + row] += 1);
                }
                first += part.count();
            }
            assert!(seen.iter().all(|&times| times == 1), "{sizes:?} in bands of {band}: {seen:?}");
        }
    }
}
