//! What rays have read, as a picture (DM Fig. 4).

use wheatstone_core::image::Image;
use wheatstone_core::reference::{Cast, Reads};

/// Samples and reads of the skip map of the ray that has read most.
pub(crate) fn most_reads(casts: &[Cast]) -> u32 {
    casts.iter().flat_map(|cast| &cast.reads).map(total).max().unwrap_or(0)
}

/// A grey picture of how much each ray has read: black is nothing, white is `white` or more.
pub(crate) fn heat_map(cast: &Cast, white: u32) -> Image {
    let Image { width, height, ref depth_m, .. } = cast.image;
    let grey = |reads: &Reads| {
        let level = (total(reads) as f32 / white.max(1) as f32).min(1.0);
        [level, level, level, 1.0]
    };
    Image { width, height, color: cast.reads.iter().map(grey).collect(), depth_m: depth_m.clone() }
}

fn total(reads: &Reads) -> u32 {
    reads.samples + reads.map_reads
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_most() {
        let reads =
            [(0, 0), (3, 1), (7, 1), (20, 0)].map(|(samples, map_reads)| Reads { samples, map_reads });
        let cast = Cast::new(Image::transparent(2, 2), reads.to_vec());
        assert_eq!((cast.samples, cast.map_reads), (30, 2));
        assert_eq!(most_reads(std::slice::from_ref(&cast)), 20);
        let levels: Vec<f32> = heat_map(&cast, 8).color.iter().map(|c| c[0]).collect();
        assert_eq!(levels, [0.0, 0.5, 1.0, 1.0]);
    }
}
