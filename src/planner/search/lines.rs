//! Polynomials in n·v for constant roughnesses: for each piece the cheapest one.

use super::attempt::{Attempts, Passed, STEPS, Tried};
use super::{Choice, MOST_POWERS, Search, Trial};
use crate::approximation::{Along, Channels, Shape};
use crate::planner::candidate::{Candidate, along, channels};
use crate::planner::cost::Cost;
use crate::planner::domain::Piece;
use crate::planner::samples::{Sample, Spread, samples};
use crate::planner::verify;
use rayon::prelude::*;

/// Samples of a polynomial: five times as many as the largest has powers.
const ALONG_A_LINE: [Spread; 2] = [Spread::Crowded(71), Spread::Crowded(1)];

/// Polynomials in these channels and this coordinate, for a piece.
struct Way<'a> {
    attempts: Attempts<'a>,
    channels: Channels,
    x: Along,
    points: &'a [Sample],
    /// Where numbers are verified.
    places: &'a [Sample],
    /// The fewest numbers in each channel; none where however many are proved to fail.
    fewest: Option<[usize; 2]>,
}

impl Way<'_> {
    /// The candidates with these numbers in each channel, which differ in storage.
    fn of(&self, counts: [usize; 2]) -> [Candidate; 2] {
        Candidate::polynomials(self.channels, self.x, counts)
    }

    /// Finds the fewest numbers in each channel that are not proved to fail, with as many as there
    /// may be in the other one: the proofs that fewer fail.
    fn find_fewest(&mut self) -> Vec<Trial> {
        if self.channels.count() == 1 {
            self.fewest = Some([1, 0]);
            return Vec::new();
        }
        let mut proofs = Vec::new();
        let mut of_channel = |own: [usize; 2]| {
            let counts = |few| own.map(|own| if own == 1 { few } else { MOST_POWERS });
            (0..=MOST_POWERS).find(|&few| {
                let same = self.of(counts(few));
                let failing = self.attempts.refuted(&same, self.points, STEPS);
                let fails = !failing.is_empty();
                proofs.extend(failing.into_iter().map(|(trial, _)| trial));
                !fails
            })
        };
        let fewest = of_channel([1, 0]).zip(of_channel([0, 1]));
        self.fewest = fewest.map(|(first, second)| [first, second]);
        proofs
    }

    /// The numbers in each channel that add up to a sum, each channel with the fewest at least.
    fn splits(&self, sum: usize) -> Vec<[usize; 2]> {
        let Some([first, second]) = self.fewest else { return Vec::new() };
        let most = match self.channels.count() {
            1 => 0,
            _ => MOST_POWERS,
        };
        let is_possible = |&[own, other]: &[usize; 2]| {
            (first..=MOST_POWERS).contains(&own) && (second..=most).contains(&other)
        };
        (0..=sum).map(|own| [own, sum - own]).filter(is_possible).collect()
    }

    /// Tries the candidates that cost less than the limit.
    fn attempt(&self, counts: [usize; 2], limit: f64) -> Vec<Tried> {
        let is_cheaper = |candidate: &Candidate| self.attempts.cost(candidate) < limit;
        let cheaper: Vec<Candidate> = self.of(counts).into_iter().filter(is_cheaper).collect();
        self.attempts.attempt(&cheaper, self.points, || self.places)
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

    /// The cheapest polynomial for a piece: all ways with one number, then with two, and so on.
    fn line(&self, piece: &Piece) -> (Option<Passed>, Vec<Trial>) {
        let region = self.task.domain.region_of(piece);
        let attempts = Attempts { search: self, region, f0: piece.f0 };
        // They are the same for every coordinate.
        let shape = Shape::Polynomial { x: Along::Nov };
        let points = samples(self.truth, &region, &shape, ALONG_A_LINE);
        let places = verify::points(self.truth, &region, &shape);
        let of = |&(channels, x): &(Channels, Along)| Way {
            attempts,
            channels,
            x,
            points: &points,
            places: &places,
            fewest: None,
        };
        let mut ways: Vec<Way> = kinds(attempts).iter().map(of).collect();
        let proofs: Vec<_> = ways.par_iter_mut().map(Way::find_fewest).collect();
        let mut trials: Vec<Trial> = proofs.into_iter().flatten().collect();
        let mut best: Option<Passed> = None;
        for sum in 1..=2 * MOST_POWERS {
            let limit = attempts.least(best.as_ref());
            let splits = |way| Way::splits(way, sum).into_iter().map(move |counts| (way, counts));
            let turn: Vec<(&Way, [usize; 2])> = ways.iter().flat_map(splits).collect();
            let tried: Vec<Tried> = turn
                .par_iter()
                .flat_map_iter(|(way, counts)| way.attempt(*counts, limit))
                .collect();
            // More numbers in the same way cost no less; a way that begins later may cost less.
            let begins = |way: &Way| way.fewest.map_or(0, |fewest| fewest.iter().sum());
            let have_begun = ways.iter().all(|way| begins(way) <= sum);
            if tried.is_empty() && have_begun {
                break;
            }
            best = attempts.settle(tried, best, &mut trials);
        }
        (best, trials)
    }
}

/// The channels and the coordinates of every way for a piece.
fn kinds(Attempts { region, f0, .. }: Attempts<'_>) -> Vec<(Channels, Along)> {
    let along = along(&region);
    channels(f0).iter().flat_map(|&form| along.iter().map(move |&x| (form, x))).collect()
}
