fn is_asleep(sponge: Sponge) -> bool {
    return (sponge.solver & ASLEEP) != 0u;
}

struct Sponges {
    all: array<Sponge, SPONGES>,
}
