//! `sorb plan`: what a step runs, and what it skips and why.

use serde_json::{Value, json};
use sorb::{
    Options, World,
    columns::Column,
    schedule::{PlanLine, Verdict},
};

use crate::{choice::Choice, error::CliError, output};

/// Arguments of `sorb plan`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    choice: Choice,
    /// Prints a JSON object instead of text
    #[arg(long)]
    json: bool,
}

/// Prints the plan.
///
/// # Errors
/// The scene cannot be read or built, or standard output cannot be written.
pub(crate) fn run(arguments: &Arguments) -> Result<(), CliError> {
    let scene = arguments.choice.load()?;
    let options = Options { threads: Some(1), ..Options::default() };
    let world = World::with_options(&scene, &options)?;
    if !arguments.json {
        return output::print(&world.plan().to_string());
    }
    let phases: Vec<Value> = world.plan().lines().iter().map(line).collect();
    let plan = json!({ "scene": scene.name, "phases": phases });
    output::print(&format!("{}\n", serde_json::to_string_pretty(&plan)?))
}

fn line(line: &PlanLine) -> Value {
    let names = |columns: &[Column]| columns.iter().map(|column| column.name()).collect::<Vec<_>>();
    let why = match line.verdict {
        Verdict::Runs => None,
        Verdict::Skipped(why) => Some(why),
    };
    json!({
        "name": line.name,
        "times": line.repeat.map_or(1, |(_, times)| times),
        "reads": names(line.reads()),
        "writes": names(line.writes()),
        "skipped": why.is_some(),
        "why": why,
    })
}
