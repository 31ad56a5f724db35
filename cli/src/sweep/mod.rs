//! `sorb sweep`: one scene with many settings, as a table.

mod jobs;
mod parts;
mod plan;
mod table;

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use crate::{error::CliError, machine::Machine, output};
use jobs::{Job, Row, Sweep, jobs};
use parts::Part;
use plan::Plan;

/// Arguments of `sorb sweep`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// A TOML file: the scene, the grid of its keys, the length of a run and the measures (docs/sweeps.md)
    #[arg(value_name = "PLAN")]
    plan: PathBuf,
    /// Runs a part: of I/N every N-th run, from the I-th on, where I is 0 to N - 1. For jobs of a cluster
    #[arg(long, value_name = "I/N", default_value = "0/1", value_parser = shard)]
    shard: Shard,
    /// Runs nothing: writes the table of the runs that the shards have left, which must be all
    #[arg(long, conflicts_with = "shard")]
    collect: bool,
    /// Folder for parts and table, by default out/ and the name of the plan; runs that are there are not run again
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    machine: Machine,
    /// Prints nothing
    #[arg(long)]
    quiet: bool,
}

/// A part of how many.
#[derive(Clone, Copy, Debug)]
struct Shard([usize; 2]);

/// Runs, and writes the table as soon as all runs are there.
///
/// # Errors
/// The plan is wrong, files cannot be read or written, a run failed, or runs are missing from what is to be collected.
pub(crate) fn run(arguments: &Arguments) -> Result<(), CliError> {
    let plan = Plan::read(&arguments.plan)?;
    let sweep = Sweep::new(&arguments.plan, &plan)?;
    let jobs = jobs(&plan);
    let identity = sweep.identity(&jobs)?;
    let stem = arguments.plan.file_stem().unwrap_or_default();
    let folder = arguments.out.clone().unwrap_or_else(|| Path::new("out").join(stem));
    if !arguments.collect {
        let Shard([shard, shards]) = arguments.shard;
        let own = jobs.iter().filter(|job| job.number % shards == shard);
        let mut part = Part::open(&folder, [shard, shards], &identity)?;
        run_all(arguments, (&sweep, jobs.len()), own, (&folder, &identity, &mut part))?;
    }
    let rows = parts::rows(&folder, &identity)?;
    let missing: Vec<usize> =
        jobs.iter().map(|job| job.number).filter(|number| !rows.contains_key(number)).collect();
    if !missing.is_empty() {
        return if arguments.collect {
            Err(incomplete(&folder, &missing, jobs.len()))
        } else {
            failures(&rows)
        };
    }
    let path = folder.join("table.csv");
    table::write(&path, &plan, &jobs, &rows)?;
    if !arguments.quiet {
        output::print(&format!("{}: {} runs\n", path.display(), rows.len()))?;
    }
    failures(&rows)
}

/// Runs what no part has.
fn run_all<'a>(
    arguments: &Arguments,
    (sweep, count): (&Sweep<'_>, usize),
    own: impl Iterator<Item = &'a Job>,
    (folder, identity, part): (&Path, &str, &mut Part),
) -> Result<(), CliError> {
    let done = parts::rows(folder, identity)?;
    let options = arguments.machine.options();
    for job in own.filter(|job| done.get(&job.number).is_none_or(|row| !row.error.is_empty())) {
        let row = sweep.run(job, &options);
        part.add(&row)?;
        if !arguments.quiet {
            let Row { run, digest, wall_seconds, error, .. } = &row;
            let result = if error.is_empty() { digest } else { error };
            output::print(&format!("run {run} of {count}: {wall_seconds:.1} s, {result}\n"))?;
        }
    }
    Ok(())
}

fn incomplete(folder: &Path, missing: &[usize], count: usize) -> CliError {
    let first: Vec<String> = missing.iter().take(8).map(ToString::to_string).collect();
    let more = if missing.len() > first.len() { ", .." } else { "" };
    let (folder, missing) = (folder.display(), missing.len());
    CliError::CheckFailed(format!(
        "{folder}: {missing} of {count} runs are missing: {}{more}",
        first.join(", ")
    ))
}

/// The first run that failed, if there is one; the others are in the table all the same.
fn failures(rows: &BTreeMap<usize, Row>) -> Result<(), CliError> {
    let failed: Vec<&Row> = rows.values().filter(|row| !row.error.is_empty()).collect();
    match failed.first() {
        None => Ok(()),
        Some(row) => {
            let (count, run, error) = (failed.len(), row.run, &row.error);
            Err(CliError::CheckFailed(format!(
                "{count} of {} runs failed, the first is run {run}: {error}",
                rows.len()
            )))
        }
    }
}

fn shard(text: &str) -> Result<Shard, String> {
    let numbers =
        text.split_once('/').and_then(|(part, parts)| Some([part.parse().ok()?, parts.parse().ok()?]));
    let is_valid = |[part, parts]: &[usize; 2]| part < parts;
    numbers
        .filter(is_valid)
        .map(Shard)
        .ok_or_else(|| "expected I/N such as 0/4, where I is 0 to N - 1".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_parts_of_a_number() {
        assert!(shard("0/1").is_ok() && shard("3/4").is_ok());
        for bad in ["", "1", "/", "1/1", "4/4", "-1/2", "0/0", "a/b", "1/2/3"] {
            assert!(shard(bad).is_err(), "{bad}");
        }
    }
}
