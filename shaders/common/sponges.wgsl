// The sponges, as `SpongeParams`.
struct Sponge {
    edge: f32,
    stretch_modulus: f32,
    shear_modulus: f32,
    volume_modulus: f32,
    damping_time: f32,
    iterations: f32,
    friction: f32,
    porosity: f32,
    drag_rate: f32,
    entry_pressure: f32,
    saturation_gain: f32,
    reaction: f32,
    solver: u32,
    mu: f32,
    lambda: f32,
    damping: f32,
    inertial_drag: f32,
    // 1 where porosity and permeability fall as the sponge is compressed.
    pores_close: u32,
    // What the sponge does as it becomes wet, as `WettingParams`.
    exponent: u32,
    softening: f32,
    swelling: f32,
    wetting_time: f32,
    receding: f32,
    // 1 for sponges that may touch themselves.
    self_contact: u32,
}

// Solvers.
const SBD: u32 = 0u;
const VBD: u32 = 1u;
const XPBD_NEO_HOOKEAN: u32 = 2u;
// Beside the solver of a sponge that is asleep: none of them moves it. Nothing that is awake is within its reach.
const ASLEEP: u32 = 4u;

fn is_asleep(sponge: Sponge) -> bool {
    return (sponge.solver & ASLEEP) != 0u;
}

struct Sponges {
    all: array<Sponge, 256>,
}
