//! Chebyshev polynomials on the range of a coordinate: polynomials are fitted in them, since their
//! system is well conditioned, and given out in powers.

use crate::approximation::{Region, Shape};

/// Products T_i(x) T_j(y), i varying fastest, with x and y from -1 to 1 over the region.
#[derive(Clone, Debug)]
pub struct Chebyshev {
    shape: Shape,
    region: Region,
    /// Centre and half width of each range.
    ranges: [(f64, f64); 2],
    columns: usize,
    rows: usize,
}

/// T_0 to T_(count - 1) at x (Rivlin 1974).
fn values(count: usize, x: f64) -> Vec<f64> {
    let mut values = vec![1.0; count];
    if count > 1 {
        values[1] = x;
    }
    for i in 2..count {
        values[i] = 2.0 * x * values[i - 1] - values[i - 2];
    }
    values
}

/// The coefficients of a series of Chebyshev polynomials of (x - centre)/half in powers of x.
fn powers(series: &[f64], (centre, half): (f64, f64)) -> Vec<f64> {
    let count = series.len();
    // T_(i-1) and T_i in powers.
    let (mut before, mut now) = (vec![0.0; count], vec![0.0; count]);
    let mut sum = vec![0.0; count];
    for (i, factor) in series.iter().enumerate() {
        match i {
            0 => now[0] = 1.0,
            1 => {
                before.clone_from(&now);
                now = times(&now, (centre, half));
            }
            _ => {
                let next: Vec<f64> = times(&now, (centre, half))
                    .iter()
                    .zip(&before)
                    .map(|(next, before)| 2.0 * next - before)
                    .collect();
                before = std::mem::replace(&mut now, next);
            }
        }
        sum.iter_mut().zip(&now).for_each(|(sum, power)| *sum += factor * power);
    }
    sum
}

/// A polynomial times (x - centre)/half.
fn times(polynomial: &[f64], (centre, half): (f64, f64)) -> Vec<f64> {
    (0..polynomial.len())
        .map(|i| {
            let lower = if i == 0 { 0.0 } else { polynomial[i - 1] };
            (lower - centre * polynomial[i]) / half
        })
        .collect()
}

/// Centre and half width.
fn range(first: f64, last: f64) -> (f64, f64) {
    (0.5 * (first + last), 0.5 * (last - first))
}

impl Chebyshev {
    /// The functions of a polynomial with `count` numbers in a region.
    pub fn of(shape: &Shape, region: &Region, count: usize) -> Self {
        let columns = if let Shape::Surface { columns, .. } = *shape { columns } else { count };
        let [low, high] = region.roughness;
        // A coordinate along n·v is least at the roughest end.
        let [x, y] = shape.coordinates::<f64>(region, region.least_nov, high);
        let [last_x, _] = shape.coordinates::<f64>(region, 1.0, high);
        let [_, first_y] = shape.coordinates::<f64>(region, 1.0, low);
        Chebyshev {
            shape: *shape,
            region: *region,
            ranges: [range(x, last_x), range(first_y, y)],
            columns,
            rows: count.div_ceil(columns.max(1)),
        }
    }

    /// The functions at a place.
    pub fn at(&self, nov: f64, roughness: f64) -> Vec<f64> {
        let place = |value: f64, (centre, half): (f64, f64)| (value - centre) / half;
        let [x, y] = self.shape.coordinates(&self.region, nov, roughness);
        let along = values(self.columns, place(x, self.ranges[0]));
        if self.rows == 1 {
            return along;
        }
        let across = values(self.rows, place(y, self.ranges[1]));
        across.iter().flat_map(|row| along.iter().map(move |column| row * column)).collect()
    }

    /// The numbers of the shape: factors of powers.
    pub fn in_powers(&self, series: &[f64]) -> Vec<f64> {
        if self.rows == 1 {
            return powers(series, self.ranges[0]);
        }
        // Along x in each row, then across y in each column.
        let rows: Vec<Vec<f64>> =
            series.chunks(self.columns).map(|row| powers(row, self.ranges[0])).collect();
        let mut numbers = vec![0.0; series.len()];
        for i in 0..self.columns {
            let column: Vec<f64> = rows.iter().map(|row| row[i]).collect();
            for (j, number) in powers(&column, self.ranges[1]).into_iter().enumerate() {
                numbers[j * self.columns + i] = number;
            }
        }
        numbers
    }
}
