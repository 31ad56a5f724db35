// First pass of `tets::corners`: the control row of every node, and lists without entries.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> control_node: array<u32>;
@group(0) @binding(3) var<storage, read_write> node_control: array<u32>;
@group(0) @binding(4) var<storage, read_write> corner_counts: array<u32>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= params.node_rows) {
        return;
    }
    node_control[control_node[row]] = row;
    corner_counts[row] = 0u;
}
