//! Literals of numbers, as languages have them.

/// A number; a negative one is a decimal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Literal {
    /// A whole number, or bits.
    Whole(u32),
    /// A decimal.
    Decimal(f32),
}

/// The most characters of a literal.
const LONGEST: usize = 64;

/// The number at the beginning of a text, and its length with a suffix; none where there is none.
/// Blanks may follow a sign.
pub fn literal(text: &str) -> Option<(Literal, usize)> {
    if let Some(rest) = text.strip_prefix('-') {
        let number = rest.trim_start_matches(' ');
        let (literal, length) = unsigned(number)?;
        let negative = match literal {
            Literal::Whole(whole) => Literal::Decimal(-(whole as f32)),
            Literal::Decimal(value) => Literal::Decimal(-value),
        };
        return Some((negative, text.len() - number.len() + length));
    }
    let plus = usize::from(text.starts_with('+'));
    unsigned(&text[plus..]).map(|(literal, length)| (literal, plus + length))
}

fn unsigned(text: &str) -> Option<(Literal, usize)> {
    let bytes = &text.as_bytes()[..text.len().min(LONGEST)];
    if let [b'0', b'x' | b'X', rest @ ..] = bytes {
        let end = 2 + rest.iter().take_while(|byte| byte.is_ascii_hexdigit()).count();
        let whole = u32::from_str_radix(&text[2..end], 16).ok()?;
        return Some((Literal::Whole(whole), end + suffix(&bytes[end..])));
    }
    let digits =
        |from: usize| bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let mut end = digits(0);
    let mut decimal = false;
    let mut any = end > 0;
    if bytes.get(end) == Some(&b'.') {
        let after = digits(end + 1);
        any |= after > 0;
        (end, decimal) = (end + 1 + after, true);
    }
    if !any {
        return None;
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'-' | b'+')));
        let count = bytes.get(end + 1 + sign..).map_or(0, |_| digits(end + 1 + sign));
        if count > 0 {
            (end, decimal) = (end + 1 + sign + count, true);
        }
    }
    // One that goes on behind what is looked at is none.
    if end == LONGEST {
        return None;
    }
    let number = &text[..end];
    let length = end + suffix(&bytes[end..]);
    match number.parse::<u32>() {
        Ok(whole) if !decimal => Some((Literal::Whole(whole), length)),
        _ => number.parse().ok().map(|value| (Literal::Decimal(value), length)),
    }
}

/// The characters of a suffix, as in 1.0f, 3u or 2.5_f32.
fn suffix(bytes: &[u8]) -> usize {
    for word in ["_f32", "_u16", "_u8", "f32", "u16", "u8", "lf", "f", "F", "h", "H", "u", "U", "L"]
    {
        if bytes.starts_with(word.as_bytes()) {
            return word.len();
        }
    }
    0
}
