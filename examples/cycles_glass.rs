//! Draws how wrong Cycles' table of glass seen from inside is: `cargo run --release --example
//! cycles_glass -- docs/glass_cycles.png`. Panels: R + T, Cycles' number, and their difference; n·v
//! from left to right, roughness from top to bottom.

use splitsum::backend::cpu;
use splitsum::brdf::interface::{Interface, Side, TransmissionMasking};
use splitsum::format::png::encode_rgb;
use splitsum::image::{Picture, diverging, panels};
use splitsum::integrate::Integrand;
use splitsum::integrate::rules::REFERENCE;
use splitsum::{Masking, Microfacet, Ndf};

/// The table's slice: z = 7/15, n = 1.56.
const SLICE: usize = 7;

/// Pixels along the edge of a texel.
const ZOOM: usize = 14;

const SIDE: usize = 16;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let output = std::env::args().nth(1).ok_or("name a file for the picture")?;
    let z = SLICE as f64 / 15.0;
    let ior = (1.0 + z * z) / (1.0 - z * z);
    let lobe = Microfacet { ndf: Ndf::Ggx, masking: Masking::HeightCorrelated };
    let inside = Interface::new(lobe, ior, Side::Inside, TransmissionMasking::Correlated)?;
    let mut shipped = [[0.0; SIDE]; SIDE];
    let table = include_str!("../tests/figures/cycles_glass_16.csv");
    for line in table.lines().filter(|line| line.starts_with(&format!("{SLICE},"))) {
        let columns: Vec<&str> = line.split(',').collect();
        shipped[columns[1].parse::<usize>()?][columns[2].parse::<usize>()?] = columns[4].parse()?;
    }
    let mut values = vec![vec![0.0; (SIDE * ZOOM).pow(2)]; 3];
    let mut worst = 0.0f64;
    for (mu_index, row) in shipped.iter().enumerate() {
        for (r_index, &theirs) in row.iter().enumerate() {
            let [mu, r] = [mu_index, r_index].map(|i| (i as f64 / 15.0).max(1e-4));
            let truth = cpu::bake_points(Integrand::Glass(inside), &[(mu, r * r)], &REFERENCE);
            let kept: f64 = truth.values().iter().sum();
            worst = worst.max((theirs - kept).abs());
            for (panel, value) in values.iter_mut().zip([kept, theirs, (theirs - kept) / 0.25]) {
                for pixel in 0..ZOOM * ZOOM {
                    let (x, y) = (pixel % ZOOM, pixel / ZOOM);
                    panel[(r_index * ZOOM + y) * SIDE * ZOOM + mu_index * ZOOM + x] = value;
                }
            }
        }
    }
    let picture: Picture = panels(&values, (SIDE * ZOOM, SIDE * ZOOM), 3, diverging);
    let Picture { width, height, rgb } = picture;
    std::fs::write(output, encode_rgb(width, height, &rgb)?)?;
    println!("n = {ior:.3}: Cycles' table is off by up to {worst:.3}");
    Ok(())
}
