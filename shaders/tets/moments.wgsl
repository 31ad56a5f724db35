// #include smoothing, solid_mirrors, shares
// The material of sponges in the neighbourhoods of the particles; `moments.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_controls: array<u32>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_material: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> fluid_moment: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_renormalisation_between: array<vec4<f32>>;

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
    for (var mirror = 0u; mirror < mirrors; mirror += 1u) {
        let by = mirror_of(near, mirror);
        for (var k = share.first; k < end && by.is_there; k += SHARES) {
            let other = fluid_controls[row + (k + 1u) * rows];
            let volume = control_material[other][CONTROL_MATERIAL_VOLUME];
            let offset = mirrored(by, control_position[other].xyz) - point;
            let u = closeness(params.solid, dot(offset, offset));
            let push = (volume * params.solid.gradient * (u * u * u)) * offset;
            moment += vec4<f32>(push, volume * params.solid.value * shape(u));
            along += push * offset;
            between += push.yzx * offset.zxy;
        }
    }
    moment = share_sum(lane, moment);
    along = share_sum3(lane, along);
    between = share_sum3(lane, between);
    if (share.writes) {
        fluid_moment[row] = moment;
        fluid_renormalisation[row] = vec4<f32>(along, 0.0);
        fluid_renormalisation_between[row] = vec4<f32>(between, 0.0);
    }
}
