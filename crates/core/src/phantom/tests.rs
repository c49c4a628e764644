use super::*;
use crate::scene::GradientMethod;
use crate::skip::voxel_occupancy;
use crate::transfer::BenchmarkRamp;

fn normalised(volume: &Volume, index: usize) -> f64 {
    volume.voxels().value(index) / 255.0
}

#[test]
fn occupancies_are_those_of_the_papers_volumes() {
    const SIZE: usize = 256;
    let mut found = Vec::new();
    for phantom in [Phantom::Present, Phantom::Beetle, Phantom::Snake] {
        let volume = phantom.cube(SIZE).unwrap();
        for ramp in BenchmarkRamp::of_volume(phantom.name()) {
            let transfer = ramp.transfer([SIZE; 3]).unwrap();
            let fraction =
                voxel_occupancy(&volume, ramp.window().unwrap(), &transfer, GradientMethod::default());
            found.push((ramp.name(), fraction, ramp.occupancy().unwrap()));
        }
    }
    assert_eq!(found.len(), 6);
    assert!(found.iter().all(|(_, fraction, expected)| (fraction / expected - 1.0).abs() < 0.1), "{found:?}");
}

#[test]
fn names_come_back() {
    for &phantom in Phantom::ALL {
        assert_eq!(phantom.name().parse::<Phantom>().unwrap(), phantom);
    }
    assert!("torus".parse::<Phantom>().unwrap_err().to_string().contains("marschner-lobb"));
}

#[test]
fn degenerate_sizes_are_sampled_and_impossible_ones_refused() {
    for &phantom in Phantom::ALL {
        for dims in [[1, 1, 1], [1, 7, 3], [16, 1, 2]] {
            let volume = phantom.volume(dims).unwrap();
            assert_eq!(volume.grid().dims(), dims, "{phantom}");
            assert!(volume.range().0 >= 0.0 && volume.range().1 <= 255.0, "{phantom}: {:?}", volume.range());
        }
        assert!(matches!(phantom.volume([4, 0, 4]), Err(PhantomError::Grid(_))), "{phantom}");
        assert!(matches!(phantom.cube(1 << 20), Err(PhantomError::Memory { .. })), "{phantom}");
    }
}

/// Where a linearly interpolated row of voxels first falls below a level, in voxels from its start's centre.
fn crossing(values: &[f64], level: f64) -> f64 {
    let i = values.iter().position(|&v| v < level).unwrap();
    (i - 1) as f64 + (values[i - 1] - level) / (values[i - 1] - values[i])
}

#[test]
fn half_value_of_the_sphere_is_at_its_radius() {
    for dims in [[32, 32, 32], [65, 65, 65], [64, 32, 48]] {
        let volume = Phantom::Sphere.volume(dims).unwrap();
        for axis in 0..3 {
            let n = dims[axis];
            let stride = [1, dims[0], dims[0] * dims[1]];
            let centre: usize = (0..3).map(|a| dims[a] / 2 * stride[a]).sum();
            let row: Vec<f64> =
                (0..n - n / 2).map(|i| normalised(&volume, centre + i * stride[axis])).collect();
            let found = crossing(&row, 0.5) + (n / 2) as f64 + 0.5 - 0.5 * n as f64;
            // Even sizes have no voxel on the axis itself: the row runs half a voxel beside it.
            let beside: f64 = (0..3)
                .filter(|&a| a != axis)
                .map(|a| ((dims[a] / 2) as f64 + 0.5) / dims[a] as f64 - 0.5)
                .map(|offset| offset * offset)
                .sum();
            let expected = (SPHERE_RADIUS * SPHERE_RADIUS - beside).sqrt() * n as f64;
            assert!((found - expected).abs() < 0.1, "{dims:?} axis {axis}: {found} is not {expected}");
        }
    }
}

#[test]
fn the_box_holds_its_share_of_the_volume() {
    for dims in [[8, 8, 8], [9, 10, 7]] {
        let volume = Phantom::SolidBox.volume(dims).unwrap();
        let sum: f64 = (0..volume.grid().voxel_count()).map(|i| normalised(&volume, i)).sum();
        let share = sum / volume.grid().voxel_count() as f64;
        assert!((share - (BOX_HI - BOX_LO).powi(3)).abs() < 2e-3, "{dims:?}: {share}");
    }
    let sharp = Phantom::SolidBox.cube(8).unwrap();
    assert_eq!(sharp.range(), (0.0, 255.0));
    assert!((0..512).all(|i| [0.0, 255.0].contains(&sharp.voxels().value(i))));
}

#[test]
fn the_ramp_is_the_texture_coordinate() {
    let volume = Phantom::Ramp.volume([5, 2, 2]).unwrap();
    for (i, expected) in [0.1, 0.3, 0.5, 0.7, 0.9].into_iter().enumerate() {
        assert!((volume.voxels().value(i + 10) - expected).abs() < 1e-6);
    }
}

#[test]
fn cakes_are_as_deep_as_the_papers_and_their_dots_are_alike() {
    // Metres from the middle, and whether a dot is there, of what is no air in a column, z upwards.
    let layers = |phantom: Phantom, [x, y]: [usize; 2]| {
        let volume = phantom.volume([100, 75, 220]).unwrap();
        let value = |z: usize| volume.voxels().value((z * 75 + y) * 100 + x);
        let found = (0..220).filter(|&z| value(z) != 128.0);
        found.map(|z| ((z as f64 + 0.5 - 110.0) * 1e-3, value(z) == 255.0)).collect::<Vec<_>>()
    };
    for ([x, y], deep_m, flat_m) in [([51, 38], 0.1, 0.01), ([70, 38], 0.0, 0.0), ([99, 74], -0.1, -0.01)] {
        for (phantom, expected_m) in [(Phantom::WeddingCake, deep_m), (Phantom::FlatWeddingCake, flat_m)] {
            let found = layers(phantom, [x, y]);
            assert!(!found.is_empty(), "{phantom} {x} {y}");
            assert!(
                found.iter().all(|(z_m, _)| (z_m - expected_m).abs() < 1.6e-3),
                "{phantom} {x} {y}: {found:?}"
            );
        }
    }
    let dot = |phantom: Phantom, at: [usize; 2]| layers(phantom, at)[0].1;
    let middle: Vec<[usize; 2]> = (64..76).step_by(2).map(|x| [x, 38]).collect();
    assert!(middle.iter().all(|&at| dot(Phantom::WeddingCake, at) == dot(Phantom::FlatWeddingCake, at)));
    assert!(middle.iter().any(|&at| dot(Phantom::WeddingCake, at)));
    assert!(middle.iter().any(|&at| !dot(Phantom::WeddingCake, at)));
}

#[test]
fn marschner_lobb_has_its_published_values() {
    assert!((marschner_lobb::value(DVec3::splat(0.5)) - 0.6).abs() < 1e-12, "ρ(0,0,0)");
    assert!((marschner_lobb::value(DVec3::new(0.5, 0.5, 0.0)) - 1.0).abs() < 1e-12, "ρ(0,0,−1)");
    assert!((marschner_lobb::value(DVec3::new(1.0, 0.5, 1.0)) - 0.2).abs() < 1e-12, "ρ(1,0,1)");
    let (lo, hi) = Phantom::MarschnerLobb.cube(41).unwrap().range();
    assert!(lo >= 0.0 && hi <= 1.0);
}

#[test]
fn shepp_logan_has_its_published_grey_levels() {
    let at = |x: f64, y: f64| shepp_logan::value((DVec3::new(x, y, 0.0) + 1.0) / 2.0, DVec3::splat(512.0));
    assert!((at(0.0, 0.897) - 1.0).abs() < 1e-9, "skull");
    assert!((at(0.0, -0.3) - 0.2).abs() < 1e-9, "brain");
    assert!(at(-0.22, 0.0).abs() < 1e-9, "left ventricle");
    assert!((at(0.0, 0.4) - 0.3).abs() < 1e-9, "upper tumour");
    assert_eq!(at(0.9, 0.9), 0.0, "air");
}

/// Reads the dots on a face as a viewer outside sees them: `texture` gives the position of a dot by column from the
/// left and row from the top, both −1…1 over the glyph.
fn read_face(texture: impl Fn(f64, f64) -> DVec3) -> [String; 7] {
    std::array::from_fn(|row| {
        (0..5)
            .map(|column| {
                let (right, down) = ((column as f64 - 2.0) * 0.08, (row as f64 - 3.0) * 0.08);
                if orientation::value(texture(right, down)) == LETTER_VALUE { '#' } else { '.' }
            })
            .collect()
    })
}

#[test]
fn letters_read_upright_and_unmirrored_from_outside() {
    const HEIGHT: f64 = 0.39;
    let c = DVec3::splat(0.5);
    // Seen from the patient's right (+x), the face (+y) is to the right and the head (+z) up.
    let right = read_face(|r, d| c + DVec3::new(HEIGHT, r, -d));
    assert_eq!(right, ["####.", "#...#", "#...#", "####.", "#.#..", "#..#.", "#...#"]);
    let left = read_face(|r, d| c + DVec3::new(-HEIGHT, -r, -d));
    assert_eq!(left, ["#....", "#....", "#....", "#....", "#....", "#....", "#####"]);
    // Seen from the front (+y), the patient's right hand (+x) is to the left.
    let anterior = read_face(|r, d| c + DVec3::new(-r, HEIGHT, -d));
    assert_eq!(anterior, [".###.", "#...#", "#...#", "#####", "#...#", "#...#", "#...#"]);
    let posterior = read_face(|r, d| c + DVec3::new(r, -HEIGHT, -d));
    assert_eq!(posterior, ["####.", "#...#", "#...#", "####.", "#....", "#....", "#...."]);
    // Seen from above with the face (+y) up, the patient's right hand is to the right; from below, to the left.
    let superior = read_face(|r, d| c + DVec3::new(r, -d, HEIGHT));
    assert_eq!(superior, [".####", "#....", "#....", ".###.", "....#", "....#", "####."]);
    let inferior = read_face(|r, d| c + DVec3::new(-r, -d, -HEIGHT));
    assert_eq!(inferior, [".###.", "..#..", "..#..", "..#..", "..#..", "..#..", ".###."]);
}
