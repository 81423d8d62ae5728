//! Certified tables of every lobe beside 1,024 samples of the same: what a table costs whose every
//! value is right, over what most bakers pay.

use splitsum::backend::device::GpuOptions;
use splitsum::backend::{Backend, BackendChoice, list_devices};
use splitsum::brdf::{Fresnel, Microfacet, Ndf};
use splitsum::compare::study::{median, timed};
use splitsum::compare::technique::{Arithmetic, BASELINE, Setting};
use splitsum::lut::{Dfg, DfgChannels, Energy, EnergyChannels, Lut};
use splitsum::report::Computed;
use splitsum::request::Request;
use splitsum::table::grid::Grid;
use splitsum::table::precision::Precision;
use splitsum::units::F0;

/// Texels along either edge of the tables.
const SIZES: [usize; 2] = [128, 512];

/// How often two works are timed in turns.
const TURNS: usize = 3;

/// The same of works of a few milliseconds, whose times differ more.
const MORE_TURNS: usize = 9;

/// A table in halves.
pub fn request(lut: Lut, size: usize) -> Request {
    Request::with_default_axes(lut, (size, size), Precision::F16).unwrap()
}

/// A and B of a lobe.
pub fn dfg(lobe: Microfacet) -> Lut {
    Lut::Dfg(Dfg::new(lobe, Fresnel::Schlick, DfgChannels::All).unwrap())
}

/// The median times of two works that take turns, the first turn is not counted.
fn in_turns(turns: usize, mut ours: impl FnMut(), mut theirs: impl FnMut()) -> [f64; 2] {
    let turn = |_| [timed(&mut ours).1, timed(&mut theirs).1];
    let turns: Vec<[f64; 2]> = (0..=turns).map(turn).skip(1).collect();
    [0, 1].map(|which| median(turns.iter().map(|turn| turn[which]).collect()))
}

/// Prints both tables.
pub fn lobes() {
    let seconds = |lobe: Microfacet, size: usize| {
        let turns = if size == SIZES[0] { MORE_TURNS } else { TURNS };
        let grid: Grid = request(dfg(lobe), size).grid().clone();
        let run = |setting: Setting, arithmetic| {
            setting.run(lobe, &grid, arithmetic, 1).unwrap();
        };
        in_turns(
            turns,
            || run(Setting::Certified(Precision::F16), Arithmetic::F64),
            || run(BASELINE, Arithmetic::F32),
        )
    };
    let head = SIZES.map(|size| format!("{size} x {size} ms | 1,024 samples ms | ratio"));
    println!("| certified f16 | {} |", head.join(" | "));
    println!("{}|", "| --- ".repeat(7));
    for lobe in Microfacet::all() {
        let cells = SIZES.map(|size| {
            let [ours, theirs] = seconds(lobe, size);
            format!("{:.1} | {:.1} | {:.3}", 1e3 * ours, 1e3 * theirs, ours / theirs)
        });
        println!("| {}, {} | {} | {} |", lobe.ndf, lobe.masking, cells[0], cells[1]);
    }
    println!();
    energy();
}

/// Tables of the energy split beside their lobe's A and B.
fn energy() {
    println!("| energy, certified f16, 128 x 128 | ms | ratio to A and B of the lobe |");
    println!("{}|", "| --- ".repeat(3));
    let backend = Backend::cpu();
    for lobe in
        [Ndf::Ggx, Ndf::Beckmann, Ndf::Charlie].map(|ndf| Microfacet::new(ndf, None).unwrap())
    {
        for &channels in <EnergyChannels as splitsum::Choice>::ALL {
            let Ok(energy) = Energy::new(lobe, F0::new(0.04).unwrap(), channels) else { continue };
            let (table, plain) =
                (request(Lut::Energy(energy), SIZES[0]), request(dfg(lobe), SIZES[0]));
            let bake = |request: &Request| {
                splitsum::bake(request, &backend).unwrap();
            };
            let [ours, plain] = in_turns(MORE_TURNS, || bake(&table), || bake(&plain));
            println!("| {}, {channels} | {:.1} | {:.2} |", lobe.ndf, 1e3 * ours, ours / plain);
        }
    }
    println!();
}

/// Every lobe on every device: the device's own time, that of the whole bake beside the CPU's
/// alone, and the share of texels that the CPU only checks.
pub fn on_devices() {
    let devices = list_devices().unwrap_or_default();
    if devices.is_empty() {
        return;
    }
    let size = SIZES[0];
    println!(
        "| device, {size} x {size}, certified f16 | lobe | rule | on the device ms | bake ms | by \
         the CPU alone ms | ratio | decided by the device |"
    );
    println!("{}|", "| --- ".repeat(8));
    let cpu = Backend::cpu();
    for device in devices {
        let options = GpuOptions { device: Some(device.uuid.clone()), ..GpuOptions::default() };
        let Ok(backend) = Backend::open(BackendChoice::Vulkan, &options) else { continue };
        for lobe in Microfacet::all() {
            let table = request(dfg(lobe), size);
            // A rule that no device can do with the lobe.
            let Ok(baked) = splitsum::bake(&table, &backend) else { continue };
            let [ours, theirs] = in_turns(
                TURNS,
                || drop(splitsum::bake(&table, &backend).unwrap()),
                || drop(splitsum::bake(&table, &cpu).unwrap()),
            );
            let (report, stage) = (&baked.reports[0], &baked.reports[0].stages[0]);
            let own = match report.computed {
                Computed::Vulkan { device_seconds: Some(seconds), .. } => {
                    format!("{:.2}", 1e3 * seconds)
                }
                _ => "no clock".into(),
            };
            let rule = stage.by.rsplit(' ').next().unwrap_or_default();
            let share =
                stage.decided.map_or(0.0, |decided| decided as f64 / stage.texels.max(1) as f64);
            println!(
                "| {} | {}, {} | {rule} | {own} | {:.1} | {:.1} | {:.2} | {:.1} % |",
                device.name,
                lobe.ndf,
                lobe.masking,
                1e3 * ours,
                1e3 * theirs,
                ours / theirs,
                100.0 * share
            );
        }
    }
    println!();
}
