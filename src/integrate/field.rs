//! Integrals at many points: what a backend gives, and the same numbers by name where the Fresnel
//! model is Schlick's.

/// The integrals at a sequence of points, those of a point side by side.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    count: usize,
    values: Vec<f64>,
}

impl Field {
    /// Zeros: `count` integrals at each of `points` points.
    pub fn zeros(count: usize, points: usize) -> Self {
        Field { count, values: vec![0.0; count * points] }
    }

    /// These values, `count` for each point.
    pub fn of(count: usize, values: Vec<f64>) -> Self {
        debug_assert!(
            count > 0 && values.len().is_multiple_of(count),
            "{} by {count}",
            values.len()
        );
        Field { count, values }
    }

    /// The number of integrals at a point.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The number of points.
    pub fn len(&self) -> usize {
        self.values.len() / self.count
    }

    /// Whether it has no point.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The integrals at a point.
    #[inline]
    pub fn at(&self, point: usize) -> &[f64] {
        &self.values[point * self.count..][..self.count]
    }

    /// The integrals at each point in turn.
    pub fn iter(&self) -> std::slice::ChunksExact<'_, f64> {
        self.values.chunks_exact(self.count)
    }

    /// All values.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// All values, to be filled.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Scale and bias at each point: the first two integrals, which are all of Schlick's.
    pub fn scale_bias(&self) -> Vec<ScaleBias> {
        let first = |point: &[f64], index: usize| point.get(index).copied().unwrap_or(0.0);
        self.iter().map(|point| ScaleBias { a: first(point, 0), b: first(point, 1) }).collect()
    }
}

/// The integrals of Schlick's weights: E(F0) = F0 · `a` + `b` (Karis 2013).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScaleBias<R = f64> {
    /// A, the scale of F0.
    pub a: R,
    /// B, the bias.
    pub b: R,
}

impl ScaleBias {
    /// The directional albedo at F = 1: E = A + B.
    pub fn e(self) -> f64 {
        self.a + self.b
    }

    /// E(F0) = F0 A + B.
    pub fn at_f0(self, f0: f64) -> f64 {
        f0 * self.a + self.b
    }

    /// A and B in an array.
    pub fn array(self) -> [f64; 2] {
        [self.a, self.b]
    }
}

impl<R> From<[R; 2]> for ScaleBias<R> {
    fn from([a, b]: [R; 2]) -> Self {
        ScaleBias { a, b }
    }
}
