//! Little-endian numbers of a header; beyond its end there are none.

use super::{Read, refuse};

/// So many bytes at a place.
pub fn part(bytes: &[u8], at: usize, length: usize) -> Read<&[u8]> {
    match at.checked_add(length).and_then(|end| bytes.get(at..end)) {
        Some(part) => Ok(part),
        None => {
            let expected = format!("{length} bytes at {at}");
            refuse(expected, format!("a file of {} bytes: it is cut off", bytes.len()))
        }
    }
}

fn array<const N: usize>(bytes: &[u8], at: usize) -> Read<[u8; N]> {
    let mut array = [0; N];
    array.copy_from_slice(part(bytes, at, N)?);
    Ok(array)
}

/// A number of 16 bits.
pub fn word16(bytes: &[u8], at: usize) -> Read<u16> {
    array(bytes, at).map(u16::from_le_bytes)
}

/// A number of 32 bits.
pub fn word32(bytes: &[u8], at: usize) -> Read<u32> {
    array(bytes, at).map(u32::from_le_bytes)
}

/// A number of 64 bits that is a place or a length in memory.
pub fn long(bytes: &[u8], at: usize) -> Read<usize> {
    let long = array(bytes, at).map(u64::from_le_bytes)?;
    match usize::try_from(long) {
        Ok(long) => Ok(long),
        Err(_) => refuse("a length that memory has", long.to_string()),
    }
}
