//! The stores: structures of arrays, each column declared once.
//!
//! A *column* is one physical quantity of one store, and the unit of scheduling, hashing and saving. Vector columns that
//! neighbours read are packed rows of four floats, because one 16-byte load per neighbour is fastest. The fourth float is a
//! scalar that the same passes need.
//!
//! Rows are padded to a multiple of eight, by at least one row ([`padded`](crate::column::padded)). Padding rows of particles lie at
//! [`FAR`](crate::column::FAR), beyond every support radius, and fill up neighbour lists: they add exact zeros to every sum.

use crate::{
    body::Bodies,
    column::{ColumnData, Element, FAR_ROW, Lane, Life, Padding},
    declaration::columns,
    divergence::image_rows::{ImageRows, Images},
    grid::{
        cells::Cells,
        neighbors::{ListValues, Neighbors},
    },
    need::Need,
    pbd::{lattice::Topology, stars::Stars},
    reduce::{Extremes, Wrenches},
    sph::{pressure_solve::PressureSolve, viscosity_solve::ViscositySolve},
    tets::rows::{CornerRows, Corners},
};

columns! {
    /// The fluid, one row per particle, in the order of its cells.
    fluid fluid: Fluid {
        /// Centre of the particle; w: pressure over density squared, p/rho^2 \[Pa m^6/kg^2\].
        FluidPosition = position: rows("m"; PRESSURE_OVER_SQUARED_DENSITY 3 "Pa m^6/kg^2") padded Row(FAR_ROW), State;
        /// Velocity of the particle. w: its volume m/rho \[m^3\] or, with a pressure solve, its permitted compression \[1\] or, with
        /// one for the divergence, its kinematic pressure \[m^2/s^2\].
        FluidVelocity = velocity: rows("m/s"; VOLUME 3 "m^3", ALLOWED_COMPRESSION 3 "1", PRESSURE 3 "m^2/s^2"), State;
        /// Identity of the particle, kept while rows are re-ordered.
        FluidId = id: words("1") padded Word(u32::MAX), State;
        /// Cells over the particles.
        FluidCells = cells: Cells("1"), Scratch on host;
        /// For every particle, the particles within the support radius, itself included.
        FluidNeighbors = neighbors: Neighbors("1"), Scratch;
        /// Mass density rho.
        FluidDensity = density: values("kg/m^3"), Kept;
        /// Acceleration by all forces of this step; w: permitted compression without delay, see `sph::forces`.
        FluidAcceleration = acceleration: rows("m/s^2"; ALLOWED_COMPRESSION 3 "1"), Scratch;
        /// Weight of the deficit of neighbours of a particle near the surface, over the part that walls and bodies leave, see
        /// `sph::deficit`.
        FluidDeficit = deficit: values("1"), Scratch, needs Cohesion;
        /// Weight of that deficit times the part of what walls and bodies leave that is filled.
        FluidAdhesion = adhesion: values("1"), Scratch, needs Cohesion;
        /// For every particle, the control rows within the suction radius.
        FluidControls = controls: Neighbors("1"), Scratch, needs Sponge;
        /// For every entry of those lists, node volume times W.
        FluidControlWeights = control_weights: ListValues("1"), Scratch on host;
        /// Interior value of the particle: sum of the present volumes of nodes times W, 0 outside of sponges, 1 inside.
        FluidInterior = interior: values("1"), Kept, needs Sponge;
        /// Drag rate of the particle; y: its derivative by the speed relative to the sponge \[1/m\]. z: root of the
        /// compliance of the material to the pressure, over that of water, see `couple::solid_yield` \[1\]. w: sum of the
        /// weights of nodes, chi.
        FluidDragRate = drag_rate: rows(; DRAG_RATE 0 "1/s", INERTIAL_DRAG_RATE 1 "1/m", COMPLIANCE 2 "1", NODE_WEIGHT 3 "1"), Scratch,
            needs Sponge;
        /// Impulse that the particle loses to the sponge, over its sum of the weights of nodes.
        FluidDrag = drag: rows("kg m/s"; MASS 3 "kg"), Scratch, needs Sponge;
        /// Predicted position at the end of the step; w: change of the kinematic pressure \[m^2/s^2\]. With a pressure solve for
        /// the divergence the position at its beginning; w: the kinematic pressure.
        FluidPredicted = predicted: rows("m"; PRESSURE_CHANGE 3 "m^2/s^2", PRESSURE 3 "m^2/s^2") padded Row(FAR_ROW), Scratch,
            needs Incompressible;
        /// Gradient of the boundary volume fraction of walls, bodies and sponges \[1/m\]; w: the fraction \[1\].
        FluidBoundary = boundary: rows("1/m"; SHARE 3 "1"), Scratch, needs Incompressible;
        /// Acceleration of a particle by its own pressure, over its kinematic pressure. w: compression `rho / rho_0 - 1` before the
        /// solve. With a solve for the divergence: the divergence that the error of the density asks for, times the step.
        FluidFactors = factors: rows("1/m"; COMPRESSION 3 "1", TARGET 3 "1"), Scratch, needs Incompressible;
        /// For every entry of the neighbour lists, volume times the gradient of W, over the distance vector.
        FluidPairs = pairs: ListValues("1/m^2"), Scratch on host;
        /// Kinematic pressure \[m^2/s^2\], its last change, diagonal of the system \[s^2/m^2\], and remaining compression
        /// \[1\].
        FluidPressureRows = pressure_rows:
            rows(; PRESSURE 0 "m^2/s^2", CHANGE 1 "m^2/s^2", DIAGONAL 2 "s^2/m^2", COMPRESSION 3 "1")
            padded Row([0.0, 0.0, 1.0, 0.0]), Scratch, needs Incompressible;
        /// Acceleration by the change of the pressure; w: its scalar product with the predicted position, less a part of the
        /// change \[m^2/s^2\], see `sph::pressure_acceleration`. With a solve for the divergence the velocity \[m/s\] by the pressure
        /// of the present round. w: the rate at which the material of sponges compresses the particle \[1/s\].
        FluidCorrection = correction: rows("m/s^2"; ALONG_POSITION 3 "m^2/s^2", COMPRESSION_RATE 3 "1/s"), Scratch, needs Incompressible;
        /// Images of the particles in walls and bodies.
        FluidImages = images: Images("m"), Scratch;
        /// For every image, that of a vector of its particle.
        FluidImageVectors = image_vectors: ImageRows("1"), Scratch on host;
        /// For every image in walls alone the renormalisation of its particle, mirrored, along the axes: xx, yy, zz. Zero for those in
        /// bodies.
        FluidImageRenormalisation = image_renormalisation: ImageRows("1"), Scratch on host;
        /// The same between the axes: yz, zx, xy.
        FluidImageRenormalisationBetween = image_renormalisation_between: ImageRows("1"), Scratch on host;
        /// Position of every image; w: pressure of its particle.
        FluidImagePredicted = image_predicted: ImageRows("m"), Scratch on host;
        /// Acceleration of every image in a body, which its particle and the body receive. Zero for those in walls alone.
        FluidImageForce = image_force: ImageRows("m/s^2"), Scratch on host;
        /// Mean velocity of the neighbours along the lines to them, relative to the particle, see `divergence::approach`.
        FluidApproach = approach: rows("m/s"), Scratch, needs Divergence;
        /// Inverse of the second moment of the neighbourhood of a particle, along the axes: xx, yy, zz. w: density over that at
        /// rest, with walls, bodies and the material of sponges. Before `divergence::moments` the second moment of the material.
        FluidRenormalisation = renormalisation: rows("1"; DENSITY 3 "1"), Scratch, needs Divergence;
        /// The same between the axes: yz, zx, xy.
        FluidRenormalisationBetween = renormalisation_between: rows("1"), Scratch, needs Divergence;
        /// First moment of the neighbourhood of a particle; before `divergence::moments` that of the material of sponges; w: share of the
        /// material in the volume \[1\].
        FluidMoment = moment: rows("1/m"; MATERIAL 3 "1"), Scratch, needs Divergence;
        /// Change of the velocity of a particle in a sponge over that without drag, with nodes at rest and with nodes that respond \[1\].
        /// What the response of the nodes adds to the diagonal of the system, over the squared norm of the renormalisation \[1/m^2\].
        FluidMobility = mobility: rows(; MOBILITY 0 "1", WITH_NODES 1 "1", DIAGONAL 2 "1/m^2"), Scratch, needs Sponge;
        /// Impulse of the pressure that the drag hands on to the nodes, over the sum of their weights. w: mass of the particle that moves
        /// with them, over the same \[kg\].
        FluidHeld = held: rows("N s"; MASS 3 "kg"), Scratch, needs Sponge;
        /// Velocity by the pressure of the present round, without the drag.
        FluidUndragged = undragged: rows("m/s"), Scratch, needs Sponge;
        /// Control rows of the corners of the tet of the particle; the padding row outside of sponges.
        FluidCorners = corners: Corners("1"), Scratch;
        /// For every corner, before `tets::flux` the gradient and the value of its weight. After it this is the change of the rate of
        /// compression by its velocity \[1/m\], and its weight in means.
        FluidShares = shares: CornerRows("1/m"), Scratch;
        /// Acceleration of the particle by the material of its sponge, over its kinematic pressure. w: change of its velocity over that
        /// without drag, with nodes at rest.
        FluidPushed = pushed: rows("1/m"; MOBILITY 3 "1"), Scratch, needs Barycentric;
        /// Impulse of the pressure that the drag hands on to the nodes; w: mass of the particle times its kinematic pressure.
        FluidCarried = carried: rows("N s"; ENERGY 3 "J"), Scratch, needs Barycentric;
        /// Compression that sponges absorb by their compliance to the pressure change, over the square of the step, see
        /// `couple::solid_yield`. Empty without sponges.
        FluidSolidYield = solid_yield: values("1/s^2"), Scratch, needs Incompressible;
        /// State of the pressure solve.
        FluidPressureSolve = pressure_solve: PressureSolve("1"), Scratch;
        /// Rate of deceleration of a particle by walls and bodies, along the axes: xx, yy, zz.
        FluidFriction = friction: rows("1/s"), Scratch, needs ImplicitViscosity;
        /// The same between the axes: yz, zx, xy.
        FluidFrictionBetween = friction_between: rows("1/s"), Scratch, needs ImplicitViscosity;
        /// Residual of the implicit viscosity.
        FluidViscosityResidual = viscosity_residual: rows("m/s"), Scratch, needs ImplicitViscosity;
        /// Direction of the present iteration of that solve.
        FluidViscosityDirection = viscosity_direction: rows("m/s"), Scratch, needs ImplicitViscosity;
        /// Product of its matrix with that direction.
        FluidViscosityProduct = viscosity_product: rows("m/s"), Scratch, needs ImplicitViscosity;
        /// Change of the velocity by the implicit viscosity so far.
        FluidViscosityChange = viscosity_change: rows("m/s"), Scratch, needs ImplicitViscosity;
        /// State of that solve.
        FluidViscositySolve = viscosity_solve: ViscositySolve("1"), Scratch;
        /// Rotation that fits the velocities of the neighbours of a particle best, or the direction of that solve.
        FluidSpin = spin: rows("rad/s"), Scratch, needs StrainRate;
        /// Extremes over chunks of particles, for the time step.
        FluidExtremes = extremes: Extremes("m/s"), Scratch;
    }
    /// The sponges, one row per lattice node, in the order of the vertex colours.
    nodes node: Nodes {
        /// Position of the node; w: inverse mass \[1/kg\], 0 for a held node.
        NodePosition = position: rows("m"; INVERSE_MASS 3 "1/kg") padded Row(FAR_ROW), State;
        /// Velocity of the node; w: share of the external acceleration that it followed in the last step, 0 to 1, see
        /// `pbd::guess`.
        NodeVelocity = velocity: rows("m/s"; FOLLOWED_SHARE 3 "1"), State;
        /// Velocity that the node would have by the impulse of the pressure alone in the last step. w: length of that step, 0 before
        /// the first.
        NodeDriven = driven: rows("m/s"; STEP 3 "s"), State, needs Divergence;
        /// Volume of sponge that the node stands for, pores included.
        NodeVolume = volume: values("m^3"), Constant;
        /// Index of the node's sponge.
        NodeSponge = sponge: words("1"), Constant;
        /// 0 for nodes of the outer surface, else 1: surface nodes have no suction.
        NodeSuction = suction: values("1"), Constant on host;
        /// Sum of node volumes times W at the node, at rest: the reference of saturation.
        NodeInterior = interior: values("1"), Constant on host;
        /// Body that holds the node, or `u32::MAX`.
        NodeGrip = grip: words("1") padded Word(u32::MAX), Commanded;
        /// Position of a held node in the frame of its body.
        NodeGripOffset = grip_offset: rows("m"), Commanded;
        /// Tets, their colours and the chunks that colours are solved in.
        NodeTopology = topology: Topology("1"), Constant on host;
        /// Neighbours and tets of every node.
        NodeStars = stars: Stars("1"), Constant on host;
        /// Position of the node in the lattice at rest; w: flatness of the surface there, 1 on a face, 0 inside, see
        /// `pbd::pairs`.
        NodeRest = rest: rows("m"; FLATNESS 3 "1"), Constant on host;
        /// Outward normal of the surface of the sponge; w: area that the node stands for \[m^2\], 0 inside and where no
        /// sponge can touch it.
        NodeNormal = normal: rows("1"; AREA 3 "m^2"), Scratch, needs Touch;
        /// For every surface node, the nodes of other sponges or of its own that it may touch in this step.
        NodePairs = pairs: Neighbors("1"), Scratch, needs Touch;
        /// How much of the face of the node other faces cover, 0 to 1.
        NodeCover = cover: values("1"), Scratch, needs Touch;
        /// Contact force of sponges on the node; w: lowest index of another sponge in contact, or of its own.
        NodeTouch = touch: rows("N"; LOWEST_SPONGE 3 "1"), Scratch, needs Touch;
        /// Negative derivative of that force by the position of the node, along the axes: xx, yy, zz. w: highest index of
        /// another sponge in contact, or of its own.
        NodeTouchStiffness = touch_stiffness: rows("N/m"; HIGHEST_SPONGE 3 "1"), Scratch, needs Touch;
        /// The same between the axes: xy, xz, yz.
        NodeTouchBetween = touch_between: rows("N/m"), Scratch, needs Touch;
        /// Position of the node without elastic forces and drag; w: its mass \[kg\], 0 for a held node.
        NodeFree = free: rows("m"; MASS 3 "kg"), Scratch;
        /// Target of the node by inertia and the drag of the fluid; w: the mass of both \[kg\].
        NodeTarget = target: rows("m"; MASS 3 "kg"), Scratch;
        /// Impulse of walls, bodies and grips on the node in this step. w: its mass if it is free to move, else the negative
        /// mass equivalent to the stiffness of what holds it \[kg\].
        NodeReaction = reaction: rows("N s"; MASS 3 "kg"), Scratch;
        /// Predicted position, corrected by the constraints; w: inverse mass \[1/kg\].
        NodePredicted = predicted: rows("m"; INVERSE_MASS 3 "1/kg") padded Row(FAR_ROW), Scratch;
        /// External acceleration, by gravity and the fluid.
        NodeAcceleration = acceleration: rows("m/s^2"), Scratch;
        /// Volume ratio of the sponge around the node \[1\]. The next two are multiplied by it: drag rate, and its derivative by the
        /// relative speed of the water \[1/m\]; w: porosity \[1\].
        NodePores = pores: rows(; VOLUME_RATIO 0 "1", DRAG_RATE 1 "1/s", INERTIAL_DRAG_RATE 2 "1/m", POROSITY 3 "1"), Scratch;
        /// Water-filled pore volume over pore volume.
        NodeSaturation = saturation: values("1"), Kept;
        /// Wetness of the material of the node, 0 to 1; its saturation in this step, at most 1. Share of the receding
        /// capillary pressure in its suction; w: mobility of the water, `k_r / S`. Empty where no property of a sponge depends
        /// on wetness, see `couple::wetting`.
        NodeWetting = wetting: rows(; WETNESS 0 "1", SATURATION 1 "1", RECEDING_SHARE 2 "1", MOBILITY 3 "1"), State, needs Wetting;
        /// Impulse of the drag of the fluid in this step; w: mass of the fluid that moves with the node \[kg\].
        NodeDrag = drag: rows("N s"; MASS 3 "kg"), Scratch;
        /// Moment of that impulse about the node: drag acts at the particles.
        NodeDragMoment = drag_moment: rows("N m s"), Scratch;
        /// Extremes over chunks of nodes, for the time step.
        NodeExtremes = extremes: Extremes("m/s"), Scratch;
    }
    /// The sponge nodes again, as control particles of the fluid, in the order of their cells.
    controls control: Controls {
        /// Row of the node.
        ControlNode = node: words("1") padded Word(u32::MAX), Scratch, needs Fluid;
        /// Position of the node; w: its volume \[m^3\].
        ControlPosition = position: rows("m"; VOLUME 3 "m^3") padded Row(FAR_ROW), Scratch, needs Fluid;
        /// Velocity of the node, filtered by the drag of the fluid; w: number of particles that share it over its mass, see
        /// `couple::control_velocity` \[1/kg\].
        ControlVelocity = velocity: rows("m/s"; DRAG_SHARE 3 "1/kg"), Scratch, needs Fluid;
        /// Velocity of the node before the filter; w: inverse mass \[1/kg\].
        ControlUnfiltered = unfiltered: rows("m/s"; INVERSE_MASS 3 "1/kg"), Scratch, needs Fluid;
        /// Cells over the controls.
        ControlCells = cells: Cells("1"), Scratch on host;
        /// For every control, the particles within the suction radius.
        ControlFluid = fluid: Neighbors("1"), Scratch, needs Fluid;
        /// For every control the corners that it is: four times the row of the particle, and the number of the corner.
        ControlCorners = corners: Neighbors("1"), Scratch, needs Fluid;
        /// For every entry of those lists, node volume times W.
        ControlFluidWeights = fluid_weights: ListValues("1"), Scratch on host;
        /// Expected position of the node at the end of the step; w: volume of its material, without pores \[m^3\].
        ControlSolid = solid: rows("m"; VOLUME 3 "m^3"), Scratch, needs Fluid;
        /// Velocity of the material of the node before the step; w: its volume, without pores \[m^3\].
        ControlMaterial = material: rows("m/s"; VOLUME 3 "m^3"), Scratch, needs Fluid;
        /// Change of the velocity of the node per impulse \[1/kg\], and the part of the impulse that moves water; w: volume of its
        /// material \[m^3\].
        ControlCompliance = compliance: rows(; COMPLIANCE 0 "1/kg", DRAWN 1 "1", VOLUME 3 "m^3"), Scratch, needs Fluid;
        /// Force of the pressure of the present round on the material of the node.
        ControlForce = force: rows("N"), Scratch, needs Fluid;
        /// Impulse of the pressure of the present round on the node, by itself and by the water that drag holds.
        ControlImpulse = impulse: rows("N s"), Scratch, needs Fluid;
        /// Impulse by everything but the pressure that the node is expected to receive in the step.
        ControlExpected = expected: rows("N s"), Scratch, needs Fluid;
        /// Velocity of the node by the pressure of the present round; w: volume of its material \[m^3\].
        ControlSolved = solved: rows("m/s"; VOLUME 3 "m^3"), Scratch, needs Fluid;
        /// Water-filled pore volume over pore volume.
        ControlSaturation = saturation: values("1"), Scratch, needs Fluid;
        /// Control pressure times volume: negative for suction.
        ControlSuction = suction: values("Pa m^3"), Scratch, needs Fluid;
    }
    /// Rigid bodies, one row per body.
    bodies body: BodyStore {
        /// Shapes, poses and velocities.
        BodyStates = states: Bodies("m"), State;
        /// Expected velocity at the end of the step without pressure.
        BodyExpected = expected: rows("m/s"), Scratch, needs Divergence;
        /// Expected angular velocity.
        BodyExpectedSpin = expected_spin: rows("rad/s"), Scratch, needs Divergence;
        /// Impulses of the pressure of the present round of a solve for the divergence.
        BodyPressureWrenches = pressure_wrenches: Wrenches("N s"), Scratch;
        /// Velocity by them.
        BodySolved = solved: rows("m/s"), Scratch, needs Divergence;
        /// Angular velocity by them.
        BodySolvedSpin = solved_spin: rows("rad/s"), Scratch, needs Divergence;
        /// Wrenches of the fluid on the bodies in this step.
        BodyFluidWrenches = fluid_wrenches: Wrenches("N s"), Scratch;
        /// Wrenches of the sponges on the bodies in this step.
        BodyNodeWrenches = node_wrenches: Wrenches("N s"), Scratch;
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
