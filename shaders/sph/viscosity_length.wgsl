// #include sums
// After the product of a round of a solve for the viscosity: how far to go along the direction, and its share in the next.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<storage, read> viscosity_sums: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> fluid_viscosity_solve: ViscositySolve;

@compute @workgroup_size(GROUP_THREADS)
fn main(@builtin(local_invocation_index) lane: u32) {
    if (clock.running == 0u) {
        return;
    }
    // Sums of missing groups stay zero.
    var own = vec4<f32>(0.0);
    for (var k = lane; k < arrayLength(&viscosity_sums); k += GROUP_THREADS) {
        own += viscosity_sums[k];
    }
    let sums = group_row(lane, own, false);
    if (lane != 0u) {
        return;
    }
    fluid_viscosity_solve.length = 0.0;
    fluid_viscosity_solve.share = 0.0;
    // Without motion there is no direction.
    if (sums.x > 0.0) {
        let length = sums.y / sums.x;
        fluid_viscosity_solve.length = length;
        fluid_viscosity_solve.share = (length * sums.w - sums.z) / sums.x;
    }
}
