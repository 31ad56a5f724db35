// #include smoothing, shares
// Interior value of every particle in a sponge, and the drag rates there.
//
//     iota_i = sum_a J_a V_a W_ia,    chi_i = sum_a V_a W_ia
//     beta_i = sum_a J_a V_a W_ia beta_a,    gamma_i = sum_a J_a V_a W_ia gamma_a
//
// and the compliance of the material, see `solid_yield.rs`.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_node: array<u32>;
@group(0) @binding(5) var<storage, read> node_pores: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> fluid_controls: array<u32>;
@group(0) @binding(7) var<storage, read_write> fluid_interior: array<f32>;
@group(0) @binding(8) var<storage, read_write> fluid_drag_rate: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read> node_wetting: array<vec4<f32>>;

fn following(porosity: f32) -> f32 {
    return sqrt(min(FOLLOWING * (1.0 - porosity) / porosity, MAXIMUM_FOLLOWING));
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let rows = params.fluid_rows;
    let share = shared_row(group, groups, lane, rows);
    let row = share.row;
    let point = fluid_position[row].xyz;
    let end = fluid_controls[row];
    var sum = 0.0;
    var rate = vec2<f32>(0.0);
    var mobile = 0.0;
    var follows = 0.0;
    var inside = 0.0;
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_controls[row + (k + 1u) * rows];
        let there = control_position[other];
        let apart = point - there.xyz;
        let weight = there[CONTROL_POSITION_VOLUME] * params.coupling.value * shape(closeness(params.coupling, dot(apart, apart)));
        sum += weight;
        let node = control_node[other];
        let pores = node_pores[node];
        rate += weight * pores.yz;
        inside += weight * pores[NODE_PORES_VOLUME_RATIO];
        follows += weight * pores[NODE_PORES_VOLUME_RATIO] * following(pores[NODE_PORES_POROSITY]);
        if (params.has_wetting != 0u) {
            mobile += weight * node_wetting[node][NODE_WETTING_MOBILITY];
        }
    }
    let all = share_sum(lane, vec4<f32>(rate, sum, mobile));
    let others = share_sum(lane, vec4<f32>(follows, inside, 0.0, 0.0));
    rate = all.xy;
    sum = all.z;
    mobile = all.w;
    if (!share.writes) {
        return;
    }
    if (mobile > 0.0) {
        let slower = sum / mobile;
        rate *= vec2<f32>(slower, sqrt(slower));
    }
    fluid_interior[row] = others.y;
    fluid_drag_rate[row] = vec4<f32>(rate, others.x, sum);
}
