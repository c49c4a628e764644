//! What to cast before a refresh.

/// Cells to cast before the next refresh, in this order.
#[derive(Debug, Clone, PartialEq)]
pub struct Batch {
    pub(super) view: u64,
    pub(super) cells: Vec<usize>,
    pub(super) expected_s: f64,
    pub(super) variance_s2: f64,
    pub(super) completes_view: bool,
}

impl Batch {
    /// Number of the view that the cells belong to; views are counted from 0 as they begin.
    pub fn view(&self) -> u64 {
        self.view
    }

    /// The cells, by their index in the view's grid.
    pub fn cells(&self) -> &[usize] {
        &self.cells
    }

    /// What they are expected to take, seconds; infinite if nothing is known yet.
    pub fn expected_s(&self) -> f64 {
        self.expected_s
    }

    /// Whether these are the last cells of their view: front and back targets are swapped after them.
    pub fn completes_view(&self) -> bool {
        self.completes_view
    }
}
