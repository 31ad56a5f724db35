//! `sorb validate`: lists, refusals, output and exit codes.

use crate::support::{Scratch, sorb};

#[test]
fn it_lists_its_cases_with_their_references() {
    let answer = sorb(&["validate", "--list"]);
    assert_eq!(answer.code, Some(0));
    assert!(answer.out.contains("dam_break") && answer.out.contains("Martin and Moyce 1952"), "{answer:?}");
    let json = sorb(&["validate", "--list", "--json"]).json();
    assert!(json.as_array().is_some_and(|cases| cases.iter().all(|case| case["control"].is_string())));
}

#[test]
fn an_unknown_case_or_solver_names_those_there_are() {
    for (arguments, word) in [
        (&["validate", "dam_brake"][..], "dam_break"),
        (&["validate", "dam_break", "--solver", "magic"], "wcsph"),
        (&["validate", "--resolution", "100"], "0.25 to 8"),
    ] {
        let answer = sorb(arguments);
        assert_eq!(answer.code, Some(2), "{answer:?}");
        assert!(answer.err.contains(word), "{answer:?}");
    }
}

#[test]
fn a_row_for_every_figure_and_1_if_one_is_out_of_bounds() {
    let answer = sorb(&["validate", "torsion", "--quick", "--json"]);
    let rows = answer.json();
    let figures = rows[0]["figures"].as_array().expect("an array of figures");
    let out = figures.iter().filter(|figure| figure["verdict"] == "miss").count();
    assert!(!figures.is_empty() && rows[0]["case"] == "torsion" && rows[0]["backend"] == "cpu");
    assert_eq!(answer.code, Some(i32::from(out > 0)), "{answer:?}");
    // The planted fault must be out of bounds; then the check passes.
    let control = sorb(&["validate", "torsion", "--quick", "--control"]);
    assert_eq!((control.code, control.err.as_str()), (Some(0), ""), "{control:?}");
    assert!(control.out.contains("MISS"), "{control:?}");
}

#[test]
fn cases_beside_each_other_tell_what_they_tell_one_by_one() {
    let figures = |cases: &[&str], jobs: &str| -> Vec<_> {
        let rows = sorb(&[&["validate"], cases, &["--quick", "--json", "--jobs", jobs]].concat()).json();
        let rows = rows.as_array().expect("an array of cases");
        rows.iter().map(|row| (row["case"].clone(), row["figures"].clone())).collect()
    };
    // The first takes longest.
    let cases = ["cantilever", "patch", "squash", "torsion"];
    let one_by_one = figures(&cases, "1");
    assert_eq!(one_by_one.len(), cases.len());
    assert_eq!(figures(&cases, "3"), one_by_one);
    // The control: another case has other figures.
    assert_ne!(figures(&["uniaxial", "patch", "squash", "torsion"], "3"), one_by_one);
}

#[test]
fn three_resolutions_have_an_order() {
    let ask = |extra: &[&str]| {
        let arguments = ["validate", "uniaxial", "patch", "--quick", "--convergence"];
        sorb(&[&arguments[..], extra].concat())
    };
    let answer = ask(&[]);
    assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""), "{answer:?}");
    let row = |figure: &str| answer.out.lines().find(|line| line.contains(figure)).unwrap_or_default();
    assert!(row("force against the continuum").ends_with("  fall"), "{}", answer.out);
    assert!(row("way off the affine map").ends_with("  are small"), "{}", answer.out);
    let json = ask(&["--json"]).json();
    let rows = json.as_array().expect("an array of figures");
    let continuum = rows
        .iter()
        .find(|row| row["convergence"]["figure"].as_str().is_some_and(|name| name.contains("continuum")));
    assert!(continuum.is_some_and(|row| row["order"].as_f64().is_some_and(|order| order > 0.1)), "{json}");
    assert_eq!(ask(&["--control"]).code, Some(2));
}

#[test]
fn run_time_against_error_leaves_a_report_a_table_and_a_diagram() {
    let scratch = Scratch::new("work_precision");
    let out = scratch.path("report");
    let quick =
        ["validate", "--work-precision", "dam_break", "--quick", "--resolution", "0.5", "--out", &out];
    let answer = sorb(&quick);
    assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""), "{answer:?}");
    let table = scratch.read("report/precision.csv");
    let runs = table.lines().count() - 1;
    assert!(runs > 4 && table.lines().skip(1).all(|line| line.starts_with("dam_break,")), "{table}");
    // A heading, a line for every run, and where the report is.
    assert_eq!(answer.out.lines().count(), runs + 2, "{}", answer.out);
    assert!(scratch.read("report/dam_break.svg").starts_with("<svg"));
    let page = scratch.read("report/index.html");
    assert!(page.contains("sorb validate --work-precision dam_break") && page.contains("</html>"));
    assert!(!page.contains("hydrostatic"));
}

#[test]
fn run_time_against_error_refuses_what_it_cannot_sweep() {
    for (arguments, word) in [
        (&["validate", "--work-precision", "patch"][..], "imbibition"),
        (&["validate", "--work-precision", "--control"], "cannot be used with"),
        (&["validate", "--out", "somewhere"], "--work-precision"),
        (&["validate", "--quality", "acurate"], "did you mean `accurate`"),
    ] {
        let answer = sorb(arguments);
        assert_eq!(answer.code, Some(2), "{answer:?}");
        assert!(answer.err.contains(word), "{answer:?}");
    }
}
