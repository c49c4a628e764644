//! What a refresh did.

/// What [`LiveView::refresh`](super::LiveView::refresh) did.
#[derive(Debug, Clone, PartialEq)]
pub struct Refresh {
    /// What was handed to the device.
    pub activity: Activity,
    /// What the cells of an earlier refresh took, if that has become known.
    pub measured: Option<Measured>,
}

/// What casting does during a refresh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Activity {
    /// Nothing: the front picture is what is wanted, at full quality.
    Resting,
    /// Nothing yet: the front picture shows what is wanted, but coarsely, for it has just moved. At rest it is refined.
    Waiting,
    /// Nothing: the device has not finished what earlier refreshes gave it.
    Busy,
    /// Cells were handed over.
    Casting {
        /// How many were begun or gone on with.
        cells: usize,
        /// Whether these complete the picture, which is now the front picture.
        completes_view: bool,
    },
}

/// What the cells of a refresh took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// Time that there was, seconds.
    pub budget_s: f64,
    /// Time that they took, seconds.
    pub cast_s: f64,
    /// Whether nothing was known to foretell it by: the first cells of a volume.
    pub is_first: bool,
}

impl Measured {
    /// Whether the refresh was late.
    pub fn is_missed(&self) -> bool {
        self.cast_s > self.budget_s
    }
}
