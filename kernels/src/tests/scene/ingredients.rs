//! Parameters and bodies of the scenes of the tests.

use std::sync::Arc;

use glam::{EulerRot, Mat3, Quat, Vec3};

use super::options::{Options, SPACING};
use crate::{
    body::{Body, BodyKind, BodyState, Compound, ConvexPart, Shape},
    grid::cells::Domain,
    params::{
        Cohesion, Divergence, FluidParams, ImplicitViscosity, Incompressible, NO_WALL, Params, Retention,
        Solver, SpongeParams, WettingParams,
    },
    periodic::Periodic,
    rounding::Rounding,
    smoothing::Wendland,
    sph::{lattice, obstacles::boundary_profile},
};

/// The body that holds nodes.
pub(super) const GRIPPER: usize = 5;

impl SpongeParams {
    /// Constraints of a material are only solved in steps that are short for it (`src/clock.rs`). Beyond, a sweep turns
    /// every other tet inside out, and what was rounded away grows by a hundred: the material is softer then.
    pub(super) fn solve_by(&mut self, solver: Solver) {
        self.solver = solver;
        if solver == Solver::XpbdNeoHookean {
            (self.mu, self.lambda) = (self.mu * 0.02, self.lambda * 0.02);
        }
    }
}

pub(super) fn params(options: Options) -> Params {
    let spacing = options.spacing();
    let radius = 2.2 * spacing;
    // A power of a constant is rounded once, and the oracles' bounds are for that mass.
    let cube = if options.refinement() == 1 { SPACING.powi(3) } else { spacing.powi(3) };
    let sum = Wendland::lattice_sum(f64::from(radius), f64::from(spacing)) as f32;
    let (low, high) = (Vec3::new(-0.002, 0.0024, -0.001), Vec3::new(0.0775, 0.06, 0.05));
    let domain = Domain::Bounded { minimum: low - 0.02, maximum: high + 0.02 };
    let without = |corner: Vec3, far: f32| Vec3::select(options.periodic.into(), Vec3::splat(far), corner);
    Params {
        // As far over the spacing in a step: faster ones would be thrown many boxes far, and the way back in is rounded.
        step: 0.001 / options.refinement() as f32,
        asleep: crate::asleep::Asleep::default(),
        gravity: Vec3::new(0.5, -9.81, 0.25),
        domain: if options.bounded { domain } else { Domain::Unbounded },
        walls: options.walls.then_some((without(low, -NO_WALL), without(high, NO_WALL))),
        periodic: Periodic::new(Vec3::ZERO, Vec3::new(13.0, 9.0, 9.0) * SPACING, options.periodic),
        no_slip: true,
        fluid: FluidParams {
            spacing,
            rest_density: 1000.0,
            particle_mass: 1000.0 * cube / sum,
            smoothing: Wendland::new(radius),
            equation_of_state: options.equation_of_state,
            sound_speed: 10.0,
            incompressible: options
                .incompressible
                .then(|| incompressible(radius, spacing, options.divergence)),
            viscosity: 0.5,
            central_viscosity: 0.3,
            strain_viscosity: if options.strain_rate { 0.5 } else { 0.0 },
            implicit_viscosity: options.implicit_viscosity.then_some(IMPLICIT_VISCOSITY),
            roughness: if options.incompressible { 5.0e-7 } else { 0.0 },
            wall_viscosity: 5.0,
            // Most particles lack something of it.
            retention: options.retention.then_some(Retention {
                strength: 0.02,
                density: 1500.0,
                range: 1.5 * spacing,
            }),
            // The colour field knows volumes that change.
            surface_tension: if options.incompressible { 0.0 } else { 0.07 },
            cohesion: options.cohesion.then(|| cohesion(radius, spacing)),
            repulsion_range: spacing,
            repulsion_stiffness: 1.0e5,
            repulsion_damping: 50.0,
        },
        sponges: if options.sponges { sponges(options.wetting, options.touch) } else { Vec::new() },
        coupling: Wendland::new(0.015),
        solid: options.porous.then(|| Wendland::new(0.012)),
        is_barycentric: options.barycentric,
    }
}

/// With a tolerance that the first round meets, so that rounding does not decide about the residual.
const IMPLICIT_VISCOSITY: ImplicitViscosity =
    ImplicitViscosity { viscosity: 8.0, central_viscosity: 5.0, tolerance: 1.0e6, rounds: 50 };

/// With a tolerance of zero, so that rounding does not decide about one more round.
fn incompressible(radius: f32, spacing: f32, divergence: bool) -> Incompressible {
    let smoothing = Wendland::new(radius);
    let (boundary_range, boundary_share) = boundary_profile(&smoothing, spacing);
    Incompressible {
        projections: None,
        tolerance: 0.0,
        rounds: 50,
        lattice_diagonal: lattice::diagonal(&smoothing, spacing),
        correction_speed: 1.0,
        boundary_range,
        boundary_share,
        divergence: divergence.then(|| {
            let (surface_moment, surface_lack) = lattice::surface(&smoothing, spacing);
            let lattice_moment = lattice::moment(&smoothing, spacing);
            Divergence { lattice_moment, surface_moment, surface_lack, lightest: 0.8 }
        }),
    }
}

fn cohesion(radius: f32, spacing: f32) -> Cohesion {
    let smoothing = Wendland::new(1.5 * radius);
    let sum = Wendland::lattice_sum(1.5 * f64::from(radius), f64::from(spacing)) as f32;
    Cohesion { stiffness: 500.0, smoothing, volume: spacing.powi(3) / sum }
}

fn sponges(has_wetting: bool, touch: bool) -> Vec<SpongeParams> {
    let mut wetting = [WettingParams::default(), WettingParams::default()];
    if has_wetting {
        wetting[0] =
            WettingParams { softening: 0.6, swelling: 0.03, time: 0.004, exponent: 4, receding: 250.0 };
        wetting[1].receding = 100.0;
    }
    let [of_soft, of_stiff] = wetting;
    let soft = SpongeParams {
        edge: 0.01,
        solver: Solver::Sbd,
        mu: 8.0e3,
        lambda: 1.3e4,
        damping: 0.002,
        stretch_modulus: 8.0e3,
        shear_modulus: 4.0e3,
        volume_modulus: 2.0e3,
        damping_time: 0.002,
        iterations: 4,
        friction: 0.4,
        self_contact: false,
        porosity: 0.9,
        drag_rate: 2000.0,
        inertial_drag_rate: 300.0,
        pores_close: true,
        entry_pressure: 300.0,
        saturation_gain: 1.5,
        reaction: 1.0,
        wetting: of_soft,
    };
    let stiff = SpongeParams {
        edge: 0.008,
        solver: Solver::Sbd,
        mu: 2.0e4,
        lambda: 3.0e4,
        damping: 0.0,
        stretch_modulus: 3.0e4,
        shear_modulus: 2.0e4,
        volume_modulus: 1.0e4,
        damping_time: 0.0,
        iterations: 2,
        friction: 0.1,
        self_contact: false,
        porosity: 0.8,
        drag_rate: 500.0,
        inertial_drag_rate: 0.0,
        pores_close: false,
        entry_pressure: 150.0,
        saturation_gain: 0.5,
        reaction: 0.7,
        wetting: of_stiff,
    };
    let mut all = vec![soft, stiff];
    if touch {
        all.push(SpongeParams { self_contact: true, ..all[0].clone() });
    }
    all
}

/// Two boxes across each other, as one body.
fn compound() -> Shape {
    let part = |centre: Vec3, half: Vec3| {
        let corner = |index: u32| {
            let sign = |bit: u32| if index >> bit & 1 == 1 { 1.0 } else { -1.0 };
            half * Vec3::new(sign(0), sign(1), sign(2))
        };
        let quads = [[1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4], [4, 5, 7, 6], [0, 2, 3, 1]];
        let hull = |by: f32| Shape::Hull {
            planes: [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z]
                .map(|normal| (normal, (normal * half).element_sum().abs() - by))
                .to_vec(),
            vertices: (0..8).map(|index| corner(index) * (1.0 - by / half)).collect(),
            triangles: quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect(),
        };
        ConvexPart { centre, hull: hull(0.0), core: hull(0.001), radius: 0.001 }
    };
    let parts = vec![
        part(Vec3::new(0.0, -0.004, 0.0), Vec3::new(0.01, 0.003, 0.008)),
        part(Vec3::new(-0.006, 0.002, 0.0), Vec3::new(0.003, 0.009, 0.008)),
    ];
    Shape::Compound(Arc::new(Compound { parts, ..Compound::default() }))
}

/// One body of every shape, each touching fluid and nodes, and one that grips. A compound is in place of the hull if that is asked for.
pub(super) fn bodies(has_compound: bool) -> Vec<Body> {
    let corner = 0.006_f32;
    let signs = [-1.0_f32, 1.0];
    let faces = signs.map(|x| signs.map(|y| signs.map(|z| (Vec3::new(x, y, z).normalize(), corner))));
    let hull = Shape::Hull {
        planes: faces.into_iter().flatten().flatten().collect(),
        vertices: [Vec3::X, Vec3::Y, Vec3::Z]
            .into_iter()
            .flat_map(|axis| signs.map(|sign| axis * sign * corner * 3.0_f32.sqrt()))
            .collect(),
        // An octahedron: corners along -x, x, -y, y, -z, z.
        triangles: vec![
            [1, 3, 5],
            [3, 0, 5],
            [0, 2, 5],
            [2, 1, 5],
            [3, 1, 4],
            [0, 3, 4],
            [2, 0, 4],
            [1, 2, 4],
        ],
    };
    let half_extents = Vec3::new(0.006, 0.004, 0.008);
    let capsule = Shape::Capsule { half_height: 0.01, radius: 0.004 };
    let mut all = vec![
        body(Shape::Sphere { radius: 0.008 }, [0.03, 0.02, 0.02], 0.0),
        body(Shape::Cuboid { half_extents }, [0.06, 0.03, 0.03], 0.7),
        body(capsule, [0.0162, 0.035, 0.03], -0.4),
        body(if has_compound { compound() } else { hull }, [0.045, 0.012, 0.035], 0.3),
        // The solid side is +x, where padding rows lie as well.
        body(Shape::Plane, [0.066, 0.0, 0.0], 1.62),
        body(Shape::Sphere { radius: 0.01 }, [0.03, 0.05, 0.02], 0.9),
    ];
    all[4].kind = BodyKind::Kinematic;
    (all[4].inverse_mass, all[4].inverse_inertia) = (0.0, Mat3::ZERO);
    all[GRIPPER].touches_nodes = false;
    all[1].no_slip = false;
    // Faster than contact and pressure are made for.
    all[1].state.linear_velocity = Vec3::new(2.0, -1.0, 1.5);
    all
}

fn body(shape: Shape, position: [f32; 3], angle: f32) -> Body {
    let position = Vec3::from_array(position);
    let rounding = Rounding::new(&shape, SPACING);
    Body {
        shape,
        kind: BodyKind::Dynamic,
        state: BodyState {
            position,
            rotation: Quat::from_euler(EulerRot::ZXY, angle, angle * 0.3, angle * 0.1),
            linear_velocity: Vec3::new(0.1, -0.3, 0.2) - position,
            angular_velocity: Vec3::new(3.0, -2.0, 1.0),
        },
        friction: 0.3,
        touches_nodes: true,
        no_slip: true,
        rounding,
        inverse_mass: 300.0,
        inverse_inertia: Mat3::from_diagonal(Vec3::new(2.0e7, 1.0e7, 3.0e7)),
    }
}
