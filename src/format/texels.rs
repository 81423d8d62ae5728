//! The texels of a file: the channels of a table and what fills up a texel, as bytes in the file's
//! order of bits.

use super::encoding::Encoding;
use crate::table::precision::Precision;
use crate::table::rgbd;
use crate::table::{Layout, Table};

/// The names of components.
pub const NAMES: [&str; 4] = ["R", "G", "B", "A"];

/// The texels of a table in a file.
#[derive(Clone, Debug)]
pub struct Texels<'a> {
    /// The table.
    pub table: &'a Table,
    /// How it is encoded.
    pub encoding: Encoding,
}

impl<'a> Texels<'a> {
    /// The texels of a table in this encoding.
    pub fn new(table: &'a Table, encoding: Encoding) -> Self {
        Texels { table, encoding }
    }

    /// Columns, rows and slices.
    pub fn size(&self) -> [usize; 3] {
        let table = self.table;
        [table.x().size(), table.y().size(), table.layout().slice_count()]
    }

    /// Components of a texel.
    pub fn components(&self) -> usize {
        self.encoding.components()
    }

    /// The names of the components.
    pub fn names(&self) -> &'static [&'static str] {
        &NAMES[..self.components()]
    }

    /// The storage.
    pub fn precision(&self) -> Precision {
        self.table.precision()
    }

    /// Bytes of a texel.
    pub fn bytes(&self) -> usize {
        match self.precision() {
            Precision::A2b10g10r10 | Precision::Rgbd8 => 4,
            precision => self.components() * precision.bytes(),
        }
    }

    /// The stored bytes of a component, little-endian: of a channel its value; else 0, or 1 of the
    /// fourth, which is alpha.
    #[inline]
    pub fn component<const N: usize>(
        &self,
        slice: usize,
        (i, j): (usize, usize),
        component: usize,
    ) -> [u8; N] {
        let channels = self.table.channels().len();
        if component >= channels {
            let mut bytes = [0; N];
            let value = if component == 3 { 1.0 } else { 0.0 };
            self.precision().write(value, &mut bytes);
            return bytes;
        }
        let value = (j * self.table.x().size() + i) * channels + component;
        self.table.bytes(slice)[value * N..].first_chunk().copied().unwrap_or([0; N])
    }

    /// The bytes of a row of a slice, texel by texel, little-endian.
    pub fn row(&self, slice: usize, j: usize) -> Vec<u8> {
        let columns = self.table.x().size();
        let mut bytes = Vec::with_capacity(columns * self.bytes());
        for i in 0..columns {
            match self.precision() {
                Precision::A2b10g10r10 => bytes.extend(self.packed_10(slice, (i, j))),
                Precision::Rgbd8 => bytes.extend(self.packed_rgbd(slice, (i, j))),
                Precision::F64 => self.extend::<8>(slice, (i, j), &mut bytes),
                Precision::F32 => self.extend::<4>(slice, (i, j), &mut bytes),
                Precision::F16 | Precision::Unorm16 => self.extend::<2>(slice, (i, j), &mut bytes),
                Precision::Unorm8 | Precision::Srgb8 => self.extend::<1>(slice, (i, j), &mut bytes),
            }
        }
        bytes
    }

    fn extend<const N: usize>(&self, slice: usize, texel: (usize, usize), bytes: &mut Vec<u8>) {
        for component in 0..self.components() {
            bytes.extend(self.component::<N>(slice, texel, component));
        }
    }

    /// Red in the lowest 10 bits, then green and blue, alpha in the highest 2.
    fn packed_10(&self, slice: usize, texel: (usize, usize)) -> [u8; 4] {
        let bits =
            |component| u32::from(u16::from_le_bytes(self.component(slice, texel, component)));
        // Alpha is 0 or 1, of which the highest 2 bits say as much as all 10.
        let bits = bits(0) | bits(1) << 10 | bits(2) << 20 | (bits(3) >> 8) << 30;
        bits.to_le_bytes()
    }

    /// The codes of three channels and their divisor.
    fn packed_rgbd(&self, slice: usize, (i, j): (usize, usize)) -> [u8; 4] {
        let (codes, divisor) = rgbd::codes(&self.table.texel(slice, i, j));
        let code = |channel: usize| codes.get(channel).copied().unwrap_or(0);
        [code(0), code(1), code(2), divisor]
    }

    /// The command that repeats the file.
    pub fn command(&self) -> String {
        self.encoding.command(self.table.command(), self.precision())
    }

    /// What each component of a texel is.
    pub fn about_components(&self) -> Vec<String> {
        about_components(self.table.layout(), self.precision(), self.components())
    }
}

/// What each component of a texel is.
pub fn about_components(layout: &Layout, precision: Precision, components: usize) -> Vec<String> {
    let about = |component: usize| {
        let name = NAMES[component];
        match (layout.channels.get(component), component) {
            (Some(channel), _) => format!("{name} = {} ({})", channel.name, channel.meaning),
            (None, 3) if precision == Precision::Rgbd8 => {
                format!("{name} = 255 times the divisor of the texel")
            }
            (None, 3) => format!("{name} = 1 (unused)"),
            (None, _) => format!("{name} = 0 (unused)"),
        }
    };
    (0..components).map(about).collect()
}
