//! The slices of a table: what differs from one to the next, from the flags that can name several.

use super::TableArgs;
use crate::brdf::Fresnel;
use crate::error::{Error, Result};
use crate::request::Request;
use crate::table::axis::{Axis, AxisSpec};
use crate::table::slices::Slices;
use crate::units::{F0, Ior};

/// F0 of most dielectrics, and their index of refraction.
const DEFAULT_F0: f64 = 0.04;
const DEFAULT_IOR: f64 = 1.5;

impl TableArgs {
    /// The Fresnel model of each slice.
    pub(super) fn fresnels(&self) -> Result<Vec<Fresnel>> {
        self.fresnel.as_deref().map_or(Ok(vec![Fresnel::Schlick]), Fresnel::list)
    }

    /// The index of refraction of each slice; of a table over two axes its own.
    pub(super) fn iors(&self) -> Result<Vec<Ior>> {
        let iors = self.ior.as_ref().map_or(Ok(vec![DEFAULT_IOR]), |iors| iors.parse("ior"))?;
        iors.into_iter().map(Ior::new).collect()
    }

    /// F0 of each slice; of a table over two axes its own.
    pub(super) fn f0s(&self) -> Result<Vec<F0>> {
        match (&self.f0, &self.ior) {
            (Some(_), Some(_)) => Err(Error::bad_input(
                "f0",
                "F0 or an index of refraction",
                "both",
                "leave one of them out",
            )),
            (Some(f0s), None) => f0s.parse("f0")?.into_iter().map(F0::new).collect(),
            (None, _) => Ok(vec![F0::new(DEFAULT_F0)?]),
        }
    }

    /// The slices: along z, or at several F0 or indices of refraction.
    pub(super) fn slices(
        &self,
        request: &Request,
        f0s: &[F0],
        iors: &[Ior],
        depth: Option<usize>,
    ) -> Result<Option<Slices>> {
        match (&self.z, depth) {
            (Some(_), _) if self.f0.is_some() || self.ior.is_some() => Err(Error::bad_input(
                "z",
                "an axis, or values of F0",
                "both",
                "leave one of them out",
            )),
            (Some(z), Some(depth)) => {
                Slices::along(&Axis::new(z.parse::<AxisSpec>()?, depth)?).map(Some)
            }
            (Some(_), None) => {
                let expected = "columns, rows and slices where there is a z axis";
                Err(Error::bad_input("size", expected, "no slices", "as in 64x64x16"))
            }
            (None, Some(_)) => {
                let cure = "add a z axis, as in --z ior or --z f0";
                Err(Error::bad_input("size", "columns and rows without a z axis", "slices", cure))
            }
            (None, None) if iors.len() > 1 && request.packing().main().ior().is_some() => {
                Slices::at_iors(iors).map(Some)
            }
            (None, None) if f0s.len() > 1 => Slices::at_f0s(f0s).map(Some),
            (None, None) => Ok(None),
        }
    }
}
