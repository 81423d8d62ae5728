//! `splitsum lookup`

use super::table_args::{Job, TableArgs};
use super::{choices, output, place, print, standard_output, usage};
use crate::error::{Error, Result};
use crate::format::texels::about_components;
use crate::lookup::{
    DEFAULT_ARRAY, DEFAULT_PREFIX, Extra, Language, Lookup, Store, about, check_name,
};
use std::fs::File;
use std::io::Read;

#[derive(clap::Args)]
#[command(mut_args(as_of_code))]
pub struct LookupArgs {
    /// File of a table (.exr, .ktx2, .png or source code of splitsum); without one the flags name
    /// the table
    file: Option<String>,
    /// Language of the code [default: by the extension of the output]
    #[arg(long, value_name = "NAME", value_parser = choices::of::<Language>())]
    language: Option<Language>,
    /// Further functions, with commas between
    #[arg(
        long, value_name = "NAME[,NAME...]", value_delimiter = ',',
        value_parser = choices::of::<Extra>()
    )]
    with: Vec<Extra>,
    /// What begins the names of functions
    #[arg(long, value_name = "NAME", default_value = DEFAULT_PREFIX)]
    prefix: String,
    #[command(flatten, next_help_heading = "The table")]
    table: TableArgs,
}

/// The flags of a table whose meaning is another one here: -o is that of the code, and what a bake
/// needs besides the table's conventions is hidden.
fn as_of_code(flag: clap::Arg) -> clap::Arg {
    match flag.get_id().as_str() {
        "output" => flag.help("File for the code [default: standard output]"),
        "lookup" | "certify" | "tolerance" | "rule" | "estimator" => flag.hide(true),
        _ => flag,
    }
}

/// The extension of each language's files.
const EXTENSIONS: [(&str, Language); 6] = [
    ("wgsl", Language::Wgsl),
    ("glsl", Language::Glsl),
    ("hlsl", Language::Hlsl),
    ("metal", Language::Msl),
    ("h", Language::C),
    ("rs", Language::Rust),
];

/// The header of a file, where its metadata is, ends before this many bytes.
const HEADER: u64 = 1 << 20;

pub fn run(arguments: &LookupArgs) -> Result<()> {
    let LookupArgs { file, language, with, prefix, table } = arguments;
    let output = table.output.as_ref();
    if let (Some(file), Some(output)) = (file, output) {
        let mut files = place::Files::default();
        files.add("the table that is read", file);
        if let Some(other) = files.add("the code", output) {
            let got = format!("{output}, which is {other}");
            return Err(usage("-o", "a file of its own", &got, "name another one"));
        }
    }
    let language = match (language, output) {
        (Some(language), Some(output)) if language_of(output).is_ok_and(|own| own != *language) => {
            let got = format!("{output} for --language {language}");
            return Err(usage("-o", "a name of that language", &got, "leave one of them out"));
        }
        (Some(language), _) => *language,
        (None, Some(output)) => language_of(output)?,
        (None, None) => {
            return Err(usage("--language", "a language", "none", "name one, as in wgsl"));
        }
    };
    let job = match file {
        Some(_) if !table.is_empty_but_for_output() => {
            let cure = "leave one of them out";
            return Err(usage("lookup", "a file or the flags of a table", "both", cure));
        }
        Some(file) => TableArgs::of_flags(&command_of(file)?)?.job()?,
        None => {
            let mut table = table.clone();
            // It is the code's, and says nothing of the table's format.
            table.output = None;
            table.job()?
        }
    };
    check_name("prefix", prefix)?;
    let code = code(&job, language, with, prefix)?;
    match output {
        Some(output) => {
            output::check(output)?;
            output::write(output, code.as_bytes())
        }
        None => {
            standard_output::check()?;
            print(code.trim_end())
        }
    }
}

/// The language of a file with this name.
pub fn language_of(name: &str) -> Result<Language> {
    let known = |(extension, _): &&(&str, Language)| {
        std::path::Path::new(name).extension().is_some_and(|of| of.eq_ignore_ascii_case(extension))
    };
    EXTENSIONS.iter().find(known).map(|(_, language)| *language).ok_or_else(|| {
        let names = EXTENSIONS.map(|(extension, _)| format!(".{extension}")).join(", ");
        let cure = "rename it";
        Error::bad_input(
            "lookup",
            format!("a name that ends in {names}"),
            format!("'{name}'"),
            cure,
        )
    })
}

/// The code for a table.
pub fn code(job: &Job, language: Language, extras: &[Extra], prefix: &str) -> Result<String> {
    let Job { request, encoding, .. } = job;
    let (layout, precision) = (request.layout(), request.precision());
    let components = about_components(layout, precision, encoding.components());
    let mut about = about(layout, &components, &request.to_string());
    about.insert(0, "Lookup of a table.".into());
    let lookup = Lookup {
        layout,
        precision,
        slices_as: encoding.style().slices,
        components: encoding.components(),
        prefix,
        array: DEFAULT_ARRAY,
        by_bits: false,
        about,
    };
    lookup.code(language, Store::Passed, extras)
}

/// The flags in the metadata of a file: in the JSON of a picture or a texture, or in the comment
/// of source code.
fn command_of(path: &str) -> Result<String> {
    let failed = Error::io("read", path, "name a file of a table");
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(&failed)?;
    file.take(HEADER).read_to_end(&mut bytes).map_err(&failed)?;
    let text = String::from_utf8_lossy(&bytes);
    let after = |mark: &str| text.split_once(mark).map(|(_, rest)| rest);
    let command = after("\"command\":\"splitsum bake ")
        .and_then(|rest| rest.split('"').next())
        .or_else(|| after(": splitsum bake ").and_then(|rest| rest.lines().next()));
    command.map(str::to_owned).ok_or_else(|| {
        let expected = "the metadata of splitsum";
        let cure = "name an .exr, .ktx2, .png or source code of splitsum, or give the flags of its \
                    bake";
        Error::bad_input(path, expected, "none", cure)
    })
}
