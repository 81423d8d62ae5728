//! Candidates and tolerances in words, as files and reports have them.

use super::candidate::Candidate;
use super::tolerance::Tolerance;
use crate::approximation::{Across, Along, Channels, Shape, Storage, Texels};
use crate::choice::Choice;
use crate::error::{Error, Result};
use crate::table::axis::AxisSpec;
use std::fmt;

/// Most numbers along either side of a candidate that a file may name.
const MOST: usize = 256;

impl fmt::Display for Candidate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Candidate { channels, shape, counts, storage } = self;
        write!(f, "{channels} ")?;
        match shape {
            Shape::Polynomial { x } => {
                write!(f, "polynomial x={}", x.word())?;
                match channels.count() {
                    1 => write!(f, " numbers={}", counts[0])?,
                    _ => write!(f, " numbers={}+{}", counts[0], counts[1])?,
                }
            }
            Shape::Surface { x, y, columns } => {
                let rows = counts[0] / columns;
                write!(f, "surface size={columns}x{rows} x={} y={}", x.word(), y.word())?;
            }
            Shape::Spline { x, y, size: [columns, rows], degree } => {
                let (x, y) = (x.word(), y.word());
                write!(f, "spline degree={degree} size={columns}x{rows} x={x} y={y}")?;
            }
            Shape::Texture { x, y, texels } => {
                let (columns, rows) = (x.size(), y.size());
                let (x, y) = (x.spec(), y.spec());
                write!(f, "texture size={columns}x{rows} x={x} y={y} texels={texels}")?;
            }
        }
        write!(f, " storage={storage}")
    }
}

impl Candidate {
    /// The candidate with these words.
    pub fn named(words: &str) -> Result<Self> {
        parse(words).ok_or_else(|| {
            let expected = "the words of a candidate, such as energy-rest spline degree=2 size=8x7 \
                            x=layer=3 y=sqrt storage=unorm8";
            let got = format!("'{}'", words.chars().take(120).collect::<String>());
            Error::bad_input("candidate", expected, got, "repeat the plan")
        })
    }

    /// Whether the functions of the other are among those of this one: then it fails where this
    /// one does.
    pub fn includes(&self, other: &Candidate) -> bool {
        let fewer = self.counts.iter().zip(&other.counts).all(|(own, other)| other <= own);
        let shapes = match (self.shape, other.shape) {
            (Shape::Polynomial { x }, Shape::Polynomial { x: other }) => x == other && fewer,
            (
                Shape::Surface { x, y, columns },
                Shape::Surface { x: other_x, y: other_y, columns: fewer_columns },
            ) => {
                let rows = (self.counts[0] / columns, other.counts[0] / fewer_columns);
                (x, y) == (other_x, other_y) && fewer_columns <= columns && rows.1 <= rows.0
            }
            (
                Shape::Spline { x, y, size, degree },
                Shape::Spline { x: other_x, y: other_y, size: other_size, degree: other_degree },
            ) => {
                // The knots of the other are among its own.
                let is_refined = size.iter().zip(&other_size).all(|(own, other)| {
                    (own - degree).is_multiple_of(other.saturating_sub(degree).max(1))
                });
                (x, y, degree) == (other_x, other_y, other_degree) && is_refined
            }
            // Those of other sizes have other places.
            (Shape::Texture { .. }, Shape::Texture { .. }) => self.shape == other.shape,
            _ => false,
        };
        self.channels == other.channels && shapes
    }
}

fn parse(words: &str) -> Option<Candidate> {
    let mut words = words.split(' ');
    let channels = Channels::named(words.next()?).ok()?;
    let kind = words.next()?;
    let (mut x, mut y, mut size, mut numbers, mut degree, mut storage, mut texels) =
        (None, None, None, None, None, None, None);
    let mut axes: [Option<AxisSpec>; 2] = [None; 2];
    for word in words {
        let (key, value) = word.split_once('=')?;
        match key {
            "x" if kind == "texture" => axes[0] = Some(value.parse().ok()?),
            "y" if kind == "texture" => axes[1] = Some(value.parse().ok()?),
            "x" => x = Some(Along::named(value).ok()?),
            "y" => y = Some(Across::named(value).ok()?),
            "texels" => texels = Some(Texels::named(value).ok()?),
            "size" => size = Some(pair(value, 'x')?),
            "numbers" => numbers = Some(pair(value, '+').or_else(|| Some([whole(value)?, 0]))?),
            "degree" => degree = Some(whole(value)?),
            "storage" => storage = Some(Storage::named(value).ok()?),
            _ => return None,
        }
    }
    let two = |count| [count, if channels.count() == 2 { count } else { 0 }];
    let (shape, counts) = match kind {
        "polynomial" => (Shape::Polynomial { x: x? }, numbers?),
        "surface" => {
            let [columns, rows] = size?;
            let shape = Shape::Surface { x: x?, y: y?, columns };
            (columns > 0 && rows > 0).then_some((shape, two(columns * rows)))?
        }
        "spline" => {
            let (size, degree) = (size?, degree?);
            let is_good = (1..=3).contains(&degree) && size.iter().all(|&side| side > degree);
            let shape = Shape::Spline { x: x?, y: y?, size, degree };
            is_good.then_some((shape, two(size[0] * size[1])))?
        }
        "texture" => {
            let (size, [x, y]) = (size?, axes);
            let shape = Shape::texture([x?, y?], size, texels?).ok()?;
            (shape, two(size[0] * size[1]))
        }
        _ => return None,
    };
    let has_numbers = counts.iter().sum::<usize>() > 0;
    has_numbers.then_some(Candidate { channels, shape, counts, storage: storage? })
}

fn whole(word: &str) -> Option<usize> {
    word.parse().ok().filter(|number| *number <= MOST)
}

fn pair(word: &str, between: char) -> Option<[usize; 2]> {
    let (first, second) = word.split_once(between)?;
    Some([whole(first)?, whole(second)?])
}

impl Tolerance {
    /// The tolerance with these words: a number, rel:SHARE or srgb:STEPS[@RADIANCE[+DIFFUSE]].
    pub fn named(words: &str) -> Result<Self> {
        let number = |word: &str| word.trim().parse::<f64>().ok();
        let parsed = if let Some(share) = words.strip_prefix("rel:") {
            number(share).map(Tolerance::Relative)
        } else if let Some(rest) = words.strip_prefix("srgb:") {
            let (steps, rest) = rest.split_once('@').unwrap_or((rest, "1"));
            let (radiance, diffuse) = rest.split_once('+').unwrap_or((rest, "0"));
            let parts = number(steps).zip(number(radiance)).zip(number(diffuse));
            parts.map(|((steps, radiance), diffuse)| Tolerance::Srgb { steps, radiance, diffuse })
        } else {
            number(words).map(Tolerance::Absolute)
        };
        parsed.map(Tolerance::checked).unwrap_or_else(|| {
            let expected = "a number, rel:SHARE or srgb:STEPS[@RADIANCE[+DIFFUSE]]";
            let got = format!("'{words}'");
            Err(Error::bad_input("tolerance", expected, got, "give one, as in 0.004"))
        })
    }

    /// Its words.
    pub fn words(self) -> String {
        match self {
            Tolerance::Absolute(error) => format!("{error}"),
            Tolerance::Relative(share) => format!("rel:{share}"),
            Tolerance::Srgb { steps, radiance, diffuse } => {
                format!("srgb:{steps}@{radiance}+{diffuse}")
            }
        }
    }
}
