//! A checked job: a table, its axes, its accuracy and its storage. It prints itself as the command
//! that repeats it.

use crate::brdf::{Fresnel, Microfacet, Ndf};
use crate::error::{Error, Result};
use crate::integrate::Integrand;
use crate::integrate::estimator::Estimator;
use crate::integrate::rule::Rule;
use crate::integrate::rules::RULES;
use crate::lut::{Content, Lut, Packing, Source};
use crate::table::Layout;
use crate::table::axis::{Axis, AxisSpec, Parameter};
use crate::table::grid::Grid;
use crate::table::precision::Precision;
use crate::table::slices::Slices;
use crate::units::short;
use std::fmt;

/// The accuracy of a table's values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Accuracy {
    /// Certified: every value is the true one, rounded once to the nearest. Not for f32 and rgbd8.
    Rounded,
    /// Certified: every value is within this absolute error before it is rounded. For f32 and
    /// rgbd8.
    Within(f64),
    /// Not certified: integrals within this absolute error, by the cheapest rule.
    Tolerance(f64),
    /// Not certified: integrals by this rule.
    Rule(Rule),
    /// Not certified and without a bound: an engine's own estimator.
    Estimator(Estimator),
}

impl Accuracy {
    /// Certified; what is stored within a tolerance within the one that befits it and the lobe,
    /// which f64 by the rules of devices keeps.
    pub fn by_default(packing: &Packing, precision: Precision) -> Self {
        if precision.is_rounded_once() {
            return Accuracy::Rounded;
        }
        let sharpest = |lut: &Lut| Rule::sharpest_device_bound(lut.integrand());
        let tolerance = precision.default_tolerance();
        Accuracy::Within(packing.luts().iter().map(sharpest).fold(tolerance, f64::max))
    }

    /// Not certified, with a tolerance that befits the precision and that a device can keep of the
    /// table's integrands.
    pub fn uncertified(packing: &Packing, precision: Precision) -> Self {
        let of_device = |lut: &Lut| Rule::device_tolerance(lut.integrand());
        let tolerance = precision.default_tolerance();
        Accuracy::Tolerance(packing.luts().iter().map(of_device).fold(tolerance, f64::max))
    }
}

/// A checked job.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// What a texel of each slice holds; one of a table without slices. None is empty.
    packings: Vec<Packing>,
    layout: Layout,
    /// The parameters of each slice's texels.
    grids: Vec<Grid>,
    accuracy: Accuracy,
    precision: Precision,
}

/// Texels along each axis when no size is given.
pub const DEFAULT_SIZE: usize = 128;

impl Request {
    /// Checks that the parts fit together.
    pub fn new(
        packing: impl Into<Packing>,
        x: Axis,
        y: Axis,
        accuracy: Accuracy,
        precision: Precision,
    ) -> Result<Self> {
        let packing = packing.into();
        let grid = Grid::about(&x, &y, packing.critical())?;
        for lut in packing.luts() {
            match lut.integrand() {
                Integrand::Specular(lobe, _) => {
                    check_finite(lobe, &grid)?;
                    check_alpha(lobe, &grid)?;
                }
                Integrand::Glass(interface) => check_alpha(interface.lobe(), &grid)?,
                Integrand::Diffuse(_) => (),
            }
        }
        check_accuracy(&packing, &grid, accuracy, precision)?;
        check_channels(&packing, precision)?;
        let layout = Layout { x, y, slices: None, channels: packing.channels() };
        Ok(Request { packings: vec![packing], layout, grids: vec![grid], accuracy, precision })
    }

    /// The table that every engine needs: x = n·v, y = perceptual roughness, texel centres;
    /// certified.
    pub fn with_default_axes(
        packing: impl Into<Packing>,
        size: (usize, usize),
        precision: Precision,
    ) -> Result<Self> {
        let packing = packing.into();
        let x = Axis::new(AxisSpec::of(Parameter::Nov), size.0)?;
        let y = Axis::new(AxisSpec::of(Parameter::Roughness), size.1)?;
        let accuracy = Accuracy::by_default(&packing, precision);
        Request::new(packing, x, y, accuracy, precision)
    }

    /// The same table in slices of a parameter; an error where it does not vary with it.
    pub fn with_slices(self, slices: Slices) -> Result<Self> {
        let Some((parameter, values)) = slices.parameter() else {
            return Err(Error::Internal("slices of models without their tables".into()));
        };
        let at = |&value: &f64| self.packing().at(parameter, value);
        let packings = values.iter().map(at).collect::<Result<Vec<Packing>>>()?;
        self.in_slices(packings, slices)
    }

    /// The same table with each of these Fresnel models, at least two, in a slice of its own; an
    /// error where the table has none, or where its channels are not those of every model.
    pub fn with_fresnel(self, models: &[Fresnel]) -> Result<Self> {
        let with = |&model: &Fresnel| self.packing().with_fresnel(model);
        let packings = models.iter().map(with).collect::<Result<Vec<Packing>>>()?;
        let words = models.iter().map(ToString::to_string).collect();
        self.in_slices(packings, Slices::of_models("fresnel", words)?)
    }

    fn in_slices(mut self, packings: Vec<Packing>, slices: Slices) -> Result<Self> {
        let Layout { x, y, .. } = &self.layout;
        let grid = |packing: &Packing| Grid::about(x, y, packing.critical());
        self.grids = packings.iter().map(grid).collect::<Result<_>>()?;
        for (packing, grid) in packings.iter().zip(&self.grids) {
            check_accuracy(packing, grid, self.accuracy, self.precision)?;
        }
        self.packings = packings;
        self.layout.slices = Some(slices);
        Ok(self)
    }

    /// The same table with another accuracy and storage.
    pub fn stored(&self, accuracy: Accuracy, precision: Precision) -> Result<Self> {
        for packing in &self.packings {
            check_accuracy(packing, self.grid(), accuracy, precision)?;
        }
        check_channels(self.packing(), precision)?;
        Ok(Request { accuracy, precision, ..self.clone() })
    }

    /// What a texel of the first slice holds.
    pub fn packing(&self) -> &Packing {
        &self.packings[0]
    }

    /// What a texel of each slice holds; of a table without slices any.
    pub fn packings(&self) -> &[Packing] {
        &self.packings
    }

    /// Axes, slices and channels.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The parameters of the first slice's texels; those of the others differ where n·v is centred
    /// on the critical angle.
    pub fn grid(&self) -> &Grid {
        &self.grids[0]
    }

    /// The parameters of the texels of each slice; of a table without slices one's.
    pub fn grids(&self) -> &[Grid] {
        &self.grids
    }

    /// The accuracy.
    pub fn accuracy(&self) -> Accuracy {
        self.accuracy
    }

    /// The storage.
    pub fn precision(&self) -> Precision {
        self.precision
    }

    /// Texels of all slices.
    pub fn texels(&self) -> usize {
        self.grid().len() * self.layout.slice_count()
    }

    /// Bytes of the table.
    pub fn bytes(&self) -> usize {
        self.layout.slice_count() * self.layout.values_of_slice() * self.precision.bytes()
    }
}

/// Refuses a grid with a point where the albedo is infinite.
fn check_finite(lobe: Microfacet, grid: &Grid) -> Result<()> {
    if lobe.diverges_at_grazing() && grid.mus.contains(&0.0) {
        let got = "n.v = 0, where this albedo is infinite";
        let cure = "add min=1e-4 to the axis, or choose texel centres";
        return Err(Error::bad_input("axis of n.v", "n.v > 0", got, cure));
    }
    Ok(())
}

/// Refuses an α that the distribution has not.
fn check_alpha(lobe: Microfacet, grid: &Grid) -> Result<()> {
    let most = lobe.ndf.most_alpha();
    match grid.alphas.iter().find(|&&alpha| alpha > most) {
        None => Ok(()),
        Some(alpha) => {
            let (expected, got) = (format!("alpha up to {most} for {}", lobe.ndf), short(*alpha));
            Err(Error::bad_input("axis of roughness", expected, got, "leave out unclamped"))
        }
    }
}

/// Refuses channels for which the storage has no bits.
fn check_channels(packing: &Packing, precision: Precision) -> Result<()> {
    let contents = packing.contents();
    let wrong = |expected: &str, got: String| {
        let what = format!("channels in {precision}");
        Err(Error::bad_input(what, expected, got, "choose others, or another precision"))
    };
    match (precision, contents.get(3)) {
        (Precision::Rgbd8, Some(_)) => wrong("at most 3, since D is the fourth", "4".into()),
        // The fourth has 2 bits, or is on no curve.
        (Precision::A2b10g10r10 | Precision::Srgb8, Some(&Content { source, offset, .. }))
            if source != Source::Constant || ![0.0, 1.0].contains(&offset) =>
        {
            wrong("0 or 1 as the fourth", packing.channels().swap_remove(3).name)
        }
        _ => Ok(()),
    }
}

/// Refuses an accuracy that the storage does not have or no rule keeps.
fn check_accuracy(
    packing: &Packing,
    grid: &Grid,
    accuracy: Accuracy,
    precision: Precision,
) -> Result<()> {
    packing.luts().iter().try_for_each(|lut| check_part(lut, grid, accuracy, precision))
}

/// Refuses n·v = 0, where an estimator divides by 0.
fn check_views(grid: &Grid) -> Result<()> {
    if !grid.mus.contains(&0.0) {
        return Ok(());
    }
    let cure = "add min=1e-4 to the axis, or choose texel centres";
    Err(Error::bad_input("axis of n.v", "n.v > 0 for an estimator", "n.v = 0", cure))
}

fn check_part(lut: &Lut, grid: &Grid, accuracy: Accuracy, precision: Precision) -> Result<()> {
    let integrand = lut.integrand();
    match (accuracy, precision) {
        (Accuracy::Rounded | Accuracy::Within(_), Precision::F64) => {
            let cure = "choose another, or values that are not certified";
            Err(Error::bad_input("precision", "one that files have, to be certified", "f64", cure))
        }
        (Accuracy::Rounded, precision) if !precision.is_rounded_once() => {
            let got = format!("{precision} rounded correctly");
            let cure = "certify it within a tolerance";
            Err(Error::bad_input(
                "accuracy",
                "a storage with coarser steps, to be rounded correctly",
                got,
                cure,
            ))
        }
        (Accuracy::Rounded, _) => Ok(()),
        (Accuracy::Within(_), precision) if precision.is_rounded_once() => {
            let expected = format!("none where values are rounded to {precision} correctly");
            Err(Error::bad_input(
                "tolerance",
                expected,
                "a tolerance",
                "leave it out, or set certify to off",
            ))
        }
        (Accuracy::Within(tolerance) | Accuracy::Tolerance(tolerance), _) => {
            // Written so that NaN fails.
            if tolerance <= 0.1 && Rule::for_cpu(integrand, tolerance, grid.len()).is_some() {
                return Ok(());
            }
            Err(Error::bad_input(
                "tolerance",
                format!("an absolute error from {:e} to 0.1", Rule::sharpest_bound(integrand)),
                format!("{tolerance:e}"),
                "give one in that range",
            ))
        }
        (Accuracy::Estimator(Estimator::WrongSide), _) => match integrand {
            Integrand::Glass(_) if !lut.needs_averages() => Ok(()),
            _ => {
                let (expected, cure) = ("R and T of glass", "leave out the estimator");
                Err(Error::bad_input("estimator", expected, lut.name(), cure))
            }
        },
        (Accuracy::Estimator(Estimator::Hammersley(_)), _) => match integrand {
            Integrand::Specular(lobe, _) if lobe.ndf == Ndf::Ggx && !lut.needs_averages() => {
                check_views(grid)
            }
            _ => {
                let cure = "leave out the other channels, or the estimator";
                let got = match lut {
                    Lut::Energy(_) => "what averages are needed for".to_owned(),
                    Lut::Dfg(dfg) => format!("those of {}", dfg.lobe().ndf),
                    Lut::Glass(_) => "those of glass".to_owned(),
                    Lut::Diffuse(diffuse) => format!("that of {diffuse}"),
                };
                Err(Error::bad_input("estimator", "integrals of ggx alone", got, cure))
            }
        },
        (Accuracy::Rule(rule), _) if !RULES.contains(&rule) => {
            let cure = "take it as Rule::named gives it";
            Err(Error::bad_input("rule", "one with its own bounds", rule.name, cure))
        }
        (Accuracy::Rule(rule), _) => {
            let bounded = |&alpha: &f64| rule.bound_at(integrand, 0.0, alpha).is_finite();
            if rule.applies_to(integrand) && grid.alphas.iter().all(bounded) {
                return Ok(());
            }
            Err(Error::bad_input(
                "rule",
                "one that serves for the model at every roughness of the axis",
                rule.name,
                "choose reference, one of h56 to h6144, or closed-form for a diffuse \
                 lobe",
            ))
        }
    }
}

impl fmt::Display for Request {
    /// The command that repeats the job.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Layout { x, y, slices, .. } = &self.layout;
        let main = self.packing().main();
        write!(f, "splitsum bake {}", self.packing().flags())?;
        match (main.fresnel(), slices) {
            (None | Some(Fresnel::Schlick), _) => (),
            // The list of slices names it.
            (Some(_), Some(slices)) if slices.parameter().is_none() => (),
            (Some(fresnel), _) => write!(f, " --fresnel {fresnel}")?,
        }
        let spec = slices.as_ref().and_then(Slices::spec);
        match (slices, spec, main.f0().map(|f0| ("f0", f0)).or(main.ior().map(|n| ("ior", n)))) {
            (Some(slices), None, _) => write!(f, " --{} {}", slices.word(), slices.list())?,
            (None, _, Some((word, value))) => write!(f, " --{word} {}", short(value))?,
            _ => (),
        }
        write!(f, " --size {}x{}", x.size(), y.size())?;
        if let (Some(slices), Some(_)) = (slices, spec) {
            write!(f, "x{}", slices.count())?;
        }
        write!(f, " --x {} --y {}", x.spec(), y.spec())?;
        if let Some(spec) = spec {
            write!(f, " --z {spec}")?;
        }
        write!(f, " --precision {}", self.precision)?;
        match self.accuracy {
            Accuracy::Rounded => Ok(()),
            Accuracy::Within(tolerance) => write!(f, " --tolerance {tolerance:e}"),
            Accuracy::Tolerance(tolerance) => write!(f, " --certify off --tolerance {tolerance:e}"),
            Accuracy::Rule(rule) => write!(f, " --certify off --rule {}", rule.name),
            Accuracy::Estimator(estimator) => write!(f, " --estimator {estimator}"),
        }
    }
}
