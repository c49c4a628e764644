//! The slabs that a volume is in.

use std::ops::Range;

/// Slabs from the furthest to the nearest, both included.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SlabRange {
    /// The smaller number; below 0 behind the depth at which both eyes see a point in one column.
    pub furthest: i32,
    /// The larger number.
    pub nearest: i32,
}

impl SlabRange {
    /// How many there are: as many layers let no two reference rays of a row that share one write the same derived pixel
    /// (SP §3.2).
    pub fn layers(&self) -> u32 {
        self.nearest.abs_diff(self.furthest).saturating_add(1)
    }

    /// Sweep columns of the reference rays that a derived picture needs; some are beyond the reference picture's edges.
    pub fn feeding_columns(&self, width: u32) -> Range<i32> {
        self.furthest..i32::try_from(width).unwrap_or(i32::MAX).saturating_add(self.nearest)
    }

    /// Sweep columns of the reference rays that a pair of pictures needs.
    pub fn cast_columns(&self, width: u32) -> Range<i32> {
        let Range { start, end } = self.feeding_columns(width);
        start.min(0)..end.max(i32::try_from(width).unwrap_or(i32::MAX))
    }

    /// Bytes of re-projection layers for pictures of a size in pixels: M = w·h·l·b (SP §4.2).
    pub fn layer_bytes(&self, [width, height]: [u32; 2], bytes_per_pixel: u32) -> u64 {
        u64::from(width) * u64::from(height) * u64::from(self.layers()) * u64::from(bytes_per_pixel)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_take_the_memory_of_table_2() {
        let table = [
            (512, [64.0, 128.0, 192.0]),
            (768, [144.0, 288.0, 432.0]),
            (1080, [284.76, 569.53, 854.29]),
            (1512, [558.14, 1116.28, 1674.42]),
        ];
        for (side, row) in table {
            for (layers, mebibytes) in [32, 64, 96].into_iter().zip(row) {
                let bytes = SlabRange { furthest: 1, nearest: layers }.layer_bytes([side; 2], 8);
                // The paper cuts its numbers off.
                assert!((bytes as f64 / f64::from(1 << 20) - mebibytes).abs() < 0.011, "{side} {layers}");
            }
        }
    }

    #[test]
    fn rays_beyond_both_edges_are_needed_where_disparities_have_both_signs() {
        let range = SlabRange { furthest: -3, nearest: 5 };
        assert_eq!((range.layers(), range.feeding_columns(10), range.cast_columns(10)), (9, -3..15, -3..15));
        let range = SlabRange { furthest: 2, nearest: 5 };
        assert_eq!((range.layers(), range.feeding_columns(10), range.cast_columns(10)), (4, 2..15, 0..15));
        let range = SlabRange { furthest: -5, nearest: -2 };
        assert_eq!((range.layers(), range.feeding_columns(10), range.cast_columns(10)), (4, -5..8, -5..10));
    }
}
