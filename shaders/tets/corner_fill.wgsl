// Fifth pass of `tets::corners`: entries of the lists, in an order that depends on that of threads.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_corners: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read_write> corner_counts: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> corner_places: array<u32>;

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
    let controls = fluid_corners[row];
    if (controls.x == controls.y) {
        return;
    }
    for (var corner = 0u; corner < TET_CORNERS; corner += 1u) {
        let place = atomicAdd(&corner_counts[controls[corner]], 1u);
        corner_places[place] = TET_CORNERS * row + corner;
    }
}
