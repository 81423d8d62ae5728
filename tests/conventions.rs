//! Foreign tables are told: random conventions, with rounding and noise, and what is no table.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::Random;
use splitsum::backend::cpu::bake_points;
use splitsum::brdf::{Masking, Microfacet, Ndf};
use splitsum::foreign::Foreign;
use splitsum::integrate::rules::H640;
use splitsum::numeric::half;
use splitsum::table::axis::{Axis, AxisSpec, Mapping, Nodes, Parameter};
use splitsum::table::precision::Precision;
use splitsum::verify::{Decision, Demands, Report, Status, verify};

/// A convention of a table, as a test makes it.
#[derive(Clone, Debug)]
struct Made {
    lobe: Microfacet,
    nov: AxisSpec,
    roughness: AxisSpec,
    transposed: bool,
    channels: &'static [&'static str],
    size: [usize; 2],
    storage: Storage,
}

/// What becomes of a value.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Storage {
    F32,
    F16,
    Unorm16,
    Unorm8,
    /// Noise of this amount on the average, in halves.
    Noise(f64),
}

fn one_of<T: Clone>(random: &mut Random, list: &[T]) -> T {
    list[(random.next() * list.len() as f64) as usize % list.len()].clone()
}

const NODES: [Nodes; 6] = [
    Nodes::Offset(0.5),
    Nodes::Edges,
    Nodes::Offset(0.0),
    Nodes::Offset(1.0),
    Nodes::Offset(1.5),
    Nodes::Offset(-0.5),
];

impl Made {
    fn random(random: &mut Random) -> Self {
        let lobes = [
            (Ndf::Ggx, Masking::HeightCorrelated),
            (Ndf::Ggx, Masking::HeightCorrelated),
            (Ndf::Ggx, Masking::Separable),
            (Ndf::Ggx, Masking::SchlickSmith),
            (Ndf::Ggx, Masking::HeightCorrelatedApprox),
            (Ndf::Ggx, Masking::Implicit),
            (Ndf::Beckmann, Masking::HeightCorrelated),
            (Ndf::BeckmannWalter, Masking::Separable),
            (Ndf::BlinnPhong, Masking::Implicit),
        ];
        let (ndf, masking) = one_of(random, &lobes);
        let mut axis = |parameter: Parameter, maps: &[Mapping]| AxisSpec {
            mapping: one_of(random, maps),
            // Centres and edges as often as all others.
            nodes: if random.next() < 0.5 {
                one_of(random, &NODES[..2])
            } else {
                one_of(random, &NODES)
            },
            flip: random.next() < 0.3,
            ..AxisSpec::of(parameter)
        };
        let nov = axis(
            Parameter::Nov,
            &[Mapping::Linear, Mapping::Linear, Mapping::Sqrt, Mapping::SqrtComplement],
        );
        let rough = axis(Parameter::Roughness, &[Mapping::Linear, Mapping::Linear, Mapping::Sqrt]);
        let alpha = axis(Parameter::Alpha, &[Mapping::Linear, Mapping::Square]);
        let packings: [&[&str]; 8] = [
            &["a", "b"],
            &["a", "b"],
            &["b", "a"],
            &["b", "e"],
            &["a", "b", "0"],
            &["b", "e", "1"],
            &["e"],
            &["1-e"],
        ];
        Made {
            lobe: Microfacet::new(ndf, Some(masking)).unwrap(),
            nov,
            roughness: if random.next() < 0.7 { rough } else { alpha },
            transposed: random.next() < 0.4,
            channels: one_of(random, &packings),
            size: one_of(random, &[[16, 16], [32, 32], [64, 64], [64, 32], [24, 48], [128, 128]]),
            storage: one_of(
                random,
                &[
                    Storage::F32,
                    Storage::F16,
                    Storage::Unorm16,
                    Storage::Unorm8,
                    Storage::Noise(1e-3),
                    Storage::Noise(3e-3),
                ],
            ),
        }
    }

    fn axes(&self) -> (Axis, Axis) {
        let [columns, rows] = self.size;
        let (x, y) = match self.transposed {
            true => (self.roughness, self.nov),
            false => (self.nov, self.roughness),
        };
        (Axis::new(x, columns).unwrap(), Axis::new(y, rows).unwrap())
    }

    /// The table, as a reader would have it.
    fn table(&self, random: &mut Random) -> Foreign {
        let (x, y) = self.axes();
        let place = |axis: &Axis, texel: usize| {
            let value = axis.value(texel);
            if axis.spec().parameter == Parameter::Roughness { value * value } else { value }
        };
        let point = |k: usize| {
            let (i, j) = (place(&x, k % x.size()), place(&y, k / x.size()));
            if self.transposed { (j, i) } else { (i, j) }
        };
        let points: Vec<(f64, f64)> = (0..x.size() * y.size()).map(point).collect();
        let integrals = bake_points(self.lobe, &points, &H640);
        let mut values = Vec::new();
        for integrals in integrals.iter() {
            let (a, b) = (integrals[0], integrals[1]);
            for channel in self.channels {
                let value = match *channel {
                    "a" => a,
                    "b" => b,
                    "e" => a + b,
                    "1-e" => 1.0 - a - b,
                    number => number.parse().unwrap(),
                };
                values.push(self.stored(value, random) as f32);
            }
        }
        let storage = match self.storage {
            Storage::F32 => Precision::F32,
            Storage::F16 | Storage::Noise(_) => Precision::F16,
            Storage::Unorm16 => Precision::Unorm16,
            Storage::Unorm8 => Precision::Unorm8,
        };
        Foreign {
            size: [x.size(), y.size(), 1],
            names: ["R", "G", "B"][..self.channels.len()].iter().map(|&n| n.into()).collect(),
            values,
            storage,
            container: "made",
            curve: None,
            notes: vec![],
            faults: vec![],
            own: vec![],
        }
    }

    fn stored(&self, value: f64, random: &mut Random) -> f64 {
        match self.storage {
            Storage::F32 => value,
            Storage::F16 => half::nearest(value),
            Storage::Unorm16 => (value.clamp(0.0, 1.0) * 65535.0).round() / 65535.0,
            Storage::Unorm8 => (value.clamp(0.0, 1.0) * 255.0).round() / 255.0,
            // A triangle's mean amount is a third of its half width.
            Storage::Noise(amount) => {
                let noise = 3.0 * amount * (random.next() - random.next());
                half::nearest(value + noise)
            }
        }
    }

    /// The right choice in a dimension.
    fn right(&self, dimension: &str) -> Option<String> {
        let direction = |spec: AxisSpec| {
            let falls = spec.flip != (spec.mapping == Mapping::SqrtComplement);
            if falls { "falls" } else { "rises" }.to_owned()
        };
        let mapping = |spec: AxisSpec| format!("{},{}", spec.parameter, spec.mapping);
        let nodes = |spec: AxisSpec| match spec.nodes {
            Nodes::Edges => "edges".into(),
            Nodes::Offset(0.5) => "centres".into(),
            Nodes::Offset(offset) if offset.fract() == 0.0 => format!("offset={offset:.0}"),
            Nodes::Offset(offset) => format!("offset={offset}"),
        };
        Some(match dimension {
            "axes" if self.transposed => "x = roughness, y = nov".into(),
            "axes" => "x = nov, y = roughness".into(),
            "direction of nov" => direction(self.nov),
            "direction of roughness" => direction(self.roughness),
            "mapping of nov" => mapping(self.nov),
            "mapping of roughness" => mapping(self.roughness),
            "nodes of nov" => nodes(self.nov),
            "nodes of roughness" => nodes(self.roughness),
            "distribution" => self.lobe.ndf.to_string(),
            "masking" => self.lobe.masking.to_string(),
            "channels" => {
                let live = self.channels.iter().enumerate();
                let live = live.filter(|(_, word)| word.parse::<f64>().is_err());
                let words = live.map(|(place, word)| format!("{place} = {word}"));
                words.collect::<Vec<_>>().join(", ")
            }
            "encoding" => "linear".into(),
            _ => return None,
        })
    }
}

/// How many choices are right, how many honestly undecided, and the wrong ones.
#[derive(Default, Debug)]
struct Score {
    right: usize,
    undecided: usize,
    unknown: usize,
    wrong: Vec<String>,
}

impl Score {
    fn add(&mut self, made: &Made, report: &Report) {
        if report.status == Status::Unknown {
            self.unknown += 1;
            println!("unknown ({:?}): {made:?}", report.distance);
            return;
        }
        for Decision { dimension, choice, decided, others, ratio, .. } in &report.decisions {
            let Some(right) = made.right(dimension) else { continue };
            match (*choice == right, decided) {
                (true, true) => self.right += 1,
                (_, false) if *choice == right || others.contains(&right) => self.undecided += 1,
                _ => self.wrong.push(format!(
                    "{dimension}: {choice} ({ratio:.2}) in place of {right}: {made:?}"
                )),
            }
        }
    }
}

#[test]
fn random_conventions_are_told_or_left_undecided() {
    let count = std::env::var("SPLITSUM_CONVENTIONS").ok().and_then(|n| n.parse().ok());
    let mut random = Random(16);
    let mut score = Score::default();
    for _ in 0..count.unwrap_or(24) {
        let made = Made::random(&mut random);
        let table = made.table(&mut random);
        let report = verify("made", &table, &Demands::default()).unwrap();
        score.add(&made, &report);
    }
    println!("right {}, undecided {}, unknown {}", score.right, score.undecided, score.unknown);
    assert!(score.wrong.is_empty(), "{} wrong:\n{}", score.wrong.len(), score.wrong.join("\n"));
}

/// A table of these values, `components` to a texel.
fn of_values(size: [usize; 2], components: usize, values: Vec<f32>) -> Foreign {
    Foreign {
        size: [size[0], size[1], 1],
        names: ["R", "G", "B", "A"][..components].iter().map(|&name| name.into()).collect(),
        values,
        storage: Precision::F32,
        container: "made",
        curve: None,
        notes: vec![],
        faults: vec![],
        own: vec![],
    }
}

#[test]
fn what_is_no_table_is_unknown() {
    let mut random = Random(3);
    let noise: Vec<f32> = (0..32 * 32 * 2).map(|_| random.next() as f32).collect();
    let smooth = |f: fn(f64, f64) -> f64| -> Vec<f32> {
        let at = |k: usize| f((k % 32) as f64 / 31.0, (k / 32) as f64 / 31.0) as f32;
        (0..32 * 32).map(at).collect()
    };
    let waves = smooth(|u, v| 0.5 + 0.5 * (9.0 * u).sin() * (7.0 * v).cos());
    let product = smooth(|u, v| u * v);
    for (what, table) in [
        ("noise", of_values([32, 32], 2, noise)),
        ("waves", of_values([32, 32], 1, waves)),
        ("a product", of_values([32, 32], 1, product)),
        ("a constant", of_values([8, 8], 2, vec![0.5; 128])),
        ("no number", of_values([8, 8], 2, vec![f32::NAN; 128])),
        ("one texel", of_values([1, 1], 3, vec![0.1, 0.2, 0.3])),
    ] {
        let report = verify(what, &table, &Demands::default()).unwrap();
        assert_eq!(report.status, Status::Unknown, "{what}: {report:?}");
        assert!(report.fails());
    }
}

/// A table as its words of `splitsum bake` make it, in halves.
fn baked(words: &str) -> Foreign {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("t.npy");
    let arguments = words.split(' ').chain(["--backend", "cpu", "-q", "-o"]);
    let program = std::process::Command::new(env!("CARGO_BIN_EXE_splitsum"))
        .arg("bake")
        .args(arguments)
        .arg(&file)
        .output()
        .unwrap();
    assert!(program.status.success(), "{words}: {}", String::from_utf8_lossy(&program.stderr));
    Foreign::read(words, &std::fs::read(&file).unwrap(), &Default::default()).unwrap()
}

#[test]
fn glass_exact_fresnel_and_energy_are_told_with_their_numbers() {
    let mut random = Random(5);
    for words in [
        "--model ggx --masking height-correlated --fresnel dielectric:1.45 --channels r",
        "--model ggx --masking separable --fresnel conductor:0.14,3.697 --channels r",
        "--model ggx --masking height-correlated --fresnel schlick:4.4 --channels a,b",
        "--lut glass --model ggx --masking height-correlated --channels rt --side outside \
         --ior 1.6",
        "--lut glass --model ggx --masking separable --channels rt --side inside --ior 1.33",
        "--lut glass --model ggx --masking height-correlated --channels total --side outside \
         --ior 1.7",
        "--lut energy --model ggx --masking height-correlated --channels kulla-conty",
        "--lut energy --model ggx --masking height-correlated --channels turquin",
        "--lut energy --model ggx --masking height-correlated --channels split --f0 0.05",
        "--lut energy --model ggx --masking separable --channels split --ior 1.8",
        "--lut energy --model beckmann --masking height-correlated --channels kulla-conty",
        "--lut glass --model ggx --masking height-correlated --channels kulla-conty --side inside \
         --ior 2.1",
        "--lut glass --model ggx --masking separable --channels turquin --side outside --ior 1.9",
    ] {
        let axes = one_of(
            &mut random,
            &[
                "--x nov,linear,centres --y roughness,linear,centres",
                "--x nov,sqrt,edges --y alpha,linear,edges",
                "--x roughness,sqrt,centres,flip --y nov,linear,edges,flip",
            ],
        );
        let report =
            verify("t", &baked(&format!("{words} --size 24x20 {axes}")), &Demands::default());
        let report = report.unwrap();
        assert_eq!(report.status, Status::Known, "{words}");
        let command = report.convention.as_ref().and_then(|convention| convention.command.clone());
        let expected = format!("splitsum bake {words} --size 24x20 {axes} --precision f16");
        // The reader of npy knows the storage of its own numbers.
        assert!(command.as_ref().is_some_and(|c| c.starts_with(&expected)), "{words}: {command:?}");
        assert!(report.faults.is_empty(), "{words}: {:?}", report.faults);
        assert!(report.channels.iter().all(|c| c.stored.largest < 1e-3), "{words}");
    }
}

#[test]
fn averages_of_a_row_are_told() {
    for words in [
        "--lut energy --model ggx --masking height-correlated --channels average",
        "--model ggx --masking separable --channels e_avg",
        "--lut glass --model ggx --masking height-correlated --channels average --side outside \
         --ior 1.5",
    ] {
        let axes = "--x roughness,linear,edges --y nov,linear,centres";
        let report =
            verify("t", &baked(&format!("{words} --size 32x1 {axes}")), &Demands::default());
        let report = report.unwrap();
        assert_eq!(report.status, Status::Known, "{words}: {:?}", report.distance);
        let command = report.convention.as_ref().and_then(|convention| convention.command.clone());
        let start = format!("splitsum bake {words} --size 32x1 --x roughness,linear,edges");
        assert!(command.as_ref().is_some_and(|c| c.starts_with(&start)), "{words}: {command:?}");
    }
}
