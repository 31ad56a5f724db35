// #include numbers, scene, between
// How much free water covers each node of the sponges, 0 to 1, from the densities before the surface sinks.

@group(0) @binding(2) var<storage, read_write> mesh: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let node = row_of(group, groups, lane);
    if (node >= scene.nodes) {
        return;
    }
    let at = scene.nodes_at + 3u * node;
    let normal = mesh[at + 1u].xyz;
    let above = mesh[at].xyz + normal * (FILM_HEIGHT * scene.spacing);
    mesh[at + 1u] = vec4(normal, smooth_between(FILM_DENSITIES.x, FILM_DENSITIES.y, density_at(above)));
}
