// #include wrench
// Wrenches of fluid and sponges on one body per workgroup, summed over all groups of particles and nodes in a fixed order.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> body_fluid_wrenches: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> body_node_wrenches: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> body_wrenches: array<vec4<f32>>;

@compute @workgroup_size(GROUP_THREADS)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let body = group.x;
    if (clock.running == 0u || body >= params.body_rows) {
        return;
    }
    var own = Wrench(vec3<f32>(0.0), vec3<f32>(0.0));
    let fluid_groups = (params.fluid_rows + GROUP_THREADS - 1u) / GROUP_THREADS;
    for (var k = lane; k < fluid_groups; k += GROUP_THREADS) {
        let slot = (k * params.body_rows + body) * WRENCH_ROWS;
        own.impulse += body_fluid_wrenches[slot].xyz;
        own.angular += body_fluid_wrenches[slot + 1u].xyz;
    }
    let fluid = group_sum(lane, own);
    own = Wrench(vec3<f32>(0.0), vec3<f32>(0.0));
    let node_groups = (params.node_rows + GROUP_THREADS - 1u) / GROUP_THREADS;
    for (var k = lane; k < node_groups; k += GROUP_THREADS) {
        let slot = (k * params.body_rows + body) * WRENCH_ROWS;
        own.impulse += body_node_wrenches[slot].xyz;
        own.angular += body_node_wrenches[slot + 1u].xyz;
    }
    let nodes = group_sum(lane, own);
    if (lane == 0u) {
        body_wrenches[2u * WRENCH_ROWS * body] = vec4<f32>(fluid.impulse, 0.0);
        body_wrenches[2u * WRENCH_ROWS * body + 1u] = vec4<f32>(fluid.angular, 0.0);
        body_wrenches[2u * WRENCH_ROWS * body + 2u] = vec4<f32>(nodes.impulse, 0.0);
        body_wrenches[2u * WRENCH_ROWS * body + 3u] = vec4<f32>(nodes.angular, 0.0);
    }
}
