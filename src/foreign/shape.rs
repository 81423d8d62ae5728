//! The size of a table, bounded before anything is allocated.

use super::{MOST_VALUES, Read, refuse};
use crate::format::texels::NAMES;
use crate::table::axis::LARGEST_SIZE;

/// The most components of a texel.
pub const MOST_COMPONENTS: usize = 4;

/// The number of values of a table; an error where it has none, or too many.
pub fn count(size: [usize; 3], components: usize) -> Read<usize> {
    let [columns, rows, slices] = size;
    let texels = format!("{columns} x {rows} x {slices} texels of {components} numbers");
    if !(1..=MOST_COMPONENTS).contains(&components) {
        return refuse(format!("texels of 1 to {MOST_COMPONENTS} numbers"), texels);
    }
    if size.iter().any(|&side| side == 0 || side > LARGEST_SIZE) {
        return refuse(format!("sides of 1 to {LARGEST_SIZE}"), texels);
    }
    // Three sides of 2^14 and four components are 2^44: no overflow.
    let count = columns as u64 * rows as u64 * slices as u64 * components as u64;
    match usize::try_from(count) {
        Ok(count) if count <= MOST_VALUES => Ok(count),
        _ => refuse(format!("at most {MOST_VALUES} numbers"), texels),
    }
}

/// The names of so many components.
pub fn names(components: usize) -> Vec<String> {
    NAMES.iter().take(components).map(|&name| name.into()).collect()
}
