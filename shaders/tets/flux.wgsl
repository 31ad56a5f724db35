// #include smoothing, solid_mirrors, image, shares
// What the material counts for in the divergence at a particle, by the corners of its tet; `flux.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_controls: array<u32>;
@group(0) @binding(4) var<storage, read> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluid_renormalisation_between: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> control_material: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_shares: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> fluid_pushed: array<vec4<f32>>;

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
    let along = fluid_renormalisation[row].xyz;
    let between = fluid_renormalisation_between[row].xyz;
    var received = vec3<f32>(0.0);
    var turned = vec3<f32>(0.0);
    // Sums of the turned push times the way from the particle to the node, by the coordinates of the way.
    var by_x = vec3<f32>(0.0);
    var by_y = vec3<f32>(0.0);
    var by_z = vec3<f32>(0.0);
    for (var mirror = 0u; mirror < mirrors; mirror += 1u) {
        let by = mirror_of(near, mirror);
        for (var k = share.first; k < end && by.is_there; k += SHARES) {
            let other = fluid_controls[row + (k + 1u) * rows];
            let node = control_position[other].xyz;
            let offset = mirrored(by, node) - point;
            let u = closeness(params.solid, dot(offset, offset));
            let push = (control_material[other][CONTROL_MATERIAL_VOLUME] * (u * u * u)) * symmetric_times(along, between, offset);
            received += push;
            let back = by.signs * push;
            let way = node - point;
            turned += back;
            by_x += back * way.x;
            by_y += back * way.y;
            by_z += back * way.z;
        }
    }
    received = share_sum3(lane, received);
    turned = share_sum3(lane, turned);
    by_x = share_sum3(lane, by_x);
    by_y = share_sum3(lane, by_y);
    by_z = share_sum3(lane, by_z);
    if (!share.writes) {
        return;
    }
    let scale = params.solid.gradient;
    fluid_pushed[row] = vec4<f32>(received * scale, 0.0);
    if (end == 0u) {
        return;
    }
    var sum = 0.0;
    for (var corner = 0u; corner < TET_CORNERS; corner += 1u) {
        sum += max(fluid_shares[TET_CORNERS * row + corner][CORNER_WEIGHT], 0.0);
    }
    for (var corner = 0u; corner < TET_CORNERS; corner += 1u) {
        let linear = fluid_shares[TET_CORNERS * row + corner];
        let own = turned * linear[CORNER_WEIGHT] + by_x * linear.x + by_y * linear.y + by_z * linear.z;
        fluid_shares[TET_CORNERS * row + corner] = vec4<f32>(own * scale, max(linear[CORNER_WEIGHT], 0.0) / sum);
    }
}
