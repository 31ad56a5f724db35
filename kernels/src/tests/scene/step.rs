//! The kernels of a step, in its order.

use super::Options;
use crate::{
    KERNELS,
    need::Need,
    step::{POROUS_STEP, Phase, STEP, Times},
};

/// The kernels of a step in its orders, by name: first that of the scene, then the others.
pub(in crate::tests) fn orders(options: Options) -> [Vec<&'static str>; 5] {
    let of = |phases, way| {
        let mut names = Vec::new();
        add(&mut names, phases, way, options);
        names
    };
    let mut orders = [
        of(STEP, Way::Solve),
        of(STEP, Way::Projection),
        of(STEP, Way::Divergence),
        of(POROUS_STEP, Way::Divergence),
        of(POROUS_STEP, Way::Solve),
    ];
    match (options.porous, options.divergence) {
        (true, true) => orders.rotate_left(3),
        (true, false) => orders.reverse(),
        (false, _) => {}
    }
    orders
}

/// How the density is kept.
#[derive(Clone, Copy)]
enum Way {
    Solve,
    Divergence,
    Projection,
}

/// Two rounds of a solve, because the second differs from the first; every other repetition is written once.
fn add(names: &mut Vec<&'static str>, phases: &[Phase], way: Way, options: Options) {
    for phase in phases {
        match phase {
            Phase::Run(kernel) => names.push(kernel.name),
            Phase::Named(block) => add(names, block.phases, way, options),
            Phase::With { needs, phases } => {
                if !needs.contains(&Need::ImplicitViscosity) || options.implicit_viscosity {
                    add(names, phases, way, options);
                }
            }
            Phase::Repeat { times, phases } => {
                let rounds = if matches!(times, Times::UntilConverged(_)) { 2 } else { 1 };
                (0..rounds).for_each(|_| add(names, phases, way, options));
            }
            Phase::KeepDensity { solve, divergence, projection } => {
                let phases = match way {
                    Way::Solve => solve,
                    Way::Divergence => divergence,
                    Way::Projection => projection,
                };
                add(names, phases, way, options);
            }
            Phase::Host(_) => {}
        }
    }
}

/// Whether a kernel is part of a solve that ends when it has converged.
fn is_in_rounds(phases: &[Phase], name: &str) -> bool {
    phases.iter().any(|phase| match phase {
        Phase::Run(_) | Phase::Host(_) => false,
        Phase::Named(block) => is_in_rounds(block.phases, name),
        Phase::With { phases, .. } => is_in_rounds(phases, name),
        Phase::Repeat { times: Times::UntilConverged(_), phases } => {
            phases.iter().any(|phase| matches!(phase, Phase::Run(kernel) if kernel.name == name))
        }
        Phase::Repeat { phases, .. } => is_in_rounds(phases, name),
        Phase::KeepDensity { solve, divergence, .. } => {
            [solve, divergence].iter().any(|way| is_in_rounds(way, name))
        }
    })
}

/// Whether a kernel is compared at its second place in a step, because it has nothing to add to at its first. These are rounds of a solve,
/// and sweeps of the drag.
pub(super) fn continues(name: &str) -> bool {
    name == "couple::drag" || is_in_rounds(STEP, name)
}

#[test]
fn a_step_has_every_kernel() {
    let all = orders(Options { implicit_viscosity: true, ..super::FULL }).concat();
    for kernel in KERNELS {
        assert!(all.contains(&kernel.name), "{}", kernel.name);
    }
}
