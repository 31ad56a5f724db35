//! The stores: structures of arrays, each column declared once.
//!
//! A *column* is one physical quantity of one store, and the unit of scheduling, hashing and saving. Vector
//! columns that neighbours read are packed rows of four floats, because one 16-byte load per neighbour is the
//! fastest way to fetch it; the fourth float carries a scalar that is needed along with the vector.
//!
//! Rows are padded to a multiple of eight with at least one row to spare ([`padded`]). Padding rows of
//! particles lie at [`FAR`], beyond every support radius, so that a list can be filled up with them: they add
//! exact zeros to every sum.

use crate::{
    body::Bodies,
    column::{ColumnData, Life},
    grid::{
        cells::Cells,
        neighbors::{ListValues, Neighbors},
    },
    pbd::{lattice::Topology, stars::Stars},
    reduce::{Extremes, Wrenches},
    sph::{pressure_solve::PressureSolve, viscosity_solve::ViscositySolve},
};

macro_rules! columns {
    ($($(#[$store_doc:meta])* $store:ident: $Store:ident {
        $($(#[$doc:meta])* $Column:ident = $field:ident: $Type:ty, $unit:literal, $life:ident;)*
    })*) => {
        $($(#[$store_doc])*
        #[derive(Clone, Debug, Default)]
        pub struct $Store {
            $($(#[$doc])* #[doc = concat!("\n\nUnit: ", $unit, ".")] pub $field: $Type,)*
        })*

        /// Every column; the order is the order of the digest and of saved files.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Column {
            $($($(#[$doc])* $Column,)*)*
        }

        impl Column {
            /// All columns, in order.
            pub const ALL: &'static [Self] = &[$($(Self::$Column,)*)*];

            /// Name, `store.quantity`.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $($(Self::$Column => concat!(stringify!($store), ".", stringify!($field)),)*)* }
            }

            /// SI unit.
            #[must_use]
            pub const fn unit(self) -> &'static str {
                match self { $($(Self::$Column => $unit,)*)* }
            }

            /// How long the content lives.
            #[must_use]
            pub const fn life(self) -> Life {
                match self { $($(Self::$Column => Life::$life,)*)* }
            }

            /// The store that the column belongs to.
            #[must_use]
            pub const fn store(self) -> Store {
                match self { $($(Self::$Column => Store::$Store,)*)* }
            }
        }

        /// Every store.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Store {
            $($(#[$store_doc])* $Store,)*
        }

        /// All stores of a world.
        #[derive(Clone, Debug, Default)]
        pub struct Columns {
            /// Number of rows in use, without padding.
            pub rows: RowCounts,
            $($(#[$store_doc])* pub $store: $Store,)*
        }

        impl Columns {
            /// The data of a column.
            #[must_use]
            pub fn data(&self, column: Column) -> &dyn ColumnData {
                match column { $($(Column::$Column => &self.$store.$field,)*)* }
            }

            /// The data of a column, writable.
            pub fn data_mut(&mut self, column: Column) -> &mut dyn ColumnData {
                match column { $($(Column::$Column => &mut self.$store.$field,)*)* }
            }
        }
    };
}

columns! {
    /// The fluid, one row per particle, in the order of its cells.
    fluid: Fluid {
        /// Centre of the particle; w: pressure over density squared, p/rho^2 \[Pa m^6/kg^2\].
        FluidPosition = position: Vec<[f32; 4]>, "m", State;
        /// Velocity of the particle; w: its volume m/rho \[m^3\], or, where pressure is solved for, the compression that
        /// it is allowed \[1\].
        FluidVelocity = velocity: Vec<[f32; 4]>, "m/s", State;
        /// Identity of the particle, kept while rows are re-ordered.
        FluidId = id: Vec<u32>, "1", State;
        /// Cells over the particles.
        FluidCells = cells: Cells, "1", Scratch;
        /// For every particle, the particles within the support radius, itself included.
        FluidNeighbors = neighbors: Neighbors, "1", Scratch;
        /// Mass density rho.
        FluidDensity = density: Vec<f32>, "kg/m^3", Scratch;
        /// Acceleration by all forces of this step; w: compression that is allowed, see `sph::forces`.
        FluidAcceleration = acceleration: Vec<[f32; 4]>, "m/s^2", Scratch;
        /// Weight of the share of its neighbourhood that a particle near the surface lacks, see `sph::deficit`.
        FluidDeficit = deficit: Vec<f32>, "1", Scratch;
        /// For every particle, the control rows within the suction radius.
        FluidControls = controls: Neighbors, "1", Scratch;
        /// For every entry of those lists, node volume times kernel.
        FluidControlWeights = control_weights: ListValues, "1", Scratch;
        /// How far inside a sponge the particle is: sum of node volume times kernel, 0 outside, 1 inside.
        FluidInterior = interior: Vec<f32>, "1", Scratch;
        /// Rate at which drag takes the particle to the velocity of the sponge, and what its speed beside the sponge adds to
        /// that \[1/m\]; z: root of how far the material there gives way to the pressure, over the water, see `couple::solid_yield` \[1\];
        /// w: unused.
        FluidDragRate = drag_rate: Vec<[f32; 4]>, "1/s", Scratch;
        /// Impulse that the particle loses to the sponge, over its interior value; w: unused.
        FluidDrag = drag: Vec<[f32; 4]>, "kg m/s", Scratch;
        /// Position at the end of the step as far as it is known; w: change of the pressure over rest density
        /// \[m^2/s^2\].
        FluidPredicted = predicted: Vec<[f32; 4]>, "m", Scratch;
        /// Gradient of the share of walls and bodies in the kernel's volume \[1/m\]; w: the share \[1\].
        FluidBoundary = boundary: Vec<[f32; 4]>, "1/m", Scratch;
        /// Acceleration of a particle by its own pressure, over that pressure over rest density; w: compression
        /// `rho / rho_0 - 1` before the solve.
        FluidFactors = factors: Vec<[f32; 4]>, "1/m", Scratch;
        /// For every entry of the neighbour lists, volume times kernel gradient, over the distance vector.
        FluidPairs = pairs: ListValues, "1/m^2", Scratch;
        /// Pressure over rest density \[m^2/s^2\], its last change, diagonal of the system \[s^2/m^2\], and compression
        /// that is left \[1\].
        FluidPressureRows = pressure_rows: Vec<[f32; 4]>, "m^2/s^2", Scratch;
        /// Acceleration by the change of the pressure; w: its scalar product with the predicted position, less a part of the
        /// change \[m^2/s^2\], see `sph::pressure_acceleration`.
        FluidCorrection = correction: Vec<[f32; 4]>, "m/s^2", Scratch;
        /// Compression that sponges take by giving way to the change of the pressure, over the square of the step, see
        /// `couple::solid_yield`. Empty where there are none.
        FluidYield = solid_yield: Vec<f32>, "1/s^2", Scratch;
        /// Where the pressure solve stands.
        FluidPressureSolve = pressure_solve: PressureSolve, "1", Scratch;
        /// Rate at which walls and bodies slow a particle down, along the axes: xx, yy, zz; w: unused.
        FluidFriction = friction: Vec<[f32; 4]>, "1/s", Scratch;
        /// The same between the axes: yz, zx, xy; w: unused.
        FluidFrictionBetween = friction_between: Vec<[f32; 4]>, "1/s", Scratch;
        /// What is left of the equation of the implicit viscosity; w: unused.
        FluidViscosityResidual = viscosity_residual: Vec<[f32; 4]>, "m/s", Scratch;
        /// Direction of the present round of that solve; w: unused.
        FluidViscosityDirection = viscosity_direction: Vec<[f32; 4]>, "m/s", Scratch;
        /// Product of its matrix with that direction; w: unused.
        FluidViscosityProduct = viscosity_product: Vec<[f32; 4]>, "m/s", Scratch;
        /// Change of the velocity by the implicit viscosity so far; w: unused.
        FluidViscosityChange = viscosity_change: Vec<[f32; 4]>, "m/s", Scratch;
        /// Where that solve stands.
        FluidViscositySolve = viscosity_solve: ViscositySolve, "1", Scratch;
        /// Extremes over chunks of particles, for the time step.
        FluidExtremes = extremes: Extremes, "m/s", Scratch;
    }
    /// The sponges, one row per lattice node, in the order of the vertex colours.
    nodes: Nodes {
        /// Position of the node; w: inverse mass \[1/kg\], 0 for a held node.
        NodePosition = position: Vec<[f32; 4]>, "m", State;
        /// Velocity of the node; w: share of the external acceleration that it followed in the last step, 0 to 1, see
        /// `pbd::guess`.
        NodeVelocity = velocity: Vec<[f32; 4]>, "m/s", State;
        /// Volume of sponge that the node stands for, pores included.
        NodeVolume = volume: Vec<f32>, "m^3", Constant;
        /// Index of the node's sponge.
        NodeSponge = sponge: Vec<u32>, "1", Constant;
        /// 0 for nodes of the outer surface, else 1: surface nodes do not suck.
        NodeSuction = suction: Vec<f32>, "1", Constant;
        /// Kernel sum of node volumes at the node, at rest: what saturation is measured against.
        NodeInterior = interior: Vec<f32>, "1", Constant;
        /// Body that holds the node, or `u32::MAX`.
        NodeGrip = grip: Vec<u32>, "1", Constant;
        /// Position of a held node in the frame of its body; w: unused.
        NodeGripOffset = grip_offset: Vec<[f32; 4]>, "m", Constant;
        /// Tets, their colours and the chunks that colours are solved in.
        NodeTopology = topology: Topology, "1", Constant;
        /// Neighbours and tets of every node.
        NodeStars = stars: Stars, "1", Constant;
        /// Place of the node in the lattice at rest; w: how flat the surface is there, 1 on a face, 0 inside, see `pbd::pairs`.
        NodeRest = rest: Vec<[f32; 4]>, "m", Constant;
        /// Outward normal of the surface of the sponge; w: area that the node stands for \[m^2\], 0 inside and where no sponge
        /// can touch it.
        NodeNormal = normal: Vec<[f32; 4]>, "1", Scratch;
        /// For every surface node, those of other sponges or of its own that it may touch in this step.
        NodePairs = pairs: Neighbors, "1", Scratch;
        /// Force by what the node touches of sponges; w: lowest index of another sponge that it touches, or of its own.
        NodeTouch = touch: Vec<[f32; 4]>, "N", Scratch;
        /// Derivative of that force by the place of the node, with the opposite sign, along the axes: xx, yy, zz; w: highest index
        /// of another sponge that it touches, or of its own.
        NodeTouchStiffness = touch_stiffness: Vec<[f32; 4]>, "N/m", Scratch;
        /// The same between the axes: xy, xz, yz; w: unused.
        NodeTouchBetween = touch_between: Vec<[f32; 4]>, "N/m", Scratch;
        /// Where the node would go without elastic forces and drag; w: its mass \[kg\], 0 for a held node.
        NodeFree = free: Vec<[f32; 4]>, "m", Scratch;
        /// Where inertia and the drag of the fluid draw the node; w: the mass with which they do \[kg\].
        NodeTarget = target: Vec<[f32; 4]>, "m", Scratch;
        /// What walls, bodies and grips gave to the node in this step; w: its mass if it is free to move, else minus the
        /// mass that would resist like what holds it \[kg\].
        NodeReaction = reaction: Vec<[f32; 4]>, "N s", Scratch;
        /// Predicted position, corrected by the constraints; w: inverse mass \[1/kg\].
        NodePredicted = predicted: Vec<[f32; 4]>, "m", Scratch;
        /// External acceleration, by gravity and the fluid; w: unused.
        NodeAcceleration = acceleration: Vec<[f32; 4]>, "m/s^2", Scratch;
        /// Volume of the sponge around the node over that at rest \[1\]; times it: rate of the drag, and what the speed of
        /// the water beside the sponge adds to that \[1/m\]; w: porosity \[1\].
        NodePores = pores: Vec<[f32; 4]>, "1/s", Scratch;
        /// Pore volume filled with fluid, over pore volume.
        NodeSaturation = saturation: Vec<f32>, "1", Scratch;
        /// How wet the material of the node is, 0 to 1; its saturation in this step, at most 1; share of the receding
        /// capillary pressure in its suction; w: how easily water moves through partly filled pores. Empty where no property
        /// of a sponge depends on them, see `couple::wetting`.
        NodeWetting = wetting: Vec<[f32; 4]>, "1", State;
        /// Impulse of the drag of the fluid in this step; w: mass of the fluid that the node takes along \[kg\].
        NodeDrag = drag: Vec<[f32; 4]>, "N s", Scratch;
        /// Moment of that impulse about the node: it acts where the particles are; w: unused.
        NodeDragMoment = drag_moment: Vec<[f32; 4]>, "N m s", Scratch;
        /// Extremes over chunks of nodes, for the time step.
        NodeExtremes = extremes: Extremes, "m/s", Scratch;
    }
    /// The sponge nodes again, as control particles of the fluid, in the order of their cells.
    controls: Controls {
        /// Row of the node.
        ControlNode = node: Vec<u32>, "1", Scratch;
        /// Position of the node; w: its volume \[m^3\].
        ControlPosition = position: Vec<[f32; 4]>, "m", Scratch;
        /// Velocity of the node, filtered by the drag of the fluid; w: share of the drag, see `couple::drag` \[1/kg\].
        ControlVelocity = velocity: Vec<[f32; 4]>, "m/s", Scratch;
        /// Velocity of the node before the filter; w: inverse mass \[1/kg\].
        ControlUnfiltered = unfiltered: Vec<[f32; 4]>, "m/s", Scratch;
        /// Cells over the controls.
        ControlCells = cells: Cells, "1", Scratch;
        /// For every control, the particles within the suction radius.
        ControlFluid = fluid: Neighbors, "1", Scratch;
        /// For every entry of those lists, node volume times kernel.
        ControlFluidWeights = fluid_weights: ListValues, "1", Scratch;
        /// Where the node is expected at the end of the step; w: volume of its material, without pores \[m^3\].
        ControlSolid = solid: Vec<[f32; 4]>, "m", Scratch;
        /// Pore volume filled with fluid, over pore volume.
        ControlSaturation = saturation: Vec<f32>, "1", Scratch;
        /// Control pressure times volume: negative, so that it sucks.
        ControlSuction = suction: Vec<f32>, "Pa m^3", Scratch;
    }
    /// Rigid bodies, one row per body.
    bodies: BodyStore {
        /// Shapes, poses and velocities.
        BodyStates = states: Bodies, "m", State;
        /// What the fluid gave to the bodies in this step.
        BodyFluidWrenches = fluid_wrenches: Wrenches, "N s", Scratch;
        /// What the sponges gave to the bodies in this step.
        BodyNodeWrenches = node_wrenches: Wrenches, "N s", Scratch;
    }
}

/// Number of rows of every store, without padding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RowCounts {
    /// Fluid particles.
    pub fluid: usize,
    /// Sponge nodes, and control rows.
    pub nodes: usize,
    /// Tets.
    pub tets: usize,
    /// Rigid bodies.
    pub bodies: usize,
}

impl RowCounts {
    /// Number of rows of a store.
    #[must_use]
    pub fn of(&self, store: Store) -> usize {
        match store {
            Store::Fluid => self.fluid,
            Store::Nodes | Store::Controls => self.nodes,
            Store::BodyStore => self.bodies,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique() {
        let mut names: Vec<_> = Column::ALL.iter().map(|column| column.name()).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), Column::ALL.len());
    }
}
