//! Computation of the phases of a step: columns, kernel table, CPU bodies and oracles.
//!
//! There is one file per kernel. A kernel's name is its path: `sph::density` is `sph/density.rs`. It declares what it reads and writes. Its
//! body for the CPU is generic over the SIMD level and runs on fixed chunks of rows. Its oracle, a brute-force loop in f64, is in `oracle`
//! (tests and feature `oracles`). Kernels depend on no scene, and on no other kernel.

pub mod asleep;
pub mod body;
pub mod clock;
pub mod column;
pub mod columns;
pub mod contents;
pub mod cpu;
mod declaration;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod kernel;
mod lanes;
mod layout;
pub mod need;
#[cfg(any(test, feature = "oracles"))]
pub mod oracle;
pub mod params;
pub mod periodic;
pub mod reduce;
pub mod rounding;
mod shape;
pub mod smoothing;
pub mod stage;
mod state;
pub mod step;
mod surface;
mod sweep;
mod symmetric;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
pub mod turn;
mod vector;
mod wrench;

/// Declares the modules of all families, and the table of all kernels. Modules that several kernels share come after them.
macro_rules! kernels {
    ($(
        $(#[$doc:meta])*
        $family:ident { $($kernel:ident),* $(,)? } shared { $($(#[$cfg:meta])* $visibility:vis $shared:ident),* $(,)? }
    )*) => {
        $($(#[$doc])*
        pub mod $family {
            $(pub mod $kernel;)*
            $($(#[$cfg])* $visibility mod $shared;)*
        })*

        /// Every kernel, by family.
        pub static KERNELS: &[&Kernel] = &[$($(&$family::$kernel::KERNEL,)*)*];
    };
}

kernels! {
    /// Neighbour search.
    grid {
        sort_fluid, fluid_neighbors,
    } shared {
        pub cells, pub neighbors, pub(crate) scan, search, pub(crate) sort, pub(crate) weighted,
    }
    /// The fluid: smoothed particle hydrodynamics, with an equation of state (the paper, section 3.1) or with a pressure
    /// solve \[BK17\].
    sph {
        density, pressure, forces, spin, strain_rate, surface_tension, deficit, cohesion, repulsion, boundary_pressure,
        adhesion, wall_friction, kick, viscosity_start, viscosity_spin, viscosity_strain, viscosity_begin, viscosity_product,
        viscosity_update, viscosity_reaction, viscosity_kick, predict, boundary, factors, pressure_update, pressure_acceleration,
        pressure_residual, pressure_kick, position_correction, boundary_reaction, sweep, advect,
    } shared {
        pub(crate) container, pub(crate) friction, pub lattice, pub obstacles, pub pressure_solve, push, pub(crate) strain,
        pub(crate) viscosity, pub viscosity_solve,
    }
    /// The fluid, with a pressure solve for the divergence of the velocities.
    divergence {
        images, moments, hydrostatic, approach, damping, pressure_guess, pressure_return, expect, update, acceleration,
        residual, kick, retention, shift,
    } shared {
        closing, pub(crate) collect, pub image_rows, pub(crate) mirror, near, pub(crate) rate, pub(crate) reflect,
        pub(crate) walls,
    }
    /// The sponge: elasticity of the lattice, by strain constraints on tets (the paper, section 3.2), by vertex block descent or by
    /// Neo-Hookean constraints. Contact of its nodes as well.
    pbd {
        pairs, gravity, predict, guess, touch, strain, xpbd_neo_hookean, vbd, contact, reaction, momentum,
        velocity,
    } shared {
        pub(crate) descent, pub flatness, pub lattice, pub meeting, pub(crate) obstacles, pub stars, sweep, tets, pub wetted,
    }
    /// Fluid and sponge: nodes as control particles of the fluid (the paper, section 3.3).
    couple {
        controls, saturation, wetting, contact_suction, pores, interior, suction, zero_distance, control_velocity, drag,
        velocity_filter, exchange, solid_pressure, solid_share, solid_yield, solid_reaction,
        drag_impulse, drag_target, drag_reaction, drag_settled, drag_kick,
        solid_expect, solid_moments, solid_diagonal, solid_response, solid_velocity, solid_kick,
    } shared {
        pub(crate) compliance, pub(crate) drag_model, pub(crate) impulses, pub(crate) solid_mirrors, #[cfg(feature = "gpu")] pub weights,
    }
    /// Fluid and sponge as porous media: a particle in a sponge exchanges momentum with the corners of its tet.
    tets {
        corners, moments, flux, mobility, response, velocity, drag_impulse, drag_target, drag_reaction, drag_settled, drag_kick,
    } shared {
        impulses, pub rows,
    }
}

/// The kernel of that name.
#[must_use]
pub fn kernel_named(name: &str) -> Option<&'static Kernel> {
    KERNELS.iter().copied().find(|kernel| kernel.name == name)
}

use kernel::Kernel;
pub use lanes::{LANES, SimdLevel};
