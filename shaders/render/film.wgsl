// #include numbers, scene, grid, between
// Films: the surface of the water sinks towards a sponge.

@group(0) @binding(2) var<storage, read> away: array<f32>;
@group(0) @binding(3) var<storage, read_write> sunk: array<f32>;

fn along(index: u32, stride: u32) -> f32 {
    let own = away[index];
    let has_before = index >= stride && is_near(away[max(index, stride) - stride]);
    let has_after = index + stride < node_count() && is_near(away[min(index + stride, node_count() - 1u)]);
    let before = away[max(index, stride) - stride];
    let after = away[min(index + stride, node_count() - 1u)];
    if (has_before && has_after) {
        return 0.5 * (after - before);
    }
    if (has_before) {
        return own - before;
    }
    return select(0.0, after - own, has_after);
}

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let index = row_of(group, groups, lane);
    if (index >= node_count()) {
        return;
    }
    let distance = away[index];
    let reach = FILM_REACH * scene.spacing;
    if (distance >= reach) {
        sunk[index] = densities[index];
        return;
    }
    let rest = 1.0 - max(distance / reach, 0.0);
    let row = scene.field_sides.x;
    let slope = vec3(along(index, 1u), along(index, row), along(index, row * scene.field_sides.y)) * scene.field_inverse;
    let step = slope / max(length(slope), 1.0) * (FILM_THICKEST * scene.spacing * rest * rest);
    sunk[index] = density_at(node_place(node_of(index)) + step);
}
