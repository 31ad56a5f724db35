//! `sorb plan`: the phases of a step, with what is skipped and why.

use serde_json::{Value, json};
use sorb::{
    Offload, Options, World,
    internal::{Place, Plan, PlannedPhase, Verdict},
};

use crate::{choice::Choice, error::CliError, output};

/// Arguments of `sorb plan`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    choice: Choice,
    /// Where to run: cpu, gpu, auto, from:KERNEL, or each:NAME=PLACE,.. kernel by kernel
    #[arg(long, value_name = "BACKEND", default_value = "cpu")]
    backend: Offload,
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
    let options = Options { threads: Some(1), offload: arguments.backend.clone(), ..Options::default() };
    let world = World::with_options(&scene, &options)?;
    if !arguments.json {
        return output::print(&format!("{}{}", world.plan(), dispatches(&world)?.0));
    }
    let plan = world.plan();
    let phases: Vec<Value> = plan.lines().iter().map(|entry| line(plan, entry)).collect();
    let reason = plan.placement().map(|placement| placement.reason.as_str());
    let transfers: Vec<Value> = plan
        .placement()
        .map_or(&[][..], |placement| &placement.transfers)
        .iter()
        .map(|transfer| {
            json!({
                "before": transfer.before,
                "to_device": transfer.to_device,
                "what": transfer.what,
                "bytes": transfer.bytes,
                "times": transfer.times,
            })
        })
        .collect();
    let (_, dispatches) = dispatches(&world)?;
    let plan = json!({
        "scene": scene.name,
        "reason": reason,
        "transfers": transfers,
        "phases": phases,
        "dispatches": dispatches,
    });
    output::print(&format!("{}\n", serde_json::to_string_pretty(&plan)?))
}

/// How many dispatches a step takes on a GPU, as text and as JSON; nothing for a world on the CPU.
#[cfg(feature = "gpu")]
fn dispatches(world: &World) -> Result<(String, Value), CliError> {
    let found = sorb::internal::dispatches(world).map_err(sorb::WorldError::from)?;
    let Some(all) = found else { return Ok((String::new(), Value::Null)) };
    let kernels = all.kernels.iter().map(|own| {
        json!({
            "name": own.kernel,
            "passes": own.once,
            "passes_of_a_round": own.in_round,
            "threads_of_a_row": own.threads,
        })
    });
    let rounds =
        all.rounds.iter().map(|(dispatches, rounds)| json!({ "dispatches": dispatches, "rounds": rounds }));
    let value = json!({
        "kernels": kernels.collect::<Vec<_>>(),
        "once": all.once,
        "rounds": rounds.collect::<Vec<_>>(),
        "total": all.total(),
    });
    Ok((all.to_string(), value))
}

#[cfg(not(feature = "gpu"))]
#[expect(clippy::unnecessary_wraps, reason = "as with the feature")]
fn dispatches(_: &World) -> Result<(&'static str, Value), CliError> {
    Ok(("", Value::Null))
}

fn line(plan: &Plan, line: &PlannedPhase) -> Value {
    let why = match line.verdict {
        Verdict::Runs => None,
        Verdict::Skipped(why) => Some(why),
    };
    json!({
        "name": line.name,
        "backend": match plan.place(line.name) {
            Place::Cpu => "cpu",
            Place::Gpu => "gpu",
        },
        "times": line.repeat.map_or(1, |(_, times)| times),
        "reads": line.reads().collect::<Vec<_>>(),
        "writes": line.writes().collect::<Vec<_>>(),
        "skipped": why.is_some(),
        "why": why,
    })
}
