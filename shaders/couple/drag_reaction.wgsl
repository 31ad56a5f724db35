// #include smoothing, control_group
// Drag impulses on the nodes, and their moments; `drag_reaction.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_drag: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_node: array<u32>;
@group(0) @binding(6) var<storage, read> control_fluid: array<u32>;
@group(0) @binding(7) var<storage, read_write> node_drag: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> node_drag_moment: array<vec4<f32>>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let row = control_row(group, groups, lane);
    let is_row = row < params.node_rows;
    let own = control_position[min(row, params.node_rows - 1u)];
    let scale = own.w * params.coupling.value;
    let first = row * (params.control_fluid_capacity + 1u);
    var end = 0u;
    if (is_row) {
        end = control_fluid[first];
    }
    var part = vec4<f32>(0.0);
    var turning = vec3<f32>(0.0);
    for (var k = lane & 31u; k < end; k += 32u) {
        let other = control_fluid[first + 1u + k];
        let apart = own.xyz - fluid_position[other].xyz;
        let weight = scale * shape(closeness(params.coupling, dot(apart, apart)));
        let impulse = weight * fluid_drag[other];
        part += impulse;
        turning -= cross(apart, impulse.xyz);
    }
    let sum = control_sum(lane, part);
    // The memory of the sum is used again.
    workgroupBarrier();
    let moment = control_sum(lane, vec4<f32>(turning, 0.0));
    if (!is_row || (lane & 31u) != 0u) {
        return;
    }
    let node = control_node[row];
    node_drag[node] = sum;
    node_drag_moment[node] = moment;
}
