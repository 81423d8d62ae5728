//! What is known of tables that others ship.

use crate::cli::{print, print_json};
use crate::error::Result;
use crate::verify::{Shipped, catalogue};

pub fn run(json: bool) -> Result<()> {
    let tables = catalogue()?;
    if json {
        return print_json(&tables);
    }
    let entry = |table: &Shipped| {
        let Shipped { name, version, file, convention, sampler, fault, source } = table;
        format!(
            "{name} ({version})\n  file        {file}\n  convention  {convention}\n  sampler     \
             {sampler}\n  fault       {fault}\n  source      {source}"
        )
    };
    print(&tables.iter().map(entry).collect::<Vec<_>>().join("\n\n"))
}
