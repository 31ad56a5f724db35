// #include sponges, grid
// Nodes as control particles: in the order of their cells, those of one cell in the order of the nodes.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> control_grid: Grid;
@group(0) @binding(2) var<storage, read> control_grouped: array<u32>;
@group(0) @binding(3) var<storage, read> control_starts: array<u32>;
@group(0) @binding(4) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> node_volume: array<f32>;
@group(0) @binding(6) var<storage, read_write> control_position: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> control_node: array<u32>;
@group(0) @binding(8) var<uniform> sponges: Sponges;
@group(0) @binding(9) var<storage, read> node_sponge: array<u32>;
@group(0) @binding(10) var<storage, read> node_wetting: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let slot = row_of(group, groups, lane);
    if (clock.running == 0u || slot >= control_grid.rows) {
        return;
    }
    let node = control_grouped[slot];
    let point = node_position[node].xyz;
    let cell = cell_of(control_grid, point);
    let begin = control_starts[cell];
    let end = control_starts[cell + 1u];
    var place = begin;
    for (var other = begin; other < end; other += 1u) {
        if (control_grouped[other] < node) {
            place += 1u;
        }
    }
    let swelling = sponges.all[node_sponge[node]].wetting.swelling;
    var volume = node_volume[node];
    if (swelling > 0.0) {
        let size = 1.0 + swelling * node_wetting[node][NODE_WETTING_WETNESS];
        volume *= size * size * size;
    }
    if (is_asleep(sponges.all[node_sponge[node]])) {
        volume = 0.0;
    }
    control_position[place] = vec4<f32>(point, volume);
    control_node[place] = node;
}
