// #include sums
// Before the first round of a solve for the divergence: tolerance, scale of the target and speed, as in `pressure_solve.rs`.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> solve_sums: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> fluid_pressure_solve: Solve;

@compute @workgroup_size(GROUP_THREADS)
fn main(@builtin(local_invocation_index) lane: u32) {
    if (clock.running == 0u) {
        return;
    }
    // Sums of missing groups stay zero.
    let groups = arrayLength(&solve_sums) / SOLVE_SUM_ROWS;
    var own = vec4<f32>(0.0);
    for (var k = lane; k < groups; k += GROUP_THREADS) {
        own += solve_sums[k * SOLVE_SUM_ROWS];
    }
    let means = group_row(lane, own, false) / f32(max(params.fluid_rows, 1u));
    if (lane != 0u) {
        return;
    }
    let gravity = sqrt(dot(params.gravity, params.gravity));
    let speed = sqrt(means.x);
    let pressure = PEAK_PRESSURE * sqrt(means.y);
    let wave = sqrt(pressure);
    var layers = MINIMUM_LAYERS;
    if (gravity > 0.0) {
        layers = max(pressure / (gravity * params.spacing), MINIMUM_LAYERS);
    }
    let displacement = speed * clock.step / params.spacing;
    let wanted = DIVERGENCE_PER_DISPLACEMENT * displacement / layers;
    let tolerance = max(min(wanted, params.solve_tolerance), MINIMUM_DIVERGENCE);
    var target_scale = 1.0;
    if (wave > 0.0) {
        let most = MAXIMUM_RISE * gravity * clock.step / wave;
        if (abs(means.z) > most && most > 0.0) {
            target_scale = most / abs(means.z);
        }
    }
    // A full vessel.
    if (means.w == 0.0) {
        target_scale = 0.0;
    }
    let fastest = max(wave, PEAK_PRESSURE * speed);
    fluid_pressure_solve = Solve(0.0, tolerance, 0.0, 0.0, 0u, 0u, target_scale, fastest);
}
