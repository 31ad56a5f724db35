//! A world can be sent to another thread, shared and copied.

use sorb::{Cpu, FrameReport, Measures, Options, StepError, StepReport, World, WorldError, scene::Scene};

const fn send_sync<T: Send + Sync + 'static>() {}
const fn clone<T: Clone>() {}
const fn error<T: std::error::Error + Send + Sync + 'static>() {}

const _: () = {
    send_sync::<World>();
    clone::<World>();
    send_sync::<Scene>();
    clone::<Scene>();
    send_sync::<Cpu>();
    clone::<Cpu>();
    clone::<Options>();
    send_sync::<Measures>();
    send_sync::<StepReport>();
    send_sync::<FrameReport>();
    error::<WorldError>();
    error::<StepError>();
};

#[test]
fn a_world_steps_on_another_thread() {
    let scene = Scene::new("nothing");
    let mut world = World::new(&scene).unwrap_or_else(|error| panic!("{error}"));
    let mut copy = world.clone();
    let stepped = std::thread::spawn(move || copy.step().map(|_| copy.digest())).join();
    let here = world.step().map(|_| world.digest());
    assert_eq!(stepped.ok(), Some(here));
}
