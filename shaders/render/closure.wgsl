// #include numbers, scene, grid, shapes
// Density of the water over the free share of space, less the level of its surface. No gap shows where water meets a solid.

@group(0) @binding(1) var<storage, read> sums: array<u32>;
@group(0) @binding(2) var<storage, read> away: array<f32>;
@group(0) @binding(3) var<storage, read_write> densities: array<f32>;

// Share of a kernel in front of a plane, with the middle of the kernel at a distance in front of it, in radii.
fn share_in_front(distance: f32) -> f32 {
    let x = clamp(distance, -1.0, 1.0);
    let y = x * x;
    return 0.5 + 1.2304688 * x * (1.0 + y * (-4.0 / 3.0 + y * (1.2 + y * (-4.0 / 7.0 + y / 9.0))));
}

fn free_of_sponge(index: u32) -> f32 {
    return share_in_front((away[index] - CLOSURE_PORES * scene.spacing) / (KERNELS_REACH * scene.spacing));
}

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let index = row_of(group, groups, lane);
    if (index >= node_count()) {
        return;
    }
    var value = of_fixed(sums[index]);
    if (value > DENSITY_THIN) {
        let node = node_of(index);
        var free = 1.0;
        if (scene.surfels != 0u) {
            free = free_of_sponge(index);
            // Sponges have images behind the floor as the water has.
            let image = 2u * scene.floor_node - node.y;
            if (scene.has_floor_node != 0u && 2u * scene.floor_node >= node.y && image < scene.field_sides.y) {
                free *= free_of_sponge(index - node.y * scene.field_sides.x + image * scene.field_sides.x);
            }
        }
        let place = node_place(node);
        for (var body = 0u; body < scene.all_bodies; body++) {
            let distance = body_distance(body, place) / (KERNELS_REACH * scene.spacing);
            if (distance < 1.0) {
                free *= share_in_front(distance);
            }
        }
        value /= max(free, DENSITY_LEAST_FREE);
    }
    densities[index] = min(value, DENSITY_LARGEST) - DENSITY_LEVEL;
}
