// #include smoothing, control_group, solid_mirrors, image
// Second pass of `couple::solid_response`: sums over the particles around a node, for `solid_response.wgsl`.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_predicted: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_renormalisation_between: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluid_held: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> control_fluid: array<u32>;
@group(0) @binding(8) var<storage, read_write> control_force: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> control_solved: array<vec4<f32>>;

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let row = control_row(group, groups, lane);
    let is_row = row < params.node_rows;
    let own = control_position[min(row, params.node_rows - 1u)];
    let first = row * (params.control_fluid_capacity + 1u);
    var end = 0u;
    if (is_row) {
        end = control_fluid[first];
    }
    let near = walls_near(own.xyz);
    let mirrors = select(1u, MIRRORS, near != 0u);
    let scale = own[CONTROL_POSITION_VOLUME] * params.coupling.value;
    var push = vec3<f32>(0.0);
    var drawn = vec3<f32>(0.0);
    for (var k = lane % CONTROL_THREADS; k < end; k += CONTROL_THREADS) {
        let other = control_fluid[first + 1u + k];
        let apart = own.xyz - fluid_predicted[other].xyz;
        drawn += (scale * shape(closeness(params.coupling, dot(apart, apart)))) * fluid_held[other].xyz;
    }
    for (var mirror = 0u; mirror < mirrors; mirror += 1u) {
        let by = mirror_of(near, mirror);
        let there = mirrored(by, own.xyz);
        for (var k = lane % CONTROL_THREADS; k < end && by.is_there; k += CONTROL_THREADS) {
            let other = control_fluid[first + 1u + k];
            let particle = fluid_predicted[other];
            let along = fluid_renormalisation[other].xyz;
            let between = fluid_renormalisation_between[other].xyz;
            let offset = there - particle.xyz;
            let u = closeness(params.solid, dot(offset, offset));
            push += by.signs * ((particle[FLUID_PREDICTED_PRESSURE] * (u * u * u)) * symmetric_times(along, between, offset));
        }
    }
    let pushed = control_sum(lane, vec4<f32>(push, 0.0));
    let held = control_sum(lane, vec4<f32>(drawn, 0.0));
    if (is_row && lane % CONTROL_THREADS == 0u) {
        control_force[row] = pushed;
        control_solved[row] = held;
    }
}
