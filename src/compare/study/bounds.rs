//! Where rules err most, measured by their bounds: a search that climbs towards the largest
//! error/bound of every rule, integrand and channel, on the CPU and on devices. Whoever changes a
//! rule or a bound learns from it what the bound has to be.
//!
//! A hunt has one integrand, the rules that are measured against one truth, and the places where
//! each has been worst. A round tries fresh starts and places near the worst ones, every rule at
//! every place.

mod places;

use self::places::{Place, Places};
use super::{Share, timed};
use crate::backend::{Gpu, cpu};
use crate::bake::on_device;
use crate::brdf::interface::Interface;
use crate::brdf::{Fresnel, Microfacet};
use crate::error::{Error, Result};
use crate::integrate::Integrand;
use crate::integrate::rule::{GRAZING, MARGIN, Rule};
use crate::integrate::rules::RULES;
use crate::table::grid::Grid;
use std::time::Instant;

/// The length and the starts of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Seeds the starts.
    pub seed: u64,
    /// Fresh starts in a round of a hunt.
    pub starts: usize,
    /// Steps of each rule and channel in a round.
    pub steps: usize,
    /// Rounds of each hunt at the least, one after the other.
    pub rounds: usize,
    /// Seconds in all; what is left of them after those rounds goes to the hunts in turn.
    pub seconds: f64,
}

/// The largest share of its bound by which a rule was seen to err in a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The rule.
    pub rule: &'static str,
    /// The device that ran it in f32; none for the CPU in f64.
    pub device: Option<String>,
    /// The integrand.
    pub of: Integrand,
    /// The name of the integral.
    pub integral: &'static str,
    /// n·v
    pub mu: f64,
    /// α
    pub alpha: f64,
    /// The error.
    pub error: f64,
    /// Its bound.
    pub bound: f64,
}

/// All findings, and the points that were tried.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Search {
    /// A rule after the other, by the CPU, then by each device.
    pub findings: Vec<Finding>,
    /// Points at which rules were held against the truth, every integrand's counted.
    pub points: usize,
}

impl Plan {
    /// A search of this length.
    pub fn of_seconds(seconds: f64, seed: u64) -> Self {
        Plan { seed, starts: 192, steps: 12, rounds: 1, seconds }
    }
}

impl Finding {
    /// Error over bound; infinite where the value was no number.
    pub fn ratio(&self) -> f64 {
        ratio(self.error, self.bound)
    }

    /// Whether the bound holds with its margin.
    pub fn holds(&self) -> bool {
        self.ratio() <= 1.0 / MARGIN
    }
}

/// Every rule with every lobe, Fresnel model and interface that it serves for, but for the closed
/// forms, which are exact.
pub fn everything() -> Vec<(Integrand, Rule)> {
    let with_every_lobe = |fresnel| Microfacet::all().map(move |lobe| (lobe, fresnel));
    let lobes = Fresnel::samples().into_iter().flat_map(with_every_lobe);
    let lobes = lobes
        .filter(|&(lobe, fresnel)| is_told_apart(lobe, fresnel))
        .map(|(lobe, fresnel)| Integrand::Specular(lobe, fresnel));
    let interfaces = Interface::samples().into_iter().map(Integrand::Glass);
    lobes.chain(interfaces).flat_map(with_rules).collect()
}

/// Other Fresnel models than Schlick's know no masking term: one of each distribution will do.
fn is_told_apart(lobe: Microfacet, fresnel: Fresnel) -> bool {
    matches!(fresnel, Fresnel::Schlick | Fresnel::SchlickF82)
        || lobe.masking == lobe.ndf.default_masking()
}

/// Every rule that serves for an integrand.
pub fn with_rules(of: Integrand) -> impl Iterator<Item = (Integrand, Rule)> {
    RULES.into_iter().filter(move |rule| rule.applies_to(of)).map(move |rule| (of, rule))
}

/// Searches the rules on the CPU, and those that run there on the devices.
pub fn search(
    plan: Plan,
    rules: &[(Integrand, Rule)],
    devices: &[Gpu],
    share: Share,
) -> Result<Search> {
    let (mut hunts, start) = (hunts(plan.seed, rules, devices), Instant::now());
    let rounds = plan.rounds * hunts.len();
    for done in 0.. {
        let spent = start.elapsed().as_secs_f64();
        if done >= rounds && spent > plan.seconds {
            break;
        }
        share((done as f64 / rounds as f64).min(spent / plan.seconds).min(1.0));
        // Whoever has had the fewest rounds of those that each is to have, then whoever has had the
        // least time.
        let order = |a: &&mut Hunt, b: &&mut Hunt| a.turn(plan).total_cmp(&b.turn(plan));
        if let Some(hunt) = hunts.iter_mut().min_by(order) {
            let (round, seconds) = timed(|| hunt.round(plan));
            round?;
            hunt.rounds += 1;
            hunt.seconds += seconds;
        }
    }
    Ok(found(hunts))
}

/// Whether every bound holds with its margin: an error that names the worst that does not.
pub fn check(search: &Search) -> Result<()> {
    let worst = search.findings.iter().max_by(|a, b| a.ratio().total_cmp(&b.ratio()));
    match worst.filter(|worst| !worst.holds()) {
        None => Ok(()),
        Some(Finding { rule, device, of, integral, mu, alpha, error, bound }) => {
            Err(Error::CheckFailed(format!(
                "{rule} of {of} by {} errs by {error:e} in {integral} at n.v = \
                 {mu:e}, alpha = {alpha:e}, where {bound:e} is promised, which has to hold with a \
                 margin of {MARGIN}; mend the rule, or raise its bound",
                device.as_deref().unwrap_or("the CPU")
            )))
        }
    }
}

/// A hunt for each integrand on the CPU, one for the rule that is measured by another truth, one
/// for the devices.
fn hunts<'a>(seed: u64, rules: &[(Integrand, Rule)], devices: &'a [Gpu]) -> Vec<Hunt<'a>> {
    let mut hunts: Vec<Hunt> = Vec::new();
    for &(of, rule) in rules {
        let on_device = rule.runs_on_device() && of.obstacle_on_device().is_none();
        let runners = std::iter::once(None).chain(devices.iter().filter(|_| on_device).map(Some));
        for gpu in runners {
            let truth = rule.yardstick();
            let same = |hunt: &&mut Hunt| {
                hunt.of == of && hunt.truth == truth && hunt.on_devices == gpu.is_some()
            };
            let track = |integral| Track { rule, gpu, integral, worst: Default::default() };
            let tracks: Vec<Track> = of.names().into_iter().map(track).collect();
            match hunts.iter_mut().find(same) {
                Some(hunt) => hunt.tracks.extend(tracks),
                None => {
                    // Odd multiples of a large number keep the hunts' sequences apart.
                    let places = Places::new(
                        of,
                        seed ^ (2 * hunts.len() as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15),
                    );
                    hunts.push(Hunt {
                        of,
                        truth,
                        on_devices: gpu.is_some(),
                        tracks,
                        places,
                        points: 0,
                        rounds: 0,
                        seconds: 0.0,
                    });
                }
            }
        }
    }
    hunts
}

fn found(hunts: Vec<Hunt>) -> Search {
    let mut search = Search::default();
    for hunt in hunts {
        search.points += hunt.points;
        search.findings.extend(hunt.tracks.iter().flat_map(|track| track.findings(hunt.of)));
    }
    let place = |f: &Finding| (f.device.clone(), RULES.iter().position(|rule| rule.name == f.rule));
    search.findings.sort_by_key(place);
    search
}

/// One integrand, one truth.
struct Hunt<'a> {
    of: Integrand,
    truth: Rule,
    on_devices: bool,
    /// A rule's integrals stand one after the other.
    tracks: Vec<Track<'a>>,
    places: Places,
    points: usize,
    /// Rounds that it has had, and the seconds that they took.
    rounds: usize,
    seconds: f64,
}

/// An integral by a rule and a backend, and the places where it has been worst.
struct Track<'a> {
    rule: Rule,
    gpu: Option<&'a Gpu>,
    integral: &'static str,
    /// The worst places, apart from each other, the worst first: below [`GRAZING`] and from there
    /// on, where many bounds are narrower.
    worst: [Vec<Worst>; 2],
}

#[derive(Clone, Copy)]
struct Worst {
    place: Place,
    error: f64,
    bound: f64,
}

/// Summits that a track climbs at a time.
const SUMMITS: usize = 5;

/// Places nearer to each other than this, in the coordinates of [`Place`], are on the same summit:
/// a decade of n·v is
/// 0.03.
const APART: f64 = 0.04;

impl Hunt<'_> {
    /// Smaller for whoever is to go first.
    fn turn(&self, plan: Plan) -> f64 {
        if self.rounds < plan.rounds {
            self.rounds as f64 - plan.rounds as f64
        } else {
            self.seconds
        }
    }

    fn round(&mut self, plan: Plan) -> Result<()> {
        // The reference of glass takes a millisecond for a point.
        let (starts, side) = match self.of {
            Integrand::Glass(_) => (plan.starts.div_ceil(4), SIDE / 2),
            Integrand::Specular(..) | Integrand::Diffuse(_) => (plan.starts, SIDE),
        };
        let mut points: Vec<Place> = (0..starts).map(|i| self.places.start(i)).collect();
        for track in &self.tracks {
            for step in 0..plan.steps {
                // Half of the steps are on either side, and of those half the worst summit's.
                let (side, step) = (&track.worst[step % 2], step / 2);
                let summit = if step % 2 == 0 { 0 } else { step / 2 % SUMMITS };
                if let Some(worst) = side.get(summit).or(side.first()) {
                    points.push(self.places.near(worst.place));
                }
            }
        }
        // A device is given a grid: every n·v of a few dozen places with every α.
        let grid = self.on_devices.then(|| grid_of(&points, &mut self.places, side));
        if let Some(grid) = &grid {
            points = (0..grid.len())
                .map(|i| grid.point(i))
                .map(|(mu, alpha)| Place { mu, alpha })
                .collect();
        }
        let pairs: Vec<(f64, f64)> = points.iter().map(|place| (place.mu, place.alpha)).collect();
        let integrand = self.of;
        let truth = cpu::bake_points(integrand, &pairs, &self.truth);
        self.points += points.len();
        for tracks in self.tracks.chunks_exact_mut(integrand.count()) {
            let (rule, gpu) = (tracks[0].rule, tracks[0].gpu);
            let values = match (gpu, &grid) {
                (Some(gpu), Some(grid)) => {
                    on_device(gpu, integrand, grid, &rule, &|_| ())?.integrals
                }
                _ => cpu::bake_points(integrand, &pairs, &rule),
            };
            let errors =
                if gpu.is_some() { rule.device_errors(integrand) } else { rule.errors(integrand) };
            for ((&place, truth), values) in points.iter().zip(truth.iter()).zip(values.iter()) {
                let bounds = errors.at((place.mu, place.alpha), values);
                for (k, track) in tracks.iter_mut().enumerate() {
                    track.tell(Worst {
                        place,
                        error: (values[k] - truth[k]).abs(),
                        bound: bounds[k],
                    });
                }
            }
        }
        Ok(())
    }
}

/// n·v and α of so many of the places each.
fn grid_of(points: &[Place], places: &mut Places, side: usize) -> Grid {
    let mut some = |of: fn(&Place) -> f64| -> Vec<f64> {
        // The last ones are near the worst; half of all are drawn from them.
        (0..side)
            .map(|i| of(&points[places.pick(points.len() / (1 + i % 2), points.len())]))
            .collect()
    };
    Grid::of(some(|place| place.mu), some(|place| place.alpha))
}

/// The number of n·v and of α of a grid for a device, of cheap integrands.
const SIDE: usize = 20;

/// Error over bound, 0 of nothing promised; infinite for what is no number.
fn ratio(error: f64, bound: f64) -> f64 {
    match error {
        0.0 => 0.0,
        _ if error.is_finite() && bound.is_finite() => error / bound,
        _ if bound.is_finite() => f64::INFINITY,
        _ => 0.0,
    }
}

impl Worst {
    fn ratio(&self) -> f64 {
        ratio(self.error, self.bound)
    }
}

impl Track<'_> {
    /// Keeps what is worse than the summit it is on, or than the lowest.
    fn tell(&mut self, new: Worst) {
        let share = new.ratio();
        let side = &mut self.worst[usize::from(new.place.mu >= GRAZING)];
        let is_worse = |worst: &Worst| worst.ratio() >= share;
        if share == 0.0 || side.len() >= SUMMITS && side.iter().all(is_worse) {
            return;
        }
        if side.iter().any(|worst| worst.place.near(new.place, APART) && is_worse(worst)) {
            return;
        }
        side.retain(|worst| !worst.place.near(new.place, APART));
        let at = side.partition_point(is_worse);
        side.insert(at, new);
        side.truncate(SUMMITS);
    }

    /// The worst place, and the worst beyond [`GRAZING`] where the bound is narrower there.
    fn findings(&self, of: Integrand) -> Vec<Finding> {
        let is_narrower = |worst: &&Worst| {
            let Place { mu, alpha } = worst.place;
            self.rule.bound_at(of, mu, alpha) < self.rule.bound_at(of, 0.0, alpha)
        };
        let [grazing, beyond] = [0, 1].map(|side| self.worst[side].first());
        let worst = match (grazing, beyond) {
            (Some(grazing), Some(beyond)) if is_narrower(&beyond) => vec![grazing, beyond],
            (Some(grazing), Some(beyond)) if beyond.ratio() > grazing.ratio() => vec![beyond],
            (grazing, beyond) => grazing.or(beyond).into_iter().collect(),
        };
        worst.into_iter().map(|worst| self.finding(of, worst)).collect()
    }

    fn finding(&self, of: Integrand, worst: &Worst) -> Finding {
        let &Worst { place: Place { mu, alpha }, error, bound } = worst;
        let device = self.gpu.map(|gpu| gpu.info().name.clone());
        Finding {
            rule: self.rule.name,
            device,
            of,
            integral: self.integral,
            mu,
            alpha,
            error,
            bound,
        }
    }
}
