// Points by the cells of a grid.

// Places of points, and how far each reaches into other cells (m); none where that is negative.
@group(0) @binding(1) var<storage, read> points: array<vec4<f32>>;

struct Cells {
    first: vec3<u32>,
    last: vec3<u32>,
    is_there: bool,
}

fn cell_of(point: vec3<f32>) -> vec3<u32> {
    let place = (point - scene.cell_low) / scene.cell_side;
    return vec3<u32>(clamp(place, vec3(0.0), vec3<f32>(scene.cell_sides) - 1.0));
}

fn cells_of(row: u32) -> Cells {
    let point = points[scene.point_rows * row];
    return Cells(cell_of(point.xyz - point.w), cell_of(point.xyz + point.w), point.w >= 0.0);
}

fn cell_index(cell: vec3<u32>) -> u32 {
    return (cell.z * scene.cell_sides.y + cell.y) * scene.cell_sides.x + cell.x;
}
