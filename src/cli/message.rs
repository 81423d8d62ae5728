//! Messages of a length that people read: what quotes a whole file, or an argument of a megabyte,
//! loses its middle.

/// Lines of a message.
const LINES: usize = 20;

/// Characters at the beginning of a line that is too long, and at its end, where the cure stands.
const HEAD: usize = 300;
const TAIL: usize = 200;

/// The message, if need be without the middle of its lines and its last ones.
pub fn shorten(message: &str) -> String {
    let mut lines: Vec<String> = message.lines().take(LINES).map(shorten_line).collect();
    let more = message.lines().count().saturating_sub(LINES);
    if more > 0 {
        lines.push(format!("… ({more} more lines)"));
    }
    lines.join("\n")
}

fn shorten_line(line: &str) -> String {
    let count = line.chars().count();
    if count <= HEAD + TAIL {
        return line.to_owned();
    }
    let head: String = line.chars().take(HEAD).collect();
    let tail: String = line.chars().skip(count - TAIL).collect();
    format!("{head}… ({} more characters) …{tail}", count - HEAD - TAIL)
}
