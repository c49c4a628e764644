//! What cells of casts of a head that turns have really taken.

use crate::workload::Model;
use wheatstone_core::budget::CellGrid;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::phantom::Phantom;
use wheatstone_core::reference::{Aids, Caster, Leap, Reads};
use wheatstone_core::scene::{Placement, Settings};
use wheatstone_core::skip::{BlockRanges, BlockSize, Occupancy, SkipMap, Structure, Visibility};
use wheatstone_core::transfer::{OpacityPoint, TransferFunction};
use wheatstone_core::view::{AnatomicalDirection, Frustum, Orbit, Projection, world_from_patient};
use wheatstone_core::volume::{Encoding, StorageKind, Window};

/// Width and height of the casts, pixels.
const SIDE_PX: u32 = 256;

/// Casts all around.
const CASTS: usize = 16;

/// What a ray takes by itself, and a look into the skip map, in samples.
const RAY: f64 = 2.0;
const LOOK: f64 = 0.5;

/// A phantom on a turntable. A cell costs what its rays have read, as the CPU caster counts it.
pub(crate) struct Turntable {
    /// Of each pixel, cast by cast.
    costs: Vec<Vec<f64>>,
    pub(crate) turns_per_s: f64,
}

impl Turntable {
    /// Casts the phantom from all around.
    pub(crate) fn new() -> Self {
        let volume = Phantom::SheppLogan.cube(48).unwrap();
        let up = world_from_patient(volume.grid(), AnatomicalDirection::Superior);
        let points = [(0.05, 0.0), (0.3, 0.03), (1.0, 0.9)].map(|(at, alpha)| OpacityPoint { at, alpha });
        let colors = TransferFunction::ramp(0.0, 1.0).unwrap().color_points().to_vec();
        let transfer = TransferFunction::new(colors, points.to_vec()).unwrap();
        let settings = Settings::new(Window::new(0.0, 255.0).unwrap(), transfer);
        let parameters = CastParameters::new(&settings, &Placement::new(&volume, up));
        let (kind, block) = (StorageKind::lossless_for(&volume), BlockSize::cube(4).unwrap());
        let normalised = Encoding::new(&volume, kind).normalised_from_stored(settings.window);
        let ranges = BlockRanges::of_values(&volume, kind, block);
        let occupancy = Occupancy::new(ranges.normalised(normalised), None, &Visibility::new(&parameters));
        let map = SkipMap::new(&occupancy, Structure::Distance);
        let size = [SIDE_PX; 2];
        let projection = Projection::Perspective(Frustum::from_fov(0.8, size).unwrap());
        let views: Vec<_> = (0..CASTS)
            .map(|cast| {
                let azimuth_rad = std::f64::consts::TAU * cast as f64 / CASTS as f64;
                Orbit { azimuth_rad, elevation_rad: 0.2, distance_m: 1.6 }.view(projection, size)
            })
            .collect();
        let aids = Aids { leap: Leap::EmptyBlocks(&map), ..Aids::default() };
        let cost = |read: &Reads| RAY + f64::from(read.samples) + LOOK * f64::from(read.map_reads);
        let casts = Caster::with_storage(&volume, kind).cast(&parameters, &aids, &views);
        let costs = casts.iter().map(|cast| cast.reads.iter().map(cost).collect()).collect();
        Self { costs, turns_per_s: 0.0 }
    }
}

impl Model for Turntable {
    fn cost(&self, grid: &CellGrid, cell: usize, at_s: f64) -> f64 {
        let rect = grid.rect(cell);
        let scale = grid.size()[0] / SIDE_PX;
        let of_cast = |cast: usize| -> f64 {
            let row = |y: u32| {
                let from = (y * SIDE_PX) as usize;
                let columns = (rect.columns.start / scale) as usize..(rect.columns.end / scale) as usize;
                self.costs[cast % CASTS][from..from + SIDE_PX as usize][columns].iter().sum::<f64>()
            };
            (rect.rows.start / scale..rect.rows.end / scale).map(row).sum()
        };
        let place = CASTS as f64 * self.turns_per_s * at_s;
        let (cast, along) = (place as usize, place.fract());
        (1.0 - along) * of_cast(cast) + along * of_cast(cast + 1)
    }
}
