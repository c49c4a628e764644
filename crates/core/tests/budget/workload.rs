//! What cells of a moving picture cost.

use wheatstone_core::budget::CellGrid;

/// Share by which a cell's cost differs from one cast to the next.
const NOISE: f64 = 0.3;

/// How cells' costs compare with each other.
pub(crate) trait Model {
    /// Of a cell of a picture as of a time in seconds, in any unit.
    fn cost(&self, grid: &CellGrid, cell: usize, at_s: f64) -> f64;
}

/// Costs of a model that add up to a view's, and scatter.
pub(crate) struct Workload<'m> {
    grid: CellGrid,
    model: &'m dyn Model,
    seconds_per_cost: f64,
    random: u64,
    /// In what share of batches, and for how long, seconds.
    interruptions: (f64, f64),
}

impl<'m> Workload<'m> {
    /// The whole picture costs `view_s` seconds at time 0, before noise.
    pub(crate) fn new(grid: CellGrid, view_s: f64, model: &'m dyn Model, seed: u64) -> Self {
        let mut workload =
            Self { grid, model, seconds_per_cost: 1.0, random: seed, interruptions: (0.0, 0.0) };
        workload.seconds_per_cost = view_s / workload.costs_s(0.0).iter().sum::<f64>();
        workload
    }

    pub(crate) fn grid(&self) -> CellGrid {
        self.grid
    }

    /// Costs without noise of all cells of a picture as of a time, seconds.
    pub(crate) fn costs_s(&self, at_s: f64) -> Vec<f64> {
        let cost_s = |cell| self.seconds_per_cost * self.model.cost(&self.grid, cell, at_s);
        (0..self.grid.cells()).map(cost_s).collect()
    }

    /// The same on a device that another program takes away during a share of batches, for so long.
    pub(crate) fn interrupted(self, share: f64, seconds: f64) -> Self {
        Self { interruptions: (share, seconds), ..self }
    }

    /// A factor about 1, different each time.
    pub(crate) fn noise(&mut self) -> f64 {
        1.0 + NOISE * (2.0 * self.unit() - 1.0)
    }

    /// What cells take one after the other that would take so long, seconds.
    pub(crate) fn batch_s(&mut self, costs_s: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut batch_s: Vec<f64> = costs_s.map(|cost_s| cost_s * self.noise()).collect();
        let (share, seconds) = self.interruptions;
        if share > 0.0 && self.unit() < share {
            let when = (self.unit() * batch_s.len() as f64) as usize;
            batch_s[when] += seconds;
        }
        batch_s
    }

    /// From 0 to 1, different each time.
    fn unit(&mut self) -> f64 {
        // SplitMix64.
        self.random = self.random.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.random;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Balls that move through a picture. A cell costs a little by itself and the chords of its rays through the balls.
pub(crate) struct Balls {
    /// Picture heights that the balls move through in a second.
    pub(crate) speed: f64,
}

/// Rays of a cell along either axis.
const PROBES: usize = 4;

impl Model for Balls {
    fn cost(&self, grid: &CellGrid, cell: usize, at_s: f64) -> f64 {
        let [columns, rows] = grid.dims();
        let phase = self.speed * at_s;
        // Centre x, y and radius in picture heights.
        let balls = [
            [0.2 * (1.7 * phase).sin(), 0.15 * (1.1 * phase).cos(), 0.33],
            [0.3 * phase.cos(), 0.3 * phase.sin(), 0.12],
            [-0.35 * (0.8 * phase).cos(), 0.25, 0.1],
        ];
        let probe = |at: usize, count: usize, i: usize| {
            (at as f64 + (i as f64 + 0.5) / PROBES as f64 - 0.5 * count as f64) / rows as f64
        };
        let mut sum = 0.0;
        for (i, j) in (0..PROBES).flat_map(|j| (0..PROBES).map(move |i| (i, j))) {
            let [x, y] = [probe(cell % columns, columns, i), probe(cell / columns, rows, j)];
            for [ball_x, ball_y, radius] in balls {
                let off = ((x - ball_x).powi(2) + (y - ball_y).powi(2)) / (radius * radius);
                sum += radius * (1.0 - off).max(0.0).sqrt();
            }
        }
        0.03 + sum / (PROBES * PROBES) as f64
    }
}
