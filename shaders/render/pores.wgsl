// #include numbers, scene, surfels
// Which particles are free water, and which are in the pores of a sponge.

@group(0) @binding(3) var<storage, read> positions: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> interior: array<f32>;
@group(0) @binding(5) var<storage, read_write> free: array<f32>;
// Places in the container, with 0 behind them, or -1 where there is no water: a position that is not finite, or a lost particle.
@group(0) @binding(6) var<storage, read_write> points: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let row = row_of(group, groups, lane);
    if (row >= scene.particles) {
        return;
    }
    let place = positions[row].xyz;
    let away = abs(place - scene.middle);
    if (!all_finite(place) || most(away) >= scene.lost) {
        free[row] = 0.0;
        points[row] = vec4(0.0, 0.0, 0.0, -1.0);
        return;
    }
    var inside = place;
    if (scene.has_container != 0u) {
        inside = clamp(place, scene.low, scene.high);
    }
    points[row] = vec4(inside, 0.0);
    var held = 0.0;
    if (scene.has_interior != 0u) {
        held = interior[row];
    }
    var share = 1.0 - smooth_between(PORES_HELD.x, PORES_HELD.y, held);
    if (share > 0.0 && held >= PORES_APART && scene.surfels != 0u) {
        let distance = surfel_distance(place) / scene.spacing;
        share *= smooth_between(PORES_OUTSIDE.x, PORES_OUTSIDE.y, distance);
    }
    free[row] = share;
}
