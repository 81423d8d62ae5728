//! URIs of buffers and images (glTF 2.0, section 2.8): data within the file, or a file beside it.

use super::notes::Read;
use crate::error::clean;
use base64::Engine;
use base64::alphabet;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

/// Base64 with or without padding: exporters leave it out.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// No system takes longer paths.
const LONGEST_PATH: usize = 4096;

/// The bytes of a `data:` URI (RFC 2397); none if it is another URI.
pub fn data(uri: &str) -> Option<Read<Vec<u8>>> {
    let rest = uri.strip_prefix("data:")?;
    let Some((kind, text)) = rest.split_once(',') else {
        return Some(Err("its data: URI has no comma".into()));
    };
    if !kind.ends_with(";base64") {
        return Some(Ok(percent_decoded(text)));
    }
    Some(BASE64.decode(text).map_err(|error| format!("its base64 is broken: {error}")))
}

/// The path of a relative URI, percent-decoded; an error for what leaves the scene's folder.
pub fn relative(uri: &str) -> Read<String> {
    let refused = |why: &str| Err(format!("its URI '{}' {why}", clean(uri, 80)));
    if uri.len() > LONGEST_PATH {
        return refused("is too long");
    }
    let Ok(path) = String::from_utf8(percent_decoded(uri)) else {
        return refused("is not UTF-8");
    };
    if path.contains(':') {
        return refused("is absolute or has a scheme, and only files beside the scene are read");
    }
    if path.starts_with(['/', '\\']) {
        return refused("is absolute, and only files beside the scene are read");
    }
    if path.split(['/', '\\']).any(|part| part == "..") {
        return refused("leaves the scene's folder by '..'");
    }
    if path.is_empty() || path.chars().any(char::is_control) {
        return refused("is no name of a file");
    }
    Ok(path)
}

/// Bytes of text with %41 for A (RFC 3986, section 2.1); a % without two digits stands for itself.
fn percent_decoded(text: &str) -> Vec<u8> {
    let bytes = text.as_bytes();
    let mut decoded = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        match (byte, bytes.get(at + 1..at + 3).and_then(hexadecimal)) {
            (b'%', Some(code)) => {
                decoded.push(code);
                at += 3;
            }
            _ => {
                decoded.push(byte);
                at += 1;
            }
        }
    }
    decoded
}

fn hexadecimal(digits: &[u8]) -> Option<u8> {
    let digit = |&digit: &u8| char::from(digit).to_digit(16);
    let &[high, low] = digits else { return None };
    u8::try_from(16 * digit(&high)? + digit(&low)?).ok()
}
