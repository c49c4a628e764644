//! Numbers and lists in the text headers of NRRD and MetaImage.

use crate::ReadError;
use std::str::FromStr;

/// The field as one number.
pub(crate) fn number<T: FromStr>(
    field: &'static str,
    text: &str,
    expected: &'static str,
) -> Result<T, ReadError> {
    text.trim().parse().map_err(|_| ReadError::bad_field(field, text, expected))
}

/// The field as numbers between white space; exactly `count` of them.
pub(crate) fn numbers<T: FromStr>(
    field: &'static str,
    text: &str,
    count: usize,
    expected: &'static str,
) -> Result<Vec<T>, ReadError> {
    let bad = || ReadError::bad_field(field, text, expected);
    let numbers: Vec<T> =
        text.split_whitespace().map(|word| word.parse().map_err(|_| bad())).collect::<Result<_, _>>()?;
    if numbers.len() == count { Ok(numbers) } else { Err(bad()) }
}

/// Sizes of axes, each at least 1.
pub(crate) fn sizes(field: &'static str, text: &str, count: usize) -> Result<Vec<u64>, ReadError> {
    let values: Vec<i64> = numbers(field, text, count, "one whole number for each dimension")?;
    let size = |(axis, value): (usize, i64)| match u64::try_from(value) {
        Ok(size) if size > 0 => Ok(size),
        _ => Err(ReadError::BadDimension { field, axis: axis + 1, value }),
    };
    values.into_iter().enumerate().map(size).collect()
}
