// #include numbers, scene
// Sums of the kernels on the nodes of a grid, in fixed point: they do not depend on the order of the sums. One group for every kernel.

@group(0) @binding(1) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> free: array<f32>;
@group(0) @binding(3) var<storage, read> kernels: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> sums: array<atomic<u32>>;

@compute @workgroup_size(DENSITY_THREADS)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let row = group.y * groups.x + group.x;
    if (row >= scene.particles || free[row] <= 0.0) {
        return;
    }
    let point = points[row].xyz;
    let own = kernels[4u * row];
    let first_metric = kernels[4u * row + 1u];
    let second_metric = kernels[4u * row + 2u];
    let extent = kernels[4u * row + 3u].xyz;
    let diagonal = vec3(first_metric.xw, second_metric.y);
    let sides = vec3(first_metric.yz, second_metric.x);
    for (var choice = 0u; choice < 27u; choice++) {
        // The mirror images behind walls, but not above.
        let choices = vec3(choice % 3u, (choice / 3u) % 3u, choice / 9u);
        if (choice > 0u && scene.has_container == 0u) {
            break;
        }
        let walls = select(scene.high, scene.low, choices == vec3(1u));
        let is_mirrored = choices != vec3(0u);
        if (choices.y == 2u || any(is_mirrored & (abs(point - walls) >= vec3(KERNELS_REACH * scene.spacing)))) {
            continue;
        }
        let centre = select(own.xyz, 2.0 * walls - own.xyz, is_mirrored);
        let flip = select(vec3(1.0), vec3(-1.0), is_mirrored);
        let s = sides * flip.xxy * flip.yzz;
        let low = (centre - extent - scene.field_origin) * scene.field_inverse;
        let high = (centre + extent - scene.field_origin) * scene.field_inverse;
        if (any(high < vec3(0.0))) {
            continue;
        }
        let first = min(vec3<u32>(max(low, vec3(0.0))), scene.field_sides);
        let size = max(min(vec3<u32>(high) + 1u, scene.field_sides), first) - first;
        for (var k = lane; k < size.x * size.y * size.z; k += DENSITY_THREADS) {
            let node = first + vec3(k % size.x, (k / size.x) % size.y, k / (size.x * size.y));
            let r = scene.field_origin + scene.field_cell * vec3<f32>(node) - centre;
            let square = dot(diagonal, r * r) + 2.0 * dot(s, r.xxy * r.yzz);
            if (square < 1.0) {
                let share = 1.0 - square;
                let index = (node.z * scene.field_sides.y + node.y) * scene.field_sides.x + node.x;
                atomicAdd(&sums[index], fixed(own.w * share * share * share));
            }
        }
    }
}
