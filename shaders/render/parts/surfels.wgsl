// Pieces of the surface of sponges, in the cells of a grid.

// First place of every cell in the list, and the end of the last one.
@group(0) @binding(1) var<storage, read> surfel_cells: array<u32>;
// Middle and normal of every piece, cell by cell.
@group(0) @binding(2) var<storage, read> surfels: array<vec4<f32>>;

// Mean distance from the planes of the pieces around a point (m), `FAR_AWAY` far from all.
fn surfel_distance(point: vec3<f32>) -> f32 {
    if (scene.surfels == 0u) {
        return FAR_AWAY;
    }
    let reach = KERNELS_REACH * scene.spacing;
    let cell = vec3<i32>(clamp(trunc((point - scene.surfel_low) * scene.surfel_inverse), vec3(-1.0e6), vec3(1.0e6)));
    let last = vec3<i32>(scene.surfel_sides) - 1;
    let first = clamp(cell - 2, vec3(0), last);
    let end = clamp(cell + 2, vec3(0), last);
    var sum = 0.0;
    var weights = 0.0;
    for (var z = first.z; z <= end.z; z++) {
        for (var y = first.y; y <= end.y; y++) {
            let row = (u32(z) * scene.surfel_sides.y + u32(y)) * scene.surfel_sides.x;
            for (var k = surfel_cells[row + u32(first.x)]; k < surfel_cells[row + u32(end.x) + 1u]; k++) {
                let r = point - surfels[2u * k].xyz;
                let near = max(1.0 - dot(r, r) / (reach * reach), 0.0);
                let weight = near * near * near * near;
                sum += weight * dot(r, surfels[2u * k + 1u].xyz);
                weights += weight;
            }
        }
    }
    return select(FAR_AWAY, sum / max(weights, 1.0e-30), weights > 1.0e-4);
}
