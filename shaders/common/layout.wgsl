// What all twins share: the layout of the uniforms, and which row a thread has.

// One smoothing function: support radius H, 1/H, and the factors of `smoothing.rs`.
struct Smoothing {
    radius: f32,
    inverse_radius: f32,
    value: f32,
    gradient: f32,
    laplacian: f32,
    viscosity: f32,
    unused_0: f32,
    unused_1: f32,
}

struct Params {
    gravity: vec4<f32>,
    // Corners of the container, out of reach along axes without walls; w of the first is 1 if there is one.
    wall_low: vec4<f32>,
    wall_high: vec4<f32>,
    fluid_rows: u32,
    node_rows: u32,
    body_rows: u32,
    tet_rows: u32,
    spacing: f32,
    rest_density: f32,
    particle_mass: f32,
    sound_speed: f32,
    viscosity: f32,
    surface_tension: f32,
    repulsion_range: f32,
    repulsion_stiffness: f32,
    repulsion_damping: f32,
    // 1 for Tait's equation of state, 0 for the linear one.
    tait: u32,
    courant: f32,
    // Smallest lattice constant of the sponges.
    edge: f32,
    minimum_step: f32,
    constant_step: f32,
    constant_bound: u32,
    // Entries that fit a list: fluid to fluid, fluid to controls, controls to fluid.
    neighbor_capacity: u32,
    control_capacity: u32,
    control_fluid_capacity: u32,
    central_viscosity: f32,
    // Compression that is allowed for the roughness of the pressure, over that roughness.
    roughness: f32,
    smoothing: Smoothing,
    coupling: Smoothing,
    // Of the volume of the sponges' material.
    solid: Smoothing,
    // The solve for the pressure, as `Incompressible`.
    solve_tolerance: f32,
    solve_rounds: u32,
    lattice_diagonal: f32,
    correction_speed: f32,
    boundary_range: f32,
    boundary_share: f32,
    // 1 where pressure is solved for.
    incompressible: u32,
    // Step over the time in which pressure moves a particle by a spacing.
    pressure_courant: f32,
    // The energy of the surface, as `Cohesion`.
    cohesion: Smoothing,
    cohesion_stiffness: f32,
    cohesion_volume: f32,
    cohesion_range: f32,
    cohesion_share: f32,
    // How far the neighbours in the lists of particles may be.
    list_radius: f32,
    wall_viscosity: f32,
    // 1 where the fluid does not slide along the walls of the container.
    no_slip: u32,
    // 1 where a property of a sponge depends on how wet it is.
    has_wetting: u32,
    // The solve for the implicit viscosity, as `ImplicitViscosity`.
    implicit_viscosity: f32,
    implicit_central_viscosity: f32,
    viscosity_tolerance: f32,
    viscosity_rounds: u32,
    // Where coordinates are taken from where their size would cost digits.
    middle: vec4<f32>,
    // The box that repeats.
    period_low: vec4<f32>,
    period_high: vec4<f32>,
    // Its length along the axes on which it repeats, 0 along the others; w: 1 if there is such an axis.
    periods: vec4<f32>,
    // Half of the periods; along the other axes farther than any two points are apart.
    half_periods: vec4<f32>,
    // How far apart nodes that touch can be; 0 where nothing can.
    pair_radius: f32,
    // 1 where there is fluid that is not asleep.
    has_moving_fluid: u32,
    unused_0: u32,
    unused_1: u32,
}

// Time on the device. Everything that a step needs to know, and what the host wants to know of the steps of a batch.
struct Clock {
    step: f32,
    inverse_step: f32,
    // 0: nothing is to be done; every kernel leaves at once.
    running: u32,
    // Why nothing is to be done: 0 for the end of the time that was asked for, else see `clock.wgsl`.
    status: u32,
    // Time left of what was asked for.
    left: f32,
    fluid_speed: f32,
    fluid_acceleration: f32,
    node_speed: f32,
    steps: u32,
    bound: u32,
    shortest: f32,
    maximum_speed: f32,
    // A row that is not finite, plus one.
    failed_row: u32,
    // Longest list: fluid to fluid, fluid to controls, controls to fluid.
    longest_0: u32,
    longest_1: u32,
    longest_2: u32,
    last_step: f32,
    last_bound: u32,
    // The step that stability asks for, where it is too small.
    needed: f32,
    // 1: the host gave the step, and there is one.
    given: u32,
    // How many steps every bound limited.
    bounds_0: vec4<u32>,
    bounds_1: vec4<u32>,
    bounds_2: vec4<u32>,
    // Rounds of the present repetition so far, see `rounds.wgsl`.
    rounds: u32,
    // 1: it has converged; what is left of its rounds leaves at once.
    is_converged: u32,
    // The repetition, counted from 1, that needs more rounds than were handed in.
    unfinished: u32,
    // Of all steps since the time was set.
    all_rounds: u32,
    // Most rounds of a step in this batch, of each repetition.
    most_rounds: vec4<u32>,
    // Root of the mean square of the pressure over rest density in the last step, where it is solved for.
    fluid_pressure: f32,
    // Largest speed of a body's surface.
    body_speed: f32,
    // Longest list of nodes that a node may touch.
    longest_3: u32,
    unused_1: u32,
}

// Threads of a group, for passes whose threads have nothing to do with each other: with few rows, small groups keep more
// of the device busy.
override GROUP: u32 = 256u;

// The row of a thread; groups beyond the limit of one dimension continue in the second.
fn row_of(group: vec3<u32>, groups: vec3<u32>, lane: u32) -> u32 {
    return (group.y * groups.x + group.x) * GROUP + lane;
}

fn group_of(group: vec3<u32>, groups: vec3<u32>) -> u32 {
    return group.y * groups.x + group.x;
}

// By its bits: compilers may assume that no number is infinite or not a number.
fn is_finite(value: f32) -> bool {
    return (bitcast<u32>(value) & 0x7f800000u) != 0x7f800000u;
}
