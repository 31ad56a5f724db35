// #include smoothing, images, sum_of_shapes, body, surface, cohesion_share
// Deficit of neighbours of particles near the surface of the fluid.
//
//     e_i = max(0, 1.03 - s_i),   s_i = (0.05 + sum_j V W_ij) / phi_i,   phi_i = prod_k (1 - lambda_ik)
//     w_i = e_i (1 - 2.5 e_i), and 0.01 beyond where it has fallen to that

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(4) var<storage, read> body_states: array<Body>;
@group(0) @binding(5) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> fluid_deficit: array<f32>;
@group(0) @binding(7) var<storage, read_write> fluid_adhesion: array<f32>;

fn share_of_all(point: vec3<f32>) -> f32 {
    var share = cohesion_share_of_walls(point).w;
    for (var index = 0u; index < params.body_rows; index += 1u) {
        share = cohesion_share_of_both(share, cohesion_share_of_body(body_states[index], point).w);
    }
    return share;
}

fn weight(lacks: f32) -> f32 {
    let falling = lacks * (1.0 - DEFICIT_FALL * lacks);
    return select(falling, max(falling, MINIMUM_DEFICIT_WEIGHT), lacks > 0.5 / DEFICIT_FALL);
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= params.fluid_rows) {
        return;
    }
    let point = fluid_position[row].xyz;
    let there = sum_of_shapes(params.cohesion, row) * (params.cohesion.value * params.cohesion_volume);
    let open = 1.0 - share_of_all(point);
    let filled = (there + (NOISE_SHARE + WALL_NOISE_SHARE)) / open;
    let lacks = weight(max((1.0 + WALL_NOISE_SHARE) - filled, 0.0));
    fluid_deficit[row] = lacks / open;
    fluid_adhesion[row] = lacks * filled;
}
