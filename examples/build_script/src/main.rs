//! Prints A and B of a rough surface seen head-on, from the table that the build script baked.

/// 64 x 64 texels of n·v and perceptual roughness, A and B as halves.
const DFG: &[u8; 64 * 64 * 4] = include_bytes!(concat!(env!("OUT_DIR"), "/dfg.bin"));

fn main() {
    // The last texel: n·v and roughness are 63.5/64.
    let [.., a0, a1, b0, b1] = *DFG;
    println!("A {:#06x}, B {:#06x}", u16::from_le_bytes([a0, a1]), u16::from_le_bytes([b0, b1]));
}
