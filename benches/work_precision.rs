//! Run time against error: the fastest run of every sweep within each budget of error, over the run time of the defaults.
//!
//! `cargo bench -p sorb-validation --bench work_precision [-- CASE.. | --quick]`. `sorb validate --work-precision`
//! makes the same sweeps and writes tables, diagrams and the report of docs/precision.

#![expect(clippy::print_stdout, reason = "the figures are what it is for")]

use sorb_validation::{
    Setting,
    precision::{self, BUDGETS, Point},
};

fn main() {
    // cargo adds `--bench`.
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let (flags, cases): (Vec<String>, Vec<String>) =
        words.into_iter().partition(|word| word.starts_with("--"));
    let setting = Setting { quick: flags.iter().any(|flag| flag == "--quick"), ..Setting::new() };
    let points = precision::sweep(&cases, &setting, |_| {});
    println!(
        "{:<14} {:>7} {:>9} {:>9} {:>14}  setting",
        "case", "budget", "error", "seconds", "over defaults"
    );
    for points in points.chunk_by(|a, b| a.case == b.case) {
        for budget in BUDGETS {
            report(points, budget);
        }
    }
}

fn report(points: &[Point], budget: f64) {
    let case = points[0].case;
    let Some(fastest) = precision::recommended(points, budget) else {
        println!("{case:<14} {budget:>7} no run is as near");
        return;
    };
    let default = points.iter().find(|point| point.arguments() == "(defaults)");
    let ratio =
        default.map_or_else(|| "-".to_owned(), |default| format!("{:.2}", fastest.seconds / default.seconds));
    println!(
        "{case:<14} {budget:>7} {:>9.2e} {:>9.3} {ratio:>14}  {} {}",
        fastest.error,
        fastest.seconds,
        fastest.solver,
        fastest.arguments()
    );
}
