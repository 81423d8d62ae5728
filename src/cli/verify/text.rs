//! The report of a table for people.

use crate::verify::{
    ChannelReport, Decision, Errors, Fault, FileFacts, Place, Report, Sampler, Status,
    offsets_in_words,
};

/// The report for people.
pub fn text(report: &Report) -> String {
    let mut lines = Vec::new();
    let mut say = |name: &str, text: String| lines.push(format!("{name:10}{text}"));
    let FileFacts { name, container, size: [columns, rows, slices], storage, steps, notes, .. } =
        &report.file;
    let slices = if *slices > 1 { format!(" x {slices}") } else { String::new() };
    let steps = if steps == storage { String::new() } else { format!(", in steps of {steps}") };
    say("file", format!("{name}: {container}, {columns} x {rows}{slices}, {storage}{steps}"));
    for note in notes {
        say("", note.clone());
    }
    match (&report.convention, report.distance) {
        (Some(words), _) => {
            say("channels", words.channels.join(", "));
            say("x", words.x.clone());
            say("y", words.y.clone());
            if let Some(offsets) = words.offsets {
                say("nodes", format!("offsets by the values: {}", offsets_in_words(offsets)));
            }
            if let Some(Sampler { estimator, left: (middle, largest) }) = &words.sampler {
                let text =
                    format!("{estimator}: repeats it to {middle:.1e}, at most {largest:.1e}");
                say("sampler", text);
            }
        }
        (None, Some(distance)) => say(
            "unknown",
            format!(
                "no convention of {} tried fits: the best is off by {:.1} % of a channel's spread \
                 on the average",
                report.tried,
                100.0 * distance
            ),
        ),
        (None, None) => {
            say("unknown", "no channel varies, or too many of its values are no numbers".into())
        }
    }
    // Of what is unknown the nearest is chance.
    let known = report.decisions.iter().filter(|_| report.status == Status::Known);
    for Decision { dimension, choice, ratio, decided, proved, others } in known {
        let sure = match decided {
            true if *proved => "proved by the sampler".into(),
            true => format!("the next is {ratio:.3} times as far"),
            false => format!("undecided: {} fit as well", others.join(", ")),
        };
        let sure = if ratio.is_infinite() { "no other is possible".into() } else { sure };
        say("", format!("{dimension:24}{choice:27} {sure}"));
    }
    for ChannelReport { name, meaning, stored, sampled, .. } in &report.channels {
        let of = |errors: &Errors| {
            let Place { texel: (i, j), nov, roughness, .. } = errors.worst;
            let (i, j) = (short(i), short(j));
            format!(
                "mean {:.1e}, 99 % {:.1e}, largest {:.2e} at texel ({i}, {j}), nov {nov:.4}, \
                 roughness {roughness:.4}",
                errors.mean, errors.most, errors.largest
            )
        };
        say("error", format!("{name} ({meaning}) stored:  {}", of(stored)));
        say("", format!("{name} ({meaning}) sampled: {}", of(sampled)));
    }
    for Fault { name, text } in &report.faults {
        say("fault", format!("{name}: {text}"));
    }
    if let Some(words) = &report.convention {
        let none = "no flags of splitsum bake say this".to_owned();
        say("like it", words.command.clone().unwrap_or(none));
        if let Some(right) =
            words.right.clone().filter(|right| Some(right) != words.command.as_ref())
        {
            say("right", right);
        }
    }
    say("time", format!("{:.2} s", report.seconds));
    lines.join("\n")
}

/// A place in hundredths of a texel.
fn short(texel: f64) -> String {
    format!("{:?}", (texel * 100.0).round() / 100.0).trim_end_matches(".0").to_owned()
}
