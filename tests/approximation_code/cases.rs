//! Approximations of every shape, degree, coordinate, storage and kind of channels, with numbers
//! from a generator, and what their lookups have to give.

use crate::common::{Random, ggx};
use splitsum::approximation::code::Code;
use splitsum::approximation::{
    Across, Along, Approximation, Channels, Numbers, Region, Shape, Storage,
};
use splitsum::brdf::Masking;
use splitsum::choice::Choice;
use splitsum::lookup::Language;
use splitsum::numeric::lanes::{F32x16, Vector};

const ALONG: [Along; 5] = [Along::Nov, Along::Sqrt, Along::Cbrt, Along::Log, Along::Layer(2.5)];
const ACROSS: [Across; 3] = [Across::Linear, Across::Sqrt, Across::Power(1.3)];

/// Approximations, one or several of materials, with a name.
pub struct Case {
    pub name: String,
    pub approximations: Vec<Approximation>,
}

/// What a lookup is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub nov: f32,
    pub roughness: f32,
    pub f0: f32,
    pub material: usize,
}

/// What it has to give: A, B and E(F0), of one channel E(F0) alone; and the sum of the weighted
/// numbers, which rounding is in proportion to.
pub struct Expected {
    pub values: Vec<f64>,
    pub scale: f64,
}

/// An approximation with numbers between -1/2 and 1/2.
pub fn approximation(
    seed: usize,
    shape: Shape,
    channels: Channels,
    storage: Storage,
    region: Region,
    count: usize,
) -> Approximation {
    let mut random = Random(20_261_126 + seed as u64);
    let mut numbers = || (0..count).map(|_| random.next() - 0.5).collect::<Vec<f64>>();
    let numbers = (0..channels.count()).map(|_| storage.store(&numbers())).collect();
    Approximation { lobe: ggx(Masking::HeightCorrelated), region, channels, shape, numbers }
}

/// Every case: channels by storages by degrees of splines, and the coordinates in turn.
pub fn cases() -> Vec<Case> {
    let mut all = Vec::new();
    for (c, &channels) in Channels::ALL.iter().enumerate() {
        for (s, &storage) in Storage::ALL.iter().enumerate() {
            for degree in 1..=3 {
                let seed = all.len();
                let x = ALONG[(c + s + degree) % 5];
                let y = ACROSS[(c + degree) % 3];
                // The smallest of each degree, too.
                let size =
                    [[5, 6], [8, 8], [degree + 1, degree + 1 + s % 2]][(c + 2 * s + degree) % 3];
                let roughness = [[0.0, 1.0], [0.1, 0.9]][seed % 2];
                let region = Region { least_nov: [0.0, 0.05][seed / 2 % 2], roughness };
                let shape = Shape::Spline { x, y, size, degree };
                let made = approximation(seed, shape, channels, storage, region, size[0] * size[1]);
                all.push(Case { name: format!("spline{seed}"), approximations: vec![made] });
            }
        }
    }
    for (n, (x, y)) in ALONG.iter().flat_map(|x| ACROSS.iter().map(move |y| (x, y))).enumerate() {
        let [columns, rows] = [[4, 3], [3, 5], [2, 2], [5, 2]][n % 4];
        let shape = Shape::Surface { x: *x, y: *y, columns };
        let region = Region { least_nov: 0.0, roughness: [[0.0, 1.0], [0.2, 0.8]][n % 2] };
        let (channels, storage) = (Channels::ALL[n % 5], Storage::ALL[n / 4 % 3]);
        let made = approximation(100 + n, shape, channels, storage, region, columns * rows);
        all.push(Case { name: format!("surface{n}"), approximations: vec![made] });
    }
    let polynomial = |n: usize, channels: Channels| {
        let r = [0.3, 0.0, 1.0, 0.55][n % 4];
        let region = Region { least_nov: 0.0, roughness: [r, r] };
        let shape = Shape::Polynomial { x: ALONG[n / 2 % 5] };
        approximation(200 + n, shape, channels, Storage::ALL[n % 3], region, [6, 3, 2, 4, 7][n % 5])
    };
    for n in 0..24 {
        let approximations = vec![polynomial(n, Channels::ALL[n / 3 % 5])];
        all.push(Case { name: format!("polynomial{n}"), approximations });
    }
    let two = [Channels::EnergyRest, Channels::ScaleBias, Channels::BiasEnergy];
    let materials: [Vec<Channels>; 3] =
        [two.to_vec(), vec![Channels::Ratio; 5], vec![Channels::Albedo; 2]];
    for (m, kinds) in materials.iter().enumerate() {
        let made = kinds.iter().enumerate().map(|(n, &kind)| polynomial(30 + 7 * m + n, kind));
        all.push(Case { name: format!("materials{m}"), approximations: made.collect() });
    }
    all.extend(uneven());
    all
}

/// Channels that differ in count or storage, and one without numbers.
fn uneven() -> Vec<Case> {
    let region = Region { least_nov: 0.0, roughness: [0.4, 0.4] };
    let shape = Shape::Polynomial { x: Along::Sqrt };
    let made = |n: usize, numbers: Vec<Numbers>| Case {
        name: format!("uneven{n}"),
        approximations: vec![Approximation {
            lobe: ggx(Masking::HeightCorrelated),
            region,
            channels: Channels::EnergyRest,
            shape,
            numbers,
        }],
    };
    let values = [0.25, -0.5, 0.125, 0.75];
    vec![
        made(0, vec![Storage::F32.store(&values), Storage::F32.store(&values[..2])]),
        made(1, vec![Storage::Unorm8.store(&values), Storage::Unorm16.store(&values)]),
        made(2, vec![Storage::Unorm16.store(&values), Numbers::Floats(Vec::new())]),
    ]
}

impl Case {
    fn first(&self) -> &Approximation {
        &self.approximations[0]
    }

    /// The code.
    pub fn code(&self, language: Language) -> splitsum::Result<String> {
        let about = vec![format!("{}, made up", self.name)];
        let prefix = self.name.as_str();
        Code { approximations: &self.approximations, prefix, about }.write(language)
    }

    /// Whether there are A and B.
    pub fn has_scale_bias(&self) -> bool {
        self.first().channels.count() == 2
    }

    /// The arguments of its functions before F0, out of words for n·v, roughness and material; and
    /// those of the albedo.
    pub fn arguments(&self, [nov, roughness, material, f0]: [&str; 4]) -> [String; 2] {
        let mut words = vec![nov];
        if !matches!(self.first().shape, Shape::Polynomial { .. }) {
            words.push(roughness);
        }
        if self.approximations.len() > 1 {
            words.push(material);
        }
        let place = words.join(", ");
        if self.first().channels != Channels::Albedo {
            words.push(f0);
        }
        [place, words.join(", ")]
    }

    /// Points at the ends of all ranges, near them, a little outside, at knots and between.
    pub fn points(&self, count: usize) -> Vec<Point> {
        let mut random = Random(20_261_127);
        let mut coordinate = |i: usize| {
            let u = random.next();
            match i % 8 {
                0 => [0.0, 1.0, -1e-7, 1.0 + 1e-6, -0.25, 1.5][i / 8 % 6],
                1 => 1e-4 * u,
                2 => 1.0 - 1e-4 * u,
                3 => (20.0 * u).round() / 20.0,
                _ => u,
            }
        };
        let point = |i: usize| Point {
            nov: coordinate(i) as f32,
            roughness: coordinate(i / 3) as f32,
            f0: (i % 101) as f32 / 100.0,
            material: i / 7 % self.approximations.len(),
        };
        (0..count).map(point).collect()
    }

    /// What lookups have to give at these points.
    pub fn expected(&self, points: &[Point]) -> Vec<Expected> {
        points.chunks(16).flat_map(|points| self.expected_of_lanes(points)).collect()
    }

    fn expected_of_lanes(&self, points: &[Point]) -> Vec<Expected> {
        let lane = |i: usize| &points[i.min(points.len() - 1)];
        let nov = F32x16::gather(|i| f64::from(lane(i).nov).clamp(0.0, 1.0));
        let f0 = F32x16::gather(|i| lane(i).f0.into());
        let found = |one: &Approximation| {
            let [low, high] = one.region.roughness;
            let roughness = F32x16::gather(|i| f64::from(lane(i).roughness).clamp(low, high));
            let albedo = one.albedo(nov, roughness, f0);
            let mut positive = one.clone();
            positive.numbers.iter_mut().for_each(|numbers| *numbers = magnitudes(numbers));
            // All functions are positive, but for weights of splines, which are so too.
            (one.at(nov, roughness), albedo, positive.at(nov, roughness))
        };
        let all: Vec<_> = self.approximations.iter().map(found).collect();
        let value = |(i, point): (usize, &Point)| {
            let one = &self.approximations[point.material];
            let (channels, albedo, magnitudes) = &all[point.material];
            let [x, y] = channels.map(|channel| channel.lane(i));
            let grazing = (1.0 - f64::from(point.nov).clamp(0.0, 1.0)).powi(5);
            let mut values = match one.channels {
                Channels::EnergyRest => vec![x - (y + grazing * x), y + grazing * x],
                Channels::ScaleBias => vec![x, y],
                Channels::BiasEnergy => vec![y - x, x],
                Channels::Albedo | Channels::Ratio => Vec::new(),
            };
            values.push(albedo.lane(i));
            Expected {
                values,
                scale: magnitudes.map(|sum| sum.lane(i)).iter().sum::<f64>().max(1.0),
            }
        };
        points.iter().enumerate().map(value).collect()
    }
}

/// The absolute values.
fn magnitudes(numbers: &Numbers) -> Numbers {
    Numbers::Floats((0..numbers.len()).map(|i| numbers.get(i).abs() as f32).collect())
}

/// A unit in the last place of a float.
const UNIT: f64 = 1.0 / 8_388_608.0;

/// The largest difference, in proportion to the weighted numbers: on SwiftShader 7e-7, and 2.2e-6
/// with powers and logarithms, which devices are free to compute less exactly. A place on an axis
/// counts its spans, so that a unit of it moves a lookup by that many units at the most: an NVIDIA
/// H100 differs by 2.3e-6 on the net of 28 x 42.
pub fn allowed(case: &Case) -> f64 {
    let is_power =
        |x, y| matches!(x, Along::Cbrt | Along::Log) || matches!(y, Some(Across::Power(_)));
    let by_power = case.approximations.iter().any(|one| match one.shape {
        Shape::Polynomial { x } => is_power(x, None),
        Shape::Surface { x, y, .. } | Shape::Spline { x, y, .. } => is_power(x, Some(y)),
        Shape::Texture { .. } => false,
    });
    let spans = |one: &Approximation| one.shape.net().map_or(0, |net| net.size[0].max(net.size[1]));
    let spans = case.approximations.iter().map(spans).max().unwrap_or(0);
    (if by_power { 5e-6 } else { 2e-6 }) + spans as f64 * UNIT
}
