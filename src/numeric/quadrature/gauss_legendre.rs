//! Gauss-Legendre quadrature on [0, 1]: n nodes, exact for polynomials of degree 2n-1.

use std::f64::consts::PI;
use std::sync::OnceLock;

/// One node of a rule on [0, 1] and its weight; the weights of a rule add up to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// The position, strictly between 0 and 1.
    pub at: f64,
    /// The weight of the value there.
    pub weight: f64,
}

/// Rules of so many nodes and fewer are worked out once: averages ask for theirs row by row.
const MOST_KEPT: usize = 256;

/// The rule with `n` nodes, in ascending order.
pub fn gauss_legendre(n: usize) -> Vec<Node> {
    static RULES: [OnceLock<Vec<Node>>; MOST_KEPT + 1] = [const { OnceLock::new() }; MOST_KEPT + 1];
    match RULES.get(n) {
        Some(kept) => kept.get_or_init(|| work_out(n)).clone(),
        None => work_out(n),
    }
}

/// Newton's iteration on the Legendre polynomial P_n from Tricomi's estimate of its roots; the
/// weights are 2 / ((1-x²) P_n'(x)²), halved for the unit interval (Abramowitz and Stegun,
/// 25.4.29).
fn work_out(n: usize) -> Vec<Node> {
    debug_assert!((1..=1_000_000).contains(&n), "{n}");
    let mut nodes = vec![Node { at: 0.5, weight: 0.0 }; n];
    for i in 0..n.div_ceil(2) {
        let mut x = libm::cos(PI * (i as f64 + 0.75) / (n as f64 + 0.5));
        // Newton's convergence is quadratic from this start: the step after one this small is below
        // rounding. For every n up to 1e6 it takes three at the most.
        for _ in 0..5 {
            let (p, slope) = legendre(n, x);
            let step = p / slope;
            x -= step;
            if step.abs() < 1e-11 {
                break;
            }
        }
        if 2 * i + 1 == n {
            x = 0.0;
        }
        let slope = legendre(n, x).1;
        let weight = 1.0 / ((1.0 - x) * (1.0 + x) * slope * slope);
        nodes[i] = Node { at: 0.5 * (1.0 - x), weight };
        nodes[n - 1 - i] = Node { at: 0.5 * (1.0 + x), weight };
    }
    nodes
}

/// The positive half of the rule with `2n` nodes on [-1, 1]: for even functions, integrated over
/// [0, 1], it is as good as one with twice its nodes.
pub fn half_gauss(n: usize) -> Vec<Node> {
    let whole = gauss_legendre(2 * n);
    whole[n..]
        .iter()
        .map(|node| Node { at: 2.0 * node.at - 1.0, weight: 2.0 * node.weight })
        .collect()
}

/// Nodes for the same integral after u → u²: crowded at 0.
pub fn crowded(nodes: Vec<Node>) -> Vec<Node> {
    let crowd = |Node { at, weight }| Node { at: at * at, weight: 2.0 * at * weight };
    nodes.into_iter().map(crowd).collect()
}

/// The same after u → 1 - (1-u)²: crowded at 1.
pub fn crowded_at_end(nodes: Vec<Node>) -> Vec<Node> {
    let crowd =
        |Node { at, weight }| Node { at: at * (2.0 - at), weight: 2.0 * (1.0 - at) * weight };
    nodes.into_iter().map(crowd).collect()
}

/// The same after u → u² (3 - 2u): crowded at both ends.
pub fn crowded_at_both_ends(nodes: Vec<Node>) -> Vec<Node> {
    let crowd = |Node { at, weight }| Node {
        at: at * at * (3.0 - 2.0 * at),
        weight: 6.0 * at * (1.0 - at) * weight,
    };
    nodes.into_iter().map(crowd).collect()
}

/// P_n(x) and P_n'(x) by the three-term recurrence (Abramowitz and Stegun, 22.7.10 and 22.8.5).
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut p) = (0.0, 1.0);
    for k in 1..=n {
        let k = k as f64;
        (previous, p) = (p, ((2.0 * k - 1.0) * x * p - (k - 1.0) * previous) / k);
    }
    (p, n as f64 * (previous - x * p) / ((1.0 - x) * (1.0 + x)))
}
