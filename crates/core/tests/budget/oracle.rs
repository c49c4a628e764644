//! A scheduler that knows what cells will take.

/// How many of the next cells fit, at least one, by their true costs in seconds.
pub(crate) fn fitting(costs_s: &[f64], available_s: f64) -> usize {
    let mut sum_s = 0.0;
    let fits = |cost_s: &&f64| {
        sum_s += **cost_s;
        sum_s <= available_s
    };
    costs_s.iter().take_while(fits).count().max(1)
}
