//! The table of ranges. Validation, schema and a test of the docs use it.

use super::container::GRAVITY_KEY;
use super::flows::{DRAIN, EMITTER};
use super::number::Numbers;
use super::{
    Body, Camera, Domain, Fluid, FluidBlock, Mesh, Motion, Rotation, Scene, ShapeKind, Sponge, Time,
};

/// Allowed range of one key; both ends are included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Key with `[]` for "every element", such as `sponges[].permeability`; a vector's range holds for each component.
    pub key: &'static str,
    /// SI unit, "1" for pure numbers.
    pub unit: &'static str,
    /// Smallest value.
    pub minimum: f32,
    /// Largest value.
    pub maximum: f32,
}

impl Limit {
    /// Last part of the key.
    #[must_use]
    pub fn field(&self) -> &'static str {
        self.key.rsplit('.').next().unwrap_or(self.key)
    }

    /// Whether a number is finite and in the range.
    #[must_use]
    pub fn contains(&self, value: f32) -> bool {
        // False for NaN, too.
        self.minimum <= value && value <= self.maximum
    }
}

/// All ranges, in the order of the documentation.
pub fn limits() -> impl Iterator<Item = &'static Limit> {
    fn of<T>(rows: &'static [Row<T>]) -> impl Iterator<Item = &'static Limit> {
        rows.iter().map(|row| &row.limit)
    }
    of(SCENE)
        .chain(of(GRAVITY_KEY))
        .chain(of(TIME))
        .chain(of(DOMAIN))
        .chain(of(FLUID))
        .chain(of(FLUID_BLOCK))
        .chain(of(EMITTER))
        .chain(of(DRAIN))
        .chain(of(SPONGE))
        .chain(of(BODY))
        .chain(of(SHAPE))
        .chain(of(MESH))
        .chain(of(ROTATION))
        .chain(of(MOTION))
        .chain(of(CAMERA))
}

/// The range of a key, as [`limits`] has it.
pub(crate) fn limit(key: &str) -> Option<&'static Limit> {
    limits().find(|limit| limit.key == key)
}

/// A range and access to its numbers; `None` where the present variant lacks the key.
pub(super) struct Row<T> {
    pub(super) limit: Limit,
    pub(super) field: fn(&T) -> Option<&dyn Numbers>,
}

/// Rows of a structure, whose fields have the names of the keys.
macro_rules! fields {
    ($owner:ty, $table:literal; $($field:ident: $minimum:literal to $maximum:literal, $unit:literal;)+) => {
        &[$(Row {
            limit: Limit {
                key: concat!($table, stringify!($field)),
                unit: $unit,
                minimum: $minimum,
                maximum: $maximum,
            },
            field: |owner: &$owner| Some(&owner.$field),
        }),+]
    };
}

pub(super) use fields;

/// Rows of an enumeration: the key and the variants that have it.
macro_rules! variants {
    ($owner:ident, $table:literal;
     $($field:ident in $($variant:ident)|+: $minimum:literal to $maximum:literal, $unit:literal;)+) => {
        &[$(Row {
            limit: Limit {
                key: concat!($table, stringify!($field)),
                unit: $unit,
                minimum: $minimum,
                maximum: $maximum,
            },
            #[allow(unreachable_patterns, reason = "some keys are in every variant")]
            field: |owner: &$owner| match owner {
                $($owner::$variant { $field, .. } => Some($field),)+
                _ => None,
            },
        }),+]
    };
}

pub(super) const SCENE: &[Row<Scene>] = fields! { Scene, "";
    gravity: -100.0 to 100.0, "m/s^2";
};

pub(super) const TIME: &[Row<Time>] = fields! { Time, "time.";
    frame_rate: 1.0 to 1e4, "1/s";
    duration: 0.0 to 1e5, "s";
    maximum_step: 1e-6 to 0.1, "s";
    minimum_step: 1e-9 to 0.1, "s";
    courant: 0.01 to 1.0, "1";
    sleep_after: 0.0 to 1e3, "s";
    sleep_speed: 0.0 to 1.0, "m/s";
};

pub(super) const DOMAIN: &[Row<Domain>] = variants! { Domain, "domain.";
    minimum in Box: -1000.0 to 1000.0, "m";
    maximum in Box: -1000.0 to 1000.0, "m";
};

pub(super) const FLUID: &[Row<Fluid>] = fields! { Fluid, "fluid.";
    spacing: 1e-4 to 1.0, "m";
    rest_density: 1.0 to 2e4, "kg/m^3";
    support: 1.8 to 3.0, "1";
    density_tolerance: 1e-6 to 0.1, "1";
    rounds: 1.0 to 1000.0, "1";
    projections: 1.0 to 100.0, "1";
    sound_speed: 0.1 to 2000.0, "m/s";
    viscosity: 0.0 to 1000.0, "Pa s";
    viscosity_tolerance: 1e-6 to 0.1, "1";
    viscosity_rounds: 1.0 to 1000.0, "1";
    artificial_viscosity: 0.0 to 1.0, "1";
    surface_tension: 0.0 to 10.0, "N/m";
    retention: 0.0 to 1.0, "N/m";
    repulsion_damping: 0.0 to 1.0, "1";
    absorption: 0.0 to 1e5, "1/m";
    colour: 0.0 to 1.0, "1";
};

pub(super) const FLUID_BLOCK: &[Row<FluidBlock>] = fields! { FluidBlock, "fluid.blocks[].";
    minimum: -1000.0 to 1000.0, "m";
    maximum: -1000.0 to 1000.0, "m";
    velocity: -100.0 to 100.0, "m/s";
};

pub(super) const SPONGE: &[Row<Sponge>] = fields! { Sponge, "sponges[].";
    edge: 1e-4 to 1.0, "m";
    cells: 2.0 to 1024.0, "1";
    position: -1000.0 to 1000.0, "m";
    velocity: -100.0 to 100.0, "m/s";
    density: 1.0 to 5000.0, "kg/m^3";
    porosity: 0.05 to 0.99, "1";
    permeability: 1e-14 to 1e-5, "m^2";
    forchheimer: 0.0 to 2.0, "1";
    entry_pressure: 0.0 to 1e5, "Pa";
    suction_radius: 1.0 to 2.5, "1";
    saturation_gain: 0.0 to 5.0, "1";
    reaction: 0.0 to 2.0, "1";
    young_modulus: 10.0 to 1e9, "Pa";
    poisson_ratio: 0.0 to 0.49, "1";
    damping: 0.0 to 10.0, "s";
    stretch_modulus: 10.0 to 1e9, "Pa";
    shear_modulus: 10.0 to 1e9, "Pa";
    volume_modulus: 10.0 to 1e9, "Pa";
    damping_time: 0.0 to 10.0, "s";
    iterations: 1.0 to 64.0, "1";
    friction: 0.0 to 10.0, "1";
    saturation: 0.0 to 1.0, "1";
    softening: 0.0 to 0.95, "1";
    swelling: 0.0 to 0.5, "1";
    wetting_time: 0.0 to 1000.0, "s";
    relative_permeability_exponent: 1.0 to 8.0, "1";
    receding_pressure: 0.0 to 1e5, "Pa";
};

pub(super) const BODY: &[Row<Body>] = fields! { Body, "bodies[].";
    density: 1.0 to 1e5, "kg/m^3";
    position: -1000.0 to 1000.0, "m";
    linear_velocity: -100.0 to 100.0, "m/s";
    angular_velocity: -1000.0 to 1000.0, "rad/s";
    friction: 0.0 to 10.0, "1";
    restitution: 0.0 to 1.0, "1";
    colour: 0.0 to 1.0, "1";
};

pub(super) const SHAPE: &[Row<ShapeKind>] = variants! { ShapeKind, "bodies[].shape.";
    radius in Sphere | Capsule | Cup: 1e-4 to 100.0, "m";
    half_extents in Cuboid: 1e-4 to 100.0, "m";
    half_height in Capsule: 0.0 to 100.0, "m";
    vertices in Hull: -100.0 to 100.0, "m";
    height in Cup: 1e-4 to 100.0, "m";
    thickness in Cup: 1e-4 to 100.0, "m";
    parts in Mesh: 1.0 to 256.0, "1";
};

pub(super) const MESH: &[Row<Mesh>] = fields! { Mesh, "bodies[].shape.mesh.";
    scale: 1e-6 to 1e6, "1";
    vertices: -1000.0 to 1000.0, "m";
    triangles: 0.0 to 1e7, "1";
};

pub(super) const ROTATION: &[Row<Rotation>] = fields! { Rotation, "bodies[].rotation.";
    axis: -1000.0 to 1000.0, "1";
    degrees: -3600.0 to 3600.0, "degrees";
};

pub(super) const MOTION: &[Row<Motion>] = variants! { Motion, "bodies[].motions[].";
    velocity in Linear: -100.0 to 100.0, "m/s";
    axis in Turn: -1000.0 to 1000.0, "1";
    pivot in Turn: -1000.0 to 1000.0, "m";
    rate in Turn: -1000.0 to 1000.0, "rad/s";
    amplitude in Shake: -10.0 to 10.0, "m";
    frequency in Shake: 1e-3 to 1000.0, "1/s";
    start in Linear | Turn | Shake: 0.0 to 1e5, "s";
    end in Linear | Turn | Shake: 0.0 to 1e5, "s";
    ease in Linear | Turn | Shake: 0.0 to 1e5, "s";
};

pub(super) const CAMERA: &[Row<Camera>] = fields! { Camera, "camera.";
    eye: -1e4 to 1e4, "m";
    target: -1e4 to 1e4, "m";
    field_of_view_degrees: 1.0 to 150.0, "degrees";
};
