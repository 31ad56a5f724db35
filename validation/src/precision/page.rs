//! The report: one file, with the diagrams in it.

use std::fmt::Write as _;

use super::{BUDGETS, DiagramError, Point, diagram, front, meaning, recommended};

/// Origin of the figures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// Day of the runs, as `2026-01-31`.
    pub date: String,
    /// Processor, cores and system, and other load.
    pub machine: String,
    /// The command that reproduces them.
    pub command: String,
}

const STYLE: &str = "body{font:15px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#222}\
    table{border-collapse:collapse;margin:1em 0;font-size:14px}th,td{padding:.2em .8em;border-bottom:1px solid #ddd;\
    text-align:left}td.number{text-align:right;font-variant-numeric:tabular-nums}tr.front{background:#eef4fb}\
    code{font-size:13px}svg{max-width:100%;height:auto}";

/// The report as self-contained HTML: recommendations, and diagram and table of every case.
///
/// # Errors
/// As [`diagram`]; a case without any error has no diagram, and says so.
pub fn page(points: &[Point], origin: &Origin) -> Result<String, DiagramError> {
    let cases = by_case(points);
    let mut text = String::new();
    let Origin { date, machine, command } = origin;
    let (date, machine, command) = (escaped(date), escaped(machine), escaped(command));
    // Writing to a string does not fail, here and below.
    let _ = write!(
        text,
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <title>sorb: run time against error</title>\n<style>{STYLE}</style>\n</head>\n<body>\n\
         <h1>Run time against error</h1>\n\
         <p>Made by <code>{command}</code> on {date}: {machine}. Run time is that of the simulator alone, of all \
         worlds of a case together; runs of less than 2 s are the best of up to three. Errors are the same on every \
         machine.</p>\n"
    );
    recommendations(&mut text, &cases);
    for points in &cases {
        case(&mut text, points)?;
    }
    text.push_str("</body>\n</html>\n");
    Ok(text)
}

/// The points of every case, in order.
fn by_case(points: &[Point]) -> Vec<&[Point]> {
    points.chunk_by(|a, b| a.case == b.case).collect()
}

/// The fastest setting within every budget.
fn recommendations(text: &mut String, cases: &[&[Point]]) {
    text.push_str(
        "<h2>What to take</h2>\n<p>The fastest run of the sweep whose error is within a budget.</p>\n\
         <table>\n<tr><th>case</th><th>error within</th><th>take</th><th>error</th><th>run time</th></tr>\n",
    );
    for points in cases {
        let name = points.first().map_or("", |point| point.case);
        for (index, budget) in BUDGETS.into_iter().enumerate() {
            let name = if index == 0 { name } else { "" };
            let within = share(budget);
            let _ = match recommended(points, budget) {
                Some(point) => writeln!(
                    text,
                    "<tr><td>{name}</td><td>{within}</td><td><code>{}</code></td><td class=\"number\">{}</td>\
                     <td class=\"number\">{}</td></tr>",
                    escaped(&point.arguments()),
                    share(point.error),
                    seconds(point.seconds)
                ),
                None => writeln!(
                    text,
                    "<tr><td>{name}</td><td>{within}</td><td>none within {within}</td><td></td><td></td></tr>"
                ),
            };
        }
    }
    text.push_str("</table>\n");
}

/// Heading, diagram and table of a case.
fn case(text: &mut String, points: &[Point]) -> Result<(), DiagramError> {
    let name = points.first().map_or("", |point| point.case);
    let _ = writeln!(text, "<h2 id=\"{name}\">{name}</h2>\n<p>Error: {}.</p>", escaped(meaning(name)));
    match diagram(points) {
        Ok(picture) => text.push_str(&picture),
        Err(DiagramError::Nothing) => text.push_str("<p>No run gave an error.</p>\n"),
        Err(error) => return Err(error),
    }
    text.push_str(
        "<table>\n<tr><th>on the front</th><th>solver</th><th>resolution</th><th>changes</th><th>error</th>\
         <th>run time</th></tr>\n",
    );
    let front = front(points);
    for point in points {
        let label = front.iter().position(|other| std::ptr::eq(*other, point)).map(|index| index + 1);
        let error = match &point.failure {
            Some(failure) => escaped(failure),
            None => share(point.error),
        };
        let _ = writeln!(
            text,
            "<tr{}><td class=\"number\">{}</td><td>{}</td><td class=\"number\">{}</td><td><code>{}</code></td>\
             <td class=\"number\">{error}</td><td class=\"number\">{}</td></tr>",
            if label.is_some() { " class=\"front\"" } else { "" },
            label.map_or_else(String::new, |label| label.to_string()),
            escaped(point.solver),
            point.resolution,
            escaped(point.changes),
            seconds(point.seconds)
        );
    }
    text.push_str("</table>\n");
    Ok(())
}

/// A share as per cent, to three digits.
fn share(value: f64) -> String {
    let value = 100.0 * value;
    let text = if value >= 10.0 { format!("{value:.1}") } else { format!("{value:.2}") };
    let short = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    format!("{short} %")
}

fn seconds(value: f64) -> String {
    if value < 1.0 { format!("{value:.3} s") } else { format!("{value:.1} s") }
}

/// Text for HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
