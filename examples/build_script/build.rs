//! Bakes the table that the program embeds.

use splitsum::{Backend, Dfg, DfgChannels, Fresnel, Lut, Microfacet, Ndf, Precision, Request};
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let lobe = Microfacet::new(Ndf::Ggx, None)?;
    let lut = Lut::Dfg(Dfg::new(lobe, Fresnel::Schlick, DfgChannels::All)?);
    let request = Request::with_default_axes(lut, (64, 64), Precision::F16)?;
    let table = splitsum::bake(&request, &Backend::cpu())?.table;
    // Halves, little-endian, row by row, A and B side by side: as a GPU's RG16F texture takes them.
    std::fs::write(Path::new(&std::env::var("OUT_DIR")?).join("dfg.bin"), table.bytes(0))?;
    // The table depends on nothing but this script.
    println!("cargo::rerun-if-changed=build.rs");
    Ok(())
}
