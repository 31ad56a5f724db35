//! Columns of a world as bytes in the memory of the module.

use sorb::World;

/// What the page can read, by its number.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Column {
    /// Positions of the particles (m): x, y, z, and a fourth number that is internal.
    ParticlePositions,
    /// Velocities of the particles (m/s), likewise.
    ParticleVelocities,
    /// Share of each particle that sponges hold (1); empty without sponges.
    ParticleInteriors,
    /// Positions of the nodes (m): x, y, z and the inverse mass (1/kg).
    NodePositions,
    /// Positions of the nodes at rest (m), likewise.
    NodeRests,
    /// Saturation of the nodes (1).
    NodeSaturations,
    /// Outer surface of the sponges: three nodes a triangle, as unsigned integers.
    Triangles,
    /// Poses of the bodies: centre of mass (m), inverse mass (1/kg), rotation as a quaternion x, y, z, w.
    Bodies,
}

const COLUMNS: [Column; 8] = [
    Column::ParticlePositions,
    Column::ParticleVelocities,
    Column::ParticleInteriors,
    Column::NodePositions,
    Column::NodeRests,
    Column::NodeSaturations,
    Column::Triangles,
    Column::Bodies,
];

/// Makes a column that the world does not have as such.
pub(crate) fn make(world: &World, number: u32, made: &mut Vec<f32>) {
    if COLUMNS.get(number as usize) != Some(&Column::Bodies) {
        return;
    }
    made.clear();
    for body in world.bodies() {
        made.extend(body.state.position.extend(body.inverse_mass).to_array());
        made.extend(body.state.rotation.to_array());
    }
}

/// The bytes of a column, made or not.
pub(crate) fn bytes<'a>(world: &'a World, number: u32, made: &'a [f32]) -> &'a [u8] {
    let Some(column) = COLUMNS.get(number as usize) else { return &[] };
    match column {
        Column::ParticlePositions => of(world.particle_positions()),
        Column::ParticleVelocities => of(world.particle_velocities()),
        Column::ParticleInteriors => of(world.particle_interiors()),
        Column::NodePositions => of(world.node_positions()),
        Column::NodeRests => of(&world.lattice().position),
        Column::NodeSaturations => of(world.node_saturations()),
        Column::Triangles => of(&world.lattice().triangles),
        Column::Bodies => of(made),
    }
}

fn of<T: Word>(values: &[T]) -> &[u8] {
    // SAFETY: floats and unsigned integers, alone and in arrays, have no padding, and bytes no alignment.
    unsafe { std::slice::from_raw_parts(values.as_ptr().cast(), size_of_val(values)) }
}

/// What is words of 32 bits and nothing else.
trait Word {}
impl Word for f32 {}
impl Word for [f32; 4] {}
impl Word for [u32; 3] {}
