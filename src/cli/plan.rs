//! `splitsum plan`

mod outputs;
mod scenes;

pub use outputs::{carry_out, is_plan, read_plan};

use super::choices;
use super::lookup::language_of;
use super::{output, place, print, print_json, resources, standard_output, usage};
use crate::approximation::{Channels, Sampler, Storage};
use crate::brdf::{Masking, Microfacet, Ndf};
use crate::choice::Choice;
use crate::error::{Error, Result};
use crate::lookup::{DEFAULT_PREFIX, check_name};
use crate::planner::check::{Checked, check};
use crate::planner::cost::Weights;
use crate::planner::engines::engines;
use crate::planner::file::PlanFile;
use crate::planner::model_errors::model_errors;
use crate::planner::page::page;
use crate::planner::report::{Report, SceneText};
use crate::planner::search::{Task, search};
use crate::planner::tolerance::Tolerance;
use crate::planner::truth::Truth;
use outputs::{output_of, table_format, write_output};
use scenes::{domain, scenes};
use std::io::Write;
use std::time::Instant;

#[derive(clap::Args)]
pub struct PlanArgs {
    /// Scenes: .gltf, .glb, or JSON with a list of materials; several have one plan
    #[arg(value_name = "SCENE")]
    scenes: Vec<String>,
    /// Perceptual roughness instead of scenes: numbers and ranges with commas between, as in
    /// 0.3..1,0.1
    #[arg(long, value_name = "R[..R][,R...]", help_heading = "The scene")]
    roughness: Option<String>,
    /// F0 of --roughness: a number or a range [default: 0..1]
    #[arg(long, value_name = "F0[..F0]", help_heading = "The scene", requires = "roughness")]
    f0: Option<String>,
    /// The least n.v that is looked up: a share of its square of a sphere's pixels lies below
    #[arg(long, value_name = "X", default_value_t = 1e-3, help_heading = "The scene")]
    nov_min: f64,
    /// The engine widens roughness at run time (specular antialiasing): ranges end at 1
    #[arg(long, help_heading = "The scene", conflicts_with = "roughness")]
    specular_antialiasing: bool,
    /// The engine raises perceptual roughness to at least this
    #[arg(
        long,
        value_name = "R",
        default_value_t = 0.0,
        help_heading = "The scene",
        conflicts_with = "roughness"
    )]
    least_roughness: f64,
    /// Ignore this share of the texels at each end, as in 0.001; what they need is then not proved
    #[arg(
        long,
        value_name = "SHARE",
        default_value_t = 0.0,
        help_heading = "The scene",
        conflicts_with = "roughness"
    )]
    ignore_texels: f64,
    /// Distribution of normals [default: ggx; charlie plans for the layers of sheen]
    #[arg(
        long, value_name = "NAME", value_parser = choices::of::<Ndf>(), help_heading = "The model"
    )]
    model: Option<Ndf>,
    /// Masking [default: as of bake]
    #[arg(
        long, value_name = "NAME", value_parser = choices::of::<Masking>(),
        help_heading = "The model"
    )]
    masking: Option<Masking>,
    /// Largest error of E(F0): a number, rel:SHARE, or srgb:STEPS[@RADIANCE[+DIFFUSE]] in steps of
    /// 8 bits at a radiance, over that of a diffuse base
    #[arg(long, value_name = "ERROR", default_value = "0.004", help_heading = "The plan")]
    tolerance: String,
    /// The shader stays as it is: it reads a bilinear texture of A and B (ab) or of B and E (be)
    #[arg(long, value_name = "ab|be", value_parser = ["ab", "be"], help_heading = "The plan")]
    texture: Option<String>,
    /// Along x of --texture, as of bake: nov, with sqrt and edges where the shader has them
    #[arg(
        long,
        value_name = "AXIS",
        default_value = "nov",
        help_heading = "The plan",
        requires = "texture"
    )]
    x: String,
    /// Along y of --texture: roughness or alpha
    #[arg(
        long,
        value_name = "AXIS",
        default_value = "roughness",
        help_heading = "The plan",
        requires = "texture"
    )]
    y: String,
    /// Storage of --texture: f16, unorm16 or unorm8 [default: the cheapest that does]
    #[arg(
        long, value_name = "NAME", value_parser = ["f16", "unorm16", "unorm8"],
        help_heading = "The plan", requires = "texture"
    )]
    storage: Option<String>,
    /// What is to be small: bytes=X,loads=X,operations=X weighs them
    #[arg(long, value_name = "WEIGHTS", help_heading = "The plan")]
    cost: Option<String>,
    /// File of the plan, which --check and bake --config read [default: out/plan.toml]
    #[arg(short, long, value_name = "FILE.toml", help_heading = "The output")]
    output: Option<String>,
    /// Write lookup code with the numbers: .wgsl, .glsl, .hlsl, .metal, .h or .rs; several times
    /// for several
    #[arg(long, value_name = "FILE", help_heading = "The output")]
    code: Vec<String>,
    /// Write the control points as they are: .png, .ktx2, .dds, .npy, .raw, .js, .ts or .txt
    #[arg(long, value_name = "FILE", help_heading = "The output")]
    table: Vec<String>,
    /// What begins the names in code
    #[arg(long, value_name = "NAME", default_value = DEFAULT_PREFIX, help_heading = "The output")]
    prefix: String,
    /// Write a page with pictures
    #[arg(long, value_name = "FILE.html", help_heading = "The output")]
    html: Option<String>,
    /// Print the report as JSON
    #[arg(long, help_heading = "The output")]
    json: bool,
    /// Verify a plan from scratch instead: its numbers by the reference rule, its proofs in f64
    #[arg(
        long, value_name = "FILE.toml", help_heading = "The check",
        conflicts_with_all = [
            "scenes", "roughness", "f0", "output", "code", "table", "html", "model", "masking",
            "cost", "texture", "specular_antialiasing", "least_roughness", "ignore_texels"
        ]
    )]
    check: Option<String>,
}

/// The file of a plan without a wish.
const DEFAULT_OUTPUT: &str = "out/plan.toml";

/// Bytes that a search takes at the most, besides the scene.
const SEARCH: u64 = 256 << 20;

pub fn run(arguments: &PlanArgs) -> Result<()> {
    if let Some(file) = &arguments.check {
        return run_check(file, arguments.json);
    }
    let lobe = lobe(arguments)?;
    let tolerance = Tolerance::named(&arguments.tolerance)?;
    let weights = arguments.cost.as_deref().map_or(Ok(Weights::default()), Weights::named)?;
    let sampler = sampler(arguments)?;
    check_name("prefix", &arguments.prefix)?;
    arguments.code.iter().try_for_each(|name| language_of(name).map(drop))?;
    let is_texture = sampler.is_some();
    arguments.table.iter().try_for_each(|name| table_format(name, is_texture).map(drop))?;
    if !(0.0..1.0).contains(&arguments.nov_min) {
        let got = arguments.nov_min.to_string();
        return Err(Error::bad_input("nov-min", "0 to below 1", got, "give one in that range"));
    }
    let output = arguments.output.as_deref().unwrap_or(DEFAULT_OUTPUT);
    check_files(arguments, output)?;
    resources::start(SEARCH, None, resources::ALLOW)?;
    let scenes = scenes(arguments)?;
    let started = Instant::now();
    let domain = domain(&scenes, lobe, arguments)?;
    let task = Task { domain, tolerance, weights, sampler };
    let truth = Truth::new(lobe);
    let outcome = search(&task, &truth);
    if outcome.choice.is_empty() {
        return Err(unmet(&task, outcome.trials.len()));
    }
    let mut plan = PlanFile::new(&task, &truth, &outcome, command(arguments))?;
    let seconds = started.elapsed().as_secs_f64();
    plan.outputs = made(arguments).map(|name| output_of(output, name, arguments)).collect();
    let report = Report {
        scenes: scenes.iter().map(SceneText::new).collect(),
        model_errors: model_errors(&task.domain, &truth),
        engines: engines(&task.domain, tolerance, &truth)?,
        plan,
        seconds,
    };
    write(arguments, output, &report)?;
    if let Some(name) = &arguments.html {
        output::write(name, page(&report, &outcome, &truth)?.as_bytes())?;
        say(arguments, &format!("wrote     {name}"));
    }
    if arguments.json {
        return print_json(&report);
    }
    print(&report.text()?)
}

/// No candidate of so many meets the tolerance.
fn unmet(task: &Task, candidates: usize) -> Error {
    let (got, cure) = match task.sampler {
        Some(_) => (
            format!("{candidates} textures of up to 256 x 256 texels that miss it"),
            "give a larger tolerance, a rougher range or axes such as nov,sqrt,edges; next to a \
             mirror no texture over n.v and roughness converges: change the shader, without \
             --texture",
        ),
        None => (
            format!(
                "{candidates} candidates that miss it, the largest of each kind among them (where \
                 these miss it by far, smaller ones are not tried)"
            ),
            "give a larger tolerance, a smaller range or a larger --nov-min",
        ),
    };
    Error::bad_input("tolerance", "one that a candidate meets", got, cure)
}

/// The texture that a shader reads.
fn sampler(arguments: &PlanArgs) -> Result<Option<Sampler>> {
    let channels = match arguments.texture.as_deref() {
        None => return Ok(None),
        Some("ab") => Channels::ScaleBias,
        Some(_) => Channels::BiasEnergy,
    };
    if let Some(name) = arguments.code.first() {
        let cure = "write the texture with --table, and its lookup with splitsum lookup";
        return Err(usage("--code", "none with --texture", name, cure));
    }
    let storage = arguments.storage.as_deref().map(Storage::named).transpose()?;
    Sampler::new(channels, [arguments.x.parse()?, arguments.y.parse()?], storage).map(Some)
}

/// The files that are made of the choice.
fn made(arguments: &PlanArgs) -> impl Iterator<Item = &String> {
    arguments.code.iter().chain(&arguments.table)
}

/// The lobe that is planned for.
fn lobe(arguments: &PlanArgs) -> Result<Microfacet> {
    Microfacet::new(arguments.model.unwrap_or(Ndf::Ggx), arguments.masking)
}

/// Every file that is read or written is another one, and those that are written can be.
fn check_files(arguments: &PlanArgs, output: &str) -> Result<()> {
    let mut files = place::Files::default();
    for scene in &arguments.scenes {
        files.add("a scene", scene);
    }
    let code = arguments.code.iter().map(|name| ("--code", name.as_str()));
    let table = arguments.table.iter().map(|name| ("--table", name.as_str()));
    let html = arguments.html.iter().map(|name| ("--html", name.as_str()));
    for (flag, name) in [("-o", output)].into_iter().chain(code).chain(table).chain(html) {
        if name == "-" {
            return Err(usage(flag, "a file", "-", "name one"));
        }
        if let Some(other) = files.add(format!("the file of {flag}"), name) {
            let got = format!("{name}, which is {other}");
            return Err(usage(flag, "a file of its own", &got, "name another one"));
        }
        output::check(name)?;
    }
    if arguments.json { standard_output::check() } else { Ok(()) }
}

/// The command that repeats the plan.
fn command(arguments: &PlanArgs) -> String {
    let mut words = vec!["splitsum plan".to_owned()];
    let mut add = |word: String| {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=+@:,".contains(c);
        let quoted = !word.is_empty() && word.chars().all(plain);
        words.push(if quoted { word } else { format!("'{}'", word.replace('\'', "'\\''")) });
    };
    let PlanArgs { scenes, roughness, f0, nov_min, tolerance, cost, model, masking, .. } =
        arguments;
    scenes.iter().for_each(|scene| add(scene.clone()));
    let mut flag = |name: &str, value: Option<String>| {
        if let Some(value) = value {
            add(name.to_owned());
            add(value);
        }
    };
    flag("--roughness", roughness.clone());
    flag("--f0", f0.clone());
    flag("--nov-min", Some(nov_min.to_string()));
    flag("--tolerance", Some(tolerance.clone()));
    flag("--cost", cost.clone());
    if arguments.texture.is_some() {
        flag("--texture", arguments.texture.clone());
        flag("--x", Some(arguments.x.clone()));
        flag("--y", Some(arguments.y.clone()));
        flag("--storage", arguments.storage.clone());
    }
    flag("--model", model.map(|model| model.to_string()));
    flag("--masking", masking.map(|masking| masking.to_string()));
    let given = |number: f64| (number > 0.0).then(|| number.to_string());
    flag("--least-roughness", given(arguments.least_roughness));
    flag("--ignore-texels", given(arguments.ignore_texels));
    if arguments.specular_antialiasing {
        add("--specular-antialiasing".to_owned());
    }
    words.join(" ")
}

fn write(arguments: &PlanArgs, output: &str, report: &Report) -> Result<()> {
    let text = toml::to_string(&report.plan)
        .map_err(|error| Error::Internal(format!("plan as TOML: {error}")))?;
    output::write(output, text.as_bytes())?;
    say(arguments, &format!("wrote     {output}"));
    for name in made(arguments) {
        write_output(&report.plan, name, &arguments.prefix)?;
        say(arguments, &format!("wrote     {name}"));
    }
    Ok(())
}

fn say(arguments: &PlanArgs, text: &str) {
    if !arguments.json {
        let _ = writeln!(std::io::stderr(), "{text}");
    }
}

fn run_check(path: &str, json: bool) -> Result<()> {
    let plan = read_plan(path)?;
    if json {
        standard_output::check()?;
    }
    resources::start(SEARCH, None, resources::ALLOW)?;
    let Checked { worst, proved, multipliers, not_found } = check(&plan)?;
    let mut lines = vec![format!("checked   {path}: it holds")];
    for (chosen, worst) in plan.choice.iter().zip(&worst) {
        lines.push(format!(
            "error     {:.2e} of E(F0) at the most, {:.3} of the tolerance, at {} points by the \
             reference rule; n.v = {:.4}, roughness {:.4}, F0 = {}; {}",
            worst.error.abs(),
            worst.share,
            worst.points,
            worst.nov,
            worst.roughness,
            worst.f0,
            chosen.candidate
        ));
        if let Some(bound) = worst.bound {
            lines.push(format!("bound     {}", bound.text(chosen.roughness[0])));
        }
    }
    lines.push(format!(
        "cheaper   {proved} candidates fail, by {multipliers} points and multipliers; of \
         {not_found} no good numbers were found"
    ));
    print(&lines.join("\n"))
}
