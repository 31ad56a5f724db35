fn is_asleep(sponge: Sponge) -> bool {
    return (sponge.solver & ASLEEP) != 0u;
}

struct Sponges {
    all: array<Sponge, SPONGES>,
}

// Control pressure of a node at a saturation, below zero; `receding` is 0 where water advances and 1 where it recedes.
fn control_pressure(sponge: Sponge, saturation: f32, receding: f32) -> f32 {
    let dry = max(1.0 - saturation, 0.0);
    return -(sponge.entry_pressure + receding * sponge.wetting.receding) * (1.0 + sponge.saturation_gain * dry);
}
