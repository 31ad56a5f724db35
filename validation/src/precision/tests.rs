use super::*;

fn at(error: f64, seconds: f64) -> Point {
    Point {
        case: "dam_break",
        solver: "wcsph",
        resolution: 0.5,
        changes: "time.courant=0.4",
        error,
        seconds,
        on_front: false,
        failure: None,
    }
}

fn some() -> Vec<Point> {
    let mut points =
        vec![at(0.1, 1.0), at(0.2, 0.5), at(0.2, 2.0), at(f64::NAN, 0.1), at(0.05, 9.0), at(0.05, 10.0)];
    mark_front(&mut points);
    points
}

#[test]
fn the_front_is_what_nothing_beats() {
    let on_front: Vec<bool> = some().iter().map(|point| point.on_front).collect();
    assert_eq!(on_front, [true, true, false, false, true, false]);
    let seconds: Vec<f64> = front(&some()).iter().map(|point| point.seconds).collect();
    assert_eq!(seconds, [0.5, 1.0, 9.0]);
}

#[test]
fn the_fastest_within_the_budget_is_recommended() {
    let points = some();
    let of = |budget| recommended(&points, budget).map(|point| point.seconds);
    assert_eq!([0.3, 0.15, 0.05, 0.04].map(of), [Some(0.5), Some(1.0), Some(9.0), None]);
    assert_eq!(points[0].arguments(), "--set fluid.solver=wcsph --set time.courant=0.4 --resolution 0.5");
    let quality = Point { solver: "divergence", changes: "quality=fast", resolution: 1.0, ..at(0.1, 1.0) };
    assert_eq!(quality.arguments(), "--quality fast");
    assert_eq!(Point { changes: "", ..quality }.arguments(), "(defaults)");
}

#[test]
fn a_row_for_every_point() {
    let table = table(&some());
    assert_eq!(table.lines().count(), 7);
    assert!(table.lines().all(|line| line.split(',').count() == 7), "{table}");
}

#[test]
fn sweeps_name_cases_and_solvers_that_there_are_and_change_keys_once() {
    for sweep in SWEEPS {
        assert!(CASES.iter().any(|case| case.name == sweep.case), "{}", sweep.case);
        let runs = sweep.runs(false);
        for (index, run) in runs.iter().enumerate() {
            let chosen = solvers(run.0);
            let found = [chosen.water, chosen.sponge].into_iter().flatten().count();
            assert_eq!(found, run.0.split('+').count(), "{}", run.0);
            assert!(!runs[..index].contains(run), "{} twice: {run:?}", sweep.case);
        }
        assert!(sweep.runs(true).len() <= runs.len());
        for (_, _, changes) in &runs {
            let quality = changes.strip_prefix(QUALITY).map(str::parse::<sorb::scene::Quality>);
            assert!(quality.is_none_or(|quality| quality.is_ok()), "{changes}");
        }
    }
    let all = |quick| SWEEPS.iter().map(|sweep| sweep.runs(quick).len()).sum::<usize>();
    assert!(2 * all(true) < all(false), "{} {}", all(true), all(false));
}

#[test]
fn an_error_counts_only_what_the_sweep_names_over_its_scale() {
    let sweep = &SWEEPS[1];
    let figure = |name: &str, error| Figure::error(name, "1", error, 1.0);
    let figures = [figure("front Z, RMSE", 0.311), figure("height at the wall", 0.1), figure("other", 9.0)];
    assert!((error(sweep, &figures) - 0.1).abs() < 1e-12);
    assert!(error(sweep, &figures[2..]).is_nan());
    assert!(error(sweep, &[figure("front Z", f64::NAN)]).is_nan());
}

#[test]
fn a_diagram_has_every_point_and_labels_the_front() {
    let points = some();
    let text = diagram(&points).expect("finite points");
    // One mark of each point that has an error, beside the one in the legend.
    assert_eq!(text.matches("<polygon").count() + text.matches("<circle").count(), 5 + 1, "{text}");
    for label in ["1", "2", "3"] {
        assert!(text.contains(&format!("\n{label}\n</text>")), "{label} is not in {text}");
    }
    assert!(!text.contains("\n4\n</text>"));
    assert!(text.contains("wcsph") && text.contains("error") && text.contains("run time"));
    assert!(!text.contains("NaN"));
}

#[test]
fn points_without_an_error_make_no_diagram() {
    assert!(matches!(diagram(&[at(f64::NAN, 1.0)]), Err(DiagramError::Nothing)));
}

#[test]
fn a_page_is_whole_and_hides_nothing() {
    let mut points = some();
    points[3].failure = Some("diverged: a < b".to_owned());
    let origin = Origin {
        date: "2026-11-21".to_owned(),
        machine: "A & B".to_owned(),
        command: "sorb validate".to_owned(),
    };
    let text = page(&points, &origin).expect("diagrams can be drawn");
    assert_eq!(text.matches("<svg").count(), 1);
    assert_eq!(text.matches("<tr").count(), text.matches("</tr>").count());
    assert!(text.contains("A &amp; B") && text.contains("diverged: a &lt; b") && text.contains("2026-11-21"));
    assert!(text.contains("none within 1 %"), "{text}");
    assert!(
        !text.contains("http://")
            || text.matches("http://").count() == text.matches("http://www.w3.org").count()
    );
}
