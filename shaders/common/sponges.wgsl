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
}

struct Sponges {
    all: array<Sponge, 256>,
}
