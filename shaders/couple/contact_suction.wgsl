// #include sponges
// Suction of faces of sponges that other faces cover; `contact_suction.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> control_node: array<u32>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_saturation: array<f32>;
@group(0) @binding(6) var<storage, read> node_traits: array<NodeTraits>;
@group(0) @binding(7) var<storage, read> node_wetting: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> node_cover: array<f32>;
@group(0) @binding(9) var<storage, read_write> control_suction: array<f32>;

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= params.node_rows) {
        return;
    }
    let node = control_node[row];
    let cover = node_cover[node];
    if (cover <= 0.0) {
        return;
    }
    var receding = 0.0;
    if (params.has_wetting != 0u) {
        receding = node_wetting[node][NODE_WETTING_RECEDING_SHARE];
    }
    let pressure = control_pressure(sponges.all[node_traits[node].sponge], control_saturation[row], receding);
    let suction = pressure * cover * control_position[row][CONTROL_POSITION_VOLUME];
    control_suction[row] = min(control_suction[row], suction);
}
