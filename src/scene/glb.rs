//! GLB: a scene's JSON and its binary data in one file (glTF 2.0, section 4).

use crate::error::{Error, Result};

/// The first bytes of a GLB file.
pub const MAGIC: &[u8] = b"glTF";

/// JSON and the binary chunk, if there is one.
pub fn split<'a>(name: &str, bytes: &'a [u8]) -> Result<(&'a [u8], Option<&'a [u8]>)> {
    let (Some(version), Some(length)) = (word(bytes, 4), word(bytes, 8)) else {
        return Err(broken(name, "a GLB header of 12 bytes", format!("{} bytes", bytes.len())));
    };
    if version != 2 {
        return Err(broken(name, "GLB of version 2", format!("version {version}")));
    }
    let Some(whole) = bytes.get(..length).filter(|whole| whole.len() >= 12) else {
        let got = format!("{} bytes", bytes.len());
        return Err(broken(name, &format!("a GLB file of {length} bytes"), got));
    };
    let (kind, json, rest) = chunk(name, &whole[12..])?;
    if kind != *b"JSON" {
        return Err(broken(name, "a chunk of JSON first", format!("'{}'", kind.escape_ascii())));
    }
    // Padding up to four bytes may follow; a chunk of another kind is to be ignored.
    if rest.len() < 8 {
        return Ok((json, None));
    }
    let (kind, binary, _) = chunk(name, rest)?;
    Ok((json, (kind == *b"BIN\0").then_some(binary)))
}

/// The kind and content of the first chunk, and what follows.
fn chunk<'a>(name: &str, bytes: &'a [u8]) -> Result<([u8; 4], &'a [u8], &'a [u8])> {
    let kind = bytes.get(4..8).and_then(|kind| kind.try_into().ok());
    let (Some(length), Some(kind)) = (word(bytes, 0), kind) else {
        let got = format!("{} bytes", bytes.len());
        return Err(broken(name, "the header of a chunk, 8 bytes", got));
    };
    match bytes[8..].split_at_checked(length) {
        Some((content, rest)) => Ok((kind, content, rest)),
        None => {
            let got = format!("{} bytes up to the file's end", bytes.len() - 8);
            Err(broken(name, &format!("a chunk of {length} bytes"), got))
        }
    }
}

/// A little-endian number of four bytes.
fn word(bytes: &[u8], at: usize) -> Option<usize> {
    let word = bytes.get(at..at.checked_add(4)?)?.try_into().ok()?;
    usize::try_from(u32::from_le_bytes(word)).ok()
}

fn broken(name: &str, expected: &str, got: String) -> Error {
    Error::bad_input(name, expected, got, "export or copy the file again")
}
