//! `sorb validate --work-precision`: run time against error, as a table, diagrams and a report.

use std::{
    fs,
    io::{self, IsTerminal},
    path::{Path, PathBuf},
    time::{Duration, SystemTime},
};

use indicatif::{ProgressBar, ProgressStyle};
use sorb_validation::{
    Setting,
    precision::{self, DiagramError, Origin, Point},
};

use crate::{error::CliError, output};

const TEMPLATE: &str = "{prefix} {bar:30} {pos} of {len} runs  {elapsed} gone";

/// Cases to sweep, and the folder for the results.
#[derive(Debug)]
pub(crate) struct Request<'a> {
    /// Names of cases; all if empty.
    pub(crate) cases: &'a [String],
    /// Settings of the runs.
    pub(crate) setting: Setting,
    /// The folder for the results.
    pub(crate) out: PathBuf,
    /// Remark about the machine.
    pub(crate) note: Option<&'a str>,
}

/// Runs the sweep, prints a row for every run, and writes `index.html`, `precision.csv` and an SVG for every case.
///
/// # Errors
/// A name has no sweep, or the results cannot be written.
pub(crate) fn run(request: &Request<'_>) -> Result<(), CliError> {
    let Request { cases, setting, out, .. } = request;
    let known = precision::names();
    if let Some(name) = cases.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(CliError::Usage(format!("no sweep of case `{name}`; there are: {}", known.join(", "))));
    }
    // Before the runs, which take a quarter of an hour.
    fs::create_dir_all(out).map_err(CliError::write(out))?;
    let bar = bar(precision::count(cases, setting));
    output::print(&row(["case", "solver", "resolution", "error", "run time", "changes"].map(str::to_owned)))?;
    let mut printed = Ok(());
    let points = precision::sweep(cases, setting, |point| {
        bar.set_prefix(point.case);
        bar.inc(1);
        let text = row(cells(point));
        bar.suspend(|| {
            if printed.is_ok() {
                printed = output::print(&text);
            }
        });
    });
    bar.finish_and_clear();
    printed?;
    write_results(request, &points)?;
    output::print(&format!("report in {}\n", out.join("index.html").display()))
}

fn write_results(request: &Request<'_>, points: &[Point]) -> Result<(), CliError> {
    let out = &request.out;
    let drawing = |error: DiagramError| CliError::Drawing(error.to_string());
    write(&out.join("precision.csv"), &precision::table(points))?;
    for points in points.chunk_by(|a, b| a.case == b.case) {
        match precision::diagram(points) {
            Ok(picture) => write(&out.join(format!("{}.svg", points[0].case)), &picture)?,
            Err(DiagramError::Nothing) => {}
            Err(error) => return Err(drawing(error)),
        }
    }
    let page = precision::page(points, &origin(request)).map_err(drawing)?;
    write(&out.join("index.html"), &page)
}

fn write(path: &Path, text: &str) -> Result<(), CliError> {
    fs::write(path, text).map_err(CliError::write(path))
}

/// A bar on standard error; none where that is no terminal.
fn bar(runs: usize) -> ProgressBar {
    let bar = if io::stderr().is_terminal() { ProgressBar::new(runs as u64) } else { ProgressBar::hidden() };
    let style = ProgressStyle::with_template(TEMPLATE).unwrap_or_else(|_| ProgressStyle::default_bar());
    bar.set_style(style.progress_chars("=> "));
    bar.enable_steady_tick(Duration::from_millis(500));
    bar
}

fn cells(point: &Point) -> [String; 6] {
    let error = match &point.failure {
        Some(failure) => failure.clone(),
        None => format!("{:.2} %", 100.0 * point.error),
    };
    [
        point.case.to_owned(),
        point.solver.to_owned(),
        point.resolution.to_string(),
        error,
        format!("{:.2} s", point.seconds),
        point.changes.to_owned(),
    ]
}

fn row([case, solver, resolution, error, seconds, changes]: [String; 6]) -> String {
    let text = format!("{case:13}  {solver:16}  {resolution:>10}  {error:>9}  {seconds:>9}  {changes}");
    format!("{}\n", text.trim_end())
}

fn origin(request: &Request<'_>) -> Origin {
    let setting = &request.setting;
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = setting.options.threads.unwrap_or(cores);
    let note = request.note.map_or_else(String::new, |note| format!(", {note}"));
    let mut command = "sorb validate --work-precision".to_owned();
    for name in request.cases {
        command += &format!(" {name}");
    }
    for change in &setting.changes {
        command += &format!(" --set {change}");
    }
    command += if setting.quick { " --quick" } else { "" };
    Origin { date: today(), machine: format!("{}, {threads} threads{note}", processor()), command }
}

/// Name of the processor, where the system provides one.
fn processor() -> String {
    let platform = || format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS);
    let text = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or_else(platform, |(_, name)| name.trim().to_owned())
}

/// The day in universal time.
fn today() -> String {
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
    date(since.as_secs() / 86400)
}

/// The Gregorian date a number of days after the first of January 1970.
fn date(days: u64) -> String {
    // Years begin in March, so that the leap day is the last one; 400 years have 146 097 days.
    let since = days + 719_468;
    let (era, day) = (since / 146_097, since % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let in_month = day - (153 * month + 2) / 5 + 1;
    let (month, next) = if month < 10 { (month + 3, 0) } else { (month - 9, 1) };
    format!("{:04}-{month:02}-{in_month:02}", era * 400 + year + next)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        for (days, expected) in
            [(0, "1970-01-01"), (11_016, "2000-02-29"), (11_017, "2000-03-01"), (20_778, "2026-11-21")]
        {
            assert_eq!(date(days), expected);
        }
        assert_ne!(date(11_016), date(11_017));
    }
}
