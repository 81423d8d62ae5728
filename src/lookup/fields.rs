//! The numbers that a lookup gives: what the channels of a texel were scaled and shifted from, and
//! what follows from them.

use crate::table::{Channel, Layout};

/// A number.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Its name in code.
    pub name: String,
    /// Its meaning.
    pub meaning: String,
    /// Where it comes from.
    pub from: From,
}

/// The origin of a number.
#[derive(Clone, Debug, PartialEq)]
pub enum From {
    /// (component - offset) / scale.
    Component {
        /// The component.
        index: usize,
        /// The factor of the stored number.
        scale: f64,
        /// What was added to it.
        offset: f64,
    },
    /// The sum of two numbers before it.
    Sum(&'static str, &'static str),
    /// Their difference.
    Difference(&'static str, &'static str),
}

impl Field {
    /// Its value as an expression of the texel's components and of the numbers before it.
    pub(super) fn value(
        &self,
        component: impl Fn(usize) -> String,
        number: fn(f64) -> String,
    ) -> String {
        match &self.from {
            From::Sum(a, b) => format!("numbers.{a} + numbers.{b}"),
            From::Difference(a, b) => format!("numbers.{a} - numbers.{b}"),
            // Brackets, since a number may have a sign.
            &From::Component { index, scale, offset } => {
                let component = component(index);
                match (scale, offset) {
                    (1.0, 0.0) => component,
                    (1.0, offset) => format!("{component} - ({})", number(offset)),
                    (scale, 0.0) => format!("{component} / ({})", number(scale)),
                    (scale, offset) => {
                        format!("({component} - ({})) / ({})", number(offset), number(scale))
                    }
                }
            }
        }
    }
}

/// The numbers of a table.
pub fn fields(layout: &Layout) -> Vec<Field> {
    let mut fields: Vec<Field> = Vec::new();
    for (index, channel) in layout.channels.iter().enumerate() {
        let Some(field) = of_channel(index, channel) else { continue };
        if fields.iter().all(|known| known.name != field.name) {
            fields.push(field);
        }
    }
    // E = A + B, of which any two give the third.
    let has = |name: &str| fields.iter().any(|field| field.name == name);
    let (a, b, e) = (has("A"), has("B"), has("E"));
    let derived = match (a, b, e) {
        (true, true, false) => Some(("E", "A + B: E at F = 1", From::Sum("A", "B"))),
        (false, true, true) => Some(("A", "E - B: the scale of F0", From::Difference("E", "B"))),
        (true, false, true) => Some(("B", "E - A: the bias", From::Difference("E", "A"))),
        _ => None,
    };
    fields.extend(derived.map(|(name, meaning, from)| Field {
        name: name.into(),
        meaning: meaning.into(),
        from,
    }));
    fields
}

/// The number of a channel; none of what the caller knows without a table.
fn of_channel(index: usize, channel: &Channel) -> Option<Field> {
    let base = channel.base.as_deref()?;
    let name = match base {
        "n.v" | "r" => return None,
        "(1-E)/E" => "turquin".into(),
        "1-F" => "one_minus_F".into(),
        "1-E" => "one_minus_E".into(),
        // Words with a hyphen, as in E_oren-nayar.
        base => base.replace('-', "_"),
    };
    let meaning = match channel.meaning.split_once(" = ") {
        // A scaled channel repeats its base's name.
        Some((before, meaning)) if before == base => meaning,
        _ => &channel.meaning,
    };
    let (scale, offset) = (channel.scale, channel.offset);
    Some(Field { name, meaning: meaning.into(), from: From::Component { index, scale, offset } })
}
