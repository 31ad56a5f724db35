// #include smoothing, images, image, damping, shares, closing
// Damping of velocities that differ from particle to particle; `damping.rs` has the formula.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(4) var<storage, read> values: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> image_position: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> fluid_near_images: array<u32>;
@group(0) @binding(7) var<storage, read> fluid_image_vectors: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> fluid_pressure_solve: Solve;
@group(0) @binding(9) var<storage, read_write> fluid_acceleration: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let share = shared_row(group, groups, lane, params.fluid_rows);
    let all = closing_sum(lane, share);
    if (share.writes) {
        let row = share.row;
        let before = fluid_acceleration[row];
        fluid_acceleration[row] = with_vector(before, before.xyz - all * damping_rate());
    }
}
