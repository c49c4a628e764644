//! The bound that structures of empty-space skipping are measured against.

use crate::scene::*;
use glam::DVec3;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::reference::{Aids, Caster, Leap, Reads};
use wheatstone_core::scene::{Placement, Settings};
use wheatstone_core::skip::{BlockRanges, BlockSize, Occupancy, SkipMap, Structure, Visibility};
use wheatstone_core::volume::{Encoding, StorageKind, Volume};

const SIZE: [u32; 2] = [5, 5];

/// Slabs of four voxels after four and after twelve of 24; a faint slab shows the others behind it.
fn slabs(alpha: f32) -> (Volume, Settings) {
    let volume = volume_of([8, 8, 24], [1.0; 3], |p| f64::from([1, 3].contains(&(p.z as u32 / 4))));
    let transfer = white_transfer(&[(0.6, 0.0), (0.6, alpha)]);
    (volume, exact_settings(unit_window(), transfer))
}

fn read(alpha: f32) -> Reads {
    let (volume, settings) = slabs(alpha);
    let along_z = look(DVec3::Z, DVec3::ZERO, DVec3::Y, orthographic(0.05, SIZE), SIZE);
    let parameters = CastParameters::new(&settings, &Placement::new(&volume, world_from_patient()));
    let cast = Caster::new(&volume).cast_by_oracle(&parameters, None, &along_z);
    assert!(cast.reads.iter().all(|ray| *ray == cast.reads[0]), "all rays go through the same slabs");
    cast.reads[0]
}

#[test]
fn visible_samples_and_runs_of_invisible_ones_are_counted() {
    assert_eq!(read(0.3), Reads { samples: 8, map_reads: 3 });
    assert_eq!(read(0.0), Reads { samples: 0, map_reads: 1 });
}

#[test]
fn rays_end_where_nothing_shines_through() {
    assert_eq!(read(1.0), Reads { samples: 1, map_reads: 1 });
}

#[test]
fn no_structure_reads_less() {
    let (volume, settings) = slabs(0.3);
    let parameters = CastParameters::new(&settings, &Placement::new(&volume, world_from_patient()));
    let view = look(DVec3::new(0.2, 0.15, 0.4), DVec3::ZERO, DVec3::Y, perspective(0.8, SIZE), SIZE);
    let caster = Caster::new(&volume);
    let least = caster.cast_by_oracle(&parameters, None, &view);
    let encoding = Encoding::new(&volume, StorageKind::F32);
    let normalised_from_stored = encoding.normalised_from_stored(settings.window);
    for structure in [Structure::Occupancy, Structure::Distance, Structure::Anisotropic] {
        let ranges = BlockRanges::of_values(&volume, StorageKind::F32, BlockSize::cube(2).unwrap());
        let occupancy =
            Occupancy::new(ranges.normalised(normalised_from_stored), None, &Visibility::new(&parameters));
        let map = SkipMap::new(&occupancy, structure);
        let cast = caster.cast_exactly(&parameters, &Leap::EmptyBlocks(&map).into(), &[view]).remove(0);
        assert!(cast.samples >= least.samples && cast.map_reads >= least.map_reads, "{structure:?}");
        assert!(
            cast.samples < caster.cast_exactly(&parameters, &Aids::default(), &[view])[0].samples,
            "{structure:?}"
        );
    }
}
