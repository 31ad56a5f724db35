// #include sponges
// How wet the material of every node is, and the suction of water that recedes; `wetting.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> control_node: array<u32>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> node_traits: array<NodeTraits>;
@group(0) @binding(6) var<storage, read_write> control_saturation: array<f32>;
@group(0) @binding(7) var<storage, read_write> control_suction: array<f32>;
@group(0) @binding(8) var<storage, read_write> node_saturation: array<f32>;
@group(0) @binding(9) var<storage, read_write> node_wetting: array<vec4<f32>>;
@group(0) @binding(10) var<storage, read_write> node_stars: array<u32>;

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
    let node = control_node[row];
    let traits = node_traits[node];
    let sponge = sponges.all[traits.sponge];
    let before = node_wetting[node];
    var saturation = control_saturation[row] * max(traits.interior, 1.0);
    if (sponge.wetting.swelling > 0.0) {
        let size = 1.0 + sponge.wetting.swelling * before[NODE_WETTING_WETNESS];
        let porosity = 1.0 - (1.0 - sponge.porosity) / (size * size * size);
        saturation *= sponge.porosity / porosity;
    }
    let filled = min(saturation, 1.0);
    var mobility = 1.0;
    for (var k = 1u; k < sponge.wetting.exponent; k += 1u) {
        mobility *= filled;
    }
    let drained = before[NODE_WETTING_SATURATION] - filled;
    let receding = clamp(before[NODE_WETTING_RECEDING_SHARE] + drained * (1.0 / SCANNING_BAND), 0.0, 1.0);
    let pressure = control_pressure(sponge, saturation, receding);
    let wetness = (sponge.wetting.time * before[NODE_WETTING_WETNESS] + clock.step * filled) / (sponge.wetting.time + clock.step);
    control_saturation[row] = saturation;
    control_suction[row] = pressure * traits.suction * control_position[row][CONTROL_POSITION_VOLUME];
    node_saturation[node] = saturation;
    node_wetting[node] = vec4<f32>(wetness, filled, receding, max(mobility, MINIMUM_MOBILITY));
    node_stars[node * STAR_WORDS + STAR_WETNESS] = bitcast<u32>(wetness);
}
