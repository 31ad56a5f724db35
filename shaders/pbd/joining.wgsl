// Connected components of sponges in contact: the transitive closure of the bits of `touching.wgsl`.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<storage, read_write> sponge_ranges: array<vec2<u32>>;

@compute @workgroup_size(1)
fn main() {
    if (clock.running == 0u) {
        return;
    }
    let count = min(arrayLength(&sponge_ranges) / RANGES, SPONGES);
    // Through every sponge once, as Warshall has it.
    for (var through = 0u; through < count; through += 1u) {
        for (var own = 0u; own < count; own += 1u) {
            let pair = sponge_ranges[own * RANGES + VERTEX_COLORS + through / 64u];
            let word = select(pair.x, pair.y, (through / 32u) % 2u == 1u);
            if (((word >> (through % 32u)) & 1u) != 0u) {
                for (var k = VERTEX_COLORS; k < RANGES; k += 1u) {
                    sponge_ranges[own * RANGES + k] = sponge_ranges[own * RANGES + k] | sponge_ranges[through * RANGES + k];
                }
            }
        }
    }
}
