//! What the window asks of the simulation thread, without a window.

use std::{
    path::Path,
    sync::{Mutex, mpsc::channel},
};

use sorb::{
    Options, Player, Recording,
    scene::{Scene, preset},
};
use sorb_view::{
    Report, Source, ViewError,
    drawing::{CpuRenderer, DrawingThread},
    facts::Facts,
    parameters::Value,
    session::Session,
    simulation::{self, Begin, Request},
};

fn scene() -> Scene {
    let scene = preset("standing").and_then(|scene| scene.scaled(0.4));
    scene.unwrap_or_else(|error| panic!("{error}"))
}

/// Carries out requests one after another; the facts at the end, and the report.
fn play(
    source: &Source,
    record: Option<&Path>,
    requests: Vec<Request>,
) -> (Facts, Result<Report, ViewError>) {
    let (sender, receiver) = channel();
    requests.into_iter().chain([Request::Close]).for_each(|request| sender.send(request).unwrap());
    let (facts, drawing) = (Mutex::new(Facts::default()), DrawingThread::new(Box::new(CpuRenderer), || ()));
    let options = Options::default();
    let begin = Begin { source, options: &options, record, frames: None, runs: false };
    let report = simulation::run(begin, &receiver, &facts, &drawing.worlds(), &|| ());
    (facts.into_inner().unwrap(), report)
}

fn set(key: &str, value: f32) -> Request {
    Request::Set(key.to_owned(), Value::Real(value))
}

fn value(facts: &Facts, key: &str) -> Value {
    facts.parameters.iter().find(|own| own.key == key).unwrap_or_else(|| panic!("{key}")).value
}

#[test]
fn materials_change_at_once_and_other_parameters_at_a_reset() {
    let source = Source::Scene(Box::new(scene()));
    let (permeability, viscosity) = ("sponges[0].permeability", "fluid.viscosity");
    let changes =
        || vec![set(permeability, 2e-9), set(permeability, 3e-9), set(viscosity, 0.01), Request::Frame];
    let (facts, report) = play(&source, None, changes());
    // One command for all changes before a step.
    assert_eq!(report.unwrap().commands.get("material"), Some(&1));
    assert!(facts.waits && facts.frames == 1);
    let (facts, report) = play(&source, None, [changes(), vec![Request::Reset]].concat());
    assert!(!facts.waits && facts.frames == 0 && report.unwrap().frames == 0);
    assert_eq!(value(&facts, permeability), Value::Real(3e-9));
    assert_eq!(value(&facts, viscosity), Value::Real(0.01));
    let (facts, _) = play(&source, None, [changes(), vec![Request::Restore]].concat());
    assert_ne!(value(&facts, viscosity), Value::Real(0.01));
}

#[test]
fn what_the_rules_of_scenes_refuse_is_told_and_changes_nothing() {
    let source = Source::Scene(Box::new(scene()));
    let (facts, _) = play(&source, None, vec![set("fluid.viscosity", -1.0)]);
    let note = facts.note.clone().unwrap_or_default();
    assert!(note.contains("`fluid.viscosity` = -1 is out of range"), "{note}");
    assert!(!facts.waits && value(&facts, "fluid.viscosity") != Value::Real(-1.0));
}

#[test]
fn a_recording_is_made_and_scrubbed() {
    let source = Source::Scene(Box::new(scene()));
    let path = std::env::temp_dir().join(format!("sorb-view-{}.rec", std::process::id()));
    let (_, report) =
        play(&source, Some(&path), [Request::Step].into_iter().chain(vec![Request::Frame; 5]).collect());
    let report = report.unwrap();
    let recording = Recording::read(&std::fs::read(&path).unwrap()[..]).unwrap();
    std::fs::remove_file(&path).unwrap();
    let mut player = Player::new(&recording, &Options::default()).unwrap();
    while player.advance().unwrap() {}
    assert_eq!((player.frame(), player.world().digest()), (6, report.digest));
    let played = Source::Recording(path.clone(), Box::new(recording));
    let requests = vec![Request::Seek(5), Request::Skip(-2), Request::Skip(1), Request::Frame];
    let (facts, again) = play(&played, None, requests);
    assert_eq!(facts.played, Some((5, 6)));
    assert!(facts.parameters.is_empty() && again.unwrap().commands.is_empty());
    let (facts, again) = play(&played, None, vec![Request::Seek(99), Request::Pour(None)]);
    assert_eq!((facts.played, again.unwrap().digest), (Some((6, 6)), report.digest));
    // A file that cannot be written is told at once.
    let bad = Session::new(&source, &Options::default(), Some(Path::new("no/such/folder/a.rec")));
    assert!(bad.is_err_and(|error| error.to_string().contains("cannot write no/such/folder/a.rec")));
}
