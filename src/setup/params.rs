//! Parameters of the kernels from the keys of a scene.

use std::f32::consts::PI;

use glam::Vec3;
use sorb_kernels::{
    asleep::Asleep,
    body::BodyKind,
    grid::cells::Domain,
    params::{
        Cohesion, Divergence, EquationOfState, FluidParams, ImplicitViscosity, Incompressible, NO_WALL,
        Params, Retention, Solver, SpongeParams, WettingParams,
    },
    periodic::Periodic,
    smoothing::Wendland,
    sph::{deficit::cohesion_stiffness, lattice, obstacles::boundary_profile},
};

use crate::scene::{self, Scene};

pub(crate) fn params(scene: &Scene) -> Params {
    let (domain, walls, periodic) = match scene.domain {
        scene::Domain::Box { minimum, maximum, periodic } => {
            let corner = |own: Vec3, far: f32| Vec3::select(periodic.into(), Vec3::splat(far), own);
            let walls = (corner(minimum, -NO_WALL), corner(maximum, NO_WALL));
            let walls = periodic.contains(&false).then_some(walls);
            (Domain::Bounded { minimum, maximum }, walls, Periodic::new(minimum, maximum, periodic))
        }
        scene::Domain::Open => (Domain::Unbounded, None, None),
    };
    let reach = |sponge: &scene::Sponge| sponge.suction_radius * swollen_edge(sponge);
    let radius = present(scene).map(reach).fold(0.0, f32::max);
    Params {
        step: scene.time.maximum_step,
        gravity: scene.gravity,
        domain,
        walls,
        periodic,
        no_slip: scene.fluid.as_ref().is_some_and(|fluid| fluid.no_slip),
        fluid: fluid_params(scene),
        sponges: scene.sponges.iter().map(|sponge| sponge_params(scene, sponge)).collect(),
        asleep: Asleep::default(),
        coupling: Wendland::new(if radius > 0.0 { radius } else { 1.0 }),
        solid: solid(scene),
        is_barycentric: scene.coupling_weights() == scene::CouplingWeights::Barycentric,
    }
}

/// The sponges that commands have not removed.
fn present(scene: &Scene) -> impl Iterator<Item = &scene::Sponge> {
    scene.sponges.iter().filter(|sponge| !sponge.is_removed())
}

/// Support radius of the material volume, over the edge of a cell. It is the smallest at which the solid volume fraction is
/// nearly uniform: 0.96 to 1.17 of its mean between nodes. A smaller one makes gaps, a larger one blurs the faces.
const SOLID_RADIUS: f32 = 1.2;

/// Largest edge of a sponge at rest, when swollen: the smoothing of the material must reach as far.
fn swollen_edge(sponge: &scene::Sponge) -> f32 {
    sponge.edge * (1.0 + sponge.swelling)
}

fn solid(scene: &Scene) -> Option<Wendland> {
    let edge = present(scene).map(swollen_edge).fold(0.0, f32::max);
    let is_porous = edge > 0.0 && scene.coupling() == scene::Coupling::Porous;
    is_porous.then(|| Wendland::new(SOLID_RADIUS * edge))
}

/// Stabilisation coefficient e over the square of the time in which sound crosses a spacing. It suffices against pressures
/// that alternate from particle to particle.
const ROUGHNESS: f32 = 2.0;

fn fluid_params(scene: &Scene) -> FluidParams {
    let Some(fluid) = &scene.fluid else {
        return FluidParams {
            spacing: 1.0,
            rest_density: 1.0,
            particle_mass: 0.0,
            smoothing: Wendland::new(1.0),
            equation_of_state: EquationOfState::Linear,
            sound_speed: 1.0,
            incompressible: None,
            viscosity: 0.0,
            central_viscosity: 0.0,
            strain_viscosity: 0.0,
            implicit_viscosity: None,
            roughness: 0.0,
            wall_viscosity: 0.0,
            retention: None,
            surface_tension: 0.0,
            cohesion: None,
            repulsion_range: 0.0,
            repulsion_stiffness: 0.0,
            repulsion_damping: 0.0,
        };
    };
    let support = fluid.support_radius();
    let solver = scene.fluid_solver().unwrap_or(scene::FluidSolver::Divergence);
    let divides = solver == scene::FluidSolver::Divergence;
    let lattice_sum = Wendland::lattice_sum(f64::from(support), f64::from(fluid.spacing));
    let cube = f64::from(fluid.rest_density) * f64::from(fluid.spacing).powi(3);
    // Either the mass is such that a lattice has rest density, or the smoothing function is.
    let (smoothing, mass) = if divides {
        (Wendland::normalised(support, fluid.spacing), cube)
    } else {
        (Wendland::new(support), cube / lattice_sum)
    };
    let sound_speed = fluid.sound_speed.unwrap_or_else(|| scene.default_sound_speed());
    // Monaghan's alpha as a kinematic viscosity in three dimensions, alpha c h / 10 with the smoothing length
    // h = H / 2 [M05, eq. 8.8].
    let numerical = fluid.rest_density * fluid.numerical_viscosity(solver) * sound_speed * support / 20.0;
    let is_incompressible = solver != scene::FluidSolver::Wcsph;
    let form = fluid.form_of_viscosity(solver);
    let (viscosity, central_viscosity) = match (is_incompressible, form) {
        (true, scene::ViscosityForm::Monaghan) => {
            (0.0, fluid.viscosity / lattice_central_viscosity(fluid) + numerical)
        }
        (true, scene::ViscosityForm::Morris) => (fluid.viscosity / lattice_viscosity(fluid), numerical),
        (_, scene::ViscosityForm::StrainRate) => (0.0, numerical),
        (false, scene::ViscosityForm::Monaghan) => (0.0, fluid.viscosity + numerical),
        // As in the paper.
        (false, scene::ViscosityForm::Morris) => (fluid.viscosity + numerical, 0.0),
    };
    let is_by_strain = form == scene::ViscosityForm::StrainRate;
    let strain_viscosity = if is_by_strain { fluid.viscosity / lattice_viscosity(fluid) } else { 0.0 };
    let is_implicit = fluid.viscosity_integration == scene::ViscosityIntegration::Implicit;
    let implicit_viscosity = (is_implicit && viscosity + central_viscosity + strain_viscosity > 0.0)
        .then_some(ImplicitViscosity {
            viscosity,
            central_viscosity,
            tolerance: fluid.viscosity_tolerance,
            rounds: fluid.viscosity_rounds,
        });
    // Viscosity that is part of the solve must not act a second time in the forces.
    let (viscosity, central_viscosity) =
        if is_implicit { (0.0, 0.0) } else { (viscosity, central_viscosity) };
    // Half a spacing, the place of the first layer of a lattice. A particle at half the speed of sound stops at the surface.
    let range = 0.5 * fluid.spacing;
    let frequency = 0.5 * sound_speed / range;
    FluidParams {
        spacing: fluid.spacing,
        rest_density: fluid.rest_density,
        particle_mass: mass as f32,
        smoothing,
        equation_of_state: match fluid.equation_of_state {
            scene::EquationOfState::Tait => EquationOfState::Tait,
            scene::EquationOfState::Linear => EquationOfState::Linear,
        },
        sound_speed,
        incompressible: incompressible(scene, fluid, &smoothing, sound_speed),
        viscosity,
        central_viscosity,
        strain_viscosity,
        implicit_viscosity,
        // Without a stored pressure there is no stabilisation.
        roughness: if solver == scene::FluidSolver::Dfsph {
            ROUGHNESS * (fluid.spacing / sound_speed).powi(2)
        } else {
            0.0
        },
        wall_viscosity: fluid.viscosity,
        retention: retention(fluid, &smoothing),
        surface_tension: if is_incompressible { 0.0 } else { fluid.surface_tension },
        cohesion: cohesion(fluid, solver).filter(|_| is_incompressible),
        repulsion_range: range,
        repulsion_stiffness: frequency * frequency,
        repulsion_damping: 2.0 * fluid.repulsion_damping * frequency,
    }
}

/// Viscosity that sums over particles a spacing apart yield for a viscosity of 1, in either form. The viscosity of the scene
/// is divided by it.
fn lattice_viscosity(fluid: &scene::Fluid) -> f32 {
    Wendland::lattice_viscosity(f64::from(fluid.support_radius()), f64::from(fluid.spacing)) as f32
}

fn lattice_central_viscosity(fluid: &scene::Fluid) -> f32 {
    Wendland::lattice_central_viscosity(f64::from(fluid.support_radius()), f64::from(fluid.spacing)) as f32
}

/// What holds films and drops, if anything does. Particles of the first layer lie half a spacing above a surface.
fn retention(fluid: &scene::Fluid, smoothing: &Wendland) -> Option<Retention> {
    let (density, edge) = lattice::film(smoothing, fluid.spacing);
    let strength = fluid.retention / (PI * (fluid.rest_density * fluid.spacing).powi(2) * edge);
    let density = density * fluid.rest_density;
    (fluid.retention > 0.0).then_some(Retention { strength, density, range: fluid.spacing })
}

/// Surface energy of drops that have settled, over that of the layers of a lattice that ends in a plane and has the same area. `divergence`
/// leaves particles less in layers than the solvers of the density do.
const SETTLED: f64 = 0.97;
const SETTLED_DIVERGENCE: f64 = 1.03;

/// Surface tension from a surface energy, if there is any.
fn cohesion(fluid: &scene::Fluid, solver: scene::FluidSolver) -> Option<Cohesion> {
    let settled = if solver == scene::FluidSolver::Divergence { SETTLED_DIVERGENCE } else { SETTLED };
    let (spacing, smoothing) = (fluid.spacing, Wendland::new(fluid.neighbor_radius()));
    let sum = Wendland::lattice_sum(f64::from(smoothing.support_radius), f64::from(spacing));
    (fluid.surface_tension > 0.0).then(|| Cohesion {
        stiffness: cohesion_stiffness(&smoothing, spacing, fluid.surface_tension, settled),
        smoothing,
        volume: (f64::from(spacing).powi(3) / sum) as f32,
    })
}

/// Smallest mass of a dynamic body, over the same and half of the water that it displaces.
fn lightest(scene: &Scene, fluid: &scene::Fluid) -> f32 {
    let dynamic = scene.bodies.iter().filter(|body| body.kind == BodyKind::Dynamic);
    dynamic.map(|body| body.density / (body.density + 0.5 * fluid.rest_density)).fold(1.0, f32::min)
}

fn incompressible(
    scene: &Scene,
    fluid: &scene::Fluid,
    smoothing: &Wendland,
    sound_speed: f32,
) -> Option<Incompressible> {
    let solver = scene.fluid_solver()?;
    if solver == scene::FluidSolver::Wcsph {
        return None;
    }
    let (boundary_range, boundary_share) = boundary_profile(smoothing, fluid.spacing);
    Some(Incompressible {
        tolerance: fluid.density_tolerance,
        rounds: fluid.rounds,
        projections: (solver == scene::FluidSolver::Pbf).then_some(fluid.projections),
        lattice_diagonal: lattice::diagonal(smoothing, fluid.spacing),
        // The speed of sound is ten times the fastest expected speed of the water.
        correction_speed: 0.1 * sound_speed,
        boundary_range,
        boundary_share,
        divergence: (solver == scene::FluidSolver::Divergence).then(|| {
            let (surface_moment, surface_lack) = lattice::surface(smoothing, fluid.spacing);
            let lattice_moment = lattice::moment(smoothing, fluid.spacing);
            Divergence { lattice_moment, surface_moment, surface_lack, lightest: lightest(scene, fluid) }
        }),
    })
}

fn sponge_params(scene: &Scene, sponge: &scene::Sponge) -> SpongeParams {
    let (viscosity, density) =
        scene.fluid.as_ref().map_or((0.0, 1.0), |fluid| (fluid.viscosity, fluid.rest_density));
    let (mu, lambda) = SpongeParams::neo_hookean(sponge.young_modulus, sponge.poisson_ratio);
    SpongeParams {
        edge: sponge.edge,
        solver: match sponge.solver {
            scene::Solver::Sbd => Solver::Sbd,
            scene::Solver::Vbd => Solver::Vbd,
            scene::Solver::XpbdNeoHookean => Solver::XpbdNeoHookean,
        },
        mu,
        lambda,
        damping: sponge.damping,
        stretch_modulus: sponge.stretch_modulus,
        shear_modulus: sponge.shear_modulus,
        volume_modulus: sponge.volume_modulus,
        damping_time: sponge.damping_time,
        iterations: match sponge.solver {
            scene::Solver::XpbdNeoHookean => 1,
            _ => sponge.iterations,
        },
        friction: sponge.friction,
        self_contact: sponge.self_contact,
        porosity: sponge.porosity,
        drag_rate: viscosity * sponge.porosity / (density * sponge.permeability),
        inertial_drag_rate: sponge.forchheimer * sponge.porosity * sponge.porosity
            / sponge.permeability.sqrt(),
        pores_close: scene.coupling() == scene::Coupling::Porous,
        entry_pressure: sponge.entry_pressure,
        saturation_gain: sponge.saturation_gain,
        reaction: sponge.reaction,
        wetting: WettingParams {
            softening: sponge.softening,
            swelling: sponge.swelling,
            time: sponge.wetting_time,
            exponent: sponge.relative_permeability_exponent,
            receding: (sponge.receding_pressure - sponge.entry_pressure).max(0.0),
        },
    }
}
