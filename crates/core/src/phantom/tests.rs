use super::*;

fn normalised(volume: &Volume, index: usize) -> f64 {
    volume.voxels().value(index) / 255.0
}

/// Percentage of voxels that DM Eq. 16 gives an opacity above zero.
fn occupancy_percent(volume: &Volume, v0: f64, g0: Option<f64>) -> f64 {
    let [nx, ny, nz] = volume.grid().dims();
    let at = |i: usize, j: usize, k: usize| normalised(volume, i + nx * (j + ny * k));
    let occupied: usize = (0..nz)
        .into_par_iter()
        .map(|k| {
            let visible = |i: usize, j: usize| {
                at(i, j, k) > v0
                    && g0.is_none_or(|g0| {
                        let dx = at((i + 1).min(nx - 1), j, k) - at(i.saturating_sub(1), j, k);
                        let dy = at(i, (j + 1).min(ny - 1), k) - at(i, j.saturating_sub(1), k);
                        let dz = at(i, j, (k + 1).min(nz - 1)) - at(i, j, k.saturating_sub(1));
                        0.5 * DVec3::new(dx, dy, dz).length() > g0
                    })
            };
            (0..ny).map(|j| (0..nx).filter(|&i| visible(i, j)).count()).sum::<usize>()
        })
        .sum();
    100.0 * occupied as f64 / volume.grid().voxel_count() as f64
}

/// Phantom, v0 and occupancy (percent) of DM Table 2's one-dimensional transfer functions, then v0, g0 and occupancy
/// of its two-dimensional ones.
const DM_TABLE_2: [(Phantom, f64, f64, f64, f64, f64); 3] = [
    (Phantom::Present, 0.071, 7.13, 0.071, 0.06, 1.85),
    (Phantom::Beetle, 0.086, 3.97, 0.086, 0.1, 1.31),
    (Phantom::Snake, 0.4, 0.67, 0.2, 0.06, 0.55),
];

#[test]
fn occupancies_are_those_of_the_papers_volumes() {
    let mut found = Vec::new();
    for (phantom, v0, expected_1d, v0_2d, g0, expected_2d) in DM_TABLE_2 {
        for size in [128, 256] {
            let volume = phantom.cube(size).unwrap();
            found.push((phantom, size, "1D", occupancy_percent(&volume, v0, None), expected_1d));
            if size == 256 {
                found.push((phantom, size, "2D", occupancy_percent(&volume, v0_2d, Some(g0)), expected_2d));
            }
        }
    }
    for (phantom, size, kind, percent, expected) in &found {
        println!("{phantom} {size}³ {kind}: {percent:.2} % ({expected} % in the paper)");
    }
    assert!(found.iter().all(|(.., percent, expected)| (percent / expected - 1.0).abs() < 0.25), "{found:?}");
}
