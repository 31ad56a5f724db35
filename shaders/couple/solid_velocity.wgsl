// #include smoothing, drag, solid_mirrors, image, shares
// Velocities with the drag, and the material that flows past them; `solid_velocity.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_controls: array<u32>;
@group(0) @binding(4) var<storage, read> fluid_mobility: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> fluid_renormalisation_between: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> control_solved: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> fluid_correction: array<vec4<f32>>;

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
    let end = fluid_controls[row];
    let point = fluid_position[row].xyz;
    let near = walls_near(point);
    let mirrors = select(1u, MIRRORS, near != 0u);
    var sum = vec3<f32>(0.0);
    var interior = 0.0;
    var moment = vec3<f32>(0.0);
    var on = vec3<f32>(0.0);
    var off = vec3<f32>(0.0);
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_controls[row + (k + 1u) * rows];
        let there = control_position[other];
        let apart = point - there.xyz;
        let weight = there[CONTROL_POSITION_VOLUME] * params.coupling.value * shape(closeness(params.coupling, dot(apart, apart)));
        sum += weight * control_solved[other].xyz;
        interior += weight;
    }
    for (var mirror = 0u; mirror < mirrors; mirror += 1u) {
        let by = mirror_of(near, mirror);
        for (var k = share.first; k < end && by.is_there; k += SHARES) {
            let other = fluid_controls[row + (k + 1u) * rows];
            let node = control_solved[other];
            let offset = point - mirrored(by, control_position[other].xyz);
            let u = closeness(params.solid, dot(offset, offset));
            let apart = (node[CONTROL_SOLVED_VOLUME] * (u * u * u)) * offset;
            let v = by.signs * node.xyz;
            moment += apart;
            on += v * apart;
            off += v.yzx * apart.zxy + v.zxy * apart.yzx;
        }
    }
    let all = share_sum(lane, vec4<f32>(sum, interior));
    moment = share_sum3(lane, moment);
    on = share_sum3(lane, on);
    off = share_sum3(lane, off);
    if (!share.writes || end == 0u) {
        return;
    }
    let mobility = fluid_mobility[row][FLUID_MOBILITY_MOBILITY];
    let own = mobility * fluid_correction[row].xyz + ((1.0 - mobility) * weight_inside(all.w)) * all.xyz;
    on -= own * moment;
    off -= own.yzx * moment.zxy + own.zxy * moment.yzx;
    let rate = dot(on, fluid_renormalisation[row].xyz) + dot(off, fluid_renormalisation_between[row].xyz);
    fluid_correction[row] = vec4<f32>(own, rate * params.solid.gradient);
}
