//! The largest value of a function of two variables near places that are known: a climb from each.

/// A place between its neighbours along either axis, and the value there.
#[derive(Clone, Copy, Debug)]
pub struct Climber {
    /// The first variable.
    pub x: [f64; 3],
    /// The second.
    pub y: [f64; 3],
    /// The value in the middle.
    pub value: f64,
}

impl Climber {
    /// At the place with these numbers among those of a grid; `first`: the first that may be
    /// reached.
    pub fn at(
        [xs, ys]: [&[f64]; 2],
        [i, j]: [usize; 2],
        [first_x, first_y]: [usize; 2],
        value: f64,
    ) -> Self {
        Climber { x: around(xs, i, first_x), y: around(ys, j, first_y), value }
    }
}

/// The highest climbers after so many steps, each to the highest of nine places half as far apart;
/// `values`: those at some places.
pub fn climb<E>(
    mut climbers: Vec<Climber>,
    count: usize,
    steps: usize,
    values: impl Fn(&[(f64, f64)]) -> Result<Vec<f64>, E>,
) -> Result<Vec<Climber>, E> {
    climbers.sort_by(|a, b| b.value.total_cmp(&a.value));
    climbers.truncate(count);
    for _ in 0..steps {
        let places: Vec<(f64, f64)> = climbers.iter().flat_map(nine).collect();
        let values = values(&places)?;
        for (climber, values) in climbers.iter_mut().zip(values.chunks_exact(9)) {
            step(climber, values);
        }
    }
    climbers.sort_by(|a, b| b.value.total_cmp(&a.value));
    Ok(climbers)
}

/// The nine places about a climber, x varying fastest.
fn nine(climber: &Climber) -> impl Iterator<Item = (f64, f64)> + use<> {
    let (xs, ys) = (halved(climber.x), halved(climber.y));
    (0..9).map(move |place| (xs[place % 3 + 1], ys[place / 3 + 1]))
}

fn step(climber: &mut Climber, values: &[f64]) {
    let (xs, ys) = (halved(climber.x), halved(climber.y));
    // The middle of the nine, where the climber stands.
    let (mut i, mut j) = (1, 1);
    for (place, &value) in values.iter().enumerate() {
        if value > climber.value {
            (i, j, climber.value) = (place % 3, place / 3, value);
        }
    }
    climber.x = [xs[i], xs[i + 1], xs[i + 2]];
    climber.y = [ys[j], ys[j + 1], ys[j + 2]];
}

/// A place between its neighbours, the first of which may be reached.
fn around(places: &[f64], i: usize, first: usize) -> [f64; 3] {
    [places[i.saturating_sub(1).max(first)], places[i], places[(i + 1).min(places.len() - 1)]]
}

/// Three places with the middles between them: in proportion where they are far apart, as towards 0
/// on an axis that is crowded there.
fn halved([low, at, high]: [f64; 3]) -> [f64; 5] {
    let middle =
        |a: f64, b: f64| if a > 0.0 && b > 2.0 * a { (a * b).sqrt() } else { 0.5 * (a + b) };
    [low, middle(low, at), at, middle(at, high), high]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The summit of a paraboloid off every node of the grid.
    #[test]
    fn a_summit_is_reached() {
        let top = |x: f64, y: f64| 3.0 - (x - 0.3217).powi(2) - 2.0 * (y - 0.7331).powi(2);
        let values = |places: &[(f64, f64)]| {
            Ok::<_, ()>(places.iter().map(|&(x, y)| top(x, y)).collect::<Vec<_>>())
        };
        let nodes: Vec<f64> = (0..=8).map(|k| f64::from(k) / 8.0).collect();
        let start = |k: usize| {
            let (i, j) = (k % 9, k / 9);
            Climber::at([&nodes, &nodes], [i, j], [0, 0], top(nodes[i], nodes[j]))
        };
        let climbers = climb((0..81).map(start).collect(), 4, 20, values);
        // Twenty halvings of 1/8 are 1e-7, whose square is lost beside 3.
        assert!(climbers.is_ok_and(|climbers| (climbers[0].value - 3.0).abs() < 1e-12));
    }
}
