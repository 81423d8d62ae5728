//! Pages of HTML: one file each, without scripts, with nothing from elsewhere; words, numbers,
//! tables and pictures.

use crate::error::Result;
use crate::format::png::encode_rgb;
use crate::image::Picture;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

/// A page with this title, which is escaped, and this body, which is HTML.
pub fn page_of(title: &str, body: &str) -> String {
    let (title, style) = (escape(title), include_str!("html/page.css"));
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; \
         style-src 'unsafe-inline'\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>\n{style}</style>\n\
         </head>\n<body>\n<main>\n<h1>{title}</h1>\n{body}</main>\n</body>\n</html>\n"
    )
}

/// A picture as the address of an image.
pub fn address_of(picture: &Picture) -> Result<String> {
    let png = STANDARD.encode(encode_rgb(picture.width, picture.height, &picture.rgb)?);
    Ok(format!("data:image/png;base64,{png}"))
}

/// Text as HTML, also between double or single quotes.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            other => escaped.push(other),
        }
    }
    escaped
}

/// A whole number, with a comma before each three digits.
pub fn whole(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A number with three digits that count.
pub fn short(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    if size < 1e-4 {
        return format!("{value:.1e}");
    }
    if size >= 1e4 {
        return format!("{value:.1e}");
    }
    let decimals = (2.0 - size.log10().floor()).max(0.0) as usize;
    let text = format!("{value:.decimals$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// The first of a list of names, and how many more there are.
pub fn list(names: &[&str], most: usize) -> String {
    let shown = names[..names.len().min(most)].join(", ");
    match names.len().saturating_sub(most) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

/// At most so many characters of a text.
pub fn cut(text: &str, most: usize) -> String {
    match text.chars().count() > most {
        true => text.chars().take(most - 1).chain(['…']).collect(),
        false => text.to_owned(),
    }
}

/// The head of a column.
pub enum Column {
    /// Of texts.
    Text(&'static str),
    /// Of numbers, which end at the right.
    Number(&'static str),
}

/// A table of cells that are HTML.
pub fn table(columns: &[Column], rows: &[Vec<String>]) -> String {
    let class = |column: &Column| match column {
        Column::Text(_) => "",
        Column::Number(_) => " class=\"n\"",
    };
    let mut text = "<div class=\"wide\"><table>\n<tr>".to_owned();
    for column in columns {
        let (Column::Text(name) | Column::Number(name)) = column;
        text += &format!("<th{}>{name}</th>", class(column));
    }
    text += "</tr>\n";
    for row in rows {
        text += "<tr>";
        for (column, cell) in columns.iter().zip(row) {
            text += &format!("<td{}>{cell}</td>", class(column));
        }
        text += "</tr>\n";
    }
    text + "</table></div>\n"
}

/// How many more there are than are shown.
pub fn and_more(count: usize, shown: usize, what: &str) -> String {
    match count.saturating_sub(shown) {
        0 => String::new(),
        more => format!("<p class=\"dim\">And {} more {what}.</p>\n", whole(more)),
    }
}

#[cfg(test)]
mod tests {
    use super::{cut, escape, short, whole};

    #[test]
    fn texts_are_escaped_and_numbers_are_short() {
        assert_eq!(escape("<a b=\"c\">&'"), "&lt;a b=&quot;c&quot;&gt;&amp;&#39;");
        let wholes = [0, 999, 1000, 65_536, 1_234_567].map(whole);
        assert_eq!(wholes, ["0", "999", "1,000", "65,536", "1,234,567"]);
        let shorts = [0.0, 0.0039, 0.97512, 20.13, 120.0, -0.5, 3.21e-5].map(short);
        assert_eq!(shorts, ["0", "0.0039", "0.975", "20.1", "120", "-0.5", "3.2e-5"]);
        assert_eq!(cut("äöü", 3), "äöü");
        assert_eq!(cut("äöüß", 3), "äö…");
    }
}
