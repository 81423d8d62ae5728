//! Symmetric positive definite systems whose matrix has a band: Cholesky's factorisation.

/// The lower triangle of a symmetric matrix, row by row: of row i the entries from column i - band
/// to i.
#[derive(Clone, Debug)]
pub struct Banded {
    band: usize,
    rows: Vec<f64>,
}

/// Σ a b, eight terms at a time: a sum in order has no vector instructions.
#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
    let mut sums = [0.0; 8];
    for (a, b) in a.zip(b) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    sums.iter().sum::<f64>() + rest
}

impl Banded {
    /// Zeros.
    pub fn zeros(size: usize, band: usize) -> Self {
        let band = band.min(size.saturating_sub(1));
        Banded { band, rows: vec![0.0; size * (band + 1)] }
    }

    /// The number of rows.
    fn size(&self) -> usize {
        self.rows.len() / (self.band + 1)
    }

    /// Adds to the entry in this row and a column not after it, within the band.
    #[inline(always)]
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        debug_assert!(column <= row && row - column <= self.band, "{row}, {column}");
        self.rows[row * (self.band + 1) + self.band + column - row] += value;
    }

    /// Adds to the entries of a row from its first column within the band to its own; those of a
    /// matrix without a band are all of them.
    #[inline(always)]
    pub fn add_row(&mut self, row: usize, factor: f64, values: &[f64]) {
        let first = row.saturating_sub(self.band);
        let width = self.band + 1;
        let entries = &mut self.rows[row * width + self.band + first - row..(row + 1) * width];
        for (entry, value) in entries.iter_mut().zip(&values[first..=row]) {
            *entry += factor * value;
        }
    }

    /// Adds `share` of the largest entry to the diagonal, so that functions that no point sees stay
    /// at rest.
    #[inline(always)]
    pub fn regularise(&mut self, share: f64) {
        let width = self.band + 1;
        let diagonal = || self.rows.iter().skip(width - 1).step_by(width);
        let added = share * diagonal().copied().fold(f64::MIN_POSITIVE, f64::max);
        self.rows.iter_mut().skip(width - 1).step_by(width).for_each(|entry| *entry += added);
    }

    /// Solves for this right side, which becomes the solution. None where the matrix is not
    /// positive definite.
    #[inline(always)]
    pub fn solve(mut self, side: &mut [f64]) -> Option<()> {
        self.factorise()?;
        self.substitute(side);
        Some(())
    }

    /// Solves for a right side, where the matrix has been factorised.
    #[inline(always)]
    pub fn substitute(&self, side: &mut [f64]) {
        let (width, size) = (self.band + 1, self.size());
        let row = |i: usize| &self.rows[i * width..(i + 1) * width];
        for i in 0..size {
            let first = i.saturating_sub(self.band);
            let known = &row(i)[self.band + first - i..self.band];
            let sum = dot(known, &side[first..i]);
            side[i] = (side[i] - sum) / row(i)[self.band];
        }
        for i in (0..size).rev() {
            side[i] /= row(i)[self.band];
            let first = i.saturating_sub(self.band);
            let (value, entries) = (side[i], &row(i)[self.band + first - i..self.band]);
            for (before, entry) in side[first..i].iter_mut().zip(entries) {
                *before -= entry * value;
            }
        }
    }

    /// Replaces the matrix by its factor L of L Lᵀ. None where it is not positive definite.
    #[inline(always)]
    pub fn factorise(&mut self) -> Option<()> {
        let (band, width) = (self.band, self.band + 1);
        for i in 0..self.size() {
            let first = i.saturating_sub(band);
            let (before, own) = self.rows.split_at_mut(i * width);
            let own = &mut own[..width];
            for j in first..=i {
                // Columns that both rows have.
                let start = first.max(j.saturating_sub(band));
                let mine = &own[band + start - i..band + j - i];
                let sum = if j == i {
                    dot(mine, mine)
                } else {
                    dot(mine, &before[j * width + band + start - j..j * width + band])
                };
                let rest = own[band + j - i] - sum;
                own[band + j - i] = if j == i {
                    if rest.is_nan() || rest <= 0.0 {
                        return None;
                    }
                    rest.sqrt()
                } else {
                    rest / before[j * width + band]
                };
            }
        }
        Some(())
    }
}
