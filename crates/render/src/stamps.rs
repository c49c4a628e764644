//! Timestamps of passes.

/// Which queries of a set a pass, or a row of them, writes the time into.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stamps<'a> {
    set: Option<&'a wgpu::QuerySet>,
    begin: Option<u32>,
    end: Option<u32>,
}

impl<'a> Stamps<'a> {
    /// Nothing is timed.
    pub(crate) const NONE: Self = Self { set: None, begin: None, end: None };

    pub(crate) fn new(set: &'a wgpu::QuerySet, begin: Option<u32>, end: Option<u32>) -> Self {
        Self { set: Some(set), begin, end }
    }

    /// Those of the first pass of a row.
    pub(crate) fn of_first(self) -> Self {
        Self { end: None, ..self }
    }

    /// Those of the last pass of a row.
    pub(crate) fn of_last(self) -> Self {
        Self { begin: None, ..self }
    }

    pub(crate) fn writes(self) -> Option<wgpu::ComputePassTimestampWrites<'a>> {
        let query_set = self.set.filter(|_| self.begin.is_some() || self.end.is_some())?;
        Some(wgpu::ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: self.begin,
            end_of_pass_write_index: self.end,
        })
    }
}
