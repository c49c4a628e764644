//! What the cells of a picture take of casting it.

use crate::backend::{Engine, Shot};
use crate::failure::Failure;
use wheatstone_core::budget::CellGrid;
use wheatstone_core::view::View;

/// Cells along the longer side of a picture: some hundreds in all, so that a refresh holds many of a view that takes several.
const CELLS_PER_SIDE: u32 = 24;

/// Sides of cells are multiples of this, pixels: workgroups stay whole.
const CELL_STEP_PX: u32 = 8;

/// The cells of a picture, and which share of its cast each of them takes.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    pub(super) grid: CellGrid,
    shares: Vec<f64>,
}

impl Cells {
    /// Those of a view: a cell takes as long as it has samples, and as many more as it has rays.
    pub(super) fn of(engine: &mut Engine<'_>, shot: Shot, view: &View) -> Result<Self, Failure> {
        let grid = grid(view.size)?;
        let works = (0..grid.cells())
            .map(|cell| {
                let part = view.part(&grid.rect(cell));
                engine.cast(shot, &[part])?;
                let rays = f64::from(part.size[0]) * f64::from(part.size[1]);
                Ok(engine.read()?[0].samples as f64 + rays)
            })
            .collect::<Result<Vec<_>, Failure>>()?;
        Ok(Self::with_works(grid, &works))
    }

    fn with_works(grid: CellGrid, works: &[f64]) -> Self {
        let all: f64 = works.iter().sum();
        Self { grid, shares: works.iter().map(|work| work / all).collect() }
    }

    /// The share of a cell; all of them are 1.
    pub(super) fn share(&self, cell: usize) -> f64 {
        self.shares[cell]
    }
}

fn grid(size: [u32; 2]) -> Result<CellGrid, Failure> {
    let cell_side_px = size[0].max(size[1]).div_ceil(CELLS_PER_SIDE).next_multiple_of(CELL_STEP_PX);
    CellGrid::new(size, cell_side_px).map_err(Failure::input)
}

#[cfg(test)]
impl Cells {
    /// Those of a picture of a size, in which the work of a cell grows with its number.
    pub(super) fn growing(size: [u32; 2]) -> Self {
        let grid = grid(size).unwrap();
        let works: Vec<f64> = (0..grid.cells()).map(|cell| 1.0 + cell as f64).collect();
        Self::with_works(grid, &works)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Up;
    use crate::skipping::Skipping;
    use wheatstone_core::cast::CastParameters;
    use wheatstone_core::phantom::Phantom;
    use wheatstone_core::scene::{Placement, Settings};
    use wheatstone_core::transfer::TransferFunction;
    use wheatstone_core::view::{Frustum, Orbit, Projection, world_from_patient};
    use wheatstone_core::volume::StorageKind;

    #[test]
    fn cells_take_all_of_a_cast_and_those_that_see_nothing_little() {
        let volume = Phantom::SheppLogan.cube(24).unwrap();
        let placement = Placement::new(&volume, world_from_patient(volume.grid(), Up::S.direction()));
        let settings = Settings::new(volume.full_window(), TransferFunction::ramp(0.2, 1.0).unwrap());
        let mut engine = Engine::cpu(&volume, StorageKind::lossless_for(&volume));
        let shot = engine.prepare(&CastParameters::new(&settings, &placement), &Skipping::AUTO).unwrap();
        let size = [96, 64];
        let frustum = Frustum::from_fov(1.2, size).unwrap();
        let view = Orbit { distance_m: 2.0, ..Orbit::default() }.view(Projection::Perspective(frustum), size);
        let cells = Cells::of(&mut engine, shot, &view).unwrap();
        let [columns, rows] = cells.grid.dims();
        let shares: Vec<f64> = (0..cells.grid.cells()).map(|cell| cells.share(cell)).collect();
        assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        assert!(shares[columns * (rows / 2) + columns / 2] > 5.0 * shares[0], "{shares:?}");
        engine.cast(shot, &[view]).unwrap();
        let whole = engine.read().unwrap()[0].samples as f64;
        let rays = f64::from(size[0] * size[1]);
        let of_corner = 64.0 / (whole + rays);
        assert!((shares[0] - of_corner).abs() < 0.01 * of_corner, "{} {of_corner}", shares[0]);
    }
}
