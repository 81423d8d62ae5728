//! Polynomials in n·v for constant roughnesses: for each piece the one with the fewest numbers.

use super::{Choice, MOST_POWERS, Search, Trial, Verdict};
use crate::approximation::{Along, Approximation, Channels, Region, Shape};
use crate::planner::candidate::{ALONG, Candidate, channels};
use crate::planner::cost::Cost;
use crate::planner::domain::Piece;
use crate::planner::samples::{Sample, Spread, samples};
use crate::planner::verify::{self, Worst};
use rayon::prelude::*;

/// Samples of a polynomial.
const ALONG_A_LINE: [Spread; 2] = [Spread::Crowded(97), Spread::Crowded(1)];

/// The search for a polynomial of one kind.
struct Line<'a> {
    search: &'a Search<'a>,
    region: Region,
    f0: [f64; 2],
    points: Vec<Sample>,
    /// Where numbers are verified.
    places: Vec<Sample>,
    trials: Vec<Trial>,
    best: Option<(Approximation, Worst, Cost)>,
}

impl Line<'_> {
    /// Whether candidates that differ in storage are proved to fail.
    fn fails(&mut self, same: &[Candidate]) -> bool {
        let problem = self.search.problem(&same[0], self.region, self.f0, &self.points);
        // Numbers that meet the tolerance end it.
        let Some(fit) = self.search.fit(&problem, 1.0) else { return false };
        let failing = self.search.failing(same, self.region, self.f0, &fit);
        let fails = !failing.is_empty();
        self.trials.extend(failing);
        fails
    }

    /// Tries candidates that differ in storage, where they cost less than the best so far.
    fn attempt(&mut self, same: &[Candidate]) {
        let cost = |candidate: &Candidate| Cost::of(candidate, &self.region);
        let cheaper = same.iter().filter(|candidate| !self.is_beaten(cost(candidate)));
        let same: Vec<Candidate> = cheaper.copied().collect();
        let places = || self.places.clone();
        let tried = self.search.attempt(&same, self.region, self.f0, &self.points, places);
        for (trial, approximation) in tried {
            if let (Verdict::Passes(worst), Some(approximation)) = (&trial.verdict, approximation) {
                self.best = Some((approximation, *worst, trial.cost));
            }
            self.trials.push(trial);
        }
    }

    /// Whether the best so far costs no more than any of these.
    fn is_done(&self, same: &[Candidate]) -> bool {
        same.iter().all(|candidate| self.is_beaten(Cost::of(candidate, &self.region)))
    }

    /// Whether the best so far costs no more than this.
    fn is_beaten(&self, cost: Cost) -> bool {
        let weights = &self.search.task.weights;
        let best = self.best.as_ref();
        best.is_some_and(|(_, _, least)| least.weighed(weights) <= cost.weighed(weights))
    }
}

impl Search<'_> {
    /// A polynomial in n·v for each piece, where all have one.
    pub(super) fn lines(&self, trials: &mut Vec<Trial>) -> Option<Choice> {
        let of_piece = |piece: &Piece| self.line(piece);
        let found: Vec<_> = self.task.domain.pieces.par_iter().map(of_piece).collect();
        let mut choice = Vec::new();
        let mut cost = Cost::default();
        let mut is_whole = true;
        for (best, tried) in found {
            trials.extend(tried);
            match best {
                Some((approximation, worst, own)) => {
                    choice.push((approximation, worst));
                    cost = cost + own;
                }
                None => is_whole = false,
            }
        }
        is_whole.then_some((choice, cost))
    }

    /// The cheapest polynomial for a piece.
    fn line(&self, piece: &Piece) -> (Option<(Approximation, Worst, Cost)>, Vec<Trial>) {
        let region = self.task.domain.region_of(piece);
        let forms = channels(piece.f0);
        let ways: Vec<(Channels, Along)> =
            forms.iter().flat_map(|&form| ALONG.map(|x| (form, x))).collect();
        let of_way = |&(form, x): &(Channels, _)| self.shortest(form, x, region, piece.f0);
        let found: Vec<_> = ways.par_iter().map(of_way).collect();
        let mut trials = Vec::new();
        let mut best: Option<(Approximation, Worst, Cost)> = None;
        for (passed, tried) in found {
            trials.extend(tried);
            let Some((approximation, worst, cost)) = passed else { continue };
            let is_cheaper = best.as_ref().is_none_or(|(_, _, least)| {
                cost.weighed(&self.task.weights) < least.weighed(&self.task.weights)
            });
            if is_cheaper {
                best = Some((approximation, worst, cost));
            }
        }
        (best, trials)
    }

    /// The polynomial with the fewest numbers in these channels and this coordinate.
    fn shortest(
        &self,
        channels: Channels,
        x: Along,
        region: Region,
        f0: [f64; 2],
    ) -> (Option<(Approximation, Worst, Cost)>, Vec<Trial>) {
        let shape = Shape::Polynomial { x };
        let points = samples(self.truth, &region, &shape, ALONG_A_LINE);
        let places = verify::points(self.truth, &region, &shape);
        let trials = Vec::new();
        let mut line = Line { search: self, region, f0, points, places, trials, best: None };
        let of = |counts| Candidate::polynomials(channels, x, counts);
        if channels.count() == 1 {
            for count in 1..=MOST_POWERS {
                if line.is_done(&of([count, 0])) {
                    break;
                }
                line.attempt(&of([count, 0]));
            }
            return (line.best, line.trials);
        }
        // With as many numbers as there may be in the other channel, how few are not proved to
        // fail?
        let fewest = [[1, 0], [0, 1]].map(|own: [usize; 2]| {
            let counts = |few| own.map(|own| if own == 1 { few } else { MOST_POWERS });
            (0..=MOST_POWERS).find(|&few| !line.fails(&of(counts(few))))
        });
        let [Some(first), Some(second)] = fewest else { return (None, line.trials) };
        for sum in (first + second).max(1)..=2 * MOST_POWERS {
            let most = MOST_POWERS.min(sum - second);
            let firsts = first.max(sum.saturating_sub(MOST_POWERS))..=most;
            if firsts.clone().all(|count| line.is_done(&of([count, sum - count]))) {
                break;
            }
            for count in firsts {
                line.attempt(&of([count, sum - count]));
            }
        }
        (line.best, line.trials)
    }
}
