//! Quantities of particles and nodes, row by row: borrowed or copied.

use std::{ffi::c_void, mem::MaybeUninit, slice};

use sorb::World as Library;

use crate::{
    failure::{Failure, Status, entry},
    memory::{give, given, versioned, write_sized},
    world::World,
};

/// A quantity. Vectors are x, y, z. Rows of particles change their order from step to step, and
/// `SORB_COLUMN_PARTICLE_IDS` identifies them; rows of nodes keep theirs.
#[derive(Clone, Copy, Debug)]
#[repr(u32)]
pub enum Column {
    /// Positions of the particles (m): 3 floats.
    ParticlePositions = 0,
    /// Velocities of the particles (m/s): 3 floats.
    ParticleVelocities = 1,
    /// Identities of the particles: 1 unsigned integer.
    ParticleIds = 2,
    /// Pressures of the particles in the last step (Pa): 1 float. Computed: to copy, not to view.
    ParticlePressures = 3,
    /// Densities of the particles by summation (kg/m^3): 1 float. Computed: to copy, not to view.
    ParticleDensities = 4,
    /// Positions of the nodes of all sponges (m): 3 floats.
    NodePositions = 5,
    /// Velocities of the nodes (m/s): 3 floats.
    NodeVelocities = 6,
    /// Saturation of the nodes, about 0 to 1: 1 float. No rows without fluid.
    NodeSaturations = 7,
    /// Masses of the dry nodes (kg): 1 float. Computed: to copy, not to view.
    NodeMasses = 8,
    /// Number of the sponge of every node: 1 unsigned integer.
    NodeSponges = 9,
    /// Outer surface of the sponges: 3 unsigned integers, the nodes of a triangle, counter-clockwise as seen from outside.
    Triangles = 10,
}

/// Type of the elements of a column.
#[derive(Clone, Copy, Debug)]
#[repr(u32)]
pub enum ElementType {
    /// A float of 32 bits.
    F32 = 0,
    /// An unsigned integer of 32 bits.
    U32 = 1,
}

/// A column in the memory of a world, to read only.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct View {
    /// `sizeof(sorb_view)`.
    pub size: usize,
    /// Its first element. Not NULL, also without rows.
    pub data: *const c_void,
    /// Number of rows.
    pub rows: usize,
    /// Bytes from a row to the next.
    pub stride: usize,
    /// Elements of a row that mean something; what follows them in its stride is internal.
    pub components: u32,
    /// Their type: a `sorb_element_type`.
    pub element_type: u32,
}

versioned! { View "sorb_view", }

/// Values of a column.
enum Values<'a> {
    Vectors(&'a [[f32; 4]]),
    Floats(&'a [f32]),
    Integers(&'a [u32]),
    Triples(&'a [[u32; 3]]),
    Computed(Vec<f32>),
}

fn values(world: &Library, column: u32) -> Result<Values<'_>, Failure> {
    const LAST: u32 = Column::Triangles as u32;
    Ok(match column {
        column if column == Column::ParticlePositions as u32 => Values::Vectors(world.particle_positions()),
        column if column == Column::ParticleVelocities as u32 => Values::Vectors(world.particle_velocities()),
        column if column == Column::ParticleIds as u32 => Values::Integers(world.particle_ids()),
        column if column == Column::ParticlePressures as u32 => Values::Computed(world.particle_pressures()),
        column if column == Column::ParticleDensities as u32 => Values::Computed(world.particle_densities()),
        column if column == Column::NodePositions as u32 => Values::Vectors(world.node_positions()),
        column if column == Column::NodeVelocities as u32 => Values::Vectors(world.node_velocities()),
        column if column == Column::NodeSaturations as u32 => Values::Floats(world.node_saturations()),
        column if column == Column::NodeMasses as u32 => Values::Computed(world.node_masses()),
        column if column == Column::NodeSponges as u32 => Values::Integers(&world.lattice().node_sponge),
        LAST => Values::Triples(&world.lattice().triangles),
        other => {
            let message = format!("column {other} is out of range 0 to {LAST}");
            return Err(Failure::new(Status::NoSuchThing, message));
        }
    })
}

/// Borrows a column without a copy. The pointer is valid until the next call that changes or frees the world: steps, frames, commands,
/// `sorb_world_resume`, `sorb_world_rollback` and `sorb_world_free`. Columns that are computed are refused: copy them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_view(world: Option<&World>, column: u32, view: *mut View) -> Status {
    entry(|| {
        let values = values(given(world, "world")?.read()?, column)?;
        let (float, integer) = (ElementType::F32 as u32, ElementType::U32 as u32);
        let (data, rows, stride, components, element_type): (*const c_void, _, _, _, _) = match values {
            Values::Vectors(rows) => (rows.as_ptr().cast(), rows.len(), 16, 3, float),
            Values::Floats(rows) => (rows.as_ptr().cast(), rows.len(), 4, 1, float),
            Values::Integers(rows) => (rows.as_ptr().cast(), rows.len(), 4, 1, integer),
            Values::Triples(rows) => (rows.as_ptr().cast(), rows.len(), 12, 3, integer),
            Values::Computed(_) => {
                let message = format!("column {column} is computed: copy it by sorb_world_copy");
                return Err(Failure::new(Status::NoSuchThing, message));
            }
        };
        let own = View { size: 0, data, rows, stride, components, element_type };
        // SAFETY: the promise of the caller.
        unsafe { write_sized(view, &own) }
    })
}

/// Copies a column, packed: 12 bytes for three elements, 4 for one. `length` is the number of its bytes; a NULL buffer asks for it alone.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_copy(
    world: Option<&World>,
    column: u32,
    buffer: *mut c_void,
    capacity: usize,
    length: Option<&mut MaybeUninit<usize>>,
) -> Status {
    entry(|| {
        let values = values(given(world, "world")?.read()?, column)?;
        let packed: Vec<[f32; 3]>;
        let bytes = match &values {
            Values::Vectors(rows) => {
                packed = rows.iter().map(|[x, y, z, _]| [*x, *y, *z]).collect();
                bytes_of(&packed)
            }
            Values::Floats(rows) => bytes_of(rows),
            Values::Integers(rows) => bytes_of(rows),
            Values::Triples(rows) => bytes_of(rows),
            Values::Computed(rows) => bytes_of(rows),
        };
        // SAFETY: the promise of the caller.
        unsafe { give(bytes, (buffer.cast(), capacity), length, "buffer") }
    })
}

/// Numbers that have no padding.
trait Plain {}
impl Plain for f32 {}
impl Plain for u32 {}
impl Plain for [f32; 3] {}
impl Plain for [u32; 3] {}

fn bytes_of<T: Plain>(rows: &[T]) -> &[u8] {
    // SAFETY: all bytes of such numbers are initialised, and bytes have no alignment.
    unsafe { slice::from_raw_parts(rows.as_ptr().cast(), size_of_val(rows)) }
}
