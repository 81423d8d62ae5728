//! Sizes and lists of numbers as users write them: text on the command line; numbers, lists or text
//! in a configuration.

use crate::error::{Error, Result};
use serde::Deserialize;
use std::fmt;

/// A table's size as users write it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged, expecting = "expected a whole number, or text as in \"64x32\"")]
pub enum Size {
    /// One number for a square.
    Square(i64),
    /// Text, with columns, rows and slices.
    Text(String),
}

/// One number or several as users write them.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged, expecting = "expected a number or several, as in [0.02, 0.04]")]
pub enum Numbers {
    /// One.
    One(f64),
    /// A list.
    List(Vec<f64>),
    /// Text, with commas between.
    Text(String),
}

impl Size {
    /// Columns, rows and, where they are named, slices.
    pub fn parse(&self) -> Result<(usize, usize, Option<usize>)> {
        let text = self.to_string();
        let numbers: Option<Vec<usize>> =
            text.split('x').map(|number| number.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[side]) => Ok((side, side, None)),
            Some(&[columns, rows]) => Ok((columns, rows, None)),
            Some(&[columns, rows, slices]) => Ok((columns, rows, Some(slices))),
            _ => {
                let expected = "a number, or two or three with an x between";
                Err(Error::bad_input(
                    "size",
                    expected,
                    format!("'{text}'"),
                    "as in 128, 64x32 or 64x64x16",
                ))
            }
        }
    }
}

impl Numbers {
    /// The numbers of a flag.
    pub fn parse(&self, flag: &str) -> Result<Vec<f64>> {
        let numbers = match self {
            Numbers::One(number) => vec![*number],
            Numbers::List(numbers) => numbers.clone(),
            Numbers::Text(text) => {
                let number = |word: &str| word.trim().parse().ok();
                text.split(',').map(number).collect::<Option<Vec<f64>>>().unwrap_or_default()
            }
        };
        if !numbers.is_empty() {
            return Ok(numbers);
        }
        let got = match self {
            Numbers::Text(text) => format!("'{text}'"),
            Numbers::One(_) | Numbers::List(_) => "none".to_owned(),
        };
        let expected = "numbers with commas between";
        Err(Error::bad_input(flag, expected, got, "as in 0.02,0.04,0.08"))
    }
}

impl From<String> for Numbers {
    fn from(text: String) -> Self {
        Numbers::Text(text)
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Size::Square(n) => write!(f, "{n}"),
            Size::Text(text) => f.write_str(text),
        }
    }
}

impl From<String> for Size {
    fn from(text: String) -> Self {
        Size::Text(text)
    }
}
