//! The least and the greatest numbers of an accessor (glTF 2.0, section 3.6.2), from its data: what
//! the file itself states as `min` and `max` proves nothing.

use super::notes::Read;
use super::span::Span;
use super::store::Store;
use crate::error::clean;

/// Numbers of all accessors that are read, together.
const MOST_NUMBERS: u64 = 1 << 26;

/// The intervals of accessors.
#[derive(Default)]
pub struct Accessors {
    numbers: u64,
}

impl Accessors {
    /// An interval for each component of an accessor.
    pub fn spans(&mut self, store: &mut Store, index: usize) -> Read<Vec<Span>> {
        let accessors = &store.document().accessors;
        let accessor =
            accessors.get(index).ok_or_else(|| format!("there is no accessor {index}"))?;
        if accessor.sparse.is_some() {
            return Err(format!("accessor {index} is sparse"));
        }
        let components = components(&accessor.kind)?;
        let number = number(accessor.component_type, accessor.normalized)?;
        let view = accessor.buffer_view.ok_or_else(|| format!("accessor {index} has no view"))?;
        let stride = store.document().buffer_views.get(view).and_then(|view| view.byte_stride);
        let size = components * number.bytes;
        let stride = stride.filter(|&stride| stride > 0).unwrap_or(size);
        let beyond = || format!("accessor {index} leaves its buffer view");
        let bytes = store.view(view)?.get(accessor.byte_offset..).ok_or_else(beyond)?;
        let last = accessor.count.checked_sub(1).ok_or("it has no elements")?;
        let end = last.checked_mul(stride).and_then(|start| start.checked_add(size));
        if end.is_none_or(|end| end > bytes.len()) {
            return Err(beyond());
        }
        self.numbers = self.numbers.saturating_add((accessor.count * components) as u64);
        if self.numbers > MOST_NUMBERS {
            return Err("the animations have too many numbers".into());
        }
        let elements = bytes.chunks(stride).take(accessor.count);
        let mut spans: Vec<Option<Span>> = vec![None; components];
        for element in elements {
            for (span, bytes) in spans.iter_mut().zip(element.chunks_exact(number.bytes)) {
                let value = (number.value)(bytes);
                if !value.is_finite() {
                    return Err(format!("accessor {index} holds {value}"));
                }
                let point = Span::point(value);
                *span = Some(span.map_or(point, |span| span.hull(point)));
            }
        }
        spans.into_iter().collect::<Option<_>>().ok_or_else(beyond)
    }
}

fn components(kind: &str) -> Read<usize> {
    match kind {
        "SCALAR" => Ok(1),
        "VEC2" => Ok(2),
        "VEC3" => Ok(3),
        "VEC4" => Ok(4),
        _ => Err(format!("accessors of type {} are not read", clean(kind, 20))),
    }
}

/// How a number is stored.
struct Number {
    bytes: usize,
    value: fn(&[u8]) -> f64,
}

/// The component types of section 3.6.2.2; integers stand for fractions of their largest.
fn number(component_type: u32, normalized: bool) -> Read<Number> {
    match (component_type, normalized) {
        (5126, _) => Ok(Number { bytes: 4, value: float }),
        (5120, true) => Ok(Number { bytes: 1, value: signed_byte }),
        (5121, true) => Ok(Number { bytes: 1, value: byte }),
        (5122, true) => Ok(Number { bytes: 2, value: signed_short }),
        (5123, true) => Ok(Number { bytes: 2, value: short }),
        _ => Err(format!("numbers of component type {component_type} are not read")),
    }
}

fn float(bytes: &[u8]) -> f64 {
    bytes.try_into().map_or(f64::NAN, |bytes| f64::from(f32::from_le_bytes(bytes)))
}

fn byte(bytes: &[u8]) -> f64 {
    bytes.first().map_or(f64::NAN, |&byte| f64::from(byte) / 255.0)
}

fn signed_byte(bytes: &[u8]) -> f64 {
    let code = bytes.first().map(|&byte| f64::from(byte as i8));
    code.map_or(f64::NAN, |code| (code / 127.0).max(-1.0))
}

fn short(bytes: &[u8]) -> f64 {
    bytes.try_into().map_or(f64::NAN, |bytes| f64::from(u16::from_le_bytes(bytes)) / 65535.0)
}

fn signed_short(bytes: &[u8]) -> f64 {
    let code = bytes.try_into().map(|bytes| f64::from(i16::from_le_bytes(bytes)));
    code.map_or(f64::NAN, |code| (code / 32767.0).max(-1.0))
}
