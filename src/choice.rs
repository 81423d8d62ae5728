//! Choices that have a word each, the same on the command line, in configurations and in metadata.

use crate::error::{Error, Result};

/// An enumeration whose variants have words.
pub trait Choice: Copy + PartialEq + 'static {
    /// The name of the choice, as errors call it.
    const WHAT: &'static str;

    /// Every variant, in the order in which they are listed.
    const ALL: &'static [Self];

    /// The variant's word.
    fn word(self) -> &'static str;

    /// The variant in a line, for `--help`.
    fn about(self) -> &'static str;

    /// The variant with this word; an error that lists all words if there is none.
    fn named(word: &str) -> Result<Self> {
        let found = Self::ALL.iter().find(|choice| choice.word() == word);
        found.copied().ok_or_else(|| {
            Error::bad_input(Self::WHAT, words(Self::ALL), format!("'{word}'"), "name one of these")
        })
    }
}

/// The words of these choices with commas between.
pub fn words<C: Choice>(choices: &[C]) -> String {
    choices.iter().map(|choice| choice.word()).collect::<Vec<_>>().join(", ")
}

/// Implements [`Choice`] from a list of variants with word and line, or only what follows from it:
/// text and serde by the word.
macro_rules! choice {
    ($name:ident, $what:literal, { $($variant:ident = $word:literal, $about:literal;)+ }) => {
        impl $crate::choice::Choice for $name {
            const WHAT: &'static str = $what;
            const ALL: &'static [Self] = &[$($name::$variant),+];

            fn word(self) -> &'static str {
                match self {
                    $($name::$variant => $word),+
                }
            }

            fn about(self) -> &'static str {
                match self {
                    $($name::$variant => $about),+
                }
            }
        }

        $crate::choice::choice!($name);
    };
    ($name:ident) => {
        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad($crate::choice::Choice::word(*self))
            }
        }

        #[cfg(feature = "serde")]
        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(
                &self,
                to: S,
            ) -> std::result::Result<S::Ok, S::Error> {
                to.serialize_str($crate::choice::Choice::word(*self))
            }
        }

        #[cfg(feature = "serde")]
        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(
                from: D,
            ) -> std::result::Result<Self, D::Error> {
                let word = String::deserialize(from)?;
                $crate::choice::Choice::named(&word).map_err(serde::de::Error::custom)
            }
        }
    };
}
pub(crate) use choice;
