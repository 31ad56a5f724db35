// The nodes of the grid that holds the density of the water.

fn node_of(index: u32) -> vec3<u32> {
    let row = index / scene.field_sides.x;
    return vec3(index % scene.field_sides.x, row % scene.field_sides.y, row / scene.field_sides.y);
}

fn node_place(node: vec3<u32>) -> vec3<f32> {
    return scene.field_origin + scene.field_cell * vec3<f32>(node);
}

fn node_count() -> u32 {
    return scene.field_sides.x * scene.field_sides.y * scene.field_sides.z;
}
