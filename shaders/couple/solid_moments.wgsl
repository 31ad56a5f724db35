// #include smoothing, drag, solid_mirrors, shares
// Fourth pass of `couple::solid_moments`: sums over the nodes around a particle; `solid_moments.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_controls: array<u32>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_compliance: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> fluid_mobility: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> fluid_moment: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> fluid_renormalisation_between: array<vec4<f32>>;

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
    let near = walls_near(point);
    let mirrors = select(1u, MIRRORS, near != 0u);
    let end = fluid_controls[row];
    var moment = vec4<f32>(0.0);
    var along = vec3<f32>(0.0);
    var between = vec3<f32>(0.0);
    var direct = 0.0;
    var follows = 0.0;
    var interior = 0.0;
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_controls[row + (k + 1u) * rows];
        let there = control_position[other];
        let apart = point - there.xyz;
        let weight = there[CONTROL_POSITION_VOLUME] * params.coupling.value * shape(closeness(params.coupling, dot(apart, apart)));
        interior += weight;
        follows += weight * control_compliance[other][CONTROL_COMPLIANCE_DRAWN];
    }
    for (var mirror = 0u; mirror < mirrors; mirror += 1u) {
        let by = mirror_of(near, mirror);
        for (var k = share.first; k < end && by.is_there; k += SHARES) {
            let other = fluid_controls[row + (k + 1u) * rows];
            let response = control_compliance[other];
            let offset = mirrored(by, control_position[other].xyz) - point;
            let u = closeness(params.solid, dot(offset, offset));
            let push = (response[CONTROL_COMPLIANCE_VOLUME] * params.solid.gradient * (u * u * u)) * offset;
            moment += vec4<f32>(push, response[CONTROL_COMPLIANCE_VOLUME] * params.solid.value * shape(u));
            along += push * offset;
            between += push.yzx * offset.zxy;
            direct += dot(push, push) * response[CONTROL_COMPLIANCE_COMPLIANCE];
        }
    }
    moment = share_sum(lane, moment);
    let first = share_sum(lane, vec4<f32>(along, interior));
    let second = share_sum(lane, vec4<f32>(between, follows));
    direct = share_sum(lane, vec4<f32>(direct, 0.0, 0.0, 0.0)).x;
    if (!share.writes) {
        return;
    }
    let own = fluid_mobility[row][FLUID_MOBILITY_MOBILITY];
    let with_nodes = own + (1.0 - own) * (second.w * weight_inside(first.w));
    fluid_mobility[row] = vec4<f32>(own, with_nodes, direct * (params.particle_mass / 3.0), 0.0);
    fluid_moment[row] = moment;
    fluid_renormalisation[row] = vec4<f32>(first.xyz, 0.0);
    fluid_renormalisation_between[row] = vec4<f32>(second.xyz, 0.0);
}
