//! The scene as it was read: its roughnesses as a chart, its lobes as a table, notes.

use super::super::report::{LobeText, Report, SceneText, range};
use super::roughness;
use crate::html::{Column, and_more, escape, table};

/// Lobes of a scene that are listed; the report in JSON has all.
const MOST_LOBES: usize = 300;

/// Notes that are listed.
const MOST_NOTES: usize = 60;

/// The section of the scenes.
pub fn section(report: &Report) -> String {
    let lobes: Vec<&LobeText> = report.scenes.iter().flat_map(|scene| &scene.lobes).collect();
    let mut text = "<h2>The scene</h2>\n".to_owned();
    text += &roughness::chart(&lobes);
    for scene in &report.scenes {
        text += &of_scene(scene, report.scenes.len() > 1);
    }
    text
}

fn of_scene(scene: &SceneText, is_named: bool) -> String {
    let SceneText { name, lobes, notes } = scene;
    let mut text = match is_named {
        true => format!("<p><b>{}</b></p>\n", escape(name)),
        false => String::new(),
    };
    let row = |lobe: &LobeText| {
        let from: Vec<String> = lobe.from.iter().map(|line| escape(line)).collect();
        vec![
            escape(&lobe.material),
            lobe.layer.to_string(),
            range(lobe.roughness),
            range(lobe.f0),
            range(lobe.f90),
            format!("<div class=\"name\">{}</div>", from.join("<br>")),
        ]
    };
    let columns = [
        Column::Text("material"),
        Column::Text("layer"),
        Column::Number("roughness"),
        Column::Number("F0"),
        Column::Number("F90"),
        Column::Text("read from"),
    ];
    let rows: Vec<Vec<String>> = lobes.iter().take(MOST_LOBES).map(row).collect();
    text += &table(&columns, &rows);
    text += &and_more(lobes.len(), MOST_LOBES, "lobes");
    if !notes.is_empty() {
        text += "<p>Notes:</p>\n<ul>\n";
        for note in notes.iter().take(MOST_NOTES) {
            text += &format!("<li>{}</li>\n", escape(note));
        }
        text += "</ul>\n";
        text += &and_more(notes.len(), MOST_NOTES, "notes");
    }
    text
}
