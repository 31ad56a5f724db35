//! Twins leave sponges that are asleep alone, as the CPU does.

use super::{
    super::scene::{FULL, Options, Scene, best},
    after_on, gpu,
    parity::{gpu_errors, on_cpu},
};
use crate::{
    KERNELS,
    asleep::Asleep,
    columns::{Column, Columns},
    kernel::Kernel,
};

/// The sponge that sleeps.
const SLEEPER: u32 = 0;

/// Kernels over nodes and tets of sponges that do not touch each other.
fn kernels() -> impl Iterator<Item = &'static Kernel> {
    let of_sponges = |name: &str| name.starts_with("pbd::") || name == "couple::pores";
    let of_touch = |name: &str| ["pbd::pairs", "pbd::touch"].contains(&name);
    KERNELS.iter().copied().filter(move |kernel| of_sponges(kernel.name) && !of_touch(kernel.name))
}

fn rows(scene: &Scene) -> Vec<usize> {
    let sponges = &scene.columns.nodes.sponge[..scene.columns.rows.nodes];
    (0..sponges.len()).filter(|row| sponges[*row] == SLEEPER).collect()
}

/// Before a kernel, with a sponge that sleeps; as the device has it, and as the CPU does, where it has no inverse mass.
fn before(kernel: &Kernel) -> [Scene; 2] {
    let options = Options { touch: false, ..FULL.suiting(kernel) };
    let mut on_device = Scene::new(options).before(kernel.name, &best());
    on_device.params.asleep = Asleep::new(rows(&on_device).into_iter().map(|row| row..row + 1).collect());
    let mut on_cpu = on_device.clone();
    let nodes = &mut on_cpu.columns.nodes;
    for row in rows(&on_device) {
        if let Some(predicted) = nodes.predicted.get_mut(row) {
            let [x, y, z, _] = nodes.position[row];
            *predicted = [x, y, z, 0.0];
        }
    }
    [on_device, on_cpu]
}

/// Takes scratch of what sleeps from another state: nobody reads it.
fn forget(rows: &[usize], found: &mut Columns, expected: &Columns) {
    let (found, expected) = (&mut found.nodes, &expected.nodes);
    for (found, expected) in [
        (&mut found.predicted, &expected.predicted),
        (&mut found.free, &expected.free),
        (&mut found.target, &expected.target),
        (&mut found.acceleration, &expected.acceleration),
        (&mut found.reaction, &expected.reaction),
        (&mut found.pores, &expected.pores),
        (&mut found.drag, &expected.drag),
        (&mut found.drag_moment, &expected.drag_moment),
    ] {
        for row in rows {
            if let Some((found, expected)) = found.get_mut(*row).zip(expected.get(*row)) {
                *found = *expected;
            }
        }
    }
}

/// Errors of what a kernel did to all that is awake, and whether what sleeps is as it was. `asleep` is what the device knows of it.
fn found(kernel: &'static Kernel, asleep: impl Fn(&Scene) -> Asleep) -> (Vec<(Column, f64)>, bool) {
    let [mut on_device, on_the_cpu] = before(kernel);
    let rows = rows(&on_device);
    let expected = on_cpu(kernel, &on_the_cpu);
    on_device.params.asleep = asleep(&on_device);
    let mut found = after_on(gpu(), kernel, &on_device);
    let solves = kernel.writes.contains(&Column::NodePredicted) && kernel.name != "pbd::predict";
    let is_kept = rows.iter().all(|row| {
        let same = |of: fn(&Columns) -> &Vec<[f32; 4]>| of(&found)[*row] == of(&on_device.columns)[*row];
        same(|columns| &columns.nodes.position)
            && same(|columns| &columns.nodes.velocity)
            && (!solves || same(|columns| &columns.nodes.predicted))
    });
    forget(&rows, &mut found, &expected);
    (gpu_errors(kernel, &on_the_cpu, &found, &expected), is_kept)
}

#[test]
fn twins_leave_out_what_is_asleep_as_the_cpu_does() {
    for kernel in kernels() {
        let (errors, is_kept) = found(kernel, |scene| scene.params.asleep.clone());
        assert!(is_kept, "{} moves what is asleep", kernel.name);
        for (column, error) in errors {
            assert!(error <= kernel.twin_bound, "{} {}: {error:.1e}", kernel.name, column.name());
        }
    }
}

/// Negative control: a device that does not know moves it.
#[test]
fn a_twin_that_does_not_know_what_is_asleep_is_noticed() {
    let moved: Vec<&str> = kernels()
        .filter(|kernel| {
            let (errors, is_kept) = found(kernel, |_| Asleep::default());
            !is_kept || errors.iter().any(|(_, error)| *error > kernel.twin_bound)
        })
        .map(|kernel| kernel.name)
        .collect();
    let moving = ["strain", "xpbd_neo_hookean", "vbd", "reaction", "momentum", "contact", "velocity"];
    for name in moving.map(|name| format!("pbd::{name}")) {
        assert!(moved.contains(&name.as_str()), "{name} does not care: {moved:?}");
    }
}
