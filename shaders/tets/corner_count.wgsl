// Third pass of `tets::corners`: control rows instead of nodes, and how many corners every control is.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> node_control: array<u32>;
@group(0) @binding(3) var<storage, read_write> fluid_corners: array<vec4<u32>>;
@group(0) @binding(4) var<storage, read_write> corner_counts: array<atomic<u32>>;

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
    let nodes = fluid_corners[row];
    if (nodes.x == nodes.y) {
        return;
    }
    var controls = vec4<u32>(0u);
    for (var corner = 0u; corner < TET_CORNERS; corner += 1u) {
        let control = node_control[nodes[corner]];
        controls[corner] = control;
        atomicAdd(&corner_counts[control], 1u);
    }
    fluid_corners[row] = controls;
}
